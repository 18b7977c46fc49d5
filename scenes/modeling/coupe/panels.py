"""The painted panels below the glass, their gaps, wheel arches and the underbody."""

from __future__ import annotations

import numpy as np

from scenes.modeling.coupe.body import (
    ARCH_HEIGHT,
    ARCH_RADIUS,
    AXLES,
    CREASE,
    LEDGE,
    S_END,
    columns_at,
    s_at,
    skin,
    top,
    wall,
)
from scenes.modeling.coupe.curves import Array, coons, invert, segment, spaced
from scenes.modeling.coupe.parts import Parts

GAP, GAP_DEPTH = 0.011, 0.005
# Upright cuts between panels, at these x.
FASCIA_CUT, DOOR_FRONT, DOOR_REAR, TAIL_CUT = -1.86, -0.56, 0.63, 1.83
# Lines along the car, at these v.
SILL, DOOR_FOOT, SHOULDER, QUARTER_TOP, HOOD_EDGE = 0.35, 1.0, 7.0, 8.55, 9.09
COWL = -0.61
RING_TOP, RING_WIDTH = 10, 0.13
UPPER_ROWS = spaced(SHOULDER, 7.5, 8.3, QUARTER_TOP, LEDGE, counts=(1, 3, 1, 1))
LOWER_ROWS = spaced(SILL, CREASE, SHOULDER, counts=(6, 3))
SIDE_ROWS = spaced(SILL, DOOR_FOOT, 3.2, CREASE, 4.8, SHOULDER, counts=(1, 4, 2, 2, 4))
GAP_ROWS = spaced(SILL, 6.5, counts=(8,))
HOOD_CELLS = (10, 18)


def around_arch(axle: float, front: float, rear: float) -> Array:
    """Return the parameters of the ring round a wheel opening, from its front line to its rear line."""
    foot = np.arcsin((0.215 - ARCH_HEIGHT) / ARCH_RADIUS)
    crease = np.arcsin((0.557 - ARCH_HEIGHT) / ARCH_RADIUS)
    angles = spaced(np.pi - foot, np.pi - crease, 2.2, 0.94, crease, foot, counts=(6, 3, RING_TOP, 3, 6))
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1) * ARCH_RADIUS + [axle, ARCH_HEIGHT]
    guess = np.stack([s_at(circle[:, 0], CREASE), circle[:, 1] * 9 - 1], axis=1)
    inner = invert(wall, circle, (0, 2), guess)
    ahead, behind = columns_at(np.array([front, rear]), LOWER_ROWS)
    above = columns_at(np.linspace(front, rear, RING_TOP + 1)[1:-1], np.array([SHOULDER]))[:, 0]
    outer = np.concatenate([ahead, above, behind[::-1]])
    steps = np.array([0.0, 0.16, 0.40, 0.68, 1.0])[None, :, None]
    ring: Array = inner[:, None] * (1 - steps) + outer[:, None] * steps
    return ring


def wheel_panel(parts: Parts, part: str, axle: float, cuts: tuple[float, float], rows: Array) -> None:
    """Add a fender or quarter panel: a ring about the wheel, upright columns beside it, rows above."""
    front = max(cuts[0], axle - ARCH_RADIUS - RING_WIDTH)
    rear = min(cuts[1], axle + ARCH_RADIUS + RING_WIDTH)
    ahead = np.linspace(cuts[0], front, 1 + int(np.ceil((front - cuts[0]) / 0.08)))
    behind = np.linspace(rear, cuts[1], 1 + int(np.ceil((cuts[1] - rear) / 0.08)))
    over = np.linspace(front, rear, RING_TOP + 1)
    parts.grid(part, skin(columns_at(np.concatenate([ahead[:-1], over, behind[1:]]), rows)))
    for stations in (ahead, behind):
        parts.grid(part, skin(columns_at(stations, LOWER_ROWS)))
    ring = skin(around_arch(axle, front, rear))
    parts.grid(part, ring)
    opening(parts, ring[:, 0], axle)


def opening(parts: Parts, edge: Array, axle: float) -> None:
    """Add the turned-in lip of a wheel opening in body color and the dark wheel well behind it."""
    lip = np.stack([edge, edge - [0, 0.012, 0], edge - [0, 0.045, 0]], axis=1)
    lip[:, 1:] += (np.array([axle, 0, ARCH_HEIGHT]) - lip[:, 1:]) * [0.012, 0, 0.012]
    parts.grid("wheel_arches", lip, flip=False)
    rim = lip[::2, -1]
    deep = rim * [1, 0, 1] + [0, 0.50, 0]
    parts.grid("wheel_wells", np.stack([rim, deep], axis=1), flip=False)
    foot = segment(deep[0], deep[-1], len(deep) - 1)
    parts.grid("wheel_wells", np.stack([deep, foot], axis=1), outward=(0, 1, 0))


