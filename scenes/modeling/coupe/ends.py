"""Nose and tail: the columns of the fascias, their recesses, and the lamps, bars and license plate in them.

The recesses are a part of the closed skin. The lenses on their boxes and the bars are closed solids.
"""

from __future__ import annotations

import re

import numpy as np

from scenes.modeling.coupe.body import FASCIA_CUT, GAP, ROWS, S_END, TAIL_CUT, TAIL_GAP, s_at
from scenes.modeling.coupe.curves import Array, coons, segment, spaced
from scenes.modeling.coupe.parts import Names, Parts

Hole = tuple[int, int, int, int]
REARWARD = np.array([1.0, 0.0, 0.0])
LEAN = 0.045
"""How far the top of a head lamp is behind its foot."""

CORNER = 13
"""The column, from the center line, at the front corner of the hood and at the rear corner of the deck."""
# Holes (first column, last column, first row, last row) of nose and tail, columns from the center line.
NOSE_BAND, INTAKE, TURN_LAMPS = (0, 10, 11, 14), (0, 4, 4, 5), (7, 10, 4, 5)
TAIL_BAND = (0, 10, 11, 13)
LAMP = 4
"""The column at which the lamps of both bands begin."""
FLUTES = 8
"""The upright ribs of a head lamp."""
TEXT = {
    "G": "0111010001100001011110001100010111",
    "M": "10001110111010110101100011000110001",
    "R": "11110100011000111110101001001010001",
    "8": "01110100011000101110100011000101110",
    "3": "11110000010000101110000010000111110",
}
"""The letters of the plates, from the top left, in seven rows of five."""


def fascia(lines: Array, cut: float) -> Array:
    """Return the parameters of a nose or tail: CORNER + 1 columns of constant s, then leaning to the cut."""
    end = s_at(np.full(len(ROWS), cut), ROWS)[None]
    share = np.clip((lines - lines[CORNER]) / (lines[-1] - lines[CORNER]), 0.0, 1.0)[:, None]
    s = np.where(share > 0, lines[CORNER] + share * (end - lines[CORNER]), lines[:, None])
    return np.stack([s, np.broadcast_to(ROWS, s.shape)], axis=-1)


def nose_columns() -> Array:
    """Return the parameters (columns, rows, 2) of the nose, from the center line."""
    s = spaced(0.0, 0.62, 0.80, 1.56, 2.30, 2.75, 4.3, counts=(3, 1, 3, 3, 3, 3))
    return fascia(s, FASCIA_CUT - GAP / 2)


def tail_columns() -> Array:
    """Return the parameters (columns, rows, 2) of the tail, from the center line."""
    s = spaced(S_END, S_END - 0.45, S_END - 0.58, 15.62, 15.25, 13.9, counts=(3, 1, 6, 3, 2))
    return fascia(s, TAIL_CUT + TAIL_GAP / 2)


def cut_holes(names: Names) -> None:
    """Leave the cells of the recesses out of the fascias."""
    for holes, of_end in (
        ((NOSE_BAND, INTAKE, TURN_LAMPS), names),
        ((TAIL_BAND,), names[::-1]),
    ):
        for i0, i1, j0, j1 in holes:
            of_end[i0:i1, j0:j1] = ""


def border(grid: Array) -> Array:
    """Return the closed loop of points round a grid."""
    return np.concatenate([grid[:, 0], grid[-1, 1:], grid[-2::-1, -1], grid[0, -2::-1]])


def recess(parts: Parts, face: Array, back: Array, bottom: str = "recesses") -> None:
    """Add the walls of a recess behind a hole in the skin, and its bottom."""
    inward = -float(np.sign(face[0, 0, 0]))
    walls = np.stack([border(face), border(back)], axis=1)
    if abs(face[0, 0, 1]) < 1e-9:
        # The mirror image goes on at the center line: no wall there.
        walls = walls[: len(walls) - face.shape[1] + 1]
    normal = np.cross(face[1, 0] - face[0, 0], face[0, 1] - face[0, 0])
    parts.grid("recesses", walls, flip=bool(normal[0] * inward > 0))
    parts.grid(bottom, back, outward=(-inward, 0, 0))


