"""The plan of the bracket: half of its L, laid out flat, as blocks of quadrilaterals around its holes.

In the plan the first coordinate is the place along the inner curve of the L, from the front of the base up to
the top of the upright; the second is y, from 0 in the middle to the right side.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats
from scenes.modeling.bracket.blocks import Plan, along, around_hole, circle, plan_of, to_outline
from scenes.modeling.bracket.measures import (
    AXIS,
    BORE,
    BOSS,
    CORNER,
    COUNTERBORE,
    EDGE,
    HALF_WIDTH,
    HOLE,
    LENGTH,
    NOSE,
    RIB,
    ROOT,
    SEAT,
    TAPER,
    TOP,
)
from scenes.modeling.bracket.profile import BEND, RIB_BEGINS, height_of_rib, s_of_x, s_of_z
from scenes.modeling.bracket.roots import FOOT, FOOT_ANGLES, distances, scale_of_roots

FLAT: Final = 2.0
"""The width of the flat cells beyond a fillet. They are of its part, so that its normals end as a plane's."""

CENTER: Final = (float(s_of_z(AXIS)), 0.0)
"""The axis of the bearing."""

HOLES_X: Final = (51.5, 97.0)
HOLE_Y: Final = 28.0

RIB_COLUMNS: Final = 3
STRIP_COLUMNS: Final = 7
"""The columns of the rib's foot, and with them those of its fillet and the flat one."""

NOSE_LINE: Final = 1 + len(FOOT_ANGLES)
"""The line of the strip where the rib begins."""

SIDE_CELLS: Final = 7
TOP_CELLS: Final = 30

RING_RADII: Final = np.array(
    [
        *(BORE, (BORE + SEAT) / 2, SEAT, SEAT + 3, BOSS - 3),
        *(BOSS + distances(FOOT_ANGLES)[::-1]),
        BOSS + ROOT + FLAT,
    ]
)
"""The rings around the bearing's axis: the bore, the seat of the bearing, the boss's foot and its fillet."""
SEAT_RING: Final = 2
BOSS_RING: Final = 5
FLAT_RING: Final = len(RING_RADII) - 1

RIM: Final = EDGE + 1.0
"""The width of the cells along the outline: of the rounded edge, and of what is flat beside it."""

HOLE_RADII: Final = [HOLE, (HOLE + COUNTERBORE) / 2, COUNTERBORE, COUNTERBORE + 1.5]
COUNTERBORE_RING: Final = 2


def half_plan() -> Plan:
    """The plan of the half from y = 0 to the right side."""
    lines = _lines()
    last = lines["stem"][-1]
    blocks = {
        "strip": _strip(np.concatenate([lines["front"], *(lines[name][1:] for name in list(lines)[1:])]))
    }
    bottom = STRIP_COLUMNS
    for name, x in zip(("front", "back"), HOLES_X[::-1], strict=True):
        s, y = lines[name], _strip(lines[name])[:, bottom, 1]
        blocks[name] = _hole((float(s_of_x(x)), HOLE_Y), np.stack([s, y], axis=-1), name == "front")
    for name in ("bend", "stem"):
        inside, outside = _strip(lines[name])[:, bottom, 1], half_width(lines[name])
        y = np.stack([_across(*ends) for ends in zip(inside, outside, strict=True)])
        blocks[name] = np.stack([np.broadcast_to(lines[name][:, None], y.shape), y], axis=-1)
    foot = np.concatenate([_strip(np.array([last]))[0], blocks["stem"][-1, 1:]])
    blocks["bearing"] = _bearing(foot)
    return plan_of(blocks)


def _lines() -> dict[str, Floats]:
    """The places of the lines across the plan below the bearing, by the block beside the strip."""
    scale = scale_of_roots(height_of_rib(RIB_BEGINS))
    foot = s_of_x(NOSE + scale * distances(FOOT_ANGLES))
    front, middle = s_of_x(LENGTH), s_of_x(sum(HOLES_X) / 2)
    first = [front, (front + foot[0]) / 2, *foot, *np.linspace(foot[-1], middle, 8)[1:]]
    return {
        "front": np.array(first),
        "back": np.linspace(middle, -FLAT, 11),
        "bend": np.array([-FLAT, *np.linspace(0, BEND, 11), BEND + FLAT]),
        "stem": np.linspace(BEND + FLAT, CENTER[0] - TOP, 4),
    }


