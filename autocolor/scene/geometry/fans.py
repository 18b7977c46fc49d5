"""Fans: the polygon corners around a place that share a normal.

Two corners at the same place share a normal where their polygons meet in an edge that is no crease, and so on
from polygon to polygon around the place. Corner 4 p + c is corner c of polygon p. Corners are worked on in
chunks, so that a large mesh needs no more than a few numbers a corner.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, chunks
from autocolor.scene.geometry.union_find import group_numbers, unite

AT_ONCE: Final = 1 << 15

MIXER: Final = np.uint64(0x9E3779B97F4A7C15)
"""An odd number with well-spread bits, so that every bit of a factor changes the high bits of the product."""


def places_of_corners(coordinate_rows: Floats, node_rows: Indices) -> Indices:
    """A number for each corner, (4, polygons), equal for corners at the same place.

    `coordinate_rows` is (3, nodes); `node_rows`, (4, polygons), holds the node numbers of the polygons.
    """
    if not _some_share_a_place(coordinate_rows):
        return node_rows
    order = np.lexsort(coordinate_rows)
    moved = np.zeros(len(order), np.bool_)
    for row in coordinate_rows:
        moved[1:] |= np.diff(row[order]) != 0
    places = np.empty(len(order), np.intp)
    places[order] = np.cumsum(moved)
    return places[node_rows]


def _some_share_a_place(coordinate_rows: Floats) -> bool:
    """Whether two nodes may be at the same place: compares hashes of the coordinates.

    Measured: it takes a fifth of the time of sorting the nodes.
    """
    hashes = np.zeros(coordinate_rows.shape[1], np.uint64)
    for row in coordinate_rows:
        # Add 0 to turn -0 into 0, which is the same place.
        hashes ^= (row + 0.0).view(np.uint64)
        hashes *= MIXER
        hashes ^= hashes >> np.uint64(32)
    hashes.sort()
    return bool((hashes[1:] == hashes[:-1]).any())


def fans_of_corners(
    places: Indices, part_numbers: Indices, normals: Floats, crease_angle: float
) -> tuple[Indices, list[Indices]]:
    """The fan of each corner, (corners,), and pairs of fans with opposite winding, each (2, pairs).

    `places`, (4, polygons), has the place of each corner; `normals`, (3, polygons), holds unit vectors, or
    zeros. Fans are numbered from 0 in the order of their first corners.
    """
    parents = np.arange(places.size)
    # Unite the last two corners of a triangle, which repeats its last node.
    parents[3::4] -= places[2] == places[3]
    least_cosine = np.cos(np.radians(crease_angle)) - 1e-9
    opposite_corners = []
    for one, other in _corners_at_shared_edges(places, part_numbers):
        # Two polygons have opposite winding where both run along the shared edge in the same direction; then
        # compare one normal with the reverse of the other.
        opposite = places[one & 3, one >> 2] == places[other & 3, other >> 2]
        cosine = (np.take(normals, one >> 2, axis=1) * np.take(normals, other >> 2, axis=1)).sum(axis=0)
        np.negative(cosine, out=cosine, where=opposite)
        smooth = cosine >= least_cosine
        # Unite the corners at both ends of the edge, unless it is a crease.
        ends, other_ends = np.stack([one, _next_corner(one)]), np.stack([other, _next_corner(other)])
        same, reversed_ = np.flatnonzero(smooth & ~opposite), np.flatnonzero(smooth & opposite)
        unite(parents, ends[:, same].ravel(), other_ends[::-1, same].ravel())
        if len(reversed_):
            opposite_corners.append(np.stack([ends[:, reversed_].ravel(), other_ends[:, reversed_].ravel()]))
    fans = group_numbers(parents)
    return fans, [fans[pairs] for pairs in opposite_corners]


def _corners_at_shared_edges(places: Indices, part_numbers: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Pairs of corners whose outgoing edges join the same two places in the same part, chunk by chunk.

    Where more than two polygons share an edge, each is paired with the next in the polygon table.
    """
    # Give each edge a key that does not depend on its direction, and all edges without length the key -1.
    keys = np.empty((places.shape[1], 4), np.int64)
    place_count = np.int64(places.max(initial=-1)) + 1
    for chunk in chunks(len(keys), AT_ONCE):
        start = places[:, chunk]
        end = np.roll(start, -1, axis=0)
        key = np.minimum(start, end) * place_count + np.maximum(start, end)
        key[start == end] = -1
        keys[chunk] = key.T
    flat = keys.ravel()
    # Sort the edges so that equal edges of one part become neighbors.
    several_parts = bool((part_numbers != part_numbers[:1]).any())
    order = (
        np.lexsort((np.repeat(part_numbers, 4), flat)) if several_parts else np.argsort(flat, kind="stable")
    )
    for first in range(int(np.count_nonzero(flat < 0)), len(order), AT_ONCE):
        corners = order[first : first + AT_ONCE + 1]
        key = flat[corners]
        shared = key[1:] == key[:-1]
        if several_parts:
            part = part_numbers[corners >> 2]
            shared &= part[1:] == part[:-1]
        shared = np.flatnonzero(shared)
        yield corners[shared], corners[shared + 1]


def _next_corner(corners: Indices) -> Indices:
    """The next corner of each corner's polygon."""
    return (corners & ~3) | ((corners + 1) & 3)
