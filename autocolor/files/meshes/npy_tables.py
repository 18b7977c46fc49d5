"""A mesh as a folder of .npy tables, mapped into memory in the order in which rendering reads them.

| file | shape | type | what |
|---|---|---|---|
| `nodes.npy` | (nodes, 3) | float64 | coordinates |
| `polygons.npy` | (polygons, 4) | int64 | rows of the node table, from 0; a triangle repeats its last |
| `parts.npy` | (polygons,) | int64 | part of each polygon, from 0; absent: all are of the first |
| `normals.npy` | (normals, 3) | float32 | unit vectors |
| `normal_numbers.npy` | (polygons, 4) | int64 | the row of `normals.npy` at each corner |
| `planes.npy` | (planes, 7) | float64 | planes that polygons share: normal, point, distance |
| `plane_numbers.npy` | (polygons,) | int64 | the row of `planes.npy` of each polygon, -1 for none |
| `plane_sides.npy` | (polygons,) | uint8 | 1 where a polygon's normal is against that of its plane |
| `scalars/1.npy`, ... | (nodes,) or (polygons,) | float64 | a scalar; NaN is missing |
| `tables.json` | | | names of parts and scalars, crease angle, planes |

All are stored by columns (Fortran order), so that `.T` is contiguous, in the byte order of the machine. Only
the first two are needed. Tables of other types, orders and shapes that numpy saves are copied: triangles
alone as (polygons, 3), float32, int32, tables by rows. If the nodes are turned (`up`) or scaled, all are
copied. Normals and planes are used if the nodes stay as in the file and the crease angle is the file's;
otherwise they are computed. If you change nodes or polygons, delete the normals and `tables.json`, or convert
the folder again. Nothing is ever repaired. All numbers are checked once, when the tables are opened.

A save replaces all tables at once (see `writing.write_together`). In `tables.json`, `planes` is true if the
three files of planes exist, false if polygons share no planes, and null if planes are to be computed:

    {"format": "autocolor npy tables 2", "part_names": ["hood", "roof"], "crease_angle": 40.0,
     "scalars": [{"name": "stress", "of": "node"}], "planes": null}
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Indices, chunks
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE, printable
from autocolor.errors import InputError
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, placed
from autocolor.files.reading import bounded_json, opened, read_bytes
from autocolor.files.writing import SCALARS, read_table, read_together, table_exists, write_together
from autocolor.immutable import read_only
from autocolor.logs import logger_of, timed
from autocolor.scene.geometry.normals import CREASE_ANGLE, NodeNormals
from autocolor.scene.geometry.planes import SharedPlanes
from autocolor.scene.mesh import PART, Mesh
from autocolor.scene.scalar import MOST_SCALARS, NODE, POLYGON, MeshScalar

LOG: Final = logger_of(__name__)

NODES: Final = "nodes.npy"
POLYGONS: Final = "polygons.npy"
PARTS: Final = "parts.npy"
NORMALS: Final = "normals.npy"
NORMAL_NUMBERS: Final = "normal_numbers.npy"
PLANES: Final = "planes.npy"
PLANE_NUMBERS: Final = "plane_numbers.npy"
PLANE_SIDES: Final = "plane_sides.npy"
NOTES: Final = "tables.json"

MAGIC: Final = np.lib.format.MAGIC_PREFIX

BYTES_OF_ROW: Final = 20
"""Measured: 168 MB to open and render ten million quads. So a sparse file is not read for hours, either."""

ROWS_AT_ONCE: Final = 1 << 14

UNIT: Final = 1e-3
"""Limit: how far the length of a unit vector may be from 1."""

MOST_PARTS: Final = 1 << 16
"""Limit: parts in a folder that does not name its parts."""

WITHIN: Final = (-LARGEST_COORDINATE, LARGEST_COORDINATE)


Table = tuple[str, AnyArray]
"""The name of a file in messages, and its table."""


def mapped(path: Path, name: str) -> Table:
    """The table of an .npy file, (rows,) or (rows, columns), read-only; messages have the `name`.

    numpy maps it into memory: it is read page by page, and never copied whole. If another program shortens
    the file later, the system ends the process that reads it (SIGBUS): write a new file and rename it. Raises
    MissingInputError if there is no such file, InputError if it is not such a table.
    """
    with opened(path):
        try:
            rows = np.asarray(np.lib.format.open_memmap(path, mode="r", max_header_size=1024))
            if rows.dtype.kind not in "iuf" or rows.ndim not in (1, 2):
                raise ValueError(f"its dtype is {rows.dtype}, its shape {rows.shape}")
        except Exception as error:
            # A wrong header makes numpy raise errors of many kinds.
            raise InputError(
                f"{name}: it must be an .npy table of numbers, not another file"
                f" ({printable(str(error)[:45])}); write it with numpy.save"
            ) from None
    return name, rows


FORMAT: Final = "autocolor npy tables 2"

LARGEST_NOTES: Final = 4 << 20

KEYS: Final = {"format", "part_names", "crease_angle", "scalars", "planes"}


def notes_of(data: bytes) -> tuple[Mesh, bool | None]:
    """The notes of `tables.json`: a mesh without nodes, and whether there are planes. Raises InputError."""
    try:
        notes = bounded_json(data, LARGEST_NOTES)
        if not isinstance(notes, dict) or notes.get("format") != FORMAT or notes.keys() - KEYS:
            raise ValueError(f"its format must be {FORMAT!r}, with no keys but {', '.join(sorted(KEYS))}")
        names, planes = notes.get("part_names", []), notes.get("planes")
        if not isinstance(names, list) or planes not in (None, True, False):
            raise ValueError("part_names must be a list, and planes true, false or null")
        nothing = np.zeros((0, 3)), np.zeros((0, 4), np.intp)
        mesh = Mesh(*nothing, None, tuple(names), notes.get("crease_angle", CREASE_ANGLE))  # type: ignore[arg-type]
        rows = notes.get("scalars", [])
        return mesh.with_scalars(*(MeshScalar(row["name"], np.zeros(0), row["of"]) for row in rows)), planes
    except (ValueError, LookupError, TypeError, InputError) as error:
        raise InputError(
            f"{NOTES}: it must be as a conversion writes it, and is not ({printable(str(error)[:200])});"
            " convert the mesh again, or correct it"
        ) from None


def read_npy_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of .npy tables. The tables beside `nodes.npy` and `polygons.npy` in their folder are read too.

    Raises InputError that names table, row and remedy.
    """
    tables, (notes, has_planes) = read_together(nodes.parent, NOTES, lambda: _opened(nodes, polygons))
    angle = notes.crease_angle if placement.crease_angle is None else placement.crease_angle
    coordinates = _table(tables[NODES], (None, 3), np.float64, *WITHIN)
    corners = _table(tables[POLYGONS], (None, 4), np.intp, 0, len(coordinates) - 1)
    count = len(corners)
    # Part 0 for all polygons takes the memory of one number.
    part_numbers: Indices = np.broadcast_to(np.zeros(1, np.intp), count)
    names = notes.part_names
    if PARTS in tables:
        part_numbers = _table(tables[PARTS], (count,), np.intp, 0, (len(names) or MOST_PARTS) - 1)
        names = names or tuple(f"part {number}" for number in range(int(part_numbers.max(initial=0)) + 1))
    rows = {NODE: len(coordinates), POLYGON: count}
    scalars = tuple(
        MeshScalar(each.name, _table(tables[file], (rows[each.of],), np.float64), each.of)
        for file, each in zip(_scalar_files(notes), notes.scalars, strict=True)
    )
    mesh = (corners, part_numbers, names or (PART,), float(angle), scalars)
    if placement.up != "z" or placement.scale != 1:
        return MeshReport(Mesh(placed(coordinates, placement), *mesh))
    planes: Any = ... if has_planes is None else None
    if has_planes:
        rows_of_planes = _table(tables[PLANES], (None, 7), np.float64, *WITHIN, True)
        plane_numbers = _table(tables[PLANE_NUMBERS], (count,), np.intp, -1, len(rows_of_planes) - 1)
        sides = _table(tables[PLANE_SIDES], (count,), np.uint8, 0, 1).view(np.bool_)
        columns = np.ascontiguousarray(rows_of_planes.T)
        planes = SharedPlanes(columns[:3], columns[3:6], columns[6], plane_numbers, sides)
    normals = None
    if NORMALS in tables and angle == notes.crease_angle:
        vectors = _table(tables[NORMALS], (None, 3), np.float32, *WITHIN, True)
        numbers = _table(tables[NORMAL_NUMBERS], (count, 4), np.intp, 0, len(vectors) - 1)
        normals = NodeNormals(vectors, numbers)
    return MeshReport(Mesh.of_tables(coordinates, *mesh, normals=normals, shared_planes=planes))


