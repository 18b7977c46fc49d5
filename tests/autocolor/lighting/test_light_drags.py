from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, HalfSpace, Light, Scene, UsageError, View, read_scene
from autocolor.lighting.highlights import highlight_of
from autocolor.lighting.light_controls.flap_sides import Axis, FlapEnd
from autocolor.lighting.light_drags import (
    LEAST_CONE,
    cone_placed,
    flap_placed,
    half_space_placed,
    highlight_placed,
)
from autocolor.rendering import rendering
from autocolor.scene.columns.rows import with_values
from autocolor.scene.lights.carried import set_down
from autocolor.visibility.sight import Seen, Sight, seen_at
from tests.autocolor.meshes import sphere, wall, wall_scene
from tests.autocolor.reference import dot, minus, plus, times, unit
from tests.autocolor.strategies import Vector, directions, numbers, outside_views, vectors

LINES, ELEMENTS = 12, 16

MESHES = [wall(3, 2, half=2.0), sphere(32, 16)]

pixels = st.tuples(st.integers(0, LINES - 1), st.integers(0, ELEMENTS - 1))
points = vectors(numbers(-2, 2))
far_positions = vectors(numbers(-9, 9)).filter(lambda position: math.hypot(*position) > 4)


def at(point: Vector, normal: Vector = (0.0, -1.0, 0.0), reflected: Vector = (0.0, -1.0, 0.0)) -> Seen:
    return Seen("wall", "wall", 0, point, normal, reflected)


def lit(light: Light) -> Scene:
    return wall_scene(lights=[Light("other", (1.0, -2.0, 3.0)), light])


@given(outside_views(), pixels, st.sampled_from(MESHES), far_positions, st.none() | directions)
def test_the_light_is_where_the_view_is_reflected_to_and_as_far_as_before(
    view: View, pixel: tuple[int, int], mesh: Any, position: Vector, direction: Vector | None
) -> None:
    scene = wall_scene(mesh, view=view, lights=[Light("light", position, direction=direction)])
    seen = seen_at(Sight(scene, rendering(scene, LINES, ELEMENTS).points), *pixel)
    assume(seen is not None)
    assert seen is not None
    assume(dot(seen.normal, minus(view.eye, seen.point)) > 1e-3)
    light = highlight_placed(scene, seen, "light").light("light")
    assert math.dist(light.position, seen.point) == pytest.approx(math.dist(position, seen.point))
    # Figure 2: E is the angle between the reflected ray of light and the ray to the eye.
    to_light = unit(minus(light.position, seen.point))
    reflected = minus(times(2 * dot(to_light, seen.normal), seen.normal), to_light)
    assert dot(reflected, unit(minus(view.eye, seen.point))) == pytest.approx(1.0, abs=1e-6)
    assert dot(to_light, seen.normal) > 0
    assert light.aim is None
    if direction is None:
        assert light.direction is None
    else:
        assert light.direction == pytest.approx(times(-1, to_light), abs=1e-9)


@given(points, directions, far_positions)
def test_a_light_with_an_aim_is_aimed_at_the_point_and_keeps_all_else(
    point: Vector, normal: Vector, position: Vector
) -> None:
    x, y, z = unit(normal)
    before = Light("light", position, 2.5, aim=(0.0, 0.0, 0.0), concentration=3, cone_angle=20)
    scene = lit(before)
    after = highlight_placed(scene, at(point, (x, y, z), (x, y, z)), "light")
    assert after.light("other") is scene.light("other")
    expected = plus(point, times(math.dist(position, point), (x, y, z)))
    assert after.light("light").position == pytest.approx(expected)
    assert after.light("light").aim == point
    assert after.light("light").replace(position=position, aim=before.aim) == before


def test_placing_a_highlight_again_at_the_same_point_changes_nothing() -> None:
    seen = at((0.25, 0.0, 0.5), (0.0, -1.0, 0.0), (0.6, -0.8, 0.0))
    once = highlight_placed(lit(Light("light", (3.0, -4.0, 0.5), aim=(0, 0, 0))), seen, "light")
    twice = highlight_placed(once, seen, "light").light("light")
    assert twice.position == pytest.approx(once.light("light").position, abs=1e-12)
    assert twice.aim == once.light("light").aim


