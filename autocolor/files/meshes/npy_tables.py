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
the first two are needed. Tables of other types, orders and shapes that numpy saves are read by copying them,
and the log says so: triangles alone as (polygons, 3), float32, int32, tables by rows. If the nodes are turned
(`up`) or scaled, they are copied. Normals and planes are used if the nodes stay as in the file and the crease
angle is the file's; otherwise they are computed. If you change nodes or polygons, delete the files of normals
and planes, or convert the folder again. Nothing is ever repaired.

`tables.json` is as `write_npy_tables` writes it. `planes` is true if the three files of planes exist, false
if polygons share no planes, and null if planes are to be computed when the mesh is opened:

    {"format": "autocolor npy tables 1", "part_names": ["hood", "roof"], "crease_angle": 40.0,
     "scalars": [{"name": "stress", "of": "node"}], "planes": null}

All numbers are checked once when the tables are opened, a few pages at a time.

Measured with `python -m benchmarks mapped_tables`: from opening ten million quads to the first picture 1.24 s
and 168 MB besides the tables; without normals in the folder, opening takes 18 s and 1.4 GB. Conversion takes
17 s and 333 MB, and about 390 bytes a polygon if all polygons lie in one plane.
"""

from __future__ import annotations

import json
import math
import mmap
import os
import re
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple, NoReturn

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Indices, chunks
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError, WriteError, reason_of
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, placed
from autocolor.files.reading import TableFiles, bounded_json, opened, read_bytes, read_together, shown
from autocolor.files.writing import write_together
from autocolor.immutable import read_only
from autocolor.logs import logger_of, timed
from autocolor.scene.columns import Problem
from autocolor.scene.geometry.normals import CREASE_ANGLE, NodeNormals, node_normals
from autocolor.scene.geometry.planes import SharedPlanes
from autocolor.scene.mesh import CREASE_ANGLES, PART, Mesh
from autocolor.scene.scalar import LARGEST_SCALAR, MOST_SCALARS, NODE, POLYGON, MeshScalar

# Tables are checked in chunks, and copied in chunks if rendering needs another type or order. Messages count
# rows from 0, as numpy does.

LOG: Final = logger_of(__name__)

ROWS_AT_ONCE: Final = 1 << 16

UNIT: Final = 1e-3
"""Limit: how far the length of a unit vector may be from 1."""

Rule = Callable[[AnyArray], Booleans]
"""A function from rows, (columns, rows), to whether each row is right."""


def checked(name: str, table: AnyArray, thing: str, rule: Rule, remedy: str) -> None:
    """Raise InputError for the first row of a table, (rows,) or (rows, columns), that breaks a rule.

    `thing` is the rule in words.
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
    """The rule that numbers are from 0 to `count` - 1, compared exactly in any integer type."""

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
    """Which vectors have the length 1 within UNIT."""
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.sqrt((rows.astype(np.float64) ** 2).sum(axis=0))
    right: Booleans = np.abs(lengths - 1) <= UNIT
    return right


LARGE_COPY: Final = 256_000_000
"""Limit: bytes; a larger copy is a warning, which commands print without `-v`."""

REMEDY: Final = (
    "to map the tables, write them with `autocolor convert FOLDER OUT --to npy`, or use"
    " numpy.asfortranarray before numpy.save"
)


def as_read(name: str, table: AnyArray, dtype: type[Any], width: int = 0) -> AnyArray:
    """The table itself, or a copy in this type and by columns, which the log mentions.

    A copy has at least `width` columns: further columns repeat the last. A large copy is a warning. Raises
    InputError if it is larger than the memory budget allows.
    """
    rows = np.atleast_2d(table.T)
    is_narrow = len(rows) < width
    if table.dtype == dtype and rows.flags.c_contiguous and rows.flags.aligned and not is_narrow:
        return table
    reason = f"it is not {np.dtype(dtype)} stored by columns, but {table.dtype} stored by"
    reason += " columns" if rows.flags.c_contiguous else " rows"
    if is_narrow:
        reason = "its triangles do not repeat their last node"
    shape = max(len(rows), width), len(table)
    size = math.prod(shape) * np.dtype(dtype).itemsize
    require_memory(size, f"{name}: its copy, for {reason},", REMEDY)
    if size > LARGE_COPY:
        LOG.warning("%s: copied into %s MB of memory, for %s; %s", name, f"{size / 1e6:,.0f}", reason, REMEDY)
    else:
        LOG.info("%s: copied, for %s", name, reason)
    copy = np.empty(shape, dtype)
    for chunk in chunks(len(table), ROWS_AT_ONCE):
        copy[: len(rows), chunk] = rows[:, chunk]
        copy[len(rows) :, chunk] = rows[-1, chunk]
    return read_only(copy).T if table.ndim > 1 else read_only(copy)[0]


