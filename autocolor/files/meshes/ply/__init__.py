"""PLY files: text or binary in either byte order, with scalars at nodes and polygons; read and written."""

from __future__ import annotations

from autocolor.files.meshes.ply import ply_file as ply_file
