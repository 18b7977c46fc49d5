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
the first two are needed. Tables of other types, orders and shapes that numpy saves are copied: triangles
alone as (polygons, 3), float32, int32, tables by rows. If the nodes are turned (`up`) or scaled, they are
copied. Normals and planes are used if the nodes stay as in the file and the crease angle is the file's;
otherwise they are computed. If you change nodes or polygons, delete the normals and `tables.json`, or convert
the folder again. Nothing is ever repaired. All numbers are checked once, when the tables are opened.

A save replaces all tables at once (see `writing.write_together`). The `files` of `tables.json` are its
tables; without them, all tables in the folder belong to the mesh. `planes` is true if the three files of
planes exist, false if polygons share no planes, and null if planes are to be computed:

    {"format": "autocolor npy tables 2", "part_names": ["hood", "roof"], "crease_angle": 40.0,
     "scalars": [{"name": "stress", "of": "node"}], "planes": null,
     "files": ["nodes.npy", "polygons.npy", "scalars/1.npy"]}

Measured with `python -m benchmarks mapped_tables`: from opening ten million quads to the first picture 1.24 s
and 168 MB besides the tables; without normals in the folder, opening takes 18 s and 1.4 GB.
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Indices, chunks
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE, printable
from autocolor.errors import InputError
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, placed
from autocolor.files.reading import bounded_json, opened, read_bytes, shown, unreadable
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

# One table. numpy maps it into memory: it is read page by page, and never copied whole. If another program
# shortens the file later, the system ends the process that reads it (SIGBUS): write a new file and rename it.

LARGEST_HEADER: Final = 1024
"""Limit: bytes of the header of a table; numpy writes 128."""

BYTES_OF_ROW: Final = 20
"""Measured: 168 MB to open and render ten million quads. So a sparse file is not read for hours, either."""

ROWS_AT_ONCE: Final = 1 << 14

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
        if status.st_size != table.offset + table.nbytes:
            raise ValueError(f"it has {status.st_size:,} bytes, not {table.offset + table.nbytes:,}")
    except OSError as error:
        raise unreadable(path, error) from None
    except Exception as error:
        # A wrong header makes numpy raise errors of many kinds.
        raise InputError(
            f"{name}: it must be an .npy file with a table of whole numbers or floating-point numbers, not"
            f" another file ({printable(str(error)[:200])}); write it with numpy.save"
        ) from None
    require_memory(BYTES_OF_ROW * len(table), f"{name}: to render {len(table):,} rows", "divide the mesh")
    return np.asarray(table)


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
        if not isinstance(content, dict) or content.get("format") not in FORMATS:
            raise ValueError(f"its format must be {FORMATS[0]!r}")
        notes = {**NO_NOTES, **content}
        scalars, angle = notes["scalars"], notes["crease_angle"]
        is_right = {
            "format": True,
            "part_names": _are_names(notes["part_names"]),
            "crease_angle": type(angle) in (int, float) and 0 <= angle <= 180,
            "scalars": isinstance(scalars, list)
            and len(scalars) <= MOST_SCALARS
            and all(map(_is_scalar, scalars)),
            "planes": notes["planes"] in (None, True, False),
            "files": notes["files"] is None or _are_names(notes["files"]),
            # Older tables have it.
            "replaces": True,
        }
        for key, value in content.items():
            if not is_right.get(key):
                raise ValueError(f"{shown(key)} must be as a conversion writes it, not {shown(str(value))}")
    except ValueError as error:
        raise InputError(f"{NOTES}: {str(error)[:200]}; convert the mesh again, or correct it") from None
    return notes


def _are_names(names: object) -> bool:
    if not isinstance(names, list) or not all(isinstance(name, str) and name for name in names):
        return False
    return len({*names}) == len(names)


def _is_scalar(row: object) -> bool:
    return (
        isinstance(row, dict)
        and row.keys() == {"name", "of"}
        and _are_names([row["name"]])
        and row["of"] in (NODE, POLYGON)
    )


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
    tables, notes = read_together(nodes.parent, NOTES, lambda: _opened(nodes, polygons))
    angle = notes["crease_angle"] if placement.crease_angle is None else placement.crease_angle
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
    normals = None
    if NORMALS in tables and has_plain_nodes and angle == notes["crease_angle"]:
        normals = _normals(tables, count)
    rows = {NODE: len(coordinates), POLYGON: count}
    scalars = tuple(
        MeshScalar(row["name"], _table(tables, name, VALUES, rows[row["of"]], (0,), np.float64), row["of"])
        for name, row in zip(map(_scalar_name, range(1, MOST_SCALARS + 1)), notes["scalars"], strict=False)
    )
    return MeshReport(
        Mesh.of_tables(
            coordinates,
            corners,
            part_numbers,
            names or (PART,),
            float(angle),
            scalars,
            normals=normals,
            shared_planes=planes,
        )
    )


