"""The top, front and side view of the light and view screen: from coordinates to positions, and back.

Paper: Figure 5, "By changing a position or direction in two of the three views, all three coordinates can be
quickly changed without having to enter numeric coordinate values". The three views share one scale, so that a
point has the same column or line in two of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, bounds_of
from autocolor.checks import LARGEST_COORDINATE, Vector
from autocolor.scene.defaults import object_bounds
from autocolor.scene.scene import Scene
from autocolor.screens.picture.picture_edits import target_of
from autocolor.widgets.items import Area

# The areas of the views on the light and view screen.

PICTURE_ASPECT: Final = 640 / 480
"""The width of a picture over its height. Paper: Figure 11, 640 x 480."""


TOP_AREA: Final = Area(0, 16, 247, 235)
PICTURE_AREA: Final = Area(256, 16, 503, 235)
FRONT_AREA: Final = Area(0, 244, 247, 463)
SIDE_AREA: Final = Area(256, 244, 503, 463)
"""The quarters of a work area of 504 x 464, on a grid of 8.

Assumed: as on an engineering drawing, the top view is above the front view, and the side view beside it. The
fourth quarter is for DISPLAY VIEW. Eight lines are left free at the bottom.
"""

LINES_BETWEEN: Final = (Area(251, 16, 252, 463), Area(0, 239, 503, 240))
"""The lines between the quarters."""


def area_of_picture(area: Area = PICTURE_AREA, aspect: float = PICTURE_ASPECT) -> Area:
    """The largest area of the shape of a picture in the middle of an area.

    >>> area_of_picture(Area(256, 16, 503, 235))
    Area(left=256, top=33, right=503, bottom=218)
    """
    width = min(area.width, round(area.height * aspect))
    height = min(area.height, round(area.width / aspect))
    left, top = area.left + (area.width - width) // 2, area.top + (area.height - height) // 2
    return Area(left, top, left + width - 1, top + height - 1)


FILLED: Final = 0.84
"""Assumed: the fraction of an area that the coordinates fill, with 16 elements or more left on all sides."""

EDGE: Final = 8
"""Assumed: elements or lines between the edge of an area and the marks of points that are outside."""

POINT: Final = 1e-9
"""Assumed: points closer than this fraction of the largest coordinate are the same point."""

FINEST: Final = 1e-11
"""Assumed: the least size of a pixel, as a fraction of the largest coordinate; 64 bits hold a hundredth."""

COARSEST: Final = 1e30
"""Assumed: the largest size of a pixel, in units: the size of the largest coordinate."""

SMALLEST: Final = 1e-30
"""Assumed: the least size of a pixel, in units."""


AXES: Final = "xyz"
"""The names of the axes."""


class ViewSide(NamedTuple):
    """One of the three views: the axes that run to the right and up, and its area.

    Axes are 0 to 2 for x, y and z; `toward` is the unit vector to the viewer, who looks along its reverse.
    """

    name: str
    right: int
    up: int
    toward: Vector
    area: Area


TOP: Final = ViewSide("top", 0, 1, (0.0, 0.0, 1.0), TOP_AREA)
FRONT: Final = ViewSide("front", 0, 2, (0.0, -1.0, 0.0), FRONT_AREA)
SIDE: Final = ViewSide("side", 1, 2, (1.0, 0.0, 0.0), SIDE_AREA)

SIDES: Final = (TOP, FRONT, SIDE)
"""The three views. Assumed: x to the right and y up, x to the right and z up, y to the right and z up."""


def side_at(element: float, line: float) -> ViewSide | None:
    """The view in whose area a place is; None beside them."""
    return next((side for side in SIDES if side.area.has(element, line)), None)


class PointMark(NamedTuple):
    """The mark of a point in a view: its element and line, and those of the point, `at`.

    They differ if the point is outside. It is `ratio` times as far from the end of its arrow as the mark is.
    """

    place: tuple[float, float]
    at: tuple[float, float]
    ratio: float = 1.0

    @property
    def is_outside(self) -> bool:
        """Whether the mark is an arrow at the edge."""
        return self.place != self.at

    def dragged(self, element: int, line: int) -> tuple[int, int]:
        """Where the point goes if the mark goes to a pixel: as many times as far as the point is farther."""
        to = (element, line)
        across, down = (
            round(at + self.ratio * (now - place))
            for at, place, now in zip(self.at, self.place, to, strict=True)
        )
        return across, down


@dataclass(frozen=True)
class OrthographicViews:
    """The coordinates in the middle of every area, and the scale of all views, in elements for each unit."""

    center: Vector
    scale: float

    def positions(self, side: ViewSide, points: Floats) -> Floats:
        """The element and line of each point of (n, 3) in one of the views, (n, 2), also outside its area."""
        element, line = side.area.middle
        positions = np.empty((len(points), 2))
        positions[:, 0] = element + (points[:, side.right] - self.center[side.right]) * self.scale
        positions[:, 1] = line - (points[:, side.up] - self.center[side.up]) * self.scale
        return positions

    def position(self, side: ViewSide, point: Vector) -> tuple[float, float]:
        """The element and line of one point."""
        element, line = side.area.middle
        return (
            element + (point[side.right] - self.center[side.right]) * self.scale,
            line - (point[side.up] - self.center[side.up]) * self.scale,
        )

    def mark(self, side: ViewSide, point: Vector, end: Vector | None) -> PointMark:
        """The mark of a point: at its position, or at the edge of the area for a point outside.

        The mark of a point outside is where the line to `end`, the end of its arrow, comes into the area.
        Without an arrow, the line leads to the middle of the area. Assumed: so that the lights and the eye
        can be found and dragged when the views are as near as the object needs.
        """
        at = self.position(side, point)
        if side.area.has(*at):
            return PointMark(at, at)
        area = side.area.inset(EDGE)
        to = area.middle if end is None else self.position(side, end)
        if not area.has(*to):
            to = area.middle
        step = at[0] - to[0], at[1] - to[1]
        # On the way from `to`, the nearest edge counts.
        share = min(
            ((high if along > 0 else low) - start) / along
            for start, along, low, high in zip(to, step, area[:2], area[2:], strict=True)
            if along
        )
        return PointMark((to[0] + share * step[0], to[1] + share * step[1]), at, 1 / share if share else 1.0)

    def placed(self, side: ViewSide, point: Vector, element: int, line: int) -> Vector:
        """The point moved to a pixel of a view, which gives it the two coordinates that the view shows.

        The third coordinate stays exactly, and so does a coordinate already at this element or line.
        Assumed: the coordinates are rounded to decimals that place them within a tenth of a pixel.
        """
        middle = side.area.middle
        present = self.position(side, point)
        moved = list(point)
        for axis, sign, picked, center, now in (
            (side.right, 1.0, element, middle[0], present[0]),
            (side.up, -1.0, line, middle[1], present[1]),
        ):
            if abs(now - picked) > 0.5:
                moved[axis] = self.rounded(self.center[axis] + sign * (picked - center) / self.scale)
        return (moved[0], moved[1], moved[2])

    def rounded(self, coordinate: float) -> float:
        """The coordinate, bounded and rounded to decimals that tell tenths of a pixel; 0 has no sign."""
        rounded = round(coordinate, math.ceil(math.log10(5 * self.scale))) + 0.0
        return max(-LARGEST_COORDINATE, min(LARGEST_COORDINATE, rounded))

    def zoomed(self, ratio: float) -> OrthographicViews:
        """The views with a scale that is `ratio` times as large, nearer above 1, around the same center.

        Paper: Figure 5, RESCALE moves closer or farther away.
        """
        return OrthographicViews(self.center, _scale_within(self.scale * ratio, self.center))

    def centered(self, point: Sequence[float]) -> OrthographicViews:
        """The views of the same scale with a point in the middle of every area."""
        center = (float(point[0]), float(point[1]), float(point[2]))
        return replace(self, center=center, scale=_scale_within(self.scale, center))


def fitted_views(points: Floats) -> OrthographicViews:
    """The views that show all points, (n, 3), with one scale, and space left on all sides.

    The points are those of the object, or of a part, and of the eye, the lights and their aims. A single
    point has a unit of space around it. Paper: Figure 5, RESCALE rescales the views "based on the maximum
    coordinate values to leave a reasonable amount of space on all sides".
    """
    low, high = bounds_of(points)
    center, extent = low + (high - low) / 2, high - low
    largest = float(np.abs([low, high]).max())
    if float(extent.max()) <= POINT * largest or not extent.any():
        extent = np.full(3, max(1.0, 1e3 * POINT * largest))
    scales = [
        FILLED * (room - 1) / float(extent[axis])
        for side in SIDES
        for axis, room in ((side.right, side.area.width), (side.up, side.area.height))
        if extent[axis] > 0
    ]
    middle = (float(center[0]), float(center[1]), float(center[2]))
    return OrthographicViews(middle, _scale_within(min(scales), middle))


def _scale_within(scale: float, center: Vector) -> float:
    """The scale within bounds: pixels are not too large, nor too small for coordinates to tell apart."""
    finest = max(SMALLEST, FINEST * max(map(abs, center)))
    return min(max(scale, 1 / COARSEST), 1 / finest)


# The points of a scene that the three views show when they are fitted to the whole scene.


def shown_points(scene: Scene) -> Floats:
    """The ends of the object's bounding box, the eye and its target, and the lights and aims, (n, 3).

    Lights that are switched off count, too. A stage, such as a floor, does not: it would make the object
    small, and is drawn as far as it is within the views.
    """
    points = [*object_bounds(scene.mesh, scene.parts), np.array(scene.view.eye), np.array(target_of(scene))]
    for light in scene.lights_in_world:
        points.append(np.array(light.position))
        if light.aim is not None:
            points.append(np.array(light.aim))
    return np.array(points)