def pane(corner: Array, opposite: Array, across: int, up: int, swell: float, lean: float) -> Array:
    """Return a lens square to x between two corners, swollen in its middle, its top set back by `lean`."""
    y, z = np.linspace(corner[1], opposite[1], across + 1), np.linspace(corner[2], opposite[2], up + 1)
    a, b = np.meshgrid(np.linspace(-1, 1, across + 1), np.linspace(-1, 1, up + 1), indexing="ij")
    x = corner[0] + swell * (1 - a**2) * (1 - b**2) + lean * (b + 1) / 2
    return np.stack([x, *np.meshgrid(y, z, indexing="ij")], axis=-1)


def boxed(parts: Parts, lens: Array, name: str, depth: float, *, mirror: bool = True) -> None:
    """Add a lens and the dark box behind its rim."""
    outward = float(np.sign(lens[0, 0, 0]))
    parts.grid(name, lens, outward=(outward, 0, 0), mirror=mirror)
    rim = border(lens[[0, -1]][:, [0, -1]])
    middle = rim[:-1].mean(axis=0)
    frame = middle + (rim - middle) * [1, 1.05, 1.10] - [outward * 0.004, 0, 0]
    back = frame - [outward * depth, 0, 0]
    parts.grid("lamp_frames", np.stack([rim, frame], axis=1), outward=(outward, 0, 0), mirror=mirror)
    turn = float((np.cross(frame[:-1] - middle, frame[1:] - middle)[:, 0] * outward).sum())
    parts.grid("lamp_frames", np.stack([frame, back], axis=1), flip=turn > 0, mirror=mirror)
    behind = np.stack([back, np.broadcast_to(back[:-1].mean(axis=0), back.shape)], axis=1)
    parts.grid("lamp_frames", behind, outward=(-outward, 0, 0), mirror=mirror)


def cells(grid: Array, hole: Hole) -> Array:
    """Return the points of a hole of the grid, rim included."""
    return grid[hole[0] : hole[1] + 1, hole[2] : hole[3] + 1]


def head_lamp(parts: Parts, corner: Array, opposite: Array) -> None:
    """Add a rectangular lamp: a bright rim, and a fluted lens that sinks to a bulb in its middle."""
    across, up = 3 * FLUTES, 6
    face = pane(corner, opposite, across, up, 0.0, LEAN)
    middle = face.reshape(-1, 3).mean(axis=0)
    rim = border(face[::across, ::up])
    outer, inner = (
        middle + (rim - middle) * [1, 1 - share / 2, 1 - share] + [ahead, 0, 0]
        for share, ahead in ((-0.05, -0.006), (0.06, 0.002))
    )
    for part, first, second in (
        ("lamp_frames", outer + 0.06 * REARWARD, outer),
        ("lamp_rims", outer, rim - 0.004 * REARWARD),
        ("lamp_rims", rim - 0.004 * REARWARD, inner),
    ):
        parts.grid(part, np.stack([second, first], axis=1), flip=False)
    parts.grid(
        "lamp_frames",
        np.stack([outer + 0.06 * REARWARD, np.broadcast_to(middle + 0.06 * REARWARD, rim.shape)], axis=1),
        outward=(1, 0, 0),
    )
    a, b = np.meshgrid(np.linspace(-1, 1, across + 1), np.linspace(-1, 1, up + 1), indexing="ij")
    deep = (1 - a**2) * (1 - b**2) * (0.036 - 0.0015 * np.cos(2 * np.pi * FLUTES * a))
    bulb = np.exp(-((2.6 * a) ** 4) - (1.5 * b) ** 4)
    lens = middle + (face - middle) * [1, 0.97, 0.94] + 0.002 * REARWARD
    lens[..., 0] += deep * (1 - 0.75 * bulb)
    parts.grid("head_lamps", lens, outward=(-1, 0, 0))


def bars(parts: Parts, face: Array, shares: tuple[float, ...]) -> None:
    """Add level bars across a hole at the center line."""
    for share in shares:
        edge = face[:, 0] * (1 - share) + face[:, -1] * share + 0.012 * REARWARD
        low, high = edge + np.array([[[0.022, 0, -0.006]], [[0.022, 0, 0.012]]])
        bar = np.stack([edge, high, low], axis=1)
        bar[-1, :, 1] -= 0.003
        # Bars cross the center line: one bar for both sides.
        bar = np.concatenate([bar[:0:-1] * [1, -1, 1], bar])
        parts.closed("grille", bar, mirror=False)


