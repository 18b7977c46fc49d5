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
| `tables.json` | | | names of parts and scalars, crease angle |

All are stored by columns (Fortran order), so that `.T` is contiguous, in the byte order of the machine. Only
the first two are needed. Tables of other types, orders and shapes that numpy saves are read, too: triangles
alone as (polygons, 3), float32, int32, rows; these are copied, and the log says so. Nodes that are turned
(`up`) or scaled are copied. Normals and planes are used where the nodes are as in the file and the crease
angle is the file's; otherwise they are computed. If you change nodes or polygons, delete the files of normals
and planes, or convert the folder again. Nothing is ever repaired.

All numbers are checked once when the tables are opened, a few pages at a time.
"""

from __future__ import annotations

import json
import math
import mmap
import os
import re
import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple, NoReturn

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, chunks
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError, OutputError, WriteError, reason_of
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, placed
from autocolor.files.reading import bounded_json, opened, read_bytes, shown
from autocolor.files.writing import write_together
from autocolor.immutable import read_only
from autocolor.logs import logger_of, timed
from autocolor.scene.columns import Problem
from autocolor.scene.geometry.normals import CREASE_ANGLE, NodeNormals, node_normals
from autocolor.scene.geometry.planes import SharedPlanes
from autocolor.scene.mesh import CREASE_ANGLES, PART, Mesh
from autocolor.scene.scalar import LARGEST_SCALAR, MOST_SCALARS, NODE, POLYGON, MeshScalar

# Tables are checked in chunks, and converted where rendering does not read them as they are. Rows are counted
# from 0, as numpy does.

LOG: Final = logger_of(__name__)

ROWS_AT_ONCE: Final = 1 << 16

UNIT: Final = 1e-3
"""Limit: how far the length of a unit vector may be from 1."""

Rule = Callable[[AnyArray], Booleans]
"""Which of some rows, (columns, rows), are right."""


def checked(name: str, table: AnyArray, thing: str, rule: Rule, remedy: str) -> None:
    """Raise InputError for the first row of a table, (rows,) or (rows, columns), that is not right.

    `thing` says what must be, in the words of the refusal.
    """
    rows = table.T if table.ndim > 1 else table[None]
    for chunk in chunks(rows.shape[1], ROWS_AT_ONCE):
        right = rule(rows[:, chunk])
        if not right.all():
            row = chunk.start + int(np.argmin(right))
            numbers = table[row].tolist()
            raise InputError(f"{name}: {thing}, not {numbers} (row {row}, counted from 0); {remedy}")


def is_shaped(name: str, table: AnyArray, what: str, rows: int | None, widths: tuple[int, ...]) -> None:
    """Raise InputError unless a table has this many rows and one of the widths; (rows,) has the width 0."""
    width = table.shape[1] if table.ndim > 1 else 0
    if width in widths and rows in (None, len(table)):
        return
    count = "rows" if rows is None else str(rows)
    shapes = " or ".join(f"({count}, {width})" if width else f"({count},)" for width in widths)
    raise InputError(f"{name}: the shape of {what} must be {shapes}, not {table.shape}; write it again")


def is_of(name: str, table: AnyArray, what: str, kinds: str) -> None:
    """Raise InputError unless the numbers are whole ("iu"), or of any kind ("iuf")."""
    if table.dtype.kind not in kinds:
        rule = "whole numbers" if kinds == "iu" else "numbers"
        raise InputError(f"{name}: {what} must be {rule}, not {table.dtype}; convert them")


def within(count: int) -> Rule:
    """The rule that all are from 0 to below `count`; numbers of any integer type are compared exactly."""

    def rule(rows: AnyArray) -> Booleans:
        right: Booleans = np.asarray(((rows >= 0) & (rows < count)).all(axis=0))
        return right

    return rule


def are_coordinates(rows: AnyArray) -> Booleans:
    """Which rows are finite and at most 1e30 in size."""
    # The largest is infinite in half precision.
    numbers = rows.astype(np.float32) if rows.dtype.newbyteorder("=") == np.float16 else rows
    right: Booleans = np.asarray((np.abs(numbers) <= LARGEST_COORDINATE).all(axis=0))
    return right


def are_unit_vectors(rows: AnyArray) -> Booleans:
    """Which rows, each a vector, have the length 1 within `UNIT`."""
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.sqrt((rows.astype(np.float64) ** 2).sum(axis=0))
    right: Booleans = np.abs(lengths - 1) <= UNIT
    return right


def as_read(name: str, table: AnyArray, dtype: type[Any]) -> AnyArray:
    """The table itself, or its copy in this type and by columns; the log tells of a copy."""
    rows = table.T
    if table.dtype == dtype and rows.flags.c_contiguous and rows.flags.aligned:
        return table
    LOG.info(
        "%s: copied, for it is not %s stored by columns, but %s stored %s",
        name,
        np.dtype(dtype),
        table.dtype,
        "by columns" if rows.flags.c_contiguous else "by rows",
    )
    copy = np.empty(rows.shape, dtype)
    for chunk in chunks(rows.shape[-1], ROWS_AT_ONCE):
        copy[..., chunk] = rows[..., chunk]
    return read_only(copy).T


# A .npy file is mapped into memory: read page by page, and never copied whole. The header is matched, never
# evaluated. The size of the file is compared with its header before it is mapped. If another program cuts off
# the file later, the system ends the process that reads it (SIGBUS). So write such files anew, and rename
# them.

MOST_ROWS: Final = 200_000_000
"""Limit: rows of a table, so that looking at all of them takes seconds."""

LARGEST_HEADER: Final = 1024
"""Bytes; numpy writes 128 for a table."""

MAGIC: Final = b"\x93NUMPY"

HEADER: Final = re.compile(
    rb"\{'descr': '([<>|](?:f[248]|[iu][1248]))', 'fortran_order': (True|False),"
    rb" 'shape': \((\d{1,12}), ?(\d{1,2})?\), \} *\n"
)
"""The header exactly as numpy writes that of a table of numbers."""


class NpyHeader(NamedTuple):
    """What the header of a file says, and where the numbers begin.

    `shape` is (rows,) or (rows, columns); `by_columns` tells that the numbers of a column follow each other.
    """

    dtype: np.dtype[np.generic]
    by_columns: bool
    shape: tuple[int, ...]
    start: int

    @property
    def size(self) -> int:
        """How many bytes the file must have."""
        return self.start + math.prod(self.shape) * self.dtype.itemsize


def parsed_header(name: str, head: bytes) -> NpyHeader:
    """The header at the beginning of a file of this name. Raises InputError."""
    width = {b"\x01\x00": 2, b"\x02\x00": 4}.get(head[6:8], 0)
    start = 8 + width + int.from_bytes(head[8 : 8 + width], "little")
    described = HEADER.fullmatch(head[8 + width : start]) if start <= LARGEST_HEADER else None
    if not head.startswith(MAGIC) or not width or described is None:
        raise InputError(
            f"{name}: it must be an .npy file with a table of whole numbers or floating-point numbers, not"
            f" begin with {shown(head[:80], 80)}; write it with numpy.save"
        )
    shape = tuple(int(count) for count in described.groups()[2:] if count is not None)
    dtype = np.dtype(described[1].decode())
    if shape[0] > MOST_ROWS:
        raise InputError(f"{name}: a table must have at most {MOST_ROWS:,} rows, not {shape[0]:,}; divide it")
    # A table of one row or one column has both orders.
    by_columns = described[2] == b"True" or len(shape) == 1 or min(shape) <= 1
    return NpyHeader(dtype, by_columns, shape, start)


def mapped(path: Path) -> AnyArray:
    """The table of an .npy file, (rows,) or (rows, columns), mapped and read-only.

    Raises MissingInputError if there is no such file, InputError if it is not such a table.
    """
    with opened(path) as (file, status):
        header = parsed_header(path.name, file.read(LARGEST_HEADER))
        if status.st_size != header.size:
            raise InputError(
                f"{path.name}: a table of shape {header.shape} and type {header.dtype} must have"
                f" {header.size:,} bytes, not {status.st_size:,}; write it again"
            )
        try:
            pages = mmap.mmap(file.fileno(), header.size, access=mmap.ACCESS_READ)
        except ValueError as error:
            # Another program cut it off meanwhile.
            raise InputError(f"{path.name}: a table must stay whole ({error}); write it again") from None
    numbers: AnyArray = np.frombuffer(pages, header.dtype, math.prod(header.shape), header.start)
    return read_only(numbers.reshape(header.shape, order="F" if header.by_columns else "C"))


# The notes beside the tables: names of parts, crease angle, scalars, and whether there are planes.

NOTES: Final = "tables.json"

FORMAT: Final = "autocolor npy tables 1"

LARGEST_NOTES: Final = 4 << 20
MOST_VALUES: Final = 200_000

KEYS: Final = frozenset(("format", "part_names", "crease_angle", "scalars", "planes"))


@dataclass(frozen=True)
class TableNotes:
    """What `tables.json` says.

    `scalars` are pairs of a name and "node" or "polygon", in the order of their files. `planes` is True if
    files have the planes that polygons share, False if no polygons share a plane, None if that is not known.
    """

    part_names: tuple[str, ...]
    crease_angle: float
    scalars: tuple[tuple[str, str], ...] = ()
    planes: bool | None = None


def notes_text(notes: TableNotes) -> bytes:
    """The content of `tables.json`."""
    content = {
        "format": FORMAT,
        "part_names": notes.part_names,
        "crease_angle": notes.crease_angle,
        "scalars": [{"name": name, "of": of} for name, of in notes.scalars],
        "planes": notes.planes,
    }
    return (json.dumps(content, indent=1, allow_nan=False) + "\n").encode()


def read_notes(path: Path) -> TableNotes:
    """The notes of a file. Raises InputError."""
    try:
        content = bounded_json(read_bytes(path, LARGEST_NOTES), MOST_VALUES)
    except ValueError as error:
        _refuse(path, f"it must be JSON of at most {MOST_VALUES:,} values, not wrong ({str(error)[:100]})")
    if not isinstance(content, dict) or set(content) != KEYS or content["format"] != FORMAT:
        _refuse(path, f"its format must be {FORMAT!r}, with the keys {', '.join(sorted(KEYS))}, not another")
    names, scalars = content["part_names"], content["scalars"]
    if not isinstance(names, list) or not all(isinstance(name, str) and name for name in names):
        _refuse(path, "part_names must be strings, one for each part, not others")
    if len(set(names)) != len(names):
        _refuse(path, "part_names must differ, not repeat")
    problems: list[Problem] = []
    angle = CREASE_ANGLES.validated(content["crease_angle"], ("crease_angle",), problems)
    if not isinstance(angle, float):
        _refuse(path, problems[0].sentence.partition(";")[0])
    if not isinstance(scalars, list) or len(scalars) > MOST_SCALARS or not all(map(_is_scalar, scalars)):
        _refuse(
            path, f"scalars must be at most {MOST_SCALARS} names, each of 'node' or 'polygon', not others"
        )
    if not (content["planes"] is None or isinstance(content["planes"], bool)):
        _refuse(path, "planes must be true, false or null, not another")
    return TableNotes(
        tuple(names), angle, tuple((each["name"], each["of"]) for each in scalars), content["planes"]
    )


def _is_scalar(entry: object) -> bool:
    return (
        isinstance(entry, dict)
        and set(entry) == {"name", "of"}
        and isinstance(entry["name"], str)
        and bool(entry["name"])
        and entry["of"] in (NODE, POLYGON)
    )


def _refuse(path: Path, sentence: str) -> NoReturn:
    raise InputError(f"{path.name}: {sentence}; convert the mesh again, or correct it")


NODES: Final = "nodes.npy"
POLYGONS: Final = "polygons.npy"
PARTS: Final = "parts.npy"
NORMALS: Final = "normals.npy"
NORMAL_NUMBERS: Final = "normal_numbers.npy"
PLANES: Final = "planes.npy"
PLANE_NUMBERS: Final = "plane_numbers.npy"
PLANE_SIDES: Final = "plane_sides.npy"
SCALARS: Final = "scalars"

MOST_PARTS: Final = 1 << 16
"""Limit: parts that get names of their own where a folder names none."""

CORRECT: Final = "correct that row"


class MappedTables(NamedTuple):
    """The node table and the polygon table, and how many rows they have."""

    coordinates: Floats
    node_numbers: Indices

    @property
    def node_count(self) -> int:
        """How many nodes there are."""
        return len(self.coordinates)

    @property
    def polygon_count(self) -> int:
        """How many polygons there are."""
        return len(self.node_numbers)


def read_npy_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of .npy tables; those beside `nodes.npy` and `polygons.npy` of one folder belong to it.

    Raises InputError that names table, row and remedy.
    """
    tables = _tables(nodes, polygons)
    folder = nodes.parent
    is_folder = (nodes.name, polygons.name) == (NODES, POLYGONS) and polygons.parent == folder
    notes = read_notes(folder / NOTES) if is_folder and (folder / NOTES).exists() else None
    angle = CREASE_ANGLE if notes is None else notes.crease_angle
    wanted = angle if placement.crease_angle is None else placement.crease_angle
    if not is_folder:
        one_part = _of_one_part(tables.polygon_count)
        return MeshReport(Mesh.of_tables(*_placed(tables, placement), one_part, (PART,), wanted))
    part_numbers, names = _parts(folder, tables.polygon_count, notes)
    is_plain = placement.up == "z" and placement.scale == 1
    normals = _normals(folder, tables.polygon_count) if is_plain and wanted == angle else None
    has_planes = None if notes is None or not is_plain else notes.planes
    planes: Any = ...
    if has_planes is not None:
        planes = _planes(folder, tables.polygon_count) if has_planes else None
    mesh = Mesh.of_tables(
        *_placed(tables, placement),
        part_numbers,
        names,
        wanted,
        () if notes is None else _scalars(folder, notes, tables),
        normals=normals,
        shared_planes=planes,
    )
    return MeshReport(mesh)


