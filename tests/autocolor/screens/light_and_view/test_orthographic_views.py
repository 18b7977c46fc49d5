from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Mesh, Part, View, scene_of
from autocolor.checks import Vector
from autocolor.screens.light_and_view.orthographic_views import (
    EDGE,
    FILLED,
    FRONT,
    SIDE,
    SIDES,
    TOP,
    OrthographicViews,
    PointMark,
    ViewSide,
    fitted_views,
    shown_points,
)
from autocolor.testing import vectors
from tests.autocolor.screens.light_and_view.pointing import VIEWS
from tests.small import cube, grid

coordinates = st.floats(-1e6, 1e6).map(lambda value: value + 0.0)
points = st.tuples(coordinates, coordinates, coordinates)
sides = st.sampled_from(SIDES)


@st.composite
def some_views(draw: st.DrawFn) -> OrthographicViews:
    """Views of any scale that can be zoomed to."""
    return OrthographicViews(draw(points), 1.0).zoomed(10.0 ** draw(st.floats(-4, 4)))


def test_each_view_shows_two_axes_as_on_an_engineering_drawing() -> None:
    for side, right, up in ((TOP, 10, 20), (FRONT, 10, 30), (SIDE, 20, 30)):
        element, line = side.area.middle
        assert VIEWS.position(side, (1, 2, 3)) == (element + right, line - up)


@given(some_views(), sides, points, points | st.none())
def test_the_mark_of_a_point_is_at_its_position_or_where_its_arrow_comes_into_the_area(
    views: OrthographicViews, side: ViewSide, point: Vector, end: Vector | None
) -> None:
    at, mark = views.position(side, point), views.mark(side, point, end)
    if side.area.has(*at):
        assert mark == PointMark(at, at)
        return
    area = side.area.inset(EDGE)
    element, line = mark.place
    beyond = [element - area.left, area.right - element, line - area.top, area.bottom - line]
    assert min(beyond) == pytest.approx(0, abs=1e-6)
    assert mark.is_outside
    assert mark.at == at
    to = area.middle if end is None else views.position(side, end)
    if area.has(*to):
        arrow, way = np.subtract(at, to), np.subtract(mark.place, to)
        assert arrow @ way >= 0
        # Both lead the same way, and the point is so many times as far.
        assert abs(arrow[0] * way[1] - arrow[1] * way[0]) <= 1e-6 * (np.hypot(*arrow) + 1)
        if np.hypot(*way) > 1e-3 and mark.ratio < 1e5:
            assert np.hypot(*arrow) == pytest.approx(mark.ratio * np.hypot(*way), rel=1e-3)


@given(some_views(), sides, points, st.integers(0, 247), st.integers(0, 200))
def test_a_point_is_placed_to_the_pixel_and_the_third_coordinate_stays(
    views: OrthographicViews, side: ViewSide, point: Vector, across: int, down: int
) -> None:
    element, line = side.area.left + across, side.area.top + down
    placed = views.placed(side, point, element, line)
    (third,) = {0, 1, 2} - {side.right, side.up}
    assert placed[third] == point[third]
    position = views.position(side, placed)
    assert abs(position[0] - element) <= 0.5
    assert abs(position[1] - line) <= 0.5
    # Placed once more at the same pixel it stays.
    assert views.placed(side, placed, element, line) == placed


def test_a_placed_coordinate_has_no_more_decimals_than_tell_the_pixel() -> None:
    middle = TOP.area.middle
    moved = VIEWS.placed(TOP, (0.123456, 0.0, 0.5), round(middle[0] + 40.5), round(middle[1] - 60.5))
    assert moved == (4.05, 6.05, 0.5)


@given(st.lists(vectors(), min_size=1, max_size=9), st.floats(-12, 12))
def test_fitted_points_are_within_all_areas_with_space_left_on_all_sides(
    many: list[Vector], power: float
) -> None:
    found = np.array(many) * 10.0**power
    views = fitted_views(found)
    for side in SIDES:
        positions = views.positions(side, found)
        assert (positions >= np.array([side.area.left, side.area.top]) + 16).all()
        assert (positions <= np.array([side.area.right, side.area.bottom]) - 16).all()


def test_the_longest_extent_fills_its_view_and_a_single_point_has_space_around_it() -> None:
    for points, center, scale in (
        (cube().coordinates, (0.5, 0.5, 0.5), FILLED * 219),
        (cube().coordinates * (4, 1, 1), (2, 0.5, 0.5), FILLED * 247 / 4),
        (np.array([[5.0, 6.0, 7.0]]), (5, 6, 7), FILLED * 219),
        (np.empty((0, 3)), (0, 0, 0), FILLED * 219),
    ):
        assert fitted_views(points).center == center
        assert fitted_views(points).scale == pytest.approx(scale)


def test_nearer_ends_where_coordinates_can_no_longer_tell_a_pixel_from_the_next() -> None:
    views = OrthographicViews((1000.0, 0.0, 0.0), 1.0)
    for _ in range(200):
        views = views.zoomed(2)
    element, line = views.position(TOP, (1000.0, 0.0, 0.0))
    point = views.placed(TOP, (1000.0, 0.0, 0.0), round(element + 9.5), round(line))
    assert views.position(TOP, point)[0] == pytest.approx(element + 9.5, abs=0.6)
    for _ in range(400):
        views = views.zoomed(0.5)
    assert views.scale == pytest.approx(1e-30)


VIEW = View((5.0, -6.0, 7.0), target=(0.5, 0.5, 0.25))


def test_the_object_the_eye_and_its_target_and_the_lights_and_their_aims_are_shown() -> None:
    lights = [
        Light("key", (1.0, 2.0, 3.0), aim=(0.0, 0.5, 0.5)),
        Light("back", (4.0, 5.0, 6.0), on=False, direction=(0.0, 0.0, -1.0)),
        Light("lamp", (0.0, 0.0, 0.0), follows="eye"),
        Light("beside", (0.0, 0.0, 1.0), follows="key"),
    ]
    found = shown_points(scene_of(cube(), view=VIEW, lights=lights))
    assert {tuple(point) for point in found.tolist()} == {
        (0, 0, 0), (1, 1, 1), VIEW.eye, VIEW.target, (1, 2, 3), (0, 0.5, 0.5), (4, 5, 6), (0, 0.5, 1.5)
    }  # fmt: skip


def test_a_stage_is_left_out_of_the_scale() -> None:
    floor = grid(1, 1, (-50, -50, 0), (100, 0, 0), (0, 100, 0), "floor")
    scene = scene_of(Mesh.joined([cube(), floor]), view=VIEW, lights=[])
    assert shown_points(scene).min() == -50
    parts = [Part(part.name, part.surface, stage=part.name == "floor") for part in scene.parts]
    assert shown_points(scene.replace(parts=tuple(parts))).min() == -6
