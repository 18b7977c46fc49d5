from __future__ import annotations

import math

import pytest

from autocolor import Flap, Flaps, Light
from autocolor.screens.light_and_view.handles import (
    AIM,
    BETWEEN,
    DIRECTION,
    EYE,
    FLAP,
    LIGHT,
    TARGET,
    MovablePoint,
    handles_in,
    movable_of,
)
from autocolor.screens.light_and_view.orthographic_views import EDGE, SIDE, SIDES, TOP
from tests.autocolor.screens.light_and_view.pointing import FILL, KEY, VIEWS, boxed

PLACE = (1.5, -2.0, 3.0)


def test_a_direction_points_to_where_its_end_is_put() -> None:
    light = Light("spot", (1.0, 2.0, 3.0), direction=(0.0, 0.0, -1.0))
    movable = MovablePoint(DIRECTION, light="spot")
    after = movable.put(boxed(light), (4.0, 2.0, 7.0)).lights["spot"]
    assert after.position == light.position
    assert after.axis == pytest.approx((0.6, 0.0, 0.8))
    end = movable.point_in(boxed(after), VIEWS)
    assert end is not None
    assert math.dist(end, light.position) == pytest.approx(4.0)


def test_what_is_gone_has_no_point() -> None:
    for movable in (
        *(MovablePoint(what, light="key") for what in (LIGHT, AIM, DIRECTION)),
        MovablePoint(FLAP, "top", "fill", "x", "minimum"),
        MovablePoint(AIM, light="fill"),
    ):
        assert movable.point_in(boxed(FILL), VIEWS) is None


def test_everything_that_a_view_shows_can_be_taken_hold_of_there() -> None:
    spot = Light("spot", (1.0, 2.0, 3.0), direction=(0.0, 0.0, -1.0))
    found = handles_in(boxed(KEY, FILL, spot), VIEWS, "key")
    for side in SIDES:
        here = [each for each in found if movable_of(each).side == side.name]
        assert all(side.area.has(each.element, each.line) for each in here)
        assert {(movable_of(each).what, movable_of(each).light) for each in here} == {
            (EYE, ""),
            (TARGET, ""),
            (LIGHT, "key"),
            (AIM, "key"),
            (LIGHT, "fill"),
            (LIGHT, "spot"),
            (DIRECTION, "spot"),
        }


def test_a_light_or_an_eye_outside_of_a_view_can_be_taken_hold_of_at_its_edge() -> None:
    far = boxed(KEY.replace(position=(1e6, 0.0, 0.0))).with_view(eye=(0.0, 0.0, 1e6))
    places = {
        (movable_of(each).what, movable_of(each).side): (each.element, each.line)
        for each in handles_in(far, VIEWS, "key")
    }
    top, side = TOP.area.inset(EDGE), SIDE.area.inset(EDGE)
    # In the side view, the light is far behind and within the view.
    assert places["light", "side"] == tuple(map(round, VIEWS.position(SIDE, (1e6, 0.0, 0.0))))
    assert places["light", "top"][0] == top.right
    assert places["eye", "side"][1] == side.top


def test_what_is_chosen_goes_before_the_others() -> None:
    scene = boxed(*(Light(name, (0.0, 0.0, 1.0)) for name in ("a", "b", "c")))
    for chosen in ("a", "b", "c"):
        assert handles_in(scene, VIEWS, chosen)[-1].key == MovablePoint(LIGHT, "side", chosen)
    last = [movable_of(each).what for each in handles_in(scene, VIEWS, "")[-6:]]
    assert last == [TARGET] * 3 + [EYE] * 3


def test_the_line_of_a_flap_of_the_chosen_light_can_be_taken_hold_of_anywhere() -> None:
    flaps = Flaps(x=Flap(-1.0, 2.0), y=Flap(minimum=-3.0))
    scene = boxed(KEY.replace(flaps=flaps), FILL.replace(flaps=flaps))
    found = [each for each in handles_in(scene, VIEWS, "key") if movable_of(each).what == FLAP]
    assert {movable_of(each).light for each in found} == {"key"}
    upright = [each for each in found if each.key == MovablePoint(FLAP, "top", "key", "x", "maximum")]
    assert {each.element for each in upright} == {round(VIEWS.position(TOP, (2.0, 0.0, 0.0))[0])}
    level = [each for each in found if each.key == MovablePoint(FLAP, "top", "key", "y", "minimum")]
    assert {each.line for each in level} == {round(VIEWS.position(TOP, (0.0, -3.0, 0.0))[1])}
    for places, first, last in (
        ([each.line for each in upright], TOP.area.top, TOP.area.bottom),
        ([each.element for each in level], TOP.area.left, TOP.area.right),
    ):
        gaps = [min(abs(place - along) for place in places) for along in range(first, last + 1)]
        assert max(gaps) == BETWEEN // 2


@pytest.mark.parametrize("follows", ["eye", "key"])
def test_a_light_that_follows_is_taken_hold_of_and_put_where_it_is_in_the_world(follows: str) -> None:
    spot = Light("spot", (0.5, 1.0, -0.5), direction=(0.0, 1.0, 0.0), follows=follows)
    scene = boxed(KEY, spot)
    assert MovablePoint(LIGHT, light="spot").point_in(scene, VIEWS) == scene.lights_in_world["spot"].position
    moved = MovablePoint(LIGHT, light="spot").put(scene, PLACE)
    assert MovablePoint(LIGHT, light="spot").point_in(moved, VIEWS) == pytest.approx(PLACE)
    assert moved.lights["spot"].follows == follows
    turned = MovablePoint(DIRECTION, light="spot").put(moved, (1.5, -2.0, 8.0)).lights_in_world["spot"]
    assert turned.axis == pytest.approx((0.0, 0.0, 1.0), abs=1e-12)
    aimed = MovablePoint(AIM, light="spot").put(moved, (0.0, 1.0, 2.0)).lights_in_world["spot"]
    assert aimed.aim == pytest.approx((0.0, 1.0, 2.0))
