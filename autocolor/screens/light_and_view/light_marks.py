"""The marks of a light in the three views: its cross, the arrow to its aim, its cone and its flaps.

Paper: Figure 5, "the position and direction of each light. Point source lights would be shown with only a
cross at the light position".
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.lights.light import Light
from autocolor.screens.light_and_view.arrows import arrow
from autocolor.screens.light_and_view.cone_outline import cone_outline
from autocolor.screens.light_and_view.orthographic_views import OrthographicViews, Side
from autocolor.widgets.strokes import clipped, joined, together

CROSS: Final = np.array([(-4, 0, 4, 0), (0, -4, 0, 4)], np.float64)
"""The cross: strokes relative to its position."""

DIRECTION_LENGTH: Final = 40.0
"""Assumed: how long the arrow of a light with a direction and no aim is, in elements."""


class LightMarks(NamedTuple):
    """The strokes of the cross, the arrow and the cone of a light, each (n, 4); n = 0 for what it lacks."""

    cross: Floats
    arrow: Floats
    cone: Floats


class FlapMark(NamedTuple):
    """The line of one end of a flap: its axis, 0 to 2, its end, whether it is on, and its stroke, (1, 4)."""

    axis: int
    end: str
    on: bool
    stroke: Floats


def arrow_end(views: OrthographicViews, light: Light) -> Vector | None:
    """The point at which the arrow of a light ends: its aim, or one in its direction; None without either."""
    if light.aim is not None or light.axis is None:
        return light.aim
    x, y, z = light.position
    length = DIRECTION_LENGTH / views.scale
    return x + length * light.axis[0], y + length * light.axis[1], z + length * light.axis[2]


def light_marks(views: OrthographicViews, side: Side, light: Light) -> LightMarks:
    """The marks of a light in one of the views, clipped by its area; the flaps are marked on their own."""
    at = views.position(side, light.position)
    end = arrow_end(views, light)
    shaft = cone = np.empty((0, 4))
    if end is not None:
        shaft = arrow(at, views.position(side, end))
        if light.cone_angle is not None:
            cone = together([joined(each) for each in cone_outline(views, side, light, end)])
    cross = CROSS + np.tile(at, 2)
    return LightMarks(*(clipped(strokes, side.area) for strokes in (cross, shaft, cone)))


def flap_marks(views: OrthographicViews, side: Side, light: Light) -> tuple[FlapMark, ...]:
    """The ends of a light's flaps that one of the views shows, as lines across its area.

    A view shows the flaps of the two coordinates that it shows. An end at infinity has no line, nor has one
    outside of the area. Paper: Figure 9.
    """
    area, marks = side.area, []
    for axis in (side.right, side.up):
        flap = (light.flaps.x, light.flaps.y, light.flaps.z)[axis]
        if flap is None:
            continue
        for end, value in (("minimum", flap.minimum), ("maximum", flap.maximum)):
            if not math.isfinite(value):
                continue
            element, line = views.position(side, (value, value, value))
            if axis == side.right:
                ends: list[tuple[float, float]] = [(element, area.top), (element, area.bottom)]
            else:
                ends = [(area.left, line), (area.right, line)]
            stroke = clipped(joined(ends), area)
            if len(stroke):
                marks.append(FlapMark(axis, end, flap.on, stroke))
    return tuple(marks)
