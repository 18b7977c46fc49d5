from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Light, View
from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.screens.light_and_view.marks import (
    RIM_SIDES,
    Cross,
    arrow,
    cone_outline,
    flap_marks,
    light_marks,
    numerals,
    picture_corners,
)
from autocolor.screens.light_and_view.orthographic_views import (
    FRONT,
    SIDES,
    TOP,
    ViewSide,
)
from autocolor.testing import directions, lights, numbers, vectors, views
from autocolor.visibility.projection import focal_length
from autocolor.widgets.items import Area
from tests.autocolor.screens.light_and_view.pointing import VIEWS

places = st.tuples(st.floats(-300, 300), st.floats(-300, 300))


def test_an_arrow_that_points_at_the_viewer_has_no_head_and_a_short_one_a_head_of_half_its_length() -> None:
    assert arrow((5, 5), (5, 5)).tolist() == [[5, 5, 5, 5]]
    assert [len(arrow((5, 5), (x, 5))) for x in (7.9, 8.0)] == [1, 3]
    assert arrow((0, 0), (0, 8))[1, 1] == pytest.approx(4)


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


def test_a_cone_that_points_at_the_viewer_is_a_circle() -> None:
    for up in (2.0, -2.0):
        light = Light("key", (0.0, 0.0, 0.0), aim=(0.0, 0.0, up), cone_angle=30.0)
        rim = cone_outline(VIEWS, TOP, light, (0.0, 0.0, up))
        assert len(rim) == RIM_SIDES
        assert np.hypot(*(rim[:, :2] - TOP.area.middle).T) == pytest.approx(np.full(RIM_SIDES, 10.0))


def test_a_cone_of_ninety_degrees_seen_from_the_side_is_a_line_across_and_of_180_none() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=90.0)
    outline = cone_outline(VIEWS, FRONT, light, (2.0, 0.0, 0.0)).reshape(-1, 2)
    assert np.ptp(outline[:, 0]) == pytest.approx(0, abs=1e-9)
    assert np.ptp(outline[:, 1]) == pytest.approx(40, rel=0.01)
    everything = light.replace(cone_angle=180.0)
    assert not any(len(cone_outline(VIEWS, side, everything, (2.0, 0.0, 0.0))) for side in SIDES)


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
        assert len(outline) == RIM_SIDES
        return
    assert len(outline) == 2
    for start, touching in outline.reshape(2, 2, 2):
        assert start == pytest.approx(at)
        # It touches the rim, and the rim lies on one side of it.
        assert np.hypot(*(rim - touching).T).min() < 0.2
        step = (touching - start) / np.linalg.norm(touching - start)
        beside = step[0] * (rim - start)[:, 1] - step[1] * (rim - start)[:, 0]
        assert min(beside.max(), (-beside).max()) < 0.1


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


def test_a_numeral_makes_way_for_what_is_there() -> None:
    ((_, area),) = numerals([Cross(3, 100, 100)], AREA, [])
    assert area == (106, 86, 112, 94)
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
