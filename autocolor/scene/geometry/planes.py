"""Planes that several polygons share and in which they may overlap, such as those of a decal and its ground.

The promise: polygons that share a plane are never torn. They have one depth, and the later one in the file
wins wherever they overlap. The planes are found in four steps:

1. Put the plane of each polygon into a cell of similar planes. Go on with the cells of the widest polygons.
2. Unite the polygons of a cell that lie in the plane of its widest polygon, then of the widest of the rest,
   and so on. So a chain of small differences, such as around a cylinder, unites no polygons.
3. Drop the groups that are one simple patch: its polygons adjoin, and none can overlap another.
4. Fit a plane to each group that is left, and drop the polygons that are too far from it.

What is not promised:

- If a ground is a fine grid, of 10 to 60 cells a side or more, and its corners are rounded, its widest
  polygon does not tell the plane of all others. A decal across several cells may be torn.
- Coordinates of fewer than six digits are too coarse. A polygon narrower than a five-hundredth of the mesh
  may be rounded to too different a plane; it is then left out.
- Of more than 16,384 polygons, at least one polygon of a plane must be among the 16,384 widest.
- A polygon that is really in front of another by less than TOLERANCE shares its plane, or tears. So does a
  decal on a polygon that is in front of a wide one by less than some ten times as much.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor import arrays
from autocolor.arrays import Booleans, Floats, Indices, LowBits, chunks, cross, dot
from autocolor.immutable import Immutable
from autocolor.scene.geometry.normals import corners_at_shared_edges, places_of_corners, roots_of, unite

TOLERANCE: Final = 3e-6
"""Assumed: polygons lie in one plane if no corner is farther from it than this fraction of their largest
coordinate. A coordinate of six decimals around 1 is rounded by a sixth of this at most."""

LEAST: Final = 4.5e-6
"""Assumed: the least of these distances in a mesh of two units or more: nine roundings of six decimals."""

MOST: Final = 8e-6
"""Assumed: the largest of these distances, as a fraction of the size of the mesh."""

SHARPEST: Final = 2e-4
"""Assumed: how far a corner may be off a plane, as a fraction of its polygon's width."""

CELL: Final = 1 / 256
"""The size of a cell. Measured: with a fourth of it, and with four times as much, random scenes have the same
planes."""

SHIFTS: Final = (0.0, 0.37, 0.71)
"""Offsets of three grids of cells: no plane is at a boundary in all grids."""

FORMS: Final = np.random.default_rng(1983).uniform(-1, 1, (3, 12))
"""Three bilinear forms of n and (n, d), which are the same for the plane (-n, -d)."""

MIXERS: Final = np.array([0x1E3779B97F4A7C15, 0x42B2AE3D27D4EB4F, 0x165667B19E3779F9], np.int64)
"""Odd numbers with well-spread bits, which make one hash of three whole numbers."""

HASHES: Final = 1 << 22
"""How many hashes there are. Cells may share a hash: all polygons of a hash are compared anyway."""

MOST_PLANES: Final = 8
"""The most planes that are found in a cell."""

MOST_GROUNDS: Final = 1 << 14
"""Assumed: how many polygons of a mesh, the widest, are compared with all others in their cells."""

POLYGONS_AT_ONCE: Final = 1 << 13


@dataclass(frozen=True, eq=False, repr=False)
class SharedPlanes(Immutable):
    """The planes that several polygons share.

    `normals` and `points` are (3, planes): a unit normal and a point of each plane. No corner is farther from
    its plane than `distances`, (planes,). `plane_of_polygon`, (polygons,) intp, is a column of these, -1 for
    none; `turned`, (polygons,), tells which polygons have a normal against that of their plane.
    """

    normals: Floats
    points: Floats
    distances: Floats
    plane_of_polygon: Indices
    turned: Booleans


