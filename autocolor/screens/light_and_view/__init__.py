"""The geometry of the light and view screen, Figure 5: its three views, the lines of the mesh and the marks.

Uses `visibility`, `scene`, the ground and `screens.orbit`; it draws nothing and knows no display.
"""