def _opened(nodes: Path, polygons: Path) -> tuple[Mapping[str, Table], tuple[Mesh, bool | None]]:
    """The tables of the mesh by their usual names, and the notes. Raises InputError."""
    folder, notes = nodes.parent, notes_of(json.dumps({"format": FORMAT}).encode())
    if (nodes, polygons) != (folder / NODES, folder / POLYGONS):
        files = {NODES: nodes, POLYGONS: polygons}
        return {name: mapped(path, path.name) for name, path in files.items()}, notes
    if table_exists(folder, NOTES):
        notes = notes_of(read_table(folder, NOTES, partial(read_bytes, largest=LARGEST_NOTES)))
    names = [NODES, POLYGONS, *_scalar_files(notes[0])]
    names += [PLANES, PLANE_NUMBERS, PLANE_SIDES] if notes[1] else []
    names += [PARTS] if table_exists(folder, PARTS) else []
    # They may have been deleted, to be computed.
    names += [NORMALS, NORMAL_NUMBERS] if table_exists(folder, NORMALS) else []
    return {name: read_table(folder, name, partial(mapped, name=name)) for name in names}, notes


def _scalar_files(mesh: Mesh) -> list[str]:
    """The files of the scalars of a mesh."""
    return [f"{SCALARS}/{number}.npy" for number in range(1, len(mesh.scalars) + 1)]


