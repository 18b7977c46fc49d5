"""The cabin behind the windshield and the open side windows: lining, dashboard, seats and steering wheel.

The renderer has no transparent surfaces, as in the paper. So the clear part of the windshield is left out,
and only a tinted band at its top is modeled. The side windows are rolled down. The hatch glass is opaque.
Lining and dashboard belong to the surface of the glass and have the normals of the windshield: light that the
windshield would reflect appears on them.
"""

from __future__ import annotations

import numpy as np

from scenes.modeling.coupe.canopy import BAND, FLANK, SHIELD, crown
from scenes.modeling.coupe.curves import Array
from scenes.modeling.coupe.parts import Names, Parts

THICKNESS = 0.025
"""Of the lining below the roof and the hatch."""
FLOOR = 0.45
SEAT_Y = 0.37
TINTED = 2
"""Columns of the tinted band of the windshield, with its dark border."""


def glazed(places: Array) -> Array:
    """Return the unit normals (..., 3) of the windshield in front of places (..., 3) in the cabin."""
    t, w = 0.4 + 5.0 * np.clip(places[..., 2] - 0.9, 0.0, 0.32), np.clip(places[..., 1] / 0.75, -0.9, 0.9)
    along = crown(t + 0.05, w) - crown(t - 0.05, w)
    across = crown(t, w + 0.05) - crown(t, w - 0.05)
    normal: Array = np.cross(along, across)
    normal /= np.linalg.norm(normal, axis=-1)[..., None]
    return normal


def opened(names: Names) -> Names:
    """Return the parts of the canopy's cells, without the panes that are open."""
    left = names.copy()
    left[: SHIELD - TINTED][names[: SHIELD - TINTED] == "windshield"] = ""
    left[:, 2:FLANK][np.char.startswith(names[:, 2:FLANK], "window")] = ""
    return left


def lining(parts: Parts, points: Array, names: Names) -> Array:
    """Add the lining of the canopy and the edges of its openings; returns the points of the lining."""
    along, up = np.gradient(points, axis=0), np.gradient(points, axis=1)
    normal = np.cross(along, up)
    normal /= np.maximum(np.linalg.norm(normal, axis=-1), 1e-9)[..., None]
    normal *= np.sign((normal * [0.2, 1, 1]).sum(axis=-1))[..., None]
    inner = points - THICKNESS * normal
    inner[..., 1] = np.where(points[..., 1] < 1e-9, 0.0, inner[..., 1])
    is_open = names == ""
    lined = np.where(is_open, "", "lining")
    # Glass and sail begin and end in points.
    lined[[0, -1]] = ""
    # The rows of the rounded band would cross: its lining is flat.
    rows = np.delete(np.arange(points.shape[1]), slice(FLANK + 1, FLANK + len(BAND) - 1))
    parts.grid(lined[:, rows[:-1]], inner[:, rows], outward=(0, -0.3, -1))
    for axis in (0, 1):
        ahead = np.diff(is_open.astype(int), axis=axis)
        for i, j in np.argwhere(ahead != 0):
            first, second = ((i + 1, j), (i + 1, j + 1)) if axis == 0 else ((i, j + 1), (i + 1, j + 1))
            quad = np.array([[points[first], points[second]], [inner[first], inner[second]]])
            toward = (along if axis == 0 else up)[first] * ahead[i, j]
            parts.grid("reveals", quad, outward=tuple(toward))
    return inner


