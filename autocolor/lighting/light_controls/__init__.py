"""The light controls, one module for each; `control` has what they share, and the list of them.

Uses `visibility`, `scene` and the ground.
"""
