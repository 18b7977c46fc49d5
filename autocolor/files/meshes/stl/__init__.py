"""STL files, binary or text, whose triangles are welded: corners at one place become one node."""

from __future__ import annotations

from autocolor.files.meshes.stl import stl_file as stl_file
