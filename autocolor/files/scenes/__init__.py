"""Scene files: reading a scene.toml, reporting all its problems at once, and writing one.

May import from `files/meshes` and the modules of `files`.
"""
