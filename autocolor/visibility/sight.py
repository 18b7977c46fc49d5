"""The sight: what the pixels of a display see of a scene, and what is seen at one of them.

It is called at each movement of the pointer. Measured on the coupe: 0.1 ms, most of it for finding the pixel
among the visible points; a raster of their places would take 1.2 MB for each picture.
"""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral
from typing import NamedTuple

import numpy as np

from autocolor.arrays import Indices
from autocolor.checks import Vector, shown
from autocolor.errors import UsageError
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import NORMAL, POINT, VisiblePoints


class Seen(NamedTuple):
    """What is seen at a pixel.

    `surface` and `part` are names, and `polygon` is a row of the polygon table. `point` is P, in object
    coordinates; `normal` is the unit normal N that is used for shading, turned to the eye where the surface
    is two-sided; `reflected_view` is the unit vector R = 2 (N.V) N - V, where V is the direction from P to
    the eye. N is zero where those of the corners cancel.
    """

    surface: str
    part: str
    polygon: int
    point: Vector
    normal: Vector
    reflected_view: Vector


@dataclass(frozen=True, eq=False)
class Sight:
    """The visible points of a scene, each of which a display shows as a block of `block` x `block` pixels."""

    scene: Scene
    points: VisiblePoints
    block: int = 1

    def place_at(self, line: int, element: int) -> int | None:
        """The place, among the visible points, of what is seen at a pixel; None on the background.

        Raises UsageError if there is no such line or element.
        """
        points, block = self.points, self.block
        for what, number, count in (("line", line, points.lines), ("element", element, points.elements)):
            if (
                isinstance(number, bool)
                or not isinstance(number, Integral)
                or not 0 <= number < count * block
            ):
                article = "an" if what == "element" else "a"
                raise UsageError(
                    f"{article} {what} must be 0 to {count * block - 1}, not {shown(number)}; choose another"
                )
        found = np.flatnonzero(points.pixels == line // block * points.elements + element // block)
        return int(found[0]) if len(found) else None

    def pixels_of(self, pixels: Indices) -> Indices:
        """The lines and elements, (n, 2), of the middle of the blocks at flat places in the raster, (n,)."""
        blocks = np.stack(np.divmod(pixels, self.points.elements), axis=1)
        return blocks * self.block + self.block // 2


def seen_at(sight: Sight, line: int, element: int) -> Seen | None:
    """What is seen at a pixel, None on the background; all pixels of a block see the same.

    Raises UsageError if there is no such line or element.
    """
    place = sight.place_at(line, element)
    if place is None:
        return None
    scene, points = sight.scene, sight.points
    span = np.searchsorted(np.cumsum(points.span_lengths), place, side="right")
    polygon = int(points.span_polygons[span])
    part = scene.parts[scene.mesh.part_numbers[polygon]]

    # Turn point and normal to the axes of the world.
    axes = points.view.axes
    from_eye = (points.rows[POINT, place] + points.middle) @ axes
    point = from_eye * points.unit + np.array(points.view.eye)
    normal = points.rows[NORMAL, place].astype(np.float64) @ axes
    # Make it as long as float64 can tell, unless it is zero.
    normal /= np.linalg.norm(normal) or 1.0
    # Reflect the view direction at the normal.
    ray = from_eye / np.linalg.norm(from_eye)
    reflected = ray - 2 * (normal @ ray) * normal
    return Seen(
        part.surface, part.name, polygon, *(tuple(each.tolist()) for each in (point, normal, reflected))
    )
