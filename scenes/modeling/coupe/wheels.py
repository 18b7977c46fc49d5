"""Wheels: tires turned from a profile, and alloy discs of five spokes before a dark brake.

Each wheel with its tire is a closed solid.
"""

from __future__ import annotations

import numpy as np

from scenes.modeling.coupe.body import AXLES, WHEEL_HEIGHT
from scenes.modeling.coupe.curves import Array
from scenes.modeling.coupe.ends import border
from scenes.modeling.coupe.parts import Parts

CENTER_Y = 0.784
AROUND = 40
SPOKES = 5
# fmt: off
# (outward offset from the wheel's middle plane, radius), from the outside bead round to the inside.
TIRE = (
    (0.090, 0.212), (0.100, 0.218), (0.107, 0.240), (0.104, 0.244), (0.106, 0.286), (0.101, 0.291),
    (0.096, 0.308), (0.076, 0.3215), (-0.080, 0.3225), (-0.104, 0.26), (-0.090, 0.0),
)
RIM = ((0.090, 0.212), (0.0975, 0.208), (0.095, 0.202), (0.050, 0.190))
# From the rim to the hub cap; cells between rows 1 and 3 are open between the spokes.
DISC = (
    (0.050, 0.190), (0.058, 0.178), (0.076, 0.140), (0.089, 0.078), (0.089, 0.052), (0.080, 0.049),
    (0.096, 0.040), (0.099, 0.0),
)
# fmt: on
OPEN_ROWS = (1, 3)
SPOKE = 2
"""Half the cells of a spoke, around the wheel."""


def turned(profile: tuple[tuple[float, float], ...], axle: float) -> Array:
    """Return the surface (around, profile, 3) turned about a wheel's axis."""
    angle = np.linspace(0, 2 * np.pi, AROUND + 1)[:, None] + np.pi / 2 + np.pi / SPOKES
    offset, radius = np.array(profile).T
    x, z = axle + radius * np.cos(angle), WHEEL_HEIGHT + radius * np.sin(angle)
    return np.stack([x, np.broadcast_to(CENTER_Y + offset, x.shape), z], axis=-1)


def build(parts: Parts) -> None:
    """Add four wheels with their tires."""
    cells = AROUND // SPOKES
    for axle in AXLES:
        parts.grid("tires", turned(TIRE, axle), flip=False)
        parts.grid("wheels", turned(RIM, axle), flip=True)
        disc = turned(DISC, axle)
        windows = [(k * cells + SPOKE, (k + 1) * cells - SPOKE, *OPEN_ROWS) for k in range(SPOKES)]
        names = np.full((AROUND, len(DISC) - 1), "wheels", dtype="<U6")
        for i0, i1, j0, j1 in windows:
            names[i0:i1, j0:j1] = ""
            opening = disc[i0 : i1 + 1, j0 : j1 + 1]
            brake = opening - [0, 0.034, 0]
            parts.grid("wheels", np.stack([border(opening), border(brake)], axis=1), flip=True)
            parts.grid("brakes", brake, flip=True)
        parts.grid(names, disc, flip=True)
