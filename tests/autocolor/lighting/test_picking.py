from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import (
    Flap,
    Flaps,
    HalfSpace,
    Light,
    Mesh,
    Reflectance,
    Scene,
    Studio,
    UsageError,
    View,
    read_scene,
    render,
)
from autocolor.checks import Vector
from autocolor.lighting.controls import Axis, FlapEnd
from autocolor.lighting.picking import (
    LEAST_CONE,
    Plane,
    Rim,
    cone_placed,
    flap_placed,
    half_space_placed,
    highlight_of,
    highlight_placed,
    rims,
    seen_highlight,
    specular_shares,
)
from autocolor.lighting.picture import Picture
from autocolor.lighting.shading import LightPlanes
from autocolor.rendering import Rendering, rendering
from autocolor.scene.columns import with_values
from autocolor.scene.following import detached
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong, ReflectionModel
from autocolor.testing import directions, lights, numbers, outside_views, vectors
from autocolor.visibility.visible_points import Seen, Sight, seen_at
from ramtek_emu import Ramtek9300
from tests.autocolor.twins.point import dot, minus, plus, times, unit
from tests.small import car, cube, grid, sphere, wall, wall_scene

LINES, ELEMENTS = 60, 80
COARSE_LINES, COARSE_ELEMENTS = 12, 16

MESHES = [wall(3, 2, half=2.0), sphere(32, 16)]

points = vectors(numbers(-2, 2))
far_positions = vectors(numbers(-9, 9)).filter(lambda position: math.hypot(*position) > 4)


def at(point: Vector, normal: Vector = (0.0, -1.0, 0.0), reflected: Vector = (0.0, -1.0, 0.0)) -> Seen:
    return Seen("wall", "wall", 0, point, normal, reflected)


def lit(light: Light) -> Scene:
    return wall_scene(lights=[Light("other", (1.0, -2.0, 3.0)), light])


@given(outside_views(), st.integers(0, 999), st.sampled_from(MESHES), far_positions, st.none() | directions())
def test_the_light_is_where_the_view_is_reflected_to_and_as_far_as_before(
    view: View, place: int, mesh: Any, position: Vector, direction: Vector | None
) -> None:
    scene = wall_scene(mesh, view=view, lights=[Light("light", position, direction=direction)])
    points = rendering(scene, COARSE_LINES, COARSE_ELEMENTS).points
    assume(len(points.pixels))
    pixel = int(points.pixels[place % len(points.pixels)])
    seen = seen_at(Sight(scene, points), *divmod(pixel, COARSE_ELEMENTS))
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


@given(points, directions(), far_positions)
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
        seen = seen_at(
            Sight(scene, rendering(scene, COARSE_LINES, COARSE_ELEMENTS).points),
            COARSE_LINES // 2,
            COARSE_ELEMENTS // 2,
        )
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


def test_a_cone_and_a_flap_of_a_light_at_the_eye_end_at_the_visible_point() -> None:
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


@given(points, far_positions, directions())
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


def test_the_inner_angle_of_a_cone_stays_within_it() -> None:
    light = Light("light", (0.0, -2.0, 0.0), aim=(0.0, 0.0, 0.0), cone_angle=30, inner_angle=20)
    wide = cone_placed(lit(light), at((3.0, 0.0, 0.0)), "light").light("light")
    assert wide.cone_angle == pytest.approx(math.degrees(math.atan2(3, 2)))
    assert wide.inner_angle == 20
    narrow = cone_placed(lit(light), at((0.5, 0.0, 0.0)), "light").light("light")
    assert narrow.cone_angle == pytest.approx(math.degrees(math.atan2(0.5, 2)))
    assert narrow.inner_angle == narrow.cone_angle


@given(points, vectors(), directions(), st.booleans(), st.none() | directions())
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
    in_world = detached(left, placed)
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


BALL = sphere(96, 48)

