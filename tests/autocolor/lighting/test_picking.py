from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, HalfSpace, Light, Mesh, Reflectance, Scene, Studio, View, read_scene
from autocolor.arrays import Booleans
from autocolor.checks import Vector
from autocolor.lighting.controls import Axis, FlapEnd, Plane
from autocolor.lighting.picking import (
    LEAST_CONE,
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
from autocolor.lighting.shading import LightPlanes
from autocolor.rendering import Rendering, rendering
from autocolor.scene.columns import with_values
from autocolor.scene.following import detached
from autocolor.scene.reflection_models import BlinnPhong, Phong, ReflectionModel
from autocolor.testing import directions, lights, numbers, vectors
from autocolor.visibility.visible_points import Seen, Sight, seen_at
from ramtek_emu import Ramtek9300
from tests.autocolor.twins.point import dot, minus, plus, times, unit
from tests.small import car, cube, grid, sphere, wall, wall_scene
from tests.tables import call, refused

LINES, ELEMENTS = 60, 80
points = vectors(numbers(-2, 2))


def rendered(scene: Scene, before: Rendering | None = None) -> Rendering:
    return rendering(scene, LINES, ELEMENTS, before)


def sight_of(rendered: Rendering, block: int = 1) -> Sight:
    return Sight(rendered.scene, rendered.points, block)


def at(point: Vector, reflected: Vector = (0.0, -1.0, 0.0)) -> Seen:
    return Seen("wall", "wall", 0, point, (0.0, -1.0, 0.0), reflected)


def lit(light: Light) -> Scene:
    return wall_scene(lights=[Light("other", (1.0, -2.0, 3.0)), light])


# Placing a highlight and finding it.

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
    vectors(numbers(-9, 9)),
    st.sampled_from(KINDS),
    st.sampled_from([None, "eye", "key"]),
    st.booleans(),
)
def test_any_light_on_the_coupe_gets_its_highlight_where_it_is_wanted_and_is_found_there(
    line: int, element: int, position: Vector, kind: dict[str, Any], follows: str | None, is_followed: bool
) -> None:
    assume(math.hypot(*position) > 4)
    before = Light("lamp", position, follows=follows, **kind)
    scene = CAR.scene.replace(lights=(*CAR.scene.lights, before))
    if is_followed and before.aim is not None:
        scene = scene.with_new_light("beside", position=(0, 0, 0.5), follows="lamp")
    sight = Sight(scene, CAR.points)
    seen = seen_at(sight, line, element)
    assume(seen is not None)
    assert seen is not None
    assume(dot(seen.normal, unit(minus(scene.view.eye, seen.point))) > 1e-3)
    distance = math.dist(scene.lights_in_world["lamp"].position, seen.point)
    assume(distance > 1e-3)

    placed = highlight_placed(scene, seen, "lamp")
    light = placed.lights_in_world["lamp"]
    assert math.dist(light.position, seen.point) == pytest.approx(distance, rel=1e-9)
    # Figure 2: E is the angle between the reflected ray of light and the ray to the eye.
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
    after = placed.lights["lamp"]
    places = {"position": before.position, "aim": before.aim, "direction": before.direction}
    assert with_values(after, places) == before
    if is_followed and before.aim is not None:
        beside = placed.lights_in_world["beside"].position
        assert beside == pytest.approx(plus(seen.point, (0, 0, 0.5)), abs=1e-9)

    # The inverse finds the pixel, or one whose cosine is equal up to rounding.
    found = highlight_of(Sight(placed, CAR.points), "lamp", seen.surface)
    assert found is not None
    there = seen_at(sight, *found)
    assert there is not None
    toward = to_light if light.at_infinity else unit(minus(light.position, there.point))
    assert found == (line, element) or dot(toward, there.reflected_view) > 1 - 1e-6


