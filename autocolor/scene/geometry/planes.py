"""Planes that several polygons share and in which they may overlap, such as those of a decal and its ground.

The promise: polygons that share a plane are never torn. They have one depth, and the later one in the file
wins wherever they overlap. The planes are found in five steps:

1. Hash the plane of each polygon to a cell. Within a cell, unite the polygons that lie in the plane of the
   largest, corner by corner.
2. Fit a plane to each group of polygons. Unite the groups, and the polygons that are still alone, that lie in
   the fitted plane of a wider group.
3. Drop the groups that are one simple patch: its polygons adjoin, and none can overlap another.
4. Divide groups into levels: a patch that is really in front of the other patches has a plane of its own.
5. Drop polygons that are too far from the plane of their group, and groups whose patches lie side by side.

Assumed: polygons lie in one plane if no corner is farther from it than two millionths of the mesh's size.
This is more than float32, or six decimals, round the corners of a mesh of a unit or more. A patch is really
in front if its corners are all on one side of the plane of the others, on average by more than four times
their scatter and four times the rounding of a coordinate. The rounding is measured at the coordinates: half a
unit in the last place of float32 or of their decimals, or a few units of float64. The corners of patches
exactly across an axis are rounded alike, so that any difference is real.

What is missed: a polygon narrower than a five-hundredth of the mesh may be rounded to too different a plane;
it is then left out. Of more than 16,384 polygons, at least one polygon of a plane must be among the 16,384
widest. Coordinates of fewer decimals than six a unit are too coarse.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import (
    Booleans,
    Floats,
    Indices,
    LowBits,
    chunks,
    cross,
    dot,
    lengths,
    underflowing,
    used_bounds,
)
from autocolor.immutable import Immutable
from autocolor.scene.geometry.normals import (
    edge_keys,
    group_numbers,
    places_of_corners,
    roots_of,
    unite,
    united_items,
)

TOLERANCE: Final = 2e-6
"""Assumed: the largest distance of a corner from its plane, as a fraction of the size of the mesh."""

MOST_OFFSET: Final = 4.0
"""Assumed: the tolerance is in proportion to the largest coordinate, as float32 is rounded, up to this."""

SHARPEST: Final = 2e-4
"""Assumed: how far a corner may be off a plane, as a fraction of its polygon's width."""

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


@underflowing
def shared_planes(coordinates: Floats, node_numbers: Indices) -> SharedPlanes | None:
    """The planes in which polygons may overlap; None if there are no such planes."""
    coordinate_rows, node_rows = coordinates.T, node_numbers.T
    low, high = used_bounds(coordinate_rows, node_rows)
    extent = float((high - low).max())
    if not 0 < extent < np.inf:
        return None
    middle = low / 2 + high / 2
    tolerance = TOLERANCE * min(max(float(np.abs([low, high]).max()) / extent, 1.0), MOST_OFFSET)
    mesh = ScaledPolygons(coordinate_rows, node_rows, middle, extent)

    # Unite the polygons that seem to lie in one plane, and sort them by group.
    cells = plane_cells(mesh, tolerance)
    parents = coplanar_groups(mesh, cells, tolerance)
    unite_in_fitted_planes(mesh, parents, cells, tolerance)
    del cells
    polygons, groups = _in_groups(parents)
    del parents
    # Drop the groups that are one patch, before anything large is computed.
    normals = mesh.normals(polygons)
    turned = dot(normals, np.take(normals, np.searchsorted(groups, groups), axis=1)) < 0
    places = places_of_corners(coordinate_rows, node_rows[:, polygons])
    patches, several = _patches(places, groups, turned)
    polygons, groups, places = polygons[several], renumbered(groups[several]), places[:, several]
    # Divide the groups into levels. Beside a tiny extent, the middle may be infinitely far.
    with np.errstate(over="ignore"):
        middle_in_extents = middle / extent
    rounding = coordinate_rounding(np.take(coordinate_rows, node_rows[:, polygons].ravel(), axis=1))
    level = levels(
        mesh.facets(polygons),
        groups,
        patches[several],
        rounding._replace(most=rounding.most / extent),
        middle_in_extents,
    )
    groups = groups * (MOST_LEVELS + 1) + level
    order = np.argsort(groups, kind="stable")
    polygons, groups, places = polygons[order], groups[order], places[:, order]
    # Drop polygons that are too far from the plane of their group, then groups whose patches lie apart, and
    # the polygons that are too far from the planes that are left.
    for drops_apart in (False, True, False):
        facets = mesh.facets(polygons)
        groups, fits, off = _fitted_and_off(facets, groups)
        fit = off <= np.minimum(tolerance, SHARPEST * facets.widths)
        if drops_apart:
            normals = fits.normals[:, groups]
            patches, several = _patches(places, groups, dot(facets.normals, normals) < 0)
            fit &= several & ~_lie_apart(patches, groups, facets.corners, normals)[groups]
        fit &= np.bincount(groups[fit], minlength=1 + int(groups.max(initial=0))).take(groups) > 1
        polygons, groups, places = polygons[fit], groups[fit], places[:, fit]
        if not len(polygons):
            return None

    facets = mesh.facets(polygons)
    groups, fits, off = _fitted_and_off(facets, groups)
    plane_of_polygon = np.full(node_rows.shape[1], -1, np.intp)
    plane_of_polygon[polygons] = groups
    turned = np.zeros(node_rows.shape[1], np.bool_)
    turned[polygons] = dot(facets.normals, fits.normals[:, groups]) < 0
    return SharedPlanes(
        fits.normals,
        fits.points * extent + middle[:, None],
        np.maximum.reduceat(off, _firsts(groups)) * extent,
        plane_of_polygon,
        turned,
    )


