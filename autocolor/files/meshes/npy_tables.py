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
| `tables.json` | | | names of parts and scalars, crease angle, files |

All are stored by columns (Fortran order), so that `.T` is contiguous, in the byte order of the machine. Only
the first two are needed. Tables of other types, orders and shapes that numpy saves are copied, and the log
says so: triangles alone as (polygons, 3), float32, int32, tables by rows. If the nodes are turned (`up`) or
scaled, they are copied. Normals and planes are used if the nodes stay as in the file and the crease angle is
the file's; otherwise they are computed. If you change nodes or polygons, delete the normals and
`tables.json`, or convert the folder again. Nothing is ever repaired. All numbers are checked once, when the
tables are opened.

A save replaces `tables.json` last (see `writing.write_together`). Its `files` are the tables of the save;
without them, all tables in the folder belong to the mesh. `replaces` is the checksum of the older
`tables.json`: so the content differs from save to save. `planes` is true if the three files of planes exist,
false if polygons share no planes, and null if planes are to be computed when the mesh is opened:

    {"format": "autocolor npy tables 2", "part_names": ["hood", "roof"], "crease_angle": 40.0,
     "scalars": [{"name": "stress", "of": "node"}], "planes": null,
     "files": ["nodes.npy", "polygons.npy", "scalars/1.npy"], "replaces": "e3b0c44298fc"}

