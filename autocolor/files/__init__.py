"""Reading scenes, meshes and picture files, and writing files atomically.

Uses `lighting`, `scene` and the ground.
"""
