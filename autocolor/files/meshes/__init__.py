"""Mesh file formats: one module or package for each, and the registry in `formats`.

Other modules are what several of them use (`number_text`) or a part of one (`csv_rows`, `csv_writing`).
Uses `files/repair`, the modules of `files`, `scene` and the ground.
"""
