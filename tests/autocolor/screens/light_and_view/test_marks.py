from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Light, View
from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.screens.light_and_view.marks import (
    HEAD,
    LIDS,
    PUPIL,
    RIM_SIDES,
    Cross,
    arrow,
    cone_outline,
    crosses_of,
    eye_marks,
    flap_marks,
    light_marks,
    lines_across,
    numerals,
    picture_corners,
)
from autocolor.screens.light_and_view.orthographic_views import (
    EDGE,
    FRONT,
    SIDE,
    SIDES,
    TOP,
    ViewSide,
)
from autocolor.testing import directions, lights, numbers, vectors, views
from autocolor.visibility.projection import focal_length
from autocolor.widgets.items import SLATE, Area
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.light_and_view.pointing import VIEWS
from tests.autocolor.widgets.drawing import draw_items

places = st.tuples(st.floats(-300, 300), st.floats(-300, 300))


def test_a_line_of_a_point_outside_of_a_view_is_left_out() -> None:
    display = Ramtek9300()
    draw_items(display, [lines_across(VIEWS, TOP, (1e6, 2.0, 3.0))])
    assert (display.words == SLATE).sum() == TOP.area.width


def test_an_arrow_that_points_at_the_viewer_has_no_head_and_a_short_one_a_head_of_half_its_length() -> None:
    assert arrow((5, 5), (5, 5)).tolist() == [[5, 5, 5, 5]]
    assert [len(arrow((5, 5), (x, 5))) for x in (7.9, 8.0)] == [1, 3]
    assert arrow((0, 0), (0, 8))[1, 1] == pytest.approx(4)
    light = Light("key", (0.0, 0.0, 5.0), aim=(0.0, 0.0, 0.0))
    assert crosses_of(VIEWS, TOP, 1, light)[0].arrow == (0.0, 0.0)
    assert crosses_of(VIEWS, FRONT, 1, light)[0].arrow == pytest.approx((0.0, 1.0))


@given(places, places)
def test_a_head_is_symmetrical_and_ends_where_the_shaft_does(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    strokes = arrow(start, end)
    assert strokes[0].tolist() == [*start, *end]
    if len(strokes) == 1:
        return
    assert strokes[1, 2:].tolist() == strokes[2, :2].tolist() == list(end)
    one, other = strokes[1, :2], strokes[2, 2:]
    assert math.dist(one, end) == pytest.approx(math.dist(other, end))
    assert math.dist(one, start) == pytest.approx(math.dist(other, start))
    shaft = math.dist(start, end)
    assert math.dist((one + other) / 2, end) == pytest.approx(min(HEAD, shaft / 2))
    assert np.dot(one - end, np.array(start) - end) > 0


def rim_of(light: Light, end: Vector) -> Floats:
    """Many points of the rim: on the cone, as far from the light as the end."""
    assert light.axis is not None
    assert light.cone_angle is not None
    axis = np.array(light.axis)
    one = np.cross(axis, (0.3, -0.5, 0.8))
    one /= np.linalg.norm(one)
    turns = np.linspace(0, 2 * math.pi, 721)[:, None]
    around = np.cos(turns) * one + np.sin(turns) * np.cross(axis, one)
    angle, slant = math.radians(light.cone_angle), math.dist(end, light.position)
    rim: Floats = np.array(light.position) + slant * (math.cos(angle) * axis + math.sin(angle) * around)
    return rim


def test_a_cone_seen_from_the_side_is_two_lines_at_its_angle() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=30.0)
    one, other = cone_outline(VIEWS, FRONT, light, (2.0, 0.0, 0.0))
    element, line = FRONT.area.middle
    side = 20 * np.array([math.cos(math.pi / 6), 0.5])
    assert one == pytest.approx(np.array([(element, line), (element + side[0], line - side[1])]))
    assert other == pytest.approx(np.array([(element, line), (element + side[0], line + side[1])]))


def test_a_cone_that_points_at_the_viewer_is_a_circle() -> None:
    for up in (2.0, -2.0):
        light = Light("key", (0.0, 0.0, 0.0), aim=(0.0, 0.0, up), cone_angle=30.0)
        (rim,) = cone_outline(VIEWS, TOP, light, (0.0, 0.0, up))
        assert len(rim) == RIM_SIDES + 1
        assert np.hypot(*(rim - TOP.area.middle).T) == pytest.approx(np.full(RIM_SIDES + 1, 10.0))