def _tables(nodes: Path, polygons: Path) -> MappedTables:
    """The two tables that there must be, checked."""
    coordinates, corners = mapped(nodes), mapped(polygons)
    is_shaped(nodes.name, coordinates, "a node table", None, (3,))
    is_of(nodes.name, coordinates, "coordinates", "iuf")
    checked(
        nodes.name,
        coordinates,
        "coordinates must be finite and at most 1e30 in size",
        are_coordinates,
        CORRECT,
    )
    is_shaped(polygons.name, corners, "a polygon table", None, (4, 3))
    _check_numbers(polygons.name, corners, "node numbers", len(coordinates), "node table")
    if corners.shape[1] == 3:
        LOG.info("%s: copied, for its triangles do not repeat their last node", polygons.name)
        four = np.empty((4, len(corners)), np.intp)
        four[:3] = corners.T
        four[3] = four[2]
        corners = read_only(four).T
    return MappedTables(
        as_read(nodes.name, coordinates, np.float64), as_read(polygons.name, corners, np.intp)
    )


def _check_numbers(name: str, numbers: Indices, what: str, count: int, table: str) -> None:
    """Raise InputError unless all are rows of a table of so many."""
    is_of(name, numbers, what, "iu")
    thing = f"{what} must be rows of the {table} (0 to {count - 1})"
    checked(name, numbers, thing, within(count), CORRECT)