Measured with `python -m benchmarks mapped_tables`: from opening ten million quads to the first picture 1.24 s
and 168 MB besides the tables; without normals in the folder, opening takes 18 s and 1.4 GB. Conversion takes
17 s and 333 MB, and about 390 bytes a polygon if all polygons lie in one plane.
"""

from __future__ import annotations

import io
import json
import math
import mmap
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Indices, chunks
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE, printable
from autocolor.errors import InputError, MissingInputError, WriteError, reason_of
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, placed
from autocolor.files.reading import (
    SCALARS,
    bounded_json,
    opened,
    read_bytes,
    read_table,
    read_together,
    save_in,
    save_of,
    shown,
    unreadable,
)
from autocolor.files.writing import write_together
from autocolor.immutable import read_only
from autocolor.logs import logger_of, timed
from autocolor.scene.geometry.normals import CREASE_ANGLE, NodeNormals, node_normals
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

# One table. numpy maps it into memory: it is read page by page, and never copied whole. If another program
# shortens the file later, the system ends the process that reads it (SIGBUS): write a new file and rename it.

LARGEST_HEADER: Final = 1024
"""Limit: bytes of the header of a table; numpy writes 128."""

BYTES_OF_ROW: Final = 20
"""Measured: 168 MB to open and render ten million quads. So a sparse file is not read for hours, either."""

ROWS_AT_ONCE: Final = 1 << 16

UNIT: Final = 1e-3
"""Limit: how far the length of a unit vector may be from 1."""


def mapped(path: Path, name: str) -> AnyArray:
    """The table of an .npy file, (rows,) or (rows, columns), mapped and read-only; messages have the `name`.

    Raises MissingInputError if there is no such file, InputError if it is not such a table, or if the budget
    does not allow so many rows.
    """
    with opened(path) as (file, status):
        head = file.read(len(MAGIC))
    try:
        if head != MAGIC:
            raise ValueError("it begins as another file")
        table = np.load(path, mmap_mode="r", allow_pickle=False, max_header_size=LARGEST_HEADER)
        if table.dtype.kind not in "iuf" or table.ndim not in (1, 2):
            raise ValueError(f"its dtype is {table.dtype}, its shape {table.shape}")
    except OSError as error:
        raise unreadable(path, error) from None
    except Exception as error:
        # A wrong header makes numpy raise errors of many kinds.
        raise InputError(
            f"{name}: it must be an .npy file with a table of whole numbers or floating-point numbers, not"
            f" another file ({printable(str(error)[:200])}); write it with numpy.save"
        ) from None
    size = table.offset + table.nbytes
    if status.st_size != size:
        raise InputError(
            f"{name}: a table of shape {table.shape} and type {table.dtype} must have {size:,} bytes, not"
            f" {status.st_size:,}; write it again"
        )
    require_memory(BYTES_OF_ROW * len(table), f"{name}: to render {len(table):,} rows", "divide the mesh")
    return np.asarray(table)


def refuse_rows(name: str, table: AnyArray, thing: str, is_right: Callable[[AnyArray], AnyArray]) -> None:
    """Raise InputError for the first row of a table, (rows,) or (rows, columns), that breaks a rule.

    `thing` is the rule in words. `is_right` takes some rows, (columns, rows), and returns for each number, or
    each row, whether it is right. Rows are counted from 0, as numpy does.
    """
    rows = np.atleast_2d(table.T)
    for chunk in chunks(rows.shape[1], ROWS_AT_ONCE):
        right = np.atleast_2d(is_right(rows[:, chunk])).all(axis=0)
        if not right.all():
            row = chunk.start + int(np.argmin(right))
            raise InputError(
                f"{name}: {thing}, not {table[row].tolist()} (row {row}, counted from 0); correct that row"
            )


def are_unit_vectors(rows: AnyArray) -> AnyArray:
    """Which vectors have the length 1 within UNIT."""
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.sqrt((rows.astype(np.float64) ** 2).sum(axis=0))
    return np.asarray(np.abs(lengths - 1) <= UNIT)


def as_read(name: str, table: AnyArray, dtype: type[Any], width: int) -> AnyArray:
    """The table itself, or a copy in this type and by columns, which the log mentions.

    Of triangles, a copy with the `width` 4 repeats the last column. Raises InputError if the copy is larger
    than the memory budget allows.
    """
    is_narrow = table.ndim > 1 and table.shape[1] < width
    if table.dtype == dtype and table.flags.f_contiguous and not is_narrow:
        return table
    size = len(table) * max(width, 1) * np.dtype(dtype).itemsize
    advice = "write the tables with `autocolor convert FOLDER OUT --to npy`"
    require_memory(size, f"{name}: a copy as {np.dtype(dtype)} by columns", advice)
    order = "columns" if table.flags.f_contiguous else "rows"
    LOG.info("%s: copied, because it is %s %s by %s", name, table.dtype, table.shape, order)
    copy = np.empty((len(table), width) if width else len(table), dtype, order="F")
    copy[..., : table.shape[-1]] = table
    if is_narrow:
        copy[:, -1] = table[:, -1]
    return read_only(copy)


# The notes: names of parts and scalars, crease angle, whether polygons share planes, and the files.

FORMATS: Final = ("autocolor npy tables 2", "autocolor npy tables 1")
"""The formats that are read; the first is written."""

LARGEST_NOTES: Final = 4 << 20
MOST_VALUES: Final = 200_000

NO_NOTES: Final[Mapping[str, Any]] = {
    "part_names": [],
    "crease_angle": CREASE_ANGLE,
    "scalars": [],
    "planes": None,
    "files": None,
}


def notes_of(data: bytes) -> Mapping[str, Any]:
    """The notes in the bytes of `tables.json`, all keys of NO_NOTES among them. Raises InputError."""
    try:
        content = bounded_json(data, MOST_VALUES)
        if not isinstance(content, dict) or not content.keys() <= {"format", "replaces", *NO_NOTES}:
            raise ValueError(
                f"it must be a table with no other keys than format, replaces, {', '.join(NO_NOTES)}"
            )
        notes = {"format": None, **NO_NOTES, **content}
        scalars, angle = notes["scalars"], notes["crease_angle"]
        rules = {
            "format": (notes["format"] in FORMATS, repr(FORMATS[0])),
            "part_names": (_are_names(notes["part_names"]), "different names, one for each part"),
            "crease_angle": (type(angle) in (int, float) and 0 <= angle <= 180, "a number from 0 to 180"),
            "scalars": (
                isinstance(scalars, list) and len(scalars) <= MOST_SCALARS and all(map(_is_scalar, scalars)),
                f"at most {MOST_SCALARS} names, each of 'node' or 'polygon'",
            ),
            "planes": (notes["planes"] in (None, True, False), "true, false or null"),
            "files": (notes["files"] is None or _are_names(notes["files"]), "the names of the tables"),
        }
        for key, (is_right, rule) in rules.items():
            if not is_right:
                raise ValueError(f"{key} must be {rule}, not {shown(str(notes[key]))}")
    except ValueError as error:
        raise InputError(f"{NOTES}: {str(error)[:200]}; convert the mesh again, or correct it") from None
    return notes


def _are_names(names: object) -> bool:
    if not isinstance(names, list) or not all(isinstance(name, str) and name for name in names):
        return False
    return len({*names}) == len(names)


def _is_scalar(row: object) -> bool:
    if not isinstance(row, dict) or row.keys() != {"name", "of"}:
        return False
    return isinstance(row["name"], str) and row["name"] != "" and row["of"] in (NODE, POLYGON)


# The mesh of a folder.

MOST_PARTS: Final = 1 << 16
"""Limit: parts in a folder that does not name its parts."""

VALUES: Final = "values"
"""The numbers of a scalar, in messages; a NaN among them is a missing value."""

Tables = Mapping[str, tuple[str, AnyArray]]
"""The mapped tables of a mesh by their usual names: the name of the file, and the table."""


def read_npy_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of .npy tables. The tables beside `nodes.npy` and `polygons.npy` in their folder are read too.

    Raises InputError that names table, row and remedy.
    """
    has_plain_nodes = placement.up == "z" and placement.scale == 1
    tables, notes = read_together(
        nodes.with_name(NOTES), lambda: _opened(nodes, polygons, placement.crease_angle, has_plain_nodes)
    )
    coordinates = _table(tables, NODES, "coordinates", None, (3,), np.float64)
    corners = _table(tables, POLYGONS, "node numbers", None, (4, 3), np.intp, 0, len(coordinates) - 1)
    count = len(corners)
    if not has_plain_nodes:
        coordinates = np.asfortranarray(placed(coordinates.copy(order="F"), placement))
        if not np.abs(coordinates).max(initial=0) <= LARGEST_COORDINATE:
            raise InputError(
                f"{NODES}: scaled coordinates must be at most 1e30 in size; give a smaller scale"
            )
        read_only(coordinates)
    # Part 0 for all polygons takes the memory of one number.
    part_numbers: Indices = np.broadcast_to(np.zeros(1, np.intp), count)
    names = tuple(notes["part_names"])
    if PARTS in tables:
        last = (len(names) or MOST_PARTS) - 1
        part_numbers = _table(tables, PARTS, "part numbers", count, (0,), np.intp, 0, last)
        names = names or tuple(f"part {number}" for number in range(int(part_numbers.max(initial=0)) + 1))
    planes: Any = ...
    if notes["planes"] is not None and has_plain_nodes:
        planes = _planes(tables, count) if notes["planes"] else None
    rows = {NODE: len(coordinates), POLYGON: count}
    scalars = tuple(
        MeshScalar(row["name"], _table(tables, name, VALUES, rows[row["of"]], (0,), np.float64), row["of"])
        for name, row in ((_scalar_name(number), row) for number, row in enumerate(notes["scalars"], 1))
    )
    angle = notes["crease_angle"] if placement.crease_angle is None else placement.crease_angle
    mesh = Mesh.of_tables(
        coordinates,
        corners,
        part_numbers,
        names or (PART,),
        float(angle),
        scalars,
        normals=_normals(tables, count),
        shared_planes=planes,
    )
    return MeshReport(mesh)


