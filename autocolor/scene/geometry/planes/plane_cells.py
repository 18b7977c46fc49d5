"""Groups of polygons that lie in one plane, found by hashing the planes to cells.

A plane is characterized by three numbers, the same whichever way its normal points. Polygons whose numbers
lie in one cell are compared with the largest of them, corner by corner, and then with the largest of those
that are left. So polygons are never united over a chain of small differences, such as around a cylinder.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, LowBits, Numbers, chunks, cross, dot, lengths
from autocolor.scene.geometry.planes.scaled_nodes import ScaledNodes
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

LARGE: Final = 1 << 21
"""Polygons of which only the low bits of hashes are kept; the few that are compared are hashed again."""

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


def facets(corners: Floats) -> Facets:
    """The facets of polygons with these corners, (3, 4, polygons)."""
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


def facet_normals(nodes: ScaledNodes, node_rows: Indices) -> Floats:
    """The normals of facets alone, (3, n)."""
    normals = np.empty((3, node_rows.shape[1]))
    for chunk in chunks(node_rows.shape[1], POLYGONS_AT_ONCE):
        normals[:, chunk] = facets(nodes.corners(node_rows[:, chunk])).normals
    return normals


@dataclass(frozen=True, eq=False)
class PlaneCells:
    """The cells in which the planes of polygons lie, and the widths of the polygons, 0 if they are not flat.

    `hashes`, (grids, polygons), has the hash of each cell as int64, or as uint32 its low bits alone.
    `widths` is (polygons,).
    """

    hashes: Numbers | LowBits
    widths: Floats

    def keys(self, nodes: ScaledNodes, node_rows: Indices, polygons: Indices, grid: int = 0) -> Numbers:
        """The whole hashes of the cells of some polygons in a grid."""
        if self.hashes.dtype == np.int64:
            whole: Numbers = self.hashes[grid].take(polygons)
            return whole
        keys = np.empty(len(polygons), np.int64)
        for chunk in chunks(len(polygons), POLYGONS_AT_ONCE):
            found = facets(nodes.corners(node_rows[:, polygons[chunk]]))
            keys[chunk] = _hashes(_numbers(found.normals, dot(found.normals, found.centers)), SHIFTS[grid])
        return keys


def coplanar_groups(nodes: ScaledNodes, node_rows: Indices, cells: PlaneCells, tolerance: float) -> Indices:
    """Union-find parents of the polygons, those united that seem to lie in one plane.

    Coordinates are around 0 and of at most about 1 in size; corners are exact to the tolerance.
    """
    count = node_rows.shape[1]
    rank = max(count - MOST_GROUNDS, 0)
    grounds = np.flatnonzero(cells.widths >= (np.partition(cells.widths, rank)[rank] if count else 0.0))
    left = cells.widths > 0
    parents = np.arange(count)
    for grid, hashes in enumerate(cells.hashes):
        candidates = _beside_grounds(hashes, left, grounds)
        keys = cells.keys(nodes, node_rows, candidates, grid)
        order = np.argsort(keys, kind="stable")
        # A chunk may end within a cell; the seeds of its two parts meet in the other grids.
        for chunk in chunks(len(order), POLYGONS_AT_ONCE):
            polygons = candidates[order[chunk]]
            found = facets(nodes.corners(node_rows[:, polygons]))
            seeds, members = _compared(found, keys[order[chunk]], tolerance)
            unite(parents, polygons[seeds], polygons[members])
            # The seed alone stands for its group in the other grids.
            left[polygons[members[members != seeds]]] = False
    return parents


def _beside_grounds(hashes: Numbers | LowBits, left: Booleans, grounds: Indices) -> Indices:
    """Those polygons that are left whose cell may have a ground and something else."""
    mask = hashes.dtype.type((4 << len(hashes).bit_length()) - 1)
    slots = np.unique(hashes[grounds[left[grounds]]] & mask)
    has_ground = np.zeros(int(mask) + 1, np.bool_)
    has_ground[slots] = True
    found = [
        np.flatnonzero(has_ground.take(hashes[chunk] & mask) & left[chunk]) + chunk.start
        for chunk in chunks(len(hashes), POLYGONS_AT_ONCE)
    ]
    beside = np.concatenate([np.empty(0, np.intp), *found])
    slot = np.searchsorted(slots, hashes[beside] & mask)
    counts = np.bincount(slot, minlength=1)
    shared: Indices = beside[counts.take(slot) > 1]
    return shared


def plane_cells(nodes: ScaledNodes, node_rows: Indices, tolerance: float) -> PlaneCells:
    """The cell of each polygon in each grid, and its width; the polygons are taken in chunks."""
    count = node_rows.shape[1]
    hashes = np.empty((len(SHIFTS), count), np.int64 if count < LARGE else np.uint32)
    widths = np.empty(node_rows.shape[1])
    for chunk in chunks(node_rows.shape[1], POLYGONS_AT_ONCE):
        found = facets(nodes.corners(node_rows[:, chunk]))
        offsets = found.corners[:, 0] - found.centers
        warp = np.abs(dot(found.normals, offsets))
        widths[chunk] = np.where(warp <= np.minimum(tolerance, SHARPEST * found.widths), found.widths, 0.0)
        numbers = _numbers(found.normals, dot(found.normals, found.centers))
        for row, shift in zip(hashes, SHIFTS, strict=True):
            row[chunk] = _hashes(numbers, shift).astype(row.dtype)
    return PlaneCells(hashes, widths)


def cells_of_planes(normals: Floats, distances: Floats, shift: Floats | float = 0.0) -> Numbers:
    """The hash of the cell of each plane in the first grid, `shift` added to its three numbers."""
    numbers = _numbers(normals, distances).T + shift
    return _hashes(numbers.T, SHIFTS[0])


def _hashes(numbers: Floats, shift: float) -> Numbers:
    """One hash of the cell that the three numbers of each plane, (3, planes), lie in."""
    hashes: Numbers = MIXERS @ np.floor(numbers / CELL + shift).astype(np.int64)
    return hashes


def _numbers(normals: Floats, distances: Floats) -> Floats:
    """The three numbers of each plane, (3, planes).

    They are the same for a plane whichever others are asked for with it: a matrix product would not say so.
    """
    planes = [*normals, distances]
    numbers = np.zeros((len(FORMS), len(distances)))
    for number, form in zip(numbers, FORMS, strict=True):
        for normal, factors in zip(normals, form.tolist(), strict=True):
            number += normal * sum(factor * row for factor, row in zip(factors, planes, strict=True))
    return numbers


def _compared(found: Facets, keys: Numbers, tolerance: float) -> tuple[Indices, Indices]:
    """Pairs of facets in one plane: in each cell, those that lie in the plane of the largest."""
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
