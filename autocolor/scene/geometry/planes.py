"""Planes that several polygons share and in which they may overlap, such as those of a decal and its ground.

Assumed: polygons lie in one plane if no corner is farther from it than two millionths of the mesh's size,
which is more than float32, or six decimals, round the corners of a mesh of a unit or more, and if none of
their patches is really in front of the others. It is if its corners are all on one side of the plane of the
others, on average by more than four times their scatter and four times the rounding of a coordinate, which is
told from the coordinates: half a unit in the last place of float32, or of the decimals they have, or a few of
float64. Patches exactly along an axis are rounded alike, so that any difference is real.

A polygon narrower than a five-hundredth of the mesh may be rounded to too different a plane; it is then left
out. Of more than 16,384 polygons, one of those that share a plane must be among the 16,384 widest.
Coordinates of fewer decimals than six a unit are too coarse.

Polygons that can't overlap are left out, too: those that are one patch in which at most two meet at each
edge, one on either side, as where a flat side is divided; and patches that lie side by side.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, LowBits, Numbers, chunks, cross, dot, lengths
from autocolor.immutable import Immutable
from autocolor.scene.geometry.normals import (
    group_numbers,
    places_of_corners,
    roots_of,
    unite,
    united_items,
    used_bounds,
)

# -------------------- coordinate_rounding
# How much the coordinates of a mesh were rounded, told from the coordinates themselves.

EXACT: Final = 2.0**-46
"""Assumed: what placing a mesh in 64-bit numbers may round, as a fraction of the largest coordinate."""

HALF_SINGLE: Final = 2.0**-24
"""Half a unit in the last place of a 32-bit number, as a fraction of the number, at most."""

LAST_BITS: Final = np.uint32(15)
"""Of a 32-bit number; where they are not all 0 it has at least 20 bits."""

MOST_DECIMALS: Final = 9

FIRST_TESTED: Final = 64


class Rounding(NamedTuple):
    """The most by which a coordinate may be rounded, and the same as a fraction of each coordinate.

    Decimals that were equal before they were rounded are equal afterwards; the second is then that of 64-bit
    numbers. Both are where nothing is `known`, as of coordinates that were turned after they were rounded.
    """

    most: float
    fraction: float
    known: bool = True


def coordinate_rounding(coordinate_rows: Floats) -> Rounding:
    """How coordinates, (3, n), were rounded: some to 32-bit numbers, all to at most nine decimals, or none.

    A mesh that was moved after its coordinates were rounded to decimals still shows it.

    >>> coordinate_rounding(np.array([[0.123, 4.567], [0.1, 2.0], [0.0, 0.0]])).most
    0.0005
    """
    largest = float(np.abs(coordinate_rows).max(initial=0.0))
    exact = EXACT * largest
    with np.errstate(over="ignore", under="ignore"):
        singles = coordinate_rows.astype(np.float32)
    same = singles == coordinate_rows
    # Some may have been rounded and others not. A number of few bits says nothing.
    if same.all() or (same & ((singles.view(np.uint32) & LAST_BITS) > 0)).any():
        return Rounding(HALF_SINGLE * largest, HALF_SINGLE)
    moved = coordinate_rows - coordinate_rows[:, :1]
    for decimals in range(MOST_DECIMALS + 1):
        if _have_decimals(moved, decimals, largest):
            return Rounding(max(10.0**-decimals / 2, exact), EXACT)
    return Rounding(exact, EXACT, known=False)


def _have_decimals(coordinates: Floats, decimals: int, largest: float) -> bool:
    """Whether all coordinates have so many decimals, but for the rounding of 64-bit numbers."""
    within = 4 * float(np.spacing(largest))
    # Of random numbers one in sixteen, at most, seems to have them.
    if not 64 * within < 10.0**-decimals < np.inf:
        return False
    few = coordinates.ravel()[:FIRST_TESTED]
    return all(bool((np.abs(part.round(decimals) - part) <= within).all()) for part in (few, coordinates))


# -------------------- scaled_nodes
# The nodes of a mesh moved to the middle and scaled to a size of 1, without a copy of the node table.


class ScaledNodes(NamedTuple):
    """Nodes, rows (3, nodes), of which `middle`, (3,), becomes 0 and `extent` becomes 1."""

    rows: Floats
    middle: Floats
    extent: float

    def corners(self, node_rows: Indices) -> Floats:
        """The corners, (3, 4, polygons), of polygons with these nodes, (4, polygons)."""
        corners: Floats = np.take(self.rows, node_rows, axis=1)
        corners -= self.middle[:, None, None]
        corners /= self.extent
        return corners


def as_they_are(rows: Floats) -> ScaledNodes:
    """Nodes that are neither moved nor scaled."""
    return ScaledNodes(rows, np.zeros(3), 1.0)


# -------------------- plane_cells
# Groups of polygons that lie in one plane, found by hashing the planes to cells.
#
# A plane is characterized by three numbers, the same whichever way its normal points. Polygons whose
# numbers lie in one cell are compared with the largest of them, corner by corner, and then with the largest
# of those that are left. So polygons are never united over a chain of small differences, such as around a
# cylinder.

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


# -------------------- plane_fits
# Planes fitted to groups of polygons.


class Fits(NamedTuple):
    """A plane fitted to each group: a unit normal and a point, (3, groups), and how wide its polygons reach.

    `widths`, (groups,), is across the longest direction: of those of a square with area 1 it is about 1.
    """

    normals: Floats
    points: Floats
    widths: Floats

    def off(self, corners: Floats, groups: Indices) -> Floats:
        """How far corners, (3, 4, n), are from the planes of `groups`, (n,), on their signed side: (4, n)."""
        off: Floats = np.einsum(
            "in,icn->cn",
            np.take(self.normals, groups, axis=1),
            corners - np.take(self.points, groups, axis=1)[:, None],
        )
        return off


def fitted(found: Facets, groups: Indices) -> Fits:
    """The planes from which the corners are least far; `groups` are sorted, and numbered without gaps."""
    if not len(groups):
        return Fits(np.empty((3, 0)), np.empty((3, 0)), np.empty(0))
    first = np.flatnonzero(np.diff(groups, prepend=-1))
    weights = found.areas / np.add.reduceat(found.areas, first)[groups]
    points = np.add.reduceat(weights * found.centers, first, axis=1)
    away = found.corners - points[:, None, groups]
    spread = np.add.reduceat(np.einsum("n,icn,jcn->nij", weights, away, away), first, axis=0)
    # The normal is the direction in which the corners spread least.
    spreads, directions = np.linalg.eigh(spread)
    return Fits(directions[:, :, 0].T.copy(), points, np.sqrt(np.maximum(spreads[:, 1], 0.0)))


def renumbered(groups: Indices) -> Indices:
    """Sorted group numbers without gaps, from 0."""
    numbers: Indices = np.cumsum(np.diff(groups, prepend=groups[:1]) != 0)
    return numbers


# -------------------- plane_levels
# Levels: patches of polygons that lie in one plane within a tolerance, but at a distance that is real.
#
# Corners that were rounded are scattered to both sides of their plane. A patch all of whose corners are on
# one side, by more than they are scattered, lies in front of the others or behind them and has a plane of
# its own.

MOST_LEVELS: Final = 8
"""How many levels of a plane are found at most; what is left is one more."""

PASSES: Final = 3
"""How often a plane is fitted to a level: to its largest patch, and then to all that are near it."""

FACTOR: Final = 4.0
"""Assumed: the distance of a patch is real if it is so many times its scatter and a corner's rounding."""