def _opened(
    nodes: Path, polygons: Path, crease_angle: float | None, has_plain_nodes: bool
) -> tuple[Tables, Mapping[str, Any]]:
    """The tables to use, and the notes. Only headers are checked. Raises InputError."""
    folder, notes, data = nodes.parent, NO_NOTES, b""
    if (nodes, polygons) != (folder / NODES, folder / POLYGONS):
        files = {NODES: nodes, POLYGONS: polygons}
        return {name: (path.name, mapped(path, path.name)) for name, path in files.items()}, notes
    if os.path.exists(folder / NOTES):
        data = read_bytes(folder / NOTES, LARGEST_NOTES)
        notes = notes_of(data)

    def table(name: str) -> tuple[str, AnyArray]:
        return name, read_table(folder / name, save_of(data), partial(mapped, name=name))

    listed, has_planes = notes["files"], notes["planes"] and has_plain_nodes
    names = [NODES, POLYGONS, *map(_scalar_name, range(1, len(notes["scalars"]) + 1))]
    names += [PLANES, PLANE_NUMBERS, PLANE_SIDES] if has_planes else []
    names += [PARTS] if listed is not None and PARTS in listed else []
    tables = {name: table(name) for name in names}
    if listed is None:
        with suppress(MissingInputError):
            tables[PARTS] = table(PARTS)
    if has_plain_nodes and crease_angle in (None, notes["crease_angle"]):
        with suppress(MissingInputError):
            tables[NORMALS] = table(NORMALS)
    if NORMALS in tables:
        tables[NORMAL_NUMBERS] = table(NORMAL_NUMBERS)
    return tables, notes


