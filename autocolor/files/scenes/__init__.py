"""Scene files: reading a scene.toml with every problem in one report, and writing one.

Uses `files/meshes` and the rooms of `files`.
"""
