"""Formats that are read by other libraries, trimesh and meshio, in a process of their own.

The extra `meshes` installs the libraries. `worker` is the only module that imports them.
"""

from __future__ import annotations

from autocolor.files.meshes.foreign import foreign_formats as foreign_formats