def test_a_cone_of_ninety_degrees_seen_from_the_side_is_a_line_across_and_of_180_none() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=90.0)
    outline = np.concatenate(cone_outline(VIEWS, FRONT, light, (2.0, 0.0, 0.0)))
    assert np.ptp(outline[:, 0]) == pytest.approx(0, abs=1e-9)
    assert np.ptp(outline[:, 1]) == pytest.approx(40, rel=0.01)
    everything = light.replace(cone_angle=180.0)
    assert all(cone_outline(VIEWS, side, everything, (2.0, 0.0, 0.0)) == () for side in SIDES)


@given(vectors(), directions(), numbers(1, 179), st.sampled_from(SIDES))
def test_the_lines_are_tangents_of_the_rim(
    position: Vector, direction: Vector, cone_angle: float, side: ViewSide
) -> None:
    light = Light("key", position, direction=direction, cone_angle=cone_angle)
    assert light.axis is not None
    end = tuple((np.array(position) + 2 * np.array(light.axis)).tolist())
    along = abs(float(np.dot(light.axis, side.toward)))
    # The cone opens behind the light above 90 degrees.
    half = math.radians(min(cone_angle, 180 - cone_angle))
    assume(abs(math.acos(min(along, 1.0)) - half) > 1e-3)
    assume(abs(cone_angle - 90) > 0.1)
    outline = cone_outline(VIEWS, side, light, end)
    rim = VIEWS.positions(side, rim_of(light, end))
    at = np.array(VIEWS.position(side, position))
    if math.acos(min(along, 1.0)) < half:
        assert len(outline) == 1
        return
    assert len(outline) == 2
    for start, touching in outline:
        assert start == pytest.approx(at)
        # It touches the rim, and the rim lies on one side of it.
        assert np.hypot(*(rim - touching).T).min() < 0.2
        step = (touching - start) / np.linalg.norm(touching - start)
        beside = step[0] * (rim - start)[:, 1] - step[1] * (rim - start)[:, 0]
        assert min(beside.max(), (-beside).max()) < 1e-6


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
    focal = focal_length(lines, elements, view.field_of_view)
    assert x / depth * focal == pytest.approx(np.array([-1, 1, 1, -1]) * elements / 2)
    assert y / depth * focal == pytest.approx(np.array([-1, -1, 1, 1]) * lines / 2)


def test_the_eye_is_drawn_at_its_position_with_an_arrow_and_a_pyramid_to_the_picture() -> None:
    view = View((1.0, -2.0, 3.0), target=(0.0, 0.0, 0.0))
    corners = picture_corners(view, (0.0, 0.0, 0.0))
    for side in SIDES:
        marks = eye_marks(VIEWS, side, view, (0.0, 0.0, 0.0))
        at = VIEWS.position(side, view.eye)
        assert len(marks.eye) == len(LIDS) + len(PUPIL) - 2
        assert (marks.eye[:, :2].min(axis=0) + marks.eye[:, :2].max(axis=0)) / 2 == pytest.approx(at)
        assert marks.direction[0].tolist() == [*at, *VIEWS.position(side, (0.0, 0.0, 0.0))]
        positions = VIEWS.positions(side, corners)
        assert len(marks.picture) == 8
        assert marks.picture[:4, 2:] == pytest.approx(positions)
        assert marks.picture[4:, :2] == pytest.approx(positions)
        assert marks.picture[4:, 2:] == pytest.approx(np.roll(positions, -1, axis=0))


def test_marks_end_at_the_border_of_the_area() -> None:
    view = View((0.0, -200.0, 0.0), target=(0.0, 0.0, 0.0))
    marks = eye_marks(VIEWS, TOP, view, (0.0, 0.0, 0.0))
    # The eye has a mark with a frame at the edge.
    assert len(marks.eye) == len(LIDS) - 1 + len(PUPIL) - 1 + 4
    assert marks.eye[:, 1::2].mean() == pytest.approx(TOP.area.bottom - EDGE, abs=0.5)
    light = Light("key", (0.0, -200.0, 0.0), aim=(0.0, 0.0, 0.0))
    assert len(light_marks(VIEWS, TOP, light).cross) == 2 + 4
    assert len(light_marks(VIEWS, FRONT, light).cross) == 2
    assert marks.direction[0].tolist() == [TOP.area.middle[0], TOP.area.bottom, *TOP.area.middle]


