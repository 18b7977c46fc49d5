"""The canopy: windshield, roof, hatch glass, side glass and pillars.

Two surfaces carry it. `crown(t, w)` runs from the cowl (t = 0) over the roof to the end of the hatch (T_END),
and from the center (w = 0) to the rail (w = 1). `flank(x, z)` is the side above the ledge, leaning inward.
A band of quadratic Bezier arcs rounds the edge between them: pillar, roof rail, bent rim of the hatch glass.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from scenes.modeling.coupe.body import DOOR_REAR, EDGE, GAP, QUARTER_TOP, ROWS, columns_at, s_at, skin, wall
from scenes.modeling.coupe.curves import Array, bezier, bspline, ease
from scenes.modeling.coupe.parts import Names

# fmt: off
# Side views (x, z) of the center line and of the rail; the same count of control points.
CENTER = np.array([
    (-0.68, 0.940), (-0.48, 1.048), (-0.23, 1.168), (-0.01, 1.260), (0.11, 1.275), (0.28, 1.278),
    (0.50, 1.270), (0.72, 1.243), (1.08, 1.172), (1.42, 1.092), (1.74, 1.012), (1.98, 0.950),
])
RAIL = np.array([
    (-0.53, 0.885), (-0.37, 0.980), (-0.17, 1.094), (0.03, 1.200), (0.13, 1.213), (0.36, 1.217),
    (0.55, 1.206), (0.76, 1.170), (1.10, 1.098), (1.43, 1.020), (1.72, 0.963), (1.92, 0.929),
])
# fmt: on
T_END = float(len(CENTER) - 3)
HEADER, REAR_HEADER = 2.25, 5.45
BORDER, RIM, DROP, GLASS_FOOT = 0.88, 0.935, 0.036, 0.016
HATCH_SIDE, HATCH_END = 0.88, 1.90
# Lines across the crown, from the center to the rim; the outermost cell is the dark border of the glass.
ACROSS = np.append(np.linspace(0.0, BORDER, 9), RIM)
BAND = (0.0, 0.14, 0.5, 0.86, 1.0)
"""Of the arcs of the band. The narrow cells keep normals right at its ends, where another part begins."""
FLANK_ROWS = (0.0, 0.10, 0.17, 0.58, 1.0)
FLANK = len(FLANK_ROWS)


def ledge(x: ArrayLike) -> Array:
    """Return points of the edge of the skin at these x."""
    return wall(s_at(x, EDGE), EDGE)


def flank(x: ArrayLike, z: ArrayLike) -> Array:
    """Return points of the side of the canopy at (x, z)."""
    along, up = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(z, dtype=float))
    foot = ledge(along)
    rise = up - foot[..., 2]
    return np.stack([along, foot[..., 1] - 0.40 * rise - 0.62 * rise * np.abs(rise), up], axis=-1)


def rail(t: ArrayLike) -> Array:
    """Return points of the edge between crown and flank."""
    side_view = bspline(RAIL, t)
    return flank(side_view[..., 0], side_view[..., 1])


def crown(t: ArrayLike, w: ArrayLike) -> Array:
    """Return points of the windshield, roof and hatch surface."""
    along, across = np.broadcast_arrays(np.asarray(t, dtype=float), np.asarray(w, dtype=float))
    center, edge = bspline(CENTER, along), rail(along)
    x = center[..., 0] + (edge[..., 0] - center[..., 0]) * across**2
    z = center[..., 1] + (edge[..., 2] - center[..., 1]) * np.abs(across) ** 2.3
    return np.stack([x, edge[..., 1] * across, z], axis=-1)


def lower_edge(t: ArrayLike) -> Array:
    """Return the lower edge of the band: on the flank, DROP below the rail and square to it in side view."""
    at = np.asarray(t, dtype=float)
    here, ahead = bspline(RAIL, np.clip(at - 0.01, 0, T_END)), bspline(RAIL, np.clip(at + 0.01, 0, T_END))
    along = (ahead - here) / np.linalg.norm(ahead - here, axis=-1)[..., None]
    middle = (here + ahead) / 2
    drop = DROP * np.clip(0.35 + at / 1.5, 0, 1) * np.clip((T_END - at) / 1.5 + 0.25, 0, 1)
    return flank(middle[..., 0] + along[..., 1] * drop, middle[..., 1] - along[..., 0] * drop)


def t_of_lower_edge(x: float) -> float:
    """Return the t at which the band's lower edge has this x."""
    low, high = 0.0, T_END
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if lower_edge(middle)[0] < x else (low, middle)
    return (low + high) / 2


