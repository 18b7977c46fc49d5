"""The outline of a light's cone as it is seen in one of the three views.

The cone is drawn as far as the end of the arrow: its rim is a circle of points at that distance from the
light. Seen from the side its outline is two lines, from the light to where they touch the rim; seen along the
axis, from within the cone, it is the rim alone, an ellipse.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.lights.light import Light
from autocolor.screens.light_and_view.orthographic_views import OrthographicViews, Side

RIM_SIDES: Final = 36
"""Assumed: strokes of an ellipse."""


def cone_outline(views: OrthographicViews, side: Side, light: Light, end: Vector) -> tuple[Floats, ...]:
    """The outline of the cone of a light that has one, as polylines, each (positions, 2).

    `end` is the end of its arrow. A cone of more than 90 degrees opens behind the light, and one of 180 holds
    everything and has no outline.

    In the view, the rim is an ellipse whose half axes are r |cos F| along the axis of the cone and r across
    it, at the distance l sin F from the light: F is the angle between the axis and the direction of looking,
    l and r are the height of the cone and the radius of its rim. The tangents from the light to it exist
    where F is larger than the cone angle.
    """
    assert light.cone_angle is not None
    assert light.axis is not None
    if light.cone_angle == 180:
        return ()
    angle = math.radians(light.cone_angle)
    slant = math.dist(end, light.position)
    height, radius = slant * math.cos(angle), slant * math.sin(angle)
    axis, position = np.array(light.axis), np.array(light.position)

    across = np.array([axis[side.right], axis[side.up]])
    sine, cosine = float(np.hypot(*across)), float(abs(axis @ np.array(side.toward)))
    distance, half = height * sine, radius * cosine
    if abs(distance) <= half:
        turns = np.linspace(0, 2 * math.pi, RIM_SIDES + 1)
        one, other = _perpendicular(axis)
        rim = np.cos(turns)[:, None] * one + np.sin(turns)[:, None] * other
        return (views.positions(side, position + height * axis + radius * rim),)

    # The tangents touch the ellipse on the polar line of the light.
    touching = distance - half * half / distance
    beside = radius * math.sqrt(1 - (half / distance) ** 2)
    forward = across / sine
    left = np.array([-forward[1], forward[0]])
    lines = []
    for sign in (1, -1):
        flat = touching * forward + sign * beside * left
        point = position.copy()
        point[[side.right, side.up]] += flat
        lines.append(views.positions(side, np.stack([position, point])))
    return tuple(lines)


def _perpendicular(axis: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors that are perpendicular to a unit vector and to each other."""
    one = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    one /= np.linalg.norm(one)
    return one, np.cross(axis, one)
