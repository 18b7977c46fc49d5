"""Groups of polygons that lie in one plane, found by hashing the planes to cells.

A plane is characterized by three numbers, the same whichever way its normal points. Polygons whose numbers
lie in one cell are compared with the largest of them, corner by corner, and then with the largest of those
that are left. So polygons are never united over a chain of small differences, such as around a cylinder.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Numbers, chunks, cross, dot, lengths
from autocolor.scene.geometry.union_find import unite

CELL: Final = 1 / 256
"""The size of a cell; measured: a fourth of it and four times as much find the same in random scenes."""

SHIFTS: Final = (0.0, 0.37, 0.71)
"""Offsets of several grids of cells, so that no plane is at a boundary in all of them."""

MOST_PLANES: Final = 8
"""Of the planes in a cell, how many are found at most."""

MOST_GROUNDS: Final = 1 << 14
"""Assumed: only so many of a mesh's polygons, the widest, are compared with all others in their cells."""

SHARPEST: Final = 2e-4
"""Assumed: how far a corner may be off a plane, as a fraction of its polygon's width."""

POLYGONS_AT_ONCE: Final = 1 << 13

FORMS: Final = np.random.default_rng(1983).uniform(-1, 1, (3, 3, 4))
"""Three bilinear forms of n and (n, d), which are the same for the plane (-n, -d)."""

MIXERS: Final = np.array([0x1E3779B97F4A7C15, 0x42B2AE3D27D4EB4F, 0x165667B19E3779F9], np.int64)
"""Odd numbers with well-spread bits, which make one hash of three whole numbers."""


@dataclass(frozen=True, eq=False)
class Facets:
    """Polygons as flat pieces.

    `corners` is (3, 4, n); unit `normals` and `centers` are (3, n), `areas` (twice the true ones) and
    `widths` (n,). The normal of a polygon without area is 0, as are its area and its width.
    """

    corners: Floats
    normals: Floats
    centers: Floats
    areas: Floats
    widths: Floats


def facets(coordinate_rows: Floats, node_rows: Indices) -> Facets:
    """The facets of polygons; `coordinate_rows` is (3, nodes), `node_rows` (4, polygons)."""
    corners = np.take(coordinate_rows, node_rows, axis=1)
    across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    normals = cross(across, along)
    areas = lengths(normals)
    # The diagonals of a triangle are two of its sides.
    diameters = np.sqrt(np.maximum(dot(across, across), dot(along, along)))
    flat = areas > np.maximum(1e-12 * diameters**2, 1e-200)
    areas *= flat
    normals *= flat / np.where(flat, areas, 1.0)
    widths = areas / np.where(flat, diameters, 1.0)
    return Facets(corners, normals, corners.mean(axis=1), areas, widths)


def part_of(found: Facets, rows: Indices | Booleans) -> Facets:
    """Some of the facets."""
    return Facets(
        found.corners[:, :, rows],
        found.normals[:, rows],
        found.centers[:, rows],
        found.areas[rows],
        found.widths[rows],
    )


def facet_normals(coordinate_rows: Floats, node_rows: Indices) -> Floats:
    """The normals of facets alone, (3, n)."""
    normals = np.empty((3, node_rows.shape[1]))
    for chunk in chunks(node_rows.shape[1], POLYGONS_AT_ONCE):
        normals[:, chunk] = facets(coordinate_rows, node_rows[:, chunk]).normals
    return normals


