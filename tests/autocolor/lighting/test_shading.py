"""The planes of one light on a wall and on a sphere, by the closed form of the paper, and their mix."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import (
    Flap,
    Flaps,
    HalfSpace,
    InputError,
    Light,
    Mesh,
    Part,
    Reflectance,
    Scene,
    Surface,
    View,
    render,
)
from autocolor.arrays import Singles
from autocolor.checks import Vector
from autocolor.lighting.controls import is_inside, sides_of
from autocolor.lighting.rays import camera_light
from autocolor.lighting.shading import DIFFUSE, SPECULAR, LightPlanes, light_mix, mix, shade
from autocolor.scene.lights import Links
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong, ReflectionModel, SpecularGrowth
from autocolor.testing import lights, numbers, outside_views, surfaces
from autocolor.visibility.visible_points import POINT, VisiblePoints, point_chunks, surface_slices
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.reference import controlled, ray
from tests.autocolor.twins.light import direction_to, specular_factor
from tests.autocolor.twins.point import dot, minus, plus, times, unit
from tests.closeness import all_close
from tests.small import cube, grid, sphere, wall, wall_scene
from tests.tables import first, refused

MODELS: list[ReflectionModel] = [
    Phong(12.0),
    BlinnPhong(12.0, SpecularGrowth(refractive_index=1.5)),
    CookTorrance(0.3),
    Phong(12.0, SpecularGrowth(base_reflectance=0.04)),
    BlinnPhong(12.0),
    CookTorrance(1.0, 0.5),
    Phong(4.0, SpecularGrowth(fresnel_curve=((0, 0.04), (50, 0.06), (70, 0.17), (80, 0.39), (90, 1)))),
]
STEEP: list[ReflectionModel] = [
    Phong(1e5),
    BlinnPhong(1e5),
    CookTorrance(0.05),
    *(model(exponent) for model in (Phong, BlinnPhong) for exponent in (101.0, 1e3)),
    Phong(333.3),
    *(CookTorrance(roughness) for roughness in (0.2, 0.02)),
]


def planes_of(
    light: Light, points: VisiblePoints, model: ReflectionModel, other: ReflectionModel | None = None
) -> Singles:
    """The planes of one light under a model, and under another on the second surface."""
    planes = np.empty((2, len(points.pixels)), np.float32)
    for chunk in points.chunks:
        shade(planes, camera_light(light, points), points, chunk, {1: model, 2: other or model})
    return planes


def planes_at(
    light: Light, point: Vector, normal: Vector, eye: Vector, model: ReflectionModel
) -> list[float]:
    """The diffuse and the specular plane at a point, by the closed form in float64."""
    to_light = direction_to(light, point)
    cos_incidence = dot(normal, to_light)
    if cos_incidence <= 0:
        return [0.0, 0.0]
    left = controlled(light, point).intensity
    to_eye = unit(minus(eye, point))
    return [left * cos_incidence, left * specular_factor(model, to_light, normal, to_eye)]


def assert_exact(
    light: Light,
    points: VisiblePoints,
    model: ReflectionModel,
    chosen: list[int],
    at: list[tuple[Vector, Vector]],
    from_rim: float,
) -> None:
    """Both planes are the closed form at the `chosen` points, `at` a point and its normal each, to 1e-4.

    Points within `from_rim` of a sharp edge, or of where the light runs along the surface, are left out.
    """
    planes = planes_of(light, points, model)
    expected, got = [[0.0, 0.0]], [[0.0, 0.0]]
    for place, (point, normal) in zip(chosen, at, strict=True):
        from_jump = min(controlled(light, point).from_jump, abs(dot(normal, direction_to(light, point))))
        if from_jump > from_rim:
            expected.append(planes_at(light, point, normal, points.view.eye, model))
            got.append(planes[:, place].tolist())
    most = max(1.0, np.max(expected))
    assert all_close(np.array(got), np.array(expected), rel=0.0, abs=1e-4 * most)


def some_of(points: VisiblePoints, specular: Singles, part: int = 1) -> list[int]:
    """Every seventh point of a part, and those with the largest specular light."""
    here = np.flatnonzero(points.parts.numbers == part)
    brightest = here[np.argsort(-specular[here])[:40]]
    chosen: list[int] = np.unique(np.concatenate([here[::7], brightest])).tolist()
    return chosen


def assert_exact_on_wall(
    light: Light, points: VisiblePoints, model: ReflectionModel, from_rim: float = 1e-6
) -> None:
    """The planes are exact on the wall y = 0, whose points are those of the rays through the pixels."""
    eye = points.view.eye
    chosen, at = some_of(points, planes_of(light, points, model)[SPECULAR]), []
    for place in chosen:
        line, element = divmod(int(points.pixels[place]), points.elements)
        direction = ray(points.view, points.lines, points.elements, line, element)
        x, _, z = plus(eye, times(-eye[1] / direction[1], direction))
        at.append(((x, 0.0, z), (0.0, math.copysign(1.0, eye[1]), 0.0)))
    assert_exact(light, points, model, chosen, at, from_rim)


def assert_exact_on_sphere(light: Light, view: View, model: ReflectionModel, from_rim: float = 1e-6) -> None:
    """The planes are exact on a sphere of polygons: the closed form starts from their points and normals."""
    points = visible_surfaces(sphere(24, 16), view, (1,), 24, 32)
    chosen = some_of(points, planes_of(light, points, model)[SPECULAR])
    normals = [unit(normal) for normal in points.world_normals[chosen].tolist()]
    at = list(zip(points.world_points[chosen].tolist(), normals, strict=True))
    assert_exact(light, points, model, chosen, at, from_rim)


@st.composite
def wall_views(draw: st.DrawFn) -> View:
    """An eye before or behind the wall."""
    side = draw(st.sampled_from([-1, 1]))
    eye = (draw(numbers(-2, 2)), side * draw(numbers(2, 4)), draw(numbers(-2, 2)))
    return View(eye, target=(0.1, 0.0, -0.1), field_of_view=40.0, angle=draw(numbers(-90, 90)))


@st.composite
def places(draw: st.DrawFn) -> Vector:
    """A place before or behind the wall, from near to far."""
    far = draw(st.sampled_from([0.06, 0.3, 1.0, 4.0, 50.0, 1e4])) * draw(st.sampled_from([-1, 1]))
    wide = max(abs(far), 1.0)
    return (draw(numbers(-1, 1)) * wide, far, draw(numbers(-1, 1)) * wide)


@pytest.mark.parametrize("model", first(3, MODELS), ids=repr)
@given(view=wall_views(), data=st.data())
def test_any_light_with_all_controls_on_a_wall_is_as_the_paper_says(
    model: ReflectionModel, view: View, data: st.DataObject
) -> None:
    light = data.draw(lights(position=data.draw(places())))
    assert_exact_on_wall(light, visible_surfaces(wall(7, 5), view, (1,), 12, 16), model, from_rim=1e-4)


@pytest.mark.parametrize("model", first(3, MODELS), ids=repr)
@given(light=lights(), view=outside_views())
def test_any_light_with_all_controls_on_a_sphere_is_as_the_paper_says(
    model: ReflectionModel, light: Light, view: View
) -> None:
    assume(math.hypot(*light.position) > 1.5)
    assert_exact_on_sphere(light, view, model, from_rim=1e-4)


@given(
    place=st.tuples(numbers(-0.9, 0.9), numbers(-2e-3, -1e-3), numbers(-0.9, 0.9)),
    toward=st.tuples(numbers(-1, 1), numbers(-1, 1)),
)
def test_the_spot_of_a_light_that_almost_touches_the_wall_is_right(
    place: Vector, toward: tuple[float, float]
) -> None:
    x, _, z = place
    view = View((x, -4.0, z), target=(x, 0.0, z), field_of_view=0.1)
    directed = Light("light", place, direction=(toward[0], 1.0, toward[1]), concentration=2)
    for light in (Light("light", place), directed):
        assert_exact_on_wall(light, visible_surfaces(wall(), view, (1,), 12, 16), Phong())


LOW = [
    *({"concentration": concentration} for concentration in (0.5, 1.0, 40.0, 200.0)),
    {"cone_angle": 120.0},
    {"falloff": "linear", "reach": 1.0},
]


@pytest.mark.parametrize("fields", LOW, ids=repr)
def test_a_light_that_shines_along_a_wall_is_as_the_paper_says(fields: dict[str, Any]) -> None:
    points = visible_surfaces(wall(), View((0.4, -4.0, 0.3), target=(0, 0, 0)), (1,), 24, 32)
    light = Light("light", (0.2, -0.3, 0.1), direction=(1.0, 0.3, 0.2), **fields)
    assert_exact_on_wall(light, points, Phong(), from_rim=1e-3)


@pytest.mark.parametrize("gap", [0.03, 0.003])
def test_a_light_close_to_a_wall_that_is_seen_as_a_whole_is_as_exact(gap: float) -> None:
    points = visible_surfaces(wall(), View((0.4, -4.0, 0.3), target=(0, 0, 0)), (1,), 24, 32)
    for x, _, z in points.world_points[::41].tolist():
        assert_exact_on_wall(Light("light", (x, -gap, z)), points, Phong(), from_rim=1e-3)


@pytest.mark.parametrize("distance", first(2, [5.0, 1e4, 211.0, 500.0, 5e3]))
@pytest.mark.parametrize("gap", [0.3, 0.01])
@pytest.mark.parametrize("concentration", [0, 40])
def test_the_wall_is_as_exact_through_a_telephoto_lens(
    distance: float, gap: float, concentration: float
) -> None:
    view = View((0, -distance, 0), target=(0, 0, 0), field_of_view=math.degrees(2 * math.atan(1 / distance)))
    light = Light("light", (0.05, -gap, -0.1), direction=(0.1, 1, 0.05), concentration=concentration)
    assert_exact_on_wall(light, visible_surfaces(wall(), view, (1,), 12, 16), Phong())


def before_a_plate(view: View, size: float) -> Mesh:
    """The wall, and behind it a plate that is much larger, across the view."""
    right, down, ahead = view.axes
    corner = np.array(view.eye) + (9 + size / 50) * ahead - size * (0.4 * right - 0.7 * down)
    plate = grid(1, 1, tuple(corner.tolist()), tuple((size * right).tolist()), tuple((-size * down).tolist()))
    return Mesh.joined(
        [wall(2, 2), Mesh(plate.coordinates, plate.node_numbers, plate.part_numbers, ("far",))]
    )


def on_a_floor(view: View, size: float) -> Mesh:
    """The wall, and below it a floor that reaches behind the eye."""
    floor = grid(1, 1, (-size, -0.8 * size, -1.5), (2 * size, 0.0, 0.0), (0.0, 1.7 * size, 0.0), "floor")
    return Mesh.joined([wall(2, 2), floor])


NEAR_LIGHTS: dict[str, dict[str, Any]] = {
    "point source": {},
    "spot": {"aim": (0.1, 0.0, 0.2), "concentration": 8.0, "cone_angle": 25.0, "inner_angle": 15.0},
    "sharp cone": {"aim": (0.1, 0.0, 0.2), "cone_angle": 12.0},
    "flaps": {"flaps": Flaps(x=Flap(-0.31, 0.47), z=Flap(-0.5, 0.33))},
    "soft flap": {"flaps": Flaps(x=Flap(-0.31, 0.47, edge_width=0.1))},
    "half-space": {"half_spaces": (HalfSpace("door", (0.1, 0.0, 0.1), (1.0, 0.2, 0.5)),)},
    "falloff": {"falloff": "linear", "reach": 3.0},
}


@pytest.mark.parametrize("fields", NEAR_LIGHTS.values(), ids=NEAR_LIGHTS)
@pytest.mark.parametrize("beside", [before_a_plate, on_a_floor])
@pytest.mark.parametrize("size", first(1, [1e5, 1e3, 1e8]))
@given(angle=numbers(-180, 180), height=numbers(-1, 2))
def test_a_small_wall_before_a_large_plate_or_floor_is_lit_by_the_closed_form(
    beside: Any, fields: dict[str, Any], size: float, angle: float, height: float
) -> None:
    view = View((1.0, -5.0, 0.4), target=(0.0, 0.0, 0.0), field_of_view=40.0, angle=angle)
    points = visible_surfaces(beside(view, size), view, (1, 1), 24, 32)
    assert points.starts_nearest
    light = Light("light", (0.7, -2.0, height), **fields)
    assert_exact_on_wall(light, points, Phong(20.0), from_rim=1e-5)


@pytest.mark.parametrize("size", [10.0, 1e3, 1e5])
@given(angle=numbers(-180, 180))
def test_a_floor_that_lies_on_a_flap_is_lit_to_the_horizon_and_just_beyond_the_flap_it_is_dark(
    size: float, angle: float
) -> None:
    view = View((1.0, -5.0, 0.4), target=(0.0, 0.0, 0.2), field_of_view=50.0, angle=angle)
    points = visible_surfaces(on_a_floor(view, size), view, (1, 1), 24, 32)
    floor = points.parts.numbers == 2
    near = floor & (np.linalg.norm(points.world_points - view.eye, axis=1) < 20)
    assert near.any()
    for least, lit in ((-1.5, floor), (-1.5 + 1e-3, np.zeros_like(near))):
        (side,) = sides_of(Light("light", (0, 0, 5), flaps=Flaps(z=Flap(minimum=least))), points).values()
        inside = is_inside(side, points.rows[POINT])
        assert (inside[near] == lit[near]).all()
        assert inside[lit].all()


@pytest.mark.parametrize("model", first(3, STEEP), ids=repr)
@given(
    eye=st.tuples(numbers(-2, 2), numbers(-4, -2), numbers(-2, 2)),
    x=numbers(-0.9, 0.9),
    z=numbers(-0.9, 0.9),
    away=st.sampled_from([0.3, 1.0, 4.0, 50.0, 1e4]),
)
def test_steep_highlights_on_a_wall_are_the_closed_form(
    model: ReflectionModel, eye: Vector, x: float, z: float, away: float
) -> None:
    # The highlight is at x, z, and fills the picture.
    middle = (x, 0.0, z)
    ahead = unit(minus(middle, eye))
    light = Light("light", plus(middle, times(-away, (ahead[0], -ahead[1], ahead[2]))))
    exponent = 2 / model.roughness**2 if isinstance(model, CookTorrance) else vars(model)["exponent"]
    view = View(eye, target=middle, field_of_view=math.degrees(2 / math.sqrt(exponent)))
    assert_exact_on_wall(light, visible_surfaces(wall(), view, (1,), 24, 32), model)


@pytest.mark.parametrize("model", first(3, STEEP), ids=repr)
@given(place=st.tuples(*[numbers(-6, 6)] * 3), view=outside_views())
def test_steep_highlights_on_a_sphere_are_the_closed_form(
    model: ReflectionModel, place: Vector, view: View
) -> None:
    assume(math.hypot(*place) > 1.5)
    assert_exact_on_sphere(Light("light", place), view, model)


@pytest.mark.parametrize(
    "beam",
    first(
        4,
        [
            {"concentration": 1e3},
            {"cone_angle": 0.3, "inner_angle": 0.2},
            {"cone_angle": 20.0, "inner_angle": 19.9},
            {"cone_angle": 0.5},
            *({"concentration": c} for c in (101.0, 1e5)),
            *({"cone_angle": a, "inner_angle": a - 0.1} for a in (0.1, 3.0, 60.0)),
            *({"cone_angle": a} for a in (0.1, 2.5)),
        ],
    ),
    ids=repr,
)
@given(distance=st.sampled_from([1.0, 4.0, 50.0]), turn=numbers(0, 360), aside=numbers(-0.3, 0.3))
def test_steep_beams_on_a_wall_are_the_closed_form(
    beam: dict[str, Any], distance: float, turn: float, aside: float
) -> None:
    # The view is as wide as the edge of the beam, and the edge goes through its middle.
    at = (aside, 0.0, 0.2)
    edge = math.radians(beam.get("cone_angle", 30 / math.sqrt(beam.get("concentration", 1.0))) - 0.05)
    wide = math.degrees(max(0.1, 30 / math.sqrt(beam.get("concentration", 1e5)))) / 57.3
    toward = (math.sin(edge) * math.cos(math.radians(turn)), math.cos(edge))
    across = math.sin(edge) * math.sin(math.radians(turn))
    light = Light("light", (aside, -distance, 0.2), direction=(*toward, across), **beam)
    view = View((aside, -distance, 0.2), target=at, field_of_view=min(wide, 60.0))
    points = visible_surfaces(wall(), view, (1,), 12, 16)
    # A sharp edge is as exact as points are: half a millionth of an angle.
    from_rim = 5e-7 * math.sin(edge) if "inner_angle" not in beam else 0.0
    assert_exact_on_wall(light, points, Phong(1.0), from_rim=from_rim)


@pytest.mark.parametrize("steep", [1e4, 1e7, 1e30])
def test_no_exponent_and_no_concentration_makes_a_light_brighter_and_all_light_is_finite(
    steep: float,
) -> None:
    view = View((0.3, -4.0, 0.2), target=(0.3, 0.0, 0.2), field_of_view=25.0)
    points = visible_surfaces(wall(), view, (1,), 301, 301)
    for light in (
        Light("light", view.eye),
        Light("light", view.eye, direction=(0, 1, 0), concentration=steep),
        Light("light", (0.3, 0.0, 0.2), direction=(0, 1, 0), concentration=3, cone_angle=20),
    ):
        assert 0 <= planes_of(light, points, Phong(steep)).max() <= 1.000001


@given(light=lights(on=True, intensity=1.0), power=st.integers(-95, 95))
def test_the_size_of_the_world_does_not_change_the_picture(light: Light, power: int) -> None:
    def scaled(size: float) -> Scene:
        def one(flap: Flap | None) -> Flap | None:
            if flap is None:
                return None
            return Flap(flap.minimum * size, flap.maximum * size, flap.on, flap.edge_width * size)

        def plane(row: HalfSpace) -> HalfSpace:
            return row.replace(point=[size * each for each in row.point], edge_width=size * row.edge_width)

        px, py, pz = light.position
        x, y, z = light.flaps.x, light.flaps.y, light.flaps.z
        moved = light.replace(
            position=(px * size, py * size, pz * size),
            flaps=Flaps(one(x), one(y), one(z)),
            half_spaces=[plane(row) for row in light.half_spaces],
            reach=None if light.reach is None else light.reach * size,
        )
        view = View((0.5 * size, -4.0 * size, 1.0 * size), target=(0.0, 0.0, 0.0))
        return wall_scene(wall(2, 2, half=size), view=view, lights=[moved])

    assume(min(abs(coordinate) for coordinate in light.position) > 1e-3)
    one, other = render(scaled(1.0), (16, 12)), render(scaled(2.0**power), (16, 12))
    assert one.intensity.tobytes() == other.intensity.tobytes()


@pytest.mark.parametrize(
    ("model", "other"), [(Phong(12.0), CookTorrance(0.4)), (Phong(1e4), CookTorrance(0.03))]
)
def test_each_surface_is_reflected_by_its_own_model(model: ReflectionModel, other: ReflectionModel) -> None:
    mesh = Mesh.joined([sphere(12, 8), cube(1.4)])
    view = View((3.0, -4.0, 2.0), target=(0.0, 0.0, 0.0), field_of_view=40.0)
    points = visible_surfaces(mesh, view, (1, 2), 24, 32)
    for cone_angle in (None, 3.0):
        # A narrow cone lights few points, which are then picked and computed alone.
        light = Light("light", (2.6, -4.0, 2.2), aim=(0.4, -0.6, 0.3), cone_angle=cone_angle)
        mixed = planes_of(light, points, model, other)
        for surface, its in zip(points.slices, (model, other), strict=True):
            alone = planes_of(light, points, its)
            assert mixed[:, surface.pixels].tobytes() == alone[:, surface.pixels].tobytes()
        assert mixed[DIFFUSE].tobytes() == planes_of(light, points, Phong(1.0))[DIFFUSE].tobytes()


# The mix.


@given(st.lists(st.integers(0, 30), min_size=1, max_size=5), st.integers(1, 40), st.integers(0, 1 << 32))
def test_the_mix_is_the_weighted_sum_of_both_planes_by_surface(
    counts: list[int], at_once: int, seed: int
) -> None:
    random = np.random.default_rng(seed)
    slices = surface_slices(np.array([0, *counts]))
    values = random.uniform(0, 1, (2, sum(counts))).astype(np.float32)
    weights = {
        each.surface_number: (np.float32(random.uniform()), np.float32(random.uniform())) for each in slices
    }
    out = np.full(sum(counts), np.float32(np.nan))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("autocolor.visibility.visible_points.PIXELS_AT_ONCE", at_once)
        for chunk in point_chunks(slices):
            mix(LightPlanes(values, weights), chunk, out=out[chunk.pixels])
    for each in slices:
        diffuse, specular = map(float, weights[each.surface_number])
        for pixel in range(each.start, each.stop):
            expected = diffuse * float(values[DIFFUSE, pixel]) + specular * float(values[SPECULAR, pixel])
            assert out[pixel] == pytest.approx(expected, rel=1e-6)


PHONG: dict[int, ReflectionModel] = {1: Phong(), 2: Phong()}


def named(names: list[str]) -> st.SearchStrategy[tuple[Light, ...]]:
    return st.tuples(*(lights(name) for name in names))


both = st.tuples(surfaces("one"), surfaces("other"))


@given(both, named(["key", "fill", "rim"]), numbers(0, 2))
def test_the_weights_are_intensity_times_d_and_s_in_proportion_to_the_largest(
    both: tuple[Surface, Surface], lights: tuple[Light, ...], ambient: float
) -> None:
    mix = light_mix(PHONG, both, lights, ambient, ())
    assert list(mix.lights) == [light.name for light in lights if light.on and light.intensity > 0]
    every = [ambient / mix.scale]
    for light in lights:
        for number, weights in mix.lights.get(light.name, {}).items():
            reflectance = both[number - 1].reflectance
            for weight, property_ in zip(weights, (reflectance.diffuse, reflectance.specular), strict=True):
                assert weight * mix.scale == pytest.approx(light.intensity * property_, rel=1e-6)
                every.append(float(weight))
    assert mix.ambient * mix.scale == pytest.approx(ambient, rel=1e-6)
    assert max(every) in (0.0, 1.0)


def test_only_visible_surfaces_have_weights() -> None:
    both = (Surface("one"), Surface("other"))
    mix = light_mix({2: Phong()}, both, [Light("key", (0, 0, 0))], 0.0, ())
    assert list(mix.lights["key"]) == [2]


def test_a_light_has_no_weight_on_a_surface_that_it_is_not_linked_to() -> None:
    both = (Surface("one"), Surface("other"))
    parts = (Part("left", "one"), Part("middle", "other"), Part("right", "other"))
    for links, lit in (
        ({"only_surfaces": ["one"]}, {1}),
        ({"except_surfaces": ["one"]}, {2}),
        ({"only_surfaces": []}, set()),
        ({"except_surfaces": []}, {1, 2}),
        ({"only_parts": ["left"]}, {1}),
        ({"except_parts": ["middle"]}, {1, 2}),
        ({"except_parts": ["middle", "right"]}, {1}),
        ({"only_parts": ["right"], "except_surfaces": ["other"]}, set()),
    ):
        light = Light("key", (0, 0, 0), 2.0, links=Links(**links))
        mix = light_mix(PHONG, both, [light], 0.0, parts)
        assert list(mix.lights["key"]) == [1, 2]
        assert {number for number, weights in mix.lights["key"].items() if any(weights)} == lit


def test_a_light_of_any_intensity_is_not_refused_for_surfaces_that_it_does_not_reach() -> None:
    strong = Light("key", (2, -3, 3), 1e39)
    for links in ({"except_surfaces": ["sphere"]}, {"except_parts": ["sphere"]}):
        scene = wall_scene(sphere(), lights=[strong.replace(**links)], ambient=0.5)  # type: ignore[arg-type]
        picture = render(scene, (16, 12))
        assert set(picture.intensity[picture.surface_number > 0].tolist()) == {0.5}
    with pytest.raises(InputError, match="surface 'sphere' under light 'key': intensities must stay below"):
        render(wall_scene(sphere(), lights=[strong.replace(only_parts=["sphere"])]), (16, 12))


HUGE = Light("key", (2, -3, 3), 1e300)
REFUSED = [
    (
        wall_scene(sphere(), lights=[Light("key", (2, -3, 3), 1e39), Light("fill", (2, -3, 3))]),
        "surface 'sphere' under light 'key': intensities must stay below 3.4e+38, not reach 1.46e+39; lower"
        " the light's intensity",
    ),
    (wall_scene(sphere(), ambient=1e39), "ambient must stay below 3.4e+38, not 1e+39; lower it"),
    (
        wall_scene(ambient=1e39).with_view(eye=(0, 40, 0), direction=(0, 1, 0)),
        "ambient must stay below 3.4e+38, not 1e+39; lower it",
    ),
    (
        wall_scene(sphere(), lights=[HUGE]).with_surface("sphere", diffuse=1e300),
        "surface 'sphere' under light 'key': intensities must stay below 3.4e+38, not reach inf; lower the"
        " light's intensity",
    ),
    # The largest factor of a model counts.
    (
        wall_scene(
            reflectance=Reflectance(0.0, 1.0, CookTorrance(0.3, 0.05)),
            lights=[Light("key", (0, -1, 0), 1e37)],
        ),
        "surface 'wall' under light 'key': intensities must stay below 3.4e+38, not reach 9.81012e+38; lower"
        " the light's intensity",
    ),
]
test_intensities_that_float32_cannot_hold_are_refused = refused(lambda scene: render(scene, (12, 9)), REFUSED)
