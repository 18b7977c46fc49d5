"""Unites groups of polygons that lie in one fitted plane, and single polygons with such groups.

A small polygon tells little of the plane it lies in, so that the polygons of a large and finely divided
ground may be found as several groups. The planes that are fitted to many polygons are far more exact.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Indices, Numbers, chunks, dot
from autocolor.scene.geometry.planes.plane_cells import (
    CELL,
    MOST_PLANES,
    POLYGONS_AT_ONCE,
    SHARPEST,
    PlaneCells,
    cells_of_planes,
    facets,
)
from autocolor.scene.geometry.planes.plane_fits import Fits, fitted
from autocolor.scene.geometry.planes.scaled_nodes import ScaledNodes
from autocolor.scene.geometry.union_find import roots_of, unite, united_items

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
