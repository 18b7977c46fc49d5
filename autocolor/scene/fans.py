"""Fans: the corners around a place that share a normal.

Corners at the same place share one where their polygons meet in an edge that is no crease, and so on around
the place from polygon to polygon. Corner 4 p + c is corner c of polygon p. Corners are worked on some at a
time, so that for a large mesh no more is held than a few numbers a corner.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Numbers, chunks
from autocolor.scene.union_find import group_numbers, join

AT_ONCE: Final = 1 << 15

MIXER: Final = np.uint64(0x9E3779B97F4A7C15)
"""An odd number with ones and zeros all over: a product with it tells about every bit."""


def places_of_corners(coordinate_rows: Floats, columns: Numbers) -> Numbers:
    """A number for each corner, (4, polygons), the same for those at the same place.

    `coordinate_rows` are (3, nodes), `columns` the node numbers of the polygons, (4, polygons).
    """
    if not _some_share_a_place(coordinate_rows):
        return columns
    order = np.lexsort(coordinate_rows)
    moved = np.zeros(len(order), np.bool_)
    for row in coordinate_rows:
        moved[1:] |= np.diff(row[order]) != 0
    places = np.empty(len(order), np.intp)
    places[order] = np.cumsum(moved)
    return places[columns]


def _some_share_a_place(coordinate_rows: Floats) -> bool:
    """False where no two nodes are at the same place; measured: a fifth of the time of sorting them."""
    mixed = np.zeros(coordinate_rows.shape[1], np.uint64)
    for row in coordinate_rows:
        # Add 0, for -0 is the same place.
        mixed ^= (row + 0.0).view(np.uint64)
        mixed *= MIXER
        mixed ^= mixed >> np.uint64(32)
    mixed.sort()
    return bool((mixed[1:] == mixed[:-1]).any())


def fans_of_corners(
    places: Numbers, part_numbers: Numbers, normals: Floats, crease_angle: float
) -> tuple[Numbers, list[Numbers]]:
    """The fan of each corner, (corners,), and pairs of fans wound against each other, each (2, pairs).

    `places`, (4, polygons), has the place of each corner; `normals`, (3, polygons), are unit vectors, or
    zeros. Fans are numbered from 0 in the order of their first corners.
    """
    leads = np.arange(places.size)
    # Join the last two corners of a triangle, which repeats its last node.
    leads[3::4] -= places[2] == places[3]
    least_cosine = np.cos(np.radians(crease_angle)) - 1e-9
    against = []
    for one, other in _corners_at_shared_edges(places, part_numbers):
        # Leave creases sharp; where the edge runs the same way in both, one polygon shows its other side.
        opposed = places[one & 3, one >> 2] == places[other & 3, other >> 2]
        cosine = (np.take(normals, one >> 2, axis=1) * np.take(normals, other >> 2, axis=1)).sum(axis=0)
        np.negative(cosine, out=cosine, where=opposed)
        smooth = cosine >= least_cosine
        # Join the corners at both ends of the edge.
        ends, other_ends = np.stack([one, _onward(one)]), np.stack([other, _onward(other)])
        alike, unlike = np.flatnonzero(smooth & ~opposed), np.flatnonzero(smooth & opposed)
        join(leads, ends[:, alike].ravel(), other_ends[::-1, alike].ravel())
        if len(unlike):
            against.append(np.stack([ends[:, unlike].ravel(), other_ends[:, unlike].ravel()]))
    fans = group_numbers(leads)
    return fans, [fans[pairs] for pairs in against]


def _corners_at_shared_edges(places: Numbers, part_numbers: Numbers) -> Iterator[tuple[Numbers, Numbers]]:
    """Pairs of corners from which polygons of a part go along the same edge, either way; some at a time.

    Where more than two share an edge, each stands in a pair with the next of the polygon table.
    """
    # Give every edge a key, whichever way it runs; those without length share theirs with none.
    keys = np.empty((places.shape[1], 4), np.int64)
    beyond = np.int64(places.max(initial=-1)) + 1
    for some in chunks(len(keys), AT_ONCE):
        start = places[:, some]
        end = np.roll(start, -1, axis=0)
        key = np.minimum(start, end) * beyond + np.maximum(start, end)
        key[start == end] = -1
        keys[some] = key.T
    flat = keys.ravel()
    # Sort the edges so that the polygons of a part along the same edge stand next to each other.
    several = bool((part_numbers != part_numbers[:1]).any())
    order = np.lexsort((np.repeat(part_numbers, 4), flat)) if several else np.argsort(flat, kind="stable")
    for first in range(int(np.count_nonzero(flat < 0)), len(order), AT_ONCE):
        corners = order[first : first + AT_ONCE + 1]
        key = flat[corners]
        shared = key[1:] == key[:-1]
        if several:
            part = part_numbers[corners >> 2]
            shared &= part[1:] == part[:-1]
        shared = np.flatnonzero(shared)
        yield corners[shared], corners[shared + 1]


def _onward(corners: Numbers) -> Numbers:
    """The next corner of each one's polygon."""
    return (corners & ~3) | ((corners + 1) & 3)
