"""From the polygons of a file to a mesh of triangles and quads, with every repair counted.

Uses the rooms of `files`.
"""
