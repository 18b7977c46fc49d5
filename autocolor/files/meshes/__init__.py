"""Readers and writers of mesh files: one module for each format; `files/formats` lists them.

`number_text`, `file_scalars`, `welding` and `repair` are for several formats. Uses the
modules of `files`, `scene` and the ground.
"""
