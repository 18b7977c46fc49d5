"""The top, front and side view of the light and view screen: from coordinates to positions, and back.

Paper: Figure 5, "By changing a position or direction in two of the three views, all three coordinates can be
quickly changed without having to enter numeric coordinate values". The three views share one scale, so that a
point has the same column or line in two of them.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple, TypeVar

import numpy as np

from autocolor.arrays import Floats, bounds_of
from autocolor.checks import LARGEST_COORDINATE, Vector
from autocolor.scene.orbit import target_of
from autocolor.scene.scene import Scene
from autocolor.widgets.items import Area, clipped
from autocolor.widgets.menu import WORK

# The areas of the views: the quarters of the work area.
#
# Assumed: as on an engineering drawing, the top view is above the front view, and the side view beside it.
# The fourth quarter is for DISPLAY VIEW.

_HIGH: Final = (WORK.height - 8) // 2
_FOOT: Final = WORK.top + _HIGH + 8

PICTURE_AREA: Final = Area(256, WORK.top, 503, WORK.top + _HIGH - 1)

LINES_BETWEEN: Final = (WORK._replace(left=251, right=252), Area(0, _FOOT - 5, WORK.right, _FOOT - 4))
"""The lines between the quarters."""

FILLED: Final = 0.84
"""Assumed: the fraction of an area that the coordinates fill, with 16 elements or more left on all sides."""

EDGE: Final = 8
"""Assumed: elements or lines between the edge of an area and the marks of points that are outside."""

FINEST: Final = 1e-11
"""Assumed: the least size of a pixel, as a fraction of the largest coordinate; 64 bits hold a hundredth."""

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


TOP: Final = ViewSide("top", 0, 1, (0.0, 0.0, 1.0), PICTURE_AREA._replace(left=0, right=247))
FRONT: Final = ViewSide("front", 0, 2, (0.0, -1.0, 0.0), Area(0, _FOOT, 247, _FOOT + _HIGH - 1))
SIDE: Final = ViewSide("side", 1, 2, (1.0, 0.0, 0.0), Area(256, _FOOT, 503, _FOOT + _HIGH - 1))

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
        across, down = element - self.place[0], line - self.place[1]
        return round(self.at[0] + self.ratio * across), round(self.at[1] + self.ratio * down)


Coordinate = TypeVar("Coordinate", float, Floats)


class OrthographicViews(NamedTuple):
    """The coordinates in the middle of every area, and the scale of all views, in elements for each unit."""

    center: Vector
    scale: float

    def position(
        self, side: ViewSide, point: tuple[Coordinate, Coordinate, Coordinate]
    ) -> tuple[Coordinate, Coordinate]:
        """The element and line of a point in one of the views, also outside its area."""
        element, line = side.area.middle
        return (
            element + (point[side.right] - self.center[side.right]) * self.scale,
            line - (point[side.up] - self.center[side.up]) * self.scale,
        )

    def positions(self, side: ViewSide, points: Floats) -> Floats:
        """The element and line of each point of (n, 3), (n, 2)."""
        x, y, z = points.T
        return np.stack(self.position(side, (x, y, z)), axis=1)

    def lines_through(self, side: ViewSide, point: Vector) -> tuple[Area, Area]:
        """The upright and the level line across a view through a point, which may be outside."""
        element, line = (round(place) for place in self.position(side, point))
        return side.area._replace(left=element, right=element), side.area._replace(top=line, bottom=line)

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
        _, _, element, line = clipped(np.array([(*to, *at)]), area)[0].tolist()
        way = math.dist(to, (element, line))
        return PointMark((element, line), at, math.dist(to, at) / way if way else 1.0)

    def placed(self, side: ViewSide, point: Vector, element: int, line: int) -> Vector:
        """The point moved to a pixel of a view, which gives it the two coordinates that the view shows.

        The third coordinate stays exactly, and so does a coordinate already at this element or line.
        Assumed: the coordinates are rounded to decimals that place them within a tenth of a pixel.
        """
        moved, axes = list(point), (side.right, side.up)
        places = zip((element, line), self.position(side, point), side.area.middle, strict=True)
        for axis, sign, (pixel, now, center) in zip(axes, (1, -1), places, strict=True):
            if abs(now - pixel) > 0.5:
                moved[axis] = self.rounded(self.center[axis] + sign * (pixel - center) / self.scale)
        return moved[0], moved[1], moved[2]

    def rounded(self, coordinate: float) -> float:
        """The coordinate, rounded to decimals that tell tenths of a pixel; 0 has no sign."""
        return round(coordinate, math.ceil(math.log10(5 * self.scale))) + 0.0

    def zoomed(self, ratio: float) -> OrthographicViews:
        """The views with a scale that is `ratio` times as large, nearer above 1, around the same center.

        A pixel is not larger than the largest coordinate, nor too small for coordinates to tell it from the
        next. Paper: Figure 5, RESCALE moves closer or farther away.
        """
        finest = max(1 / LARGEST_COORDINATE, FINEST * max(map(abs, self.center)))
        return self._replace(scale=min(max(self.scale * ratio, 1 / LARGEST_COORDINATE), 1 / finest))

    def panned(self, side: ViewSide, elements: float, lines: float) -> OrthographicViews:
        """The views of the same scale, moved so that every point of a view moves by elements and lines."""
        center = list(self.center)
        center[side.right] -= elements / self.scale
        center[side.up] += lines / self.scale
        return self._replace(center=(center[0], center[1], center[2])).zoomed(1)


def fitted_views(points: Floats) -> OrthographicViews:
    """The views that show all points, (n, 3), with one scale, and space left on all sides.

    A single point has a unit of space around it. Paper: Figure 5, RESCALE rescales the views "based on the
    maximum coordinate values to leave a reasonable amount of space on all sides".
    """
    low, high = bounds_of(points)
    x, y, z = (low + (high - low) / 2).tolist()
    extent = high - low if (high > low).any() else np.ones(3)
    # The top view has the least room for y.
    room = np.array([TOP.area.width, TOP.area.height, TOP.area.height]) - 1
    with np.errstate(divide="ignore"):
        scale = float((FILLED * room / extent).min())
    return OrthographicViews((x, y, z), 1.0).zoomed(scale)


def shown_points(scene: Scene) -> Floats:
    """The points to show of a whole scene, (n, 3): object, eye and target, lights and their aims.

    Lights that are switched off count, too. A stage, such as a floor, does not: it would make the object
    small, and is drawn as far as it is within the views.
    """
    lights = scene.lights_in_world
    places = [light.position for light in lights] + [light.aim for light in lights if light.aim is not None]
    return np.array([*scene.object_bounds, scene.view.eye, target_of(scene), *places])
