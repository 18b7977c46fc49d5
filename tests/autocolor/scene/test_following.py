from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import (
    HalfSpace,
    InputError,
    Light,
    Scene,
    View,
    read_scene,
    render,
    write_scene,
)
from autocolor.checks import Vector
from autocolor.explanation.point import dot, minus, unit
from autocolor.rendering import rendering
from autocolor.scene.following import (
    DOWN_TO_UP,
    attached,
    changes_in_frame,
    detached,
    eye_frame,
    followers_of,
    frame_of,
    in_world,
    light_frame,
    lights_in_world,
    names_to_follow,
)
from autocolor.testing import directions, lights, outside_views, vectors, views
from tests.small import car, fresh, held, opened, wall_scene

VIEW = View((0.0, -4.0, 0.0), target=(0.0, 0.0, 0.0))


def followed_car() -> Scene:
    """The car, under a light at the eye and one beside the aim of the key light."""
    return (
        car()
        .with_light("fill", follows="key", position=(-2.0, -2.0, 1.5))
        .with_new_light("lamp", position=(0.0, 0.0, 0.0), intensity=0.3, follows="eye")
    )


def refused(make: Any) -> str:
    with pytest.raises(InputError) as refusal:
        make()
    return str(refusal.value)


@given(views() | outside_views())
def test_a_light_at_the_eye_gives_in_every_view_the_picture_of_a_point_light_there(view: View) -> None:
    scene = car().replace(view=view)
    follower = scene.replace(lights=[Light("lamp", (0.0, 0.0, 0.0), follows="eye")])
    placed = scene.replace(lights=[Light("lamp", view.eye)])
    assert render(follower, 12, 16).intensity.tobytes() == render(placed, 12, 16).intensity.tobytes()


@given(views())
def test_the_frame_of_the_eye_is_that_of_the_picture(view: View) -> None:
    frame = eye_frame(view)
    right, forward, up = frame.axes
    assert frame.point_to_world((0.0, 0.0, 0.0)) == view.eye
    assert np.array_equal([right, -up, forward], view.axes)
    assert np.cross(right, forward) == pytest.approx(up, abs=1e-12)
    assert np.array_equal(DOWN_TO_UP @ DOWN_TO_UP.T, np.eye(3))


@given(views(), vectors(), vectors(), directions())
def test_a_frame_converts_to_the_world_and_back(
    view: View, position: Vector, point: Vector, direction: Vector
) -> None:
    for frame in (eye_frame(view), light_frame(Light("light", position, direction=direction))):
        assert frame.point_from_world(frame.point_to_world(point)) == pytest.approx(point, abs=1e-12)
        turned = frame.direction_to_world(direction)
        assert frame.direction_from_world(turned) == pytest.approx(direction, abs=1e-12)
        assert math.hypot(*turned) == pytest.approx(math.hypot(*direction))
        assert math.dist(frame.point_to_world(point), frame.origin) == pytest.approx(math.hypot(*point))


@given(directions(), vectors())
def test_a_light_carries_things_ahead_along_its_direction(direction: Vector, position: Vector) -> None:
    frame = light_frame(Light("light", position, direction=direction))
    assert frame.direction_to_world((0.0, 1.0, 0.0)) == pytest.approx(unit(direction), abs=1e-12)
    assert frame.direction_to_world((1.0, 0.0, 0.0))[2] == pytest.approx(0.0, abs=1e-12)
    assert light_frame(Light("light", position)).axes.tolist() == np.eye(3).tolist()


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, -135.0])
def test_a_light_to_the_right_of_the_eye_stays_there_when_the_picture_is_turned(angle: float) -> None:
    view = VIEW.replace(angle=angle)
    row = Light("lamp", (1.0, 0.0, 0.0), direction=(-1.0, 4.0, 0.0), follows="eye")
    (light,) = lights_in_world((row,), view)
    camera = view.axes @ (np.array(light.position) - np.array(view.eye))
    assert camera == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)
    assert light.axis is not None
    assert view.axes @ np.array(light.axis) == pytest.approx(unit((-1.0, 0.0, 4.0)), abs=1e-12)
    (aimed,) = lights_in_world((row.replace(aim=(0.0, 4.0, 0.0)),), view)
    assert aimed.aim == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


