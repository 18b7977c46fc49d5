"""Scene files: a scene as a `scene.toml` and mesh files beside it, read, written and edited as text.

A part of `autocolor.files`. It uses `autocolor.scene`, and the readers of meshes.
"""
