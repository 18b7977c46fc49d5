from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from autocolor import Flap, Flaps, Light
from autocolor.screens.light_and_view.light_marks import (
    DIRECTION_LENGTH,
    arrow_end,
    flap_marks,
    light_marks,
)
from autocolor.screens.light_and_view.orthographic_views import FRONT, SIDE, SIDES, TOP, OrthographicViews
from tests.autocolor.strategies import lights

VIEWS = OrthographicViews((0.0, 0.0, 0.0), 10.0)


def test_a_point_source_is_a_cross_alone() -> None:
    for side in SIDES:
        marks = light_marks(VIEWS, side, Light("key", (1.0, 2.0, 3.0)))
        element, line = VIEWS.position(side, (1.0, 2.0, 3.0))
        assert marks.cross.tolist() == [
            [element - 4, line, element + 4, line],
            [element, line - 4, element, line + 4],
        ]
        assert marks.arrow.shape == marks.cone.shape == (0, 4)


def test_a_light_with_an_aim_has_an_arrow_to_it() -> None:
    light = Light("key", (1.0, 2.0, 3.0), aim=(0.0, -1.0, 0.5))
    assert arrow_end(VIEWS, light) == (0.0, -1.0, 0.5)
    for side in SIDES:
        shaft = light_marks(VIEWS, side, light).arrow[0]
        assert shaft.tolist() == [
            *VIEWS.position(side, (1.0, 2.0, 3.0)),
            *VIEWS.position(side, (0.0, -1.0, 0.5)),
        ]


def test_a_direction_is_an_arrow_of_the_same_length_at_any_scale() -> None:
    light = Light("key", (1.0, 2.0, 3.0), direction=(3.0, 0.0, -4.0))
    for scale in (0.01, 1.0, 50.0):
        views = OrthographicViews(light.position, scale)
        start_x, start_y, end_x, end_y = light_marks(views, FRONT, light).arrow[0]
        assert math.hypot(end_x - start_x, end_y - start_y) == pytest.approx(DIRECTION_LENGTH)
        assert end_x - start_x == pytest.approx(0.6 * DIRECTION_LENGTH)


def test_flaps_are_lines_across_the_views_that_show_their_coordinate() -> None:
    flaps = Flaps(x=Flap(-1.0, 2.0), z=Flap(minimum=0.5, on=False))
    light = Light("key", (0.0, 0.0, 5.0), flaps=flaps)
    (left, right) = flap_marks(VIEWS, TOP, light)
    element = TOP.area.middle[0]
    assert left.stroke.tolist() == [[element - 10, TOP.area.top, element - 10, TOP.area.bottom]]
    assert right.stroke.tolist() == [[element + 20, TOP.area.top, element + 20, TOP.area.bottom]]
    assert [(mark.axis, mark.end, mark.on) for mark in (left, right)] == [
        (0, "minimum", True),
        (0, "maximum", True),
    ]
    (low,) = flap_marks(VIEWS, SIDE, light)
    line = SIDE.area.middle[1] - 5
    assert low.stroke.tolist() == [[SIDE.area.left, line, SIDE.area.right, line]]
    assert low[:3] == (2, "minimum", False)
    assert len(flap_marks(VIEWS, FRONT, light)) == 3


def test_a_flap_outside_of_the_view_has_no_line() -> None:
    light = Light("key", (0.0, 0.0, 5.0), flaps=Flaps(y=Flap(-1e9, 1e9)))
    assert flap_marks(VIEWS, TOP, light) == ()


@given(lights())
def test_all_marks_are_within_their_area(light: Light) -> None:
    for side in SIDES:
        marks = [*light_marks(VIEWS, side, light), *(m.stroke for m in flap_marks(VIEWS, side, light))]
        strokes = np.concatenate(marks)
        assert (strokes >= [side.area.left, side.area.top] * 2).all()
        assert (strokes <= [side.area.right, side.area.bottom] * 2).all()
        assert len(marks[2]) == 0 or light.cone_angle is not None
