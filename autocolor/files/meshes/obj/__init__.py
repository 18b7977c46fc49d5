"""Meshes in OBJ files (Wavefront): plain files are read fast, others line by line."""

from __future__ import annotations

from autocolor.files.meshes.obj import obj_file as obj_file
