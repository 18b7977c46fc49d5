"""Meshes of other programs: nodes and polygons in arrays, and the meshes of trimesh, PyVista and meshio.

These libraries are not imported: a mesh is recognized by its attributes. Its nodes, polygons and scalars are
taken, but no colors, normals or groups. A polygon of more than four sides is split, as in files.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from os import PathLike
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Indices
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.immutable import read_only
from autocolor.logs import logger_of
from autocolor.scene.geometry.polygon_split import MOST_CORNERS, Pieces, crossed_quads, split_polygons
from autocolor.scene.scalar import LARGEST_SCALAR, MOST_SCALARS, NODE, POLYGON, MeshScalar

LOG: Final = logger_of(__name__)

FLAT_CELLS: Final = ("triangle", "quad", "polygon")
"""The cells of meshio that are polygons; some files add the number of sides to "polygon", as in polygon5."""


class ForeignTables(NamedTuple):
    """The node table, the polygon table and the scalars of a mesh of another program, not yet checked."""

    nodes: Any
    polygons: Any
    scalars: tuple[MeshScalar, ...] = ()


def foreign_tables(source: object, polygons: object = None) -> ForeignTables:
    """The tables of a mesh of another program, for the checks of `Mesh`.

    If `polygons` are given, (polygons, 3), (polygons, 4), or a list of lists of any lengths, `source` has the
    nodes, (nodes, 3). Otherwise `source` has `vertices` and `faces`, as in trimesh; `points` and `faces`, as
    in PyVista's PolyData; or `points` and `cells`, as in meshio. The latter two may have scalars. Raises
    InputError, and UsageError for anything else.
    """
    scalars: tuple[MeshScalar, ...] = ()
    nodes = source
    if polygons is None:
        nodes, polygons = _nodes_and_polygons(source)
        pieces = _pieces(nodes, polygons)
        cells = getattr(source, "cells", None)
        blocks = _flat_blocks(cells) if isinstance(cells, (list, tuple)) else None
        scalars = foreign_scalars(source, nodes, pieces.owners, blocks)
    else:
        pieces = _pieces(nodes, polygons)
    if len(pieces.crossed):
        LOG.info("polygons whose sides cross that were split: %d", len(pieces.crossed))
        coordinates = np.asarray(nodes, np.float64)
        nodes = np.concatenate([coordinates, pieces.added.between(coordinates)])
        scalars = tuple(pieces.added.with_scalar(each) for each in scalars)
    return ForeignTables(nodes, pieces.corners, scalars)


def _pieces(nodes: object, polygons: Any) -> Pieces:
    """The polygons split into triangles and quads; a table of these is not checked."""
    try:
        table = np.asarray(polygons)
    except ValueError:
        # Its rows differ in length.
        table = np.empty(0)
    if table.ndim == 2 and len(table) and table.shape[1] in (3, 4):
        if table.shape[1] == 4 and _has_crossed_quads(nodes, table):
            return _split(nodes, table.astype(np.intp).ravel(), np.full(len(table), 4))
        return Pieces(table, np.arange(len(table)))
    rows = [_row(number, row) for number, row in enumerate(_iterated(polygons))]
    if not rows:
        raise InputError("a mesh must have polygons, not nodes alone; add some")
    counts = np.array([len(row) for row in rows], np.intp)
    return _split(nodes, np.concatenate(rows).astype(np.intp), counts)


def _has_crossed_quads(nodes: object, table: AnyArray) -> bool:
    """Whether a table of quads has any whose sides cross; False for tables that `Mesh` will refuse."""
    try:
        coordinates = np.asarray(nodes, np.float64)
    except (TypeError, ValueError):
        return False
    if coordinates.ndim != 2 or coordinates.shape[1] != 3 or table.dtype.kind not in "iu":
        return False
    if table.min() < 0 or table.max() >= len(coordinates) or not np.isfinite(coordinates).all():
        return False
    return bool(crossed_quads(coordinates, table).any())


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


def _iterated(polygons: object) -> Iterator[object]:
    if isinstance(polygons, (str, bytes)) or not isinstance(polygons, Iterable):
        raise InputError(
            f"polygons must be a table of node numbers, not {shown(polygons)}; give rows of them"
        )
    return iter(polygons)


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


def _split(nodes: object, corners: Indices, counts: Indices) -> Pieces:
    """The pieces of polygons with any number of corners. Raises InputError."""
    coordinates = np.asarray(nodes)
    if coordinates.ndim != 2 or coordinates.shape[1] != 3 or coordinates.dtype.kind not in "iuf":
        raise InputError(f"nodes must be numbers of shape (nodes, 3), not {coordinates.shape}; convert them")
    outside = np.flatnonzero((corners < 0) | (corners >= len(coordinates)))
    if len(outside):
        row = int(np.searchsorted(np.cumsum(counts), outside[0], side="right"))
        raise InputError(
            f"a node number must be a row of the nodes (0 to {len(coordinates) - 1}), not"
            f" {corners[outside[0]]} (row {row}); correct it"
        )
    pieces = split_polygons(coordinates.astype(np.float64), corners, counts)
    if split := int((counts > 4).sum()):
        LOG.info("polygons with more than four corners that were split: %d", split)
    return pieces


def foreign_scalars(
    source: object, nodes: object, owners: Indices, blocks: Sequence[int] | None
) -> tuple[MeshScalar, ...]:
    """The scalars in `point_data` and `cell_data` of a mesh, if it has them.

    Arrays of several components are left out. A number that is infinite or above 1e30 in size becomes
    missing. `owners` has the source polygon of each row of the polygon table; every source polygon has a row.
    If the data of cells are lists with an array for each block, `blocks` are the blocks of polygons.
    """
    scalars: dict[str, MeshScalar] = {}
    of_polygons = (
        (name, values if blocks is None else _joined(values, blocks))
        for name, values in _items(source, "cell_data")
    )
    for of, count, rows, data in (
        (NODE, _row_count(nodes), None, _items(source, "point_data")),
        (POLYGON, int(owners.max(initial=-1)) + 1, owners, of_polygons),
    ):
        for name, given in data:
            values = _numbers(given)
            if values is None or values.shape != (count,) or len(scalars) >= MOST_SCALARS:
                LOG.info("data of a %s left out, since they are no scalar: %s", of, name)
                continue
            with np.errstate(invalid="ignore"):
                too_large = np.abs(values) > LARGEST_SCALAR
            if too_large.any():
                LOG.info("values of scalar %s above 1e30 in size made missing: %d", name, too_large.sum())
                values[too_large] = np.nan
            name = name if name not in scalars else f"{name} of {of}s"
            values = values if rows is None else values[rows]
            scalars.setdefault(name, MeshScalar(name, read_only(values), of))
    return tuple(scalars.values())


def _items(source: Any, data: str) -> Iterator[tuple[str, Any]]:
    """The names and the arrays of the data of a mesh. Names that a scalar cannot have are left out."""
    table = getattr(source, data, None)
    if table is not None and callable(getattr(table, "items", None)):
        yield from ((name, values) for name, values in table.items() if isinstance(name, str) and name)


def _row_count(table: object) -> int:
    """The number of rows of a table; -1, which fits no data, if `Mesh` will refuse the table."""
    try:
        return len(np.asarray(table))
    except (TypeError, ValueError):
        return -1


def _joined(values: Any, blocks: Sequence[int]) -> object:
    """The concatenated arrays of some blocks; None if they do not fit together."""
    try:
        return np.concatenate([np.asarray(values[block]) for block in blocks])
    except (TypeError, ValueError, LookupError):
        return None


def _numbers(given: object) -> AnyArray | None:
    """A copy of an array of one component as float64, (n,); None for anything else."""
    try:
        values = np.asarray(given)
    except (TypeError, ValueError):
        return None
    if values.dtype.kind not in "iuf" or not (values.ndim == 1 or values.shape[1:] == (1,)):
        return None
    with np.errstate(over="ignore"):
        return np.array(values.reshape(-1), np.float64)
