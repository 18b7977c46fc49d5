"""Mesh file formats: one module or package for each, and the registry in `formats`.

Uses `files/repair`, the modules of `files`, `scene` and the ground.
"""
