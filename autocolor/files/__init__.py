"""Reading scenes, meshes and picture files, and writing files atomically.

May import from `mapping`, `lighting`, `scene`, and the modules that every package shares.
"""
