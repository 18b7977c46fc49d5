"""The painted panels below the glass, their gaps, wheel arches and the underbody."""

from __future__ import annotations

import numpy as np

from scenes.coupe.body import (
    ARCH_HEIGHT, ARCH_RADIUS, AXLES, CREASE, LEDGE, S_END, s_at, top, wall,
)  # fmt: skip
from scenes.coupe.curves import Array, coons, invert, segment, spaced
from scenes.coupe.parts import Parts

GAP, GAP_DEPTH = 0.011, 0.005
FASCIA_CUT, DOOR_FRONT, DOOR_REAR, TAIL_CUT = -1.86, -0.56, 0.63, 1.83
SILL, DOOR_FOOT, SHOULDER, QUARTER_TOP = 0.35, 1.0, 7.0, 8.55
HOOD_EDGE = 9.09
UPPER_ROWS = spaced(SHOULDER, 7.5, 8.3, QUARTER_TOP, LEDGE, counts=(1, 3, 1, 1))
SIDE_ROWS = spaced(SILL, DOOR_FOOT, 3.2, CREASE, 4.8, SHOULDER, counts=(1, 4, 2, 2, 4))


def columns(start: float, end: float, count: int, rows: Array) -> Array:
    """Return the (count + 1, rows, 2) parameters of a side panel between two upright cuts."""
    grid = np.zeros((count + 1, len(rows), 2))
    for i, x in enumerate(np.linspace(start, end, count + 1)):
        grid[i] = np.stack([s_at(np.full(len(rows), x), rows), rows], axis=1)
    return grid


def skin(grid: Array) -> Array:
    """Return the points of a parameter grid."""
    return wall(grid[..., 0], grid[..., 1])


def around_arch(axle: float, front: float, rear: float) -> Array:
    """Return the parameters of the side panel about a wheel opening, from the front cut round to the rear cut."""
    foot = np.arcsin((0.215 - ARCH_HEIGHT) / ARCH_RADIUS)
    crease = np.arcsin((0.557 - ARCH_HEIGHT) / ARCH_RADIUS)
    angles = spaced(np.pi - foot, np.pi - crease, 2.15, 0.99, crease, foot, counts=(6, 3, 10, 3, 6))
    circle = np.stack([axle + ARCH_RADIUS * np.cos(angles), ARCH_HEIGHT + ARCH_RADIUS * np.sin(angles)], axis=1)
    inner = invert(wall, circle, (0, 2), np.stack([s_at(circle[:, 0], 4.0), circle[:, 1] * 9 - 1], axis=1))
    up = spaced(SILL, CREASE, SHOULDER, counts=(6, 3))
    ahead = np.stack([s_at(np.full(10, front), up), up], axis=1)
    behind = np.stack([s_at(np.full(10, rear), up), up], axis=1)[::-1]
    over = np.linspace(front, rear, 11)[1:-1]
    above = np.stack([s_at(over, SHOULDER), np.full(9, SHOULDER)], axis=1)
    outer = np.concatenate([ahead, above, behind])
    steps = np.array([0.0, 0.12, 0.30, 0.52, 0.76, 1.0])[None, :, None]
    ring: Array = inner[:, None] * (1 - steps) + outer[:, None] * steps
    return ring


def opening(parts: Parts, edge: Array, axle: float) -> None:
    """Add the turned-in lip of a wheel opening in body color and the dark wheel well behind it."""
    lip = np.stack([edge, edge - [0, 0.012, 0], edge - [0, 0.045, 0]], axis=1)
    lip[:, 1:, 0] += (axle - lip[:, 1:, 0]) * 0.012
    lip[:, 1:, 2] += (ARCH_HEIGHT - lip[:, 1:, 2]) * 0.012
    parts.grid("wheel_arches", lip, flip=False)
    rim = lip[::2, -1]
    deep = rim * [1, 0, 1] + [0, 0.50, 0]
    well = np.stack([rim, deep], axis=1)
    parts.grid("wheel_wells", well, flip=False)
    foot = segment(deep[0], deep[-1], len(deep) - 1)
    parts.grid("wheel_wells", np.stack([deep, (deep + foot) / 2, foot], axis=1), outward=(0.0, 1.0, 0.0))


