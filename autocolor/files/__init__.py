"""Readers of scenes and meshes, and writing that leaves the old or the new file whole.

Uses `mapping`, `lighting`, `scene` and the ground.
"""
