"""The canopy: windshield, roof, hatch glass, side glass, pillars, and the deck and cowl that meet them.

Two surfaces carry it. `crown(t, w)` runs from the cowl (t = 0) over the roof to the end of the hatch (T_END),
and from the center (w = 0) to the rail (w = 1). `flank(x, z)` is the side above the ledge, leaning inward.
A band of quadratic Bezier arcs rounds the edge between them: pillar, roof rail, bent rim of the hatch glass.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from scenes.modeling.coupe.body import LEDGE, S_END, s_at, wall
from scenes.modeling.coupe.curves import Array, bezier, bspline, coons, ease, segment
from scenes.modeling.coupe.panels import COWL, DOOR_FRONT, DOOR_REAR, QUARTER_TOP, hood_rear
from scenes.modeling.coupe.parts import Parts

# fmt: off
# Side views (x, z) of the center line and of the rail; the same count of control points.
CENTER = np.array([
    (-0.68, 0.940), (-0.48, 1.048), (-0.26, 1.168), (-0.07, 1.262), (0.05, 1.274), (0.28, 1.278),
    (0.50, 1.270), (0.72, 1.243), (1.08, 1.172), (1.42, 1.092), (1.74, 1.012), (1.98, 0.950),
])
RAIL = np.array([
    (-0.50, 0.885), (-0.33, 0.980), (-0.13, 1.094), (0.06, 1.200), (0.15, 1.213), (0.36, 1.217),
    (0.55, 1.206), (0.76, 1.170), (1.10, 1.098), (1.43, 1.020), (1.72, 0.963), (1.92, 0.929),
])
# fmt: on
T_END = float(len(CENTER) - 3)
HEADER, REAR_HEADER = 2.25, 5.45
BORDER, RIM, DROP, GLASS_FOOT = 0.90, 0.935, 0.036, 0.016
HATCH_SIDE, HATCH_END = 0.88, 1.90
# Lines of the crown: across, and along the windshield, roof and hatch; the outermost bound the dark borders.
ACROSS = np.append(np.linspace(0.0, BORDER, 10), RIM)
SHIELD_LINES = np.concatenate([[0.0], np.linspace(0.16, HEADER - 0.10, 10), [HEADER]])
ROOF_LINES = np.linspace(HEADER, REAR_HEADER, 11)
HATCH_LINES = np.concatenate([[REAR_HEADER], np.linspace(REAR_HEADER + 0.10, T_END - 0.16, 14), [T_END]])
SAIL_LINES = 5


def ledge(x: ArrayLike) -> Array:
    """Return points of the ledge at these x."""
    return wall(s_at(x, LEDGE), LEDGE)


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


def band(t: Array) -> Array:
    """Return the rounded edge, (t, 4, 3), from the crown down to the flank."""
    return bezier(crown(t, RIM), rail(t), lower_edge(t), 3)


def hollow_top(x: Array) -> Array:
    """Return where the hollow strip above the quarter panel meets the flank; it runs out with the hatch."""
    rise = (GLASS_FOOT + 0.016 * ease(x, DOOR_REAR, HATCH_SIDE)) * np.clip((2.03 - x) / 0.5, 0.0, 1.0)
    return flank(x, ledge(x)[:, 2] + rise)


def hollow(x: Array) -> Array:
    """Return the hollow strip, (x, 5, 3), from the quarter panel's top up into the flank."""
    return bezier(wall(s_at(x, QUARTER_TOP), QUARTER_TOP), ledge(x), hollow_top(x), 4)


def sheet(foot: Array, head: Array) -> Array:
    """Return the piece of flank, (n, 6, 3), between two lines of n points."""
    u = np.linspace(0, 1, 6)[None, :]
    x = foot[:, None, 0] * (1 - u) + head[:, None, 0] * u
    z = foot[:, None, 2] * (1 - u) + head[:, None, 2] * u
    return flank(x, z)