VIEWS = [
    View((0.0, -6.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=25.0),
    View((4.0, 3.0, 2.5), target=(0.1, 0.0, 0.2), field_of_view=30.0, angle=25.0),
    View((0.0, 0.0, 7.0), direction=(0.0, 0.0, -1.0), field_of_view=22.0),
]


def sight_of(rendered: Rendering) -> Sight:
    return Sight(rendered.scene, rendered.points)


def rendered(scene: Scene) -> Rendering:
    return rendering(scene, LINES, ELEMENTS)


def on_ball(model: ReflectionModel, view: View, light: Light) -> Scene:
    return wall_scene(BALL, view=view, lights=[light, Light("other", (1.0, 1.0, 1.0))]).with_surface(
        "sphere", reflectance=Reflectance(0.6, 0.5, model)
    )


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("pixel", [(30, 40), (20, 33), (41, 52), (33, 27)])
@pytest.mark.parametrize("model", [Phong(20.0), Phong(1.0), BlinnPhong(30.0)])
@pytest.mark.parametrize(
    "controls", [{}, {"aim": (0.0, 0.0, 0.0), "concentration": 10.0, "cone_angle": 30.0}]
)
def test_a_highlight_is_found_where_it_was_placed_and_nothing_is_brighter(
    view: View, pixel: tuple[int, int], model: ReflectionModel, controls: dict[str, object]
) -> None:
    light = Light("light", (3.0, -6.0, 4.0), **controls)  # type: ignore[arg-type]
    before = rendered(on_ball(model, view, light))
    scene = highlight_placed(before.scene, seen_at(sight_of(before), *pixel), "light")
    after = rendering(scene, LINES, ELEMENTS, before)
    assert highlight_of(sight_of(after), "light") == pixel
    # cos(E) is 1 there: so is its power, up to rounding.
    specular = after.picture.planes["light"].specular
    assert specular[pixel] == pytest.approx(1.0, abs=2e-5)
    assert specular[pixel] >= specular.max() - 1e-6


@pytest.mark.parametrize("pixel", [(30, 40), (20, 33), (41, 52)])
def test_the_peak_of_a_fine_metal_is_within_a_pixel(pixel: tuple[int, int]) -> None:
    before = rendered(on_ball(CookTorrance(0.1), VIEWS[0], Light("light", (3.0, -6.0, 4.0))))
    scene = highlight_placed(before.scene, seen_at(sight_of(before), *pixel), "light")
    specular = rendering(scene, LINES, ELEMENTS, before).picture.planes["light"].specular
    line, element = np.unravel_index(int(specular.argmax()), specular.shape)
    assert max(abs(int(line) - pixel[0]), abs(int(element) - pixel[1])) <= 1


@given(vectors(numbers(-1.2, 1.2)), numbers(0.5, 5))
def test_the_highlight_on_a_wall_is_where_the_mirror_image_of_the_light_is_seen(
    beside: tuple[float, float, float], before: float
) -> None:
    view = View((0.5, -4.0, 0.25), target=(0.0, 0.0, 0.0), field_of_view=40.0)
    light = Light("light", (beside[0], -before, beside[2]))
    sight = sight_of(rendered(wall_scene(wall(3, 3, half=3.0), view=view, lights=[light])))
    seen = seen_at(sight, *(highlight_of(sight, "light") or (0, 0)))
    assert seen is not None
    image = (beside[0], before, beside[2])
    expected = plus(view.eye, times(4.0 / (4.0 + before), minus(image, view.eye)))
    pixel = 2 * math.tan(math.radians(20)) * 4.1 / LINES
    assert math.dist(seen.point, expected) < pixel


@given(lights())
def test_the_highlight_is_at_the_largest_cosine_of_all_surfaces_or_of_a_surface(light: Light) -> None:
    # With an exponent of 1, Phong's specular plane is cos(E), where cos(I) is above 0.
    scene = car()
    for surface in scene.surfaces:
        scene = scene.with_surface(surface.name, reflectance=Reflectance(0.5, 0.5, Phong(1.0)))
    # Controls and switches are left out of it.
    bare = Light(light.name, light.position, direction=light.direction, at_infinity=light.at_infinity)
    cosines = render(scene.replace(lights=[bare]), (ELEMENTS, LINES)).planes[light.name].specular
    sight = sight_of(rendered(scene.replace(lights=[light])))
    numbers_at = rendered(scene).picture.surface_number
    for name in (None, "body", "glass", "wheels"):
        found = highlight_of(sight, light.name, name)
        number = 0 if name is None else [each.name for each in scene.surfaces].index(name) + 1
        here = cosines if name is None else np.where(numbers_at == number, cosines, 0)
        if found is None:
            assert here.max() <= 1e-6
        else:
            assert name is None or numbers_at[found] == number
            assert here[found] == pytest.approx(here.max(), abs=2e-5)


def test_there_is_no_highlight_where_no_light_is_reflected_to_the_eye() -> None:
    behind = wall_scene(lights=[Light("light", (0.0, 3.0, 0.0))])
    assert highlight_of(sight_of(rendered(behind)), "light") is None
    before = behind.with_light("light", position=(0.0, -3.0, 0.0))
    assert highlight_of(sight_of(rendered(before)), "light") is not None
    # A cube behind the wall is in use, but not seen.
    hidden = grid(1, 1, (-0.5, 1.0, -0.5), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), "hidden")
    both = wall_scene(Mesh.joined([wall(), hidden]), lights=before.lights)
    assert highlight_of(sight_of(rendered(both)), "light", "wall") is not None
    assert highlight_of(sight_of(rendered(both)), "light", "hidden") is None
    nothing = wall_scene(view=View((0.0, -4.0, 0.0), direction=(0.0, -1.0, 0.0)), lights=before.lights)
    assert highlight_of(sight_of(rendered(nothing)), "light") is None


