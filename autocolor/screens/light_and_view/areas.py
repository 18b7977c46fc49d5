"""Areas of the screen, and where the views of the light and view screen stand in them.

Positions on the screen are an element and a line. Whole numbers are the centers of pixels, line 0 on top.
"""

from __future__ import annotations

from typing import Final, NamedTuple

PICTURE_ASPECT: Final = 640 / 480
"""The width of a picture over its height. Paper: Figure 11, 640 x 480."""


class Area(NamedTuple):
    """A rectangle of pixels: the element and the line of its upper left pixel, its width and its height."""

    left: int
    top: int
    width: int
    height: int

    @property
    def right(self) -> int:
        """The last element."""
        return self.left + self.width - 1

    @property
    def bottom(self) -> int:
        """The last line."""
        return self.top + self.height - 1

    @property
    def middle(self) -> tuple[float, float]:
        """The element and the line of the middle, which may lie between pixels."""
        return self.left + (self.width - 1) / 2, self.top + (self.height - 1) / 2

    def holds(self, element: float, line: float) -> bool:
        """Whether a position is in the area.

        >>> Area(8, 0, 2, 2).holds(9, 1), Area(8, 0, 2, 2).holds(10, 1)
        (True, False)
        """
        return self.left <= element <= self.right and self.top <= line <= self.bottom


TOP_AREA: Final = Area(0, 0, 248, 224)
PICTURE_AREA: Final = Area(256, 0, 248, 224)
FRONT_AREA: Final = Area(0, 232, 248, 224)
SIDE_AREA: Final = Area(256, 232, 248, 224)
"""The quarters of a work area of 504 x 464, on a grid of 8.

Assumed: the top view is above the front view, and the side view beside it, as on an engineering drawing; the
fourth quarter is that of DISPLAY VIEW. Eight lines are left free at the bottom.
"""


def area_of_picture(area: Area = PICTURE_AREA, aspect: float = PICTURE_ASPECT) -> Area:
    """The largest area of the shape of a picture in the middle of an area.

    >>> area_of_picture(Area(256, 0, 248, 224))
    Area(left=256, top=19, width=248, height=186)
    """
    width = min(area.width, round(area.height * aspect))
    height = min(area.height, round(area.width / aspect))
    return Area(area.left + (area.width - width) // 2, area.top + (area.height - height) // 2, width, height)
