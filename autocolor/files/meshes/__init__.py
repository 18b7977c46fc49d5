"""Readers and writers of mesh files: one module for each format; `files/formats` lists them.

`number_text`, `file_scalars`, `cells` and `repair` are for several formats. Uses the
modules of `files`, `scene` and the ground.
"""