# A .npy file is mapped into memory: read page by page, and never copied whole. The header is matched, never
# evaluated, and the size of the file is compared with it. If another program shortens the file later, the
# system ends the process that reads it (SIGBUS). So write a new file and rename it.

MOST_ROWS: Final = 200_000_000
"""Limit: rows of a table. To check this many takes seconds."""

LARGEST_HEADER: Final = 1024
"""Bytes; numpy writes 128 for a table."""

MAGIC: Final = b"\x93NUMPY"

HEADER: Final = re.compile(
    rb"\{'descr': '([<>|](?:f[248]|[iu][1248]))', 'fortran_order': (True|False),"
    rb" 'shape': \((\d{1,12}), ?(\d{1,2})?\), \} *\n"
)
"""The header of a table of numbers exactly as numpy writes it."""


class NpyHeader(NamedTuple):
    """The header of a file, and the byte where the numbers begin.

    `shape` is (rows,) or (rows, columns). With `by_columns` the numbers of a column follow each other.
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
    """The header at the start of a file with this name. Raises InputError."""
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
    # A table with one row or one column is stored by rows and by columns alike.
    by_columns = described[2] == b"True" or len(shape) == 1 or min(shape) <= 1
    return NpyHeader(dtype, by_columns, shape, start)


def mapped(path: Path, name: str = "") -> AnyArray:
    """The table of an .npy file, (rows,) or (rows, columns), mapped and read-only.

    Messages have the `name`, if it is another than the path's. Raises MissingInputError if there is no such
    file, InputError if it is not such a table.
    """
    name = name or path.name
    with opened(path) as (file, status):
        header = parsed_header(name, file.read(LARGEST_HEADER))
        if status.st_size != header.size:
            raise InputError(
                f"{name}: a table of shape {header.shape} and type {header.dtype} must have"
                f" {header.size:,} bytes, not {status.st_size:,}; write it again"
            )
        try:
            pages = mmap.mmap(file.fileno(), header.size, access=mmap.ACCESS_READ)
        except ValueError as error:
            # Another program shortened the file meanwhile.
            raise InputError(f"{name}: a table must stay whole ({error}); write it again") from None
    numbers: AnyArray = np.frombuffer(pages, header.dtype, math.prod(header.shape), header.start)
    return read_only(numbers.reshape(header.shape, order="F" if header.by_columns else "C"))


# The notes: names of parts and scalars, crease angle, and whether polygons share planes.

NOTES: Final = "tables.json"

FORMAT: Final = "autocolor npy tables 1"

LARGEST_NOTES: Final = 4 << 20
MOST_VALUES: Final = 200_000

KEYS: Final = frozenset(("format", "part_names", "crease_angle", "scalars", "planes"))


@dataclass(frozen=True)
class TableNotes:
    """The content of `tables.json`.

    `scalars` are pairs of a name and "node" or "polygon", in the order of their files. `planes` is True if
    files have the planes that polygons share, False if no polygons share a plane, None if unknown.
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
"""Limit: parts in a folder that does not name its parts."""

FINITE: Final = "coordinates must be finite and at most 1e30 in size"
CORRECT: Final = "correct that row"