def test_unknown_lights_and_surfaces_are_refused() -> None:
    sight = sight_of(rendered(wall_scene(cube(), lights=[Light("key", (0.1, -3.0, 0.3))])))
    with pytest.raises(UsageError, match=r"there is no light 'kee'; did you mean 'key'\?"):
        highlight_of(sight, "kee")
    with pytest.raises(UsageError, match=r"there is no surface 'cub'; did you mean 'cube'\?"):
        highlight_of(sight, "key", "cub")


VIEW = View((1.0, -4.0, 1.5), target=(0.0, 0.0, 0.0), field_of_view=35.0)

AIMS: list[dict[str, Any]] = [
    {},
    {"aim": (0.3, 0.2, 0.1)},
    {"direction": (0.2, 0.9, -0.4)},
    {"direction": (0.2, 0.9, -0.4), "at_infinity": True},
    {"aim": (0.3, 0.2, 0.1), "at_infinity": True},
]


def ball(kind: dict[str, Any]) -> Scene:
    lights = [Light("key", (1.0, -2.0, 2.0), **kind)]
    return wall_scene(sphere(96, 48), view=VIEW, lights=lights).replace(words="normals")


@cache
def studio_of(number: int) -> Studio:
    """A studio for lights of one of the kinds, made once."""
    return Studio(ball(AIMS[number]), Ramtek9300())


@pytest.mark.parametrize("number", range(len(AIMS)))
@given(line=st.integers(150, 330), element=st.integers(230, 410))
def test_where_words_stand_for_normals_a_highlight_is_where_it_is_placed(
    number: int, line: int, element: int
) -> None:
    studio = studio_of(number)
    seen = studio.seen_at(line, element)
    assert seen is not None
    before = studio.scene.light("key")
    studio.place_highlight("key", line, element)
    found = studio.highlight_of("key")
    assert found is not None
    assert math.dist(found, (line, element)) < 3
    light = studio.scene.light("key")
    assert math.dist(light.position, (0, 0, 0)) == pytest.approx(math.dist(before.position, (0, 0, 0)))
    # The brightest word is at the pixel, or in a cell beside it.
    brightness = studio.entries[studio.words].sum(axis=2, dtype=np.int64)
    around = brightness[line - 12 : line + 13, element - 12 : element + 13]
    assert around.max() == brightness.max()


