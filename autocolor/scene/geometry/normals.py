"""Node normals: one unit vector for each smooth fan of polygons around a node.

Paper: "The Lighting Model" interpolates the normal between node normals, and does not say how they are
computed. Assumed: a node normal is the mean of the normals of the adjoining polygons, weighted by their
angles at the node, so that it does not depend on how a flat side was divided into polygons. A normal is not
shared across parts, nor across an edge where the polygons meet at more than the crease angle. Nodes at the
same place count as one node, so that it does not matter whether a file repeats its nodes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, Numbers, Singles, chunks, cross, lengths, underflowing
from autocolor.immutable import Immutable, read_only

CREASE_ANGLE: Final = 40.0
"""Assumed: in degrees; the edges of a box stay sharp, and a cylinder of ten sides or more is smooth."""

POLYGONS_AT_ONCE: Final = 1 << 13
"""Few enough for their corners to stay in the processor's cache."""

CORNERS_AT_ONCE: Final = 1 << 15
"""The polygons, corners or items of a chunk in the search for fans."""

MIXER: Final = np.uint64(0x9E3779B97F4A7C15)
"""An odd number with well-spread bits, so that every bit of a factor changes the high bits of the product."""


@dataclass(frozen=True, eq=False, repr=False)
class NodeNormals(Immutable):
    """Unit normals, and the number of the normal at each corner of each polygon.

    `vectors` is (normals, 3) float32, `numbers` (polygons, 4) intp: rows of `vectors`. Both are stored by
    columns, so that `.T` is the contiguous array that the renderer works on. The normals of a file may lack
    some: their numbers are -1.
    """

    vectors: Singles
    numbers: Indices

    @cached_property
    def are_complete(self) -> bool:
        """Whether there is a normal at every corner."""
        return bool(self.numbers.min(initial=0) >= 0)

    def completed(self, computed: NodeNormals) -> NodeNormals:
        """These normals, with computed normals of the same mesh at the corners that lack one."""
        own, others = self.numbers.T, computed.numbers.T
        used, rows = np.unique(others[own < 0], return_inverse=True)
        numbers = own.copy()
        numbers[own < 0] = rows.ravel() + len(self.vectors)
        vectors = np.concatenate([self.vectors.T, computed.vectors.T[:, used]], axis=1)
        return NodeNormals(read_only(vectors.T), read_only(numbers.T))

    @staticmethod
    def joined(normals: Sequence[NodeNormals | None], polygons: Sequence[int]) -> NodeNormals | None:
        """The normals of several meshes as one, which have so many polygons; None if no mesh has any."""
        if all(each is None for each in normals):
            return None
        none = np.empty((0, 3), np.float32)
        pairs = [
            (none, np.full((count, 4), -1)) if each is None else (each.vectors, each.numbers)
            for each, count in zip(normals, polygons, strict=True)
        ]
        firsts = np.cumsum([0, *(len(vectors) for vectors, _ in pairs)])
        rows = [
            np.where(own.T < 0, -1, own.T + first) for (_, own), first in zip(pairs, firsts, strict=False)
        ]
        vectors = np.concatenate([vectors.T for vectors, _ in pairs], axis=1)
        return NodeNormals(read_only(vectors.T), read_only(np.concatenate(rows, axis=1).T))


@underflowing
def node_normals(
    coordinates: Floats,
    node_numbers: Indices,
    part_numbers: Indices,
    crease_angle: float = CREASE_ANGLE,
) -> NodeNormals:
    """The normals at the corners of the polygons; a polygon without area adds nothing."""
    coordinate_rows, node_rows = np.ascontiguousarray(coordinates.T), np.ascontiguousarray(node_numbers.T)
    count = node_rows.shape[1]
    normals, angles = np.empty((3, count), np.float64), np.empty((4, count), np.float64)
    for chunk in chunks(count, POLYGONS_AT_ONCE):
        corners = np.take(coordinate_rows, node_rows[:, chunk], axis=1)
        normals[:, chunk] = polygon_normals(corners)
        angles[:, chunk] = _corner_angles(corners)
    places = places_of_corners(coordinate_rows, node_rows)
    fans, opposite = fans_of_corners(places, part_numbers, normals, crease_angle)
    del places

    # Sum the normals of each fan, weighted by the angles.
    sums = [np.bincount(fans, (angles * row).T.ravel()) for row in normals]
    vectors = np.array(sums, np.float64)
    numbers = np.array(fans.reshape(-1, 4).T, np.intp, order="C")
    del angles, fans, sums
    if opposite:
        vectors, united = _united_with_opposite(vectors, opposite)
        numbers = united[numbers]

    # Give a fan whose normals cancel out the normal of one of its polygons.
    sizes = lengths(vectors)
    canceled = np.flatnonzero(sizes < 1e-9)
    if len(canceled):
        polygon_of_fan = np.zeros(vectors.shape[1], np.intp)
        # Row by row: `maximum.at` of numpy 2.4 reads past the end of values that it broadcasts.
        for row in numbers:
            np.maximum.at(polygon_of_fan, row, np.arange(len(row)))
        vectors[:, canceled] = normals[:, polygon_of_fan[canceled]]
        vectors[2, canceled[~vectors[:, canceled].any(axis=0)]] = 1.0
        sizes[canceled] = 1.0
    vectors /= sizes
    return NodeNormals(read_only(vectors.astype(np.float32).T), read_only(numbers.T))