@given(outside_views(), outside_views(), lights(follows="eye"))
def test_a_view_from_elsewhere_sees_the_light_of_the_eye_in_the_same_place(
    one: View, other: View, light: Light
) -> None:
    found = []
    for view in (one, other):
        (world,) = lights_in_world((light,), view)
        assert world.follows is None
        assert world.replace(position=light.position, direction=light.direction, follows="eye") == light
        axis = None if world.axis is None else (view.axes @ np.array(world.axis)).tolist()
        found.append(((view.axes @ (np.array(world.position) - np.array(view.eye))).tolist(), axis))
    for here, there in zip(*found, strict=True):
        assert here is there is None or here == pytest.approx(there, abs=1e-9)


def test_lights_that_follow_nothing_are_the_same_rows() -> None:
    scene = car()
    assert scene.lights_in_world is scene.lights
    assert scene.light_in_world("key") is scene.light("key")
    assert in_world(scene.light("key"), None) is scene.light("key")
    assert changes_in_frame({"position": (1, 2, 3)}, None) == {"position": (1, 2, 3)}


def test_a_light_that_follows_an_aim_moves_with_it() -> None:
    scene = followed_car()
    before = scene.light_in_world("fill").position
    assert before == (-2.0, -2.0, 1.5)
    moved = scene.with_light("key", aim=(0.5, 0.25, -1.0))
    assert moved.light_in_world("fill").position == (-1.5, -1.75, 0.5)
    # The place of the light that is followed does not matter.
    assert moved.with_light("key", position=(9, 9, 9)).light_in_world("fill").position == (-1.5, -1.75, 0.5)


def test_lights_follow_each_other_in_a_chain_in_any_order() -> None:
    last = Light("c", (0, 0, 1), follows="b")
    rows = (last, Light("b", (0, 1, 0), aim=(0, 2, 0), follows="a"), Light("a", (0, 0, 0), aim=(1, 0, 0)))
    for lights_of in (rows, rows[::-1]):
        world = {light.name: light for light in lights_in_world(lights_of, VIEW)}
        assert [light.name for light in lights_in_world(lights_of, VIEW)] == [each.name for each in lights_of]
        assert (world["b"].position, world["b"].aim) == ((1.0, 1.0, 0.0), (1.0, 2.0, 0.0))
        assert world["c"].position == (1.0, 2.0, 1.0)
        assert frame_of(last, world, VIEW) is not None
    # The first of the chain may follow the eye.
    (*_, first) = lights_in_world((*rows[:2], rows[2].replace(follows="eye")), VIEW)
    assert first.position == VIEW.eye


def test_a_chain_of_thousands_is_followed() -> None:
    count = 3000
    rows = [Light("0", (0, 0, 0), aim=(1, 0, 0))]
    rows += [Light(str(n), (0, 0, 0), aim=(1, 0, 0), follows=str(n - 1)) for n in range(1, count)]
    world = wall_scene(lights=rows[::-1]).lights_in_world
    assert world[0].position == (count - 1.0, 0.0, 0.0)


@given(vectors(), vectors().filter(any), st.sampled_from(["fill", "lamp"]))
def test_a_light_is_placed_in_the_world_whatever_it_follows(
    position: Vector, away: Vector, name: str
) -> None:
    scene = followed_car().with_view(eye=(3, -2, 1), angle=20)
    aim = (position[0] + away[0], position[1] + away[1], position[2] + away[2])
    placed = scene.with_light_in_world(name, position=position, aim=aim)
    light = placed.light_in_world(name)
    assert light.position == pytest.approx(position, abs=1e-9)
    assert light.aim == pytest.approx(aim, abs=1e-9)
    assert placed.light(name).follows == scene.light(name).follows
    turned = placed.with_light_in_world(name, direction=away, intensity=2).light_in_world(name)
    assert turned.direction == pytest.approx(away, abs=1e-9)
    assert (turned.aim, turned.intensity) == (None, 2.0)


