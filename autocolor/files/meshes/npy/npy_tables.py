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
angle is the file's; else, and where they are absent, they are computed. Whoever changes nodes or polygons
must delete the files of normals and planes, or convert the folder again. Nothing is ever repaired.

All numbers are checked once when the tables are opened, a few pages at a time.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.errors import InputError
from autocolor.files.meshes.npy import table_rows as rows
from autocolor.files.meshes.npy.npy_array import mapped
from autocolor.files.meshes.npy.table_notes import NOTES, TableNotes, read_notes
from autocolor.files.repair.placement import PLAIN, Placement, placed
from autocolor.files.repair.polygons import MeshReport
from autocolor.immutable import read_only
from autocolor.logs import logger_of
from autocolor.scene.geometry.node_normals import CREASE_ANGLE, NodeNormals
from autocolor.scene.geometry.planes.shared_planes import SharedPlanes
from autocolor.scene.mesh import PART, Mesh
from autocolor.scene.scalars.mesh_scalars import LARGEST_SCALAR, NODE, MeshScalar

LOG: Final = logger_of(__name__)

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
"""Assumed: parts that get names of their own where a folder names none."""

CORRECT: Final = "correct that row"


class Tables(NamedTuple):
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
    known = None if notes is None or not is_plain else notes.planes
    mesh = Mesh.of_tables(
        *_placed(tables, placement),
        part_numbers,
        names,
        wanted,
        () if notes is None else _scalars(folder, notes, tables),
        normals=normals,
        shared_planes=... if known is None else _planes(folder, tables.polygon_count) if known else None,
    )
    return MeshReport(mesh)


def _tables(nodes: Path, polygons: Path) -> Tables:
    """The two tables that there must be, checked."""
    coordinates, corners = mapped(nodes), mapped(polygons)
    rows.is_shaped(nodes.name, coordinates, "a node table", None, (3,))
    rows.is_of(nodes.name, coordinates, "coordinates", "iuf")
    rows.checked(
        nodes.name,
        coordinates,
        "coordinates must be finite and at most 1e30 in size",
        rows.are_coordinates,
        CORRECT,
    )
    rows.is_shaped(polygons.name, corners, "a polygon table", None, (4, 3))
    _check_numbers(polygons.name, corners, "node numbers", len(coordinates), "node table")
    if corners.shape[1] == 3:
        LOG.info("%s: copied, for its triangles do not repeat their last node", polygons.name)
        four = np.empty((4, len(corners)), np.intp)
        four[:3] = corners.T
        four[3] = four[2]
        corners = read_only(four).T
    return Tables(
        rows.as_read(nodes.name, coordinates, np.float64), rows.as_read(polygons.name, corners, np.intp)
    )


def _check_numbers(name: str, numbers: Indices, what: str, count: int, table: str) -> None:
    """Raise InputError unless all are rows of a table of so many."""
    rows.is_of(name, numbers, what, "iu")
    thing = f"{what} must be rows of the {table} (0 to {count - 1})"
    rows.checked(name, numbers, thing, rows.within(count), CORRECT)


def _placed(tables: Tables, placement: Placement) -> Tables:
    """The tables with their nodes in the world: copied, and checked again, unless they are there already."""
    if placement.up == "z" and placement.scale == 1:
        return tables
    turned = np.asfortranarray(placed(tables.coordinates.copy(order="F"), placement))
    thing = "scaled coordinates must be at most 1e30 in size"
    rows.checked(NODES, turned, thing, rows.are_coordinates, "give a smaller scale")
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
    rows.is_shaped(PARTS, parts, "part numbers", polygons, (0,))
    _check_numbers(PARTS, parts, "part numbers", len(named) or MOST_PARTS, "part table")
    count = int(parts.max(initial=0)) + 1
    return rows.as_read(PARTS, parts, np.intp), named or tuple(f"part {number}" for number in range(count))


def _normals(folder: Path, polygons: int) -> NodeNormals | None:
    """The normals of the files; None if there are none."""
    there = [name for name in (NORMALS, NORMAL_NUMBERS) if (folder / name).exists()]
    if not there:
        return None
    if len(there) == 1:
        raise InputError(
            f"{there[0]}: {NORMALS} and {NORMAL_NUMBERS} must both be there or neither, not one alone;"
            " delete it"
        )
    vectors, numbers = mapped(folder / NORMALS), mapped(folder / NORMAL_NUMBERS)
    rows.is_shaped(NORMALS, vectors, "normals", None, (3,))
    rows.is_of(NORMALS, vectors, "normals", "iuf")
    rows.checked(NORMALS, vectors, "a normal must be a unit vector", rows.are_unit_vectors, CORRECT)
    rows.is_shaped(NORMAL_NUMBERS, numbers, "normal numbers", polygons, (4,))
    _check_numbers(NORMAL_NUMBERS, numbers, "normal numbers", len(vectors), "normals")
    return NodeNormals(
        rows.as_read(NORMALS, vectors, np.float32), rows.as_read(NORMAL_NUMBERS, numbers, np.intp)
    )


def _planes(folder: Path, polygons: int) -> SharedPlanes:
    """The planes of the files that the notes promise."""
    planes, numbers = mapped(folder / PLANES), mapped(folder / PLANE_NUMBERS)
    sides = mapped(folder / PLANE_SIDES)
    rows.is_shaped(PLANES, planes, "planes", None, (7,))
    rows.checked(
        PLANES, planes, "numbers must be finite and at most 1e30 in size", rows.are_coordinates, CORRECT
    )
    rows.checked(
        PLANES, planes[:, :3], "the normal of a plane must be a unit vector", rows.are_unit_vectors, CORRECT
    )
    rows.is_shaped(PLANE_NUMBERS, numbers, "plane numbers", polygons, (0,))
    rows.is_of(PLANE_NUMBERS, numbers, "plane numbers", "i")
    thing = f"plane numbers must be -1 or rows of the planes (0 to {len(planes) - 1})"
    rows.checked(PLANE_NUMBERS, numbers, thing, lambda row: ((row >= -1) & (row < len(planes)))[0], CORRECT)
    rows.is_shaped(PLANE_SIDES, sides, "sides", polygons, (0,))
    rows.checked(
        PLANE_SIDES, sides, "a side must be 0 or 1", lambda row: ((row == 0) | (row == 1))[0], CORRECT
    )
    columns = read_only(np.array(planes.T, np.float64, order="C"))
    return SharedPlanes(
        columns[:3],
        columns[3:6],
        columns[6],
        rows.as_read(PLANE_NUMBERS, numbers, np.intp),
        rows.as_read(PLANE_SIDES, sides, np.uint8).view(np.bool_),
    )


def _scalars(folder: Path, notes: TableNotes, tables: Tables) -> tuple[MeshScalar, ...]:
    """The scalars that the notes name."""
    found = []
    for number, (name, of) in enumerate(notes.scalars, 1):
        path = folder / SCALARS / f"{number}.npy"
        place, values = f"{SCALARS}/{path.name}", mapped(path)
        rows.is_shaped(
            place,
            values,
            f"a scalar of each {of}",
            tables.node_count if of == NODE else tables.polygon_count,
            (0,),
        )
        rows.is_of(place, values, "values", "iuf")
        rows.checked(
            place,
            values,
            "a value must be at most 1e30 in size, or NaN if it is missing",
            lambda row: (np.isnan(row) | (np.abs(row) <= LARGEST_SCALAR))[0],
            CORRECT,
        )
        found.append(MeshScalar(name, rows.as_read(place, values, np.float64), of))
    return tuple(found)
