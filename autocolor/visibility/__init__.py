"""Which polygon is visible at each pixel, the point, normal and reflected view there, and what a pixel sees.

Uses `scene` and the ground.
"""
