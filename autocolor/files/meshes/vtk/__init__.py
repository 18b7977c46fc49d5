"""Legacy VTK files: lines of keywords, arrays of numbers, cells, and the data of nodes and cells."""

from __future__ import annotations

from autocolor.files.meshes.vtk import vtk_file as vtk_file