@arrays.underflowing
def shared_planes(coordinates: Floats, node_numbers: Indices) -> SharedPlanes | None:
    """The planes in which polygons may overlap; None if there are no such planes."""
    rows, node_rows = coordinates.T, node_numbers.T
    low, high = arrays.used_bounds(rows, node_rows)
    extent = float((high - low).max())
    if not 0 < extent < np.inf:
        return None
    mesh = Polygons(rows, node_rows, low / 2 + high / 2, extent)
    polygons, groups = _groups(mesh)
    # Drop the groups that are one patch, before anything large is computed.
    parts = [mesh.facets(polygons[chunk]).normals for chunk in chunks(len(polygons), POLYGONS_AT_ONCE)]
    normals = np.concatenate([np.empty((3, 0)), *parts], axis=1)
    turned = dot(normals, np.take(normals, np.searchsorted(groups, groups), axis=1)) < 0
    rest = _may_overlap(places_of_corners(rows, node_rows[:, polygons]), groups, turned)
    polygons, groups = polygons[rest], np.unique(groups[rest], return_inverse=True)[1]
    if not len(polygons):
        return None
    # Fit a plane to each group, and drop the polygons that are too far from it.
    facets, first = mesh.facets(polygons), _firsts(groups)
    normals, points = _fitted(facets, groups)
    away = facets.corners - points[:, None, groups]
    off = np.abs(np.einsum("in,icn->cn", normals[:, groups], away)).max(axis=0)
    tolerances = np.maximum.reduceat(facets.tolerances, first)[groups]
    near = off <= np.minimum(tolerances, SHARPEST * facets.widths)
    near = np.flatnonzero(near & (np.bincount(groups, near)[groups] > 1))
    if not len(near):
        return None
    numbers, planes = np.unique(groups[near], return_inverse=True)
    plane_of_polygon = np.full(len(node_numbers), -1, np.intp)
    plane_of_polygon[polygons[near]] = planes
    turned = np.zeros(len(node_numbers), np.bool_)
    turned[polygons] = dot(facets.normals, normals[:, groups]) < 0
    distances = np.maximum.reduceat(off[near], _firsts(planes)) * extent
    points = points[:, numbers] * extent + mesh.middle[:, None]
    return SharedPlanes(normals[:, numbers], points, distances, plane_of_polygon, turned)


class Facets(NamedTuple):
    """Polygons as flat pieces, in a mesh of size 1.

    `corners` is (3, 4, n); unit `normals` and `centers` are (3, n), `areas` (twice the true ones), `widths`
    and `tolerances` (n,): how far the corners may be off a plane. A polygon without area has a normal, an
    area and a width of 0.
    """

    corners: Floats
    normals: Floats
    centers: Floats
    areas: Floats
    widths: Floats
    tolerances: Floats


class Polygons(NamedTuple):
    """Polygons, `node_rows` (4, polygons), and their nodes, `rows` (3, nodes), of a mesh of any size."""

    rows: Floats
    node_rows: Indices
    middle: Floats
    extent: float

    def facets(self, polygons: Indices | slice) -> Facets:
        """Some of the polygons, moved and scaled: the middle becomes 0, and the extent becomes 1."""
        corners = np.take(self.rows, self.node_rows[:, polygons], axis=1)
        largest = np.maximum(corners.max(axis=(0, 1)), -corners.min(axis=(0, 1))) / self.extent
        tolerances = np.clip(TOLERANCE * largest, min(LEAST / self.extent, TOLERANCE), MOST)
        corners -= self.middle[:, None, None]
        corners /= self.extent
        across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
        normals = cross(across, along)
        areas = arrays.lengths(normals)
        # The diagonals of a triangle are two of its sides.
        diameters = np.sqrt(np.maximum(dot(across, across), dot(along, along)))
        flat = areas > np.maximum(1e-12 * diameters**2, 1e-200)
        areas *= flat
        normals *= flat / np.where(flat, areas, 1.0)
        widths = areas / np.where(flat, diameters, 1.0)
        return Facets(corners, normals, corners.mean(axis=1), areas, widths, tolerances)


def _groups(mesh: Polygons) -> tuple[Indices, Indices]:
    """The polygons that seem to lie in one plane with others, sorted by group; groups count from 0."""
    hashes, widths = _hashes_and_widths(mesh)
    left, parents = widths > 0, np.arange(len(widths))
    rank = max(len(widths) - MOST_GROUNDS, 0)
    grounds = np.flatnonzero(widths >= (np.partition(widths, rank)[rank] if len(widths) else 0.0))
    for cells in hashes:
        has_ground = np.zeros(HASHES, np.bool_)
        has_ground[cells[grounds[left[grounds]]]] = True
        beside = np.flatnonzero(left & has_ground[cells])
        beside = beside[np.lexsort((-widths[beside], cells[beside]))]
        # A chunk may end within a cell; the widest polygons of its two parts meet in the other grids.
        for chunk in chunks(len(beside), POLYGONS_AT_ONCE):
            some = beside[chunk]
            for widest, members in _in_planes_of_widest(mesh.facets(some), cells[some]):
                unite(parents, some[widest], some[members])
                # The widest polygon alone stands for its group in the other grids.
                left[some[members[members != widest]]] = False
    united = np.flatnonzero(parents != np.arange(len(parents)))
    roots = roots_of(parents, united)
    firsts = np.unique(roots)
    polygons, roots = np.concatenate([firsts, united]), np.concatenate([firsts, roots])
    order = np.lexsort((polygons, roots))
    return polygons[order], np.searchsorted(firsts, roots[order])


