"""The light controls: what they leave of a light at a point, from nothing to all of it.

Paper: "Light Controls". They modify what a reflection model gives at a point and know nothing of it, so they
work with any.

Each control is one class here, registered where it is defined, and nothing else names it: `shading` asks
every control of a light the same three questions, each with a default that leaves the light as it is.

- `lit_points`: which points may be lit, judged by the points alone. Asked first: where it leaves a chunk of
  points dark, no ray is computed.
- `least_cosine`: the least cos(L) that is lit. Of several controls the largest counts.
- `factor`: what is left of the light elsewhere, 0 to 1, as a function of cos(L), of the distance, or of the
  positions of the points. Factors are multiplied.

To add one, give `Light` a field and write its class. A soft cone has the cosine of its outer angle as
`least_cosine` and a ramp up to the inner angle as its `factor`. A flap along any plane is a `FlapSides` with
the row of that plane; a soft one has a ramp across the plane as its `factor`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple, TypeVar

import numpy as np

from autocolor.arrays import Booleans, Floats, Singles, power
from autocolor.scene.lights import Flap, Light
from autocolor.visibility.visible_points import POINT, VisiblePoints

ROUNDING: Final = float(np.finfo(np.float32).eps)

Axis = Literal["x", "y", "z"]
"""The object coordinate that a flap restricts."""

FlapEnd = Literal["minimum", "maximum"]
"""The fields of a flap that are coordinates."""

FAR_FLAP: Final = 1e30
"""In units; farther than any point, and float32 can hold it."""

ABOVE_ZERO: Final = float(np.finfo(np.float32).smallest_subnormal)
"""The least positive float32."""


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

    def lit_points(self, rows: Singles) -> Booleans | None:
        """Whether the points in some columns of `VisiblePoints.rows` may be lit; None for all of them."""
        return None

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """What is left of the light at points that are lit, 0 to 1, written to `out`.

        It is also computed at points that are not lit, and must be finite there. `out` may be the array of
        the cosines. A control without this method leaves all of the light.
        """
        raise NotImplementedError


Control = TypeVar("Control", bound=type[LightControl])

CONTROLS: Final[list[type[LightControl]]] = []
"""Every kind of control."""


def registered(control: Control) -> Control:
    """Add a class to `CONTROLS`."""
    CONTROLS.append(control)
    return control


def controls_of(light: Light, points: VisiblePoints) -> tuple[LightControl, ...]:
    """The controls that a light uses, ready for some visible points."""
    ready = (control.of(light, points) for control in CONTROLS)
    return tuple(control for control in ready if control is not None)


@registered
@dataclass(frozen=True, eq=False)
class FlapSides(LightControl):
    """The sides of all flaps that are on.

    Paper: "Light Flaps and Cones": a flap is a range of an object coordinate, a box and no shadow. A point on
    a side is inside. `sides` is (sides, 4); see `is_inside`.
    """

    sides: Singles

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> FlapSides | None:
        """The sides that are not at infinity."""
        sides = flap_sides(light, points)
        return cls(np.array(list(sides.values()), np.float32)) if sides else None

    def lit_points(self, rows: Singles) -> Booleans:
        """Whether each point is inside all flaps."""
        lit = is_inside(self.sides[0], rows)
        for side in self.sides[1:]:
            np.logical_and(lit, is_inside(side, rows), out=lit)
        return lit


def flaps_of(light: Light) -> dict[Axis, Flap | None]:
    """The flap of a light along each axis, on or off; None where there is none."""
    return {"x": light.flaps.x, "y": light.flaps.y, "z": light.flaps.z}


def flap_sides(light: Light, points: VisiblePoints) -> dict[tuple[Axis, FlapEnd], Floats]:
    """The sides, (4,) each, of the flaps that are on, but for those at infinity; see `is_inside`."""
    sides: dict[tuple[Axis, FlapEnd], Floats] = {}
    # A surface that lies on a side is lit: allow for the rounding of its points to float32.
    slack = 4 * ROUNDING * points.radius
    for row, (axis, flap) in enumerate(flaps_of(light).items()):
        if flap is None or not flap.on:
            continue
        coordinate = points.world_coordinate(row)
        ends: dict[FlapEnd, tuple[float, float]] = {
            "minimum": (1.0, flap.minimum),
            "maximum": (-1.0, flap.maximum),
        }
        for end, (sign, limit) in ends.items():
            if math.isfinite(limit):
                in_units = min(max(sign * limit / points.unit, -FAR_FLAP), FAR_FLAP)
                sides[axis, end] = sign * coordinate - np.array([0, 0, 0, in_units - slack])
    return sides


def is_inside(side: Singles, rows: Singles) -> Booleans:
    """Whether each point is on the inner side of a plane: where its product with (P, 1) is at least 0."""
    inside: Booleans = side[:3] @ rows[POINT] >= -side[3]
    return inside


@registered
@dataclass(frozen=True, eq=False)
class Cone(LightControl):
    """The cone: a point is lit where L <= A.

    Departs: the paper prints the test as cos(L) <= cos(A), which would light the outside; the rim itself is
    lit. With C = 0 nothing is dark behind the light, so a cone of more than 90 degrees lights there too; with
    C > 0 the hemisphere ends at 90.
    """

    least_cosine: float
    directed = True

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Cone | None:
        """The cone, widened by a rounding of float32: a rim along a line of pixels does not fray."""
        if light.cone_angle is None:
            return None
        return cls(math.cos(math.radians(light.cone_angle)) - ROUNDING)


@registered
@dataclass(frozen=True, eq=False)
class Concentration(LightControl):
    """Concentration: cos^C(L) where cos(L) > 0.

    Paper: "Light Direction and Concentration". Half is left at 60 degrees for C = 1, at 21.1 for C = 10 and
    at 10.6 for C = 40. With C = 0 the light is a point source, and nothing is dark behind it.
    """

    exponent: float
    directed = True
    least_cosine = ABOVE_ZERO

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Concentration | None:
        """The concentration, if the light has any."""
        return cls(light.concentration) if light.concentration > 0 else None

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """cos^C(L)."""
        assert lit.cos_light is not None
        return power(lit.cos_light, self.exponent, out=out)