def _united_with_opposite(sums: Floats, opposite: list[Indices]) -> tuple[Floats, Indices]:
    """The sums of fans united with neighboring fans of opposite winding, and the column of each fan in them.

    Every fan has two sides, numbered `fan` and `fan + count`. The front of a fan is united with the back of a
    neighboring fan of opposite winding, so that a normal is never added to its own reverse.
    """
    count = sums.shape[1]
    sides = np.arange(2 * count)
    for one, other in opposite:
        unite(sides, np.concatenate([one, one + count]), np.concatenate([other + count, other]))
    # Groups are numbered by their lowest side, so those with the front of a fan come first.
    groups = group_numbers(sides)
    used = int(groups[:count].max()) + 1
    both = np.concatenate([sums, -sums], axis=1)
    return np.stack([np.bincount(groups, row)[:used] for row in both]), groups[:count]


@underflowing
def polygon_normals(corners: Floats) -> Floats:
    """Unit normals, (3, polygons), of corners (3, 4, polygons); zero for a polygon without area.

    The cross product of the diagonals also suits warped quads, and triangles that repeat a node.
    """
    size = np.ptp(corners, axis=1).max(axis=0)
    size[size == 0] = 1.0
    scaled = (corners[:, 1:] - corners[:, :1]) / size
    normals = cross(scaled[:, 1], scaled[:, 2] - scaled[:, 0])
    sizes = lengths(normals)
    flat = sizes < 1e-12
    sizes[flat] = 1.0
    normals[:, flat] = 0.0
    normals /= sizes
    return normals


def _corner_angles(corners: Floats) -> Floats:
    """The angle in radians at each corner, (4, polygons); 0 at the repeated corner of a triangle."""
    outgoing = np.roll(corners, -1, axis=1) - corners
    incoming = np.roll(outgoing, 1, axis=1)
    # A triangle repeats its last node.
    triangle = ~outgoing[:, 2].any(axis=0)
    outgoing[:, 2, triangle] = outgoing[:, 3, triangle]
    size = np.maximum(np.abs(outgoing).max(axis=0), np.abs(incoming).max(axis=0))
    size[size == 0] = 1.0
    outgoing /= size
    incoming /= size
    # Subtract from 0: -0.0 would give an edge without length an angle of 180 degrees.
    angles: Floats = np.arctan2(lengths(cross(incoming, outgoing)), 0.0 - (incoming * outgoing).sum(axis=0))
    angles[3, triangle] = 0.0
    return angles


# Fans. Two corners at the same place share a normal where their polygons meet in an edge that is no crease,
# and so on from polygon to polygon around the place. Corner 4 p + c is corner c of polygon p. Corners are
# worked on in chunks, so that a large mesh needs no more than a few numbers a corner.


def places_of_corners(coordinate_rows: Floats, node_rows: Indices) -> Indices:
    """A number for each corner, (4, polygons), equal for corners at the same place.

    `coordinate_rows` is (3, nodes); `node_rows`, (4, polygons), holds the node numbers of the polygons.
    """
    places = places_of_nodes(coordinate_rows)
    return node_rows if places is None else places.take(node_rows)


