"""Writing a mesh as .npy tables, in chunks: no table is copied whole.

Each file is written beside its place, synced and renamed. The notes, without which nothing of normals and
planes is believed, are renamed last.
"""

from __future__ import annotations

import math
import mmap
import os
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, chunks
from autocolor.errors import OutputError, WriteError, reason_of
from autocolor.files.meshes.npy import npy_tables as tables
from autocolor.files.meshes.npy.npy_array import MAGIC
from autocolor.files.meshes.npy.table_notes import NOTES, TableNotes, notes_text
from autocolor.files.writing import write_together
from autocolor.logs import logger_of, timed
from autocolor.scene.geometry.node_normals import NodeNormals, node_normals
from autocolor.scene.geometry.planes.shared_planes import SharedPlanes
from autocolor.scene.mesh import Mesh

LOG: Final = logger_of(__name__)

NUMBERS_AT_ONCE: Final = 1 << 17

LARGE: Final = 1 << 21
"""Polygons whose normals are computed in files, for they would take 160 bytes of memory a polygon."""


def write_npy_tables(folder: Path, mesh: Mesh, *, overwrite: bool = False) -> None:
    """Write a mesh as tables to a folder, with its normals and planes, so that they are mapped as they are.

    Raises OutputError if a file is there already and `overwrite` is false, WriteError if writing fails.
    """
    if mesh.scalars:
        _make(folder / tables.SCALARS)
    with timed(LOG, f"write tables, {len(mesh.node_numbers):,} polygons"):
        write_together(_files(folder, mesh), overwrite=overwrite, before_names=lambda: _remove_notes(folder))


def _files(folder: Path, mesh: Mesh) -> Iterator[tuple[Path, Iterable[bytes]]]:
    """The files of a mesh and their content; each is computed when it is written."""
    for name, table in _tables(folder, mesh):
        yield folder / name, _pieces(table)
    scalars = tuple((scalar.name, scalar.of) for scalar in mesh.scalars)
    notes = TableNotes(mesh.part_names, mesh.crease_angle, scalars, mesh.shared_planes is not None)
    yield folder / NOTES, [notes_text(notes)]


def _tables(folder: Path, mesh: Mesh) -> Iterator[tuple[str, AnyArray]]:
    """The names of the files and their tables, (rows,) or (rows, columns)."""
    yield tables.NODES, mesh.coordinates
    yield tables.POLYGONS, mesh.node_numbers
    yield tables.PARTS, mesh.part_numbers
    for number, scalar in enumerate(mesh.scalars, 1):
        yield f"{tables.SCALARS}/{number}.npy", scalar.values
    planes = mesh.shared_planes
    if planes is not None:
        yield tables.PLANES, _plane_rows(planes)
        yield tables.PLANE_NUMBERS, planes.plane_of_polygon
        yield tables.PLANE_SIDES, planes.turned.view(np.uint8)
    normals = _normals(folder, mesh)
    yield tables.NORMAL_NUMBERS, normals.numbers
    yield tables.NORMALS, normals.vectors


def _normals(folder: Path, mesh: Mesh) -> NodeNormals:
    """The normals of a mesh: its own, or those of a large one computed in files that have no name."""
    if len(mesh.node_numbers) < LARGE or "normals" in vars(mesh):
        return mesh.normals
    with timed(LOG, "node normals, in files"):
        return node_normals(
            mesh.coordinates,
            mesh.node_numbers,
            mesh.part_numbers,
            mesh.crease_angle,
            lambda shape, dtype: scratch_array(folder, shape, dtype),
        )


def scratch_array(folder: Path, shape: tuple[int, ...], dtype: type[Any]) -> AnyArray:
    """An array to work in, backed by a file without a name in a folder, which is gone with the array.

    Raises WriteError if there is no room for it: the room is taken at once, for nobody could be told later.
    """
    count = math.prod(shape)
    size = max(count * np.dtype(dtype).itemsize, 1)
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            if hasattr(os, "posix_fallocate"):
                os.posix_fallocate(file.fileno(), 0, size)
            else:
                for _ in range(0, size, NUMBERS_AT_ONCE):
                    file.write(bytes(NUMBERS_AT_ONCE))
                file.flush()
            pages = mmap.mmap(file.fileno(), size)
    except OSError as error:
        raise WriteError(f"{folder}: there must be room to work in ({reason_of(error)}); make some") from None
    return np.frombuffer(pages, dtype, count).reshape(shape)


def _plane_rows(planes: SharedPlanes) -> AnyArray:
    return np.concatenate([planes.normals, planes.points, planes.distances[None]]).T


def _make(folder: Path) -> None:
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: it cannot be made ({reason_of(error)}); choose another place") from None


def _remove_notes(folder: Path) -> None:
    """Remove the notes of an older mesh, and what its normals and planes were, before files are replaced."""
    others = (tables.PLANES, tables.PLANE_NUMBERS, tables.PLANE_SIDES, tables.NORMALS, tables.NORMAL_NUMBERS)
    for path in (folder / NOTES, *(folder / name for name in others)):
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise OutputError(f"{path}: it cannot be replaced ({reason_of(error)}); delete it") from None


def npy_header(dtype: np.dtype[Any], shape: tuple[int, ...]) -> bytes:
    """The header of an .npy file of a table that is stored by columns, as numpy writes it."""
    order = len(shape) > 1
    text = f"{{'descr': '{dtype.str}', 'fortran_order': {order}, 'shape': {shape}, }}"
    size = -(-(10 + len(text) + 1) // 64) * 64
    return MAGIC + b"\x01\x00" + (size - 10).to_bytes(2, "little") + text.ljust(size - 11).encode() + b"\n"


def _pieces(table: AnyArray) -> Iterable[bytes]:
    """The bytes of the .npy file of a table, column after column."""
    yield npy_header(table.dtype, table.shape)
    for row in table.T if table.ndim > 1 else table[None]:
        for chunk in chunks(len(row), NUMBERS_AT_ONCE):
            yield row[chunk].tobytes()