def read_npy_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of .npy tables. The tables beside `nodes.npy` and `polygons.npy` in their folder are read too.

    Raises InputError that names table, row and remedy.
    """
    is_plain = placement.up == "z" and placement.scale == 1
    tables, notes, wanted = read_together(
        lambda files: _mapped_tables(files, nodes, polygons, placement.crease_angle, is_plain)
    )
    coordinates = _table(tables, NODES, "coordinates", None, (3,), np.float64, are_coordinates, FINITE)
    corners = _numbers(tables, POLYGONS, "node numbers", None, (4, 3), "node table", len(coordinates))
    count = len(corners)
    if not is_plain:
        coordinates = np.asfortranarray(placed(coordinates.copy(order="F"), placement))
        thing = "scaled coordinates must be at most 1e30 in size"
        checked(NODES, coordinates, thing, are_coordinates, "give a smaller scale")
        read_only(coordinates)
    # Part 0 for all polygons takes the memory of one number.
    part_numbers: Indices = np.broadcast_to(np.zeros(1, np.intp), count)
    names = () if notes is None else notes.part_names
    if PARTS in tables:
        most = len(names) or MOST_PARTS
        part_numbers = _numbers(tables, PARTS, "part numbers", count, (0,), "part table", most)
        names = names or tuple(f"part {number}" for number in range(int(part_numbers.max(initial=0)) + 1))
    planes: Any = ...
    if notes is not None and notes.planes is not None and is_plain:
        planes = _planes(tables, count) if notes.planes else None
    mesh = Mesh.of_tables(
        coordinates,
        corners,
        part_numbers,
        names or (PART,),
        wanted,
        () if notes is None else _scalars(tables, notes, {NODE: len(coordinates), POLYGON: count}),
        normals=_normals(tables, count),
        shared_planes=planes,
    )
    return MeshReport(mesh)


Tables = Mapping[str, tuple[str, AnyArray]]
"""The mapped tables of a folder by their usual names: the name of the file, and the table."""


def _mapped_tables(
    files: TableFiles, nodes: Path, polygons: Path, crease_angle: float | None, is_plain: bool
) -> tuple[Tables, TableNotes | None, float]:
    """The tables to use, the notes if there are any, and the crease angle of the mesh.

    Only headers are checked. Raises InputError.
    """
    folder = nodes.parent
    is_folder = (nodes.name, polygons.name) == (NODES, POLYGONS) and polygons.parent == folder
    has_notes = is_folder and files.has(folder, NOTES)
    notes = read_notes(files.path(folder, NOTES)) if has_notes else None
    angle = CREASE_ANGLE if notes is None else notes.crease_angle
    wanted = angle if crease_angle is None else crease_angle
    names = [PARTS] if is_folder and files.has(folder, PARTS) else []
    if is_folder and is_plain and wanted == angle:
        names += [name for name in (NORMALS, NORMAL_NUMBERS) if files.has(folder, name)]
    if notes is not None:
        names += [PLANES, PLANE_NUMBERS, PLANE_SIDES] if notes.planes and is_plain else []
        names += [_scalar_name(number) for number in range(1, len(notes.scalars) + 1)]
    places = {NODES: (folder, nodes.name), POLYGONS: (polygons.parent, polygons.name)}
    places |= {name: (folder, name) for name in names}
    tables = {key: (name, mapped(files.path(at, name), name)) for key, (at, name) in places.items()}
    return tables, notes, wanted


def _scalar_name(number: int) -> str:
    return f"{SCALARS}/{number}.npy"


def _table(
    tables: Tables,
    name: str,
    what: str,
    rows: int | None,
    widths: tuple[int, ...],
    dtype: type[Any],
    rule: Rule,
    thing: str,
    kinds: str = "iuf",
) -> AnyArray:
    """The checked table of a file, of the first of the widths. Raises InputError.

    `what` names the table, and `thing` the rule, in messages.
    """
    place, table = tables[name]
    is_shaped(place, table, what, rows, widths)
    is_of(place, table, what, kinds)
    checked(place, table, thing, rule, CORRECT)
    return as_read(place, table, dtype, widths[0])


def _numbers(
    tables: Tables, name: str, what: str, rows: int | None, widths: tuple[int, ...], target: str, count: int
) -> Indices:
    """The checked numbers in a file, each a row of another table, `target`, of `count` rows."""
    thing = f"{what} must be rows of the {target} (0 to {count - 1})"
    return _table(tables, name, what, rows, widths, np.intp, within(count), thing, "iu")


def _normals(tables: Tables, polygons: int) -> NodeNormals | None:
    """The normals of the files; None if there are none."""
    names = [name for name in (NORMALS, NORMAL_NUMBERS) if name in tables]
    if not names:
        return None
    if len(names) == 1:
        raise InputError(
            f"{names[0]}: {NORMALS} and {NORMAL_NUMBERS} must be in the folder together; delete it"
        )
    thing = "a normal must be a unit vector"
    vectors = _table(tables, NORMALS, "normals", None, (3,), np.float32, are_unit_vectors, thing)
    numbers = _numbers(tables, NORMAL_NUMBERS, "normal numbers", polygons, (4,), "normals", len(vectors))
    return NodeNormals(vectors, numbers)


def _planes(tables: Tables, polygons: int) -> SharedPlanes:
    """The planes of the files that the notes promise."""
    thing = "numbers must be finite and at most 1e30 in size"
    planes = _table(tables, PLANES, "planes", None, (7,), np.float64, are_coordinates, thing)
    checked(PLANES, planes[:, :3], "the normal of a plane must be a unit vector", are_unit_vectors, CORRECT)
    columns = np.ascontiguousarray(planes.T)
    numbers = _table(
        tables,
        PLANE_NUMBERS,
        "plane numbers",
        polygons,
        (0,),
        np.intp,
        lambda row: ((row >= -1) & (row < len(planes)))[0],
        f"plane numbers must be -1 or rows of the planes (0 to {len(planes) - 1})",
        "i",
    )
    sides = _table(
        tables,
        PLANE_SIDES,
        "sides",
        polygons,
        (0,),
        np.uint8,
        lambda row: ((row == 0) | (row == 1))[0],
        "a side must be 0 or 1",
    )
    return SharedPlanes(columns[:3], columns[3:6], columns[6], numbers, sides.view(np.bool_))


def _scalars(tables: Tables, notes: TableNotes, counts: Mapping[str, int]) -> tuple[MeshScalar, ...]:
    """The scalars that the notes name, for this many nodes and polygons."""
    return tuple(
        MeshScalar(
            name,
            _table(
                tables,
                _scalar_name(number),
                f"a scalar of each {of}",
                counts[of],
                (0,),
                np.float64,
                lambda row: (np.isnan(row) | (np.abs(row) <= LARGEST_SCALAR))[0],
                "a value must be at most 1e30 in size, or NaN if it is missing",
            ),
            of,
        )
        for number, (name, of) in enumerate(notes.scalars, 1)
    )


# Writing goes in chunks: no table is copied whole.

NUMBERS_AT_ONCE: Final = 1 << 17

LARGE: Final = 1 << 21
"""From this many polygons on, normals are computed in files: they take 160 bytes a polygon."""


OTHERS: Final = (
    *(NOTES, PARTS, PLANES, PLANE_NUMBERS, PLANE_SIDES, NORMALS, NORMAL_NUMBERS),
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
    for name, table in _named_tables(folder, mesh):
        yield name, _pieces(table)
    scalars = tuple((scalar.name, scalar.of) for scalar in mesh.scalars)
    notes = TableNotes(mesh.part_names, mesh.crease_angle, scalars, mesh.shared_planes is not None)
    yield NOTES, [notes_text(notes)]


def _named_tables(folder: Path, mesh: Mesh) -> Iterator[tuple[str, AnyArray]]:
    """The names of the files and their tables, (rows,) or (rows, columns)."""
    yield NODES, mesh.coordinates
    yield POLYGONS, mesh.node_numbers
    yield PARTS, mesh.part_numbers
    for number, scalar in enumerate(mesh.scalars, 1):
        yield _scalar_name(number), scalar.values
    planes = mesh.shared_planes
    if planes is not None:
        yield PLANES, _plane_rows(planes)
        yield PLANE_NUMBERS, planes.plane_of_polygon
        yield PLANE_SIDES, planes.turned.view(np.uint8)
    normals = _normals_of(folder, mesh)
    yield NORMAL_NUMBERS, normals.numbers
    yield NORMALS, normals.vectors


def _normals_of(folder: Path, mesh: Mesh) -> NodeNormals:
    """The normals of a mesh; for a large mesh they are computed in nameless files."""
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
    """A working array in a nameless file in a folder; the file is gone with the array.

    All room is reserved at once, since a lack of room could not be reported later. Raises WriteError.
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