def _hashes_and_widths(mesh: Polygons) -> tuple[LowBits, Floats]:
    """The hash of each polygon's cell in each grid, (grids, polygons), and its width, 0 if it is warped."""
    count = mesh.node_rows.shape[1]
    hashes, widths = np.empty((len(SHIFTS), count), np.uint32), np.empty(count)
    for chunk in chunks(count, POLYGONS_AT_ONCE):
        facets = mesh.facets(chunk)
        warp = np.abs(dot(facets.normals, facets.corners[:, 0] - facets.centers))
        is_flat = warp <= np.minimum(facets.tolerances, SHARPEST * facets.widths)
        widths[chunk] = np.where(is_flat, facets.widths, 0.0)
        planes = np.concatenate([facets.normals, dot(facets.normals, facets.centers)[None]])
        numbers = FORMS @ (facets.normals[:, None] * planes).reshape(12, -1) / CELL
        for row, shift in zip(hashes, SHIFTS, strict=True):
            row[chunk] = MIXERS @ np.floor(numbers + shift).astype(np.int64) & (HASHES - 1)
    return hashes, widths


def _in_planes_of_widest(facets: Facets, cells: LowBits) -> Iterator[tuple[Indices, Indices]]:
    """Pairs of the widest facet of a cell and a facet in its plane; then the widest of the rest, and so on.

    The facets are sorted by cell, the widest of a cell first. Every facet lies in its own plane.
    """
    rows = np.arange(len(cells))
    for _ in range(MOST_PLANES):
        first = _firsts(cells[rows])
        widest = np.repeat(rows[first], np.diff(first, append=len(rows)))
        # The error of the widest facet's plane grows with the distance from its corners.
        away = facets.corners[:, :, rows] - facets.centers[:, None, widest]
        off = np.abs(np.einsum("in,ijn->jn", facets.normals[:, widest], away)).max(axis=0)
        reach = np.sqrt(np.einsum("ijn,ijn->jn", away, away).max(axis=0))
        tolerances = np.maximum(facets.tolerances[widest], facets.tolerances[rows])
        tolerances *= 1 + 2 * reach / facets.widths[widest]
        within = off <= np.minimum(tolerances, SHARPEST * facets.widths[rows])
        yield widest[within], rows[within]
        rows = rows[~within]


def _firsts(groups: Indices | LowBits) -> Indices:
    """Where each group begins; `groups` are sorted."""
    return np.flatnonzero(np.append(True, groups[1:] != groups[:-1])[: len(groups)])


def _fitted(facets: Facets, groups: Indices) -> tuple[Floats, Floats]:
    """The planes that fit the corners of each group best: unit normals and points, (3, groups)."""
    first = _firsts(groups)
    weights = facets.areas / np.add.reduceat(facets.areas, first)[groups]
    points = np.add.reduceat(weights * facets.centers, first, axis=1)
    away = facets.corners - points[:, None, groups]
    spread = np.add.reduceat(np.einsum("n,icn,jcn->nij", weights, away, away), first, axis=0)
    # The normal is the direction in which the corners spread least.
    return np.linalg.eigh(spread)[1][:, :, 0].T.copy(), points


def _may_overlap(places: Indices, groups: Indices, turned: Booleans) -> Booleans:
    """Whether each polygon's group is more than one simple patch.

    A patch is simple if at most two polygons meet at each edge, one on either side. `places` is as from
    `places_of_corners`. Polygons on the same side of an edge overlap; such an edge joins no polygons.
    """
    forward = ((places < np.roll(places, -1, axis=0)) ^ turned).T.ravel()
    none = np.empty((2, 0), np.intp)
    one, other = np.concatenate([none, *corners_at_shared_edges(places, groups)], axis=1)
    folded = forward[one] == forward[other]
    # A third polygon at an edge is paired with the second.
    folded[1:] |= one[1:] == other[:-1]
    # Unite polygons across their edges, unless they are folded there.
    parents = np.arange(len(groups))
    unite(parents, one[~folded] >> 2, other[~folded] >> 2)
    several = np.bincount(groups[parents == np.arange(len(groups))], minlength=1) > 1
    several[groups[other[folded] >> 2]] = True
    return several[groups]
