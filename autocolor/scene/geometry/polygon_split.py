"""Splitting polygons with more than four corners into quads and triangles.

Assumed: a convex polygon is split into a fan of quads around its first corner; a polygon with a reflex corner
is split by ear clipping, until a quad is left.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from functools import cached_property
from typing import Any, Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, underflowing
from autocolor.errors import InputError

MOST_CORNERS: Final = 1000
"""Limit: corners of one polygon."""

MOST_CLIPPING: Final = 20_000_000
"""Limit: corners of all clipped polygons; they take up to 30 microseconds each."""

FEW: Final = 30
"""Measured: the points at which arrays become faster."""

Point = tuple[float, float]


@underflowing
def split_polygons(coordinates: Floats, corners: Indices, counts: Indices) -> tuple[Indices, Indices]:
    """The pieces, (n, 4), and the index of the polygon of each piece, (n,).

    A piece is a quad, or a triangle that repeats its last node. The pieces are in polygon order; polygons
    with fewer than three corners have none. Raises InputError if there are too many large polygons with
    reflex corners.
    """
    for sides in (3, 4):
        if len(counts) and (counts == sides).all():
            # Measured: if all polygons have the same number of sides, this takes half the time.
            by_column = np.empty((4, len(counts)), np.intp)
            by_column[:sides] = corners.reshape(-1, sides).T
            by_column[3] = by_column[sides - 1]
            return by_column.T, np.arange(len(counts))
    starts = np.cumsum(counts) - counts
    small = np.flatnonzero((counts == 3) | (counts == 4))
    pieces = [corners[starts[small, None] + np.minimum(np.arange(4), counts[small, None] - 1)]]
    large = np.flatnonzero(counts > 4)
    if not len(large):
        return pieces[0], small
    owners = [small]
    clipping = 0
    for count in np.flatnonzero(np.bincount(counts[large])).tolist():
        rows = large[counts[large] == count]
        nodes = corners[starts[rows, None] + np.arange(count)]
        flat, convex = _in_their_planes(coordinates[nodes])
        fan = np.array([(0, at, at + 1, min(at + 2, count - 1)) for at in range(1, count - 1, 2)])
        pieces.append(nodes[convex][:, fan].reshape(-1, 4))
        owners.append(np.repeat(rows[convex], len(fan)))
        clipping += int((~convex).sum()) * count
        if clipping > MOST_CLIPPING:
            raise InputError(
                f"there must be fewer polygons with reflex corners, not so many with {count} corners; split"
                " them into triangles"
            )
        for row in np.flatnonzero(~convex).tolist():
            clipped = np.array(clipped_ears([(x, y) for x, y in flat[row].tolist()]))
            pieces.append(nodes[row][clipped])
            owners.append(np.repeat(rows[row], len(clipped)))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(pieces)[order], owner[order]


def _in_their_planes(points: Floats) -> tuple[Floats, Booleans]:
    """Polygons, (n, corners, 3), projected to (n, corners, 2), counterclockwise; whether each is convex."""
    size = np.ptp(points, axis=1).max(axis=1)
    size[size == 0] = 1.0
    points = (points - points[:, :1]) / size[:, None, None]
    normals = np.cross(points, np.roll(points, -1, axis=1)).sum(axis=1)
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
