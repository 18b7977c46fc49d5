"""Splitting polygons with more than four corners, and polygons whose sides cross, into quads and triangles.

Assumed: a convex polygon is split into a fan of quads around its first corner; a polygon with a reflex corner
is split by ear clipping, until a quad is left. A polygon whose sides cross, such as a bow-tie or a pentagram,
is filled even-odd: a point is inside if a ray from it crosses an odd number of sides. It is split into slabs
between the heights of its corners and crossings, with new nodes where slabs end on a side.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, chunks, cross, dot, underflowing
from autocolor.errors import InputError
from autocolor.immutable import read_only
from autocolor.scene.scalar import NODE, MeshScalar

MOST_CORNERS: Final = 1000
"""Limit: corners of one polygon."""

MOST_CLIPPING: Final = 20_000_000
"""Limit: corners of all clipped polygons; each takes a few microseconds, in large polygons up to 100."""

MOST_SLABS: Final = 100_000
"""Limit: heights of corners and crossings times sides, in a polygon whose sides cross."""

PAIRS_AT_ONCE: Final = 1 << 21
"""Pairs of a corner and a point that are worked on at once."""

TOUCHING: Final = 1e-9
"""Assumed: sides that meet within this fraction of their lengths from an end touch and do not cross. Points
closer than this fraction of a polygon's size are one point."""

CANCELS: Final = 1e-6
"""Assumed: twice the area below which the halves of a polygon of size 1 cancel."""

AT_ONCE: Final = 1 << 14

NONE: Final = read_only(np.empty(0, np.intp))


class AddedNodes(NamedTuple):
    """Nodes on the sides of polygons whose sides cross; every array is (nodes,).

    A node lies between the nodes `starts` and `ends`, at a fraction of the way.
    """

    starts: Indices
    ends: Indices
    fractions: Floats

    def between(self, table: Floats) -> Floats:
        """The rows of a table at these nodes: (nodes,) or (nodes, k), from a row for each former node."""
        start, end = table[self.starts], table[self.ends]
        fractions = self.fractions if table.ndim == 1 else self.fractions[:, None]
        between: Floats = start + fractions * (end - start)
        return between

    def with_scalar(self, scalar: MeshScalar) -> MeshScalar:
        """A scalar of the former nodes with values at these nodes also; a scalar of polygons as it is."""
        if scalar.of != NODE:
            return scalar
        return MeshScalar(scalar.name, read_only(np.append(scalar.values, self.between(scalar.values))))


class Pieces(NamedTuple):
    """The pieces of polygons.

    `corners`, (n, 4), has the nodes of each piece, a quad or a triangle that repeats its last node. `owners`,
    (n,), is the polygon of each piece, ascending. The `added` nodes are numbered after the given nodes.
    `crossed`, (k,), are the polygons whose sides cross.
    """

    corners: Indices
    owners: Indices
    added: AddedNodes = AddedNodes(NONE, NONE, np.empty(0))
    crossed: Indices = NONE


