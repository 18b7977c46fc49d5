"""Folders of .npy tables, which are mapped into memory: `npy_tables` says which, in what order and shape."""

from __future__ import annotations

from autocolor.files.meshes.npy import npy_format as npy_format
