"""Polygons of more than four corners as quads and triangles.

Assumed: a convex one is cut into quads that fan out from its first corner; from one that has a corner
pointing inward, triangles are clipped where no other corner lies in them, until a quad is left.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Flags, Floats, Numbers
from autocolor.errors import InputError

MOST_CORNERS: Final = 1000
"""Assumed: corners of one polygon; clipping takes time with their square."""

MOST_CLIPPING: Final = 200_000_000
"""Assumed: the sum of the squared corners of all polygons that are clipped, some minutes at the worst."""

Point = tuple[float, float]


def split_polygons(coordinates: Floats, corners: Numbers, counts: Numbers) -> tuple[Numbers, Numbers]:
    """Pieces (n, 4), each a quad or a triangle that repeats its last node, and the row of each one's polygon.

    The pieces stand in the order of the polygons; those with fewer than three corners have none.
    Raises InputError where the polygons with corners that point inward are too many and too large.
    """
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
                f"polygons with corners that point inward must be fewer, not so many with {count} corners;"
                " split them into triangles"
            )
        for row in np.flatnonzero(~convex).tolist():
            clipped = np.array(clipped_ears([(x, y) for x, y in flat[row].tolist()]))
            pieces.append(nodes[row][clipped])
            owners.append(np.repeat(rows[row], len(clipped)))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(pieces)[order], owner[order]


def _in_their_planes(
    points: Floats,
) -> tuple[Floats, Flags]:
    """Polygons (n, corners, 3) as (n, corners, 2), turning left, and whether no corner points inward."""
    size = np.ptp(points, axis=1).max(axis=1)
    size[size == 0] = 1.0
    points = (points - points[:, :1]) / size[:, None, None]
    normals = np.cross(points, np.roll(points, -1, axis=1)).sum(axis=1)
    # Look along the axis on which the polygon shows most of its area, from the side where it turns left.
    rows = np.arange(len(points))
    axis = np.abs(normals).argmax(axis=1)
    across = points[rows, :, (axis + 1) % 3]
    along = points[rows, :, (axis + 2) % 3]
    across[normals[rows, axis] < 0] *= -1
    flat = np.stack([across, along], axis=-1)
    onward = np.roll(flat, -1, axis=1) - flat
    before = np.roll(onward, 1, axis=1)
    turns = before[..., 0] * onward[..., 1] - before[..., 1] * onward[..., 0]
    return flat, np.all(turns >= -1e-12, axis=1)


def clipped_ears(points: list[Point]) -> list[tuple[int, int, int, int]]:
    """The pieces of one polygon that turns left, as rows of its points; the last has four corners.

    One that does not cross itself always has an ear; from another, what is left is clipped as it comes.
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
            # Look at the corner after next: ears taken in a row would make slivers.
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