class Facets(NamedTuple):
    """Polygons as flat pieces.

    `corners` is (3, 4, n); unit `normals` and `centers` are (3, n), `areas` (twice the true ones) and
    `widths` (n,). A polygon without area has a normal, an area and a width of 0.
    """

    corners: Floats
    normals: Floats
    centers: Floats
    areas: Floats
    widths: Floats

    def some(self, rows: Indices | Booleans) -> Facets:
        """Some of the facets."""
        return Facets(*(table[..., rows] for table in self))


def facets_of(corners: Floats) -> Facets:
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


class ScaledPolygons(NamedTuple):
    """Polygons, `node_rows` (4, polygons), and their nodes, `rows` (3, nodes), moved and scaled.

    The point `middle`, (3,), becomes 0, and the length `extent` becomes 1. The node table is not copied.
    """

    rows: Floats
    node_rows: Indices
    middle: Floats = np.zeros(3)
    extent: float = 1.0

    def facets(self, polygons: Indices | slice) -> Facets:
        """Some of the polygons as facets."""
        corners = np.take(self.rows, self.node_rows[:, polygons], axis=1)
        corners -= self.middle[:, None, None]
        corners /= self.extent
        return facets_of(corners)

    def normals(self, polygons: Indices) -> Floats:
        """The unit normals of some polygons, (3, n), computed in chunks."""
        normals = np.empty((3, len(polygons)))
        for chunk in chunks(len(polygons), POLYGONS_AT_ONCE):
            normals[:, chunk] = self.facets(polygons[chunk]).normals
        return normals


# Cells. Three numbers characterize a plane, the same whichever way its normal points. Polygons whose numbers
# lie in one cell are compared with the largest polygon there, corner by corner; the rest of them with the
# largest of the rest, and so on. So a chain of small differences, such as around a cylinder, unites no
# polygons.

CELL: Final = 1 / 256
"""The size of a cell; measured: with a fourth of it, and with four times as much, random scenes have the same
planes."""

SHIFTS: Final = (0.0, 0.37, 0.71)
"""Offsets of three grids of cells: no plane is at a boundary in all grids."""

MOST_PLANES: Final = 8
"""The most planes that are found in a cell."""

MOST_GROUNDS: Final = 1 << 14
"""Assumed: how many polygons of a mesh, the widest, are compared with all others in their cells."""

FORMS: Final = np.random.default_rng(1983).uniform(-1, 1, (3, 3, 4))
"""Three bilinear forms of n and (n, d), which are the same for the plane (-n, -d)."""

MIXERS: Final = np.array([0x1E3779B97F4A7C15, 0x42B2AE3D27D4EB4F, 0x165667B19E3779F9], np.int64)
"""Odd numbers with well-spread bits, which make one hash of three whole numbers."""


class PlaneCells(NamedTuple):
    """The cells of the planes of polygons, and the widths of the polygons, 0 if they are not flat.

    `hashes`, (grids, polygons) uint32, has a hash of each cell; two cells may share one, because all polygons
    of a hash are compared anyway. `widths` is (polygons,).
    """

    hashes: LowBits
    widths: Floats