def test_a_light_is_put_in_the_world_and_follows_something_else_at_once() -> None:
    scene = followed_car().with_view(angle=20)
    placed = scene.with_light_in_world("fill", follows="eye", position=(1, 2, 3))
    assert placed.light("fill").follows == "eye"
    assert placed.light_in_world("fill").position == pytest.approx((1, 2, 3))
    freed = scene.with_light_in_world("fill", follows=None, intensity=2)
    assert freed.light("fill").position == pytest.approx(scene.light_in_world("fill").position)
    assert (freed.light("fill").follows, freed.light("fill").intensity) == (None, 2.0)


@pytest.mark.parametrize("position", ["abc", (1, 2), ("x", 1, 2), None, (math.nan, 0, 0)])
def test_an_invalid_place_of_a_light_that_follows_is_refused_as_of_any_light(position: Any) -> None:
    told = []
    for follows in (None, "eye"):
        scene = car().with_light("fill", follows=follows)
        with pytest.raises(InputError) as refused:
            scene.with_light_in_world("fill", position=position)
        told.append(str(refused.value))
    assert told[0] == told[1]


@pytest.mark.parametrize("follows", ["eye", "key"])
@pytest.mark.parametrize("distance", [1e-30, 1e-12])
def test_an_aim_that_rounding_would_move_onto_its_light_still_tells_the_direction(
    follows: str, distance: float
) -> None:
    light = Light("near", (0, 0, 0), aim=(0, distance, 0), follows=follows, concentration=5)
    scene = wall_scene(view=VIEW, lights=[Light("key", (0, -3, 0), aim=(0.7, -2, 0.1)), light])
    assert scene.light_in_world("near").axis == pytest.approx((0, 1, 0), abs=1e-6)
    followed = scene.with_new_light("last", position=(0, 0, 0), follows="near").light_in_world("last")
    assert followed.position == pytest.approx(scene.light_in_world("near").position, abs=1e-8)
    assert render(scene, 8, 8).intensity.max() > 0


def test_a_light_farther_than_any_place_in_a_file_still_carries_its_half_spaces() -> None:
    far = Light("far", (9e35, 0, 0), follows="key", aim=(0, 0, 0)).replace(
        half_spaces={"door": {"point": (0, 0, 0), "direction": (0, 1, 0), "carried": True}}
    )
    scene = wall_scene(view=VIEW, lights=[Light("key", (0, -3, 0), aim=(9e35, 0, 0)), far])
    assert render(scene, 8, 8).lines == 8


def test_a_light_named_eye_exists_but_to_follow_eye_means_the_eye() -> None:
    scene = wall_scene(
        lights=[Light("eye", (5, 5, 5), aim=(0, 0, 0), follows="eye"), Light("b", (0, 0, 0), follows="eye")]
    )
    assert scene.light_in_world("b").position == scene.view.eye
    assert followers_of("eye", scene.lights) == []
    assert names_to_follow(scene.light("b"), scene.lights) == []
    assert [light.name for light in scene.without_light("eye").lights] == ["b"]


def test_the_lights_that_can_be_followed_have_an_aim_and_do_not_follow_it_themselves() -> None:
    rows = [
        Light("a", (0, 0, 0), aim=(1, 0, 0)),
        Light("b", (0, 0, 0), aim=(1, 0, 0), follows="a"),
        Light("c", (0, 0, 0), aim=(1, 0, 0), follows="b"),
        Light("d", (0, 0, 0)),
    ]
    found = {light.name: names_to_follow(light, rows) for light in rows}
    assert found == {"a": [], "b": ["a"], "c": ["a", "b"], "d": ["a", "b", "c"]}
    assert followers_of("a", rows) == ["b"]


