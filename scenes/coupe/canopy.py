"""The canopy: windshield, roof, hatch glass, side glass, pillars, and the deck and cowl that meet them.

Two surfaces carry it. `crown(t, w)` runs from the cowl (t = 0) over the roof to the end of the hatch (t = T_END), and
from the center (w = 0) out to the rail (w = 1). `flank(x, z)` is the side above the ledge, leaning inward. A band
of quadratic Bezier arcs rounds the edge between them: pillar, roof rail and the bent rim of the hatch glass.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from scenes.coupe.body import LEDGE, S_END, s_at, top, wall
from scenes.coupe.curves import Array, bspline, coons, ease, segment, spaced
from scenes.coupe.panels import DOOR_FRONT, DOOR_REAR, HOOD_EDGE, QUARTER_TOP, hood_rear
from scenes.coupe.parts import Parts

# Side views (x, z) of the center line and of the rail; the same count of control points.
CENTER = np.array([(-0.68, 0.940), (-0.48, 1.048), (-0.26, 1.168), (-0.07, 1.262), (0.05, 1.274), (0.28, 1.278),
                   (0.50, 1.270), (0.72, 1.243), (1.08, 1.172), (1.42, 1.092), (1.74, 1.012), (1.98, 0.950)])  # fmt: skip
RAIL = np.array([(-0.50, 0.885), (-0.33, 0.980), (-0.13, 1.094), (0.06, 1.200), (0.15, 1.213), (0.36, 1.217),
                 (0.55, 1.206), (0.76, 1.170), (1.10, 1.098), (1.43, 1.020), (1.72, 0.963), (1.92, 0.929)])  # fmt: skip
T_END = float(len(CENTER) - 3)
HEADER, REAR_HEADER, PILLAR_END = 2.25, 5.45, 6.35
RIM, DROP, GLASS_FOOT = 0.935, 0.036, 0.016


def flank(x: ArrayLike, z: ArrayLike) -> Array:
    """Return points of the side of the canopy at (x, z)."""
    x, z = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(z, dtype=float))
    foot = wall(s_at(x, LEDGE), LEDGE)
    rise = z - foot[..., 2]
    return np.stack([x, foot[..., 1] - 0.40 * rise - 0.62 * rise * np.abs(rise), z], axis=-1)


def rail(t: ArrayLike) -> Array:
    """Return points of the edge between crown and flank."""
    side_view = bspline(RAIL, t)
    return flank(side_view[..., 0], side_view[..., 1])


def crown(t: ArrayLike, w: ArrayLike) -> Array:
    """Return points of the windshield, roof and hatch surface."""
    t, w = np.broadcast_arrays(np.asarray(t, dtype=float), np.asarray(w, dtype=float))
    center, edge = bspline(CENTER, t), rail(t)
    x = center[..., 0] + (edge[..., 0] - center[..., 0]) * w**2
    z = center[..., 1] + (edge[..., 2] - center[..., 1]) * w**2.3
    return np.stack([x, edge[..., 1] * w, z], axis=-1)


def lower_edge(t: ArrayLike) -> Array:
    """Return the lower edge of the band: points on the flank DROP below the rail, square to it in side view."""
    t = np.asarray(t, dtype=float)
    here, ahead = bspline(RAIL, np.clip(t - 0.01, 0, T_END)), bspline(RAIL, np.clip(t + 0.01, 0, T_END))
    along = ahead - here
    along /= np.linalg.norm(along, axis=-1)[..., None]
    middle = (here + ahead) / 2
    drop = DROP * np.clip(0.35 + t / 1.5, 0, 1) * np.clip((T_END - t) / 1.5 + 0.25, 0, 1)
    return flank(middle[..., 0] + along[..., 1] * drop, middle[..., 1] - along[..., 0] * drop)


def band(t: Array, steps: int) -> Array:
    """Return the rounded edge, (t, steps + 1, 3), from the crown down to the flank."""
    upper, corner, lower = crown(t, RIM)[:, None], rail(t)[:, None], lower_edge(t)[:, None]
    u = np.linspace(0, 1, steps + 1)[None, :, None]
    arc: Array = upper * (1 - u) ** 2 + corner * 2 * u * (1 - u) + lower * u**2
    return arc


def fillet(x: Array, steps: int) -> Array:
    """Return the hollow strip, (x, steps + 1, 3), from the quarter panel's top up into the flank."""
    outer = wall(s_at(x, QUARTER_TOP), QUARTER_TOP)[:, None]
    corner = wall(s_at(x, LEDGE), LEDGE)[:, None]
    upper = flank(x, corner[:, 0, 2] + fillet_rise(x))[:, None]
    u = np.linspace(0, 1, steps + 1)[None, :, None]
    arc: Array = outer * (1 - u) ** 2 + corner * 2 * u * (1 - u) + upper * u**2
    return arc


def fillet_rise(x: Array) -> Array:
    """Return how far the hollow strip climbs the flank; it runs out with the hatch."""
    return (GLASS_FOOT + 0.016 * ease(x, DOOR_REAR, 0.88)) * np.clip((2.03 - x) / 0.5, 0.0, 1.0)


def t_of_lower_edge(x: float) -> float:
    """Return the t at which the band's lower edge has this x."""
    low, high = 0.0, T_END
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if lower_edge(middle)[0] < x else (low, middle)
    return (low + high) / 2


