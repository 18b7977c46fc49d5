"""Meshes in OBJ files (Wavefront): plain files are read fast, others line by line."""

from autocolor.files.meshes.obj import obj_file as obj_file
