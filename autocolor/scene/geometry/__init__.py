"""Geometry of the node table and the polygon table: normals, fans, curvatures, shared planes, foreign meshes.

Uses the ground, and of `scene` only the scalars of meshes; never the mesh itself.
"""