@pytest.mark.parametrize(
    ("pixel", "model", "controls"),
    [
        ((30, 40), Phong(20.0), {}),
        ((20, 33), Phong(1.0), {"aim": (0.0, 0.0, 0.0), "concentration": 10.0, "cone_angle": 30.0}),
        ((41, 52), BlinnPhong(30.0), {}),
    ],
)
def test_a_highlight_is_found_where_it_was_placed_and_nothing_is_brighter(
    pixel: tuple[int, int], model: ReflectionModel, controls: dict[str, Any]
) -> None:
    view = View((4.0, 3.0, 2.5), target=(0.1, 0.0, 0.2), field_of_view=30.0, angle=25.0)
    scene = wall_scene(sphere(96, 48), view=view, lights=[Light("light", (3.0, -6.0, 4.0), **controls)])
    before = rendered(scene.with_surface("sphere", reflectance=Reflectance(0.6, 0.5, model)))
    after = rendered(highlight_placed(before.scene, seen_at(sight_of(before), *pixel), "light"), before)
    assert highlight_of(sight_of(after), "light") == pixel
    # cos(E) is 1 there: so is its power, up to rounding.
    specular = after.picture.planes["light"].specular
    assert specular[pixel] == pytest.approx(1.0, abs=2e-5)
    assert specular[pixel] >= specular.max() - 1e-6


@given(lights())
def test_the_highlight_is_at_the_largest_cosine_of_all_surfaces_or_of_a_surface(light: Light) -> None:
    # With an exponent of 1, Phong's specular plane is cos(E), where cos(I) is above 0.
    scene = car()
    for surface in scene.surfaces:
        scene = scene.with_surface(surface.name, reflectance=Reflectance(0.5, 0.5, Phong(1.0)))
    # Controls and switches are left out of it.
    bare = Light(light.name, light.position, direction=light.direction, at_infinity=light.at_infinity)
    picture = rendered(scene.replace(lights=[bare])).picture
    sight = sight_of(rendered(scene.replace(lights=[light])))
    for name in (None, "body", "glass", "wheels"):
        found = highlight_of(sight, light.name, name)
        is_here = np.array([name in (None, each) for each in ("", *picture.surfaces)])[picture.surface_number]
        cosines = np.where(is_here, picture.planes[light.name].specular, 0)
        if found is None:
            assert cosines.max() <= 1e-6
        else:
            assert is_here[found]
            assert cosines[found] == pytest.approx(cosines.max(), abs=2e-5)


def test_there_is_no_highlight_where_no_light_is_reflected_to_the_eye() -> None:
    behind = wall_scene(lights=[Light("light", (0.0, 3.0, 0.0))])
    # L . R is above 0, but the light is behind the wall.
    low = wall_scene(view=View((0.0, -0.5, 4.0), target=(0, 0, 0)), lights=[Light("light", (0, 0.3, -4))])
    for dark in (behind, low, low.replace(words="normals")):
        assert highlight_of(sight_of(rendered(dark)), "light") is None
    before = behind.with_light("light", position=(0.0, -3.0, 0.0))
    # A wall behind the wall is in use, but not seen.
    hidden = grid(1, 1, (-0.5, 1.0, -0.5), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), "hidden")
    both = sight_of(rendered(wall_scene(Mesh.joined([wall(), hidden]), lights=before.lights)))
    assert highlight_of(both, "light", "wall") is not None
    assert highlight_of(both, "light", "hidden") is None
    nothing = wall_scene(view=View((0.0, -4.0, 0.0), direction=(0.0, -1.0, 0.0)), lights=before.lights)
    assert highlight_of(sight_of(rendered(nothing)), "light") is None


AIMS: list[dict[str, Any]] = [
    {},
    {"aim": (0.3, 0.2, 0.1)},
    {"direction": (0.2, 0.9, -0.4)},
    {"direction": (0.2, 0.9, -0.4), "at_infinity": True},
]


