"""The closed skin of the car: columns of nodes from nose to tail, whose cells become panels and shut lines.

A column runs from the sill (row 0) over the crease and the shoulder to the edge of hood, glass and deck
(row EDGE_ROW). The columns beside the glass go on over the roof to the center line. Neighboring panels
share the nodes of the shut line between them: a dark strip in the skin, wide enough to be seen at 640 x
480. So no panel has a border, and nothing shows through a crack.
"""

from __future__ import annotations

import numpy as np

from scenes.modeling.coupe import cabin, canopy, ends
from scenes.modeling.coupe.body import (
    ARCH_HEIGHT,
    ARCH_RADIUS,
    AXLES,
    COWL,
    CREASE,
    DOOR_FOOT,
    DOOR_FRONT,
    FASCIA_CUT,
    GAP,
    ROWS,
    SHOULDER,
    TAIL_CUT,
    TAIL_GAP,
    columns_at,
    s_at,
    skin,
    top,
    wall,
)
from scenes.modeling.coupe.curves import Array, coons, invert, segment, spaced
from scenes.modeling.coupe.parts import Names, Parts

FOOT_ROW, CREASE_ROW, SHOULDER_ROW = (
    int(row) for row in np.searchsorted(ROWS, (DOOR_FOOT, CREASE, SHOULDER))
)
EDGE_ROW = len(ROWS) - 1
RING_WIDTH = 0.11
WELL = 0.50
LIFT = 0.010
"""The hood is this much higher than `top`: its shut line shows on the near side and hides on the far one."""


class Skin:
    """The columns of the right side, in parameters (columns, rows, 2), and the numbers of some columns."""

    def __init__(self) -> None:
        """Lay out the columns."""
        half, x = GAP / 2, canopy.feet()
        front = AXLES[0] + ARCH_RADIUS + RING_WIDTH
        fender = spaced(FASCIA_CUT + half, front, COWL, DOOR_FRONT - half, counts=(12, 3, 1))
        rear = spaced(x[-1], TAIL_CUT - TAIL_GAP / 2, counts=(1,))
        stations = np.concatenate([fender, [DOOR_FRONT + half], x, rear[1:]])
        nose, tail = ends.nose_columns(), ends.tail_columns()
        self.nose, self.tail = len(nose), len(nose) + len(stations)
        self.cowl = self.nose + len(fender) - 2
        self.door = self.nose + len(fender)
        self.glass, self.deck = self.door + 1, self.door + len(x)
        self.quarter = self.glass + canopy.POST + 1
        self.grid = np.concatenate([nose, columns_at(stations, ROWS), tail[::-1]])
        self.points = skin(self.grid)
        self.arches = (self.nose, self.nose + 12), self.arch_at(AXLES[1])

    def arch_at(self, axle: float) -> tuple[int, int]:
        """Return the columns that are nearest to the ring round the opening of the rear wheel."""
        x = self.points[self.quarter : self.deck, SHOULDER_ROW, 0]
        reach = ARCH_RADIUS + RING_WIDTH
        front, rear = (int(np.abs(x - at).argmin()) + self.quarter for at in (axle - reach, axle + reach))
        return front, rear


def side_names(skin_: Skin) -> Names:
    """Return the parts of the cells (columns - 1, rows - 1) below hood, glass and deck."""
    names = np.full((len(skin_.grid) - 1, EDGE_ROW), "quarter_{side}", dtype="<U16")
    names[: skin_.nose - 1] = "front_fascia"
    names[skin_.nose : skin_.door - 1] = "fender_{side}"
    names[skin_.door : skin_.quarter - 1] = "door_{side}"
    names[skin_.door - 1 : skin_.quarter, :FOOT_ROW] = "sill_{side}"
    for cut in (skin_.nose - 1, skin_.door - 1, skin_.quarter - 1, skin_.tail - 1):
        names[cut, FOOT_ROW if skin_.nose < cut < skin_.tail - 1 else 0 :] = "gaps"
    names[skin_.door - 1 : skin_.quarter, FOOT_ROW] = "gaps"
    names[skin_.tail :] = "rear_fascia"
    # The shut line of the hood, and the edge of the deck.
    names[: skin_.glass, -1] = "gaps"
    names[skin_.deck :, -1] = "deck"
    ends.cut_holes(names)
    for front, rear in skin_.arches:
        names[front:rear, :SHOULDER_ROW] = ""
    return names


