from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import View
from autocolor.screens.light_and_view.eye_marks import LIDS, PUPIL, eye_marks, picture_corners
from autocolor.screens.light_and_view.orthographic_views import FRONT, SIDE, SIDES, TOP, OrthographicViews
from autocolor.visibility.projection import focal_length
from tests.autocolor.strategies import views

VIEWS = OrthographicViews((0.0, 0.0, 0.0), 10.0)


def test_the_corners_are_those_of_the_picture_as_deep_as_the_target() -> None:
    view = View((0.0, -2.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=90.0)
    corners = picture_corners(view, (5.0, 0.0, 3.0), aspect=1.5)
    assert corners == pytest.approx(np.array([(-3, 0, 2), (3, 0, 2), (3, 0, -2), (-3, 0, -2)]))


@given(views())
def test_the_renderer_has_the_corners_at_the_corners_of_its_raster(view: View) -> None:
    lines, elements = 480, 640
    target = np.array(view.eye) + view.axes[2]
    corners = picture_corners(view, tuple(target.tolist()))
    x, y, depth = view.axes @ (corners - np.array(view.eye)).T
    focal = focal_length(lines, view.field_of_view)
    assert x / depth * focal == pytest.approx(np.array([-1, 1, 1, -1]) * elements / 2)
    assert y / depth * focal == pytest.approx(np.array([-1, -1, 1, 1]) * lines / 2)


def test_the_eye_is_drawn_at_its_position_in_each_view() -> None:
    view = View((1.0, -2.0, 3.0), target=(0.0, 0.0, 0.0))
    for side in SIDES:
        marks = eye_marks(VIEWS, side, view, (0.0, 0.0, 0.0))
        at = VIEWS.position(side, view.eye)
        assert len(marks.eye) == len(LIDS) + len(PUPIL) - 2
        assert (marks.eye[:, :2].min(axis=0) + marks.eye[:, :2].max(axis=0)) / 2 == pytest.approx(at)
        assert marks.direction[0].tolist() == [*at, *VIEWS.position(side, (0.0, 0.0, 0.0))]


def test_the_edges_of_the_picture_are_a_pyramid_of_eight() -> None:
    view = View((1.0, -2.0, 3.0), target=(0.0, 0.0, 0.0))
    corners = picture_corners(view, (0.0, 0.0, 0.0))
    for side in SIDES:
        strokes = eye_marks(VIEWS, side, view, (0.0, 0.0, 0.0)).picture
        positions = VIEWS.positions(side, corners)
        assert len(strokes) == 8
        assert strokes[:4, 2:] == pytest.approx(positions)
        assert strokes[4:, :2] == pytest.approx(positions)
        assert strokes[4:, 2:] == pytest.approx(np.roll(positions, -1, axis=0))


def test_an_eye_that_looks_at_the_viewer_has_an_arrow_without_a_head() -> None:
    view = View((0.0, -2.0, 0.0), target=(0.0, 0.0, 0.0))
    assert len(eye_marks(VIEWS, FRONT, view, (0.0, 0.0, 0.0)).direction) == 1
    assert len(eye_marks(VIEWS, SIDE, view, (0.0, 0.0, 0.0)).direction) == 3


def test_marks_end_at_the_border_of_the_area() -> None:
    view = View((0.0, -200.0, 0.0), target=(0.0, 0.0, 0.0))
    marks = eye_marks(VIEWS, TOP, view, (0.0, 0.0, 0.0))
    assert len(marks.eye) == 0
    assert marks.direction[0].tolist() == [TOP.area.middle[0], TOP.area.bottom, *TOP.area.middle]
