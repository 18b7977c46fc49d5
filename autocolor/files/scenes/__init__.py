"""Scene files: reading a scene.toml, reporting all its problems at once, and writing one.

Uses `files/meshes`, the modules of `files`, `scene` and the ground.
"""
