from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Light, Scene, View
from autocolor.screens.light_and_view.marks import (
    AIM,
    BETWEEN,
    DIRECTION,
    EYE,
    FLAP,
    LIGHT,
    RIM_SIDES,
    TARGET,
    MovablePoint,
    cone_outline,
    marks_in,
    numerals,
    picture_corners,
)
from autocolor.screens.light_and_view.orthographic_views import FRONT, SIDE, SIDES, TOP, ViewSide
from autocolor.screens.screen import Handle
from autocolor.testing import lights, views
from autocolor.visibility.projection import focal_length
from autocolor.widgets.items import Area
from tests.autocolor.screens.light_and_view.pointing import FILL, KEY, VIEWS, boxed, movable_of

PLACE = (1.5, -2.0, 3.0)


def handles_in(scene: Scene, side: ViewSide, chosen: str = "key") -> list[Handle]:
    return marks_in(scene, VIEWS, side, chosen, lambda point: None)[1]


def test_everything_that_a_view_shows_can_be_taken_hold_of_there() -> None:
    spot = Light("spot", (1.0, 2.0, 3.0), direction=(0.0, 0.0, -1.0))
    for side in SIDES:
        found = handles_in(boxed(KEY, FILL, spot), side)
        assert all(side.area.has(each.element, each.line) for each in found)
        assert {movable_of(each) for each in found} == {
            MovablePoint(EYE, side),
            MovablePoint(TARGET, side),
            MovablePoint(LIGHT, side, "key"),
            MovablePoint(AIM, side, "key"),
            MovablePoint(LIGHT, side, "fill"),
            MovablePoint(LIGHT, side, "spot"),
            MovablePoint(DIRECTION, side, "spot"),
        }
        # The arrow of a direction has a length on the screen, of 4 units at this scale.
        assert "spot: direction: x 1  y 2  z -1" in [each.label for each in found]


def test_what_is_chosen_goes_before_the_others() -> None:
    scene = boxed(*(Light(name, (0.0, 0.0, 1.0)) for name in ("a", "b", "c")))
    for chosen in ("a", "b", "c"):
        assert handles_in(scene, SIDE, chosen)[-1].key == MovablePoint(LIGHT, SIDE, chosen)
    assert [movable_of(each).what for each in handles_in(scene, SIDE, "")[-2:]] == [TARGET, EYE]


def test_the_line_of_a_flap_of_the_chosen_light_can_be_taken_hold_of_anywhere() -> None:
    flaps = Flaps(x=Flap(-1.0, 2.0), y=Flap(minimum=-3.0), z=Flap(0.0, 1.0))
    scene = boxed(KEY.replace(flaps=flaps), FILL.replace(flaps=flaps))
    found = [each for each in handles_in(scene, TOP) if movable_of(each).what == FLAP]
    ends = {(movable_of(each).axis, movable_of(each).end) for each in found}
    assert ends == {("x", "minimum"), ("x", "maximum"), ("y", "minimum")}
    upright = [each for each in found if each.key == MovablePoint(FLAP, TOP, "key", "x", "maximum")]
    level = [each for each in found if each.key == MovablePoint(FLAP, TOP, "key", "y", "minimum")]
    assert {each.element for each in upright} == {round(VIEWS.position(TOP, (2.0, 0.0, 0.0))[0])}
    assert {each.line for each in level} == {round(VIEWS.position(TOP, (0.0, -3.0, 0.0))[1])}
    for places, first, last in (
        ([each.line for each in upright], TOP.area.top, TOP.area.bottom),
        ([each.element for each in level], TOP.area.left, TOP.area.right),
    ):
        gaps = [min(abs(place - along) for place in places) for along in range(first, last + 1)]
        assert max(gaps) == BETWEEN // 2