@cache
def studio_of(number: int) -> Studio:
    """A studio for lights of one of the kinds, made once, whose words stand for normals."""
    view = View((1.0, -4.0, 1.5), target=(0.0, 0.0, 0.0), field_of_view=35.0)
    scene = wall_scene(sphere(96, 48), view=view, lights=[Light("key", (1.0, -2.0, 2.0), **AIMS[number])])
    return Studio(scene.replace(words="normals"), Ramtek9300())


@pytest.mark.parametrize("number", range(len(AIMS)))
@given(line=st.integers(150, 330), element=st.integers(230, 410))
def test_where_words_stand_for_normals_a_highlight_is_where_it_is_placed(
    number: int, line: int, element: int
) -> None:
    studio = studio_of(number)
    distance = math.hypot(*studio.scene.lights["key"].position)
    studio.place_highlight("key", line, element)
    assert math.dist(studio.highlight_of("key") or (0, 0), (line, element)) < 3
    assert math.hypot(*studio.scene.lights["key"].position) == pytest.approx(distance)
    # The brightest word is at the pixel, or in a cell beside it.
    brightness = studio.entries[studio.words].sum(axis=2, dtype=np.int64)
    around = brightness[line - 12 : line + 13, element - 12 : element + 13]
    assert around.max() == brightness.max()


@given(st.integers(120, 300), st.integers(220, 400))
def test_a_highlight_is_seen_where_much_of_it_is_and_not_at_a_brighter_edge(line: int, element: int) -> None:
    picture = wide_wall().picture
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


@cache
def wide_wall() -> Rendering:
    return rendering(wall_scene(lights=[Light("key", (0, -4, 0))]), 480, 640)


# Placing rims.


@pytest.mark.parametrize(
    ("point", "angle", "inner"),
    [
        ((0.0, 0.0, 0.0), LEAST_CONE, LEAST_CONE),
        ((0.0, -3.0, 0.0), LEAST_CONE, LEAST_CONE),
        ((0.0, -5.0, 0.0), 180.0, 20.0),
        ((3.0, -3.0, 0.0), 90.0, 20.0),
        ((0.0, 0.0, 3.0), 45.0, 20.0),
        ((0.5, -1.0, 0.0), math.degrees(math.atan2(0.5, 2)), math.degrees(math.atan2(0.5, 2))),
    ],
)
def test_a_cone_ends_at_the_point_and_its_inner_angle_stays_within_it(
    point: Vector, angle: float, inner: float
) -> None:
    light = Light("light", (0.0, -3.0, 0.0), direction=(0.0, 2.0, 0.0), cone_angle=30)
    for expected, row in ((None, light), (inner, light.replace(inner_angle=20))):
        placed = cone_placed(lit(row), at(point), "light").lights["light"]
        assert placed.cone_angle == pytest.approx(angle)
        assert placed.inner_angle == (None if expected is None else pytest.approx(expected))


def test_a_cone_and_a_flap_of_a_light_at_the_eye_end_at_the_visible_point() -> None:
    flaps = Flaps(x=Flap())
    lamp = Light("lamp", (0, 0, 0), direction=(0, 1, 0), cone_angle=5, flaps=flaps, follows="eye")
    scene = CAR.scene.replace(lights=(*CAR.scene.lights, lamp))
    seen = seen_at(Sight(scene, CAR.points), 24, 20)
    assert seen is not None
    angle = cone_placed(scene, seen, "lamp").lights["lamp"].cone_angle
    cosine = dot(scene.view.axes[2].tolist(), unit(minus(seen.point, scene.view.eye)))
    assert angle == pytest.approx(math.degrees(math.acos(cosine)))
    flapped = flap_placed(scene, seen, "lamp", "x", "maximum").lights["lamp"]
    assert (flapped.flaps.x, flapped.follows) == (Flap(maximum=seen.point[0]), "eye")


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@given(one=numbers(-2, 2), other=numbers(-2, 2), point=points, on=st.booleans())
def test_a_flap_ends_at_the_coordinate_of_the_point_and_its_minimum_never_passes_its_maximum(
    axis: Axis, one: float, other: float, point: Vector, on: bool
) -> None:
    flap, to = Flap(min(one, other), max(one, other), on), point["xyz".index(axis)]
    flaps = Flaps(**{name: flap for name in "xyz"})
    scene = lit(Light("light", (0.0, -3.0, 0.0), flaps=flaps))
    expected: dict[FlapEnd, Flap] = {
        "minimum": Flap(min(to, flap.maximum), flap.maximum, on),
        "maximum": Flap(flap.minimum, max(to, flap.minimum), on),
    }
    for end, after in expected.items():
        placed = flap_placed(scene, at(point), "light", axis, end).lights["light"]
        assert placed.flaps == flaps.replace(**{axis: after})


