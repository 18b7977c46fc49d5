from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import (
    Flap,
    Flaps,
    HalfSpace,
    InputError,
    Light,
    Rig,
    Scene,
    View,
    render,
    scene_of,
)
from autocolor.checks import Vector
from autocolor.scene.columns import from_plain, to_plain
from autocolor.scene.following import (
    attached,
    detached,
    followers_of,
    frame_of,
    lights_in_world,
    names_to_follow,
)
from autocolor.scene.lights import AXES
from autocolor.scene.rigs import mirrored
from autocolor.testing import coordinates, directions, lights, scenes, vectors
from tests.autocolor.twins.point import unit
from tests.small import car, cube, wall_scene
from tests.tables import call, refused

VIEW = View((0.0, -4.0, 0.0), target=(0.0, 0.0, 0.0))


def followed_car() -> Scene:
    """The car, under a light at the eye and one beside the aim of the key light."""
    return (
        car()
        .with_light("fill", follows="key", position=(-2.0, -2.0, 1.5))
        .with_new_light("lamp", position=(0.0, 0.0, 0.0), intensity=0.3, follows="eye")
    )


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, -135.0])
def test_a_light_to_the_right_of_the_eye_stays_there_when_the_picture_is_turned(angle: float) -> None:
    view = VIEW.replace(angle=angle)
    row = Light("lamp", (1.0, 2.0, 3.0), direction=(-1.0, 4.0, 2.0), follows="eye")
    (light,) = lights_in_world((row,), view)
    camera = view.axes @ (np.array(light.position) - np.array(view.eye))
    # Right, down and forward.
    assert camera == pytest.approx([1.0, -3.0, 2.0], abs=1e-12)
    assert light.axis is not None
    assert view.axes @ np.array(light.axis) == pytest.approx(unit((-1.0, -2.0, 4.0)), abs=1e-12)
    (aimed,) = lights_in_world((row.replace(aim=(0.0, 4.0, 0.0)),), view)
    assert aimed.aim == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_a_light_that_follows_an_aim_moves_with_it() -> None:
    scene = followed_car()
    before = scene.lights_in_world["fill"].position
    assert before == (-2.0, -2.0, 1.5)
    moved = scene.with_light("key", aim=(0.5, 0.25, -1.0))
    assert moved.lights_in_world["fill"].position == (-1.5, -1.75, 0.5)
    # The place of the light that is followed does not matter.
    assert moved.with_light("key", position=(9, 9, 9)).lights_in_world["fill"].position == (-1.5, -1.75, 0.5)


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


@pytest.mark.thorough
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
    light = placed.lights_in_world[name]
    assert light.position == pytest.approx(position, abs=1e-9)
    assert light.aim == pytest.approx(aim, abs=1e-9)
    assert placed.lights[name].follows == scene.lights[name].follows
    turned = placed.with_light_in_world(name, direction=away, intensity=2).lights_in_world[name]
    assert turned.direction == pytest.approx(away, abs=1e-9)
    assert (turned.aim, turned.intensity) == (None, 2.0)


def test_a_light_is_put_in_the_world_and_follows_something_else_at_once() -> None:
    scene = followed_car().with_view(angle=20)
    placed = scene.with_light_in_world("fill", follows="eye", position=(1, 2, 3))
    assert placed.lights["fill"].follows == "eye"
    assert placed.lights_in_world["fill"].position == pytest.approx((1, 2, 3))
    freed = scene.with_light_in_world("fill", follows=None, intensity=2)
    assert freed.lights["fill"].position == pytest.approx(scene.lights_in_world["fill"].position)
    assert (freed.lights["fill"].follows, freed.lights["fill"].intensity) == (None, 2.0)


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
    assert scene.lights_in_world["near"].axis == pytest.approx((0, 1, 0), abs=1e-6)
    followed = scene.with_new_light("last", position=(0, 0, 0), follows="near").lights_in_world["last"]
    assert followed.position == pytest.approx(scene.lights_in_world["near"].position, abs=1e-8)
    assert render(scene, (8, 8)).intensity.max() > 0


def test_a_light_named_eye_exists_but_to_follow_eye_means_the_eye() -> None:
    scene = wall_scene(
        lights=[Light("eye", (5, 5, 5), aim=(0, 0, 0), follows="eye"), Light("b", (0, 0, 0), follows="eye")]
    )
    assert scene.lights_in_world["b"].position == scene.view.eye
    assert followers_of("eye", scene.lights) == []
    assert names_to_follow(scene.lights["b"], scene.lights) == []
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


