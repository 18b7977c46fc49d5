"""Splitting polygons with more than four corners into quads and triangles.

Assumed: a convex polygon is split into a fan of quads around its first corner; a polygon with a reflex corner
is split by ear clipping, until a quad is left.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices
from autocolor.errors import InputError

MOST_CORNERS: Final = 1000
"""Limit: corners of one polygon; the time for ear clipping grows with their square."""

MOST_CLIPPING: Final = 200_000_000
"""Limit: the sum of squared corner counts of all clipped polygons; some minutes in the worst case."""

Point = tuple[float, float]


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
        clipping += int((~convex).sum()) * count * count
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
    """
    rows = list(range(len(points)))
    pieces = []
    at = looked = 0
    crossed = False
    while len(rows) > 4:
        before, here, after = rows[at - 1], rows[at], rows[(at + 1) % len(rows)]
        crossed = crossed or looked >= len(rows)
        if crossed or _is_ear(points, rows, before, here, after):
            pieces.append((before, here, after, after))
            del rows[at]
            # Continue after the next corner: clipping adjacent ears would make slivers.
            looked = 0
        else:
            looked += 1
        at = (at + 1) % len(rows)
    pieces.append((rows[0], rows[1], rows[2], rows[3]))
    return pieces


def _is_ear(points: list[Point], rows: list[int], before: int, here: int, after: int) -> bool:
    a, b, c = points[before], points[here], points[after]
    if _turn(a, b, c) <= 0:
        return False
    for row in rows:
        p = points[row]
        if p not in (a, b, c) and _turn(a, b, p) >= 0 and _turn(b, c, p) >= 0 and _turn(c, a, p) >= 0:
            return False
    return True


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