def places_of_nodes(coordinate_rows: Floats) -> Indices | None:
    """A number for each node, equal for nodes at the same place; None if all their places differ."""
    if not _some_share_a_place(coordinate_rows):
        return None
    order = np.lexsort(coordinate_rows)
    moved = np.zeros(len(order), np.bool_)
    for row in coordinate_rows:
        moved[1:] |= np.diff(row[order]) != 0
    places = np.empty(len(order), np.intp)
    places[order] = np.cumsum(moved)
    return places


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
    places: Indices,
    part_numbers: Indices,
    normals: Floats,
    crease_angle: float,
) -> tuple[Indices, list[Indices]]:
    """The fan of each corner, (corners,), and pairs of fans with opposite winding, each (2, pairs).

    `places`, (4, polygons), has the place of each corner; `normals`, (3, polygons), holds unit vectors, or
    zeros. Fans are numbered from 0 in the order of their first corners.
    """
    # Corner numbers of 32 bits suffice, and take half of the memory.
    parents: AnyArray = np.arange(places.size, dtype=np.int32)
    # Unite the last two corners of a triangle, which repeats its last node.
    parents[3::4] -= places[2] == places[3]
    least_cosine = np.cos(np.radians(crease_angle)) - 1e-9
    opposite_corners = []
    for one, other in corners_at_shared_edges(places, part_numbers):
        # Two polygons have opposite winding if both run along the shared edge in the same direction. Compare
        # the normal of the first then with the reversed normal of the second.
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


def corners_at_shared_edges(places: Indices, part_numbers: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Pairs of corners whose outgoing edges join the same two places in the same part, chunk by chunk.

    Where more than two polygons share an edge, each is paired with the next in the polygon table.
    """
    several_parts = bool((part_numbers != part_numbers[:1]).any())
    table = np.empty((places.shape[1], 4), np.int64)
    count = int(places.max(initial=-1)) + 1
    for chunk in chunks(len(table), CORNERS_AT_ONCE):
        start = places[:, chunk]
        table[chunk] = edge_keys(start, np.roll(start, -1, axis=0), count).T
    # Sort the edges so that equal edges of one part become neighbors.
    keys = table.ravel()
    order = (
        np.lexsort((np.repeat(part_numbers, 4), keys)) if several_parts else np.argsort(keys, kind="stable")
    )
    for first in range(int(np.count_nonzero(keys < 0)), len(order), CORNERS_AT_ONCE):
        corners = order[first : first + CORNERS_AT_ONCE + 1]
        shared = keys[corners[1:]] == keys[corners[:-1]]
        if several_parts:
            parts = part_numbers[corners >> 2]
            shared &= parts[1:] == parts[:-1]
        shared = np.flatnonzero(shared)
        yield corners[shared], corners[shared + 1]


def edge_keys(start: Indices, end: Indices, place_count: int) -> Numbers:
    """The keys of edges between places, the same in both directions; -1 if start and end are the same."""
    keys: Numbers = np.minimum(start, end) * np.int64(place_count) + np.maximum(start, end)
    keys[start == end] = -1
    return keys


def _next_corner(corners: Indices) -> Indices:
    """The next corner of each corner's polygon."""
    return (corners & ~3) | ((corners + 1) & 3)


# Union-find. Every item has a parent, a lower item of its group; the root of a group is its lowest item and
# its own parent. At first every item is a root, as in `np.arange`. All functions work on many items at once.


def unite(parents: Indices, one: Indices, other: Indices) -> None:
    """Unite the groups of each pair of items; `parents` is changed in place."""
    while len(one):
        # Drop the pairs that are already in one group.
        one, other = roots_of(parents, np.concatenate([one, other])).reshape(2, -1)
        apart = np.flatnonzero(one != other)
        one, other = np.take(one, apart), np.take(other, apart)
        # Make the lower root the parent of the higher root. If several pairs share the higher root, the
        # lowest parent is taken, and the other pairs try again.
        np.minimum.at(parents, np.maximum(one, other), np.minimum(one, other))


def group_numbers(parents: Indices) -> Indices:
    """The group of each item; groups are numbered from 0 in the order of their roots."""
    items = np.arange(len(parents), dtype=parents.dtype)
    numbers = np.cumsum(parents == items, dtype=parents.dtype) - 1
    groups: Indices = numbers.take(roots_of(parents, items))
    return groups


def roots_of(parents: Indices, items: Indices) -> Indices:
    """The root of each item, which becomes its parent (path compression)."""
    ancestors = np.take(parents, items)
    while True:
        higher = np.take(parents, ancestors)
        if (higher == ancestors).all():
            return higher
        parents[items] = ancestors = higher
