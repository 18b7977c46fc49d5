"""Reading a mesh from a PLY file, in text or binary in either byte order.

Nodes come from the element `vertex`, polygons from `face`, or from `tristrips` where there are no faces.
Properties may have any type and any order; integers and real numbers beside coordinates are scalars (see
`ply_polygons`). NaN is a missing value of a scalar; an infinite one becomes missing, and is counted. Other
elements, and what follows the last one, are skipped and counted.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, chunks
from autocolor.checks import LARGEST_COORDINATE, listed, printable
from autocolor.errors import InputError
from autocolor.files.meshes.ply_elements import (
    AXES,
    CORNERS,
    FACE,
    MOST_UNNAMED_PARTS,
    PART,
    PARTS,
    STRIPS,
    VERTEX,
    Comments,
    Lists,
    PlyTables,
    Rows,
    is_scalar,
    named_in,
    parsed_header,
    property_of,
    read_binary,
    read_text,
)
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, Polygons, different, repaired
from autocolor.files.reading import LARGEST_BINARY_MESH_FILE, LARGEST_MESH_FILE, read_bytes, read_head
from autocolor.immutable import read_only
from autocolor.scene.geometry.polygon_split import MOST_CORNERS
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import LARGEST_SCALAR, NODE, POLYGON, MeshScalar

# -------------------- strips
# Triangle strips of a PLY file, as the scanned models of the nineties have them.


def triangles_of_strips(numbers: Indices, counts: Indices) -> tuple[Indices, Indices]:
    """The corners and the corner counts of the triangles of strips.

    `numbers` are the corners of all strips, with -1 where a strip ends; `counts` are the lengths of the lists
    that they stood in, at whose ends strips end, too. Every corner from the third of a strip on makes a
    triangle with the two before it; every second one is turned, so that all wind alike. Triangles with equal
    corners are left out: they only lead on to the next.

    >>> triangles_of_strips(np.array([0, 1, 2, 3, -1, 4, 5, 6]), np.array([8]))[0].reshape(-1, 3).tolist()
    [[0, 1, 2], [2, 1, 3], [4, 5, 6]]
    """
    breaks = numbers < 0
    begins = np.zeros(len(numbers) + 1, np.bool_)
    begins[np.cumsum(counts) - counts] = True
    begins[1:] |= breaks
    begins = begins[:-1]
    # The place of each corner in its strip.
    places = np.arange(len(numbers))
    places -= np.maximum.accumulate(np.where(begins, places, 0))
    thirds = np.flatnonzero((places >= 2) & ~breaks)
    before, between, last = (numbers[thirds - back] for back in (2, 1, 0))
    turned = places[thirds] % 2 == 1
    triangles = np.stack([np.where(turned, between, before), np.where(turned, before, between), last], axis=1)
    differ = (before != between) & (between != last) & (last != before)
    kept = triangles[differ]
    return kept.ravel(), np.full(len(kept), 3, np.intp)


# -------------------- ply_polygons
# The polygons of a PLY file: nodes from `vertex`, polygons from `face` or `tristrips`, parts and scalars.
#
# A file may have a part number for each face, in a property `part`, `material_index` or `group`. A comment
# such as `part 0 hood` names a part; without comments, parts are named after the property. All other
# numbers of vertices and faces are scalars, but for normals, colors and texture coordinates, which are
# ignored.

MOST_PROBLEMS: Final = 20

LARGEST_INDEX: Final = 1 << 53
"""A number from here on is that of no node, and may not be exact."""


def ply_polygons(tables: PlyTables, comments: Comments, place: str, stem: str) -> tuple[Polygons, list[str]]:
    """The polygons of the elements of a file, and messages about what was skipped or is missing.

    `place` is the file's name in messages, `stem` the name of its one part. Raises InputError with the first
    problems of coordinates and of corners, each with its place.
    """
    messages = list(tables.skipped)
    vertices = tables.elements.get(VERTEX)
    faces = tables.elements.get(FACE)
    coordinates = _coordinates(vertices, place)
    strips = tables.elements.get(STRIPS)
    has_strips = strips is not None and strips.count > 0 and not (faces and faces.count)
    polygons = strips if strips is not None and has_strips else faces
    corners, counts = _corners(polygons, len(coordinates), place, has_strips)
    if has_strips:
        corners, counts = triangles_of_strips(corners, counts)
    for name, rows in tables.elements.items():
        if name not in (VERTEX, FACE) and rows.count and not (has_strips and name == STRIPS):
            messages.insert(0, f"skipped elements {name!r}: {rows.count:,}")
    # Nothing but corners is read of strips.
    faces = None if has_strips else faces
    part = _part_property(faces, comments)
    part_numbers, names = _parts(faces, part, comments, stem, len(counts))
    scalars = []
    found = [
        (comments.scalars.get(name, name), values, of)
        for rows, of in ((vertices, NODE), (faces, POLYGON))
        for name, values in _numbers(rows, comments)
        if of == NODE or name != part
    ]
    unique = different([name for name, _, _ in found], " of polygons")
    for name, (_, values, of) in zip(unique, found, strict=True):
        scalar, missing = _scalar(name, values, of)
        scalars.append(scalar)
        if missing:
            messages.append(f"scalar {name!r}: infinite or larger than 1e30, and so missing: {missing:,}")
    return Polygons(coordinates, corners, counts, part_numbers, names, tuple(scalars)), messages


def _coordinates(vertices: Rows | None, place: str) -> Floats:
    """The coordinates of the nodes, (nodes, 3)."""
    columns = {} if vertices is None else vertices.columns
    axes = [columns.get(axis) for axis in AXES]
    coordinates = np.empty((0 if vertices is None else vertices.count, 3))
    for row, axis in enumerate(axes):
        if axis is None or isinstance(axis, Lists):
            found = f"only {listed(list(columns)[:8])}" if columns else "none"
            raise InputError(
                f"{place}: an element 'vertex' must have the properties x, y and z, not {found};"
                " export it with coordinates"
            )
        with np.errstate(invalid="ignore"):
            coordinates[:, row] = axis
    if vertices is not None and len(coordinates):
        # A comparison with NaN is false.
        low, high = coordinates.min(), coordinates.max()
        if not (low >= -LARGEST_COORDINATE and high <= LARGEST_COORDINATE):
            rows = np.flatnonzero(~(np.abs(coordinates) <= LARGEST_COORDINATE).all(axis=1))[:MOST_PROBLEMS]
            rule = "a coordinate must be a finite number of at most 1e30 in size"
            raise InputError(
                [
                    f"{vertices.place_of(row)}: {rule}, not {_first_wrong(coordinates[row]):g}; correct it"
                    for row in rows.tolist()
                ]
            )
    return coordinates


def _first_wrong(coordinates: Floats) -> float:
    return float(coordinates[~(np.abs(coordinates) <= LARGEST_COORDINATE)][0])


def _corners(rows: Rows | None, nodes: int, place: str, are_strips: bool) -> tuple[Indices, Indices]:
    """The rows in the node table of all corners, and how many corners each polygon or group of strips has."""
    if rows is None or not rows.count:
        return np.empty(0, np.intp), np.empty(0, np.intp)
    lists = next((rows.columns[name] for name in CORNERS if name in rows.columns), None)
    if not isinstance(lists, Lists):
        raise InputError(
            f"{place}: an element {STRIPS if are_strips else FACE!r} must have a list 'vertex_indices', not"
            f" only {listed(list(rows.columns)[:8]) or 'none'}; export it with polygons"
        )
    values, counts = lists
    if not are_strips and int(counts.max()) > MOST_CORNERS:
        row = int(np.flatnonzero(counts > MOST_CORNERS)[0])
        raise InputError(
            f"{rows.place_of(row)}: a polygon must have at most {MOST_CORNERS:,} corners, not"
            f" {int(counts[row]):,}; split it"
        )
    least = -1 if are_strips else 0
    if len(values) and not (values.min() >= least and values.max() < nodes and _are_whole(values)):
        _refuse_corners(rows, values, counts, nodes, least)
    return values.astype(np.intp, copy=False), counts


def _are_whole(values: AnyArray) -> bool:
    return values.dtype.kind != "f" or bool((values == np.floor(values)).all())


def _refuse_corners(rows: Rows, values: AnyArray, counts: Indices, nodes: int, least: int) -> None:
    """Raise InputError about the first polygons with corners that are no nodes."""
    is_node = (values >= least) & (values < nodes)
    if values.dtype.kind == "f":
        is_node &= values == np.floor(values)
    wrong = np.flatnonzero(~is_node)
    owners, first = np.unique(np.searchsorted(np.cumsum(counts), wrong, side="right"), return_index=True)
    rule = f"from {least} to {nodes - 1:,}" if nodes else "of a node in the file, which has none"
    raise InputError(
        [
            f"{rows.place_of(row)}: a corner must be a node number {rule}, not {values[corner]:.15g};"
            " correct it"
            for row, corner in list(zip(owners.tolist(), wrong[first].tolist(), strict=True))[:MOST_PROBLEMS]
        ]
    )


def _numbers(rows: Rows | None, comments: Comments) -> Iterator[tuple[str, AnyArray]]:
    """The properties of an element that are scalars, and their values."""
    for name, column in rows.columns.items() if rows is not None else ():
        if not isinstance(column, Lists) and is_scalar(name, comments):
            yield name, column


def _scalar(name: str, column: AnyArray, of: str) -> tuple[MeshScalar, int]:
    """A scalar, and how many of its values are missing because they are infinite or too large."""
    with np.errstate(invalid="ignore"):
        values = column.astype(np.float64)
    # A comparison with NaN is false.
    too_large = (values > LARGEST_SCALAR) | (values < -LARGEST_SCALAR)
    missing = int(too_large.sum())
    if missing:
        values[too_large] = np.nan
    return MeshScalar(name, read_only(values), of), missing


def _part_property(faces: Rows | None, comments: Comments) -> str | None:
    """The property of faces that divides them into parts; None if there is none."""
    for name in PARTS:
        column = None if faces is None else faces.columns.get(name)
        if column is None or isinstance(column, Lists) or name in comments.scalars or not len(column):
            continue
        if not (np.abs(column) < LARGEST_INDEX).all() or not _are_whole(column):
            continue
        found = np.unique(column)
        if len(found) <= MOST_UNNAMED_PARTS or (
            name == PART and all(number in comments.parts for number in found.tolist())
        ):
            return name
    return None


def _parts(
    faces: Rows | None, part: str | None, comments: Comments, stem: str, polygons: int
) -> tuple[Indices, tuple[str, ...]]:
    """The part number of each polygon, and the names of the parts."""
    if faces is None or part is None:
        names = [comments.parts[number] for number in sorted(comments.parts)] or [stem]
        return np.zeros(polygons, np.intp), different(names)
    column = faces.columns[part]
    assert not isinstance(column, Lists)
    found = np.unique(column.astype(np.int64))
    named = comments.parts if part == PART else {}
    numbers = np.union1d(found, np.array(sorted(named), np.int64))
    names = [named.get(number, f"{part} {number}") for number in numbers.tolist()]
    return np.searchsorted(numbers, column.astype(np.int64)).astype(np.intp), different(names)


# -------------------- ply_bytes
# Writing a mesh as a binary PLY file.

ROWS_AT_ONCE: Final = 1 << 16

Fields = list[tuple[str, str]]


def ply_bytes(mesh: Mesh) -> bytes:
    """The mesh as a binary PLY file, little endian, with its parts and scalars; its numbers read back equal.

    Coordinates and scalars are of type double. Each part is named in a comment, and each face has the number
    of its part where there are several. A scalar whose name is no word, or that of something else in PLY, is
    a property `value_N` with its name in a comment.

    Reading it back gives the same mesh unless the reader repairs it: a polygon without area is dropped, and
    names of parts and scalars are printable, of at most 200 letters, with no spaces around them.
    """
    nodes, polygons = len(mesh.coordinates), len(mesh.node_numbers)
    properties = [property_of(each.name, number) for number, each in enumerate(mesh.scalars)]
    of_nodes, of_polygons = (
        [(name, each) for name, each in zip(properties, mesh.scalars, strict=True) if each.of == of]
        for of in (NODE, POLYGON)
    )
    has_parts = len(mesh.part_names) > 1
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        "comment written by autocolor",
        *(f"comment part {number} {printable(name)}" for number, name in enumerate(mesh.part_names)),
        *(
            f"comment scalar {name} {printable(each.name)}"
            for name, each in zip(properties, mesh.scalars, strict=True)
            if name != each.name
        ),
        f"element {VERTEX} {nodes}",
        *(f"property double {name}" for name in (*AXES, *(name for name, _ in of_nodes))),
        f"element {FACE} {polygons}",
        "property list uchar int vertex_indices",
        *([f"property int {PART}"] if has_parts else []),
        *(f"property double {name}" for name, _ in of_polygons),
        "end_header\n",
    ]
    node_rows = np.empty(nodes, _dtype([(axis, "<f8") for axis in AXES], of_nodes))
    for axis, values in zip(AXES, mesh.coordinates.T, strict=True):
        node_rows[axis] = values
    for name, scalar in of_nodes:
        node_rows[name] = scalar.values
    faces = [_faces(mesh, chunk, of_polygons, has_parts) for chunk in chunks(polygons, ROWS_AT_ONCE)]
    return b"".join(["\n".join(lines).encode("utf-8", "replace"), node_rows.tobytes(), *faces])


def _dtype(fields: Fields, scalars: list[tuple[str, MeshScalar]]) -> np.dtype[np.void]:
    return np.dtype([*fields, *((name, "<f8") for name, _ in scalars)])


def _faces(mesh: Mesh, chunk: slice, scalars: list[tuple[str, MeshScalar]], has_parts: bool) -> bytes:
    """The rows of some polygons."""
    corners = mesh.node_numbers[chunk]
    is_triangle = corners[:, 2] == corners[:, 3]
    # Every row is made as long as that of a quad, and the last corner of a triangle cut out.
    fields: Fields = [("count", "u1"), *((f"corner {at}", "<i4") for at in range(4))]
    rows = np.empty(len(corners), _dtype([*fields, *([(PART, "<i4")] if has_parts else [])], scalars))
    rows["count"] = np.where(is_triangle, 3, 4)
    for at in range(4):
        rows[f"corner {at}"] = corners[:, at]
    if has_parts:
        rows[PART] = mesh.part_numbers[chunk]
    for name, scalar in scalars:
        rows[name] = scalar.values[chunk]
    if not is_triangle.any():
        return rows.tobytes()
    kept = np.ones((len(rows), rows.itemsize), np.bool_)
    first = rows.dtype.fields["corner 3"][1]  # type: ignore[index]
    kept[is_triangle, first : first + 4] = False
    return rows.view(np.uint8).reshape(kept.shape)[kept].tobytes()


def read_ply(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a PLY file, and what was repaired or skipped.

    Raises InputError, with the place of each problem, and MissingInputError if the file does not exist.
    """
    polygons, skipped = _read(path)
    return repaired(polygons, path.name, placement, skipped=tuple(skipped))


def _read(path: Path) -> tuple[Polygons, list[str]]:
    """The polygons of a file, and what was skipped; its bytes are given up before the mesh is made."""
    is_text = b"format ascii" in read_head(path)
    data = read_bytes(path, LARGEST_MESH_FILE if is_text else LARGEST_BINARY_MESH_FILE)
    header = parsed_header(data, path.name)
    if not header.order and len(data) > LARGEST_MESH_FILE:
        raise InputError(
            f"{path.name}: an ascii PLY file must have at most {LARGEST_MESH_FILE:,} bytes, not more; export"
            " it as binary"
        )
    tables = read_binary(data, header, path.name) if header.order else read_text(data, header, path.name)
    return ply_polygons(tables, named_in(header.comments), path.name, path.stem)
