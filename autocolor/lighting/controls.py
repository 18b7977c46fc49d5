"""The light controls: the share of a light, 0 to 1, that reaches a point.

Paper: "Light Controls". Controls modify the result of a reflection model at a point and know nothing of the
model, so they work with any.

Each control is one class, named in `CONTROLS` at the foot. `shading` asks every control of a light the same
three questions, each with a default that leaves the light as it is:

- `lit_points`: which points may be lit, judged by the points alone. This comes first: if a chunk of points
  is dark, no ray is computed.
- `least_cosine`: the least cos(L) that is lit. Of several controls the largest counts.
- `factor`: the share of the light at these points, 0 to 1, as a function of cos(L), of the distance, or of
  the positions of the points. Factors are multiplied.

To add a control, give `Light` a field with its column, write its class here, and name it in `CONTROLS`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

import numpy as np

from autocolor.arrays import (
    NEGLIGIBLE,
    POWER_ERROR,
    ROUNDING,
    Booleans,
    ExactLogarithms,
    Floats,
    Indices,
    PartNumbers,
    Singles,
    power,
    unit_vector,
)
from autocolor.checks import Vector
from autocolor.lighting.rays import FARTHEST, Rays, camera_light
from autocolor.scene.following import detached
from autocolor.scene.lights import Flap, Light
from autocolor.visibility.visible_points import POINT, POINT_SQUARED, VisiblePoints

ABOVE_ZERO: Final = float(np.finfo(np.float32).smallest_subnormal)
"""The least positive float32: the least cos(L) in front of a light."""

FARTHEST_PLANE: Final = 1e15
"""The largest distance of a plane, in units: farther than any point."""

LEAST_WIDTH: Final = 1e-20
"""The least edge width, in units: far below the rounding of points, and float32 holds any quotient by it."""

MOST_SPREAD: Final = 100.0
"""The largest concentration whose light counts wherever cos(L) is above 0."""

ROUNDING_OF_COSINES: Final = 1e-5
"""Above the rounding of any cosine in float32."""

LEAST_REACH: Final = 1e-20
"""The least reach, in units: float32 can hold any distance as a multiple of it."""


class ExactLight(NamedTuple):
    """cos(L) with more digits than in float32.

    It has the logarithms near 1. `cosines` returns cos(L), (k,) float64, at k places.
    """

    logarithms: ExactLogarithms
    cosines: Callable[[Indices], Floats]


class LitPoints(NamedTuple):
    """The points that may be lit: the arguments of a factor.

    `cos_light` is cos(L), (points,), or None if no control of the light is `directed`. `distance()` is the
    distance to the light, (points,); `positions()` are the points in camera space around
    `VisiblePoints.origin`, (3, points). Both are in `VisiblePoints.unit` and must not be modified.
    `exact` has cos(L) with more digits; None if it is exact in float32.
    """

    cos_light: Singles | None
    distance: Callable[[], Singles]
    positions: Callable[[], Singles]
    exact: ExactLight | None = None


class LightControl(ABC):
    """One control of one light, ready for the visible points of one view.

    A control that uses cos(L), in `least_cosine` or in `factor`, is `directed`. Only a light with a direction
    may have one.
    """

    directed: bool = False
    least_cosine: float = -math.inf

    @classmethod
    @abstractmethod
    def of(cls, light: Light, points: VisiblePoints) -> LightControl | None:
        """The control of a light, or None if the light does not use it."""

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans | None:
        """Whether each of some points may be lit; None for all of them.

        `rows` are the columns `pixels` of `VisiblePoints.rows`.
        """
        return None

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """The share of the light that is left at points that are lit, 0 to 1, written to `out`.

        It is also computed at points that are not lit, and must be finite there. `out` may be the array of
        the cosines. A control that does not override this method leaves all of the light.
        """
        raise NotImplementedError


def controls_of(light: Light, points: VisiblePoints) -> tuple[LightControl, ...]:
    """The controls that a light uses, ready for some visible points."""
    ready = (control.of(light, points) for control in CONTROLS)
    return tuple(control for control in ready if control is not None)


@dataclass(frozen=True, eq=False)
class Concentration(LightControl):
    """Concentration: cos^C(L) where cos(L) > 0.

    Paper: "Light Direction and Concentration". Half of the light is left at 60 degrees for C = 1, at 21.1 for
    C = 10 and at 10.6 for C = 40. With C = 0 the light is a point source, which also lights the points behind
    it. Outside of a narrow beam, shares that are negligible count as 0, which saves their time.
    """

    exponent: float
    least_cosine: float = ABOVE_ZERO
    directed = True

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Concentration | None:
        """The concentration, if the light has any."""
        concentration = light.concentration
        if concentration <= MOST_SPREAD:
            return cls(concentration) if concentration > 0 else None
        return cls(concentration, math.exp(-NEGLIGIBLE / concentration) - ROUNDING_OF_COSINES)

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """cos^C(L)."""
        assert lit.cos_light is not None
        return power(lit.cos_light, self.exponent, out, lit.exact and lit.exact.logarithms)


@dataclass(frozen=True, eq=False)
class Cone(LightControl):
    """The cone: a point is lit where L <= A.

    Paper: "Light Flaps and Cones". Departs: the paper prints the test as cos(L) <= cos(A), which would light
    the outside; the rim itself is lit. With C = 0 nothing is dark behind the light, so a cone of more than 90
    degrees lights there too; with C > 0 the hemisphere ends at 90.
    """

    least_cosine: float
    directed = True

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Cone | None:
        """The cone, widened by a rounding of float32: a rim along a line of pixels does not fray.

        The rim of a narrow cone is widened by `within`.
        """
        if light.cone_angle is None:
            return None
        least = math.cos(math.radians(light.cone_angle))
        return cls(least if is_narrow(least) else least - ROUNDING)


NARROW: Final = 2.5e-3
"""Assumed: a cone is narrow if sin^2(A) is below this: up to 2.9 degrees, or less than that from 180.

