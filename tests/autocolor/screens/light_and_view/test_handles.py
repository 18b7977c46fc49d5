from __future__ import annotations

import math

import pytest

from autocolor import Flap, Flaps, Light, Scene
from autocolor.screens.light_and_view.handles import (
    AIM,
    BETWEEN,
    DIRECTION,
    EYE,
    FLAP,
    LIGHT,
    TARGET,
    MovablePoint,
    handles_of,
    points_in,
)
from autocolor.screens.light_and_view.orthographic_views import EDGE, SIDE, SIDES, TOP, ViewSide
from autocolor.screens.screen import Handle
from tests.autocolor.screens.light_and_view.pointing import FILL, KEY, VIEWS, boxed, movable_of

PLACE = (1.5, -2.0, 3.0)


def handles_in(scene: Scene, side: ViewSide, chosen: str = "key") -> list[Handle]:
    others, ours = points_in(scene, VIEWS, side, chosen)
    return list(handles_of((*others, *ours), scene, VIEWS, {}, lambda point: None))


def test_a_direction_points_to_where_its_end_is_put() -> None:
    light = Light("spot", (1.0, 2.0, 3.0), direction=(0.0, 0.0, -1.0))
    movable = MovablePoint(DIRECTION, TOP, "spot")
    scene = movable.put(boxed(light), (4.0, 2.0, 7.0))
    after = scene.lights["spot"]
    assert after.position == light.position
    assert after.axis == pytest.approx((0.6, 0.0, 0.8))
    (end,) = (each for each in points_in(scene, VIEWS, TOP, "spot")[1] if each.movable == movable)
    assert math.dist(end.point, light.position) == pytest.approx(4.0)


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


def test_a_light_or_an_eye_outside_of_a_view_can_be_taken_hold_of_at_its_edge() -> None:
    far = boxed(KEY.replace(position=(1e6, 0.0, 0.0))).with_view(eye=(0.0, 0.0, 1e6))
    places = {movable_of(each): (each.element, each.line) for side in SIDES for each in handles_in(far, side)}
    # In the side view, the light is far behind and within the view.
    behind = tuple(map(round, VIEWS.position(SIDE, (1e6, 0.0, 0.0))))
    assert places[MovablePoint(LIGHT, SIDE, "key")] == behind
    assert places[MovablePoint(LIGHT, TOP, "key")][0] == TOP.area.inset(EDGE).right
    assert places[MovablePoint(EYE, SIDE)][1] == SIDE.area.inset(EDGE).top


def test_what_is_chosen_goes_before_the_others() -> None:
    scene = boxed(*(Light(name, (0.0, 0.0, 1.0)) for name in ("a", "b", "c")))
    for chosen in ("a", "b", "c"):
        assert handles_in(scene, SIDE, chosen)[-1].key == MovablePoint(LIGHT, SIDE, chosen)
    assert [movable_of(each).what for each in handles_in(scene, SIDE, "")[-2:]] == [TARGET, EYE]


def test_the_line_of_a_flap_of_the_chosen_light_can_be_taken_hold_of_anywhere() -> None:
    flaps = Flaps(x=Flap(-1.0, 2.0), y=Flap(minimum=-3.0), z=Flap(0.0, 1.0))
    scene = boxed(KEY.replace(flaps=flaps), FILL.replace(flaps=flaps))
    found = [each for each in handles_in(scene, TOP) if movable_of(each).what == FLAP]
    upright = [each for each in found if each.key == MovablePoint(FLAP, TOP, "key", "x", "maximum")]
    level = [each for each in found if each.key == MovablePoint(FLAP, TOP, "key", "y", "minimum")]
    leftmost = [each for each in found if each.key == MovablePoint(FLAP, TOP, "key", "x", "minimum")]
    assert len(found) == len(upright) + len(level) + len(leftmost)
    assert {each.element for each in upright} == {round(VIEWS.position(TOP, (2.0, 0.0, 0.0))[0])}
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
    scene, light = boxed(KEY, spot), MovablePoint(LIGHT, TOP, "spot")
    (marked,) = (each for each in points_in(scene, VIEWS, TOP, "spot")[1] if each.movable == light)
    assert marked.point == scene.lights_in_world["spot"].position
    moved = light.put(scene, PLACE)
    assert moved.lights_in_world["spot"].position == pytest.approx(PLACE)
    assert moved.lights["spot"].follows == follows
    turned = light._replace(what=DIRECTION).put(moved, (1.5, -2.0, 8.0)).lights_in_world["spot"]
    assert turned.axis == pytest.approx((0.0, 0.0, 1.0), abs=1e-12)
    aimed = light._replace(what=AIM).put(moved, (0.0, 1.0, 2.0)).lights_in_world["spot"]
    assert aimed.aim == pytest.approx((0.0, 1.0, 2.0))
