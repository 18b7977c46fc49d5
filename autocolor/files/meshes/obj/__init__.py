"""Meshes in OBJ files (Wavefront): the plain files fast, the others line by line."""
