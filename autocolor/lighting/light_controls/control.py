"""The light controls: what they leave of a light at a point, from nothing to all of it.

Paper: "Light Controls". They modify what a reflection model gives at a point and know nothing of it, so they
work with any.

Each control is one class in a module of this package, registered where it is defined. It is found there, and
nothing else names it: `shading` asks every control of a light the same three questions, each with a default
that leaves the light as it is.

- `lit_points`: which points may be lit, judged by the points alone. Asked first: where it leaves a chunk of
  points dark, no ray is computed.
- `least_cosine`: the least cos(L) that is lit. Of several controls the largest counts.
- `factor`: what is left of the light elsewhere, 0 to 1, as a function of cos(L), of the distance, or of the
  positions of the points. Factors are multiplied.

To add one, give `Light` a field and write its class.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cache
from typing import Final, NamedTuple, TypeVar

import numpy as np

from autocolor.arrays import Booleans, Singles
from autocolor.modules import import_modules_of
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import VisiblePoints

ROUNDING: Final = float(np.finfo(np.float32).eps)


class LitPoints(NamedTuple):
    """What a factor may depend on, at the points that may be lit.

    `cos_light` is cos(L), (points,), or None if no control of the light is `directed`. `distance()` is the
    distance to the light, (points,); `positions()` are the points in camera space around
    `VisiblePoints.middle`, (3, points). Both are in `VisiblePoints.unit` and must not be modified.
    """

    cos_light: Singles | None
    distance: Callable[[], Singles]
    positions: Callable[[], Singles]


class LightControl(ABC):
    """One control of one light, ready for the visible points of one view.

    A control that asks for cos(L), in `least_cosine` or in `factor`, is `directed`; it must not be made for a
    light without a direction.
    """

    directed: bool = False
    least_cosine: float = -math.inf

    @classmethod
    @abstractmethod
    def of(cls, light: Light, points: VisiblePoints) -> LightControl | None:
        """The control of a light, or None where the light does not use it."""

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans | None:
        """Whether some points may be lit; None for all of them.

        `rows` are the columns `pixels` of `VisiblePoints.rows`.
        """
        return None

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """What is left of the light at points that are lit, 0 to 1, written to `out`.

        It is also computed at points that are not lit, and must be finite there. `out` may be the array of
        the cosines. A control without this method leaves all of the light.
        """
        raise NotImplementedError


Control = TypeVar("Control", bound=type[LightControl])

CONTROLS: Final[list[type[LightControl]]] = []
"""Every kind of control, in the order of the names of their modules.

So factors are multiplied, and rounded, in one order, whichever of the modules is imported first.
"""


def registered(control: Control) -> Control:
    """Add a class to `CONTROLS`."""
    CONTROLS.append(control)
    CONTROLS.sort(key=lambda each: each.__module__)
    return control


def controls_of(light: Light, points: VisiblePoints) -> tuple[LightControl, ...]:
    """The controls that a light uses, ready for some visible points."""
    _import_controls()
    ready = (control.of(light, points) for control in CONTROLS)
    return tuple(control for control in ready if control is not None)


@cache
def _import_controls() -> None:
    import_modules_of("autocolor.lighting.light_controls")


def ramp(fraction: Singles) -> Singles:
    """What a soft edge leaves at a fraction t of its width: nothing up to 0, all of it from 1 on.

    Between it is t^2 (3 - 2 t), in place. Assumed: of the polynomials that begin and end with a slope of 0,
    so that neither end shows as a seam, this has the lowest degree. Infinite fractions are not allowed.
    """
    np.clip(fraction, 0, 1, out=fraction)
    rest = np.multiply(fraction, -2)
    rest += 3
    rest *= fraction
    return np.multiply(fraction, rest, out=fraction)