def _strip(s: Floats) -> Floats:
    """The lines of the strip along the rib at places s, (s, columns, 2)."""
    scale = scale_of_roots(height_of_rib(s))[:, None]
    foot = (RIB + FOOT * scale) * np.arange(RIB_COLUMNS) / RIB_COLUMNS
    fillet = RIB + scale * distances(FOOT_ANGLES)[::-1]
    fillet[:, -1] = RIB + ROOT
    y = np.concatenate([foot, fillet, np.full((len(s), 1), RIB + ROOT + FLAT)], axis=1)
    return np.stack([np.broadcast_to(s[:, None], y.shape), y], axis=-1)


def _across(first: float, last: float) -> Floats:
    """The y of the nodes from beside the rib to the right side."""
    return np.append(np.linspace(first, last - RIM, SIDE_CELLS), last)


def half_width(s: Floats) -> Floats:
    """The y of the right side at places below the round top, which it leans to from `TAPER` on."""
    start = float(s_of_z(TAPER))
    across, up = HALF_WIDTH, CENTER[0] - start
    apart = np.hypot(across, up)
    lean = np.arctan2(across, up) - np.arcsin(TOP / apart)
    return np.asarray(HALF_WIDTH - np.maximum(s - start, 0) * np.tan(lean))


def _side_of_top() -> Floats:
    """The outline from where the blocks around the bearing begin to the top: a line, then an arc; (n, 2)."""
    first = CENTER[0] - TOP
    slope = half_width(np.array([first + 1.0]))[0] - half_width(np.array([first]))[0]
    arc = circle(CENTER, TOP, np.linspace(np.pi / 2 - np.arctan(slope), 0, 200))
    return np.concatenate([[(first, half_width(np.array([first]))[0])], arc])


def _bearing(foot: Floats) -> Floats:
    """The block around the bearing's axis from the line below it, (columns, 2), over the side to the top."""
    side = along(_side_of_top(), TOP_CELLS)
    outline = np.concatenate([foot, side[1:]])
    rings = []
    for radius in RING_RADII:
        # Up to the strip's last column the lines keep their y; from there on the angles are halfway between
        # equal ones and those in which the outline is seen.
        begins = np.pi - np.arcsin(foot[: STRIP_COLUMNS + 1, 1] / max(radius, RING_RADII[BOSS_RING]))
        even = np.linspace(begins[-1], 0, len(outline) - STRIP_COLUMNS)
        seen = np.arctan2(*(outline[STRIP_COLUMNS:] - CENTER).T[::-1])
        rest = (even + begins[-1] * seen / seen[0]) / 2
        rings.append(circle(CENTER, radius, np.concatenate([begins, rest[1:]])))
        rings[-1][[0, -1], 1] = 0.0
    return np.concatenate([rings, to_outline(rings[-1], outline, RIM)])


def _hole(center: tuple[float, float], side: Floats, is_front: bool) -> Floats:
    """The block around a bolt hole; `side` is that toward the rib, (n, 2), from front to back."""
    low, high, y = side[0, 0], side[-1, 0], side[0, 1]
    radius = CORNER if is_front else 0.0
    corner = circle((low + radius, HALF_WIDTH - radius), radius, np.linspace(np.pi / 2, np.pi, 40))
    front = along(np.concatenate([[((low + high) / 2, HALF_WIDTH)], corner, [(low, y)]]), 5 + SIDE_CELLS)
    across = _across(y, HALF_WIDTH)
    back = np.stack([np.full(len(across), high), across], axis=-1)
    far = along(np.array([(high, HALF_WIDTH), ((low + high) / 2, HALF_WIDTH)]), 5)
    if not is_front:
        near = along(np.array([((low + high) / 2, HALF_WIDTH), (low, HALF_WIDTH)]), 5)
        front = np.concatenate([near, np.stack([np.full(len(across), low), across], axis=-1)[-2::-1]])
    outline = np.concatenate([side, back[1:], far[1:], front[1:]])
    return around_hole(center, HOLE_RADII, outline, RIM)