CIRCLE = "light 'a': follows must not lead back to it, as 'a' to 'b' to 'a' does; change one of them"


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        ({"a": "b", "b": "a"}, CIRCLE),
        ({"c": "a", "a": "b", "b": "a"}, CIRCLE),
        (
            {"a": "a"},
            "light 'a': follows must not lead back to it, as 'a' to 'a' does; change one of them",
        ),
        (
            {"a": "lamp"},
            "light 'a': follows must be a light with an aim, not 'lamp' without one; give it an aim",
        ),
        (
            {str(n): str((n + 1) % 20) for n in range(20)},
            "light '0': follows must not lead back to it, as '0' to '1' to '2' to '3' to '4' to '5' to ... to"
            " '0' does; change one of them",
        ),
        ({"a": "bb"}, "light 'a': follows 'bb' is not in the light table; choose 'eye', 'lamp' or 'a'"),
    ],
)
def test_circles_and_lights_without_an_aim_are_refused(rows: dict[str, str], sentence: str) -> None:
    table = [
        Light("lamp", (1, 1, 1)),
        *(Light(name, (0, 0, 0), aim=(1, 0, 0), follows=follows) for name, follows in rows.items()),
    ]
    assert refused(lambda: wall_scene(lights=table)) == sentence


def test_a_followed_light_keeps_its_aim_its_name_and_its_place_in_the_scene() -> None:
    scene = followed_car()
    assert refused(lambda: scene.with_light("key", direction=(0, 0, -1))) == (
        "light 'fill': follows must be a light with an aim, not 'key' without one; give it an aim"
    )
    assert refused(lambda: scene.with_light("key", name="main")) == (
        "light 'fill': follows 'key' is not in the light table; did you mean 'eye'?"
    )
    assert refused(lambda: scene.without_light("key")) == (
        "light 'key' must stay while 'fill' follows it; let 'fill' follow something else"
    )
    assert refused(lambda: scene.with_light("key", follows="fill")) == (
        "light 'key': follows must not lead back to it, as 'key' to 'fill' to 'key' does; change one of them"
    )


def test_a_scene_file_with_followers_reads_back_the_same_and_tells_a_circle(tmp_path: Path) -> None:
    scene = followed_car()
    write_scene(tmp_path / "scene", scene)
    read = read_scene(tmp_path / "scene")
    assert [light.follows for light in read.lights] == [None, "key", "eye"]
    assert read.lights == scene.lights
    file = tmp_path / "scene" / "scene.toml"
    text = file.read_text("utf-8")
    file.write_text(text.replace('follows = "key"', 'follows = "fill"'), "utf-8")
    assert "light 'fill': follows must not lead back to it, as 'fill' to 'fill' does" in refused(
        lambda: read_scene(tmp_path / "scene")
    )


def test_moving_an_aim_computes_that_light_and_its_followers_and_nothing_else() -> None:
    scene = followed_car()
    before = rendering(scene, 24, 32)
    moved = scene.with_light("key", aim=(0.2, 0.0, 0.1))
    after = rendering(moved, 24, 32, before)
    kept = {
        name: planes.values is before.picture.light_planes[name].values
        for name, planes in after.picture.light_planes.items()
    }
    assert kept == {"key": False, "fill": False, "lamp": True}
    assert after.picture.intensity.tobytes() == render(moved, 24, 32).intensity.tobytes()
    # Its intensity and its position are its own.
    for changes, expected in (({"intensity": 0.5}, True), ({"position": (3, -3, 3)}, False)):
        edited = rendering(scene.with_light("key", **changes), 24, 32, before)
        planes = edited.picture.light_planes
        assert planes["fill"].values is before.picture.light_planes["fill"].values
        assert (planes["key"].values is before.picture.light_planes["key"].values) == expected


def test_an_edit_of_the_eye_or_a_followed_light_gives_the_fresh_picture() -> None:
    studio, display = opened(followed_car())
    for edit in (
        lambda: studio.light("key", aim=(0.3, 0.1, 0.2)),
        lambda: studio.view(eye=(2.0, -3.5, 1.5), angle=15),
        lambda: studio.light("fill", follows="eye"),
        lambda: studio.light("lamp", follows="key", position=(0, -2, 0)),
        lambda: studio.light("key", position=(1, -4, 2)),
        lambda: studio.light("lamp", follows=None),
        studio.undo,
        studio.undo,
    ):
        edit()
        assert held(display) == fresh(studio.scene)


