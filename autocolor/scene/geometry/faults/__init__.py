"""What may be wrong with a mesh that can be rendered: holes, turned and repeated polygons, warped quads.

Uses the mesh, the other modules of `geometry`, and the ground.
"""