UNKNOWN: Final = 32.0
"""Assumed: so many times its scatter, if it isn't known how corners are rounded; measured: with 4, in some of
the planes of a few triangles that were rounded and then moved a decal was apart."""


def levels(found: Facets, groups: Indices, patches: Indices, rounding: Rounding, middle: Floats) -> Indices:
    """The level of each polygon in its group, 0 for that of the largest patch.

    `groups` are sorted; `patches` are numbers of patches, none in two groups. `rounding` is that of the
    coordinates of `found` plus `middle`, (3,).
    """
    result = np.full(len(groups), MOST_LEVELS, np.intp)
    left = np.arange(len(groups))
    for level in range(MOST_LEVELS):
        if not len(left):
            break
        near = _level(
            part_of(found, left),
            renumbered(groups[left]),
            np.unique(patches[left], return_inverse=True)[1],
            rounding,
            middle,
        )
        result[left[near]] = level
        left = left[~near]
    return result


def _level(found: Facets, groups: Indices, patches: Indices, rounding: Rounding, middle: Floats) -> Booleans:
    """Which polygons lie at the level of the largest patch of their group."""
    group = np.empty(int(patches.max()) + 1, np.intp)
    group[patches] = groups
    areas = np.bincount(patches, found.areas)
    order = np.lexsort((-areas, group))
    largest = order[np.diff(group[order], prepend=-1) != 0]
    near = np.zeros(len(group), np.bool_)
    near[largest] = True
    corners = np.bincount(patches) * 4.0
    for _ in range(PASSES):
        core = np.flatnonzero(near[patches])
        fits = fitted(found if len(core) == len(patches) else part_of(found, core), groups[core])
        off = fits.off(found.corners, groups)
        mean = np.bincount(patches, off.sum(axis=0)) / corners
        scatter = np.sqrt(np.bincount(patches, ((off - mean[patches]) ** 2).sum(axis=0)) / corners)
        square = np.bincount(groups[core], (off[:, core] ** 2).sum(axis=0))
        scattered = scatter + np.sqrt(square / np.bincount(groups[core]) / 4)[group]
        away = found.centers - fits.points[:, groups]
        reach = np.sqrt(np.bincount(patches, (away**2).sum(axis=0)) * 4 / corners)
        # The plane is as inexact as its corners, and more so beside it.
        beside = 1 + 2 * reach / np.where(fits.widths > 0, fits.widths, np.inf)[group]
        least = np.full(len(group), rounding.most)
        # Along an axis all corners of a plane are rounded alike.
        at = np.abs(fits.normals).argmax(axis=0)
        along = np.abs(fits.normals).sum(axis=0) < 1 + 1e-9
        distances = np.abs(fits.points[at, np.arange(len(at))] + middle[at])
        exact = EXACT * (1 + float(np.abs(middle).max()))
        alike = along[group] & (scattered <= exact)
        least[alike] = np.maximum(rounding.fraction * distances[group[alike]], exact)
        before = near
        near = np.abs(mean) <= (FACTOR if rounding.known else UNKNOWN) * scattered + FACTOR * least * beside
        near[largest] = True
        if (near == before).all():
            break
    return near[patches]


