"""Nose and tail: the columns of the fascias, their recesses, and the lamps, bars and license plate in them.

The recesses are a part of the closed skin. The lenses on their boxes and the bars are closed solids.
"""

from __future__ import annotations

import numpy as np

from scenes.modeling.coupe.body import FASCIA_CUT, GAP, ROWS, S_END, TAIL_CUT, TAIL_GAP, s_at
from scenes.modeling.coupe.curves import Array, spaced
from scenes.modeling.coupe.parts import Names, Parts

Hole = tuple[int, int, int, int]
REARWARD = np.array([1.0, 0.0, 0.0])

CORNER = 13
"""The column, from the center line, at the front corner of the hood and at the rear corner of the deck."""
# Holes (first column, last column, first row, last row) of nose and tail, columns from the center line.
HEAD_LAMPS, SLOT, INTAKE, TURN_LAMPS = (4, 10, 11, 14), (0, 3, 12, 13), (0, 4, 4, 5), (7, 10, 4, 5)
TAIL_LAMPS, PLATE = (4, 10, 11, 13), (0, 3, 11, 13)


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
        ((HEAD_LAMPS, SLOT, INTAKE, TURN_LAMPS), names),
        ((TAIL_LAMPS, PLATE), names[::-1]),
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
    rim = border(lens)
    middle = rim.mean(axis=0)
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


def nose(parts: Parts, points: Array) -> None:
    """Add quad head lamps, turn lamps, grille and intake to the columns of the nose."""
    face = cells(points, HEAD_LAMPS)
    recess(parts, face, face + 0.12 * REARWARD)
    for i0, i1 in ((0, 3), (3, 6)):
        ahead = float(face[i0 : i1 + 1, :, 0].max()) + 0.008
        corner = np.array([ahead, face[i0, 0, 1] + 0.012, face[i0, 0, 2] + 0.014])
        opposite = np.array([ahead, face[i1, 0, 1] - 0.012, face[i0, -1, 2] - 0.012])
        boxed(parts, pane(corner, opposite, 4, 3, -0.016, 0.045), "head_lamps", 0.06)
    for hole in (SLOT, INTAKE):
        face = cells(points, hole)
        recess(parts, face, face + 0.07 * REARWARD)
        for share in (1 / 6, 3 / 6, 5 / 6):
            edge = face[:, 0] * (1 - share) + face[:, -1] * share + 0.012 * REARWARD
            low, high = edge + np.array([[[0.022, 0, -0.006]], [[0.022, 0, 0.012]]])
            bar = np.stack([edge, high, low], axis=1)
            bar[-1, :, 1] -= 0.003
            # Bars cross the center line: one bar for both sides.
            bar = np.concatenate([bar[:0:-1] * [1, -1, 1], bar])
            parts.closed("grille", bar, mirror=False)
    face = cells(points, TURN_LAMPS)
    lean = np.linspace(0.0, 0.030, face.shape[1])[:, None] * REARWARD
    recess(parts, face, face + 0.010 * REARWARD + lean, "turn_lamps")


def tail(parts: Parts, points: Array) -> None:
    """Add tail lamps and license plate to the columns of the tail, center line first."""
    face = cells(points, TAIL_LAMPS)
    recess(parts, face, face - 0.060 * REARWARD)
    for i in range(0, 6, 2):
        for j in (0, 1):
            low, high = (
                face[i : i + 3, 0] * (1 - at) + face[i : i + 3, -1] * at for at in (j / 2, (j + 1) / 2)
            )
            cell = np.stack([low, high], axis=1) - 0.012 * REARWARD
            middle = cell.reshape(-1, 3).mean(axis=0)
            inner = middle + (cell - middle) * [1, 0.93, 0.86]
            inner[:, 0, 0] -= 0.020
            boxed(parts, inner, "tail_lamps", 0.030)
    face = cells(points, PLATE)
    recess(parts, face, face - 0.035 * REARWARD)
    sheet = pane(np.array([2.335, -0.155, 0.630]), np.array([2.335, 0.155, 0.765]), 2, 1, 0.0, -0.035)
    boxed(parts, sheet, "license_plate", 0.012, mirror=False)


def lamps(parts: Parts, points: Array) -> None:
    """Add all that is recessed into nose and tail, to columns from nose to tail."""
    nose(parts, points)
    tail(parts, points[::-1])