def padded(parts: Parts, part: str, stations: Array, *, mirror: bool = True) -> None:
    """Add a cushion along stations (n, 5): x, y, z of the middle, half its width and half its thickness."""
    angle = np.linspace(0, 2 * np.pi, 15)[:-1]
    wide, deep = (np.sign(w) * np.abs(w) ** 0.6 for w in (np.cos(angle), np.sin(angle)))
    middle = stations[:, None, :3]
    along = np.gradient(stations[:, :3], axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    across = np.array([0.0, 1.0, 0.0])
    through = np.cross(along, across)
    sections = (
        middle
        + across * (stations[:, 3, None] * wide)[..., None]
        - through[:, None] * (stations[:, 4, None] * deep)[..., None]
    )
    parts.closed(part, sections, mirror=mirror)


def seats(parts: Parts) -> None:
    """Add the backs of two front seats with head rests, and of the bench behind them."""
    y = SEAT_Y
    padded(parts, "seats", np.array([
        (0.16, y, 0.50, 0.20, 0.04), (0.17, y, 0.53, 0.24, 0.065), (0.20, y, 0.64, 0.25, 0.07),
        (0.24, y, 0.76, 0.25, 0.065), (0.28, y, 0.88, 0.24, 0.06), (0.31, y, 0.96, 0.21, 0.055),
        (0.325, y, 1.00, 0.17, 0.045), (0.33, y, 1.015, 0.11, 0.025),
    ]))  # fmt: skip
    padded(parts, "seats", np.array([
        (0.325, y, 1.035, 0.09, 0.025), (0.33, y, 1.05, 0.115, 0.04), (0.345, y, 1.095, 0.12, 0.045),
        (0.355, y, 1.13, 0.11, 0.04), (0.36, y, 1.145, 0.08, 0.02),
    ]))  # fmt: skip
    padded(parts, "seats", np.array([
        (0.86, 0.33, 0.55, 0.30, 0.06), (0.90, 0.33, 0.70, 0.31, 0.07), (0.95, 0.33, 0.86, 0.30, 0.06),
        (0.97, 0.33, 0.91, 0.27, 0.03),
    ]))  # fmt: skip


def wheel(parts: Parts) -> None:
    """Add the steering wheel on the left, its hub and two spokes."""
    center, tilt, radius = np.array([-0.04, -SEAT_Y, 0.885]), np.radians(62), 0.185
    side, up = np.array([0.0, 1.0, 0.0]), np.array([np.cos(tilt), 0.0, np.sin(tilt)])
    axis = np.cross(side, up)
    turn = np.linspace(0, 2 * np.pi, 29)[:, None, None]
    round_ = np.linspace(0, 2 * np.pi, 7)[None, :, None]
    out = np.cos(turn) * side + np.sin(turn) * up
    parts.grid(
        "steering_wheel",
        center + radius * out + 0.014 * (np.cos(round_) * out + np.sin(round_) * axis),
        mirror=False,
        flip=True,
    )
    for angle in (-0.25, np.pi + 0.25):
        arm = np.cos(angle) * side + np.sin(angle) * up
        thick = np.cross(axis, arm) * 0.022
        ends = np.array([0.02 * arm, radius * arm])
        sides = ((1, 1), (1, -1), (-1, -1), (-1, 1))
        bar = np.stack([ends + a * thick + b * 0.006 * axis for a, b in sides], axis=1)
        parts.closed("steering_wheel", center - 0.02 * axis * [[[1]], [[0]]] + bar, mirror=False)
    hub = np.array([(1.0, 0.02), (1.0, -0.015), (0.7, -0.03), (0.0, -0.032)])
    parts.grid(
        "steering_wheel",
        center + 0.055 * out[::2] * hub[None, :, :1] + axis * hub[None, :, 1:],
        mirror=False,
        flip=False,
    )


def build(parts: Parts, points: Array, names: Names) -> None:
    """Add the cabin below the canopy, whose points and open cells are given."""
    inner = lining(parts, points, names)
    parts.normals |= dict.fromkeys(("lining", "dashboard"), glazed)
    # The dashboard begins at the foot of the windshield.
    foot = inner[1, FLANK + 3 :]
    share = foot[:, 1] / foot[0, 1]
    rows = [foot]
    for x, wide, z in (
        (-0.30, 0.73, 0.925), (-0.12, 0.72, 0.915), (-0.085, 0.72, 0.90), (-0.08, 0.72, 0.87),
        (-0.12, 0.71, 0.78), (-0.11, 0.70, 0.64), (-0.25, 0.68, FLOOR),
    ):  # fmt: skip
        rows.append(np.stack([0 * share + x, wide * share, z + 0 * share], axis=1))
    parts.grid("dashboard", np.stack(rows), outward=(1, 0, 1))
    # The shelf behind the bench, up to the foot of the hatch.
    end = inner[-2, FLANK + 3 :]
    shelf = [
        np.stack([0 * share + x, 0.72 * share, z + 0 * share], axis=1)
        for x, z in ((1.02, FLOOR), (0.98, 0.86), (1.5, 0.86))
    ]
    parts.grid("shelf", np.stack([*shelf, end]), outward=(-0.5, 0, 1))
    # Doors and sides, then the floor.
    edge = inner[:, 0]
    low = np.stack([edge[:, 0], 0.93 * edge[:, 1], 0 * edge[:, 0] + FLOOR], axis=1)
    tub = [edge, edge * [1, 0.96, 1] - [0, 0, 0.06], low, low * [1, 0, 1]]
    parts.grid("door_trim", np.stack(tub, axis=1), outward=(0, -1, 1))
    # The hood of the instruments.
    y = np.linspace(-0.24, 0.24, 13)
    arc = 0.05 * (1 - (y / 0.24) ** 4)
    hood = [
        np.stack([0 * y + x, y - SEAT_Y, z + high * arc], axis=1)
        for x, z, high in (
            (-0.36, 0.92, 0), (-0.28, 0.92, 0.8), (-0.13, 0.915, 1), (-0.11, 0.90, 0.9), (-0.16, 0.88, 0)
        )
    ]  # fmt: skip
    parts.grid("dashboard", np.stack(hood), outward=(0, 0, 1), mirror=False)
    seats(parts)
    wheel(parts)