def _placed(tables: MappedTables, placement: Placement) -> MappedTables:
    """The tables with their nodes in the world: copied, and checked again, unless they are there already."""
    if placement.up == "z" and placement.scale == 1:
        return tables
    turned = np.asfortranarray(placed(tables.coordinates.copy(order="F"), placement))
    thing = "scaled coordinates must be at most 1e30 in size"
    checked(NODES, turned, thing, are_coordinates, "give a smaller scale")
    return tables._replace(coordinates=read_only(turned))


def _of_one_part(polygons: int) -> Indices:
    """The part numbers where all are 0, in the memory of one."""
    return np.broadcast_to(np.zeros(1, np.intp), polygons)


def _parts(folder: Path, polygons: int, notes: TableNotes | None) -> tuple[Indices, tuple[str, ...]]:
    """The part of each polygon, and the names of the parts."""
    named = () if notes is None else notes.part_names
    if not (folder / PARTS).exists():
        return _of_one_part(polygons), named or (PART,)
    parts = mapped(folder / PARTS)
    is_shaped(PARTS, parts, "part numbers", polygons, (0,))
    _check_numbers(PARTS, parts, "part numbers", len(named) or MOST_PARTS, "part table")
    count = int(parts.max(initial=0)) + 1
    return as_read(PARTS, parts, np.intp), named or tuple(f"part {number}" for number in range(count))


