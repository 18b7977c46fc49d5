"""Orbiting: views with the eye moved around its target, closer to it, farther away or beside it.

Some views have names: those from the sides of the object.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.defaults import default_view, framed, object_bounds
from autocolor.scene.scene import Scene
from autocolor.scene.view import View

HIGHEST: Final = math.radians(85)
"""Assumed: the largest elevation; closer to the vertical, a small step would spin the picture."""

SIDES: Final[dict[str, Vector | None]] = {
    "front": (0.0, -1.0, 0.0),
    "side": (1.0, 0.0, 0.0),
    "back": (0.0, 1.0, 0.0),
    "top": (0.0, 0.0, 1.0),
    "three quarters": None,
}
"""The directions toward the eye of the named views; that of three quarters is the one of a created view.

Assumed: as on an engineering drawing, x is to the right and z up in the front view, y to the right and z up
in the side view, x to the right and y up in the top view.
"""


def turned(scene: Scene, right: float, up: float) -> View:
    """The view with the eye moved around the target by degrees to the right and up, at the same distance."""
    target = target_of(scene)
    away = np.array(scene.view.eye) - target
    distance = float(np.linalg.norm(away)) or 1.0
    azimuth = _azimuth(scene.view, away) + math.radians(right)
    before = math.asin(max(-1.0, min(1.0, float(away[2]) / distance)))
    elevation = max(-HIGHEST, min(HIGHEST, before + math.radians(up)))
    # At the highest elevation, rounding would make a slightly different view.
    if up and math.isclose(elevation, before, abs_tol=1e-9):
        return scene.view
    horizontal = math.cos(elevation)
    eye = target + distance * np.array(
        [horizontal * math.cos(azimuth), horizontal * math.sin(azimuth), math.sin(elevation)]
    )
    return scene.view.replace(eye=_vector(eye), target=_vector(target))


def _azimuth(view: View, away: Floats) -> float:
    """The azimuth of the eye as seen from the target; for a vertical view, from the picture's axes."""
    if math.hypot(away[0], away[1]) < 1e-9 * abs(away[2]):
        # The picture's bottom points to the side of a lower eye; seen from below, its top does.
        toward = view.axes[1] if away[2] > 0 else -view.axes[1]
        return math.atan2(toward[1], toward[0])
    return math.atan2(away[1], away[0])


def moved(scene: Scene, ratio: float) -> View:
    """The view with the distance of the eye from the target multiplied by a ratio."""
    target = target_of(scene)
    return scene.view.replace(eye=_vector(target + (np.array(scene.view.eye) - target) * ratio))


def panned(scene: Scene, right: float, down: float, lines: int) -> View:
    """The view moved sideways, so that what is at the target moves by elements and lines in the picture.

    `lines` is the number of lines of the picture.
    """
    view, target = scene.view, target_of(scene)
    eye = np.array(view.eye)
    axes = view.axes
    depth = float((target - eye) @ axes[2])
    step = 2 * depth * math.tan(math.radians(view.field_of_view) / 2) / lines
    shift = -step * (right * axes[0] + down * axes[1])
    return view.replace(eye=_vector(eye + shift), target=_vector(target + shift))


def seen_from(scene: Scene, side: str) -> View:
    """A view of the object from one of `SIDES`, in which it fills the picture."""
    toward_eye = SIDES[side]
    if toward_eye is None:
        toward_eye = default_view(scene.object_coordinates).axes[2] * -1
    view = View(_vector(np.array(toward_eye)), target=(0.0, 0.0, 0.0), field_of_view=scene.view.field_of_view)
    return framed(view, scene.object_coordinates)


def target_of(scene: Scene) -> Floats:
    """The point to orbit: the view's target, else the point of the line of sight as deep as the object."""
    view = scene.view
    if view.target is not None:
        return np.array(view.target)
    low, high = object_bounds(scene.mesh, scene.parts)
    eye = np.array(view.eye)
    forward = view.axes[2]
    depth = float(((low + high) / 2 - eye) @ forward)
    least = float(np.linalg.norm(high - low)) / 2 or 1.0
    return np.asarray(eye + forward * max(depth, least))


def _vector(values: Floats) -> Vector:
    return (float(values[0]), float(values[1]), float(values[2]))