def plane_cells(mesh: ScaledPolygons, tolerance: float) -> PlaneCells:
    """The cell of each polygon in each grid, and its width."""
    count = mesh.node_rows.shape[1]
    hashes, widths = np.empty((len(SHIFTS), count), np.uint32), np.empty(count)
    for chunk in chunks(count, POLYGONS_AT_ONCE):
        facets = mesh.facets(chunk)
        warp = np.abs(dot(facets.normals, facets.corners[:, 0] - facets.centers))
        widths[chunk] = np.where(warp <= np.minimum(tolerance, SHARPEST * facets.widths), facets.widths, 0.0)
        numbers = _numbers_of_planes(facets.normals, dot(facets.normals, facets.centers))
        for row, shift in zip(hashes, SHIFTS, strict=True):
            row[chunk] = _hashes(numbers, shift)
    return PlaneCells(hashes, widths)


def _numbers_of_planes(normals: Floats, distances: Floats) -> Floats:
    """The three numbers of each plane, (3, planes), with these normals and distances from the origin.

    Rejected: a matrix product, which rounds the numbers of a plane differently among other planes.
    """
    planes = [*normals, distances]
    numbers = np.zeros((len(FORMS), len(distances)))
    for number, form in zip(numbers, FORMS, strict=True):
        for normal, factors in zip(normals, form.tolist(), strict=True):
            number += normal * sum(factor * row for factor, row in zip(factors, planes, strict=True))
    return numbers


def _hashes(numbers: Floats, shift: float) -> LowBits:
    """The hash of the cell of each plane, whose numbers are (3, planes), in a grid."""
    hashes: LowBits = (MIXERS @ np.floor(numbers / CELL + shift).astype(np.int64)).astype(np.uint32)
    return hashes


def coplanar_groups(mesh: ScaledPolygons, cells: PlaneCells, tolerance: float) -> Indices:
    """Union-find parents of the polygons, with polygons united that seem to lie in one plane.

    Coordinates are around 0 and of at most about 1 in size; corners are exact to the tolerance.
    """
    count = len(cells.widths)
    rank = max(count - MOST_GROUNDS, 0)
    grounds = np.flatnonzero(cells.widths >= (np.partition(cells.widths, rank)[rank] if count else 0.0))
    left = cells.widths > 0
    parents = np.arange(count)
    for hashes in cells.hashes:
        # Take the polygons that share their cell with another, and sort them by cell.
        beside = _in_cells(hashes, hashes[grounds[left[grounds]]], left)
        _, cell, sizes = np.unique(hashes[beside], return_inverse=True, return_counts=True)
        several = sizes[cell] > 1
        beside, cell = beside[several], cell[several]
        order = np.argsort(cell, kind="stable")
        # A chunk may end within a cell; the seeds of its two parts meet in the other grids.
        for chunk in chunks(len(order), POLYGONS_AT_ONCE):
            polygons = beside[order[chunk]]
            seeds, members = _in_plane_of_largest(mesh.facets(polygons), cell[order[chunk]], tolerance)
            unite(parents, polygons[seeds], polygons[members])
            # The seed alone stands for its group in the other grids.
            left[polygons[members[members != seeds]]] = False
    return parents


def _in_cells(hashes: LowBits, cells: LowBits, candidates: Booleans) -> Indices:
    """The candidates that lie in some cells, and a few other candidates.

    For many polygons and few cells, a table of low bits is far faster than a search.
    """
    mask = np.uint32((64 << len(cells).bit_length()) - 1)
    slots = np.zeros(int(mask) + 1, np.bool_)
    slots[cells & mask] = True
    parts = [
        np.flatnonzero(candidates[chunk] & slots.take(hashes[chunk] & mask)) + chunk.start
        for chunk in chunks(len(hashes), POLYGONS_AT_ONCE)
    ]
    return np.concatenate([np.empty(0, np.intp), *parts])


