"""Hidden surfaces: the polygon that is visible at each pixel, and its point, normal and reflected view.

Uses `scene` and the ground.
"""
