"""The outer skin below the glass: one B-spline surface round the car, and the height of the hood and deck.

x runs from nose to tail, y to the right, z up, in meters; the right half is modeled and mirrored. The
surface `wall(s, v)` has s round the plan outline (0 at the nose, S_END at the tail) and v from the sill (0)
over the side crease (4) and the shoulder (8) to the ledge (9), where hood, glass and deck begin.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from scenes.modeling.coupe.curves import Array, basis, ease, smooth

AXLES = (-1.365, 1.205)
WHEEL_HEIGHT = 0.325
ARCH_HEIGHT, ARCH_RADIUS = 0.335, 0.375
GAP = 0.014
"""The width of a shut line: 1.5 pixels across a door in the first view at 480 lines."""
TAIL_GAP = 0.018
"""It lies where the skin turns toward the tail, and is seen at a slant from the front."""
# Upright cuts between panels, at these x.
FASCIA_CUT, DOOR_FRONT, DOOR_REAR, TAIL_CUT = -1.86, -0.56, 0.63, 1.97
COWL = -0.61
# Lines along the car, at these v.
SILL, DOOR_FOOT, CREASE, SHOULDER, QUARTER_TOP, LEDGE, EDGE = 0.35, 1.0, 4.0, 7.0, 8.55, 9.0, 9.1

# fmt: off
# Plan outline: control points of the widest line, nose center to tail center.
OUTLINE = np.array([
    (-2.385, 0.000), (-2.384, 0.220), (-2.370, 0.470), (-2.335, 0.700), (-2.230, 0.845), (-2.020, 0.894),
    (-1.720, 0.909), (-1.365, 0.914), (-0.950, 0.910), (-0.500, 0.906), (0.000, 0.906), (0.500, 0.910),
    (0.900, 0.917), (1.250, 0.922), (1.620, 0.917), (1.950, 0.900), (2.200, 0.858), (2.325, 0.725),
    (2.365, 0.480), (2.384, 0.240), (2.385, 0.000),
])
# Sections: 13 rows of (inset from the outline, height), sill to ledge. Rows 8 and 9 may give a height over
# the shoulder line, as a number below 0.1; rows 10 to 12 lie on `top` and give none.
SECTIONS = {
    "nose": (
        (0.26, 0.200), (0.14, 0.165), (0.105, 0.215), (0.06, 0.31), (0.004, 0.425), (0.0, 0.458),
        (0.010, 0.492), (0.052, 0.535), (0.076, 0.612), (0.086, 0.645), (0.125, 0), (0.27, 0), (0.42, 0),
    ),
    "fender": (
        (0.16, 0.205), (0.095, 0.180), (0.062, 0.235), (0.036, 0.38), (0.008, 0.52), (0.0, 0.548),
        (0.006, 0.575), (0.024, 0.68), (0.042, -0.05), (0.055, -0.004), (0.10, 0), (0.20, 0), (0.32, 0),
    ),
    "door": (
        (0.16, 0.205), (0.095, 0.185), (0.060, 0.24), (0.038, 0.38), (0.008, 0.528), (0.0, 0.555),
        (0.006, 0.582), (0.022, 0.70), (0.036, -0.05), (0.047, -0.004), (0.078, 0), (0.12, 0), (0.18, 0),
    ),
    "quarter": (
        (0.16, 0.215), (0.10, 0.195), (0.066, 0.25), (0.038, 0.38), (0.008, 0.530), (0.0, 0.557),
        (0.006, 0.584), (0.020, 0.70), (0.034, -0.05), (0.047, -0.004), (0.09, 0), (0.14, 0), (0.20, 0),
    ),
    "tail": (
        (0.26, 0.265), (0.15, 0.235), (0.11, 0.28), (0.05, 0.36), (0.006, 0.505), (0.0, 0.540),
        (0.020, 0.562), (0.058, 0.62), (0.076, 0.82), (0.078, 0.925), (0.12, 0), (0.22, 0), (0.34, 0),
    ),
}
# The section of each outline column, and how far it has gone over to the next one.
COLUMNS = (
    ("nose", 0), ("nose", 0), ("nose", 0), ("nose", 0.25), ("nose", 0.5), ("nose", 0.75), ("fender", 0),
    ("fender", 0), ("fender", 0.5), ("door", 0), ("door", 0), ("door", 0), ("door", 0.5), ("quarter", 0),
    ("quarter", 0), ("quarter", 0.25), ("quarter", 0.5), ("quarter", 0.75), ("tail", 0), ("tail", 0),
    ("tail", 0),
)
shoulder_height = smooth([
    (-2.4, 0.625), (-2.1, 0.690), (-1.75, 0.752), (-1.365, 0.800), (-0.9, 0.836), (-0.4, 0.860),
    (0.2, 0.874), (0.8, 0.884), (1.4, 0.893), (1.8, 0.897), (2.05, 0.905), (2.25, 0.928), (2.4, 0.952),
])
center_height = smooth([
    (-2.4, 0.630), (-2.1, 0.710), (-1.75, 0.786), (-1.365, 0.851), (-0.9, 0.907), (-0.5, 0.940),
    (0.2, 0.960), (0.8, 0.950), (1.4, 0.938), (1.8, 0.932), (2.05, 0.934), (2.25, 0.953), (2.4, 0.975),
])
# fmt: on
S_END = float(len(OUTLINE) - 3)

# The v of the rows of the skin: close where it bends, for a highlight shows each false normal.
ROWS = np.array([
    SILL, 0.65, DOOR_FOOT, 1.22, 1.7, 2.8, 3.4, 3.7, CREASE, 4.3, 4.6, 5.1, 5.4, 6.7, SHOULDER,
    7.5, 7.77, 8.03, 8.3, QUARTER_TOP, 8.88, EDGE,
])  # fmt: skip


def top(x: ArrayLike, y: ArrayLike) -> Array:
    """Return the height of the hood, ledge and deck above (x, y)."""
    across = np.abs(np.asarray(y, dtype=float))
    crown = (across / 0.86) ** 2.1
    height: Array = center_height(x) + (shoulder_height(x) - center_height(x)) * crown
    return height


def control_net() -> Array:
    """Return the control points (columns, rows, 3) of the skin."""
    before = np.vstack([OUTLINE[1] * [1, -1], OUTLINE[:-1]])
    after = np.vstack([OUTLINE[1:], OUTLINE[-2] * [1, -1]])
    along = after - before
    outward = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    order = list(SECTIONS)
    net = np.zeros((len(OUTLINE), len(SECTIONS["nose"]), 3))
    for column, (name, share) in enumerate(COLUMNS):
        pair = np.array([SECTIONS[name], SECTIONS[order[min(order.index(name) + 1, len(order) - 1)]]])
        inset = pair[0, :, 0] * (1 - share) + pair[1, :, 0] * share
        net[column, :, :2] = OUTLINE[column] - outward[column] * inset[:, None]
        heights = pair[:, :, 1]
        shoulder = shoulder_height(net[column, 8:10, 0])
        heights[:, 8:10] += np.where(heights[:, 8:10] < 0.1, shoulder, 0.0)
        net[column, :, 2] = heights[0] * (1 - share) + heights[1] * share
        net[column, 10:, 2] = top(net[column, 10:, 0], net[column, 10:, 1])
    return net


NET = control_net()


def wall(s: ArrayLike, v: ArrayLike) -> Array:
    """Return points (..., 3) of the outer skin."""
    along, up = np.broadcast_arrays(np.asarray(s, dtype=float), np.asarray(v, dtype=float))
    columns, rows = basis(NET.shape[0], along), basis(NET.shape[1], up)
    points: Array = np.einsum("...i,...j,ijk->...k", columns, rows, NET)
    # Go over to the height of hood and deck above the shoulder.
    points[..., 2] += ease(up, 7.8, LEDGE) * (top(points[..., 0], points[..., 1]) - points[..., 2])
    # Swell out about the wheel openings.
    for axle in AXLES:
        distance = np.hypot(points[..., 0] - axle, points[..., 2] - ARCH_HEIGHT)
        swell = np.exp(-(((distance - ARCH_RADIUS) / 0.055) ** 2)) * (1 - ease(up, 6, 8.5))
        points[..., 1] += 0.013 * swell * ease(points[..., 1], 0.4, 0.8)
    return points


def skin(grid: Array) -> Array:
    """Return the points of a grid (..., 2) of parameters of the outer skin."""
    return wall(grid[..., 0], grid[..., 1])


def s_at(x: ArrayLike, v: ArrayLike) -> Array:
    """Return the s on the side of the car at which the skin has this x and v, by bisection."""
    target, up = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(v, dtype=float))
    low, high = np.full(target.shape, 3.2), np.full(target.shape, S_END - 3.2)
    for _ in range(45):
        middle = (low + high) / 2
        ahead = wall(middle, up)[..., 0] < target
        low, high = np.where(ahead, middle, low), np.where(ahead, high, middle)
    found: Array = (low + high) / 2
    return found


def columns_at(stations: Array, rows: Array) -> Array:
    """Return the parameters (stations, rows, 2) of the side with upright lines at these x."""
    x, v = np.meshgrid(stations, rows, indexing="ij")
    return np.stack([s_at(x, v), v], axis=-1)