The rounding of a cosine would move its rim by a ten thousandth of the angle, or more."""

RIM_ROUNDING: Final = 2e-7
"""Assumed: in radians; a rim along a line of pixels does not fray."""


def is_narrow(least_cosine: float) -> bool:
    """Whether a cone with the least cosine cos(A) has a rim that depends on the rounding of cosines."""
    return 1 - least_cosine**2 < NARROW


def within(rays: Rays, least_cosine: float) -> Booleans:
    """Whether cos(L) of each ray of a directed light is at least the least cosine of its controls."""
    assert rays.cos_light is not None
    if rays.are_parallel or not is_narrow(least_cosine):
        lit: Booleans = rays.cos_light >= np.float32(least_cosine)
        return lit
    rounding = rays.rounding + ROUNDING
    lit = rays.cos_light >= np.float32(least_cosine - rounding)
    places = lit.nonzero()[0]
    places = places[rays.cos_light.take(places) <= least_cosine + rounding]
    if len(places):
        slack = RIM_ROUNDING * math.sqrt(1 - least_cosine**2)
        lit[places] = rays.exact_cos_light(places) >= least_cosine - slack
    return lit


@dataclass(frozen=True, eq=False)
class SoftCone(LightControl):
    """All of the light up to the inner angle, and nothing from the cone angle on; see `soften`.

    Departs: the paper's cones have a sharp edge. Assumed: between the angles the share depends on cos(L), not
    on L. So no pixel needs an arc cosine, and a share with an inner angle of 0 is smooth on the axis: there
    cos(L) has a slope of 0, and L a corner.
    """

    rim: float
    width: float
    cosines: tuple[float, float]
    directed = True

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> SoftCone | None:
        """The soft edge, if the inner angle is below the cone angle; else the cone is sharp."""
        inner, outer = light.inner_angle, light.cone_angle
        if inner is None or outer is None or inner >= outer:
            return None
        cosines = math.cos(math.radians(inner)), math.cos(math.radians(outer))
        # Rounded like the cosines that it is subtracted from.
        rim = float(np.float32(cosines[1]))
        return cls(rim, max(cosines[0] - rim, ROUNDING), cosines)

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """The share that is left between the two angles."""
        assert lit.cos_light is not None
        # The share changes by at most 3/2 of the change of the fraction.
        exact, rounding = lit.exact, 0.0
        if exact is not None and 1.5 * exact.logarithms.rounding > POWER_ERROR * self.width:
            rounding = exact.logarithms.rounding + ROUNDING
        np.subtract(lit.cos_light, np.float32(self.rim - rounding), out=out)
        out *= np.float32(1 / self.width)
        if exact is not None and rounding:
            # Fractions are too large by that of the rounding. As integers, negative numbers are the largest.
            most = np.float32(1 + 2 * rounding / self.width)
            places = (out.view(np.uint32) < most.view(np.uint32)).nonzero()[0]
            inner, outer = self.cosines
            out[places] = (exact.cosines(places) - outer) / (inner - outer)
        return soften(out)


def soften(fraction: Singles) -> Singles:
    """The share of the light at a fraction t of the width of a soft edge, in place.

    It is 0 up to t = 0, 1 from t = 1 on, and t^2 (3 - 2 t) between. Assumed: this is the polynomial of the
    lowest degree that begins and ends with a slope of 0, so that neither end shows as a seam. Fractions must
    be finite.
    """
    np.clip(fraction, 0, 1, out=fraction)
    rest = np.multiply(fraction, -2)
    rest += 3
    rest *= fraction
    return np.multiply(fraction, rest, out=fraction)


@dataclass(frozen=True, eq=False)
class Sides(LightControl):
    """Flaps and half-spaces: nothing is left beyond the planes at which they end.

    Paper: "Light Flaps and Cones": a flap is a range of an object coordinate, a box and no shadow. Departs:
    the paper has flaps along the axes alone. A point on a plane is lit.

    `sides` is (sides, 4); see `LitSide.row`.
    """

    sides: Singles

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Sides | None:
        """The sides of the flaps and the half-spaces of a light, if any is on."""
        sides = sides_of(light, points)
        return cls(np.array([side.row for side in sides], np.float32)) if sides else None

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans:
        """Whether each point is on the lit side of all planes."""
        lit = is_inside(self.sides[0], rows)
        for side in self.sides[1:]:
            np.logical_and(lit, is_inside(side, rows), out=lit)
        return lit


@dataclass(frozen=True, eq=False)
class SoftSides(LightControl):
    """The soft edges of flaps and half-spaces: none of the light on a plane, all of it at the edge width.

    Departs: the paper's flaps end at once. `sides` is (sides, 4); its product with (P, 1) is the distance
    from a plane as a fraction of its edge width. The shares of several edges are multiplied; see `soften`.
    """

    sides: Singles

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> SoftSides | None:
        """The sides with soft edges, if there are any."""
        sides = sides_of(light, points)
        soft = [side.row / max(side.edge_width, LEAST_WIDTH) for side in sides if side.edge_width > 0]
        return cls(np.array(soft, np.float32)) if soft else None

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """The product of the shares at all edges."""
        positions = lit.positions()
        for number, side in enumerate(self.sides):
            fraction = np.matmul(side[:3], positions, out=None if number else out)
            fraction += side[3]
            soften(fraction)
            if number:
                out *= fraction
        return out


Axis = Literal["x", "y", "z"]
"""The object coordinate that a flap restricts."""

FlapEnd = Literal["minimum", "maximum"]
"""The fields of a flap that are coordinates."""


class LitSide(NamedTuple):
    """The lit side of a plane: the points P where the product of `row`, (4,), with (P, 1) is at least 0.

    The product is the distance from the plane. From the distance `edge_width` on, all of the light is left.
    Both are in `VisiblePoints.unit`. An edge of the width 0 is sharp.
    """

    row: Floats
    edge_width: float


def is_inside(row: Floats | Singles, rows: Singles) -> Booleans:
    """Whether each point in `VisiblePoints.rows` is on the lit side of a plane, or on the plane itself."""
    row = row.astype(np.float32, copy=False)
    inside: Booleans = row[:3] @ rows[POINT] >= -row[3]
    return inside


def sides_of(light: Light, points: VisiblePoints) -> list[LitSide]:
    """The sides of the flaps and the half-spaces of a light that are on."""
    return [*flap_sides(light, points).values(), *half_space_sides(light, points).values()]


def flaps_of(light: Light) -> dict[Axis, Flap | None]:
    """The flap of a light along each axis, on or off; None where there is none."""
    return {"x": light.flaps.x, "y": light.flaps.y, "z": light.flaps.z}


def flap_sides(light: Light, points: VisiblePoints) -> dict[tuple[Axis, FlapEnd], LitSide]:
    """The sides of the flaps that are on, without ends at infinity."""
    sides: dict[tuple[Axis, FlapEnd], LitSide] = {}
    for row, (axis, flap) in enumerate(flaps_of(light).items()):
        if flap is None or not flap.on:
            continue
        ends: dict[FlapEnd, tuple[float, float]] = {
            "minimum": (1.0, flap.minimum),
            "maximum": (-1.0, flap.maximum),
        }
        for end, (sign, limit) in ends.items():
            if math.isfinite(limit):
                x, y, z = (sign if number == row else 0.0 for number in range(3))
                sides[axis, end] = side_of(points, (x, y, z), sign * limit, flap.edge_width)
    return sides


def half_space_sides(light: Light, points: VisiblePoints) -> dict[str, LitSide]:
    """The sides of the half-spaces that are on, by name; a carried half-space is placed with its light."""
    sides: dict[str, LitSide] = {}
    for half_space in light.half_spaces:
        if half_space.on:
            placed = detached(half_space, light)
            direction = unit_vector(placed.direction)
            least = sum(a * b for a, b in zip(direction, placed.point, strict=True))
            sides[half_space.name] = side_of(points, direction, least, half_space.edge_width)
    return sides


def side_of(points: VisiblePoints, direction: Vector, least: float, edge_width: float) -> LitSide:
    """The side of a plane of the world whose points have a product of at least `least` with a unit vector.

    The unit vector is the `direction` from the plane into the light. `edge_width` is in world units.
    """
    coordinates = np.array([points.world_coordinate(axis) for axis in range(3)])
    in_units = min(max(least / points.unit, -FARTHEST_PLANE), FARTHEST_PLANE)
    # A surface that lies on a sharp side is lit: allow for the rounding of its points to float32.
    slack = 0.0 if edge_width > 0 else 4 * ROUNDING * points.largest_distance
    row = np.array(direction) @ coordinates - (np.array([0, 0, 0, in_units]) - slack)
    return LitSide(row, edge_width / points.unit)


@dataclass(frozen=True, eq=False)
class Falloff(LightControl):
    """Falloff: (1 - f)^n at the distance f as a fraction of the reach, n = 1 or 2, and 0 beyond it.

    Departs: the light of the paper does not depend on the distance, nor does a light without a falloff here.
    Rejected: 1/d^2, which has no upper limit. A point close to the light would take the whole range of levels
    and leave all others black. This falloff stays within 0 to 1, and ends.
    """

    reach: float
    exponent: int
    sphere: Singles

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Falloff | None:
        """The falloff, if the light has any."""
        if light.falloff == "none" or light.reach is None:
            return None
        reach = min(max(light.reach / points.unit, LEAST_REACH), FARTHEST)
        position = camera_light(light, points, directed=False).position
        square = float(position @ position)
        # The factor is 0 at a point that is within reach only by this slack.
        slack = 8 * ROUNDING * (square + points.radius**2)
        sphere = np.array([*(-2 * position), 1, square - reach**2 - slack], np.float32)
        return cls(reach, 1 if light.falloff == "linear" else 2, sphere)

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans:
        """Whether each point is within reach: (p - P)^2 = p.p - 2 p.P + P.P, as in `rays`."""
        within: Booleans = self.sphere[:4] @ rows[POINT.start : POINT_SQUARED + 1] <= -self.sphere[4]
        return within

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """All of the light at the light itself, nothing at its reach."""
        np.divide(lit.distance(), np.float32(-self.reach), out=out)
        out += 1
        np.maximum(out, 0, out=out)
        return out if self.exponent == 1 else np.square(out, out=out)


@dataclass(frozen=True, eq=False)
class LinkedParts(LightControl):
    """The links of a light to parts: it leaves the points of other parts dark.

    Departs: the paper's lights shine on all parts. Links to surfaces are no control but weights: see
    `shading.LightMix`. `is_lit` has an entry for each part number, and `numbers` are the part numbers of all
    points.
    """

    is_lit: Booleans
    numbers: PartNumbers

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> LinkedParts | None:
        """The links to parts, if the light has any."""
        if not light.links.depend_on_parts:
            return None
        names = points.parts.names
        lit = light.links.lit_parts(names)
        return cls(np.array([False, *(name in lit for name in names)]), points.parts.numbers)

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans:
        """Whether each point belongs to a part that is lit."""
        return self.is_lit.take(self.numbers[pixels])


CONTROLS: Final[tuple[type[LightControl], ...]] = (
    Concentration,
    Cone,
    Falloff,
    Sides,
    LinkedParts,
    SoftCone,
    SoftSides,
)
"""Every kind of control. Factors are multiplied, and rounded, in this order."""