def crown_panels(parts: Parts) -> None:
    """Add windshield, roof and hatch glass with their dark borders, and the band beside them."""
    across = spaced(0.0, 0.90, counts=(9,))
    border = np.array([0.90, RIM])
    for part, start, end, count in (
        ("windshield", 0.16, HEADER - 0.10, 10),
        ("roof", HEADER, REAR_HEADER, 10),
        ("hatch_glass", REAR_HEADER + 0.10, T_END - 0.16, 14),
    ):
        t = np.linspace(start, end, count + 1)
        wide = part == "roof"
        parts.grid(part, crown(t[:, None], (spaced(0.0, RIM, counts=(10,)) if wide else across)[None]))
        if not wide:
            parts.grid("glass_trim", crown(t[:, None], border[None]))
    across = np.concatenate([across, [RIM]])
    for start, end in ((0.0, 0.16), (HEADER - 0.10, HEADER), (REAR_HEADER, REAR_HEADER + 0.10), (T_END - 0.16, T_END)):
        parts.grid("glass_trim", crown(np.array([start, end])[:, None], across[None]))
    for part, start, end, count in (
        ("pillar_{side}", 0.0, HEADER, 10),
        ("roof", HEADER, REAR_HEADER, 10),
        ("sail_{side}", REAR_HEADER, PILLAR_END, 3),
        ("hatch_glass", PILLAR_END, T_END, 11),
    ):
        parts.grid(part, band(np.linspace(start, end, count + 1), 3))


def side_panels(parts: Parts) -> None:
    """Add door glass, sail panel and the side of the hatch glass, down to the ledge."""
    top_rear = t_of_lower_edge(0.47)
    x = np.linspace(DOOR_FRONT + 0.09, DOOR_REAR + 0.005, 13)
    foot = wall(s_at(x, LEDGE), LEDGE)
    low = flank(x, foot[:, 2] + GLASS_FOOT)
    high = lower_edge(np.linspace(0.12, top_rear, 13))

    def upright(bottom: Array, summit: Array, steps: int = 5) -> Array:
        line = segment(bottom, summit, steps)
        return flank(line[:, 0], line[:, 2])

    def sheet(bottom: Array, summit: Array) -> Array:
        grid = np.stack([upright(b, s) for b, s in zip(bottom, summit, strict=True)])
        return grid

    parts.grid("window_{side}", sheet(low[3:], high[3:]))
    parts.grid("glass_trim", sheet(low[:4], high[:4]))
    parts.grid("glass_trim", np.stack([foot, low], axis=1))

    post = np.linspace(DOOR_REAR + 0.005, 0.88, 4)
    rise = wall(s_at(post, LEDGE), LEDGE)[:, 2] + fillet_rise(post)
    start = flank(post, rise)
    parts.grid("sail_{side}", sheet(start, lower_edge(np.linspace(top_rear, PILLAR_END, 4))))
    aft = np.linspace(0.88, 1.90, 10)
    start = flank(aft, wall(s_at(aft, LEDGE), LEDGE)[:, 2] + fillet_rise(aft))
    parts.grid("hatch_glass", sheet(start, lower_edge(np.linspace(PILLAR_END, T_END, 10))))
    parts.grid("quarter_{side}", fillet(np.concatenate([post, aft[1:]]), 4))


def deck(parts: Parts) -> None:
    """Add the short deck behind the hatch glass."""
    front = crown(T_END, spaced(0.0, RIM, counts=(10,)))
    front = np.concatenate([front, band(np.array([T_END]), 3)[0, 1:], fillet(np.array([1.90]), 4)[0, ::-1]])
    corner = s_at(2.16, QUARTER_TOP)
    side = wall(np.linspace(s_at(1.90, QUARTER_TOP), corner, 5), QUARTER_TOP)
    rear = wall(np.linspace(S_END, corner, len(front)), QUARTER_TOP)
    center = segment(front[0], rear[0], 4)
    parts.grid("deck", coons(front, rear, center, side), outward=(0, 0, 1))


def cowl(parts: Parts) -> None:
    """Add the dark vent panel between hood and windshield."""
    shield = crown(0.0, spaced(0.0, RIM, counts=(10,)))
    shield = np.concatenate([shield, band(np.array([0.0]), 3)[0, 1:]])
    side = wall(s_at(-0.61, HOOD_EDGE), HOOD_EDGE)
    y = np.linspace(0, float(side[1]), len(shield))
    plan = hood_rear(y, float(side[1]))
    rear = np.concatenate([plan, top(plan[:, 0], plan[:, 1])[:, None]], axis=1)
    parts.grid("cowl", np.stack([rear, (rear + shield) / 2 - [0, 0, 0.004], shield], axis=1), outward=(0, 0, 1))
    ledge = wall(s_at(np.linspace(-0.61, -0.47, 4), LEDGE), LEDGE)
    parts.grid("cowl", np.stack([ledge, segment(rear[-1], shield[-1], 3)], axis=1), outward=(0, 0, 1))


def build(parts: Parts) -> None:
    """Add everything above the ledge."""
    crown_panels(parts)
    side_panels(parts)
    deck(parts)
    cowl(parts)