def _in_plane_of_largest(facets: Facets, cells: Indices, tolerance: float) -> tuple[Indices, Indices]:
    """Pairs of facets in one plane: in each cell the largest, and the facets that lie in its plane."""
    rows = np.lexsort((-facets.areas, cells))
    seeds, members = [np.empty(0, np.intp)], [np.empty(0, np.intp)]
    for _ in range(MOST_PLANES):
        _, first, cell, sizes = np.unique(
            cells[rows], return_index=True, return_inverse=True, return_counts=True
        )
        several = sizes[cell] > 1
        rows, seed = rows[several], rows[first[cell[several]]]
        if not len(rows):
            break
        # The error of the seed's plane grows with the distance from its corners.
        away = facets.corners[:, :, rows] - facets.centers[:, None, seed]
        off = np.abs(np.einsum("in,ijn->jn", facets.normals[:, seed], away)).max(axis=0)
        reach = np.sqrt(np.einsum("ijn,ijn->jn", away, away).max(axis=0))
        within = off <= tolerance * (1 + 2 * reach / facets.widths[seed])
        within &= off <= SHARPEST * facets.widths[rows]
        seeds.append(seed[within])
        members.append(rows[within])
        rows = rows[~within]
    return np.concatenate(seeds), np.concatenate(members)


# Fitted planes. The plane of a small polygon is inexact, so that the polygons of a large and finely divided
# ground may be united to several groups. A plane fitted to many polygons is far more exact.

MOST_SAMPLES: Final = 256
"""The most polygons of a group to which a plane is fitted when groups are united."""

LEAST_UNITING: Final = 8
"""Assumed: the fewest polygons of a group that unites others. The fitted plane of a smaller group is no more
exact than the plane of its widest polygon, with which all polygons were compared before."""


class Fits(NamedTuple):
    """A plane fitted to each group: a unit normal and a point, (3, groups), and how wide its polygons reach.

    `widths`, (groups,), is across the longest direction, about 1 for a square with area 1.
    """

    normals: Floats
    points: Floats
    widths: Floats

    def off(self, corners: Floats, groups: Indices) -> Floats:
        """The signed distances of corners, (3, 4, n), from the planes of `groups`, (n,): (4, n)."""
        off: Floats = np.einsum(
            "in,icn->cn",
            np.take(self.normals, groups, axis=1),
            corners - np.take(self.points, groups, axis=1)[:, None],
        )
        return off


def fitted(facets: Facets, groups: Indices) -> Fits:
    """The planes that fit the corners best; `groups` are sorted, and numbered without gaps."""
    if not len(groups):
        return Fits(np.empty((3, 0)), np.empty((3, 0)), np.empty(0))
    first = _firsts(groups)
    weights = facets.areas / np.add.reduceat(facets.areas, first)[groups]
    points = np.add.reduceat(weights * facets.centers, first, axis=1)
    away = facets.corners - points[:, None, groups]
    spread = np.add.reduceat(np.einsum("n,icn,jcn->nij", weights, away, away), first, axis=0)
    # The normal is the direction in which the corners spread least.
    spreads, directions = np.linalg.eigh(spread)
    return Fits(directions[:, :, 0].T.copy(), points, np.sqrt(np.maximum(spreads[:, 1], 0.0)))


class GroupPlanes(NamedTuple):
    """Planes fitted to groups of several polygons, with the cells in and beside which the planes lie.

    `polygons` are samples of the groups, and `groups` the group of each sample. `first` has the first polygon
    of each group. `cells` are sorted hashes in the first grid. `planes` has the group whose plane lies in or
    beside each cell, the widest group first. Only the planes of large groups have cells.
    """

    polygons: Indices
    groups: Indices
    first: Indices
    fits: Fits
    cells: LowBits
    planes: Indices


def unite_in_fitted_planes(
    mesh: ScaledPolygons, parents: Indices, cells: PlaneCells, tolerance: float
) -> None:
    """Unite groups and single polygons that lie in one fitted plane; `parents` is changed in place.

    Measured: a second round united nothing more in 2,100 scenes.
    """
    # Unite the groups that lie in the plane of a wider one.
    planes = _planes_of_groups(mesh, parents)
    fits = planes.fits
    hashes = _hashes(_numbers_of_planes(fits.normals, dot(fits.normals, fits.points)), SHIFTS[0])
    samples = mesh.facets(planes.polygons)
    if _unite_with_planes(
        parents, planes, samples, planes.groups, planes.first, hashes, fits.widths, tolerance
    ):
        planes = _planes_of_groups(mesh, parents)
    # Unite the polygons that are alone. In a group, only the first polygon is its own parent.
    alone = cells.widths > 0
    alone[united_items(parents)] = False
    alone[planes.first] = False
    polygons = _in_cells(cells.hashes[0], planes.cells, alone)
    for chunk in chunks(len(polygons), POLYGONS_AT_ONCE):
        some = polygons[chunk]
        items, widths = np.arange(len(some)), np.full(len(some), -1.0)
        hashes = cells.hashes[0].take(some)
        _unite_with_planes(parents, planes, mesh.facets(some), items, some, hashes, widths, tolerance)


