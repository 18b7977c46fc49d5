"""Scalar values: the number at each visible point, of a scalar of the mesh or a computed one.

Uses `scene`, `visibility` and the ground.
"""