POST_TOP = 0.47
BEFORE_POST, BEHIND_POST = (t_of_lower_edge(POST_TOP + side * GAP / 2) for side in (-1, 1))
"""The columns on both sides of the post behind the side window, which goes on with the door's shut line."""
# fmt: off
LINES = np.concatenate([
    [0.0], np.linspace(0.16, HEADER - 0.15, 10), [HEADER],
    np.linspace(HEADER + 0.1, BEFORE_POST, 6),
    np.linspace(BEHIND_POST, REAR_HEADER - 0.1, 4), [REAR_HEADER],
    np.linspace(REAR_HEADER + 0.15, T_END - 0.16, 10), [T_END],
])
# fmt: on
"""The t of the columns of nodes beside and above the glass; narrow cells bound the dark borders."""
SHIELD, POST, ROOF = (int(np.abs(LINES - t).argmin()) for t in (HEADER, BEFORE_POST, REAR_HEADER))
SAIL = ROOF + 3


def feet() -> Array:
    """Return the x at which each column leaves the edge of the skin."""
    head: Array = lower_edge(LINES)[:, 0]
    half = GAP / 2
    stops = [head[0], DOOR_REAR - half, DOOR_REAR + half, HATCH_SIDE, HATCH_END]
    x: Array = np.interp(head, head[[0, POST, POST + 1, SAIL, -1]], stops)
    return x


def columns() -> Array:
    """Return the columns of nodes (columns, rows, 3) from the sill over the roof to the center line."""
    x, head = feet(), lower_edge(LINES)
    skin_rows = skin(columns_at(x, ROWS))
    foot = skin_rows[:, -1]
    # A low rise below the side glass; behind the door it is a fillet, which runs out with the hatch.
    rise = (GLASS_FOOT + 0.016 * ease(x, DOOR_REAR, HATCH_SIDE)) * np.clip((HATCH_END - x) / 0.5, 0.0, 1.0)
    low = flank(x, foot[:, 2] + rise)
    fillet = bezier(wall(s_at(x, QUARTER_TOP), QUARTER_TOP), ledge(x), low, (0.0, 0.4, 0.85, 1.0))

    skin_rows[POST + 1 : -1, -2:] = fillet[POST + 1 : -1, 1:3]
    # Glass and sail begin and end in points on the edge of the skin.
    low[[0, -1]], head[[0, -1]] = foot[[0, -1]], foot[[0, -1]]
    u = np.array(FLANK_ROWS)[None, :]
    side = flank(
        low[:, None, 0] * (1 - u) + head[:, None, 0] * u, low[:, None, 2] * (1 - u) + head[:, None, 2] * u
    )
    side[[0, -1]] = foot[[0, -1], None]
    band = bezier(crown(LINES, RIM), rail(LINES), head, BAND)[:, ::-1]
    over = crown(LINES[:, None], ACROSS[None, ::-1])
    return np.concatenate([skin_rows, side, band[:, 1:], over[:, 1:]], axis=1)


def names() -> Names:
    """Return the parts of the cells (columns - 1, rows - 1) above the edge of the skin."""
    of_cells = np.full((len(LINES) - 1, FLANK + len(BAND) + len(ACROSS) - 2), "hatch_glass", dtype="<U16")
    band, over = slice(FLANK, FLANK + len(BAND) - 1), slice(FLANK + len(BAND) - 1, None)
    shield, roof, sail = slice(0, SHIELD), slice(SHIELD, ROOF), slice(POST + 1, SAIL)
    of_cells[: POST + 1, :FLANK] = "glass_trim"
    of_cells[3:POST, 1:FLANK] = "window_{side}"
    of_cells[POST + 1 : SAIL, :FLANK] = "sail_{side}"
    of_cells[POST + 1 :, 0] = "quarter_{side}"
    of_cells[shield, band], of_cells[roof, band], of_cells[sail, band] = (
        "pillar_{side}",
        "roof",
        "sail_{side}",
    )
    of_cells[shield, over], of_cells[roof, over] = "windshield", "roof"
    # The dark borders of windshield and hatch.
    for glass in (shield, slice(ROOF, None)):
        of_cells[glass, over.start] = "glass_trim"
        for line in (glass.start, (glass.stop or 0) - 1):
            of_cells[line, over] = "glass_trim"
    return of_cells