def _scalar_name(number: int) -> str:
    return f"{SCALARS}/{number}.npy"


def _table(
    tables: Tables,
    name: str,
    what: str,
    rows: int | None,
    widths: tuple[int, ...],
    dtype: type[Any],
    low: float = -LARGEST_COORDINATE,
    high: float = LARGEST_COORDINATE,
) -> AnyArray:
    """The table of a file, of the first of the widths, with numbers from `low` to `high`.

    A table (rows,) has the width 0. Messages call the numbers `what`; VALUES may be NaN. Raises InputError.
    """
    file, table = tables[name]
    width = table.shape[1] if table.ndim > 1 else 0
    if width not in widths or rows not in (None, len(table)):
        count = "rows" if rows is None else str(rows)
        shapes = " or ".join(f"({count}, {each})" if each else f"({count},)" for each in widths)
        raise InputError(f"{file}: the shape of {what} must be {shapes}, not {table.shape}; write it again")
    if np.issubdtype(dtype, np.integer) and table.dtype.kind not in "iu":
        raise InputError(f"{file}: {what} must be whole numbers, not {table.dtype}; convert them")

    def is_right(numbers: AnyArray) -> AnyArray:
        # In half precision, 1e30 is infinite. Whole numbers are compared exactly.
        numbers = numbers.astype(np.float64, copy=False) if numbers.dtype.kind == "f" else numbers
        # The usual case takes two thirds of the time.
        if numbers.min() >= low and numbers.max() <= high:
            return np.asarray(True)
        right = (numbers >= low) & (numbers <= high)
        return right | np.isnan(numbers) if what == VALUES else right

    refuse_rows(file, table, f"{what} must be from {low} to {high}", is_right)
    return as_read(file, table, dtype, widths[0])


def _normals(tables: Tables, polygons: int) -> NodeNormals | None:
    """The normals of the files; None if there are none."""
    if NORMALS not in tables:
        return None
    vectors = _table(tables, NORMALS, "normals", None, (3,), np.float32)
    refuse_rows(NORMALS, vectors, "a normal must be a unit vector", are_unit_vectors)
    last = len(vectors) - 1
    numbers = _table(tables, NORMAL_NUMBERS, "normal numbers", polygons, (4,), np.intp, 0, last)
    return NodeNormals(vectors, numbers)


def _planes(tables: Tables, polygons: int) -> SharedPlanes:
    """The planes of the files that the notes promise."""
    planes = _table(tables, PLANES, "numbers of planes", None, (7,), np.float64)
    refuse_rows(PLANES, planes[:, :3], "the normal of a plane must be a unit vector", are_unit_vectors)
    last = len(planes) - 1
    numbers = _table(tables, PLANE_NUMBERS, "plane numbers", polygons, (0,), np.intp, -1, last)
    sides = _table(tables, PLANE_SIDES, "sides", polygons, (0,), np.uint8, 0, 1)
    columns = np.ascontiguousarray(planes.T)
    return SharedPlanes(columns[:3], columns[3:6], columns[6], numbers, sides.view(np.bool_))


