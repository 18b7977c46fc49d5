"""The controls of a light beside its concentration and cone: soft cones, flaps, half-spaces, falloff, links.

Paper: "Light Controls". A control leaves a share of the light, 0 to 1, and knows nothing of the reflection
model. The shares of all controls are multiplied; see `light.shares_of`. To add a control, give `Light` a
field with its column, write its function here, and name its share there.
"""

from __future__ import annotations

import math
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from autocolor.arrays import ROUNDING, Booleans, Floats, RealArray, Singles, unit_vector
from autocolor.checks import Vector
from autocolor.scene.following import detached
from autocolor.scene.lights import Flap, Light
from autocolor.visibility.visible_points import POINT, VisiblePoints

FARTHEST: Final = 1e15
"""The largest distance of a plane or a light, in units, farther than any point.

The rays of such a light are parallel, and float32 can hold the square of the distance."""

LEAST_LENGTH: Final = 1e-20
"""The least edge width and reach, in units: far below the rounding of points, and float32 holds any quotient
by it."""


def soften(fraction: RealArray[Any]) -> RealArray[Any]:
    """The share of the light at a fraction t of the width of a soft edge.

    It is 0 up to t = 0, 1 from t = 1 on, and t^2 (3 - 2 t) between. Assumed: this is the polynomial of the
    lowest degree that begins and ends with a slope of 0, so that neither end shows as a seam. Fractions must
    be finite.
    """
    t: RealArray[Any] = np.clip(fraction, 0, 1)
    share: RealArray[Any] = t * ((3 - 2 * t) * t)
    return share


def soft_cone_share(cos_light: RealArray[Any], inner_angle: float, cone_angle: float) -> RealArray[Any]:
    """All of the light up to the inner angle, and nothing from the cone angle on; see `soften`.

    Departs: a cone may have a soft edge; the paper's cones are sharp. Assumed: between the angles the share
    depends on cos(L), not on L. So no pixel needs an arc cosine, and a share with an inner angle of 0 is
    smooth on the axis: there cos(L) has a slope of 0, and L a corner.
    """
    kind = cos_light.dtype.type
    # Rounded like the cosines that it is subtracted from.
    rim = kind(math.cos(math.radians(cone_angle)))
    width = max(math.cos(math.radians(inner_angle)) - float(rim), float(np.finfo(kind).eps))
    return soften((cos_light - rim) * kind(1 / width))


def falloff_share(light: Light, reach: float, length: RealArray[Any]) -> RealArray[Any]:
    """(1 - f)^n at the distance f as a fraction of the reach, n = 1 or 2, and 0 beyond it.

    Departs: a light may decrease with the distance; the paper's lights do not. Rejected: 1/d^2, which has no
    upper limit. A point close to the light would take the whole range of levels and leave all others black.
    This falloff stays within 0 to 1, and ends.
    """
    left: RealArray[Any] = np.maximum(1 - length / length.dtype.type(reach), 0)
    return left if light.falloff == "linear" else left * left


def reach_of(light: Light, points: VisiblePoints) -> float | None:
    """The reach of a light with a falloff, in the unit of some points; None without."""
    if light.falloff == "none" or light.reach is None:
        return None
    return min(max(light.reach / points.unit, LEAST_LENGTH), FARTHEST)


# Flaps and half-spaces.

Axis = Literal["x", "y", "z"]
"""The object coordinate that a flap restricts."""

FlapEnd = Literal["minimum", "maximum"]
"""The fields of a flap that are coordinates."""


class Plane(NamedTuple):
    """The plane of a half-space, by its name."""

    half_space: str


class LitSide(NamedTuple):
    """The lit side of a plane: the points P where the product of `row`, (4,), with (P, 1) is at least 0.

    Paper: "Light Flaps and Cones": a flap is a range of an object coordinate, a box and no shadow. Departs:
    flaps may lie along any plane and have a soft edge; the paper's lie along the axes and are sharp.

    The product is the distance from the plane. From the distance `edge_width` on, all of the light is left.
    Both are in `VisiblePoints.unit`. An edge of the width 0 is sharp: a point on its plane is lit. `name` is
    that of the control: "flap x" or "half-space door".
    """

    name: str
    row: Floats
    edge_width: float