def _normals(folder: Path, polygons: int) -> NodeNormals | None:
    """The normals of the files; None if there are none."""
    there = [name for name in (NORMALS, NORMAL_NUMBERS) if (folder / name).exists()]
    if not there:
        return None
    if len(there) == 1:
        raise InputError(
            f"{there[0]}: {NORMALS} and {NORMAL_NUMBERS} must be in the folder together; delete it"
        )
    vectors, numbers = mapped(folder / NORMALS), mapped(folder / NORMAL_NUMBERS)
    is_shaped(NORMALS, vectors, "normals", None, (3,))
    is_of(NORMALS, vectors, "normals", "iuf")
    checked(NORMALS, vectors, "a normal must be a unit vector", are_unit_vectors, CORRECT)
    is_shaped(NORMAL_NUMBERS, numbers, "normal numbers", polygons, (4,))
    _check_numbers(NORMAL_NUMBERS, numbers, "normal numbers", len(vectors), "normals")
    return NodeNormals(as_read(NORMALS, vectors, np.float32), as_read(NORMAL_NUMBERS, numbers, np.intp))


def _planes(folder: Path, polygons: int) -> SharedPlanes:
    """The planes of the files that the notes promise."""
    planes, numbers = mapped(folder / PLANES), mapped(folder / PLANE_NUMBERS)
    sides = mapped(folder / PLANE_SIDES)
    is_shaped(PLANES, planes, "planes", None, (7,))
    checked(PLANES, planes, "numbers must be finite and at most 1e30 in size", are_coordinates, CORRECT)
    checked(PLANES, planes[:, :3], "the normal of a plane must be a unit vector", are_unit_vectors, CORRECT)
    is_shaped(PLANE_NUMBERS, numbers, "plane numbers", polygons, (0,))
    is_of(PLANE_NUMBERS, numbers, "plane numbers", "i")
    thing = f"plane numbers must be -1 or rows of the planes (0 to {len(planes) - 1})"
    checked(PLANE_NUMBERS, numbers, thing, lambda row: ((row >= -1) & (row < len(planes)))[0], CORRECT)
    is_shaped(PLANE_SIDES, sides, "sides", polygons, (0,))
    checked(PLANE_SIDES, sides, "a side must be 0 or 1", lambda row: ((row == 0) | (row == 1))[0], CORRECT)
    columns = read_only(np.array(planes.T, np.float64, order="C"))
    return SharedPlanes(
        columns[:3],
        columns[3:6],
        columns[6],
        as_read(PLANE_NUMBERS, numbers, np.intp),
        as_read(PLANE_SIDES, sides, np.uint8).view(np.bool_),
    )