FILLING = View((0.0, -4.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=25.0)
"""A wall of half a width of 2 fills the picture."""

WALL_VIEWS = [FILLING, View((1.5, -4.0, 1.0), target=(0.1, 0.0, 0.2), field_of_view=35.0, angle=20.0)]


def wall_sight(scene: Scene, block: int = 1) -> Sight:
    return Sight(scene, rendering(scene, LINES, ELEMENTS).points, block)


def points_at(sight: Sight, pixels: npt.NDArray[np.intp]) -> npt.NDArray[np.float64]:
    """The points seen at pixels, (n, 3)."""
    raster = np.full((LINES * ELEMENTS, 3), np.nan)
    raster[sight.points.pixels] = sight.points.world_points
    return raster.reshape(LINES, ELEMENTS, 3)[pixels[:, 0], pixels[:, 1]]


def lit_beside_dark(lit: npt.NDArray[np.bool_]) -> list[list[int]]:
    """The slow twin: the lit pixels with a dark one above, below, left or right of them."""
    return [
        [line, element]
        for line, element in np.argwhere(lit).tolist()
        if any(
            0 <= other < LINES and 0 <= another < ELEMENTS and not lit[other, another]
            for other, another in (
                (line - 1, element),
                (line + 1, element),
                (line, element - 1),
                (line, element + 1),
            )
        )
    ]


@pytest.mark.parametrize("view", WALL_VIEWS)
@pytest.mark.parametrize("angle", [5.0, 9.0, 12.0])
def test_the_rim_of_a_cone_straight_above_a_plane_is_a_circle(view: View, angle: float) -> None:
    light = Light("light", (0.1, -3.0, 0.05), direction=(0.0, 1.0, 0.0), cone_angle=angle)
    sight = wall_sight(wall_scene(wall(3, 2, half=2.0), view=view, lights=[light]))
    found = rims(sight, "light")
    assert list(found) == ["cone"]
    at = points_at(sight, found["cone"])
    radius, pixel = 3 * math.tan(math.radians(angle)), 2 * math.tan(math.radians(17.5)) * 5 / LINES
    distance = np.hypot(at[:, 0] - 0.1, at[:, 2] - 0.05)
    assert distance.max() <= radius + 1e-4
    assert distance.min() >= radius - 1.5 * pixel
    # It goes all the way around.
    around = np.sort(np.arctan2(at[:, 2] - 0.05, at[:, 0] - 0.1))
    assert np.diff(around, append=around[0] + 2 * math.pi).max() < 3 * pixel / radius


@given(numbers(1, 60), directions())
def test_the_rim_of_a_cone_is_where_the_light_ends(angle: float, direction: Vector) -> None:
    light = Light("light", (0.2, -1.0, 0.1), direction=direction, cone_angle=angle)
    scene = wall_scene(wall(3, 2, half=2.0), view=FILLING, lights=[light])
    lit = render(scene, (ELEMENTS, LINES)).planes["light"].diffuse > 0
    assert rims(wall_sight(scene), "light")["cone"].tolist() == lit_beside_dark(lit)


FLAPS: list[tuple[Rim, Flaps]] = [
    (("x", "minimum"), Flaps(x=Flap(minimum=0.21))),
    (("x", "maximum"), Flaps(x=Flap(maximum=0.21))),
    (("y", "minimum"), Flaps(y=Flap(minimum=-0.3))),
    (("y", "maximum"), Flaps(y=Flap(maximum=-0.3))),
    (("z", "minimum"), Flaps(z=Flap(minimum=-0.43))),
    (("z", "maximum"), Flaps(z=Flap(maximum=-0.43))),
]


@pytest.mark.parametrize("view", WALL_VIEWS)
@pytest.mark.parametrize(("rim", "flaps"), FLAPS)
def test_the_rim_of_a_flap_is_where_the_light_ends(rim: Rim, flaps: Flaps, view: View) -> None:
    leaning = grid(4, 4, (-2.0, -0.8, -2.0), (4.0, 0.5, 0.0), (0.0, 0.7, 4.0))
    light = Light("light", (0.2, -9.0, 0.1), flaps=flaps)
    scene = wall_scene(leaning, view=view, lights=[light])
    picture = render(scene, (ELEMENTS, LINES))
    lit = picture.planes["light"].diffuse > 0
    twin = [
        pixel
        for pixel in lit_beside_dark(lit | (picture.surface_number == 0))
        if picture.surface_number[tuple(pixel)]
    ]
    found = rims(wall_sight(scene), "light")
    assert list(found) == [rim]
    assert len(twin) > 20
    assert found[rim].tolist() == twin


def test_a_silhouette_is_no_rim() -> None:
    floating = Mesh.joined([cube(0.7), grid(2, 2, (-3.0, 4.0, -3.0), (6.0, 0.0, 0.0), (0.0, 0.0, 6.0))])
    light = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(y=Flap(maximum=2.0)))
    scene = wall_scene(floating, view=FILLING, lights=[light])
    picture = render(scene, (ELEMENTS, LINES))
    assert len(lit_beside_dark(picture.planes["light"].diffuse > 0)) > 20
    assert rims(wall_sight(scene), "light")["y", "maximum"].tolist() == []


def test_the_end_of_a_line_is_no_neighbor_of_the_next() -> None:
    light = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(minimum=0.0)))
    scene = wall_scene(wall(1, 1, half=3.0), view=FILLING, lights=[light])
    assert rims(wall_sight(scene), "light")["x", "minimum"].tolist() == [
        [line, ELEMENTS // 2] for line in range(LINES)
    ]


def test_only_controls_that_end_have_a_rim() -> None:
    for light in (
        Light("light", (0.0, -9.0, 0.0)),
        Light("light", (0.0, -9.0, 0.0), aim=(0, 0, 0), concentration=5),
        Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(0.0, 1.0, on=False), z=Flap())),
    ):
        assert rims(wall_sight(wall_scene(lights=[light])), "light") == {}
    aside = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(minimum=50.0)))
    found = rims(wall_sight(wall_scene(lights=[aside])), "light")
    assert {rim: pixels.shape for rim, pixels in found.items()} == {("x", "minimum"): (0, 2)}
    away = View((0.0, -4.0, 0.0), direction=(0.0, -1.0, 0.0))
    nothing = rims(wall_sight(wall_scene(view=away, lights=[aside])), "light")
    assert nothing["x", "minimum"].shape == (0, 2)


