"""Wavefront OBJ files: a fast reader for plain files, and a line-by-line reader for all others."""

from __future__ import annotations

from autocolor.files.meshes.obj import obj_file as obj_file
