"""Fans: the polygon corners around a place that share a normal.

Two corners at the same place share a normal where their polygons meet in an edge that is no crease, and so on
from polygon to polygon around the place. Corner 4 p + c is corner c of polygon p. Corners are worked on in
chunks, so that a large mesh needs no more than a few numbers a corner.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, Numbers, Scratch, chunks
from autocolor.scene.geometry.union_find import group_numbers, unite

AT_ONCE: Final = 1 << 15

EDGES_AT_ONCE: Final = 1 << 22
"""Edges that are sorted at once; more are divided by the lower of their places."""

MOST_DIVISIONS: Final = 200

LARGE: Final = 1 << 23
"""Corners of which the numbers are held in 32 bits."""

MIXER: Final = np.uint64(0x9E3779B97F4A7C15)
"""An odd number with well-spread bits, so that every bit of a factor changes the high bits of the product."""


def places_of_corners(coordinate_rows: Floats, node_rows: Indices, scratch: Scratch = np.empty) -> Indices:
    """A number for each corner, (4, polygons), equal for corners at the same place.

    `coordinate_rows` is (3, nodes); `node_rows`, (4, polygons), holds the node numbers of the polygons.
    """
    if not _some_share_a_place(coordinate_rows, scratch):
        return node_rows
    order = np.lexsort(coordinate_rows)
    moved = np.zeros(len(order), np.bool_)
    for row in coordinate_rows:
        moved[1:] |= np.diff(row[order]) != 0
    places = np.empty(len(order), np.intp)
    places[order] = np.cumsum(moved)
    found: Indices = scratch(node_rows.shape, np.intp)
    for chunk in chunks(node_rows.shape[1], AT_ONCE):
        found[:, chunk] = places.take(node_rows[:, chunk])
    return found


def _some_share_a_place(coordinate_rows: Floats, scratch: Scratch) -> bool:
    """Whether two nodes may be at the same place: compares hashes of the coordinates.

    Measured: it takes a fifth of the time of sorting the nodes.
    """
    hashes = scratch(coordinate_rows.shape[1:], np.uint64)
    for chunk in chunks(len(hashes), AT_ONCE):
        part = np.zeros(chunk.stop - chunk.start, np.uint64)
        for row in coordinate_rows:
            # Add 0 to turn -0 into 0, which is the same place.
            part ^= (row[chunk] + 0.0).view(np.uint64)
            part *= MIXER
            part ^= part >> np.uint64(32)
        hashes[chunk] = part
    hashes.sort()
    return bool((hashes[1:] == hashes[:-1]).any())


def fans_of_corners(
    places: Indices,
    part_numbers: Indices,
    normals: Floats,
    crease_angle: float,
    scratch: Scratch = np.empty,
) -> tuple[Indices, list[Indices]]:
    """The fan of each corner, (corners,), and pairs of fans with opposite winding, each (2, pairs).

    `places`, (4, polygons), has the place of each corner; `normals`, (3, polygons), holds unit vectors, or
    zeros. Fans are numbered from 0 in the order of their first corners.
    """
    parents = scratch((places.size,), np.intp if places.size < LARGE else np.int32)
    for chunk in chunks(places.shape[1], AT_ONCE):
        corners = np.arange(4 * chunk.start, 4 * chunk.stop)
        # Unite the last two corners of a triangle, which repeats its last node.
        corners[3::4] -= places[2, chunk] == places[3, chunk]
        parents[4 * chunk.start : 4 * chunk.stop] = corners
    least_cosine = np.cos(np.radians(crease_angle)) - 1e-9
    opposite_corners = []
    for one, other in _corners_at_shared_edges(places, part_numbers, scratch):
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
    fans = group_numbers(parents, scratch)
    return fans, [fans[pairs] for pairs in opposite_corners]


def _corners_at_shared_edges(
    places: Indices, part_numbers: Indices, scratch: Scratch
) -> Iterator[tuple[Indices, Indices]]:
    """Pairs of corners whose outgoing edges join the same two places in the same part, chunk by chunk.

    Where more than two polygons share an edge, each is paired with the next in the polygon table.
    """
    several_parts = bool((part_numbers != part_numbers[:1]).any())
    for keys, edges in _edges(places, scratch):
        # Sort the edges so that equal edges of one part become neighbors.
        if several_parts:
            polygons = np.repeat(np.arange(places.shape[1]), 4) if edges is None else edges >> 2
            order = np.lexsort((part_numbers[polygons], keys))
        else:
            order = np.argsort(keys, kind="stable")
        for first in range(int(np.count_nonzero(keys < 0)), len(order), AT_ONCE):
            rows = order[first : first + AT_ONCE + 1]
            key, corners = keys[rows], rows if edges is None else edges[rows]
            shared = key[1:] == key[:-1]
            if several_parts:
                part = part_numbers[corners >> 2]
                shared &= part[1:] == part[:-1]
            shared = np.flatnonzero(shared)
            yield corners[shared], corners[shared + 1]


def _edges(places: Indices, scratch: Scratch) -> Iterator[tuple[Numbers, Indices | None]]:
    """The edges in divisions: a key that does not depend on their direction, and their first corners.

    Edges without length have the key -1. The corners of a division are in order, and no key is in two of
    them. Where all are in one division its corners are None: they are as many as the keys.
    """
    place_count = int(places.max(initial=-1)) + 1
    count = min(-(-places.size // EDGES_AT_ONCE), MOST_DIVISIONS)
    if count <= 1:
        all_keys = np.empty((places.shape[1], 4), np.int64)
        for chunk in chunks(len(all_keys), AT_ONCE):
            start = places[:, chunk]
            all_keys[chunk] = _keys(start, np.roll(start, -1, axis=0), place_count).T
        yield all_keys.ravel(), None
        return
    # Number the divisions by the lower place of an edge.
    divisions = scratch((places.size,), np.uint8)
    for chunk in chunks(places.shape[1], AT_ONCE):
        start = places[:, chunk]
        lower = np.minimum(start, np.roll(start, -1, axis=0))
        divisions[4 * chunk.start : 4 * chunk.stop] = (lower * count // place_count).T.ravel()
    for number in range(count):
        corners = np.concatenate(
            [
                np.flatnonzero(divisions[chunk] == number) + chunk.start
                for chunk in chunks(len(divisions), EDGES_AT_ONCE)
            ]
        )
        keys = np.empty(len(corners), np.int64)
        for chunk in chunks(len(corners), AT_ONCE):
            some = corners[chunk]
            start, end = places[some & 3, some >> 2], places[(some + 1) & 3, some >> 2]
            keys[chunk] = _keys(start, end, place_count)
        yield keys, corners


def _keys(start: Indices, end: Indices, place_count: int) -> Numbers:
    """A key for each edge from one place to another, the same both ways; -1 where they are the same."""
    keys: Numbers = np.minimum(start, end) * np.int64(place_count) + np.maximum(start, end)
    keys[start == end] = -1
    return keys


def _next_corner(corners: Indices) -> Indices:
    """The next corner of each corner's polygon."""
    return (corners & ~3) | ((corners + 1) & 3)
