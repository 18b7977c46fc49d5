"""Nose and tail: the fascias with recessed lamps, grille, air intake and license plate."""

from __future__ import annotations

import numpy as np

from scenes.modeling.coupe.body import CREASE, S_END, s_at, skin
from scenes.modeling.coupe.curves import Array, spaced
from scenes.modeling.coupe.panels import FASCIA_CUT, GAP, SHOULDER, SILL, TAIL_CUT, UPPER_ROWS
from scenes.modeling.coupe.parts import Parts

Hole = tuple[int, int, int, int]


def fascia(lines: Array, rows: Array, cut: float, fixed: int) -> Array:
    """Return the points of a nose or tail panel: `fixed` + 1 lines of constant s, then leaning to the cut."""
    end = s_at(np.full(len(rows), cut), rows)[None]
    share = np.clip((lines - lines[fixed]) / (lines[-1] - lines[fixed]), 0.0, 1.0)[:, None]
    s = np.where(share > 0, lines[fixed] + share * (end - lines[fixed]), lines[:, None])
    return skin(np.stack([s, np.broadcast_to(rows, s.shape)], axis=-1))


def border(grid: Array) -> Array:
    """Return the closed loop of points round a grid."""
    return np.concatenate([grid[:, 0], grid[-1, 1:], grid[-2::-1, -1], grid[0, -2::-1]])


def recess(parts: Parts, face: Array, depth: float, name: str) -> Array:
    """Add the walls of a recess behind a hole in the skin; returns the grid of its bottom."""
    inward = -float(np.sign(face[0, 0, 0]))
    back: Array = face + np.array([inward * depth, 0, 0])
    walls = np.stack([border(face), border(back)], axis=1)
    if abs(face[0, 0, 1]) < 1e-9:
        # The mirror image goes on at the center line: no wall there.
        walls = walls[: len(walls) - face.shape[1] + 1]
    normal = np.cross(face[1, 0] - face[0, 0], face[0, 1] - face[0, 0])
    parts.grid(name, walls, flip=bool(normal[0] * inward > 0))
    return back


def pane(corner: Array, opposite: Array, across: int, up: int, swell: float, lean: float) -> Array:
    """Return a lens square to x between two corners, swollen in its middle, its top set back by `lean`."""
    y, z = np.linspace(corner[1], opposite[1], across + 1), np.linspace(corner[2], opposite[2], up + 1)
    a, b = np.meshgrid(np.linspace(-1, 1, across + 1), np.linspace(-1, 1, up + 1), indexing="ij")
    x = corner[0] + swell * (1 - a**2) * (1 - b**2) + lean * (b + 1) / 2
    return np.stack([x, *np.meshgrid(y, z, indexing="ij")], axis=-1)


def boxed(parts: Parts, lens: Array, name: str, depth: float) -> None:
    """Add a lens and the dark box behind its rim."""
    outward = float(np.sign(lens[0, 0, 0]))
    parts.grid(name, lens, outward=(outward, 0, 0))
    rim = border(lens)
    middle = rim.mean(axis=0)
    frame = middle + (rim - middle) * [1, 1.05, 1.10] - [outward * 0.004, 0, 0]
    parts.grid("lamp_frames", np.stack([rim, frame], axis=1), outward=(outward, 0, 0))
    parts.grid("lamp_frames", np.stack([frame, frame - [outward * depth, 0, 0]], axis=1))


def cells(grid: Array, hole: Hole) -> Array:
    """Return the points of a hole of the grid, rim included."""
    return grid[hole[0] : hole[1] + 1, hole[2] : hole[3] + 1]