def arch(parts: Parts, part: str, skin_: Skin, columns: tuple[int, int], axle: float) -> None:
    """Add the ring round a wheel opening, its lip and the wheel well."""
    front, rear = columns
    lower = slice(0, SHOULDER_ROW + 1)
    outer = np.concatenate(
        [
            skin_.grid[front, lower],
            skin_.grid[front + 1 : rear, SHOULDER_ROW],
            skin_.grid[rear, lower][::-1],
        ]
    )
    foot = np.arcsin((0.215 - ARCH_HEIGHT) / ARCH_RADIUS)
    crease = np.arcsin((0.557 - ARCH_HEIGHT) / ARCH_RADIUS)
    over = SHOULDER_ROW - CREASE_ROW
    angles = spaced(
        np.pi - foot, np.pi - crease, 2.2, 0.94, crease, foot,
        counts=(CREASE_ROW, over, rear - front, over, CREASE_ROW),
    )  # fmt: skip
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1) * ARCH_RADIUS + [axle, ARCH_HEIGHT]
    guess = np.stack([s_at(circle[:, 0], CREASE), circle[:, 1] * 9 - 1], axis=1)
    inner = invert(wall, circle, (0, 2), guess)
    steps = np.array([0.0, 0.12, 0.27, 0.46, 0.70, 1.0])
    ring = skin(inner[:, None] * (1 - steps[:, None]) + outer[:, None] * steps[:, None])
    parts.grid(part, ring)

    edge = ring[:, 0]
    lip = np.stack([edge, edge - [0, 0.045, 0]], axis=1)
    lip[:, 1] += (np.array([axle, 0, ARCH_HEIGHT]) - lip[:, 1]) * [0.012, 0, 0.012]
    parts.grid("wheel_arches", lip, flip=False)
    deep = lip[:, -1] * [1, 0, 1] + [0, WELL, 0]
    parts.grid("wheel_wells", np.stack([lip[:, -1], deep], axis=1), flip=False)
    bottom = segment(deep[0], deep[-1], len(deep) - 1)
    parts.grid("wheel_wells", np.stack([deep, bottom], axis=1), outward=(0, 1, 0))
    parts.grid("underbody", np.stack([bottom, bottom * [1, 0, 1]], axis=1), outward=(0, 0, -1))

    # Close the skin below the ring: from the column beside it to the end of lip and well.
    for end, column in ((0, front), (-1, rear)):
        rim = np.concatenate([lip[end], [deep[end], deep[end] * [1, 0, 1]]])
        share = np.linspace(0, 1, len(steps))[:, None, None]
        strip = turned_under(skin_, column)[None] * (1 - share) + rim[None] * share
        strip[:, 0] = ring[end, ::-1]
        parts.grid("underbody", strip, outward=(0, 0, -1))


def turned_under(skin_: Skin, column: int) -> Array:
    """Return the nodes (4, 3) of a column below the car, from the sill to the center line."""
    sill = skin_.points[column, 0]
    inner = np.array([0.985 * sill[0], 0.94 * sill[1], 0.2])
    pan = np.array([inner[0], min(WELL, 0.9 * inner[1]), 0.2])
    return np.stack([sill, inner, pan, pan * [1, 0, 1]])


def hood(parts: Parts, skin_: Skin, shield: Array) -> None:
    """Add the hood, and the dark vent panel between hood and windshield, whose foot is `shield`."""
    edge = skin_.points[:, EDGE_ROW]
    front, side = edge[: ends.CORNER + 1], edge[ends.CORNER : skin_.cowl + 1]
    y = np.linspace(0, 1, len(front)) * side[-1, 1]
    x = -0.76 + (side[-1, 0] + 0.76) * (y / y[-1]) ** 2
    rear = np.stack([x, y, top(x, y) + LIFT], axis=1)
    rear[-1] = side[-1]
    points = coons(front, rear, segment(front[0], rear[0], len(side) - 1), side)
    points[..., 2] = top(points[..., 0], points[..., 1]) + LIFT
    parts.grid("hood", points, outward=(0, 0, 1))
    side = edge[skin_.cowl : skin_.glass + 1]
    middle = segment(rear[0], shield[0], len(side) - 1)
    parts.grid("cowl", coons(rear, shield, middle, side), outward=(0, 0, 1))


def deck(parts: Parts, skin_: Skin, front: Array) -> None:
    """Add the short deck behind the hatch glass, which ends at `front`."""
    edge = skin_.points[:, EDGE_ROW]
    corner = len(edge) - 1 - ends.CORNER
    rear, side = edge[corner:][::-1], edge[skin_.deck : corner + 1]
    parts.grid("deck", coons(front, rear, segment(front[0], rear[0], len(side) - 1), side), outward=(0, 0, 1))


def build(parts: Parts) -> None:
    """Add the whole skin."""
    skin_ = Skin()
    beside = canopy.columns()
    # The fillet between quarter panel and hatch belongs to the columns beside the glass.
    skin_.points[skin_.glass : skin_.deck + 1] = beside[:, : EDGE_ROW + 1]
    skin_.points[: skin_.cowl + 1, EDGE_ROW, 2] += LIFT
    parts.grid(side_names(skin_), skin_.points)
    names = cabin.opened(canopy.names())
    parts.grid(names, beside[:, EDGE_ROW:])
    cabin.build(parts, beside[:, EDGE_ROW:], names)
    for part, columns, axle in zip(("fender_{side}", "quarter_{side}"), skin_.arches, AXLES, strict=True):
        arch(parts, part, skin_, columns, axle)
    shield, hatch = beside[[0, -1], EDGE_ROW + canopy.FLANK :][:, ::-1]
    hood(parts, skin_, shield)
    deck(parts, skin_, hatch)
    ends.lamps(parts, skin_.points)
    (a, b), (c, d) = skin_.arches
    for first, last in ((0, a), (b, c), (d, len(skin_.grid) - 1)):
        pan = np.stack([turned_under(skin_, column) for column in range(first, last + 1)])
        parts.grid("underbody", pan, outward=(0, 0, -1))
