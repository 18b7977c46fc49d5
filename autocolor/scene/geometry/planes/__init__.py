"""The planes that several polygons of a mesh share, found once for a mesh, so that no decal is torn.

Uses the modules of `scene` that the mesh uses, and the ground.
"""