def _scalars(folder: Path, notes: TableNotes, tables: MappedTables) -> tuple[MeshScalar, ...]:
    """The scalars that the notes name."""
    scalars = []
    for number, (name, of) in enumerate(notes.scalars, 1):
        path = folder / SCALARS / f"{number}.npy"
        place, values = f"{SCALARS}/{path.name}", mapped(path)
        is_shaped(
            place,
            values,
            f"a scalar of each {of}",
            tables.node_count if of == NODE else tables.polygon_count,
            (0,),
        )
        is_of(place, values, "values", "iuf")
        checked(
            place,
            values,
            "a value must be at most 1e30 in size, or NaN if it is missing",
            lambda row: (np.isnan(row) | (np.abs(row) <= LARGEST_SCALAR))[0],
            CORRECT,
        )
        scalars.append(MeshScalar(name, as_read(place, values, np.float64), of))
    return tuple(scalars)


# Writing goes in chunks: no table is copied whole. Each file is written beside its place, synced and renamed.
# The notes are renamed last: without them nobody reads normals and planes.

NUMBERS_AT_ONCE: Final = 1 << 17

LARGE: Final = 1 << 21
"""Polygons whose normals are computed in files, for they would take 160 bytes of memory a polygon."""


def write_npy_tables(folder: Path, mesh: Mesh, *, overwrite: bool = False) -> None:
    """Write a mesh as tables to a folder, with its normals and planes, in the order that rendering reads.

    Raises OutputError if a file is there already and `overwrite` is false, WriteError if writing fails.
    """
    if mesh.scalars:
        _make(folder / SCALARS)
    with timed(LOG, f"write tables, {len(mesh.node_numbers):,} polygons"):
        write_together(_files(folder, mesh), overwrite=overwrite, before_names=lambda: _remove_notes(folder))


def _files(folder: Path, mesh: Mesh) -> Iterator[tuple[Path, Iterable[bytes]]]:
    """The files of a mesh and their content; each is computed when it is written."""
    for name, table in _named_tables(folder, mesh):
        yield folder / name, _pieces(table)
    scalars = tuple((scalar.name, scalar.of) for scalar in mesh.scalars)
    notes = TableNotes(mesh.part_names, mesh.crease_angle, scalars, mesh.shared_planes is not None)
    yield folder / NOTES, [notes_text(notes)]


def _named_tables(folder: Path, mesh: Mesh) -> Iterator[tuple[str, AnyArray]]:
    """The names of the files and their tables, (rows,) or (rows, columns)."""
    yield NODES, mesh.coordinates
    yield POLYGONS, mesh.node_numbers
    yield PARTS, mesh.part_numbers
    for number, scalar in enumerate(mesh.scalars, 1):
        yield f"{SCALARS}/{number}.npy", scalar.values
    planes = mesh.shared_planes
    if planes is not None:
        yield PLANES, _plane_rows(planes)
        yield PLANE_NUMBERS, planes.plane_of_polygon
        yield PLANE_SIDES, planes.turned.view(np.uint8)
    normals = _normals_of(folder, mesh)
    yield NORMAL_NUMBERS, normals.numbers
    yield NORMALS, normals.vectors


def _normals_of(folder: Path, mesh: Mesh) -> NodeNormals:
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
    others = (PLANES, PLANE_NUMBERS, PLANE_SIDES, NORMALS, NORMAL_NUMBERS)
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
