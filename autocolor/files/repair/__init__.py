"""Converting the polygons of a file to a mesh of triangles and quads, and reporting every repair.

Uses the modules of `files`, `scene` and the ground.
"""