def test_a_highlight_needs_a_surface_that_faces_the_eye_and_a_light_away_from_it() -> None:
    scene = lit(Light("light", (0.5, 0.0, 0.5)))
    turned = at((0.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.6, 0.8, 0.0))
    for seen, message in (
        (None, "a highlight must be dragged to a surface, not to the background; choose another pixel"),
        (
            turned,
            "a highlight must be placed where the normal faces the eye, not where 'wall' turns away; choose"
            " another pixel",
        ),
        (
            at((0.5, 0.0, 0.5)),
            "light 'light' must be away from the point of its highlight, not at (0.5, 0.0, 0.5); move it"
            " first",
        ),
    ):
        with pytest.raises(UsageError) as caught:
            highlight_placed(scene, seen, "light")
        assert str(caught.value) == message


def test_a_one_sided_wall_seen_from_behind_gets_no_highlight_and_a_two_sided_one_does() -> None:
    view = View((0.3, 4.0, 0.5), target=(0.0, 0.0, 0.0))
    for two_sided in (True, False):
        scene = wall_scene(view=view, two_sided=two_sided, lights=[Light("light", (0.0, 5.0, 0.0))])
        seen = seen_at(Sight(scene, rendering(scene, LINES, ELEMENTS).points), LINES // 2, ELEMENTS // 2)
        if two_sided:
            assert highlight_placed(scene, seen, "light").light("light").position[1] > 0
        else:
            with pytest.raises(UsageError, match="the normal faces the eye"):
                highlight_placed(scene, seen, "light")


CAR = rendering(read_scene(Path(__file__).parents[3] / "scenes" / "coupe"), 48, 64)

KINDS: list[dict[str, Any]] = [
    {},
    {"direction": (0.3, 1.0, -0.2), "cone_angle": 40},
    {"aim": (-0.5, 0.2, 0.4), "concentration": 9},
    {"direction": (1.0, 0.5, -0.5), "at_infinity": True},
    {"aim": (0.25, 0.0, 0.5), "at_infinity": True, "intensity": 0.5},
]


@given(
    st.integers(0, 47),
    st.integers(0, 63),
    far_positions,
    st.sampled_from(KINDS),
    st.sampled_from([None, "eye", "key"]),
    st.booleans(),
)
def test_any_light_on_the_coupe_gets_its_highlight_where_it_is_wanted_and_is_found_there(
    line: int, element: int, position: Vector, kind: dict[str, Any], follows: str | None, is_followed: bool
) -> None:
    before = Light("lamp", position, follows=follows, **kind)
    scene = CAR.scene.replace(lights=(*CAR.scene.lights, before))
    if is_followed and before.aim is not None:
        scene = scene.with_new_light("beside", position=(0, 0, 0.5), follows="lamp")
    sight = Sight(scene, CAR.points)
    seen = seen_at(sight, line, element)
    assume(seen is not None)
    assert seen is not None
    assume(dot(seen.normal, unit(minus(scene.view.eye, seen.point))) > 1e-3)
    distance = math.dist(scene.light_in_world("lamp").position, seen.point)
    assume(distance > 1e-3)

    placed = highlight_placed(scene, seen, "lamp")
    light = placed.light_in_world("lamp")
    assert math.dist(light.position, seen.point) == pytest.approx(distance, rel=1e-9)
    to_light = unit(minus(light.position, seen.point))
    assert dot(to_light, seen.reflected_view) == pytest.approx(1.0, abs=1e-12)
    reflected = minus(times(2 * dot(to_light, seen.normal), seen.normal), to_light)
    assert dot(reflected, unit(minus(scene.view.eye, seen.point))) == pytest.approx(1.0, abs=1e-6)
    if before.direction is None and before.aim is None:
        assert light.axis is None
    else:
        assert light.axis == pytest.approx(times(-1, to_light), abs=1e-9)
        assert (light.aim is None) == (before.aim is None)
    if before.aim is not None:
        assert light.aim == pytest.approx(seen.point, abs=1e-12)
    # All else stays, and so does what follows it.
    after = placed.light("lamp")
    places = {"position": before.position, "aim": before.aim, "direction": before.direction}
    assert with_values(after, places) == before
    if is_followed and before.aim is not None:
        beside = placed.light_in_world("beside").position
        assert beside == pytest.approx(plus(seen.point, (0, 0, 0.5)), abs=1e-9)

    # The inverse finds the pixel, or one whose cosine is equal up to rounding.
    found = highlight_of(Sight(placed, CAR.points), "lamp", seen.surface)
    assert found is not None
    there = seen_at(sight, *found)
    assert there is not None
    toward = to_light if light.at_infinity else unit(minus(light.position, there.point))
    assert found == (line, element) or dot(toward, there.reflected_view) > 1 - 1e-6


def test_a_cone_and_a_flap_of_a_light_at_the_eye_end_at_what_is_seen() -> None:
    lamp = Light("lamp", (0, 0, 0), direction=(0, 1, 0), cone_angle=5, follows="eye")
    scene = CAR.scene.replace(lights=(*CAR.scene.lights, lamp))
    seen = seen_at(Sight(scene, CAR.points), 24, 20)
    assert seen is not None
    view = scene.view
    angle = cone_placed(scene, seen, "lamp").light("lamp").cone_angle
    cosine = dot(view.axes[2].tolist(), unit(minus(seen.point, view.eye)))
    assert angle == pytest.approx(math.degrees(math.acos(cosine)))
    flapped = flap_placed(scene, seen, "lamp", "x", "maximum", add=True).light("lamp")
    assert (flapped.flaps.x, flapped.follows) == (Flap(maximum=seen.point[0]), "eye")


def test_a_light_at_infinity_has_no_cone_to_be_dragged() -> None:
    scene = lit(Light("light", (0, -3, 0), direction=(0, 1, 0), cone_angle=30, at_infinity=True))
    with pytest.raises(UsageError) as caught:
        cone_placed(scene, at((0.25, 0.0, 0.25)), "light")
    assert str(caught.value) == (
        "a cone must end around a light that is somewhere, not around 'light' at infinity; switch"
        " at_infinity off"
    )


@given(points, far_positions, directions)
def test_a_cone_ends_at_the_point(point: Vector, position: Vector, direction: Vector) -> None:
    light = Light("light", position, direction=direction, cone_angle=30)
    angle = cone_placed(lit(light), at(point), "light").light("light").cone_angle
    cosine = dot(unit(direction), unit(minus(point, position)))
    assert angle is not None
    if math.cos(math.radians(LEAST_CONE)) > cosine > -1 + 1e-9:
        assert math.cos(math.radians(angle)) == pytest.approx(cosine, abs=1e-12)


def test_a_cone_has_an_angle_above_0_and_at_most_180() -> None:
    scene = lit(Light("light", (0.0, -3.0, 0.0), direction=(0.0, 1.0, 0.0), cone_angle=30))
    for point, angle in (
        ((0.0, 0.0, 0.0), LEAST_CONE),
        ((0.0, -5.0, 0.0), 180.0),
        ((3.0, -3.0, 0.0), 90.0),
        ((0.0, 0.0, 3.0), 45.0),
    ):
        assert cone_placed(scene, at(point), "light").light("light").cone_angle == pytest.approx(angle)


def test_a_light_gets_a_cone_only_when_asked_and_a_point_source_never() -> None:
    scene = lit(Light("light", (0.0, -3.0, 0.0), aim=(0.0, 0.0, 0.0)))
    added = cone_placed(scene, at((3.0, 0.0, 0.0)), "light", add=True)
    assert added.light("light").cone_angle == pytest.approx(45.0)
    for name, seen, add, message in (
        (
            "light",
            at((3.0, 0.0, 0.0)),
            False,
            "light 'light' must have a cone to be changed, not none; add one",
        ),
        (
            "light",
            None,
            True,
            "a cone must be dragged to a surface, not to the background; choose another pixel",
        ),
        (
            "light",
            at((0.0, -3.0, 0.0)),
            True,
            "a cone must end away from its light, not at 'light' itself; choose another pixel",
        ),
        (
            "other",
            at((3.0, 0.0, 0.0)),
            True,
            "a cone must have a direction or an aim, not be of the point source 'other'; add an aim",
        ),
    ):
        with pytest.raises(UsageError) as caught:
            cone_placed(scene, seen, name, add)
        assert str(caught.value) == message


@pytest.mark.parametrize("on", [True, False])
@pytest.mark.parametrize(("axis", "coordinate"), [("x", 0.25), ("y", -0.5), ("z", 0.75)])
def test_a_flap_ends_at_the_coordinate_of_the_point(axis: Axis, coordinate: float, on: bool) -> None:
    flaps = Flaps(**{name: Flap(-1.0, 1.0, on) for name in "xyz"})
    scene = lit(Light("light", (0.0, -3.0, 0.0), flaps=flaps))
    for end, flap in (
        ("minimum", Flap(coordinate, 1.0, on)),
        ("maximum", Flap(-1.0, coordinate, on)),
    ):
        after = flap_placed(scene, at((0.25, -0.5, 0.75)), "light", axis, end).light("light")  # type: ignore[arg-type]
        assert after.flaps == flaps.replace(**{axis: flap})


@given(numbers(-2, 2), numbers(-2, 2), numbers(-2, 2))
def test_the_minimum_never_passes_the_maximum(one: float, other: float, to: float) -> None:
    flap = Flap(min(one, other), max(one, other))
    scene = lit(Light("light", (0.0, -3.0, 0.0), flaps=Flaps(z=flap)))
    after = {
        end: flap_placed(scene, at((0.0, 0.0, to)), "light", "z", end).light("light").flaps.z
        for end in ("minimum", "maximum")
    }
    assert after["minimum"] == Flap(min(to, flap.maximum), flap.maximum)
    assert after["maximum"] == Flap(flap.minimum, max(to, flap.minimum))


def test_a_light_gets_a_flap_only_when_asked() -> None:
    scene = lit(Light("light", (0.0, -3.0, 0.0)))
    added = flap_placed(scene, at((0.25, 0.0, 0.0)), "light", "x", "maximum", add=True).light("light")
    assert added.flaps == Flaps(x=Flap(maximum=0.25))
    with pytest.raises(UsageError) as caught:
        flap_placed(scene, at((0.25, 0.0, 0.0)), "light", "x", "maximum")
    assert str(caught.value) == "light 'light' must have a flap in x to be changed, not none; add one"


@pytest.mark.parametrize(
    ("axis", "end", "message"),
    [
        ("w", "minimum", "the axis of a flap must be 'x', 'y' or 'z', not 'w'; choose another"),
        ("x", "left", "the end of a flap must be 'minimum' or 'maximum', not 'left'; choose another"),
    ],
)
def test_an_unknown_axis_or_end_of_a_flap_is_refused(axis: Axis, end: FlapEnd, message: str) -> None:
    scene = lit(Light("light", (0.0, -3.0, 0.0), flaps=Flaps(x=Flap())))
    with pytest.raises(UsageError) as caught:
        flap_placed(scene, at((0.25, 0.0, 0.0)), "light", axis, end)
    assert str(caught.value) == message


def test_a_flap_is_not_dragged_to_the_background() -> None:
    with pytest.raises(UsageError) as caught:
        flap_placed(lit(Light("light", (0.0, -3.0, 0.0))), None, "light", "x", "minimum", add=True)
    assert str(caught.value) == (
        "a flap must be dragged to a surface, not to the background; choose another pixel"
    )


def test_the_inner_angle_of_a_cone_stays_within_it() -> None:
    light = Light("light", (0.0, -2.0, 0.0), aim=(0.0, 0.0, 0.0), cone_angle=30, inner_angle=20)
    wide = cone_placed(lit(light), at((3.0, 0.0, 0.0)), "light").light("light")
    assert wide.cone_angle == pytest.approx(math.degrees(math.atan2(3, 2)))
    assert wide.inner_angle == 20
    narrow = cone_placed(lit(light), at((0.5, 0.0, 0.0)), "light").light("light")
    assert narrow.cone_angle == pytest.approx(math.degrees(math.atan2(0.5, 2)))
    assert narrow.inner_angle == narrow.cone_angle


@given(points, vectors(), directions, st.booleans(), st.none() | directions)
def test_a_half_space_ends_at_the_point_and_moves_along_its_direction(
    point: Vector, start: Vector, direction: Vector, carried: bool, toward: Vector | None
) -> None:
    planes = (
        HalfSpace("left", start, direction, edge_width=0.3, carried=carried),
        HalfSpace("right", start, direction, on=False),
    )
    light = Light("light", (0.3, -2.0, 0.5), direction=toward, half_spaces=planes)
    placed = half_space_placed(lit(light), at(point), "light", "left").light("light")
    left, right = placed.half_spaces
    assert right == planes[1]
    assert left == planes[0].replace(point=left.point)
    in_world = set_down(left, placed)
    assert dot(minus(in_world.point, point), unit(in_world.direction)) == pytest.approx(0, abs=1e-9)
    across = np.cross(minus(left.point, start), unit(direction))
    assert across == pytest.approx(np.zeros(3), abs=1e-9)


def test_a_half_space_that_is_not_there_and_the_background_are_refused() -> None:
    light = Light("light", (0.0, -2.0, 0.0), half_spaces=(HalfSpace("left", (0, 0, 0), (1, 0, 0)),))
    with pytest.raises(UsageError) as refusal:
        half_space_placed(lit(light), at((0.0, 0.0, 0.0)), "light", "lef")
    assert str(refusal.value) == "there is no half-space 'lef' of light 'light'; did you mean 'left'?"
    with pytest.raises(UsageError) as refusal:
        half_space_placed(lit(light), at((0.0, 0.0, 0.0)), "other", "left")
    assert str(refusal.value) == "there is no half-space 'left' of light 'other'; add one"
    with pytest.raises(UsageError, match=r"^a half-space must be dragged to a surface, not to the back"):
        half_space_placed(lit(light), None, "light", "left")