def side(parts: Parts) -> None:
    """Add fenders, doors, sills and quarter panels with the gaps between them."""
    half = GAP / 2
    fender = columns(FASCIA_CUT + half, DOOR_FRONT - half, 10, UPPER_ROWS)
    parts.grid("fender_{side}", skin(fender))
    ring = around_arch(AXLES[0], FASCIA_CUT + half, DOOR_FRONT - half)
    parts.grid("fender_{side}", skin(ring))
    opening(parts, skin(ring[:, 0]), AXLES[0])

    door_rows = np.concatenate([SIDE_ROWS[1:-1], UPPER_ROWS])
    door_rows[0] += 0.06
    parts.grid("door_{side}", skin(columns(DOOR_FRONT + half, DOOR_REAR - half, 16, door_rows)))
    sill = np.array([SILL, 0.7, DOOR_FOOT])
    parts.grid("sill_{side}", skin(columns(DOOR_FRONT - half, DOOR_REAR + half, 8, sill)))

    quarter = columns(DOOR_REAR + half, TAIL_CUT - half, 10, UPPER_ROWS[:-1])
    parts.grid("quarter_{side}", skin(quarter))
    ring = around_arch(AXLES[1], DOOR_REAR + half, TAIL_CUT - half)
    parts.grid("quarter_{side}", skin(ring))
    opening(parts, skin(ring[:, 0]), AXLES[1])

    gap(parts, FASCIA_CUT, np.concatenate([spaced(SILL, 6.5, counts=(12,)), UPPER_ROWS]))
    gap(parts, DOOR_FRONT, np.concatenate([SIDE_ROWS[:-1], UPPER_ROWS]))
    gap(parts, DOOR_REAR, np.concatenate([SIDE_ROWS[:-1], UPPER_ROWS[:-1]]))
    gap(parts, TAIL_CUT, np.concatenate([spaced(SILL, 6.5, counts=(12,)), UPPER_ROWS[:-1]]))
    strip = columns(DOOR_FRONT, DOOR_REAR, 8, np.array([DOOR_FOOT - 0.05, DOOR_FOOT + 0.11]))
    parts.grid("gaps", skin(strip) - [0, GAP_DEPTH, 0])


def gap(parts: Parts, cut: float, rows: Array) -> None:
    """Add the dark bottom of an upright gap: a strip behind the skin, wider than the gap."""
    points = skin(columns(cut - 2 * GAP, cut + 2 * GAP, 1, rows))
    inward = np.stack([0 * rows, -np.ones(len(rows)), -1.6 * (rows > 7.6)], axis=-1)
    parts.grid("gaps", points + GAP_DEPTH * inward)


def fascia_columns(lines: Array, rows: Array, cut: float, fixed: float) -> Array:
    """Return parameters of a nose or tail panel: lines of constant s up to `fixed`, then leaning to the cut."""
    end = s_at(np.full(len(rows), cut), rows)
    far = lines[-1]
    grid = np.zeros((len(lines), len(rows), 2))
    for i, line in enumerate(lines):
        share = (line - fixed) / (far - fixed)
        grid[i, :, 0] = line if share <= 0 else fixed + share * (end - fixed)
        grid[i, :, 1] = rows
    return grid


def hood_outline(count_front: int, count_side: int, v: float, cowl: float) -> tuple[Array, Array]:
    """Return the hood's front edge (center to corner) and side edge (corner to cowl) on the line v."""
    fine = np.linspace(0, float(s_at(cowl, v)), 400)
    points = wall(fine, v)
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    corner = float(np.interp(2.75, fine, along))
    front = np.interp(np.linspace(0, corner, count_front + 1), along, fine)
    flank = np.interp(np.linspace(corner, along[-1], count_side + 1), along, fine)
    return wall(front, v), wall(flank, v)


def hood_rear(y: Array, side_y: float) -> Array:
    """Return the (n, 2) rear edge of the hood at these y."""
    return np.stack([-0.76 + 0.15 * (y / side_y) ** 2, y], axis=-1)


def hood(parts: Parts) -> None:
    """Add the hood, the gap about it and the cowl vent behind it."""
    front, flank = hood_outline(10, 18, HOOD_EDGE, -0.61)
    side_y = float(flank[-1, 1])
    rear = hood_rear(np.linspace(0, side_y, 11), side_y)
    center = segment(front[0, :2], rear[0], 18)
    plan = coons(front[:, :2], rear, center, flank[:, :2])
    points = np.concatenate([plan, top(plan[..., 0], plan[..., 1])[..., None]], axis=2)
    parts.grid("hood", points, outward=(0, 0, 1))
    below = [np.concatenate([a, b[1:]]) for a, b in (hood_outline(10, 18, v, -0.61) for v in (8.85, 9.3))]
    strip = np.stack(below, axis=1) - [0, 0, GAP_DEPTH]
    parts.grid("gaps", strip, outward=(0, 0, 1))


def underbody(parts: Parts) -> None:
    """Add the turned-under edge and a flat floor pan."""
    for start, end in ((0.0, -1.86), (-1.86, -1.73), (-0.99, 0.82), (1.58, 1.83), (1.83, 0.0)):
        a = 0.0 if start == 0.0 else float(s_at(start, 0.2))
        b = S_END if end == 0.0 else float(s_at(end, 0.2))
        s = np.linspace(a, b, 7)
        rows = np.array([0.0, SILL])
        edge = wall(s[:, None], rows[None])
        parts.grid("underbody", edge)
        pan = np.stack([edge[:, 0], edge[:, 0] * [1, 0, 1]], axis=1)
        parts.grid("underbody", pan, outward=(0, 0, -1))
    pan = segment((-1.73, 0, 0.2), (1.58, 0, 0.2), 10)
    parts.grid("underbody", np.stack([pan, pan + [0, 0.505, 0]], axis=1), outward=(0, 0, -1))


def build(parts: Parts) -> None:
    """Add the painted panels below the glass."""
    side(parts)
    hood(parts)
    underbody(parts)
