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
RING_TOP, RING_WIDTH = 10, 0.13
UPPER_ROWS = spaced(SHOULDER, 7.5, 8.3, QUARTER_TOP, LEDGE, counts=(1, 3, 1, 1))
LOWER_ROWS = spaced(SILL, CREASE, SHOULDER, counts=(6, 3))
SIDE_ROWS = spaced(SILL, DOOR_FOOT, 3.2, CREASE, 4.8, SHOULDER, counts=(1, 4, 2, 2, 4))


def columns(stations: Array, rows: Array) -> Array:
    """Return the (stations, rows, 2) parameters of a side panel with upright lines at these x."""
    x, v = np.meshgrid(stations, rows, indexing="ij")
    return np.stack([s_at(x, v), v], axis=-1)


def skin(grid: Array) -> Array:
    """Return the points of a parameter grid."""
    return wall(grid[..., 0], grid[..., 1])


def around_arch(axle: float, front: float, rear: float) -> Array:
    """Return the parameters of the ring of panel round a wheel opening, from the front line to the rear line."""
    foot = np.arcsin((0.215 - ARCH_HEIGHT) / ARCH_RADIUS)
    crease = np.arcsin((0.557 - ARCH_HEIGHT) / ARCH_RADIUS)
    angles = spaced(np.pi - foot, np.pi - crease, 2.2, 0.94, crease, foot, counts=(6, 3, RING_TOP, 3, 6))
    circle = np.stack([axle + ARCH_RADIUS * np.cos(angles), ARCH_HEIGHT + ARCH_RADIUS * np.sin(angles)], axis=1)
    inner = invert(wall, circle, (0, 2), np.stack([s_at(circle[:, 0], 4.0), circle[:, 1] * 9 - 1], axis=1))
    ahead, behind = columns(np.array([front, rear]), LOWER_ROWS)
    above = columns(np.linspace(front, rear, RING_TOP + 1)[1:-1], np.array([SHOULDER]))[:, 0]
    outer = np.concatenate([ahead, above, behind[::-1]])
    steps = np.array([0.0, 0.16, 0.40, 0.68, 1.0])[None, :, None]
    ring: Array = inner[:, None] * (1 - steps) + outer[:, None] * steps
    return ring


def wheel_panel(parts: Parts, part: str, axle: float, cuts: tuple[float, float], rows: Array) -> None:
    """Add a fender or quarter panel between two cuts: a ring about the wheel, columns beside it, rows above."""
    front = max(cuts[0], axle - ARCH_RADIUS - RING_WIDTH)
    rear = min(cuts[1], axle + ARCH_RADIUS + RING_WIDTH)
    ahead = np.linspace(cuts[0], front, 1 + int(np.ceil((front - cuts[0]) / 0.08)))
    behind = np.linspace(rear, cuts[1], 1 + int(np.ceil((cuts[1] - rear) / 0.08)))
    over = np.linspace(front, rear, RING_TOP + 1)
    parts.grid(part, skin(columns(np.concatenate([ahead[:-1], over, behind[1:]]), rows)))
    for stations in (ahead, behind):
        parts.grid(part, skin(columns(stations, LOWER_ROWS)))
    ring = skin(around_arch(axle, front, rear))
    parts.grid(part, ring)
    opening(parts, ring[:, 0], axle)


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
    parts.grid("wheel_wells", np.stack([deep, foot], axis=1), outward=(0.0, 1.0, 0.0))


def side(parts: Parts) -> None:
    """Add fenders, doors, sills and quarter panels with the gaps between them."""
    half = GAP / 2
    wheel_panel(parts, "fender_{side}", AXLES[0], (FASCIA_CUT + half, DOOR_FRONT - half), UPPER_ROWS)
    wheel_panel(parts, "quarter_{side}", AXLES[1], (DOOR_REAR + half, TAIL_CUT - half), UPPER_ROWS[:-1])
    door_rows = np.concatenate([SIDE_ROWS[1:-1], UPPER_ROWS])
    door_rows[0] += 0.06
    parts.grid("door_{side}", skin(columns(np.linspace(DOOR_FRONT + half, DOOR_REAR - half, 16), door_rows)))
    sill = np.array([SILL, 0.7, DOOR_FOOT])
    parts.grid("sill_{side}", skin(columns(np.linspace(DOOR_FRONT - half, DOOR_REAR + half, 9), sill)))

    gap(parts, FASCIA_CUT, np.concatenate([spaced(SILL, 6.5, counts=(8,)), UPPER_ROWS]))
    gap(parts, DOOR_FRONT, np.concatenate([SIDE_ROWS[:-1], UPPER_ROWS]))
    gap(parts, DOOR_REAR, np.concatenate([SIDE_ROWS[:-1], UPPER_ROWS[:-1]]))
    gap(parts, TAIL_CUT, np.concatenate([spaced(SILL, 6.5, counts=(8,)), UPPER_ROWS[:-1]]))
    strip = columns(np.linspace(DOOR_FRONT, DOOR_REAR, 9), np.array([DOOR_FOOT - 0.05, DOOR_FOOT + 0.11]))
    parts.grid("gaps", skin(strip) - [0, GAP_DEPTH, 0])


def gap(parts: Parts, cut: float, rows: Array) -> None:
    """Add the dark bottom of an upright gap: a strip behind the skin, wider than the gap."""
    points = skin(columns(np.array([cut - 2 * GAP, cut + 2 * GAP]), rows))
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
    front, flank = hood_outline(10, 17, HOOD_EDGE, -0.61)
    side_y = float(flank[-1, 1])
    rear = hood_rear(np.linspace(0, side_y, 11), side_y)
    center = segment(front[0, :2], rear[0], 17)
    plan = coons(front[:, :2], rear, center, flank[:, :2])
    points = np.concatenate([plan, top(plan[..., 0], plan[..., 1])[..., None]], axis=2)
    parts.grid("hood", points, outward=(0, 0, 1))
    below = [np.concatenate([a, b[1:]]) for a, b in (hood_outline(10, 17, v, -0.61) for v in (8.85, 9.3))]
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