@given(points, vectors(), directions(), st.booleans(), st.none() | directions())
def test_a_half_space_ends_at_the_point_and_moves_along_its_direction(
    point: Vector, start: Vector, direction: Vector, carried: bool, toward: Vector | None
) -> None:
    planes = (
        HalfSpace("left", start, direction, edge_width=0.3, carried=carried),
        HalfSpace("right", start, direction, on=False),
    )
    light = Light("light", (0.3, -2.0, 0.5), direction=toward, half_spaces=planes)
    placed = half_space_placed(lit(light), at(point), "light", "left").lights["light"]
    left, right = placed.half_spaces
    assert right == planes[1]
    assert left == planes[0].replace(point=left.point)
    in_world = detached(left, placed)
    assert dot(minus(in_world.point, point), unit(in_world.direction)) == pytest.approx(0, abs=1e-9)
    across = np.cross(minus(left.point, start), unit(direction))
    assert across == pytest.approx(np.zeros(3), abs=1e-9)


SCENE = lit(Light("key", (0.5, 0.0, 0.5)))
REFUSED: list[tuple[Callable[[], object], str]] = [
    *(
        (act, f"{what} must be dragged to a surface, not to the background; choose another pixel")
        for act, what in (
            (lambda: highlight_placed(SCENE, None, "key"), "a highlight"),
            (lambda: cone_placed(SCENE, None, "key"), "a cone"),
            (lambda: flap_placed(SCENE, None, "key", "x", "minimum"), "a flap"),
            (lambda: half_space_placed(SCENE, None, "key", "left"), "a half-space"),
        )
    ),
    (
        lambda: highlight_placed(SCENE, at((0.0, 0.0, 0.0), (0.6, 0.8, 0.0)), "key"),
        "a highlight must be placed where the normal faces the eye, not where 'wall' turns away; choose"
        " another pixel",
    ),
    (
        lambda: highlight_of(sight_of(wide_wall()), "kee"),
        "there is no light 'kee'; did you mean 'key'?",
    ),
    (
        lambda: highlight_of(sight_of(wide_wall()), "key", "wal"),
        "there is no surface 'wal'; did you mean 'wall'?",
    ),
]
test_a_pixel_without_a_highlight_and_unknown_names_are_refused = refused(call, REFUSED)


# Finding rims.