# Writing goes in chunks: no table is copied whole.

NUMBERS_AT_ONCE: Final = 1 << 17

LARGE: Final = 1 << 21
"""From this many polygons on, normals are computed in files: they take 160 bytes a polygon."""

OTHERS: Final = (
    *(PARTS, PLANES, PLANE_NUMBERS, PLANE_SIDES, NORMALS, NORMAL_NUMBERS),
    *map(_scalar_name, range(1, MOST_SCALARS + 1)),
)
"""The names of tables that a mesh may lack: those of an older mesh are removed."""


def write_npy_tables(folder: Path, mesh: Mesh, *, overwrite: bool = False) -> list[Path]:
    """Write a mesh as tables to a folder, with its normals and planes, in the order that rendering reads.

    Returns the paths of the tables. Raises OutputError if a file is there already and `overwrite` is false,
    WriteError if writing fails.
    """
    with timed(LOG, f"write tables, {len(mesh.node_numbers):,} polygons"):
        return write_together(folder, _files(folder, mesh), others=OTHERS, overwrite=overwrite)


def _files(folder: Path, mesh: Mesh) -> Iterator[tuple[str, Iterable[bytes]]]:
    """The files of a mesh and their content; each is computed when it is written."""
    names = []
    for name, table in _named_tables(folder, mesh):
        names.append(name)
        yield name, _pieces(table)
    notes = {
        "format": FORMATS[0],
        "part_names": mesh.part_names,
        "crease_angle": mesh.crease_angle,
        "scalars": [{"name": scalar.name, "of": scalar.of} for scalar in mesh.scalars],
        "planes": mesh.shared_planes is not None,
        "files": names,
        "replaces": save_in(folder / NOTES),
    }
    yield NOTES, [(json.dumps(notes, indent=1, allow_nan=False) + "\n").encode()]


def _named_tables(folder: Path, mesh: Mesh) -> Iterator[tuple[str, AnyArray]]:
    """The names of the files and their tables, (rows,) or (rows, columns)."""
    yield NODES, mesh.coordinates
    yield POLYGONS, mesh.node_numbers
    yield PARTS, mesh.part_numbers
    for number, scalar in enumerate(mesh.scalars, 1):
        yield _scalar_name(number), scalar.values
    planes = mesh.shared_planes
    if planes is not None:
        yield PLANES, np.concatenate([planes.normals, planes.points, planes.distances[None]]).T
        yield PLANE_NUMBERS, planes.plane_of_polygon
        yield PLANE_SIDES, planes.turned.view(np.uint8)
    normals = _normals_of(folder, mesh)
    yield NORMAL_NUMBERS, normals.numbers
    yield NORMALS, normals.vectors


def _normals_of(folder: Path, mesh: Mesh) -> NodeNormals:
    """The normals of a mesh; for a large mesh they are computed in nameless files."""
    if len(mesh.node_numbers) < LARGE or "normals" in vars(mesh) or not hasattr(os, "posix_fallocate"):
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
    """A working array in a nameless file in a folder; the file is gone with the array.

    All room is reserved at once, since a lack of room could not be reported later. Raises WriteError.
    """
    size = max(math.prod(shape) * np.dtype(dtype).itemsize, 1)
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            os.posix_fallocate(file.fileno(), 0, size)
            pages = mmap.mmap(file.fileno(), size)
    except OSError as error:
        raise WriteError(f"{folder}: there must be room to work in ({reason_of(error)}); make some") from None
    return np.ndarray(shape, dtype, pages)


def _pieces(table: AnyArray) -> Iterable[bytes]:
    """The bytes of the .npy file of a table that is stored by columns, column after column."""
    header = io.BytesIO()
    described = {"descr": table.dtype.str, "fortran_order": table.ndim > 1, "shape": table.shape}
    np.lib.format.write_array_header_1_0(header, described)
    yield header.getvalue()
    for row in np.atleast_2d(table.T):
        for chunk in chunks(len(row), NUMBERS_AT_ONCE):
            yield row[chunk].tobytes()