@pytest.mark.parametrize("follows", ["eye", "key"])
def test_a_light_that_follows_is_put_where_it_is_in_the_world(follows: str) -> None:
    light = MovablePoint(LIGHT, TOP, "spot")
    spot = Light("spot", (0.5, 1.0, -0.5), direction=(0.0, 1.0, 0.0), follows=follows)
    scene = light.put(boxed(KEY, spot), PLACE)
    assert scene.lights_in_world["spot"].position == pytest.approx(PLACE)
    turned = light._replace(what=DIRECTION).put(scene, (1.5, -2.0, 8.0)).lights_in_world["spot"]
    assert turned.axis == pytest.approx((0.0, 0.0, 1.0), abs=1e-12)
    aimed = light._replace(what=AIM).put(scene, (0.0, 1.0, 2.0)).lights_in_world["spot"]
    assert aimed.aim == pytest.approx((0.0, 1.0, 2.0))


def test_a_cone_that_points_at_the_viewer_is_a_circle() -> None:
    for up in (2.0, -2.0):
        light = Light("key", (0.0, 0.0, 0.0), aim=(0.0, 0.0, up), cone_angle=30.0)
        rim = cone_outline(VIEWS, TOP, light, (0.0, 0.0, up))
        assert len(rim) == RIM_SIDES
        assert np.hypot(*(rim[:, :2] - TOP.area.middle).T) == pytest.approx(np.full(RIM_SIDES, 10.0))


@pytest.mark.parametrize("angle", [30.0, 80.0, 120.0])
def test_a_cone_seen_from_the_side_is_two_lines_that_open_by_its_angle(angle: float) -> None:
    light = Light("key", (1.0, 0.0, 0.5), aim=(3.0, 0.0, 0.5), cone_angle=angle)
    outline = cone_outline(VIEWS, FRONT, light, (3.0, 0.0, 0.5)).reshape(2, 2, 2)
    at = np.array(VIEWS.position(FRONT, light.position))
    assert outline[:, 0] == pytest.approx(np.stack([at, at]))
    ends = outline[np.argsort(outline[:, 1, 1]), 1] - at
    x, y = 20 * math.cos(math.radians(angle)), 20 * math.sin(math.radians(angle))
    assert ends == pytest.approx(np.array([(x, -y), (x, y)]), abs=0.1)


def test_a_cone_of_180_degrees_has_no_outline() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=180.0)
    assert not any(len(cone_outline(VIEWS, side, light, (2.0, 0.0, 0.0))) for side in SIDES)


@given(views())
def test_the_renderer_has_the_corners_at_the_corners_of_its_raster(view: View) -> None:
    lines, elements = 480, 640
    target = np.array(view.eye) + view.axes[2]
    corners = picture_corners(view, tuple(target.tolist()))
    x, y, depth = view.axes @ (corners - np.array(view.eye)).T
    focal = focal_length(lines, elements, view.field_of_view)
    assert x / depth * focal == pytest.approx(np.array([-1, 1, 1, -1]) * elements / 2)
    assert y / depth * focal == pytest.approx(np.array([-1, -1, 1, 1]) * lines / 2)
    assert depth == pytest.approx(1)


@given(lights(), st.sampled_from(SIDES), st.booleans())
def test_all_marks_are_within_their_area(light: Light, side: ViewSide, is_chosen: bool) -> None:
    chosen = light.name if is_chosen else ""
    items, handles = marks_in(boxed(light), VIEWS, side, chosen, lambda point: None)
    assert all(side.area.covers(item.area) for item in items)
    assert all(side.area.has(handle.element, handle.line) for handle in handles)


AREA = Area(0, 0, 247, 223)

crosses = st.tuples(st.integers(1, 16), st.integers(0, 247), st.integers(0, 223))


@given(st.lists(crosses, max_size=16))
def test_every_light_in_the_area_has_a_numeral_within_it(lights: list[tuple[int, int, int]]) -> None:
    corners = [(10, element, line) for element, line in itertools.product((0, 247), (0, 223))]
    areas = numerals((*corners, *lights), AREA, ())
    assert len(areas) == len(corners) + len(lights)
    assert all(AREA.covers(area) for area in areas)