@underflowing
def split_polygons(coordinates: Floats, corners: Indices, counts: Indices) -> Pieces:
    """The pieces of polygons, given by the nodes of all corners and the number of corners of each.

    Polygons with fewer than three corners have no pieces. Raises InputError if there are too many large
    polygons with reflex corners.
    """
    starts = np.cumsum(counts) - counts
    is_small, quads = (counts == 3) | (counts == 4), np.flatnonzero(counts == 4)
    of_quads = corners[starts[quads] + np.arange(4)[:, None]].T
    is_small[quads] = ~crossed_quads(coordinates, of_quads)
    if len(quads) == len(counts) and is_small.all():
        return Pieces(of_quads, quads)
    small = np.flatnonzero(is_small)
    pieces = [corners[starts[small] + np.minimum(np.arange(4)[:, None], counts[small] - 1)].T]
    if is_small.all():
        return Pieces(pieces[0], small)
    owners, crossed = [small], [NONE]
    added: list[tuple[int, int, float]] = []
    large = np.flatnonzero((counts > 3) & ~is_small)
    clipping = 0
    for count in np.flatnonzero(np.bincount(counts[large])).tolist():
        rows = large[counts[large] == count]
        nodes = corners[starts[rows, None] + np.arange(count)]
        flat, convex = _in_their_planes(coordinates[nodes])
        crosses = _cross_themselves(flat, convex)
        convex &= ~crosses
        crossed.append(rows[crosses])
        fan = np.array([(0, at, at + 1, min(at + 2, count - 1)) for at in range(1, count - 1, 2)])
        pieces.append(nodes[convex][:, fan].reshape(-1, 4))
        owners.append(np.repeat(rows[convex], len(fan)))
        clipping += int((~convex & ~crosses).sum()) * count
        _check_clipping(clipping, count)
        for row in np.flatnonzero(crosses).tolist():
            slabs = even_odd_slabs(flat[row], nodes[row].tolist(), len(coordinates), added)
            clipping += slabs.size
            _check_clipping(clipping, count)
            pieces.append(slabs)
            owners.append(np.repeat(rows[row], len(slabs)))
        reflex = np.flatnonzero(~convex & ~crosses)
        for chunk in chunks(len(reflex), max(PAIRS_AT_ONCE // count**2, 1)):
            ears = clipped_ears(flat[reflex[chunk]]).reshape(len(reflex[chunk]), -1)
            pieces.append(np.take_along_axis(nodes[reflex[chunk]], ears, axis=1).reshape(-1, 4))
            owners.append(np.repeat(rows[reflex[chunk]], count - 3))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    table = np.array(added, np.float64).reshape(-1, 3).T
    return Pieces(
        np.concatenate(pieces)[order],
        owner[order],
        AddedNodes(table[0].astype(np.intp), table[1].astype(np.intp), table[2]),
        np.sort(np.concatenate(crossed)),
    )


def _check_clipping(corners: int, count: int) -> None:
    """Raise InputError if too many corners are clipped; `count` are the corners of the last polygon."""
    if corners > MOST_CLIPPING:
        raise InputError(
            f"there must be fewer polygons with reflex corners, not so many with {count} corners; split"
            " them into triangles"
        )


def crossed_quads(coordinates: Floats, node_numbers: Indices) -> Booleans:
    """Which quads, (n, 4), have sides that cross.

    Measured: a million quads take 0.07 s.
    """
    are_crossed = np.zeros(len(node_numbers), np.bool_)
    for chunk in chunks(len(node_numbers), AT_ONCE):
        places = np.take(coordinates.T, node_numbers.T[:, chunk], axis=1)
        # If sides cross, both diagonals lie outside.
        one, two, three = (places[:, corner] - places[:, 0] for corner in (1, 2, 3))
        rows = np.flatnonzero(dot(cross(one, two), cross(two, three)) < 0)
        if len(rows):
            flat, _ = _in_their_planes(places[:, :, rows].T)
            are_crossed[chunk.start + rows] = _cross_themselves(flat, np.zeros(len(rows), np.bool_))
    return are_crossed


def _cross_themselves(flat: Floats, convex: Booleans) -> Booleans:
    """Which polygons, (n, corners, 2), have sides that cross; `convex` are those that turn left alone."""
    crosses = np.zeros(len(flat), np.bool_)
    # A polygon that turns left alone goes around once if it goes right once and left once.
    right = np.roll(flat[..., 0], -1, axis=1) > flat[..., 0]
    rows = np.flatnonzero(~convex | ((right != np.roll(right, 1, axis=1)).sum(axis=1) > 2))
    count = flat.shape[1]
    for chunk in chunks(len(rows), max(AT_ONCE // count, 1)):
        start = flat[rows[chunk]].transpose(2, 0, 1)
        side = np.roll(start, -1, axis=2) - start
        for distance in range(2, count // 2 + 1):
            other, away = (np.roll(table, -distance, axis=2) for table in (side, start))
            away = away - start
            turn = side[0] * other[1] - side[1] * other[0]
            on_side = (away[0] * other[1] - away[1] * other[0]) * np.sign(turn)
            on_other = (away[0] * side[1] - away[1] * side[0]) * np.sign(turn)
            least, most = TOUCHING * np.abs(turn), (1 - TOUCHING) * np.abs(turn)
            meet = (on_side > least) & (on_side < most) & (on_other > least) & (on_other < most)
            crosses[rows[chunk]] |= meet.any(axis=1)
    return crosses


def even_odd_slabs(
    flat: Floats, nodes: list[int], node_count: int, added: list[tuple[int, int, float]]
) -> Indices:
    """The pieces, (n, 4), of a polygon whose sides cross, filled even-odd; `flat` is (corners, 2).

    New nodes are appended to `added`: the nodes of a side and a fraction of the way; `node_count` is the
    number of the first of them. Raises InputError if the sides cross too often.
    """
    ends = np.roll(flat, -1, axis=0)
    side = ends - flat
    # Find the heights of all corners and crossings.
    away = flat[None] - flat[:, None]
    turn = side[:, None, 0] * side[None, :, 1] - side[:, None, 1] * side[None, :, 0]
    turn[turn == 0] = np.inf
    along = (away[..., 0] * side[None, :, 1] - away[..., 1] * side[None, :, 0]) / turn
    crossing = (along > 0) & (along < 1) & (along.T > 0) & (along.T < 1)
    heights = np.unique(np.append(flat[:, 1], (flat[:, None, 1] + along * side[:, None, 1])[crossing]))
    heights = heights[np.diff(heights, prepend=-np.inf) > TOUCHING]
    if len(heights) * len(flat) > MOST_SLABS:
        raise InputError(
            f"the sides of a polygon must cross less often, not {int(crossing.sum()) // 2:,} times; split it"
            " into triangles"
        )
    following = [*nodes[1:], nodes[0]]
    known: dict[float, list[tuple[float, int]]] = {}

    def node_at(row: int, height: float) -> int:
        """The node of a side at a height."""
        fraction = (height - flat[row, 1]) / side[row, 1]
        x = float(flat[row, 0] + fraction * side[row, 0])
        if fraction <= TOUCHING or fraction >= 1 - TOUCHING:
            return nodes[row] if fraction < 0.5 else following[row]
        # Sides that cross at this height share a node.
        at_height = known.setdefault(height, [])
        for other, node in at_height:
            if abs(other - x) <= TOUCHING:
                return node
        at_height.append((x, node_count + len(added)))
        added.append((nodes[row], following[row], fraction))
        return at_height[-1][1]

    pieces = []
    for low, high in pairwise(heights.tolist()):
        middle = low + (high - low) / 2
        rows = np.flatnonzero((flat[:, 1] < middle) != (ends[:, 1] < middle))
        across = flat[rows, 0] + (middle - flat[rows, 1]) / side[rows, 1] * side[rows, 0]
        rows = rows[np.argsort(across, kind="stable")]
        for left, right in zip(rows[::2].tolist(), rows[1::2].tolist(), strict=True):
            corners = [node_at(*place) for place in ((left, low), (right, low), (right, high), (left, high))]
            distinct = [each for at, each in enumerate(corners) if each != corners[at - 1]]
            if len(distinct) > 2:
                pieces.append((distinct + distinct[-1:])[:4])
    return np.array(pieces, np.intp).reshape(-1, 4)


def _in_their_planes(points: Floats) -> tuple[Floats, Booleans]:
    """Polygons, (n, corners, 3), projected to (n, corners, 2), counterclockwise; whether each is convex."""
    size = np.ptp(points, axis=1).max(axis=1)
    size[size == 0] = 1.0
    points = (points - points[:, :1]) / size[:, None, None]
    normals = np.cross(points, np.roll(points, -1, axis=1)).sum(axis=1)
    # The halves of a polygon whose sides cross may cancel: take the normal at its sharpest corner.
    incoming = points - np.roll(points, 1, axis=1)
    corner_normals = np.cross(incoming, np.roll(incoming, -1, axis=1))
    sharpest = (corner_normals**2).sum(axis=2).argmax(axis=1)
    cancel = (normals**2).sum(axis=1) < CANCELS**2
    normals[cancel] = corner_normals[cancel, sharpest[cancel]]
    # Project along the axis that preserves most of the area, from the side where the corners turn left.
    rows = np.arange(len(points))
    axis = np.abs(normals).argmax(axis=1)
    x = points[rows, :, (axis + 1) % 3]
    y = points[rows, :, (axis + 2) % 3]
    x[normals[rows, axis] < 0] *= -1
    flat = np.stack([x, y], axis=-1)
    outgoing = np.roll(flat, -1, axis=1) - flat
    incoming = np.roll(outgoing, 1, axis=1)
    turns = incoming[..., 0] * outgoing[..., 1] - incoming[..., 1] * outgoing[..., 0]
    return flat, np.all(turns >= -1e-12, axis=1)


def clipped_ears(points: Floats) -> Indices:
    """The pieces of counterclockwise polygons, (n, corners, 2), by ear clipping: (n, corners - 3, 4) corners.

    All pieces but the last of a polygon are triangles. A simple polygon always has an ear. If a
    self-intersecting polygon has no ear left, its remaining corners are clipped in order.
    """
    polygons, count, _ = points.shape
    rows, corners = np.arange(polygons), np.arange(count)
    before, after = (np.tile(np.roll(corners, step), (polygons, 1)) for step in (1, -1))
    is_left = np.ones((polygons, count), np.bool_)
    # A corner is an ear if no point is in its triangle.
    inside = np.stack(
        [_in_triangles(points, corner - 1, corner, corner + 1 - count) for corner in corners], 1
    )
    pieces = np.empty((polygons, count - 3, 4), np.intp)
    here, crosses = np.zeros(polygons, np.intp), np.zeros(polygons, np.bool_)
    counts = inside.sum(axis=2)
    for step in range(count - 4):
        # Find the next ear.
        is_ear = is_left & (counts == 0)
        crosses |= ~is_ear.any(axis=1)
        distances = np.where(is_ear, (corners - here[:, None]) % count, count)
        ear = np.where(crosses, here, distances.argmin(axis=1))
        # Clip it, and test its neighbors again.
        one, other = before[rows, ear], after[rows, ear]
        pieces[:, step] = np.stack([one, ear, other, other], axis=1)
        is_left[rows, ear] = False
        after[rows, one], before[rows, other] = other, one
        counts -= inside[rows, :, ear]
        inside[rows, :, ear] = False
        for corner in (one, other):
            tested = _in_triangles(points, before[rows, corner], corner, after[rows, corner]) & is_left
            inside[rows, corner], counts[rows, corner] = tested, tested.sum(axis=1)
        # Continue after the next corner: clipping adjacent ears would make slivers.
        here = after[rows, other]
    pieces[:, -1] = np.nonzero(is_left)[1].reshape(-1, 4)
    return pieces


def _in_triangles(points: Floats, before: Any, here: Any, after: Any) -> Booleans:
    """Which points of each polygon, (n, corners, 2), are in the triangle of three: (n, corners).

    Points on its border are in it, too, but not its corners; `here` is in it if it is reflex or straight.
    """
    rows = np.arange(len(points))
    p = points.view(np.complex128)[..., 0]
    a, b, c = corners = [p[rows, corner, None] for corner in (before, here, after)]
    inside = (_turns(a, b, p) >= 0) & (_turns(b, c, p) >= 0) & (_turns(c, a, p) >= 0)
    for corner in corners:
        inside &= p != corner
    inside[rows, here] = _turns(a, b, c)[:, 0] <= 0
    return inside


def _turns(a: Any, b: Any, c: Any) -> Floats:
    """Twice the areas of triangles, whose corners are complex numbers."""
    one, other = b - a, c - a
    turns: Floats = one.real * other.imag - one.imag * other.real
    return turns
