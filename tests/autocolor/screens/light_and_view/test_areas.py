from __future__ import annotations

import numpy as np

from autocolor.screens.light_and_view.areas import (
    FRONT_AREA,
    PICTURE_AREA,
    SIDE_AREA,
    TOP_AREA,
    area_of_picture,
)
from autocolor.widgets.areas import Area
from autocolor.widgets.menu import WORK

QUARTERS = (TOP_AREA, PICTURE_AREA, FRONT_AREA, SIDE_AREA)


def test_the_quarters_of_the_work_area_do_not_touch_and_stand_on_a_grid_of_eight() -> None:
    covered = np.zeros((464, 504), np.intp)
    for area in QUARTERS:
        covered[area.top : area.bottom + 1, area.left : area.right + 1] += 1
    assert covered.max() == 1
    assert covered.sum() == 4 * 248 * 224
    for area in QUARTERS:
        assert {number % 8 for number in (area.left, area.top, area.width, area.height)} == {0}
        assert WORK.covers(area)


def test_the_top_view_is_above_the_front_view_and_the_side_view_beside_it() -> None:
    assert (TOP_AREA.left, TOP_AREA.width) == (FRONT_AREA.left, FRONT_AREA.width)
    assert (SIDE_AREA.top, SIDE_AREA.height) == (FRONT_AREA.top, FRONT_AREA.height)
    assert TOP_AREA.bottom < FRONT_AREA.top
    assert FRONT_AREA.right < SIDE_AREA.left


def test_the_picture_has_its_shape_in_a_high_area_and_in_a_wide_one() -> None:
    assert area_of_picture(Area(0, 0, 63, 99)) == Area(0, 26, 63, 73)
    assert area_of_picture(Area(0, 0, 99, 47)) == Area(18, 0, 81, 47)
