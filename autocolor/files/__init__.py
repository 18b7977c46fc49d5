"""Reading scenes, meshes and picture files, and writing files atomically.

Uses `mapping`, `lighting`, `scene` and the ground.
"""