def _opened(nodes: Path, polygons: Path) -> tuple[Tables, Mapping[str, Any]]:
    """All tables of the mesh, and the notes. Only headers are checked. Raises InputError."""
    folder, notes = nodes.parent, NO_NOTES
    if (nodes, polygons) != (folder / NODES, folder / POLYGONS):
        files = {NODES: nodes, POLYGONS: polygons}
        return {name: (path.name, mapped(path, path.name)) for name, path in files.items()}, notes
    if table_exists(folder, NOTES):
        notes = notes_of(read_table(folder, NOTES, partial(read_bytes, largest=LARGEST_NOTES)))
    listed = notes["files"]
    names = [NODES, POLYGONS, *map(_scalar_name, range(1, len(notes["scalars"]) + 1))]
    names += [PLANES, PLANE_NUMBERS, PLANE_SIDES] if notes["planes"] else []
    if PARTS in (listed or ()) or (listed is None and table_exists(folder, PARTS)):
        names.append(PARTS)
    # They may have been deleted, to be computed.
    if table_exists(folder, NORMALS):
        names += [NORMALS, NORMAL_NUMBERS]
    return {name: (name, read_table(folder, name, partial(mapped, name=name))) for name in names}, notes


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
    is_unit: bool = False,
) -> AnyArray:
    """The table of a file, of the first of the widths, with numbers from `low` to `high`.

    It is copied if it has another type or order. A table (rows,) has the width 0. Messages call the numbers
    `what`; VALUES may be NaN. With `is_unit`, the first three columns are unit vectors. Raises InputError,
    which counts rows from 0, as numpy does.
    """
    file, table = tables[name]
    width = table.shape[1] if table.ndim > 1 else 0
    if width not in widths or rows not in (None, len(table)):
        count = "rows" if rows is None else str(rows)
        shapes = " or ".join(f"({count}, {each})" if each else f"({count},)" for each in widths)
        raise InputError(f"{file}: the shape of {what} must be {shapes}, not {table.shape}; write it again")
    if np.issubdtype(dtype, np.integer) and table.dtype.kind not in "iu":
        raise InputError(f"{file}: {what} must be whole numbers, not {table.dtype}; convert them")
    columns = np.atleast_2d(table.T)
    for chunk in chunks(len(table), ROWS_AT_ONCE):
        numbers = columns[:, chunk]
        # In half precision, 1e30 is infinite. Whole numbers are compared exactly.
        numbers = numbers.astype(np.float64) if numbers.itemsize < 4 else numbers
        units: AnyArray = np.asarray(True)
        if is_unit:
            squares = np.einsum("ij,ij->j", numbers[:3], numbers[:3], dtype=np.float64)
            units = np.abs(squares - 1) <= 2 * UNIT
        # The usual case takes two thirds of the time.
        if numbers.min() >= low and numbers.max() <= high and units.all():
            continue
        right = (numbers >= low) & (numbers <= high) & units
        if what == VALUES:
            right |= np.isnan(numbers)
        if not right.all():
            row = chunk.start + int(np.argmin(right.all(axis=0)))
            rule = f"from {low} to {high}{', with normals of the length 1' if is_unit else ''}"
            raise InputError(
                f"{file}: {what} must be {rule}, not {table[row].tolist()} (row {row}, counted from 0);"
                " correct that row"
            )
    if table.dtype == dtype and table.flags.f_contiguous and width == widths[0]:
        return table
    size = len(table) * max(widths[0], 1) * np.dtype(dtype).itemsize
    advice = "write the tables with `autocolor convert FOLDER OUT --to npy`"
    require_memory(size, f"{file}: a copy as {np.dtype(dtype)} by columns", advice)
    # A triangle repeats its last corner.
    table = np.column_stack([table, table[:, -1]]) if width < widths[0] else table
    return read_only(np.asarray(table, dtype, order="F"))


def _normals(tables: Tables, polygons: int) -> NodeNormals:
    """The normals of the files."""
    vectors = _table(tables, NORMALS, "numbers of normals", None, (3,), np.float32, is_unit=True)
    last = len(vectors) - 1
    numbers = _table(tables, NORMAL_NUMBERS, "normal numbers", polygons, (4,), np.intp, 0, last)
    return NodeNormals(vectors, numbers)


def _planes(tables: Tables, polygons: int) -> SharedPlanes:
    """The planes of the files that the notes promise."""
    planes = _table(tables, PLANES, "numbers of planes", None, (7,), np.float64, is_unit=True)
    last = len(planes) - 1
    numbers = _table(tables, PLANE_NUMBERS, "plane numbers", polygons, (0,), np.intp, -1, last)
    sides = _table(tables, PLANE_SIDES, "sides", polygons, (0,), np.uint8, 0, 1)
    columns = np.ascontiguousarray(planes.T)
    return SharedPlanes(columns[:3], columns[3:6], columns[6], numbers, sides.view(np.bool_))


# Writing goes in chunks: no table is copied whole.

NUMBERS_AT_ONCE: Final = 1 << 17

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
        return write_together(folder, _files(mesh), others=OTHERS, overwrite=overwrite)


def _files(mesh: Mesh) -> Iterator[tuple[str, Iterable[bytes]]]:
    """The files of a mesh and their content; each is computed when it is written."""
    names = []
    for name, table in _named_tables(mesh):
        names.append(name)
        yield name, _pieces(table)
    notes = {
        "format": FORMATS[0],
        "part_names": mesh.part_names,
        "crease_angle": mesh.crease_angle,
        "scalars": [{"name": scalar.name, "of": scalar.of} for scalar in mesh.scalars],
        "planes": mesh.shared_planes is not None,
        "files": names,
    }
    yield NOTES, [(json.dumps(notes, indent=1, allow_nan=False) + "\n").encode()]


def _named_tables(mesh: Mesh) -> Iterator[tuple[str, AnyArray]]:
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
    yield NORMAL_NUMBERS, mesh.normals.numbers
    yield NORMALS, mesh.normals.vectors


def _pieces(table: AnyArray) -> Iterable[bytes]:
    """The bytes of the .npy file of a table that is stored by columns, column after column."""
    header = io.BytesIO()
    described = {"descr": table.dtype.str, "fortran_order": table.ndim > 1, "shape": table.shape}
    np.lib.format.write_array_header_1_0(header, described)
    yield header.getvalue()
    for row in np.atleast_2d(table.T):
        for chunk in chunks(len(row), NUMBERS_AT_ONCE):
            yield row[chunk].tobytes()