def coplanar_groups(
    coordinate_rows: Floats, node_rows: Indices, grids: Numbers, widths: Floats, tolerance: float
) -> Indices:
    """Union-find parents of the polygons, those united that seem to lie in one plane.

    Coordinates are around 0 and of at most about 1 in size; corners are exact to the tolerance. `grids` and
    `widths` are as from `plane_cells`.
    """
    parents = np.arange(node_rows.shape[1])
    widths = widths.copy()
    rank = max(len(widths) - MOST_GROUNDS, 0)
    grounds = widths >= np.sort(widths)[rank:][:1]
    left = np.flatnonzero(widths)
    slot_count = 4 << len(widths).bit_length()
    for keys in grids:
        # Leave out most of the polygons whose cell has no ground or nothing else before they are sorted.
        slots = keys.take(left) & (slot_count - 1)
        counts = np.bincount(slots, minlength=slot_count)
        counts *= np.bincount(slots.compress(grounds.take(left)), minlength=slot_count) > 0
        candidates = left.compress(counts.take(slots) > 1)
        candidates = candidates[np.argsort(keys.take(candidates), kind="stable")]
        # A chunk may end within a cell; the seeds of its two parts meet in the other grids.
        for chunk in chunks(len(candidates), POLYGONS_AT_ONCE):
            polygons = candidates[chunk]
            seeds, members = _compared(
                coordinate_rows, node_rows[:, polygons], keys.take(polygons), tolerance
            )
            unite(parents, polygons[seeds], polygons[members])
            # The seed alone stands for its group in the other grids.
            widths[polygons[members[members != seeds]]] = 0
        left = left.compress(widths.take(left) > 0)
    return parents


def plane_cells(coordinate_rows: Floats, node_rows: Indices, tolerance: float) -> tuple[Numbers, Floats]:
    """The hash of each polygon's cell in each grid, (grids, polygons), and its width, 0 if it is not flat."""
    keys = np.empty((len(SHIFTS), node_rows.shape[1]), np.int64)
    widths = np.empty(node_rows.shape[1])
    for chunk in chunks(node_rows.shape[1], POLYGONS_AT_ONCE):
        found = facets(coordinate_rows, node_rows[:, chunk])
        offsets = found.corners[:, 0] - found.centers
        warp = np.abs(dot(found.normals, offsets))
        numbers = _numbers(found.normals, dot(found.normals, found.centers))
        widths[chunk] = np.where(warp <= np.minimum(tolerance, SHARPEST * found.widths), found.widths, 0.0)
        for row, shift in zip(keys, SHIFTS, strict=True):
            cells = np.floor(numbers / CELL + shift).astype(np.int64)
            row[chunk] = MIXERS @ cells
    return keys, widths


def cells_of_planes(normals: Floats, distances: Floats, shift: Floats | float = 0.0) -> Numbers:
    """The hash of the cell of each plane in the first grid, `shift` added to its three numbers."""
    numbers = _numbers(normals, distances).T + shift
    return np.floor(numbers / CELL + SHIFTS[0]).astype(np.int64) @ MIXERS


def _numbers(normals: Floats, distances: Floats) -> Floats:
    """The three numbers of each plane, (3, planes)."""
    planes = np.concatenate([normals, distances[None]])
    return np.stack([dot(normals, form @ planes) for form in FORMS])


def _compared(
    coordinate_rows: Floats, node_rows: Indices, keys: Numbers, tolerance: float
) -> tuple[Indices, Indices]:
    """Pairs of polygons in one plane: in each cell, those that lie in the plane of the largest."""
    found = facets(coordinate_rows, node_rows)
    rows = np.lexsort((-found.areas, keys))
    seeds, members = [], []
    for _ in range(MOST_PLANES):
        heads = np.ones(len(rows), np.bool_)
        heads[1:] = np.diff(keys[rows]) != 0
        cell = np.cumsum(heads) - 1
        rows = rows[np.bincount(cell, minlength=1)[cell] > 1] if len(rows) else rows
        if not len(rows):
            break
        heads = np.ones(len(rows), np.bool_)
        heads[1:] = np.diff(keys[rows]) != 0
        seed = rows[heads][np.cumsum(heads) - 1]
        # The plane of the seed is as inexact as its corners, and more so beside it.
        away = found.corners[:, :, rows] - found.centers[:, None, seed]
        off = np.abs(np.einsum("in,ijn->jn", found.normals[:, seed], away)).max(axis=0)
        reach = np.sqrt(np.einsum("ijn,ijn->jn", away, away).max(axis=0))
        within = off <= tolerance * (1 + 2 * reach / found.widths[seed])
        within &= off <= SHARPEST * found.widths[rows]
        seeds.append(seed[within])
        members.append(rows[within])
        rows = rows[~within]
    empty = np.empty(0, np.intp)
    return np.concatenate([empty, *seeds]), np.concatenate([empty, *members])
