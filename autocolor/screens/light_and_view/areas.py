"""Where the views of the light and view screen stand."""

from __future__ import annotations

from typing import Final

from autocolor.widgets.areas import Area

PICTURE_ASPECT: Final = 640 / 480
"""The width of a picture over its height. Paper: Figure 11, 640 x 480."""


TOP_AREA: Final = Area(0, 0, 247, 223)
PICTURE_AREA: Final = Area(256, 0, 503, 223)
FRONT_AREA: Final = Area(0, 232, 247, 455)
SIDE_AREA: Final = Area(256, 232, 503, 455)
"""The quarters of a work area of 504 x 464, on a grid of 8.

Assumed: the top view is above the front view, and the side view beside it, as on an engineering drawing; the
fourth quarter is that of DISPLAY VIEW. Eight lines are left free at the bottom.
"""


def area_of_picture(area: Area = PICTURE_AREA, aspect: float = PICTURE_ASPECT) -> Area:
    """The largest area of the shape of a picture in the middle of an area.

    >>> area_of_picture(Area(256, 0, 503, 223))
    Area(left=256, top=19, right=503, bottom=204)
    """
    width = min(area.width, round(area.height * aspect))
    height = min(area.height, round(area.width / aspect))
    left, top = area.left + (area.width - width) // 2, area.top + (area.height - height) // 2
    return Area(left, top, left + width - 1, top + height - 1)
