"""Meshes of other programs: nodes and polygons in arrays, and the meshes of trimesh, PyVista and meshio.

These libraries are not imported: a mesh is recognized by its attributes. Its nodes, polygons and scalars are
taken, but no colors, normals or groups. A polygon of more than four sides is split, as in files.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from os import PathLike
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.immutable import read_only
from autocolor.logs import logger_of
from autocolor.scene.geometry.polygon_split import MOST_CORNERS, split_polygons
from autocolor.scene.scalar import LARGEST_SCALAR, MOST_SCALARS, NODE, POLYGON, MeshScalar

LOG: Final = logger_of(__name__)

FLAT_CELLS: Final = ("triangle", "quad", "polygon")
"""The cells of meshio that are polygons; some files add the number of sides to "polygon", as in polygon5."""


def foreign_tables(source: object, polygons: object = None) -> tuple[Floats, Indices, tuple[MeshScalar, ...]]:
    """The node table, the polygon table, (polygons, 4), and the scalars of a mesh of another program.

    If `polygons` are given, (polygons, 3), (polygons, 4), or a list of lists of any lengths, `source` has the
    nodes, (nodes, 3). Otherwise `source` has `vertices` and `faces`, as in trimesh; `points` and `faces`, as
    in PyVista's PolyData; or `points` and `cells`, as in meshio. The latter two may have scalars. `Mesh`
    checks the coordinates. Raises InputError, and UsageError for anything else.
    """
    nodes, rows = _nodes_and_polygons(source) if polygons is None else (source, polygons)
    coordinates = _numbers(nodes)
    if coordinates is None or coordinates.ndim != 2 or coordinates.shape[1] != 3:
        given = type(nodes).__name__ if coordinates is None else coordinates.shape
        raise InputError(f"nodes must be numbers of shape (nodes, 3), not {given}; convert them")
    corners, counts = _corners_and_counts(rows)
    outside = np.flatnonzero((corners < 0) | (corners >= len(coordinates)))
    if len(outside):
        row = int(np.searchsorted(np.cumsum(counts), outside[0], side="right"))
        raise InputError(
            f"a node number must be a row of the nodes (0 to {len(coordinates) - 1}), not"
            f" {corners[outside[0]]} (row {row}); correct it"
        )
    # Coordinates may be infinite here.
    with np.errstate(invalid="ignore", over="ignore"):
        pieces = split_polygons(coordinates, corners, counts)
    if split := int((counts > 4).sum()):
        LOG.info("polygons with more than four corners that were split: %d", split)
    scalars = foreign_scalars(source, len(coordinates), pieces.owners) if polygons is None else ()
    if len(pieces.crossed):
        LOG.info("polygons whose sides cross that were split: %d", len(pieces.crossed))
        coordinates = np.concatenate([coordinates, pieces.added.between(coordinates)])
        scalars = tuple(pieces.added.with_scalar(each) for each in scalars)
    return coordinates, pieces.corners, scalars


def _corners_and_counts(polygons: Any) -> tuple[Indices, Indices]:
    """The nodes of all corners of polygons, and the number of corners of each. Raises InputError."""
    try:
        table = np.asarray(polygons)
    except ValueError:
        # Its rows differ in length.
        table = np.empty(0)
    if table.ndim == 0 and not isinstance(polygons, Iterator):
        raise InputError(
            f"polygons must be a table of node numbers, not {shown(polygons)}; give rows of them"
        )
    if table.ndim == 2 and table.size and table.dtype.kind in "iu" and 3 <= table.shape[1] <= MOST_CORNERS:
        return table.astype(np.intp).ravel(), np.full(len(table), table.shape[1])
    rows = [_row(number, row) for number, row in enumerate(polygons)]
    if not rows:
        raise InputError("a mesh must have polygons, not nodes alone; add some")
    return np.concatenate(rows).astype(np.intp), np.array([len(row) for row in rows], np.intp)


def _row(number: int, row: object) -> AnyArray:
    """The node numbers of one polygon. Raises InputError."""
    try:
        corners = np.asarray(row)
    except ValueError:
        corners = np.empty(0)
    if corners.ndim != 1 or corners.dtype.kind not in "iu" or not 3 <= len(corners) <= MOST_CORNERS:
        raise InputError(
            f"a polygon must have 3 to {MOST_CORNERS:,} node numbers, not {shown(row)} (row {number});"
            " correct it"
        )
    return corners


def _nodes_and_polygons(source: Any) -> tuple[Any, Any]:
    """The nodes of a mesh object, and its polygons: an array of equal rows, or rows of any lengths."""
    points, faces = getattr(source, "points", None), getattr(source, "faces", None)
    cells = getattr(source, "cells", None)
    if points is not None and isinstance(cells, (list, tuple)):
        return points, _polygons_of_cells(cells)
    if points is not None and faces is not None:
        return points, _polygons_of_counted(np.asarray(faces))
    if getattr(source, "vertices", None) is not None and faces is not None:
        return source.vertices, faces
    if isinstance(source, (str, PathLike)):
        raise UsageError(f"a mesh must be in memory, not a file, {shown(source)}; read that with read_scene")
    raise UsageError(
        "a mesh must be a Mesh, nodes and polygons, or a surface of trimesh, PyVista or meshio, not"
        f" {type(source).__name__}; take its surface, or give its nodes and its polygons as two arguments"
    )


def _polygons_of_counted(faces: AnyArray) -> object:
    """The polygons of PyVista's faces, in which a count precedes the node numbers of each polygon.

    Raises InputError if the counts do not add up to the length.
    """
    if faces.ndim == 2:
        return faces
    if faces.ndim != 1 or (faces.size and faces.dtype.kind not in "iu"):
        raise InputError("faces must be whole numbers in one row, a count before each polygon; convert them")
    if not faces.size:
        return []
    width = int(faces[0]) + 1
    if width > 1 and faces.size % width == 0 and (faces[::width] == width - 1).all():
        return faces.reshape(-1, width)[:, 1:]
    rows: list[list[int]] = []
    numbers, at = faces.tolist(), 0
    while at < len(numbers):
        end = at + 1 + numbers[at]
        if numbers[at] < 0 or end > len(numbers):
            raise InputError(
                f"faces must have as many numbers after each count, not {len(numbers) - at - 1} after"
                f" {numbers[at]} (polygon {len(rows)}); correct them"
            )
        rows.append(numbers[at + 1 : end])
        at = end
    return rows


def _flat_blocks(cells: Sequence[Any]) -> list[int]:
    """The places of the blocks that are polygons, among the cells of meshio."""
    kinds = [str(block.type) for block in cells]
    return [
        place
        for place, kind in enumerate(kinds)
        if kind in FLAT_CELLS or kind.removeprefix("polygon").isdigit()
    ]


def _polygons_of_cells(cells: Sequence[Any]) -> object:
    """The polygons among the cells of meshio, without other cells. Raises InputError if there are none."""
    for block in cells:
        if not (hasattr(block, "type") and hasattr(block, "data")):
            raise InputError(
                f"cells must be cell blocks with a type and data, as in meshio, not {shown(block)}; convert"
                " them"
            )
    places = _flat_blocks(cells)
    flat = [cells[place] for place in places]
    others = [block for place, block in enumerate(cells) if place not in places]
    left_out = ", ".join(f"{len(block.data):,} of type {block.type!r}" for block in others)
    if not flat:
        kinds = f"cells alone: {left_out}" if others else "none"
        raise InputError(f"a mesh must have triangles or quads, not {kinds}; take its surface")
    if others:
        LOG.info("cells left out: %s", left_out)
    if len(flat) == 1:
        return flat[0].data
    return list(chain.from_iterable(block.data for block in flat))


def foreign_scalars(source: Any, node_count: int, owners: Indices) -> tuple[MeshScalar, ...]:
    """The scalars in `point_data` and `cell_data` of a mesh, if it has them.

    Arrays of several components are left out. A number that is infinite or above 1e30 in size becomes
    missing. `owners` has the source polygon of each row of the polygon table; every source polygon has a row.
    """
    cells = getattr(source, "cells", None)
    blocks = _flat_blocks(cells) if isinstance(cells, (list, tuple)) else None
    scalars: dict[str, MeshScalar] = {}
    for of, count in ((NODE, node_count), (POLYGON, int(owners.max(initial=-1)) + 1)):
        for name, given in _items(source, "point_data" if of == NODE else "cell_data"):
            # The data of cells are lists with an array for each block.
            values = _joined(given, blocks) if of == POLYGON and blocks is not None else _numbers(given)
            if values is None or values.shape not in ((count,), (count, 1)) or len(scalars) >= MOST_SCALARS:
                LOG.info("data of a %s left out, since they are no scalar: %s", of, name)
                continue
            values = values.ravel()
            with np.errstate(invalid="ignore"):
                too_large = np.abs(values) > LARGEST_SCALAR
            if too_large.any():
                LOG.info("values of scalar %s above 1e30 in size made missing: %d", name, too_large.sum())
            values = np.where(too_large, np.nan, values)[... if of == NODE else owners]
            name = name if name not in scalars else f"{name} of {of}s"
            scalars.setdefault(name, MeshScalar(name, read_only(values), of))
    return tuple(scalars.values())


def _items(source: Any, data: str) -> Iterator[tuple[str, Any]]:
    """The names and the arrays of the data of a mesh. Names that a scalar cannot have are left out."""
    table = getattr(source, data, None)
    if table is not None and callable(getattr(table, "items", None)):
        yield from ((name, values) for name, values in table.items() if isinstance(name, str) and name)


def _joined(values: Any, blocks: Sequence[int]) -> AnyArray | None:
    """The concatenated arrays of some blocks; None if they do not fit together."""
    try:
        return _numbers(np.concatenate([np.asarray(values[block]) for block in blocks]))
    except (TypeError, ValueError, LookupError):
        return None


def _numbers(given: object) -> AnyArray | None:
    """The values as an array of float64; None if they are no array of numbers."""
    try:
        values = np.asarray(given)
    except (TypeError, ValueError):
        return None
    with np.errstate(over="ignore"):
        return values.astype(np.float64, copy=False) if values.dtype.kind in "iuf" else None
