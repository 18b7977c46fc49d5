from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, InputError, Light, View
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
from autocolor.screens.light_and_view.orthographic_views import EDGE, SIDE, SIDES, TOP, OrthographicViews
from autocolor.screens.picture.picture_edits import target_of
from tests.autocolor.screens.light_and_view.pointing import FILL, KEY, boxed

VIEWS = OrthographicViews((0.0, 0.0, 0.0), 10.0)
PLACE = (1.5, -2.0, 3.0)


@pytest.mark.parametrize(
    "movable",
    [
        MovablePoint(EYE),
        MovablePoint(TARGET),
        MovablePoint(LIGHT, light="key"),
        MovablePoint(AIM, light="key"),
    ],
)
def test_what_is_put_at_a_point_is_there(movable: MovablePoint) -> None:
    scene = movable.put(boxed(KEY, FILL), PLACE)
    assert movable.point_in(scene, VIEWS) == PLACE
    before = boxed(KEY, FILL)
    moved = [scene.view.eye != before.view.eye, scene.view.target != before.view.target]
    moved += [scene.light("key").position != KEY.position, scene.light("key").aim != KEY.aim]
    assert sum(moved) == 1
    assert scene.light("fill") == FILL


def test_a_direction_points_to_where_its_end_is_put() -> None:
    light = Light("spot", (1.0, 2.0, 3.0), direction=(0.0, 0.0, -1.0))
    movable = MovablePoint(DIRECTION, light="spot")
    after = movable.put(boxed(light), (4.0, 2.0, 7.0)).light("spot")
    assert after.position == light.position
    assert after.axis == pytest.approx((0.6, 0.0, 0.8))
    end = movable.point_in(boxed(after), VIEWS)
    assert end is not None
    assert math.dist(end, light.position) == pytest.approx(4.0)


def test_a_view_without_a_target_is_aimed_by_its_direction() -> None:
    scene = boxed().replace(view=View((0.0, -5.0, 0.5), direction=(0.0, 1.0, 0.0)))
    assert target_of(scene) == pytest.approx((0.0, 0.5, 0.5))
    after = MovablePoint(TARGET).put(scene, (5.0, 0.0, 0.5)).view
    assert after.target is None
    assert after.eye == (0.0, -5.0, 0.5)
    assert after.axes[2] == pytest.approx((0.5**0.5, 0.5**0.5, 0.0))


def test_an_aim_at_the_place_of_its_light_is_refused() -> None:
    with pytest.raises(InputError, match="the aim must differ from the position"):
        MovablePoint(AIM, light="key").put(boxed(KEY), KEY.position)


@given(st.floats(-9, 9), st.sampled_from("xyz"), st.sampled_from(["minimum", "maximum"]))
def test_the_ends_of_a_flap_never_pass_each_other(value: float, axis: str, end: str) -> None:
    light = FILL.replace(flaps=Flaps(x=Flap(-1.0, 2.0), y=Flap(-1.0, 2.0), z=Flap(-1.0, 2.0)))
    movable = MovablePoint(FLAP, "top", "fill", axis, end)
    flap = getattr(movable.put(boxed(light), (value, value, value)).light("fill").flaps, axis)
    if end == "minimum":
        assert flap == Flap(min(value, 2.0), 2.0)
    else:
        assert flap == Flap(-1.0, max(value, -1.0))


def test_what_is_gone_has_no_point() -> None:
    scene = boxed(FILL)
    for what in (LIGHT, AIM, DIRECTION):
        assert MovablePoint(what, light="key").point_in(scene, VIEWS) is None
    assert MovablePoint(FLAP, "top", "fill", "x", "minimum").point_in(scene, VIEWS) is None
    assert MovablePoint(AIM, light="fill").point_in(scene, VIEWS) is None


def test_everything_that_a_view_shows_can_be_taken_hold_of_there() -> None:
    spot = Light("spot", (1.0, 2.0, 3.0), direction=(0.0, 0.0, -1.0))
    scene = boxed(KEY, FILL, spot)
    for side in SIDES:
        found = {
            movable_of(each) for each in handles_in(scene, VIEWS, "key") if movable_of(each).side == side.name
        }
        lights = {
            ("light", "key"),
            ("aim", "key"),
            ("light", "fill"),
            ("light", "spot"),
            ("direction", "spot"),
        }
        assert {(movable.what, movable.light) for movable in found} == {("eye", ""), ("target", ""), *lights}


def test_handles_are_within_their_view_and_tell_the_coordinates() -> None:
    for each in handles_in(boxed(KEY, FILL), VIEWS, "key"):
        side = next(side for side in SIDES if side.name == movable_of(each).side)
        assert side.area.has(each.element, each.line)
    found = {each.label for each in handles_in(boxed(KEY), VIEWS, "key") if movable_of(each).what != "eye"}
    assert found == {"key: x 2  y -3  z 4", "key: aim: x 0.5  y 0.5  z 0.5", "target: x 0.5  y 0.5  z 0.5"}


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
    lights = [Light(name, (0.0, 0.0, 1.0)) for name in ("a", "b", "c")]
    for chosen in ("a", "b", "c"):
        assert handles_in(boxed(*lights), VIEWS, chosen)[-1].key == MovablePoint(LIGHT, "side", chosen)
    assert [movable_of(each).what for each in handles_in(boxed(*lights), VIEWS, "")[-6:]] == [TARGET] * 3 + [
        EYE
    ] * 3


def test_the_line_of_a_flap_of_the_chosen_light_can_be_taken_hold_of_anywhere() -> None:
    flaps = Flaps(x=Flap(-1.0, 2.0))
    scene = boxed(KEY.replace(flaps=flaps), FILL.replace(flaps=flaps))
    movable = MovablePoint(FLAP, "top", "key", "x", "maximum")
    handles = [each for each in handles_in(scene, VIEWS, "key") if each.key == movable]
    element = round(VIEWS.position(TOP, (2.0, 0.0, 0.0))[0])
    assert {each.element for each in handles} == {element}
    for line in range(TOP.area.top, TOP.area.bottom + 1):
        assert min(abs(each.line - line) for each in handles) <= BETWEEN // 2
    points = map(movable_of, handles_in(scene, VIEWS, "key"))
    assert {each.light for each in points if each.what == FLAP} == {"key"}


@pytest.mark.parametrize("follows", ["eye", "key"])
def test_a_light_that_follows_is_taken_hold_of_and_put_where_it_is_in_the_world(follows: str) -> None:
    spot = Light("spot", (0.5, 1.0, -0.5), direction=(0.0, 1.0, 0.0), follows=follows)
    scene = boxed(KEY, spot)
    assert MovablePoint(LIGHT, light="spot").point_in(scene, VIEWS) == scene.light_in_world("spot").position
    moved = MovablePoint(LIGHT, light="spot").put(scene, PLACE)
    assert MovablePoint(LIGHT, light="spot").point_in(moved, VIEWS) == pytest.approx(PLACE)
    assert moved.light("spot").follows == follows
    turned = MovablePoint(DIRECTION, light="spot").put(moved, (1.5, -2.0, 8.0)).light_in_world("spot")
    assert turned.axis == pytest.approx((0.0, 0.0, 1.0), abs=1e-12)
    aimed = MovablePoint(AIM, light="spot").put(moved, (0.0, 1.0, 2.0)).light_in_world("spot")
    assert aimed.aim == pytest.approx((0.0, 1.0, 2.0))
    handles = {handle.key for handle in handles_in(scene, VIEWS, "spot")}
    assert MovablePoint(LIGHT, "top", "spot") in handles