def edge_share(side: LitSide, points: RealArray[Any]) -> RealArray[Any]:
    """The share that an edge leaves at some points, (3, k): none on its plane, all from its width on."""
    if side.edge_width == 0:
        return is_inside(side, points).astype(points.dtype)
    row = (side.row / max(side.edge_width, LEAST_LENGTH)).astype(points.dtype)
    return soften(row[:3] @ points + row[3])


def is_inside(side: LitSide, points: RealArray[Any]) -> Booleans:
    """Whether each of some points, (3, k), is on the lit side of a plane, or on the plane itself."""
    row = side.row.astype(points.dtype)
    inside: Booleans = row[:3] @ points >= -row[3]
    return inside


def flaps_of(light: Light) -> dict[Axis, Flap | None]:
    """The flap of a light along each axis, on or off; None where there is none."""
    return {"x": light.flaps.x, "y": light.flaps.y, "z": light.flaps.z}


def sides_of(light: Light, points: VisiblePoints) -> dict[tuple[Axis, FlapEnd] | Plane, LitSide]:
    """The sides of the flaps and the half-spaces of a light that are on, without ends at infinity.

    A carried half-space is placed with its light.
    """
    sides: dict[tuple[Axis, FlapEnd] | Plane, LitSide] = {}
    for number, (axis, flap) in enumerate(flaps_of(light).items()):
        if flap is None or not flap.on:
            continue
        ends: dict[FlapEnd, float] = {"minimum": flap.minimum, "maximum": flap.maximum}
        for end, limit in ends.items():
            if math.isfinite(limit):
                sign = 1.0 if end == "minimum" else -1.0
                x, y, z = (sign if row == number else 0.0 for row in range(3))
                sides[axis, end] = side_of(points, f"flap {axis}", (x, y, z), sign * limit, flap.edge_width)
    for half_space in light.half_spaces:
        if half_space.on:
            placed = detached(half_space, light)
            direction = unit_vector(placed.direction)
            least = sum(a * b for a, b in zip(direction, placed.point, strict=True))
            name = f"half-space {half_space.name}"
            sides[Plane(half_space.name)] = side_of(points, name, direction, least, half_space.edge_width)
    return sides


def side_of(points: VisiblePoints, name: str, direction: Vector, least: float, edge_width: float) -> LitSide:
    """The side of a plane of the world whose points have a product of at least `least` with a unit vector.

    The unit vector is the `direction` from the plane into the light. `edge_width` is in world units.
    """
    coordinates = np.array([points.world_coordinate(axis) for axis in range(3)])
    in_units = min(max(least / points.unit, -FARTHEST), FARTHEST)
    # A surface that lies on a sharp side is lit: allow for the rounding of its points to float32.
    slack = 0.0 if edge_width > 0 else 4 * ROUNDING * points.largest_distance
    row = np.array(direction) @ coordinates - (np.array([0, 0, 0, in_units]) - slack)
    return LitSide(name, row, edge_width / points.unit)


def lit_points(
    light: Light, sides: tuple[LitSide, ...], points: VisiblePoints, rows: Singles, pixels: slice
) -> Booleans | None:
    """Whether each of some points is within all sharp sides and of a linked part; None for all of them.

    `rows` are the columns `pixels` of `VisiblePoints.rows`. Links to surfaces are weights: see
    `shading.LightMix`.
    """
    masks = [is_inside(side, rows[POINT]) for side in sides if side.edge_width == 0]
    if light.links.depend_on_parts:
        names = points.parts.names
        lit = light.links.lit_parts(names)
        is_lit = np.array([False, *(name in lit for name in names)])
        masks.append(is_lit.take(points.parts.numbers[pixels]))
    return np.logical_and.reduce(masks) if masks else None