def _table(
    given: Table,
    shape: tuple[int | None, ...],
    dtype: type[Any],
    low: float = -math.inf,
    high: float = math.inf,
    is_unit: bool = False,
) -> AnyArray:
    """The table of a file by columns, with numbers from `low` to `high`; copied if the file has another type.

    None in the shape stands for any number of rows. With `is_unit`, the first three columns are unit vectors.
    Raises InputError, which counts rows from 0, as numpy does, also if the budget does not allow so many.
    """
    file, table = given
    rows = len(table)
    are_triangles = shape == (None, 4) and table.shape[1:] == (3,)
    if table.shape != (rows if shape[0] is None else shape[0], *shape[1:]) and not are_triangles:
        wanted = str(shape).replace("None", "rows")
        raise InputError(f"{file}: its shape must be {wanted}, not {table.shape}; write it again")
    if np.issubdtype(dtype, np.integer) and table.dtype.kind not in "iu":
        raise InputError(f"{file}: its numbers must be whole, not {table.dtype}; convert them")
    is_copied = are_triangles or table.dtype != dtype or not table.flags.f_contiguous
    size = rows * (
        BYTES_OF_ROW + is_copied * math.prod(size or 1 for size in shape[1:]) * np.dtype(dtype).itemsize
    )
    advice = "divide the mesh, or write it with `autocolor convert`"
    require_memory(size, f"{file}: to render {rows:,} rows", advice)
    if is_copied:
        # A triangle repeats its last corner.
        table = table[:, [0, 1, 2, 2]] if are_triangles else table
        table = read_only(np.array(table, dtype, order="F"))
    columns = np.atleast_2d(table.T)
    for chunk in chunks(rows if high < math.inf else 0, ROWS_AT_ONCE):
        numbers = columns[:, chunk]
        is_right = ((numbers >= low) & (numbers <= high)).all(axis=0)
        if is_unit:
            squares = np.einsum("ij,ij->j", numbers[:3], numbers[:3], dtype=np.float64)
            is_right &= np.abs(squares - 1) <= 2 * UNIT
        if not is_right.all():
            row = chunk.start + int(np.argmin(is_right))
            rule = f"from {low} to {high}{', with normals of the length 1' if is_unit else ''}"
            raise InputError(
                f"{file}: its numbers must be {rule}, not {given[1][row].tolist()} (row {row}, counted from"
                " 0); correct that row"
            )
    return table


OTHERS: Final = (
    *(PARTS, PLANES, PLANE_NUMBERS, PLANE_SIDES, NORMALS, NORMAL_NUMBERS),
    *(f"{SCALARS}/{number}.npy" for number in range(1, MOST_SCALARS + 1)),
)
"""The names of tables that a mesh may lack: those of an older mesh are removed."""


def write_npy_tables(folder: Path, mesh: Mesh, *, overwrite: bool = False) -> list[Path]:
    """Write a mesh as tables to a folder, with its normals and planes, in the order that rendering reads.

    Returns the paths of the tables. Raises OutputError if a file is there already and `overwrite` is false,
    WriteError if writing fails.
    """
    with timed(LOG, f"write tables, {len(mesh.node_numbers):,} polygons"):
        return write_together(folder, _files(mesh), others=OTHERS, overwrite=overwrite)


def _files(mesh: Mesh) -> Iterator[tuple[str, bytes | AnyArray]]:
    """The files of a mesh and their content; each is computed when it is written."""
    planes = mesh.shared_planes
    notes = {
        "format": FORMAT,
        "part_names": mesh.part_names,
        "crease_angle": mesh.crease_angle,
        "scalars": [{"name": scalar.name, "of": scalar.of} for scalar in mesh.scalars],
        "planes": planes is not None,
    }
    yield NODES, mesh.coordinates
    yield POLYGONS, mesh.node_numbers
    yield PARTS, mesh.part_numbers
    for name, scalar in zip(_scalar_files(mesh), mesh.scalars, strict=True):
        yield name, scalar.values
    if planes is not None:
        yield PLANES, np.concatenate([planes.normals, planes.points, planes.distances[None]]).T
        yield PLANE_NUMBERS, planes.plane_of_polygon
        yield PLANE_SIDES, planes.turned.view(np.uint8)
    yield NORMAL_NUMBERS, mesh.normals.numbers
    yield NORMALS, mesh.normals.vectors
    yield NOTES, (json.dumps(notes, indent=1, allow_nan=False) + "\n").encode()