def _planes_of_groups(mesh: ScaledPolygons, parents: Indices) -> GroupPlanes:
    """The planes fitted to the groups of several polygons."""
    polygons, groups = _in_groups(parents)
    starts, sizes = _firsts(groups), np.bincount(groups)
    first = polygons[starts]
    # Sample every k-th polygon of a group, because polygons with neighboring numbers may lie close together.
    place = np.arange(len(polygons)) - starts[groups]
    samples = place % (-(-sizes // MOST_SAMPLES))[groups] == 0
    polygons, groups = polygons[samples], groups[samples]
    fits = fitted(mesh.facets(polygons), groups)

    # Look up the cells at the corners of a cell around each plane.
    planes = np.flatnonzero(sizes >= LEAST_UNITING)
    normals = fits.normals[:, planes]
    numbers = _numbers_of_planes(normals, dot(normals, fits.points[:, planes]))
    sides = np.array(np.meshgrid(*3 * [(-CELL / 2, CELL / 2)])).reshape(3, -1)
    cells = np.concatenate([_hashes(numbers + side[:, None], SHIFTS[0]) for side in sides.T])
    planes = np.tile(planes, sides.shape[1])
    order = np.lexsort((-fits.widths[planes], cells))
    return GroupPlanes(polygons, groups, first, fits, cells[order], planes[order])


def _unite_with_planes(
    parents: Indices,
    planes: GroupPlanes,
    samples: Facets,
    items: Indices,
    first: Indices,
    hashes: LowBits,
    widths: Floats,
    tolerance: float,
) -> bool:
    """Unite each item with the widest group whose plane holds all samples of the item.

    An item is a group or a single polygon. `items` has the item of each sample. `first` has the first polygon
    of each item, `hashes` its cell, and `widths` its width, which must be less than the group's. Returns
    whether any item was united.
    """
    start, stop = np.searchsorted(planes.cells, hashes), np.searchsorted(planes.cells, hashes, "right")
    limits = np.minimum(tolerance, SHARPEST * samples.widths)
    left, any_united = np.ones(len(first), np.bool_), False
    for rank in range(MOST_PLANES):
        left &= start + rank < stop
        if not left.any():
            break
        plane = planes.planes.take(np.minimum(start + rank, stop - 1))
        wider = planes.fits.widths[plane] - widths
        left &= (wider > 0) | ((wider == 0) & (plane < np.arange(len(plane))))
        rows = np.flatnonzero(left[items])
        off = np.abs(planes.fits.off(samples.corners[:, :, rows], plane[items[rows]])).max(axis=0)
        beyond = np.bincount(items[rows[off > limits[rows]]], minlength=len(first))
        same = np.flatnonzero(left & (beyond == 0))
        unite(parents, first[same], planes.first[plane[same]])
        left[same] = False
        any_united |= len(same) > 0
    return any_united


DIRECTIONS: Final = 16
"""The number of directions in which patches may lie apart."""

MOST_PATCHES: Final = 64
"""The most patches of a plane that are compared. Among more patches, overlaps are assumed."""


def _firsts(groups: Indices) -> Indices:
    """Where each group begins; `groups` are sorted."""
    return np.flatnonzero(np.diff(groups, prepend=-1))


def renumbered(groups: Indices) -> Indices:
    """Sorted group numbers without gaps, from 0."""
    numbers: Indices = np.cumsum(np.diff(groups, prepend=groups[:1]) != 0)
    return numbers


def _in_groups(parents: Indices) -> tuple[Indices, Indices]:
    """The polygons that are in a group of several, sorted by group, and their groups, numbered from 0."""
    united = united_items(parents)
    roots = roots_of(parents, united)
    firsts = np.unique(roots)
    polygons = np.concatenate([firsts, united])
    groups = np.searchsorted(firsts, np.concatenate([firsts, roots]))
    order = np.lexsort((polygons, groups))
    return polygons[order], groups[order]


def _fitted_and_off(facets: Facets, groups: Indices) -> tuple[Indices, Fits, Floats]:
    """The groups numbered without gaps, their fitted planes, and how far each facet is off its plane."""
    groups = renumbered(groups)
    fits = fitted(facets, groups)
    return groups, fits, np.abs(fits.off(facets.corners, groups)).max(axis=0)


def _patches(places: Indices, groups: Indices, turned: Booleans) -> tuple[Indices, Booleans]:
    """The patch of each polygon, and whether its group is more than one simple patch.

    A patch is simple if at most two polygons meet at each edge, one on either side. `places` is as from
    `places_of_corners`. Polygons on the same side of an edge overlap; such an edge joins no polygons.
    """
    start, end = places, np.roll(places, -1, axis=0)
    keys = edge_keys(start, end, int(places.max(initial=0)) + 1).T.ravel()
    forward = ((start < end) ^ turned).T.ravel()
    edges = np.flatnonzero(keys >= 0)
    # Edges are in the order of the groups; after a stable sort, so are equal edges.
    edges = edges[np.argsort(keys[edges], kind="stable")]
    keys, forward, polygon = keys[edges], forward[edges], edges >> 2
    shared = (keys[1:] == keys[:-1]) & (groups[polygon[1:]] == groups[polygon[:-1]])
    folded = shared & (forward[1:] == forward[:-1])
    folded[1:] |= shared[1:] & shared[:-1]
    # Unite polygons across their edges, unless they are folded there.
    parents = np.arange(len(groups))
    joined = shared & ~folded
    unite(parents, polygon[:-1][joined], polygon[1:][joined])
    several = np.bincount(groups[parents == np.arange(len(groups))], minlength=1) > 1
    several[groups[polygon[1:][folded]]] = True
    return group_numbers(parents), several[groups]


def _lie_apart(patches: Indices, groups: Indices, corners: Floats, normals: Floats) -> Booleans:
    """Whether every two patches of a group are apart along some direction of the plane, (groups,)."""
    order = np.argsort(patches, kind="stable")
    first = _firsts(patches[order])
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
    # Compare each patch with the patches that follow it in its group.
    by_group = np.argsort(group, kind="stable")
    for distance in range(1, int(counts[lie_apart].max(initial=0))):
        one, other = by_group[:-distance], by_group[distance:]
        pairs = np.flatnonzero((group[one] == group[other]) & lie_apart[group[one]])
        one, other = one[pairs], other[pairs]
        overlap = (high[:, one] > low[:, other] + TOLERANCE) & (high[:, other] > low[:, one] + TOLERANCE)
        lie_apart[group[one[overlap.all(axis=0)]]] = False
    return lie_apart


# Levels. Rounding scatters corners to both sides of their plane. If all corners of a patch are on one side,
# by more than their scatter, the patch lies in front of the others or behind them and has a level of its own.

MOST_LEVELS: Final = 8
"""The most levels of a plane that are told apart; all further patches are another level."""

PASSES: Final = 3
"""How often a plane is fitted to a level: first to its largest patch, then to all patches near the plane."""

FACTOR: Final = 4.0
"""Assumed: a patch is really in front if its distance is above this multiple of its scatter plus this
multiple of the rounding of a corner."""

UNKNOWN_ROUNDING_FACTOR: Final = 32.0
"""Assumed: the multiple of the scatter if the rounding of the corners is not known.

Measured: with 4, in some planes of a few triangles that were rounded and then moved, a decal was apart.
"""

EXACT: Final = 2.0**-46
"""Assumed: the rounding of a mesh placed in 64-bit numbers, as a fraction of the largest coordinate."""


class Rounding(NamedTuple):
    """How far rounding may have moved a coordinate: at most by `most`, and by a `fraction` of the coordinate.

    Rounding to decimals leaves equal coordinates equal: then `fraction` is the rounding of 64-bit numbers. If
    the rounding is not `known`, as in a mesh that was turned after it was rounded, both are the rounding of
    64-bit numbers.
    """

    most: float
    fraction: float
    known: bool = True


def levels(facets: Facets, groups: Indices, patches: Indices, rounding: Rounding, middle: Floats) -> Indices:
    """The level of each polygon in its group; the largest patch has level 0.

    `groups` are sorted; `patches` are numbers of patches, and no patch is in two groups. The coordinates of
    `facets` plus `middle`, (3,), have this `rounding`.
    """
    result = np.full(len(groups), MOST_LEVELS, np.intp)
    left = np.arange(len(groups))
    for level in range(MOST_LEVELS):
        if not len(left):
            break
        numbers = np.unique(patches[left], return_inverse=True)[1]
        near = _near_largest(facets.some(left), renumbered(groups[left]), numbers, rounding, middle)
        result[left[near]] = level
        left = left[~near]
    return result


def _near_largest(
    facets: Facets, groups: Indices, patches: Indices, rounding: Rounding, middle: Floats
) -> Booleans:
    """Which polygons lie at the level of the largest patch of their group."""
    group = np.empty(int(patches.max()) + 1, np.intp)
    group[patches] = groups
    order = np.lexsort((-np.bincount(patches, facets.areas), group))
    largest = order[_firsts(group[order])]
    near = np.zeros(len(group), np.bool_)
    near[largest] = True
    corners = np.bincount(patches) * 4.0
    for _ in range(PASSES):
        core = np.flatnonzero(near[patches])
        fits = fitted(facets.some(core), groups[core])
        off = fits.off(facets.corners, groups)
        mean = np.bincount(patches, off.sum(axis=0)) / corners
        scatter = np.sqrt(np.bincount(patches, ((off - mean[patches]) ** 2).sum(axis=0)) / corners)
        square = np.bincount(groups[core], (off[:, core] ** 2).sum(axis=0))
        scattered = scatter + np.sqrt(square / np.bincount(groups[core]) / 4)[group]
        away = facets.centers - fits.points[:, groups]
        reach = np.sqrt(np.bincount(patches, (away**2).sum(axis=0)) * 4 / corners)
        # The error of the plane grows with the distance from the corners that it was fitted to.
        beside = 1 + 2 * reach / np.where(fits.widths > 0, fits.widths, np.inf)[group]
        least = np.full(len(group), rounding.most)
        # In a plane across an axis, all corners are rounded alike.
        at = np.abs(fits.normals).argmax(axis=0)
        along = np.abs(fits.normals).sum(axis=0) < 1 + 1e-9
        distances = np.abs(fits.points[at, np.arange(len(at))] + middle[at])
        exact = EXACT * (1 + float(np.abs(middle).max()))
        alike = along[group] & (scattered <= exact)
        least[alike] = np.maximum(rounding.fraction * distances[group[alike]], exact)
        before = near
        factor = FACTOR if rounding.known else UNKNOWN_ROUNDING_FACTOR
        near = np.abs(mean) <= factor * scattered + FACTOR * least * beside
        near[largest] = True
        if (near == before).all():
            break
    return near[patches]


HALF_SINGLE: Final = 2.0**-24
"""Half a unit in the last place of a 32-bit number, as a fraction of the number, at most."""

LAST_BITS: Final = np.uint32(15)
"""The last four bits of a 32-bit number. A number with a 1 among these bits has at least 20 bits."""

MOST_DECIMALS: Final = 9


def coordinate_rounding(coordinate_rows: Floats) -> Rounding:
    """How coordinates, (3, n), were rounded: to 32-bit numbers, to at most nine decimals, or not at all.

    Decimals are recognized even if the mesh was moved after its coordinates were rounded.

    >>> coordinate_rounding(np.array([[0.123, 4.567], [0.1, 2.0], [0.0, 0.0]])).most
    0.0005
    """
    largest = float(np.abs(coordinate_rows).max(initial=0.0))
    exact = EXACT * largest
    with np.errstate(over="ignore", under="ignore"):
        singles = coordinate_rows.astype(np.float32)
    same = singles == coordinate_rows
    # Perhaps only some coordinates were rounded. A number of few bits proves nothing.
    if same.all() or (same & ((singles.view(np.uint32) & LAST_BITS) > 0)).any():
        return Rounding(HALF_SINGLE * largest, HALF_SINGLE)
    moved = coordinate_rows - coordinate_rows[:, :1]
    for decimals in range(MOST_DECIMALS + 1):
        if _have_decimals(moved, decimals, largest):
            return Rounding(max(10.0**-decimals / 2, exact), EXACT)
    return Rounding(exact, EXACT, known=False)


def _have_decimals(coordinates: Floats, decimals: int, largest: float) -> bool:
    """Whether all coordinates have so many decimals, up to the rounding of 64-bit numbers."""
    within = 4 * float(np.spacing(largest))
    # At most one random number in sixteen passes the test below by chance.
    if not 64 * within < 10.0**-decimals < np.inf:
        return False
    # Test few coordinates first: most often they decide.
    few = coordinates.ravel()[:64]
    return all(bool((np.abs(part.round(decimals) - part) <= within).all()) for part in (few, coordinates))