# -------------------- plane_unions
# Unites groups of polygons that lie in one fitted plane, and single polygons with such groups.
#
# A small polygon tells little of the plane it lies in, so that the polygons of a large and finely divided
# ground may be found as several groups. The planes that are fitted to many polygons are far more exact.

MOST_SAMPLES: Final = 256
"""To how many polygons of a group a plane is fitted at most, when groups are united."""

LEAST_UNITING: Final = 8
"""Assumed: the plane of a group of fewer polygons is no more exact than that of the widest of them, with
which all have been compared before."""

ROUNDS: Final = 2
"""Assumed: after two rounds nothing is left that could be united."""


class _Sampled(NamedTuple):
    """Groups of several polygons: some polygons of each, the group of each of them, and the fitted planes.

    `first` has the first polygon of each group; `uniting` are the groups that others may be united with.
    """

    polygons: Indices
    groups: Indices
    first: Indices
    fits: Fits
    uniting: Indices


def unite_in_fitted_planes(
    nodes: ScaledNodes,
    node_rows: Indices,
    parents: Indices,
    cells: PlaneCells,
    tolerance: float,
) -> None:
    """Unite what lies in one plane; `parents`, as from `coplanar_groups`, is changed in place."""
    for _ in range(ROUNDS):
        sampled = _sampled(nodes, node_rows, parents)
        if sampled is None:
            return
        before = len(united_items(parents))
        if _unite_groups(nodes, node_rows, parents, sampled, tolerance):
            sampled = _sampled(nodes, node_rows, parents) or sampled
        _unite_polygons(nodes, node_rows, parents, sampled, cells, tolerance)
        if len(united_items(parents)) == before:
            return