def t_of_lower_edge(x: float) -> float:
    """Return the t at which the band's lower edge has this x."""
    low, high = 0.0, T_END
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if lower_edge(middle)[0] < x else (low, middle)
    return (low + high) / 2


def crown_panels(parts: Parts) -> None:
    """Add windshield, roof and hatch glass with their dark borders, and the band beside them."""
    parts.grid("roof", crown(ROOF_LINES[:, None], ACROSS[None]))
    for part, lines in (("windshield", SHIELD_LINES), ("hatch_glass", HATCH_LINES)):
        parts.grid(part, crown(lines[1:-1, None], ACROSS[None, :-1]))
        parts.grid("glass_trim", crown(lines[1:-1, None], ACROSS[None, -2:]))
        for edge in (lines[:2], lines[-2:]):
            parts.grid("glass_trim", crown(edge[:, None], ACROSS[None]))
    parts.grid("pillar_{side}", band(SHIELD_LINES))
    parts.grid("roof", band(ROOF_LINES))
    parts.grid("sail_{side}", band(HATCH_LINES[:SAIL_LINES]))
    parts.grid("hatch_glass", band(HATCH_LINES[SAIL_LINES - 1 :]))


def side_panels(parts: Parts) -> None:
    """Add door glass, sail panel and the side of the hatch glass, down to the ledge."""
    top_rear = t_of_lower_edge(0.47)
    x = np.linspace(DOOR_FRONT + 0.09, DOOR_REAR + 0.005, 13)
    foot = ledge(x)
    low = flank(x, foot[:, 2] + GLASS_FOOT)
    high = lower_edge(np.linspace(0.12, top_rear, 13))
    parts.grid("window_{side}", sheet(low[3:], high[3:]))
    parts.grid("glass_trim", sheet(low[:4], high[:4]))
    parts.grid("glass_trim", np.stack([foot, low], axis=1))

    glass = HATCH_LINES[SAIL_LINES - 1 :]
    post, aft = np.linspace(DOOR_REAR + 0.005, HATCH_SIDE, 4), np.linspace(HATCH_SIDE, HATCH_END, len(glass))
    parts.grid("sail_{side}", sheet(hollow_top(post), lower_edge(np.linspace(top_rear, glass[0], 4))))
    parts.grid("hatch_glass", sheet(hollow_top(aft), lower_edge(glass)))
    parts.grid("quarter_{side}", hollow(np.concatenate([post, aft[1:]])))


def crown_end(t: float) -> Array:
    """Return the crown's line at t, from the center over the band to the flank."""
    return np.concatenate([crown(t, ACROSS), band(np.array([t]))[0, 1:]])


def deck(parts: Parts) -> None:
    """Add the short deck behind the hatch glass."""
    front = np.concatenate([crown_end(T_END), hollow(np.array([HATCH_END]))[0, ::-1]])
    corner = float(s_at(2.16, QUARTER_TOP))
    side = wall(np.linspace(float(s_at(HATCH_END, QUARTER_TOP)), corner, 5), QUARTER_TOP)
    rear = wall(np.linspace(S_END, corner, len(front)), QUARTER_TOP)
    parts.grid("deck", coons(front, rear, segment(front[0], rear[0], 4), side), outward=(0, 0, 1))


def cowl(parts: Parts) -> None:
    """Add the dark vent panel between hood and windshield."""
    shield = crown_end(0.0)
    rear = hood_rear(len(shield) - 1)
    middle = (rear + shield) / 2 - [0, 0, 0.004]
    parts.grid("cowl", np.stack([rear, middle, shield], axis=1), outward=(0, 0, 1))
    corner = np.stack([ledge(np.linspace(COWL, -0.47, 4)), segment(rear[-1], shield[-1], 3)], axis=1)
    parts.grid("cowl", corner, outward=(0, 0, 1))


def build(parts: Parts) -> None:
    """Add everything above the ledge."""
    crown_panels(parts)
    side_panels(parts)
    deck(parts)
    cowl(parts)