def test_flaps_are_lines_across_the_views_that_show_their_coordinate() -> None:
    flaps = Flaps(x=Flap(-1.0, 2.0), y=Flap(-1e9, 1e9), z=Flap(minimum=0.5, on=False))
    light = Light("key", (0.0, 0.0, 5.0), flaps=flaps)
    (left, right) = flap_marks(VIEWS, TOP, light)
    element = TOP.area.middle[0]
    assert left.stroke.tolist() == [[element - 10, TOP.area.top, element - 10, TOP.area.bottom]]
    assert right.stroke.tolist() == [[element + 20, TOP.area.top, element + 20, TOP.area.bottom]]
    assert [mark[:3] for mark in (left, right)] == [(0, "minimum", True), (0, "maximum", True)]
    (low,) = flap_marks(VIEWS, SIDE, light)
    line = SIDE.area.middle[1] - 5
    assert low.stroke.tolist() == [[SIDE.area.left, line, SIDE.area.right, line]]
    assert low[:3] == (2, "minimum", False)
    assert len(flap_marks(VIEWS, FRONT, light)) == 3


@given(lights())
def test_all_marks_are_within_their_area(light: Light) -> None:
    for side in SIDES:
        marks = [*light_marks(VIEWS, side, light), *(m.stroke for m in flap_marks(VIEWS, side, light))]
        strokes = np.concatenate(marks)
        assert (strokes >= [side.area.left, side.area.top] * 2).all()
        assert (strokes <= [side.area.right, side.area.bottom] * 2).all()
        assert len(marks[2]) == 0 or light.cone_angle is not None


AREA = Area(0, 0, 247, 223)

crosses = st.builds(Cross, st.integers(1, 16), st.integers(-20, 260), st.integers(-20, 240))


@pytest.mark.parametrize(
    ("right", "down", "area"),
    [
        (1, -1, (106, 86, 119, 94)),
        (-1, -1, (81, 86, 94, 94)),
        (1, 1, (106, 106, 119, 114)),
        (-1, 1, (81, 106, 94, 114)),
        (1, 0, (108, 96, 121, 104)),
        (-1, 0, (79, 96, 92, 104)),
        (0, -1, (93, 84, 106, 92)),
        (0, 1, (93, 108, 106, 116)),
    ],
)
def test_a_numeral_has_eight_places_around_its_cross(
    right: int, down: int, area: tuple[int, int, int, int]
) -> None:
    # If all other places are taken, by pixels that no other place covers, it stands there.
    taken = [
        Area(100 + 13 * x, 100 + 12 * y, 100 + 13 * x, 100 + 12 * y)
        for x, y in itertools.product((-1, 0, 1), repeat=2)
        if (x, y) not in ((right, down), (0, 0))
    ]
    ((_, found),) = numerals([Cross(16, 100, 100)], AREA, taken)
    assert found == area


def test_a_numeral_makes_way_for_the_arrow_of_its_light_and_for_what_is_there() -> None:
    ((_, area),) = numerals([Cross(3, 100, 100)], AREA, [])
    assert area == (106, 86, 112, 94)
    ((_, area),) = numerals([Cross(12, 100, 100, (0.8, -0.6))], AREA, [])
    assert area.right < 96
    assert area.width == 14
    ((_, area),) = numerals([Cross(1, 100, 100)], AREA, [Area(103, 80, 120, 99)])
    assert not area.overlaps(Area(103, 80, 120, 99))


@given(st.lists(crosses, max_size=16))
def test_every_light_in_the_area_has_a_numeral_within_it(lights: list[Cross]) -> None:
    corners = [Cross(10, element, line) for element, line in itertools.product((0, 247), (0, 223))]
    beyond = [Cross(1, 248, 100), Cross(1, -1, 100), Cross(1, 100, 224), Cross(1, 100, -1)]
    found = numerals([*corners, *beyond, *lights], AREA, [])
    assert [cross for cross, _ in found] == [
        *corners,
        *(each for each in lights if AREA.has(each.element, each.line)),
    ]
    assert all(AREA.covers(area) for _, area in found)