def plate(parts: Parts, center: Array, lean: float) -> None:
    """Add a license plate with raised letters. `lean` is how far its top is behind its foot."""
    sign, half = float(np.sign(center[0])), np.array([0.0, 0.152, 0.076])
    sheet = pane(center - half, center + half, 2, 1, 0.0, -sign * abs(lean))
    boxed(parts, sheet, "license_plate", 0.012, mirror=False)
    # Letters are seen from the side that the plate faces: left and right change there.
    dot, right = 0.0076, np.array([0.0, 1.0, 0.0]) * sign
    up = np.array([-sign * abs(lean), 0.0, 2 * half[2]]) / (2 * half[2])
    start = sheet.reshape(-1, 3).mean(axis=0) + sign * 0.002 * REARWARD
    for number, letter in enumerate("GMR 83"):
        for row in range(7):
            line = TEXT.get(letter, "").ljust(35, "0")[5 * row : 5 * row + 5]
            at = 0
            for run in re.findall("0+|1+", line):
                if run[0] == "1":
                    left, low = (number - 3) * 6 + at + 0.5, 2.5 - row
                    corners = [
                        start + dot * ((left + len(run) * a) * right + (low + b) * 1.25 * up)
                        for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))
                    ]
                    quad = np.array(corners).reshape(2, 2, 3)[:, [0, 1]]
                    quad[1] = quad[1, ::-1]
                    parts.grid("letters", quad, outward=(sign, 0, 0), mirror=False)
                at += len(run)


def nose(parts: Parts, points: Array) -> None:
    """Add head lamps, turn lamps, grille, intake and plate to the columns of the nose."""
    face = cells(points, NOSE_BAND)
    recess(parts, face, face + 0.12 * REARWARD)
    bars(parts, face[:LAMP], (0.2, 0.4, 0.6, 0.8))
    for i0, i1 in ((LAMP, LAMP + 3), (LAMP + 3, NOSE_BAND[1])):
        ahead = float(face[i0 : i1 + 1, :, 0].max()) + 0.004
        corner = np.array([ahead, face[i0, 0, 1] + 0.010, face[i0, 0, 2] + 0.012])
        opposite = np.array([ahead, face[i1, 0, 1] - 0.010, face[i0, -1, 2] - 0.010])
        head_lamp(parts, corner, opposite)
    face = cells(points, INTAKE)
    recess(parts, face, face + 0.07 * REARWARD)
    bars(parts, face, (1 / 6, 3 / 6, 5 / 6))
    plate(parts, np.array([-2.395, 0.0, 0.355]), 0.0)
    face = cells(points, TURN_LAMPS)
    lean = np.linspace(0.0, 0.030, face.shape[1])[:, None] * REARWARD
    recess(parts, face, face + 0.010 * REARWARD + lean, "turn_lamps")


def tail(parts: Parts, points: Array) -> None:
    """Add tail lamps and license plate to the columns of the tail, center line first."""
    face = cells(points, TAIL_BAND)
    recess(parts, face, face - 0.060 * REARWARD)
    for i in range(LAMP, TAIL_BAND[1], 2):
        for j in (0, 1):
            low, high = (
                face[[i, i + 2], 0] * (1 - at) + face[[i, i + 2], -1] * at for at in (j / 2, (j + 1) / 2)
            )
            corners = np.stack([low, high], axis=1)
            middle = corners.mean(axis=(0, 1))
            (a, b), (c, d) = middle + (corners - middle) * [1, 0.95, 0.88] - 0.030 * REARWARD
            lens = coons(segment(a, c, 4), segment(b, d, 4), segment(a, b, 4), segment(c, d, 4))
            u, v = np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5), indexing="ij")
            boxed(parts, lens + 0.016 * ((1 - u**2) * (1 - v**2))[..., None] * REARWARD, "tail_lamps", 0.025)
    plate(parts, np.array([2.352, 0.0, 0.700]), 0.035)


def lamps(parts: Parts, points: Array) -> None:
    """Add all that is recessed into nose and tail, to columns from nose to tail."""
    nose(parts, points)
    tail(parts, points[::-1])