FILLING = View((0.0, -4.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=25.0)
"""A wall of half a width of 2 fills the picture."""

WALL_VIEWS = [FILLING, View((1.5, -4.0, 1.0), target=(0.1, 0.0, 0.2), field_of_view=35.0, angle=20.0)]


def rims_of(scene: Scene, block: int = 1) -> dict[Rim, list[list[int]]]:
    found = rims(sight_of(rendered(scene), block), "light")
    return {rim: pixels.tolist() for rim, pixels in found.items()}


def lit_beside_dark(scene: Scene) -> list[list[int]]:
    """The slow twin: the lit pixels of a scene with a dark one above, below, left or right of them."""
    picture = rendered(scene).picture
    dark: Booleans = (picture.planes["light"].diffuse == 0) & (picture.surface_number > 0)
    around = np.pad(dark, 1)
    beside = around[:-2, 1:-1] | around[2:, 1:-1] | around[1:-1, :-2] | around[1:-1, 2:]
    pixels: list[list[int]] = np.argwhere(beside & ~dark & (picture.surface_number > 0)).tolist()
    return pixels


PLANE = HalfSpace("left", (0.13, 0.2, 0.1), (1.0, 0.1, 0.5))
RIMS: list[tuple[Rim, dict[str, Any]]] = [
    (("x", "minimum"), {"flaps": Flaps(x=Flap(minimum=0.21))}),
    (("x", "maximum"), {"flaps": Flaps(x=Flap(maximum=0.21))}),
    (("y", "minimum"), {"flaps": Flaps(y=Flap(minimum=-0.3))}),
    (("z", "maximum"), {"flaps": Flaps(z=Flap(maximum=-0.43))}),
    (Plane("left"), {"half_spaces": (PLANE,)}),
    (Plane("left"), {"half_spaces": (PLANE.replace(edge_width=0.4, carried=True),)}),
    ("cone", {"cone_angle": 5.0}),
    ("cone", {"cone_angle": 6.0, "inner_angle": 4.0}),
]


@pytest.mark.parametrize("view", WALL_VIEWS)
@pytest.mark.parametrize(("rim", "fields"), RIMS)
def test_a_rim_is_where_the_light_ends(rim: Rim, fields: dict[str, Any], view: View) -> None:
    leaning = grid(4, 4, (-2.0, -0.8, -2.0), (4.0, 0.5, 0.0), (0.0, 0.7, 4.0))
    light = Light("light", (0.2, -9.0, 0.1), aim=(0.1, 0.0, 0.0), **fields)
    scene = wall_scene(leaning, view=view, lights=[light])
    twin = lit_beside_dark(scene)
    assert len(twin) > 20
    assert rims_of(scene) == {rim: twin}


@given(numbers(1, 60), directions())
def test_the_rim_of_any_cone_is_where_the_light_ends(angle: float, direction: Vector) -> None:
    light = Light("light", (0.2, -1.0, 0.1), direction=direction, cone_angle=angle)
    scene = wall_scene(wall(3, 2, half=2.0), view=FILLING, lights=[light])
    assert rims_of(scene) == {"cone": lit_beside_dark(scene)}


def test_a_silhouette_is_no_rim() -> None:
    floating = Mesh.joined([cube(0.7), grid(2, 2, (-3.0, 4.0, -3.0), (6.0, 0.0, 0.0), (0.0, 0.0, 6.0))])
    light = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(y=Flap(maximum=2.0)))
    scene = wall_scene(floating, view=FILLING, lights=[light])
    assert len(lit_beside_dark(scene)) > 20
    assert rims_of(scene) == {("y", "maximum"): []}


def test_the_end_of_a_line_is_no_neighbor_of_the_next() -> None:
    light = Light("light", (0.0, -9.0, 0.0), flaps=Flaps(x=Flap(minimum=0.0)))
    scene = wall_scene(wall(1, 1, half=3.0), view=FILLING, lights=[light])
    middle = [[line, ELEMENTS // 2] for line in range(LINES)]
    assert rims_of(scene) == {("x", "minimum"): middle}
    # A coarse picture has it in the middle of its blocks.
    coarse = [[2 * line + 1, 2 * element + 1] for line, element in middle]
    assert rims_of(scene, block=2) == {("x", "minimum"): coarse}


def test_only_controls_that_end_have_a_rim() -> None:
    light = Light("light", (0.0, -9.0, 0.0), aim=(0, 0, 0), concentration=5)
    assert (
        rims_of(wall_scene(lights=[light.replace(flaps=Flaps(x=Flap(0.0, 1.0, on=False), z=Flap()))])) == {}
    )
    aside = light.replace(flaps=Flaps(x=Flap(minimum=50.0)))
    away = View((0.0, -4.0, 0.0), direction=(0.0, -1.0, 0.0))
    for scene in (wall_scene(lights=[aside]), wall_scene(view=away, lights=[aside])):
        assert rims_of(scene) == {("x", "minimum"): []}
