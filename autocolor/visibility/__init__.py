"""Which polygon is visible at each pixel, and the point, normal and reflected view there.

Uses `scene` and the ground.
"""
