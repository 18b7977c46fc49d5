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
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, cross, dot
from autocolor.immutable import Immutable
from autocolor.scene.geometry.fans import places_of_corners
from autocolor.scene.geometry.planes.coordinate_rounding import coordinate_rounding
from autocolor.scene.geometry.planes.plane_cells import (
    SHARPEST,
    Facets,
    coplanar_groups,
    facet_normals,
    facets,
    plane_cells,
)
from autocolor.scene.geometry.planes.plane_fits import Fits, fitted, renumbered
from autocolor.scene.geometry.planes.plane_levels import MOST_LEVELS, levels
from autocolor.scene.geometry.planes.plane_unions import unite_in_fitted_planes
from autocolor.scene.geometry.planes.scaled_nodes import ScaledNodes
from autocolor.scene.geometry.union_find import group_numbers, roots_of, unite, united_items
from autocolor.scene.geometry.used_rows import used_bounds

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
