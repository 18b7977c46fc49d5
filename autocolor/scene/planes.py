"""Planes that several polygons share and in which they may overlap, such as those of a decal and its ground.

Assumed: polygons lie in one plane if no corner is farther from it than two millionths of the mesh's size,
which is more than float32, or six decimals, round the corners of a mesh of a unit or more. A polygon
narrower than a five-hundredth of the mesh may be rounded to too different a plane; it is then left out. Of
more than 16,384 polygons, one of those that share a plane must be among the 16,384 widest.

Polygons that can't overlap are left out, too: those that are one patch in which at most two meet at each
edge, one on either side, as where a flat side is divided; and patches that lie side by side.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, cross, dot
from autocolor.scene.fans import places_of_corners
from autocolor.scene.plane_cells import SHARPEST, Facets, coplanar_groups, facets
from autocolor.scene.union_find import group_numbers, unite

TOLERANCE: Final = 2e-6
"""Assumed: the largest distance of a corner from its plane, as a fraction of the size of the mesh."""

MOST_OFFSET: Final = 4.0
"""Assumed: the tolerance is in proportion to the largest coordinate, as float32 is rounded, up to so much."""


DIRECTIONS: Final = 16
"""In how many directions patches may lie apart."""

MOST_PATCHES: Final = 64
"""Of how many patches in a plane each is compared with each; of more it is assumed that some overlap."""


@dataclass(frozen=True, eq=False)
class SharedPlanes:
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
    used = np.zeros(coordinate_rows.shape[1], np.bool_)
    used[node_rows] = True
    low = coordinate_rows.min(axis=1, where=used, initial=np.inf)
    high = coordinate_rows.max(axis=1, where=used, initial=-np.inf)
    extent = float((high - low).max())
    if not 0 < extent < np.inf:
        return None
    middle = low / 2 + high / 2
    tolerance = TOLERANCE * min(max(float(np.abs([low, high]).max()) / extent, 1.0), MOST_OFFSET)
    scaled = (coordinate_rows - middle[:, None]) / extent

    # Find groups of polygons that seem to lie in one plane, and sort the polygons by group.
    groups = group_numbers(coplanar_groups(scaled, node_rows, tolerance))
    polygons = np.flatnonzero(np.bincount(groups).take(groups) > 1)
    polygons = polygons[np.argsort(groups[polygons], kind="stable")]
    groups = groups[polygons]
    # Drop those that are too far from the plane of the others, and what can't overlap.
    for overlapping in (False, True, False):
        found = facets(scaled, node_rows[:, polygons])
        normals, _, off = _fitted(found, groups)
        kept = off <= np.minimum(tolerance, SHARPEST * found.widths)
        if overlapping:
            places = places_of_corners(coordinate_rows, node_rows[:, polygons])
            kept &= _may_overlap(places, groups, found, normals)
        polygons, groups = polygons[kept], groups[kept]
        several = np.bincount(groups, minlength=1).take(groups) > 1
        polygons, groups = polygons[several], groups[several]
        if not len(polygons):
            return None

    found = facets(scaled, node_rows[:, polygons])
    normals, points, off = _fitted(found, groups)
    numbers = _renumbered(groups)
    first = np.flatnonzero(np.diff(numbers, prepend=-1))
    plane_of_polygon = np.full(node_rows.shape[1], -1, np.intp)
    plane_of_polygon[polygons] = numbers
    turned = np.zeros(node_rows.shape[1], np.bool_)
    turned[polygons] = dot(found.normals, normals) < 0
    return SharedPlanes(
        normals[:, first],
        points[:, first] * extent + middle[:, None],
        np.maximum.reduceat(off, first) * extent,
        plane_of_polygon,
        turned,
    )


def _renumbered(groups: Indices) -> Indices:
    """Sorted group numbers without gaps."""
    numbers: Indices = np.cumsum(np.diff(groups, prepend=groups[:1]) != 0)
    return numbers


def _fitted(found: Facets, groups: Indices) -> tuple[Floats, Floats, Floats]:
    """For each facet the normal and a point of the plane fitted to its group, and how far it is off."""
    numbers = _renumbered(groups)
    if not len(numbers):
        return found.normals, found.centers, found.areas
    first = np.flatnonzero(np.diff(numbers, prepend=-1))
    weights = found.areas / np.add.reduceat(found.areas, first)[numbers]
    points = np.add.reduceat(weights * found.centers, first, axis=1)[:, numbers]
    away = found.corners - points[:, None]
    spread = np.add.reduceat(np.einsum("n,icn,jcn->nij", weights, away, away), first, axis=0)
    # The normal is the direction in which the corners spread least.
    normals: Floats = np.linalg.eigh(spread)[1][:, :, 0].T[:, numbers]
    return normals, points, np.abs(np.einsum("in,icn->cn", normals, away)).max(axis=0)


def _may_overlap(places: Indices, groups: Indices, found: Facets, normals: Floats) -> Booleans:
    """For each polygon whether those of its group may overlap; `places` as from `places_of_corners`."""
    start, end = places, np.roll(places, -1, axis=0)
    keys = (np.minimum(start, end) * (int(places.max(initial=0)) + 1) + np.maximum(start, end)).T.ravel()
    forward = ((start < end) ^ (dot(found.normals, normals) < 0)).T.ravel()
    edges = np.flatnonzero((start != end).T.ravel())
    # Edges are in the order of the groups, and so are equal ones after a stable sort.
    edges = edges[np.argsort(keys[edges], kind="stable")]
    keys, forward, polygon = keys[edges], forward[edges], edges >> 2
    shared = (keys[1:] == keys[:-1]) & (groups[polygon[1:]] == groups[polygon[:-1]])
    folded = shared & (forward[1:] == forward[:-1])
    folded[1:] |= shared[1:] & shared[:-1]
    # Find the patches of each group, and whether straight lines lie between them.
    parents = np.arange(len(groups))
    unite(parents, polygon[:-1][shared], polygon[1:][shared])
    overlapping = ~_lie_apart(group_numbers(parents), groups, found.corners, normals)
    overlapping[groups[polygon[1:][folded]]] = True
    return overlapping[groups]


def _lie_apart(patches: Indices, groups: Indices, corners: Floats, normals: Floats) -> Booleans:
    """For each group whether no two of its patches overlap as seen along every direction of the plane."""
    order = np.argsort(patches, kind="stable")
    first = np.flatnonzero(np.diff(patches[order], prepend=-1))
    group = groups[order[first]]
    counts = np.bincount(group, minlength=int(groups.max(initial=-1)) + 1)
    lie_apart = counts <= MOST_PATCHES
    if counts.max(initial=0) < 2:
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
