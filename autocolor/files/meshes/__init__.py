"""Mesh file formats: one module or package for each, and the registry in `formats`.

May import from `files/repair` and the modules of `files`.
"""