def side(parts: Parts) -> None:
    """Add fenders, doors, sills and quarter panels with the gaps between them."""
    half = GAP / 2
    wheel_panel(parts, "fender_{side}", AXLES[0], (FASCIA_CUT + half, DOOR_FRONT - half), UPPER_ROWS)
    wheel_panel(parts, "quarter_{side}", AXLES[1], (DOOR_REAR + half, TAIL_CUT - half), UPPER_ROWS[:-1])
    door_rows = np.concatenate([[DOOR_FOOT + 0.06], SIDE_ROWS[2:-1], UPPER_ROWS])
    stations = np.linspace(DOOR_FRONT + half, DOOR_REAR - half, 17)
    parts.grid("door_{side}", skin(columns_at(stations, door_rows)))
    stations = np.linspace(DOOR_FRONT - half, DOOR_REAR + half, 9)
    parts.grid("sill_{side}", skin(columns_at(stations, np.array([SILL, 0.7, DOOR_FOOT]))))

    gap(parts, FASCIA_CUT, np.concatenate([GAP_ROWS, UPPER_ROWS]))
    gap(parts, DOOR_FRONT, np.concatenate([SIDE_ROWS[:-1], UPPER_ROWS]))
    gap(parts, DOOR_REAR, np.concatenate([SIDE_ROWS[:-1], UPPER_ROWS[:-1]]))
    gap(parts, TAIL_CUT, np.concatenate([GAP_ROWS, UPPER_ROWS[:-1]]))
    below_door = columns_at(stations, np.array([DOOR_FOOT - 0.05, DOOR_FOOT + 0.11]))
    parts.grid("gaps", skin(below_door) - [0, GAP_DEPTH, 0])


def gap(parts: Parts, cut: float, rows: Array) -> None:
    """Add the dark bottom of an upright gap: a strip behind the skin, wider than the gap."""
    points = skin(columns_at(np.array([cut - 2 * GAP, cut + 2 * GAP]), rows))
    inward = np.stack([0 * rows, -np.ones(len(rows)), -1.6 * (rows > 7.6)], axis=-1)
    parts.grid("gaps", points + GAP_DEPTH * inward)


def hood_outline(v: float) -> tuple[Array, Array]:
    """Return the hood's front edge (center to corner) and side edge (corner to cowl) on the line v."""
    fine = np.linspace(0, float(s_at(COWL, v)), 400)
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(wall(fine, v), axis=0), axis=1))])
    corner = float(np.interp(2.75, fine, along))
    front = np.interp(np.linspace(0, corner, HOOD_CELLS[0] + 1), along, fine)
    side_edge = np.interp(np.linspace(corner, along[-1], HOOD_CELLS[1] + 1), along, fine)
    return wall(front, v), wall(side_edge, v)


def hood_rear(count: int) -> Array:
    """Return count + 1 points of the hood's rear edge, center to side."""
    y = np.linspace(0, float(wall(s_at(COWL, HOOD_EDGE), HOOD_EDGE)[1]), count + 1)
    x = -0.76 + (COWL + 0.76) * (y / y[-1]) ** 2
    return np.stack([x, y, top(x, y)], axis=1)


def hood(parts: Parts) -> None:
    """Add the hood and the bottom of the gap about it."""
    front, side_edge = hood_outline(HOOD_EDGE)
    rear = hood_rear(HOOD_CELLS[0])
    center = segment(front[0], rear[0], HOOD_CELLS[1])
    points = coons(front, rear, center, side_edge)
    points[..., 2] = top(points[..., 0], points[..., 1])
    parts.grid("hood", points, outward=(0, 0, 1))
    inner, outer = (np.concatenate([a, b[1:]]) for a, b in map(hood_outline, (9.3, 8.85)))
    parts.grid("gaps", np.stack([inner, outer], axis=1) - [0, 0, GAP_DEPTH], outward=(0, 0, 1))


def underbody(parts: Parts) -> None:
    """Add the turned-under edge, leaving out the wheel openings, and a flat floor pan."""
    at = [float(s_at(x, 0.2)) for x in (FASCIA_CUT, -1.73, -0.99, 0.82, 1.58, TAIL_CUT)]
    for start, end in ((0.0, at[0]), (at[0], at[1]), (at[2], at[3]), (at[4], at[5]), (at[5], S_END)):
        edge = wall(np.linspace(start, end, 7)[:, None], np.array([0.0, SILL])[None])
        parts.grid("underbody", edge)
        pan = np.stack([edge[:, 0], edge[:, 0] * [1, 0, 1]], axis=1)
        parts.grid("underbody", pan, outward=(0, 0, -1))
    center = segment((-1.73, 0, 0.2), (1.58, 0, 0.2), 10)
    beside = center + np.array([0, 0.505, 0])
    parts.grid("underbody", np.stack([center, beside], axis=1), outward=(0, 0, -1))


def build(parts: Parts) -> None:
    """Add the painted panels below the glass."""
    side(parts)
    hood(parts)
    underbody(parts)