@given(lights(follows="eye"), st.sampled_from("xyz"), vectors())
def test_the_mirrored_copy_of_a_follower_is_mirrored_in_the_world_and_follows(
    light: Light, axis: str, eye: Vector
) -> None:
    scene = car().with_view(eye=(eye[0] + 5, eye[1], eye[2]), angle=30)
    scene = scene.replace(lights=(*scene.lights, light.replace(name="lamp", flaps={})))
    both = scene.with_mirrored_light("lamp", axis, 0.25, "other")
    one, other = both.lights_in_world["lamp"], both.lights_in_world["other"]
    assert both.lights["other"].follows == "eye"
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


LETTERS = "abcdefghi"


def circle(count: int) -> dict[str, str]:
    """Lights, the first letters, each of which follows the next one, and the last the first."""
    return {LETTERS[at]: LETTERS[(at + 1) % count] for at in range(count)}


test_circles_and_lights_without_an_aim_are_refused = refused(
    lambda rows: wall_scene(
        lights=[
            Light("lamp", (1, 1, 1)),
            *(Light(name, (0, 0, 0), aim=(1, 0, 0), follows=follows) for name, follows in rows.items()),
        ]
    ),
    [
        *(
            (rows, f"light 'a': follows must not lead back to it, as {path} does; change one of them")
            for rows, path in (
                (circle(1), "'a' to 'a'"),
                (circle(2), "'a' to 'b' to 'a'"),
                ({"i": "a", **circle(2)}, "'a' to 'b' to 'a'"),
            )
        ),
        (
            {"a": "lamp"},
            "light 'a': follows must be a light with an aim, not 'lamp' without one; give it an aim",
        ),
        ({"a": "bb"}, "light 'a': follows 'bb' is not in the light table; choose 'eye', 'lamp' or 'a'"),
    ],
)

test_a_followed_light_keeps_its_aim_its_name_and_its_place_in_the_scene = refused(
    lambda edit: edit(followed_car()),
    [
        (
            lambda scene: scene.with_light("key", direction=(0, 0, -1)),
            "light 'fill': follows must be a light with an aim, not 'key' without one; give it an aim",
        ),
        (
            lambda scene: scene.with_light("key", name="main"),
            "light 'fill': follows 'key' is not in the light table; did you mean 'eye'?",
        ),
        (
            lambda scene: scene.without_light("key"),
            "light 'key' must stay while 'fill' follows it; let 'fill' follow something else",
        ),
    ],
)


@given(scenes())
def test_a_rig_on_its_own_scene_gives_the_same_lights_exactly(scene: Scene) -> None:
    assert scene.replace(lights=()).with_rig(scene.rig).lights == scene.lights
    assert from_plain(Rig, to_plain(scene.rig)) == scene.rig


def test_a_rig_is_fitted_to_the_middle_and_the_size_of_the_object() -> None:
    rig = Rig(
        (0, 0, 0),
        (1, 1, 1),
        (
            Light(
                "key",
                (0.5, -3.5, 2.5),
                aim=(0.5, 0.5, 0.0),
                flaps=Flaps(y=Flap(0, 1, False), z=Flap(0.25)),
            ),
            Light("sun", (0.5, 0.5, 9.5), direction=(0, 1, -1)),
        ),
    )
    key, sun = rig.fitted((-1, -1, -1), (1, 1, 1))
    assert key == Light("key", (0, -8, 4), aim=(0, 0, -1), flaps=Flaps(z=Flap(-0.5), y=Flap(-1, 1, on=False)))
    assert sun == Light("sun", (0, 0, 18), direction=(0, 1, -1))


def test_an_object_twice_as_large_looks_the_same_with_a_fitted_rig() -> None:
    planes = (
        HalfSpace("across", (0.2, 0, 0.3), (1, 0, 1), edge_width=0.3),
        HalfSpace("door", (-0.1, 0, 0), (1, 0, 0), edge_width=0.2, carried=True),
    )
    flaps = Flaps(x=Flap(0.1, edge_width=0.4), z=Flap(0.3))
    key = Light("key", (-2, -3, 4), aim=(0.5, 0.2, 0.9), concentration=6, flaps=flaps, half_spaces=planes)
    small = scene_of(cube(), lights=[key, key.replace(name="bare", half_spaces=(), flaps=Flaps())])
    large = scene_of(cube(2.0), lights=()).with_rig(small.rig)
    for is_on in (True, False):
        each_alone = (each.with_light("bare", on=is_on) for each in (small, large))
        one, other = (render(each, (32, 24)).intensity for each in each_alone)
        assert np.ptp(one) > 0.01
        assert np.allclose(one, other, atol=1e-5)


