"""The marks of the eye in the three views: an eye, its view direction, and the edges of the picture.

Paper: Figure 5, "Each view shows the eye position and view direction". Assumed: the edges of the picture
are shown too.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.view import View
from autocolor.screens.light_and_view.areas import PICTURE_ASPECT
from autocolor.screens.light_and_view.arrows import arrow
from autocolor.screens.light_and_view.orthographic_views import OrthographicViews, Side
from autocolor.widgets.strokes import between, clipped, joined, together

LIDS: Final = np.array([(-7, 0), (-3, -3), (3, -3), (7, 0), (3, 3), (-3, 3), (-7, 0)], np.float64)
PUPIL: Final = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)], np.float64)
"""The eye: positions relative to its own, joined by strokes."""


class EyeMarks(NamedTuple):
    """The strokes of the eye, of the arrow to its target, and of the edges of the picture, each (n, 4)."""

    eye: Floats
    direction: Floats
    picture: Floats


def eye_marks(
    views: OrthographicViews, side: Side, view: View, target: Vector, aspect: float = PICTURE_ASPECT
) -> EyeMarks:
    """The marks of a view in one of the three, clipped by its area.

    `target` is the point at which the arrow ends: that of the view, or one in its direction. `aspect` is the
    width of the picture over its height. The picture is drawn as deep as the target: a pyramid with the eye
    as its top.
    """
    at = views.position(side, view.eye)
    corners = views.positions(side, picture_corners(view, target, aspect))
    picture = together([between(np.broadcast_to(at, (4, 2)), corners), joined([*corners, corners[0]])])
    eye = together([joined(LIDS + at), joined(PUPIL + at)])
    direction = arrow(at, views.position(side, target))
    return EyeMarks(*(clipped(strokes, side.area) for strokes in (eye, direction, picture)))


def picture_corners(view: View, target: Vector, aspect: float = PICTURE_ASPECT) -> Floats:
    """The points that are seen at the corners of the picture, (4, 3), as deep as a point before the eye.

    They run around the picture from the upper left corner.
    """
    right, down, forward = view.axes
    depth = float(forward @ (np.array(target) - np.array(view.eye)))
    half = math.tan(math.radians(view.field_of_view) / 2)
    rays = [forward + half * (aspect * x * right + y * down) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return np.array(view.eye) + depth * np.array(rays)