def nose(parts: Parts) -> None:
    """Add the front fascia with quad head lamps, turn lamps, grille and intake."""
    s = spaced(0.0, 0.62, 0.80, 1.56, 2.30, 3.0, 4.3, counts=(3, 1, 3, 3, 3, 3))
    v = spaced(SILL, 1.7, 2.8, CREASE, 5.1, 5.4, 6.7, SHOULDER, counts=(2, 2, 2, 2, 1, 2, 1))
    points = fascia(s, np.concatenate([v, UPPER_ROWS[1:]]), FASCIA_CUT - GAP / 2, 13)
    lamps, slot, intake, turn = (4, 10, 8, 12), (0, 3, 9, 11), (0, 4, 2, 4), (7, 10, 2, 4)
    parts.grid("front_fascia", points, holes=(lamps, slot, intake, turn))

    face = cells(points, lamps)
    parts.grid("lamp_frames", recess(parts, face, 0.12, "lamp_frames")[:, ::2], outward=(-1, 0, 0))
    for i0, i1 in ((0, 3), (3, 6)):
        ahead = float(face[i0 : i1 + 1, :, 0].max()) + 0.008
        corner = np.array([ahead, face[i0, 0, 1] + 0.012, face[i0, 0, 2] + 0.014])
        opposite = np.array([ahead, face[i1, 0, 1] - 0.012, face[i0, -1, 2] - 0.012])
        boxed(parts, pane(corner, opposite, 4, 3, -0.010, 0.018), "head_lamps", 0.06)
    for hole, bars in ((slot, 3), (intake, 3)):
        face = cells(points, hole)
        parts.grid("lamp_frames", recess(parts, face, 0.07, "lamp_frames")[:, ::2], outward=(-1, 0, 0))
        for k in range(bars):
            share = (k + 0.5) / bars
            edge = face[:, 0] * (1 - share) + face[:, -1] * share + [0.012, 0, 0]
            for z in (0.012, -0.006):
                bar = np.stack([edge, edge + np.array([0.022, 0, z])], axis=1)
                parts.grid("grille", bar, outward=(-1, 0, float(np.sign(z))))
    lens = recess(parts, cells(points, turn), 0.010, "lamp_frames")
    lens[..., 0] += np.linspace(0.030, 0.0, lens.shape[1])
    parts.grid("turn_lamps", lens, outward=(-1, 0, 0))


def tail(parts: Parts) -> None:
    """Add the rear fascia, tail lamps and license plate recess."""
    s = spaced(S_END, S_END - 0.45, S_END - 0.58, 15.62, 15.0, 13.9, counts=(3, 1, 6, 3, 2))
    v = spaced(SILL, 1.5, 3.0, CREASE, 5.0, 5.5, 6.75, SHOULDER, counts=(2, 1, 2, 2, 1, 2, 1))
    points = fascia(s, np.concatenate([v, UPPER_ROWS[1:-1]]), TAIL_CUT + GAP / 2, 13)
    lamps, plate = (4, 10, 8, 10), (0, 3, 8, 10)
    parts.grid("rear_fascia", points, holes=(lamps, plate))
    back = recess(parts, cells(points, lamps), 0.040, "lamp_frames")
    parts.grid("lamp_frames", back, outward=(1, 0, 0))
    for i in range(0, 6, 2):
        for j in range(2):
            cell = back[i : i + 3, j : j + 2]
            middle = cell.reshape(-1, 3).mean(axis=0)
            inner = middle + (cell - middle) * [1, 0.93, 0.86] + [0.030, 0, 0]
            inner[:, 0, 0] -= 0.020
            parts.grid("tail_lamps", inner, outward=(1, 0, 0))
            parts.grid("lamp_frames", np.stack([border(inner), border(inner) - [0.030, 0, 0]], axis=1))
    parts.grid("lamp_frames", recess(parts, cells(points, plate), 0.035, "lamp_frames"), outward=(1, 0, 0))
    sheet = pane(np.array([2.325, 0.0, 0.625]), np.array([2.325, 0.150, 0.765]), 1, 1, 0.0, -0.035)
    parts.grid("license_plate", sheet, outward=(1, 0, 0))


def build(parts: Parts) -> None:
    """Add both ends."""
    nose(parts)
    tail(parts)