def test_an_object_without_size_moves_the_lights_and_keeps_distances() -> None:
    rig = Rig((1, 1, 1), (1, 1, 1), (Light("key", (1, 1, 3)),))
    assert rig.fitted((0, 0, 0), (2, 2, 4))[0].position == (1, 1, 4)
    assert Rig((0, 0, 0), (2, 2, 4), rig.lights).fitted((1, 1, 1), (1, 1, 1))[0].position == (1, 1, 2)


def test_lights_that_follow_keep_their_place_in_sizes_of_the_object() -> None:
    rig = Rig(
        (0, 0, 0),
        (1, 1, 1),
        (
            Light("key", (0.5, -3.5, 2.5), aim=(0.5, 0.5, 0.0)),
            Light("beside", (0, 0, 2), aim=(1, 0, 0), follows="key"),
            Light("lamp", (0, 0, 0), follows="eye"),
            Light("left", (-1, 0, 0), direction=(1, 3, 0), follows="eye"),
        ),
    )
    _, beside, lamp, left = rig.fitted((-1, -1, -1), (1, 1, 1))
    assert beside == Light("beside", (0, 0, 4), aim=(2, 0, 0), follows="key")
    assert lamp == rig.lights[2]
    assert left == Light("left", (-2, 0, 0), direction=(1, 3, 0), follows="eye")
    small = scene_of(cube(), lights=rig.lights)
    large = scene_of(cube(2.0), lights=()).with_rig(small.rig)
    one, other = (render(each, (32, 24)).intensity for each in (small, large))
    assert np.allclose(one, other, atol=1e-5)


@given(lights(), st.sampled_from(AXES), coordinates())
def test_the_half_spaces_of_a_mirrored_light_are_mirrored_in_the_world(
    light: Light, axis: str, about: float
) -> None:
    there = mirrored(light, "there", axis, about)
    number = AXES.index(axis)
    for plane, copy in zip(light.half_spaces, there.half_spaces, strict=True):
        assert copy.carried == plane.carried
        one, other = detached(plane, light), detached(copy, there)
        point, direction = list(one.point), list(one.direction)
        point[number], direction[number] = 2 * about - point[number], -direction[number]
        assert other.point == pytest.approx(point, abs=1e-9)
        assert other.direction == pytest.approx(direction, abs=1e-9)


def test_position_aim_and_one_flap_are_mirrored_and_nothing_else() -> None:
    light = Light(
        "key", (1, 2, 3), aim=(0, 1, 0), concentration=4, flaps=Flaps(Flap(0, 1), Flap(minimum=0.5))
    )
    assert mirrored(light, "other", "y", 1.0) == Light(
        "other", (1, 0, 3), aim=(0, 1, 0), concentration=4, flaps=Flaps(Flap(0, 1), Flap(maximum=1.5))
    )
    directed = Light("key", (1, 2, 3), direction=(0, 1, -1))
    assert repr(mirrored(directed, "key", "x", 0.0).direction) == "(0.0, 1.0, -1.0)"
    assert mirrored(directed, "key", "z", 0.0).direction == (0, 1, 1)


test_a_rig_or_a_mirror_that_breaks_a_rule_is_refused = refused(
    call,
    [
        (
            lambda: Rig((0, 2, 0), (1, 1, 1)),
            "rig: the minimum of y must be at most the maximum, not 2 to 1; exchange them",
        ),
        (
            lambda: mirrored(Light("key", (0, 0, 0)), "other", "X", math.pi),
            "an axis must be 'x', 'y' or 'z', not 'X'",
        ),
        (
            lambda: Rig((0, 0, 0), (1e-300, 0, 0), (Light("key", (0, 0, 1)),)).fitted(
                (0, 0, 0), (1e30, 0, 0)
            ),
            "light 'key': position must be three finite numbers of at most 1e36, not (-inf, nan, inf)",
        ),
    ],
)
