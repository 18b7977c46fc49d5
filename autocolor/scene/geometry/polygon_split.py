"""Splitting polygons with more than four corners, and polygons whose sides cross, into quads and triangles.

Assumed: a convex polygon is split into a fan of quads around its first corner; a polygon with a reflex corner
is split by ear clipping, until a quad is left. A polygon whose sides cross, such as a bow-tie or a pentagram,
is filled even-odd: a point is inside if a ray from it crosses an odd number of sides. It is split into slabs
between the heights of its corners and crossings, with new nodes where slabs end on a side.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from functools import cached_property
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
"""Limit: corners of all clipped polygons; they take up to 30 microseconds each."""

MOST_SLABS: Final = 100_000
"""Limit: heights of corners and crossings times sides, in a polygon whose sides cross."""

FEW: Final = 30
"""Measured: the points at which arrays become faster."""

Point = tuple[float, float]


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
    is_small = (counts == 3) | (counts == 4)
    for sides in (3, 4):
        if not len(counts) or not (counts == sides).all():
            continue
        # Measured: if all polygons have the same number of sides, this takes half the time.
        by_column = np.empty((4, len(counts)), np.intp)
        by_column[:sides] = corners.reshape(-1, sides).T
        by_column[3] = by_column[sides - 1]
        if sides == 4:
            is_small = ~crossed_quads(coordinates, by_column.T)
        if is_small.all():
            return Pieces(by_column.T, np.arange(len(counts)))
    quads = np.flatnonzero(is_small & (counts == 4))
    is_small[quads] = ~crossed_quads(coordinates, corners[starts[quads, None] + np.arange(4)])
    small = np.flatnonzero(is_small)
    pieces = [corners[starts[small, None] + np.minimum(np.arange(4), counts[small, None] - 1)]]
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
        for row in np.flatnonzero(~convex).tolist():
            if crosses[row]:
                clipped = even_odd_slabs(flat[row], nodes[row].tolist(), len(coordinates), added)
                clipping += clipped.size
                _check_clipping(clipping, count)
                pieces.append(clipped)
            else:
                clipped = np.array(clipped_ears([(x, y) for x, y in flat[row].tolist()]))
                pieces.append(nodes[row][clipped])
            owners.append(np.repeat(rows[row], len(clipped)))
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


def clipped_ears(points: list[Point]) -> list[tuple[int, int, int, int]]:
    """The pieces of one counterclockwise polygon by ear clipping, as indices of its points.

    All but the last are triangles. A simple polygon always has an ear. If a self-intersecting polygon has no
    ear left, its remaining corners are clipped in order.

    A corner that is no ear is tested again only after a neighbor was clipped, or the last point in its
    triangle. Measured: a spiral of 1,000 corners takes 20 ms, and 1.2 s if all corners are tested in turn.
    """
    count = len(points)
    before, after = [count - 1, *range(count - 1)], [*range(1, count), 0]
    in_triangle = PointsInTriangles(points)
    is_left = [True] * count
    blockers: list[list[int] | None] = [None] * count
    blocked: list[list[int]] = [[] for _ in points]
    untested = list(range(count))
    pieces: list[tuple[int, int, int, int]] = []
    here = 0
    crosses = False
    while len(pieces) < count - 4:
        # Find the next ear.
        while untested and not crosses:
            corner = untested.pop(bisect_left(untested, here) % len(untested))
            inside = blockers[corner]
            if inside is None:
                inside = blockers[corner] = in_triangle(before[corner], corner, after[corner])
            while inside and not is_left[inside[-1]]:
                inside.pop()
            if not inside:
                here = corner
                break
            blocked[inside[-1]].append(corner)
        else:
            crosses = True
        # Clip it, and test again the corners for which this matters.
        one, other = before[here], after[here]
        pieces.append((one, here, other, other))
        is_left[here] = False
        after[one], before[other] = other, one
        blockers[one] = blockers[other] = None
        for corner in (one, other, *blocked[here]):
            at = bisect_left(untested, corner)
            if is_left[corner] and untested[at : at + 1] != [corner]:
                untested.insert(at, corner)
        # Continue after the next corner: clipping adjacent ears would make slivers.
        here = after[other]
    a, b, c, d = (corner for corner in range(count) if is_left[corner])
    return [*pieces, (a, b, c, d)]


class PointsInTriangles:
    """Finds which points of a polygon are in a triangle of three of them, or on its border."""

    def __init__(self, points: list[Point]) -> None:
        self.points = points
        self.rows = sorted(range(len(points)), key=points.__getitem__)
        self.sorted_x = [points[row][0] for row in self.rows]

    @cached_property
    def columns(self) -> Any:
        """The points in the order of their rows, (2, points)."""
        return np.array([self.points[row] for row in self.rows]).T

    def __call__(self, before: int, here: int, after: int) -> list[int]:
        """The points in the triangle except its corners; the corner `here` if it is reflex or straight."""
        a, b, c = corners = [self.points[row] for row in (before, here, after)]
        if _turn(a, b, c) <= 0:
            return [here]
        first = bisect_left(self.sorted_x, min(corners)[0])
        last = bisect_right(self.sorted_x, max(corners)[0])
        rows = self.rows[first:last]
        if last - first > FEW:
            p = self.columns[:, first:last]
            is_inside = (_turn(a, b, p) >= 0) & (_turn(b, c, p) >= 0) & (_turn(c, a, p) >= 0)
            inside = (rows[at] for at in np.flatnonzero(is_inside).tolist())
            return [row for row in inside if self.points[row] not in corners]
        return [
            row
            for row in rows
            if (p := self.points[row]) not in corners
            and _turn(a, b, p) >= 0
            and _turn(b, c, p) >= 0
            and _turn(c, a, p) >= 0
        ]


def _turn(a: Point, b: Point, c: Any) -> Any:
    """Twice the area of a triangle; c may be rows of x and y."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
