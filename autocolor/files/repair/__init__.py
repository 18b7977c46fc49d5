"""Converting what a file has to a mesh of triangles and quads, with names and scalars; telling every repair.

Uses the modules of `files`, `scene` and the ground.
"""
