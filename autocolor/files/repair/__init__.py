"""Converting the polygons of a file to a mesh of triangles and quads, and reporting every repair.

May import from the modules of `files`.
"""
