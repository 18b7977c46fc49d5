"""The polygons of a PLY file: nodes from `vertex`, polygons from `face` or `tristrips`, parts and scalars.

A file may have a part number for each face, in a property `part`, `material_index` or `group`. A comment such
as `part 0 hood` names a part; without comments, parts are named after the property. All other numbers of
vertices and faces are scalars, but for normals, colors and texture coordinates, which are ignored.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.checks import LARGEST_COORDINATE, listed
from autocolor.errors import InputError
from autocolor.files.meshes.ply.columns import Lists, PlyTables, Rows
from autocolor.files.meshes.ply.properties import (
    AXES,
    CORNERS,
    FACE,
    MOST_UNNAMED_PARTS,
    PART,
    PARTS,
    STRIPS,
    VERTEX,
    Comments,
    is_scalar,
)
from autocolor.files.meshes.ply.strips import triangles_of_strips
from autocolor.files.repair.names import different
from autocolor.files.repair.polygons import Polygons
from autocolor.immutable import read_only
from autocolor.scene.geometry.polygon_split import MOST_CORNERS
from autocolor.scene.scalars.mesh_scalars import LARGEST_SCALAR, NODE, POLYGON, MeshScalar

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
