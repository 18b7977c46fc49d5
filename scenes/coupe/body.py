"""The outer skin below the glass: one B-spline surface round the car, the hood above it, and their panels.

x runs from nose to tail, y to the right, z up, in meters; the right half is modelled and mirrored. The surface
`wall(s, v)` has s round the plan outline (0 at the nose, S_END at the tail) and v from the sill (0) over the
side crease (4) and the shoulder (8) to the ledge (9) where hood, glass and deck begin.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from scenes.coupe.curves import Array, basis, ease, smooth

AXLES = (-1.365, 1.205)
WHEEL_HEIGHT = 0.325
ARCH_HEIGHT, ARCH_RADIUS = 0.335, 0.375
CREASE, LEDGE = 4.0, 9.0

# Plan outline: control points of the widest line, nose center to tail center.
OUTLINE = np.array([
    (-2.385, 0.0), (-2.384, 0.22), (-2.370, 0.47), (-2.335, 0.70), (-2.23, 0.845), (-2.02, 0.894), (-1.72, 0.909),
    (-1.365, 0.914), (-0.95, 0.910), (-0.5, 0.906), (0.0, 0.906), (0.5, 0.910), (0.9, 0.917), (1.25, 0.922),
    (1.62, 0.917), (1.95, 0.900), (2.20, 0.858), (2.325, 0.725), (2.365, 0.48), (2.384, 0.24), (2.385, 0.0),
])  # fmt: skip
S_END = float(len(OUTLINE) - 3)

# Sections: (inset from the outline, height) from the sill to the shoulder; then insets of the rows on the top.
NOSE = ((0.26, 0.20), (0.14, 0.165), (0.105, 0.215), (0.06, 0.31), (0.004, 0.425), (0.0, 0.458), (0.010, 0.492),
        (0.052, 0.535), (0.076, 0.612), (0.086, 0.645), (0.125, 0), (0.27, 0), (0.42, 0))  # fmt: skip
FENDER = ((0.16, 0.205), (0.095, 0.180), (0.062, 0.235), (0.036, 0.38), (0.008, 0.520), (0.0, 0.548), (0.006, 0.575),
          (0.024, 0.68), (0.042, -0.050), (0.055, -0.004), (0.10, 0), (0.20, 0), (0.32, 0))  # fmt: skip
DOOR = ((0.16, 0.205), (0.095, 0.185), (0.060, 0.24), (0.038, 0.38), (0.008, 0.528), (0.0, 0.555), (0.006, 0.582),
        (0.022, 0.70), (0.036, -0.050), (0.047, -0.004), (0.078, 0), (0.120, 0), (0.18, 0))  # fmt: skip
QUARTER = ((0.16, 0.215), (0.10, 0.195), (0.066, 0.25), (0.038, 0.38), (0.008, 0.530), (0.0, 0.557), (0.006, 0.584),
           (0.020, 0.70), (0.034, -0.050), (0.047, -0.004), (0.09, 0), (0.14, 0), (0.20, 0))  # fmt: skip
TAIL = ((0.26, 0.265), (0.15, 0.235), (0.11, 0.28), (0.05, 0.36), (0.006, 0.505), (0.0, 0.54), (0.020, 0.562),
        (0.058, 0.62), (0.070, 0.80), (0.074, 0.875), (0.12, 0), (0.22, 0), (0.34, 0))  # fmt: skip
# Which section each outline column has: weights of NOSE, FENDER, DOOR, QUARTER, TAIL.
COLUMNS = ("N", "N", "N", "NNNF", "NF", "NFFF", "F", "F", "FD", "D", "D", "D", "DQ", "Q", "Q", "QQQT", "QT", "QTTT", "T", "T", "T")
SECTIONS = {"N": NOSE, "F": FENDER, "D": DOOR, "Q": QUARTER, "T": TAIL}

shoulder_height = smooth([(-2.4, 0.625), (-2.1, 0.690), (-1.75, 0.752), (-1.365, 0.800), (-0.9, 0.836), (-0.4, 0.860),
                          (0.2, 0.874), (0.8, 0.884), (1.4, 0.893), (2.0, 0.897), (2.4, 0.890)])  # fmt: skip
center_height = smooth([(-2.4, 0.630), (-2.1, 0.710), (-1.75, 0.786), (-1.365, 0.851), (-0.9, 0.907), (-0.5, 0.940),
                        (0.2, 0.960), (0.8, 0.950), (1.4, 0.938), (2.0, 0.925), (2.4, 0.912)])  # fmt: skip


def top(x: ArrayLike, y: ArrayLike) -> Array:
    """Return the height of the hood, ledge and deck above (x, y)."""
    x, y = np.asarray(x, dtype=float), np.abs(np.asarray(y, dtype=float))
    crown = np.clip(y / 0.86, 0, None) ** 2.4
    height = center_height(x) + (shoulder_height(x) - center_height(x)) * crown
    bulge = 0.016 * ease(x, -2.15, -1.2) * (1 - ease(x, -0.7, -0.3)) * (1 - ease(y, 0.30, 0.40))
    return height + bulge


def _net() -> Array:
    """Return the control net (columns, rows, 3)."""
    before = np.vstack([OUTLINE[1] * [1, -1], OUTLINE[:-1]])
    after = np.vstack([OUTLINE[1:], OUTLINE[-2] * [1, -1]])
    along = after - before
    outward = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    net = np.zeros((len(OUTLINE), len(NOSE), 3))
    for column, kind in enumerate(COLUMNS):
        section = np.mean([np.array(SECTIONS[k]) for k in kind], axis=0)
        net[column, :, :2] = OUTLINE[column] - outward[column] * section[:, :1]
        net[column, :, 2] = section[:, 1]
        for row in (8, 9):
            heights = [SECTIONS[k][row][1] for k in kind]
            x = float(net[column, row, 0])
            net[column, row, 2] = np.mean([h if h > 0.3 else h + float(shoulder_height(x)) for h in heights])
        net[column, 10:, 2] = top(net[column, 10:, 0], net[column, 10:, 1])
    return net


NET = _net()


def wall(s: ArrayLike, v: ArrayLike) -> Array:
    """Return points (..., 3) of the outer skin."""
    s, v = np.broadcast_arrays(np.asarray(s, dtype=float), np.asarray(v, dtype=float))
    points: Array = np.einsum("...i,...j,ijk->...k", basis(NET.shape[0], s), basis(NET.shape[1], v), NET)
    lift = ease(v, 7.8, LEDGE)
    points[..., 2] += lift * (top(points[..., 0], points[..., 1]) - points[..., 2])
    for axle in AXLES:
        distance = np.hypot(points[..., 0] - axle, points[..., 2] - ARCH_HEIGHT)
        swell = np.exp(-(((distance - ARCH_RADIUS) / 0.10) ** 2)) * (1 - ease(v, 6, 8.5))
        points[..., 1] += 0.017 * swell * ease(points[..., 1], 0.4, 0.8)
    return points


def s_at(x: ArrayLike, v: ArrayLike) -> Array:
    """Return s on the side of the car where the skin has this x, at the given v, by bisection."""
    x, v = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(v, dtype=float))
    low, high = np.full(x.shape, 3.2), np.full(x.shape, S_END - 3.2)
    for _ in range(45):
        middle = (low + high) / 2
        ahead = wall(middle, v)[..., 0] < x
        low, high = np.where(ahead, middle, low), np.where(ahead, high, middle)
    return (low + high) / 2
