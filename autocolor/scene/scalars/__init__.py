"""Scalars: numbers at the nodes or the polygons of a mesh, such as stress, and how they are shown in color.

Uses `scene.columns` and the ground.
"""
