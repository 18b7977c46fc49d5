"""Scene files: reading a scene.toml, reporting all its problems at once, and writing one.

Uses `files/meshes` and the modules of `files`.
"""