def test_the_rim_of_a_coarse_picture_is_in_the_middle_of_its_blocks() -> None:
    light = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(minimum=0.3)))
    scene = wall_scene(lights=[light])
    fine, coarse = (rims(wall_sight(scene, block), "light")["x", "minimum"] for block in (1, 2))
    assert coarse.tolist() == (2 * fine + 1).tolist()


@pytest.mark.parametrize("view", WALL_VIEWS)
@pytest.mark.parametrize("edge_width", [0.0, 0.4])
@pytest.mark.parametrize("carried", [False, True])
def test_the_rim_of_a_half_space_is_where_the_light_ends(
    view: View, edge_width: float, carried: bool
) -> None:
    plane = HalfSpace("left", (0.13, 0.2, 0.1), (1.0, 0.1, 0.5), edge_width, carried)
    light = Light("light", (0.2, -9.0, 0.1), aim=(0.0, 0.0, 0.0), half_spaces=(plane,))
    scene = wall_scene(wall(3, 2, half=2.5), view=view, lights=[light])
    picture = render(scene, (ELEMENTS, LINES))
    lit = picture.planes["light"].diffuse > 0
    found = rims(wall_sight(scene), "light")
    assert list(found) == [Plane("left")]
    twin = [
        p for p in lit_beside_dark(lit | (picture.surface_number == 0)) if picture.surface_number[tuple(p)]
    ]
    assert len(twin) > 20
    assert found[Plane("left")].tolist() == twin


def test_a_soft_cone_ends_at_its_cone_angle() -> None:
    light = Light("light", (0.1, -3.0, 0.05), direction=(0.0, 1.0, 0.0), cone_angle=9)
    found = [
        rims(wall_sight(wall_scene(wall(half=2.0), view=FILLING, lights=[each])), "light")["cone"].tolist()
        for each in (light, light.replace(inner_angle=4))
    ]
    assert found[0] == found[1]


@cache
def wall_picture() -> Picture:
    return render(wall_scene(lights=[Light("key", (0, -4, 0))]), (640, 480))


@given(st.integers(120, 300), st.integers(220, 400))
def test_a_highlight_is_seen_where_much_of_it_is_and_not_at_a_brighter_edge(line: int, element: int) -> None:
    picture = wall_picture()
    planes = picture.light_planes["key"]
    raster = np.zeros((480, 640), np.float32)
    # A broad reflection, and a brighter pixel elsewhere.
    raster[line : line + 32, element : element + 32] = 0.5
    raster[line + 20, element + 20] = 0.6
    raster[100, 200] = 1.0
    values = np.stack([planes.values[0], raster.ravel()[picture.pixels]])
    weights = {number: (np.float32(1), np.float32(1)) for number in planes.weights}
    changed = replace(picture, light_planes={"key": LightPlanes(values, weights)})
    found = seen_highlight(changed, "key")
    assert found is not None
    assert 0 <= found[0] - line < 32
    assert 0 <= found[1] - element < 32
    assert specular_shares(changed, 100, 200)["key"] == 1
    assert specular_shares(changed, 0, 0) == {}
    assert seen_highlight(changed, "none") is None


def test_any_number_of_half_spaces_have_rims_of_their_own() -> None:
    planes = tuple(
        HalfSpace(f"plane {number}", (0.1 * number - 0.9, 0, 0), (1, 0, 0.1)) for number in range(19)
    )
    light = Light("light", (0.2, -6.0, 0.1), half_spaces=planes, flaps=Flaps(z=Flap(-0.5, 0.5)))
    found = rims(wall_sight(wall_scene(wall(half=2.0), view=FILLING, lights=[light])), "light")
    assert len(found) == 21
    for plane in planes:
        alone = light.replace(half_spaces=(plane,), flaps=Flaps())
        rim = rims(wall_sight(wall_scene(wall(half=2.0), view=FILLING, lights=[alone])), "light")
        assert found[Plane(plane.name)].tolist() == rim[Plane(plane.name)].tolist() != []
