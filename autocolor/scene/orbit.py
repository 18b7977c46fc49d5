"""Views of a scene with the eye moved: around the object, closer, beside it, or to a side of the object.

An eye above a stage stays above it. The sides of the object have names.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.arrays import Floats, underflowing
from autocolor.checks import Vector
from autocolor.scene.defaults import FILLED, default_view, framed, sphere_around, stage_top
from autocolor.scene.scene import Scene
from autocolor.scene.stage import NONE, shape_of
from autocolor.scene.view import ASPECT, Polar, View

HIGHEST: Final = 85.0
"""Assumed: the largest elevation in degrees; closer to the vertical, a small step would spin the picture."""

ABOVE_STAGE: Final = 0.01
"""Assumed: how far an eye stays above the stage, as a part of its distance from the target."""

SIDE_NAMES: Final = ("front", "left", "back", "right")
"""The sides of an object whose front is known. Left and right are the object's own."""


def front_of(scene: Scene) -> tuple[float, float]:
    """The direction toward which the object faces; -y, as on an engineering drawing, if that is not known."""
    front = scene.front or "-y"
    sign = -1.0 if front.startswith("-") else 1.0
    return (sign, 0.0) if front.endswith("x") else (0.0, sign)


def sides_of(scene: Scene) -> dict[str, Vector | None]:
    """The directions toward the eye of the views from the sides, in the order of their keys.

    Three quarters, which is None, is the direction of a created view, turned with the front.
    Assumed: as on an engineering drawing, x is to the right and z up in the view from -y, y to the right and
    z up in the view from x, x to the right and y up in the top view.
    """
    x, y = front_of(scene)
    ring = ((x, y, 0.0), (0.0 - y, x, 0.0), (0.0 - x, 0.0 - y, 0.0), (y, 0.0 - x, 0.0))
    names = [f"from {'-' if x + y < 0 else ''}{'x' if x else 'y'}" for x, y, _ in ring]
    front, left, back, right = zip(SIDE_NAMES if scene.front else names, ring, strict=True)
    return dict([front, left, back, ("top", (0.0, 0.0, 1.0)), ("three quarters", None), right])


def side_name(scene: Scene, toward_eye: Vector) -> str:
    """The name of the view from a direction along an axis."""
    return next(name for name, toward in sides_of(scene).items() if toward == toward_eye)


def turned(scene: Scene, right: float, up: float) -> View:
    """The view with the eye moved around the target by degrees to the right and up, at the same distance."""
    target = target_of(scene)
    azimuth, before, distance = scene.view.polar(target)
    lowest = min(1.0, max(-1.0, (lowest_eye(scene) - target[2]) / distance))
    elevation = max(-HIGHEST, min(HIGHEST, before + up))
    elevation = max(elevation, min(before, math.degrees(math.asin(lowest))))
    # At the highest and lowest elevation, rounding would make a slightly different view.
    if up and math.isclose(elevation, before, abs_tol=1e-7):
        return scene.view
    eye = Polar(azimuth + right, elevation, distance).from_point(target)
    return scene.view.replace(eye=eye, target=target)


def lowest_eye(scene: Scene) -> float:
    """The least z coordinate that the eye may move to; minus infinity for an eye not above a stage."""
    mesh, parts, eye = scene.mesh, scene.parts, scene.view.eye
    top = stage_top(mesh, parts)
    if scene.stage != NONE:
        top = max(top, shape_of(mesh, parts).floor)
    if eye[2] <= top:
        return -math.inf
    return min(eye[2], top + ABOVE_STAGE * math.dist(eye, target_of(scene)))


def moved(scene: Scene, ratio: float) -> View:
    """The view with the distance of the eye from the target multiplied by a ratio.

    At the stage, the eye slides along it.
    """
    target = np.array(target_of(scene))
    eye = target + (np.array(scene.view.eye) - target) * ratio
    eye[2] = max(eye[2], lowest_eye(scene))
    return scene.view.replace(eye=_vector(eye))


def panned(scene: Scene, right: float, down: float, lines: int, elements: int) -> View:
    """The view moved sideways, so that the target point moves by elements and lines in the picture.

    `lines` and `elements` are the size of the picture.
    """
    view, target = scene.view, np.array(target_of(scene))
    eye = np.array(view.eye)
    axes = view.axes
    depth = float((target - eye) @ axes[2])
    step = depth * view.half_height(elements / lines) * 2 / lines
    shift = -step * (right * axes[0] + down * axes[1])
    missing = lowest_eye(scene) - float(eye[2] + shift[2])
    if missing > 0:
        # The steepest direction in the picture plane: only a shift along it changes the height.
        steepest = np.array([0.0, 0.0, 1.0]) - axes[2, 2] * axes[2]
        shift += steepest * missing / steepest[2]
    return view.replace(eye=_vector(eye + shift), target=_vector(target + shift))


def seen_from(scene: Scene, side: str) -> View:
    """The upright view of the object from a side of `sides_of`, in which it fills the picture."""
    toward_eye = sides_of(scene)[side]
    if toward_eye is None:
        right, toward, up = (-default_view(scene.object_coordinates).axes[2]).tolist()
        x, y = front_of(scene)
        toward_eye = (-right * y - toward * x, right * x - toward * y, up)
    # The angle is 0, so that the view is upright, as on a drawing.
    view = scene.view.replace(eye=toward_eye, direction=None, target=(0.0, 0.0, 0.0), angle=0.0)
    return framed(view, scene.object_coordinates)


@underflowing
def around(scene: Scene, count: int, aspect: float = ASPECT) -> tuple[View, ...]:
    """Views from a number of eyes around the object, all at the least distance from which it always fits.

    The eyes look at the middle of the object. They have the elevation of the scene's view, and begin at its
    azimuth, at equal angles counterclockwise as seen from above. An eye above a stage stays above it.
    `aspect` is the width of the picture over its height.
    """
    low, high = scene.object_bounds
    middle, radius = sphere_around(np.array(low), np.array(high))
    target = _vector(middle)
    azimuth, elevation, _ = scene.view.polar(target)
    elevation = min(HIGHEST, max(elevation, 0.0 if lowest_eye(scene) > -math.inf else -HIGHEST))
    slope = FILLED * scene.view.half_height(aspect)
    distance, views = radius, []
    for turn in np.linspace(0, 360, count, endpoint=False).tolist():
        away = Polar(azimuth + turn, elevation, radius).from_point((0.0, 0.0, 0.0))
        # A point fits if |x| <= slope * aspect * (depth + distance), and likewise for y.
        view = scene.view.replace(eye=away, target=(0.0, 0.0, 0.0))
        x, y, depth = view.axes @ (scene.object_coordinates - middle).T
        reach = np.maximum(np.abs(x) / (slope * aspect), np.abs(y) / slope) - depth
        distance = max(distance, float(reach.max()))
        views.append(view)
    return tuple(
        view.replace(eye=_vector(middle + distance / radius * np.array(view.eye)), target=target)
        for view in views
    )


def target_of(scene: Scene) -> Vector:
    """The point to orbit: the view's target, else the point on the line of sight at the object's depth."""
    return scene.view.orbit_target(*scene.object_bounds)


def _vector(values: Floats) -> Vector:
    return (float(values[0]), float(values[1]), float(values[2]))