@given(outside_views(), lights("key", aim=(0.1, 0.2, 0.3), direction=None), vectors())
def test_a_follower_lights_like_a_light_at_its_place(view: View, key: Light, position: Vector) -> None:
    scene = wall_scene(view=view, lights=[key, Light("b", position, aim=(9, 9, 9), follows="key")])
    placed = scene.replace(lights=scene.lights_in_world)
    assert render(scene, 8, 8).intensity.tobytes() == render(placed, 8, 8).intensity.tobytes()
    assert minus(placed.light("b").position, position) == pytest.approx([0.1, 0.2, 0.3])
    assert dot(placed.light("b").aim or (0, 0, 0), (1, 0, 0)) == pytest.approx(9.1)


@pytest.mark.parametrize("follows", ["eye", "key"])
def test_a_light_that_begins_to_follow_stays_where_it_is(follows: str) -> None:
    scene = car().with_view(angle=25).with_light("key", aim=(0.2, 0.1, 0.0))
    before = scene.light("fill").replace(aim=(0.5, 0.5, 0.5))
    scene = scene.with_light("fill", aim=before.aim)
    following = scene.with_light_following("fill", follows)
    assert following.light("fill").follows == follows
    assert following.light("fill").position != before.position
    for back in (following, following.with_light_following("fill", None)):
        light = back.light_in_world("fill")
        assert light.position == pytest.approx(before.position)
        assert light.aim == pytest.approx(before.aim)
    assert back.light("fill").follows is None


@given(lights(follows="eye"), st.sampled_from("xyz"), vectors())
def test_the_mirrored_copy_of_a_follower_is_mirrored_in_the_world_and_follows(
    light: Light, axis: str, eye: Vector
) -> None:
    scene = car().with_view(eye=(eye[0] + 5, eye[1], eye[2]), angle=30)
    scene = scene.replace(lights=(*scene.lights, light.replace(name="lamp", flaps={})))
    both = scene.with_mirrored_light("lamp", axis, 0.25, "other")
    one, other = both.light_in_world("lamp"), both.light_in_world("other")
    assert both.light("other").follows == "eye"
    place = "xyz".index(axis)
    mirrored = np.array(one.position)
    mirrored[place] = 0.5 - mirrored[place]
    assert other.position == pytest.approx(mirrored, abs=1e-9)
    if one.axis is not None:
        turned = np.array(one.axis)
        turned[place] *= -1
        assert other.axis == pytest.approx(turned, abs=1e-9)


LEFT = HalfSpace("left", (0.5, 2.0, 0.25), (1.0, 0.0, 0.0), edge_width=0.1, carried=True)


def test_a_carried_half_space_is_given_to_the_right_of_its_light_along_it_and_up() -> None:
    light = Light("light", (1.0, 2.0, 3.0), direction=(1.0, 0.0, 0.0))
    placed = detached(LEFT, light)
    assert placed.point == pytest.approx((3.0, 1.5, 3.25))
    assert placed.direction == pytest.approx((0.0, -1.0, 0.0))
    assert (placed.carried, placed.edge_width, placed.on) == (False, 0.1, True)


def test_a_point_source_carries_along_the_axes_of_the_world() -> None:
    placed = detached(LEFT, Light("light", (1.0, 2.0, 3.0)))
    assert placed.point == (1.5, 4.0, 3.25)
    assert placed.direction == (1.0, 0.0, 0.0)


@given(vectors(), directions(), vectors(), directions())
def test_a_half_space_attached_and_detached_again_is_where_it_was(
    position: Vector, toward: Vector, point: Vector, direction: Vector
) -> None:
    light = Light("light", position, direction=toward)
    there = HalfSpace("left", point, direction)
    carried = attached(there, light)
    assert carried.carried
    back = detached(carried, light)
    assert back.point == pytest.approx(point, abs=1e-12)
    assert back.direction == pytest.approx(direction, abs=1e-12)
    assert not back.carried


def test_attaching_or_detaching_twice_changes_nothing() -> None:
    light = Light("light", (1.0, 2.0, 3.0), direction=(1.0, 0.0, 0.0))
    placed = detached(LEFT, light)
    assert detached(placed, light) is placed
    assert attached(LEFT, light) is LEFT