def _sampled(nodes: ScaledNodes, node_rows: Indices, parents: Indices) -> _Sampled | None:
    """The groups; None if there is none that others may be united with."""
    united = united_items(parents)
    roots = roots_of(parents, united)
    counts = np.bincount(roots)
    roots, sizes = np.flatnonzero(counts), counts[counts > 0] + 1
    uniting = np.flatnonzero(sizes >= LEAST_UNITING)
    if not len(uniting):
        return None
    # Each group begins with its root.
    united = united[np.argsort(parents[united], kind="stable")]
    polygons = np.insert(united, np.cumsum(sizes - 1) - (sizes - 1), roots)
    numbers = np.repeat(np.arange(len(sizes)), sizes)
    # Take every so many polygons of a group, as those with neighboring numbers may lie close together.
    place = np.arange(len(polygons)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    chosen = place % (-(-sizes // MOST_SAMPLES))[numbers] == 0
    polygons, numbers = polygons[chosen], numbers[chosen]
    fits = fitted(facets(nodes.corners(node_rows[:, polygons])), numbers)
    return _Sampled(polygons, numbers, roots, fits, uniting)


class _Registered(NamedTuple):
    """The cells in and beside which the fitted planes lie, sorted, and the plane for each, widest first."""

    cells: Numbers
    planes: Indices

    def near(self, cells: Numbers) -> tuple[Indices, Indices]:
        """Where the planes of some cells begin and end."""
        return np.searchsorted(self.cells, cells), np.searchsorted(self.cells, cells, "right")


def _registered(sampled: _Sampled) -> _Registered:
    fits, planes = sampled.fits, sampled.uniting
    normals = fits.normals[:, planes]
    distances = dot(normals, fits.points[:, planes])
    sides = np.array(np.meshgrid(*3 * [(-CELL / 2, CELL / 2)])).reshape(3, -1)
    cells = np.concatenate([cells_of_planes(normals, distances, side) for side in sides.T])
    planes = np.tile(planes, sides.shape[1])
    order = np.lexsort((-fits.widths[planes], cells))
    return _Registered(cells[order], planes[order])


def _unite_groups(
    nodes: ScaledNodes, node_rows: Indices, parents: Indices, sampled: _Sampled, tolerance: float
) -> bool:
    """Unite each group with the widest one in whose plane all of its polygons lie; whether any was united."""
    fits = sampled.fits
    registered = _registered(sampled)
    start, stop = registered.near(cells_of_planes(fits.normals, dot(fits.normals, fits.points)))
    first = sampled.first
    found = facets(nodes.corners(node_rows[:, sampled.polygons]))
    limits = np.minimum(tolerance, SHARPEST * found.widths)
    left, united = np.ones(len(first), np.bool_), False
    for rank in range(MOST_PLANES):
        left &= start + rank < stop
        if not left.any():
            break
        plane = registered.planes.take(np.minimum(start + rank, stop - 1))
        wider = (fits.widths[plane] > fits.widths) | (
            (fits.widths[plane] == fits.widths) & (plane < np.arange(len(plane)))
        )
        left &= wider
        rows = np.flatnonzero(left[sampled.groups])
        off = np.abs(fits.off(found.corners[:, :, rows], plane[sampled.groups[rows]])).max(axis=0)
        beyond = np.bincount(sampled.groups[rows[off > limits[rows]]], minlength=len(first))
        same = np.flatnonzero(left & (beyond == 0))
        unite(parents, first[same], first[plane[same]])
        left[same] = False
        united |= len(same) > 0
    return united


def _unite_polygons(
    nodes: ScaledNodes,
    node_rows: Indices,
    parents: Indices,
    sampled: _Sampled,
    cells: PlaneCells,
    tolerance: float,
) -> None:
    """Unite each polygon that is alone with the widest group in whose plane it lies."""
    registered = _registered(sampled)
    first = sampled.first
    # Of a group only the first is its own parent.
    alone = cells.widths > 0
    alone[united_items(parents)] = False
    alone[sampled.first] = False
    # Most of the polygons are in cells without a plane.
    slots = np.zeros(4 << len(registered.cells).bit_length(), np.bool_)
    slots[registered.cells & (len(slots) - 1)] = True
    mask = cells.hashes.dtype.type(len(slots) - 1)
    found_alone = [
        np.flatnonzero(alone[chunk] & slots.take(cells.hashes[0, chunk] & mask)) + chunk.start
        for chunk in chunks(len(alone), POLYGONS_AT_ONCE)
    ]
    left = np.concatenate([np.empty(0, np.intp), *found_alone])
    start, stop = registered.near(cells.keys(nodes, node_rows, left))
    some = start < stop
    left, start, stop = left[some], start[some], stop[some]
    for chunk in chunks(len(left), POLYGONS_AT_ONCE):
        polygons = left[chunk]
        found = facets(nodes.corners(node_rows[:, polygons]))
        limits = np.minimum(tolerance, SHARPEST * found.widths)
        rows = np.arange(len(polygons))
        for rank in range(MOST_PLANES):
            rows = rows[start[chunk][rows] + rank < stop[chunk][rows]]
            if not len(rows):
                break
            plane = registered.planes[start[chunk][rows] + rank]
            off = np.abs(sampled.fits.off(found.corners[:, :, rows], plane)).max(axis=0)
            within = off <= limits[rows]
            unite(parents, polygons[rows[within]], first[plane[within]])
            rows = rows[~within]


TOLERANCE: Final = 2e-6
"""Assumed: the largest distance of a corner from its plane, as a fraction of the size of the mesh."""

MOST_OFFSET: Final = 4.0
"""Assumed: the tolerance is in proportion to the largest coordinate, as float32 is rounded, up to so much."""

DIRECTIONS: Final = 16
"""In how many directions patches may lie apart."""

MOST_PATCHES: Final = 64
"""Of how many patches in a plane each is compared with each; of more it is assumed that some overlap."""


@dataclass(frozen=True, eq=False, repr=False)
class SharedPlanes(Immutable):
    """Planes, each of several polygons.

    `normals` and `points` are (3, planes): a unit normal and a point of each. No corner is farther from its
    plane than `distances`, (planes,). `plane_of_polygon`, (polygons,) intp, is a column of them, -1 for none;
    `turned`, (polygons,), tells which polygons have a normal against that of their plane.
    """

    normals: Floats
    points: Floats
    distances: Floats
    plane_of_polygon: Indices
    turned: Booleans


def shared_planes(coordinates: Floats, node_numbers: Indices) -> SharedPlanes | None:
    """The planes in which polygons may overlap; None if there is none."""
    coordinate_rows, node_rows = coordinates.T, node_numbers.T
    low, high = used_bounds(coordinate_rows, node_rows)
    extent = float((high - low).max())
    if not 0 < extent < np.inf:
        return None
    middle = low / 2 + high / 2
    tolerance = TOLERANCE * min(max(float(np.abs([low, high]).max()) / extent, 1.0), MOST_OFFSET)
    scaled = ScaledNodes(coordinate_rows, middle, extent)

    # Find groups of polygons that seem to lie in one plane, and sort the polygons by group.
    cells = plane_cells(scaled, node_rows, tolerance)
    parents = coplanar_groups(scaled, node_rows, cells, tolerance)
    unite_in_fitted_planes(scaled, node_rows, parents, cells, tolerance)
    del cells
    polygons, groups = _in_groups(parents)
    del parents
    # Drop those that are one patch, before anything large is computed.
    normals = facet_normals(scaled, node_rows[:, polygons])
    first = np.searchsorted(groups, groups)
    turned = dot(normals, np.take(normals, first, axis=1)) < 0
    places = places_of_corners(coordinate_rows, node_rows[:, polygons])
    patches, several = _patches(places, groups, turned)
    polygons, groups, places = polygons[several], renumbered(groups[several]), places[:, several]
    # Take those apart that lie in front of each other.
    rounding = coordinate_rounding(np.take(coordinate_rows, node_rows[:, polygons].ravel(), axis=1))
    level = levels(
        facets(scaled.corners(node_rows[:, polygons])),
        groups,
        patches[several],
        rounding._replace(most=rounding.most / extent),
        middle / extent,
    )
    groups = groups * (MOST_LEVELS + 1) + level
    order = np.argsort(groups, kind="stable")
    polygons, groups, places = polygons[order], groups[order], places[:, order]
    # Drop those that are too far from the plane of the others, or lie beside all of them.
    for beside in (False, True, False):
        found = facets(scaled.corners(node_rows[:, polygons]))
        groups, fits, off = _fitted_and_off(found, groups)
        normals = fits.normals[:, groups]
        kept = off <= np.minimum(tolerance, SHARPEST * found.widths)
        if beside:
            patches, several = _patches(places, groups, dot(found.normals, normals) < 0)
            kept &= several & ~_lie_apart(patches, groups, found.corners, normals)[groups]
        kept &= np.bincount(groups[kept], minlength=1 + int(groups.max(initial=0))).take(groups) > 1
        polygons, groups, places = polygons[kept], groups[kept], places[:, kept]
        if not len(polygons):
            return None

    found = facets(scaled.corners(node_rows[:, polygons]))
    groups, fits, off = _fitted_and_off(found, groups)
    first = np.flatnonzero(np.diff(groups, prepend=-1))
    plane_of_polygon = np.full(node_rows.shape[1], -1, np.intp)
    plane_of_polygon[polygons] = groups
    turned = np.zeros(node_rows.shape[1], np.bool_)
    turned[polygons] = dot(found.normals, fits.normals[:, groups]) < 0
    return SharedPlanes(
        fits.normals,
        fits.points * extent + middle[:, None],
        np.maximum.reduceat(off, first) * extent,
        plane_of_polygon,
        turned,
    )


def _in_groups(parents: Indices) -> tuple[Indices, Indices]:
    """The polygons that are in a group of several, sorted by group, and their groups, numbered from 0."""
    united = united_items(parents)
    roots = roots_of(parents, united)
    firsts = np.unique(roots)
    polygons = np.concatenate([firsts, united])
    groups = np.searchsorted(firsts, np.concatenate([firsts, roots]))
    order = np.lexsort((polygons, groups))
    return polygons[order], groups[order]


def _fitted_and_off(found: Facets, groups: Indices) -> tuple[Indices, Fits, Floats]:
    """The groups numbered without gaps, the planes fitted to them, and how far each facet is off its own."""
    groups = renumbered(groups)
    fits = fitted(found, groups)
    return groups, fits, np.abs(fits.off(found.corners, groups)).max(axis=0)


def _patches(places: Indices, groups: Indices, turned: Booleans) -> tuple[Indices, Booleans]:
    """The patch of each polygon, and whether its group is more than one simple patch.

    `places` is as from `places_of_corners`. An edge with two polygons on one side, which overlap, joins none.
    """
    start, end = places, np.roll(places, -1, axis=0)
    keys = (np.minimum(start, end) * (int(places.max(initial=0)) + 1) + np.maximum(start, end)).T.ravel()
    forward = ((start < end) ^ turned).T.ravel()
    edges = np.flatnonzero((start != end).T.ravel())
    # Edges are in the order of the groups, and so are equal ones after a stable sort.
    edges = edges[np.argsort(keys[edges], kind="stable")]
    keys, forward, polygon = keys[edges], forward[edges], edges >> 2
    shared = (keys[1:] == keys[:-1]) & (groups[polygon[1:]] == groups[polygon[:-1]])
    folded = shared & (forward[1:] == forward[:-1])
    folded[1:] |= shared[1:] & shared[:-1]
    # Unite polygons across their edges, but for those that are folded.
    parents = np.arange(len(groups))
    joined = shared & ~folded
    unite(parents, polygon[:-1][joined], polygon[1:][joined])
    several = np.bincount(groups[parents == np.arange(len(groups))], minlength=1) > 1
    several[groups[polygon[1:][folded]]] = True
    return group_numbers(parents), several[groups]


def _lie_apart(patches: Indices, groups: Indices, corners: Floats, normals: Floats) -> Booleans:
    """For each group whether no two of its patches overlap as seen along every direction of the plane."""
    order = np.argsort(patches, kind="stable")
    first = np.flatnonzero(np.diff(patches[order], prepend=-1))
    group = groups[order[first]]
    counts = np.bincount(group, minlength=int(groups.max(initial=-1)) + 1)
    lie_apart = (counts > 1) & (counts <= MOST_PATCHES)
    if not lie_apart.any():
        return lie_apart
    # Find the interval that each patch covers along each direction.
    across = cross(normals, np.eye(3)[np.abs(normals).argmin(axis=0)].T)
    along = cross(normals, across)
    low, high = np.empty((2, DIRECTIONS, len(first)))
    for row, angle in enumerate(np.arange(DIRECTIONS) * (np.pi / DIRECTIONS)):
        direction = np.cos(angle) * across + np.sin(angle) * along
        reached = np.einsum("in,icn->cn", direction, corners)[:, order]
        low[row] = np.minimum.reduceat(reached.min(axis=0), first)
        high[row] = np.maximum.reduceat(reached.max(axis=0), first)
    # Compare each patch with those that follow it in its group.
    by_group = np.argsort(group, kind="stable")
    for distance in range(1, int(counts[lie_apart].max(initial=0))):
        one, other = by_group[:-distance], by_group[distance:]
        pairs = np.flatnonzero((group[one] == group[other]) & lie_apart[group[one]])
        one, other = one[pairs], other[pairs]
        overlap = (high[:, one] > low[:, other] + TOLERANCE) & (high[:, other] > low[:, one] + TOLERANCE)
        lie_apart[group[one[overlap.all(axis=0)]]] = False
    return lie_apart
