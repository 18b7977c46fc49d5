"""One light on a wall and on a sphere, by the closed form of the paper."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
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
from autocolor.arrays import Floats, Singles
from autocolor.checks import Vector
from autocolor.lighting.controls import is_inside, sides_of
from autocolor.lighting.rays import camera_light
from autocolor.lighting.shading import DIFFUSE, SPECULAR, LightPlanes, light_mix, mix, shade
from autocolor.scene.kinds import AngleCurve
from autocolor.scene.lights import Links
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong, ReflectionModel, SpecularGrowth
from autocolor.testing import flaps, lights, numbers, outside_views, surfaces
from autocolor.visibility.visible_points import POINT, VisiblePoints, point_chunks, surface_slices
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.reference import Lit, controlled, light_at, ray
from tests.autocolor.strategies import reflectances
from tests.autocolor.twins.light import specular_factor
from tests.autocolor.twins.point import dot, minus, plus, times, unit
from tests.closeness import all_close
from tests.small import cube, grid, sphere, wall, wall_scene
from tests.tables import first, refused

LINES, ELEMENTS = 12, 16
WALLS = [wall(), wall(7, 5)]


MODELS: list[ReflectionModel] = [
    Phong(12.0),
    BlinnPhong(12.0, SpecularGrowth(refractive_index=1.5)),
    CookTorrance(0.3),
    Phong(12.0, SpecularGrowth(base_reflectance=0.04)),
    BlinnPhong(12.0),
    CookTorrance(1.0, 0.5),
]


def planes_of(light: Light, points: VisiblePoints, model: ReflectionModel) -> Singles:
    """The planes of one light on the one surface there is."""
    planes = np.empty((2, len(points.pixels)), np.float32)
    for chunk in points.chunks:
        shade(planes, camera_light(light, points), points, chunk, {1: model})
    return planes


def expected_on_wall(scene: Scene, lines: int, elements: int) -> dict[tuple[int, int], Lit]:
    """The sum of all lights at each pixel that is on the wall y = 0, from -1 to 1, by the paper's formula."""
    expected = {}
    eye = scene.view.eye
    surface = scene.surfaces[0]
    for line in range(lines):
        for element in range(elements):
            direction = ray(scene.view, lines, elements, line, element)
            if direction[1] == 0 or eye[1] / -direction[1] <= 0:
                continue
            point = plus(eye, times(eye[1] / -direction[1], direction))
            if max(abs(point[0]), abs(point[2])) > 1 - 1e-6:
                continue
            point = (point[0], 0.0, point[2])
            facing = 1.0 if surface.two_sided and eye[1] > 0 else -1.0
            each = [
                light_at(light, point, (0.0, facing, 0.0), eye, surface.reflectance) for light in scene.lights
            ]
            expected[line, element] = Lit(
                scene.ambient + math.fsum(lit.intensity for lit in each),
                min((lit.from_jump for lit in each), default=math.inf),
            )
    return expected


def assert_as_the_paper(scene: Scene) -> None:
    picture = render(scene, (ELEMENTS, LINES))
    expected = expected_on_wall(scene, LINES, ELEMENTS)
    largest = max((lit.intensity for lit in expected.values()), default=0.0)
    # Where less than a hundredth of the light is visible, float32 rounds in proportion to the whole.
    reflectance = scene.surfaces[0].reflectance
    peak = sum(light.intensity for light in scene.lights) * (reflectance.diffuse + reflectance.specular)
    largest = max(largest, peak / 100)
    for (line, element), lit in expected.items():
        assert picture.surface_number[line, element] == 1
        if lit.from_jump > 1e-2:
            error = abs(float(picture.intensity[line, element]) - lit.intensity)
            assert error <= 1e-4 * largest, f"{lit} at line {line}, element {element}"
    assert np.count_nonzero(picture.surface_number) >= len(expected)


@st.composite
def wall_views(draw: st.DrawFn) -> View:
    """An eye before or behind the wall."""
    side = draw(st.sampled_from([-1, 1]))
    eye = (draw(numbers(-2, 2)), side * draw(numbers(2, 4)), draw(numbers(-2, 2)))
    return View(eye, target=(0.1, 0.0, -0.1), field_of_view=40.0, angle=draw(numbers(-90, 90)))


@st.composite
def places(draw: st.DrawFn) -> tuple[float, float, float]:
    """A place before or behind the wall, from near to far."""
    far = draw(st.sampled_from([0.06, 0.3, 1.0, 4.0, 50.0, 1e4])) * draw(st.sampled_from([-1, 1]))
    wide = max(abs(far), 1.0)
    return (draw(numbers(-1, 1)) * wide, far, draw(numbers(-1, 1)) * wide)


def aimed(position: tuple[float, float, float], aim: Sequence[float]) -> tuple[float, float, float]:
    return minus(aim, position)


@pytest.mark.parametrize("mesh", WALLS, ids=["of one polygon", "of 35 polygons"])
@given(view=wall_views(), place=places(), reflectance=reflectances, two_sided=st.booleans())
def test_a_point_source_on_a_wall_is_as_the_paper_says(
    mesh: Mesh, view: View, place: tuple[float, float, float], reflectance: Reflectance, two_sided: bool
) -> None:
    light = Light("light", place, 1.5)
    assert_as_the_paper(wall_scene(mesh, reflectance, view, two_sided, lights=[light]))


GLASS: AngleCurve = ((0, 0.04), (50, 0.06), (70, 0.17), (80, 0.39), (90, 1))


def schlick(cosines: Floats) -> Floats:
    """Schlick's factor of a refractive index of 1.5 over its F0, by the closed form."""
    return np.asarray((0.04 + 0.96 * (1 - cosines) ** 5) / 0.04)


def along_glass(cosines: Floats) -> Floats:
    angles, shares = zip(*GLASS, strict=True)
    return np.asarray(np.interp(np.degrees(np.arccos(cosines)), angles, shares) / 0.04)


@pytest.mark.parametrize(
    ("growth", "closed_form"),
    [
        (SpecularGrowth(base_reflectance=0.04), schlick),
        (SpecularGrowth(refractive_index=1.5), schlick),
        (SpecularGrowth(fresnel_curve=GLASS), along_glass),
    ],
    ids=["F0", "index", "curve"],
)
@pytest.mark.parametrize("model", [Phong, BlinnPhong])
@pytest.mark.parametrize("angle", first(3, [10, 45, 87, 30, 70, 80]))
def test_s_on_a_wall_grows_by_the_closed_form_of_the_angle_of_incidence(
    growth: SpecularGrowth,
    closed_form: Callable[[Floats], Floats],
    model: type[Phong | BlinnPhong],
    angle: int,
) -> None:
    # The light and the eye mirror each other's places, so that the middle of the wall is a highlight.
    away, aside = 20 * math.cos(math.radians(angle)), 20 * math.sin(math.radians(angle))
    view = View((-aside, -away, 0.0), target=(0.0, 0.0, 0.0), field_of_view=6.0)
    points = visible_surfaces(wall(), view, (1,), 61, 61)
    place = np.array([aside, -away, 0.0])
    light = Light("light", tuple(place.tolist()))
    diffuse, specular = planes_of(light, points, model(4.0, growth))
    plain = planes_of(light, points, model(4.0))
    to_light = place - points.world_points
    to_light /= np.linalg.norm(to_light, axis=1, keepdims=True)
    to_eye = np.array(view.eye) - points.world_points
    to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
    cos_incidence = -to_light[:, 1]
    if model is Phong:
        cosines = (to_light * to_eye * [-1, 1, -1]).sum(axis=1)
    else:
        half = to_light + to_eye
        cosines = -half[:, 1] / np.linalg.norm(half, axis=1)
    assert len(cosines) > 100
    assert np.degrees(np.arccos(cos_incidence)).mean() == pytest.approx(angle, abs=3)
    assert diffuse.tobytes() == plain[0].tobytes()
    assert all_close(specular, plain[1] * closed_form(cos_incidence), rel=1e-5)
    # Near grazing incidence, float32 rounds the half vector more than the reflected view.
    error = 1e-5 if model is Phong else 1e-4
    assert all_close(specular, cosines**4 * closed_form(cos_incidence), rel=error)


@given(
    view=wall_views(),
    place=places(),
    at=st.tuples(numbers(-1.5, 1.5), numbers(-1.5, 1.5)),
    concentration=st.sampled_from([0.0, 0.5, 1.0, 2.0, 10.0, 40.0]),
    cone_angle=st.none() | numbers(2, 180),
)
def test_a_directed_light_with_a_cone_on_a_wall_is_as_the_paper_says(
    view: View,
    place: tuple[float, float, float],
    at: tuple[float, float],
    concentration: float,
    cone_angle: float | None,
) -> None:
    light = Light(
        "light",
        place,
        direction=aimed(place, [at[0], 0.0, at[1]]),
        concentration=concentration,
        cone_angle=cone_angle,
    )
    assert_as_the_paper(wall_scene(WALLS[1], view=view, lights=[light]))


@given(view=wall_views(), place=places(), limits=flaps())
def test_flaps_on_a_wall_are_as_the_paper_says(
    view: View, place: tuple[float, float, float], limits: Flaps
) -> None:
    assert_as_the_paper(wall_scene(view=view, lights=[Light("light", place, flaps=limits)]))


@pytest.mark.parametrize("mesh", WALLS, ids=["of one polygon", "of 35 polygons"])
@given(data=st.data())
def test_all_controls_of_several_lights_on_a_wall_are_as_the_paper_says(
    mesh: Mesh, data: st.DataObject
) -> None:
    scene = wall_scene(
        mesh,
        data.draw(reflectances),
        data.draw(wall_views()),
        data.draw(st.booleans()),
        lights=[data.draw(lights(name, position=data.draw(places()))) for name in ("key", "fill", "rim")],
        ambient=data.draw(numbers(0, 1)),
    )
    assert_as_the_paper(scene)


@given(place=st.tuples(numbers(-0.9, 0.9), numbers(-2e-3, -2e-4), numbers(-0.9, 0.9)))
def test_a_light_that_almost_touches_the_wall_is_still_right_beside_the_spot(
    place: tuple[float, float, float],
) -> None:
    assert_as_the_paper(wall_scene(lights=[Light("light", place)]))


@given(
    place=st.tuples(numbers(-0.9, 0.9), numbers(-2e-3, -1e-3), numbers(-0.9, 0.9)),
    toward=st.tuples(numbers(-1, 1), numbers(-1, 1)),
)
def test_the_spot_of_a_light_that_almost_touches_the_wall_is_right(
    place: tuple[float, float, float], toward: tuple[float, float]
) -> None:
    x, _, z = place
    view = View((x, -4.0, z), target=(x, 0.0, z), field_of_view=0.1)
    directed = Light("light", place, direction=(toward[0], 1.0, toward[1]), concentration=2)
    for light in (Light("light", place), directed):
        assert_as_the_paper(wall_scene(view=view, lights=[light]))


@pytest.mark.parametrize("distance", first(2, [5.0, 1e4, 211.0, 500.0, 5e3]))
@pytest.mark.parametrize("gap", [0.3, 0.01])
@pytest.mark.parametrize("concentration", [0, 40])
def test_the_wall_is_as_exact_through_a_telephoto_lens(
    distance: float, gap: float, concentration: float
) -> None:
    view = View((0, -distance, 0), target=(0, 0, 0), field_of_view=math.degrees(2 * math.atan(1 / distance)))
    light = Light("light", (0.05, -gap, -0.1), direction=(0.1, 1, 0.05), concentration=concentration)
    assert_as_the_paper(wall_scene(view=view, lights=[light]))


def planes_at(
    light: Light, point: Vector, normal: Vector, eye: Vector, model: ReflectionModel
) -> list[float]:
    """The diffuse and the specular plane at a point, by the closed form in float64."""
    to_light = unit(minus(light.position, point))
    cos_incidence = dot(normal, to_light)
    if cos_incidence <= 0:
        return [0.0, 0.0]
    left = controlled(light, point).intensity
    to_eye = unit(minus(eye, point))
    return [left * cos_incidence, left * specular_factor(model, to_light, normal, to_eye)]


def assert_exact_on_wall(
    light: Light, points: VisiblePoints, model: ReflectionModel, part: int = 1, from_rim: float = 1e-6
) -> None:
    """Both planes of a light are the closed form on the wall y = 0, which faces the eye, to 1e-4.

    Of its points, every seventh and those with the largest planes are examined, unless they are within
    `from_rim` of a sharp edge.
    """
    planes = planes_of(light, points, model)
    on_wall = np.flatnonzero(points.parts.numbers == part)
    brightest = on_wall[np.argsort(-planes[SPECULAR, on_wall])[:40]]
    chosen = np.unique(np.concatenate([on_wall[::7], brightest]))
    eye = points.view.eye
    expected, got = [], []
    for place in chosen.tolist():
        line, element = divmod(int(points.pixels[place]), points.elements)
        direction = ray(points.view, points.lines, points.elements, line, element)
        x, _, z = plus(eye, times(-eye[1] / direction[1], direction))
        point = (x, 0.0, z)
        if controlled(light, point).from_jump > from_rim:
            expected.append(planes_at(light, point, (0.0, math.copysign(1.0, eye[1]), 0.0), eye, model))
            got.append(planes[:, place].tolist())
    most = max(1.0, np.max(expected, initial=0.0))
    assert all_close(np.array(got), np.array(expected), rel=0.0, abs=1e-4 * most)


def before_a_plate(view: View, size: float) -> Mesh:
    """The wall, and behind it a plate that is much larger, across the view."""
    right, down, ahead = view.axes
    corner = np.array(view.eye) + (9 + size / 50) * ahead - size * (0.4 * right - 0.7 * down)
    plate = grid(1, 1, tuple(corner.tolist()), tuple((size * right).tolist()), tuple((-size * down).tolist()))
    return Mesh.joined(
        [wall(2, 2), Mesh(plate.coordinates, plate.node_numbers, plate.part_numbers, ("far",))]
    )


def on_a_floor(size: float) -> Mesh:
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
@pytest.mark.parametrize("size", first(1, [1e6, 1e4, 1e8]))
@given(angle=numbers(-180, 180), height=numbers(-1, 2))
def test_a_small_wall_before_a_large_plate_is_lit_by_the_closed_form(
    fields: dict[str, Any], size: float, angle: float, height: float
) -> None:
    view = View((1.0, -5.0, 1.2), target=(0.0, 0.0, 0.0), field_of_view=32.0, angle=angle)
    points = visible_surfaces(before_a_plate(view, size), view, (1, 1), 24, 32)
    assert points.starts_nearest
    light = Light("light", (0.7, -2.0, height), **fields)
    assert_exact_on_wall(light, points, Phong(20.0), from_rim=1e-5)


@pytest.mark.parametrize("fields", NEAR_LIGHTS.values(), ids=NEAR_LIGHTS)
@pytest.mark.parametrize("size", first(1, [1e5, 1e3]))
@given(angle=numbers(-180, 180), height=numbers(-1, 2))
def test_a_small_wall_on_a_floor_that_reaches_behind_the_eye_is_lit_by_the_closed_form(
    fields: dict[str, Any], size: float, angle: float, height: float
) -> None:
    view = View((1.0, -5.0, 0.4), target=(0.0, 0.0, 0.0), field_of_view=50.0, angle=angle)
    points = visible_surfaces(on_a_floor(size), view, (1, 1), 24, 32)
    assert points.starts_nearest
    light = Light("light", (0.7, -2.0, height), **fields)
    assert_exact_on_wall(light, points, Phong(20.0), from_rim=1e-5)


@pytest.mark.parametrize("size", [10.0, 1e3, 1e5])
@given(angle=numbers(-180, 180))
def test_a_floor_that_lies_on_a_flap_is_lit_to_the_horizon_and_just_beyond_the_flap_it_is_dark(
    size: float, angle: float
) -> None:
    view = View((1.0, -5.0, 0.4), target=(0.0, 0.0, 0.2), field_of_view=50.0, angle=angle)
    points = visible_surfaces(on_a_floor(size), view, (1, 1), 24, 32)
    floor = points.parts.numbers == 2
    near = floor & (np.linalg.norm(points.world_points - view.eye, axis=1) < 20)
    assert near.any()
    for least, lit in ((-1.5, floor), (-1.5 + 1e-3, np.zeros_like(near))):
        (side,) = sides_of(Light("light", (0, 0, 5), flaps=Flaps(z=Flap(minimum=least))), points)
        inside = is_inside(side, points.rows[POINT])
        assert (inside[near] == lit[near]).all()
        assert inside[lit].all()


STEEP: list[ReflectionModel] = [
    Phong(333.3),
    BlinnPhong(1e5),
    CookTorrance(0.05),
    *(model(exponent) for model in (Phong, BlinnPhong) for exponent in (101.0, 1e3)),
    Phong(1e5),
    *(CookTorrance(roughness) for roughness in (0.2, 0.02)),
]


@pytest.mark.parametrize("model", first(3, STEEP), ids=repr)
@given(
    eye=st.tuples(numbers(-2, 2), numbers(-4, -2), numbers(-2, 2)),
    x=numbers(-0.9, 0.9),
    z=numbers(-0.9, 0.9),
    away=st.sampled_from([0.3, 1.0, 4.0, 50.0, 1e4]),
)
def test_steep_highlights_on_a_wall_are_the_closed_form(
    model: ReflectionModel, eye: tuple[float, float, float], x: float, z: float, away: float
) -> None:
    # The highlight is at x, z, and fills the picture.
    middle = (x, 0.0, z)
    ahead = unit(minus(middle, eye))
    light = Light("light", aimed((0, 0, 0), plus(middle, times(away, (ahead[0], -ahead[1], ahead[2])))))
    exponent = 2 / model.roughness**2 if isinstance(model, CookTorrance) else vars(model)["exponent"]
    view = View(eye, target=middle, field_of_view=math.degrees(2 / math.sqrt(exponent)))
    assert_exact_on_wall(light, visible_surfaces(wall(), view, (1,), 24, 32), model)


@pytest.mark.parametrize("model", first(3, STEEP), ids=repr)
@given(light=st.tuples(*[numbers(-6, 6)] * 3), view=outside_views())
def test_steep_highlights_on_a_sphere_are_the_closed_form(
    model: ReflectionModel, light: tuple[float, float, float], view: View
) -> None:
    # What float32 points and normals cost is left out: the closed form starts from them.
    assume(math.hypot(*light) > 1.5)
    points = visible_surfaces(sphere(24, 16), view, (1,), 24, 32)
    planes = planes_of(Light("light", light), points, model)
    chosen = np.argsort(-planes[SPECULAR])[:40].tolist()
    expected = [
        planes_at(Light("light", light), point, unit(normal), view.eye, model)[SPECULAR]
        for point, normal in zip(
            points.world_points[chosen].tolist(), points.world_normals[chosen].tolist(), strict=True
        )
    ]
    most = max([1.0, *expected])
    assert all_close(planes[SPECULAR, chosen], np.array(expected), rel=0.0, abs=1e-4 * most)


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


def test_a_light_within_the_wall_gives_finite_light() -> None:
    scene = wall_scene(
        lights=[
            Light("point", (0.0, 0.0, 0.0)),
            Light("spot", (0.2, 0.0, 0.1), direction=(0, 1, 0), concentration=3, cone_angle=20),
        ]
    )
    picture = render(scene, (ELEMENTS + 1, LINES + 1))
    assert np.isfinite(picture.intensity).all()
    assert picture.ranges.whole.maximum < 2.5


@pytest.mark.parametrize("exponent", [1e4, 1e7, 1e30])
def test_no_exponent_makes_a_highlight_brighter_than_its_light(exponent: float) -> None:
    picture = render(
        wall_scene(
            reflectance=Reflectance(0.0, 1.0, exponent),
            view=View((0.3, -4.0, 0.2), target=(0.3, 0.0, 0.2), field_of_view=25.0),
            lights=[Light("light", (0.3, -4.0, 0.2))],
        ),
        (301, 301),
    )
    assert picture.ranges.whole.maximum <= 1.000001


@pytest.mark.parametrize("concentration", [1e4, 1e7, 1e30])
def test_no_concentration_makes_a_light_brighter(concentration: float) -> None:
    light = Light("light", (0.3, -4.0, 0.2), direction=(0, 1, 0), concentration=concentration)
    picture = render(wall_scene(reflectance=Reflectance(1, 0, 1), lights=[light]), (101, 101))
    assert picture.ranges.whole.maximum <= 1.000001


@pytest.mark.parametrize(("concentration", "half"), [(1, 60.0), (10, 21.1), (40, 10.6)])
def test_half_of_a_directed_light_is_left_at_the_angle_of_its_concentration(
    concentration: float, half: float
) -> None:
    light = Light("light", (0.0, -0.5, 0.0), direction=(0.0, 1.0, 0.0))
    points = visible_surfaces(wall(), View((0, -4, 0), target=(0, 0, 0), field_of_view=25), (1,), 401, 401)
    whole = planes_of(light, points, Phong(20.0))[0]
    directed = planes_of(light.replace(concentration=concentration), points, Phong(20.0))[0]
    angles = np.degrees(np.arctan2(np.hypot(points.world_points[:, 0], points.world_points[:, 2]), 0.5))
    order = np.argsort(angles)
    falling = (directed / whole)[order]
    assert np.interp(-0.5, -falling, angles[order]) == pytest.approx(half, abs=0.1)


def test_a_cone_of_more_than_90_degrees_lights_behind_a_light_without_concentration() -> None:
    # The light shines away from the wall; the wall is at 180 degrees and less from its direction.
    away = Light("light", (0.0, -1.0, 0.0), direction=(0.0, -1.0, 0.0), cone_angle=170.0)
    picture = render(wall_scene(lights=[away]), (69, 51))
    assert picture.intensity[25, 34] == 0
    assert picture.intensity[25, 59] > 0
    concentrated = render(wall_scene(lights=[away.replace(concentration=0.01)]), (69, 51))
    assert concentrated.ranges.whole.maximum == 0
    narrow = render(wall_scene(lights=[away.replace(cone_angle=90.0)]), (51, 51))
    assert narrow.ranges.whole.maximum == 0


@pytest.mark.parametrize("away", [2.0, 0.05])
@pytest.mark.parametrize(
    ("limits", "lit_side"),
    [(Flaps(x=Flap(minimum=0.0)), 1), (Flaps(x=Flap(maximum=0.0)), -1), (Flaps(z=Flap(0.0, 9.0)), 1)],
)
def test_a_flap_along_the_middle_of_the_wall_lights_exactly_its_side(
    limits: Flaps, lit_side: int, away: float
) -> None:
    light = Light("light", (0.0, -away, 0.0), flaps=limits)
    picture = render(wall_scene(lights=[light]), (40, 40))
    on_wall = picture.surface_number == 1
    line, element = np.indices((40, 40))
    side = np.where(element < 20, -1, 1) if limits.z is None else np.where(line < 20, 1, -1)
    assert (picture.intensity[on_wall & (side == lit_side)] > 0).all()
    assert (picture.intensity[side != lit_side] == 0).all()


@pytest.mark.parametrize("limit", [Flap(0.0, 0.0), Flap(minimum=0.0), Flap(maximum=0.0)])
def test_a_wall_that_lies_on_a_flap_is_lit(limit: Flap) -> None:
    view = View((1.0, -7.0, 2.0), target=(0.0, 0.0, 0.0))
    lit = render(
        wall_scene(view=view, lights=[Light("light", (0.3, -2.0, 0.1), flaps=Flaps(y=limit))]), (40, 30)
    )
    whole = render(wall_scene(view=view, lights=[Light("light", (0.3, -2.0, 0.1))]), (40, 30))
    assert lit.intensity.tobytes() == whole.intensity.tobytes()


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


@pytest.mark.parametrize("two_sided", [True, False])
def test_a_sphere_is_lit_as_the_paper_says(two_sided: bool) -> None:
    view = View((3.0, -4.0, 2.0), target=(0.0, 0.0, 0.0), field_of_view=25.0)
    reflectance = Reflectance(0.8, 0.6, 12.0)
    some = [
        Light("key", (2.0, -3.0, 3.0)),
        Light("spot", (-3.0, -3.0, 1.0), 0.7, aim=(0, 0, 0), concentration=10),
    ]
    scene = wall_scene(sphere(128, 64), lights=some, view=view, two_sided=two_sided)
    scene = scene.with_surface("sphere", reflectance=reflectance, two_sided=two_sided)
    picture = render(scene, (40, 40))
    for line, element in np.argwhere(picture.surface_number).tolist():
        direction = np.array(ray(view, 40, 40, line, element))
        eye = np.array(view.eye)
        half, square = direction @ eye, direction @ direction
        under = half * half - square * (eye @ eye - 1)
        if under < 0.02:
            continue
        point = (eye + (-half - math.sqrt(under)) / square * direction).tolist()
        each = [light_at(light, point, unit(point), view.eye, reflectance) for light in some]
        expected = sum(lit.intensity for lit in each)
        if min(lit.from_jump for lit in each) > 0.02:
            assert float(picture.intensity[line, element]) == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize("model", first(3, MODELS), ids=repr)
@given(light=lights(), view=wall_views())
def test_under_every_model_the_controls_leave_their_multiple_of_the_light(
    model: ReflectionModel, light: Light, view: View
) -> None:
    assume(max(map(abs, light.position)) > 0.05)
    points = visible_surfaces(sphere(24, 16), view, (1,), LINES, ELEMENTS)
    free = Light("light", light.position, direction=light.direction, at_infinity=light.at_infinity)
    whole, left = planes_of(free, points, model), planes_of(light, points, model)
    multipliers = [controlled(light, point) for point in points.world_points.tolist()]
    clear = np.array([each.from_jump > 1e-2 for each in multipliers])
    expected = whole * np.array([each.intensity for each in multipliers])
    assert left[:, clear] == pytest.approx(
        expected[:, clear], rel=1e-3, abs=2e-5 * max(float(whole.max()), 1)
    )
    dark = clear & np.array([each.intensity == 0 for each in multipliers])
    assert not left[:, dark].any()


@pytest.mark.parametrize("model", first(3, MODELS), ids=repr)
@given(
    place=st.tuples(numbers(-3, 3), numbers(-4, -1), numbers(-3, 3)),
    cone_angle=st.none() | st.sampled_from([3.0, 20.0]),
)
def test_under_every_model_both_planes_agree_with_the_slow_twin(
    model: ReflectionModel, place: tuple[float, float, float], cone_angle: float | None
) -> None:
    # A narrow cone lights few points, which are then picked and computed alone.
    light = Light("light", place, aim=(0, 0, 0), cone_angle=cone_angle)
    view = View((0.5, -3.0, 1.0), target=(0.0, 0.0, 0.0), field_of_view=30.0)
    points = visible_surfaces(wall(7, 5), view, (1,), LINES, ELEMENTS)
    diffuse, specular = planes_of(light, points, model)
    for number, point in enumerate(points.world_points.tolist()):
        to_light, to_eye = unit(minus(place, point)), unit(minus(view.eye, point))
        left = controlled(light, point)
        if left.from_jump < 1e-3:
            continue
        factor = specular_factor(model, to_light, [0.0, -1.0, 0.0], to_eye) * left.intensity
        assert diffuse[number] == pytest.approx(-to_light[1] * left.intensity, abs=1e-5)
        assert specular[number] == pytest.approx(factor, rel=1e-3, abs=1e-4)


def test_each_surface_is_reflected_by_its_own_model() -> None:
    mesh = Mesh.joined([sphere(12, 8), cube(1.4)])
    view = View((3.0, -4.0, 2.0), target=(0.0, 0.0, 0.0), field_of_view=40.0)
    points = visible_surfaces(mesh, view, (1, 2), 24, 32)
    light = camera_light(Light("light", (2.0, -3.0, 3.0)), points)

    def planes(models: dict[int, ReflectionModel]) -> Singles:
        filled = np.empty((2, len(points.pixels)), np.float32)
        for chunk in points.chunks:
            shade(filled, light, points, chunk, models)
        return filled

    both: list[ReflectionModel] = [Phong(12.0), CookTorrance(0.4)]
    mixed = planes({1: both[0], 2: both[1]})
    for surface, model in zip(points.slices, both, strict=True):
        alone = planes({1: model, 2: model})
        assert mixed[:, surface.pixels].tobytes() == alone[:, surface.pixels].tobytes()
        assert alone[1, surface.pixels].any()


@given(light=lights(on=True, intensity=1.0, direction=(1.0, 2.0, -0.5)), view=wall_views())
def test_a_light_at_infinity_lights_like_a_light_a_million_times_as_far_away(
    light: Light, view: View
) -> None:
    # What narrows a light is without effect at infinity, and what it carries would be moved.
    light = light.replace(concentration=0, cone_angle=None, inner_angle=None, half_spaces=())
    light = light.replace(falloff="none", at_infinity=True)
    assert light.axis is not None
    x, y, z = times(-1e7, light.axis)
    far = light.replace(position=(x, y, z), at_infinity=False)
    for mesh in (wall(3, 2), sphere(24, 16)):
        scene = wall_scene(mesh, view=view, lights=[light])
        at_infinity, moved = (render(each, (40, 30)) for each in (scene, scene.replace(lights=[far])))
        largest = max(float(moved.intensity.max()), 1e-3)
        assert all_close(at_infinity.intensity, moved.intensity, abs=1e-5 * largest)


def test_at_infinity_concentration_and_cone_leave_all_of_the_light_and_flaps_do_not() -> None:
    light = Light("light", (0.3, -2, 0.1), aim=(0, 0, 0), at_infinity=True)
    whole, narrow, flapped = (
        render(wall_scene(lights=[each]), (16, 12))
        for each in (
            light,
            light.replace(concentration=40, cone_angle=1),
            light.replace(flaps={"x": {"minimum": 0}}),
        )
    )
    near = render(wall_scene(lights=[light.replace(at_infinity=False)]), (16, 12))
    assert not np.allclose(whole.intensity, near.intensity, rtol=0.01)
    assert narrow.intensity.tobytes() == whole.intensity.tobytes()
    assert (flapped.intensity[:, :7] == 0).all()
    assert (flapped.intensity[:, 9:] == whole.intensity[:, 9:]).all()


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


@given(both, named(["key", "fill"]), numbers(0, 2), st.integers(-40, 40))
def test_lights_and_ambient_2_to_the_k_times_as_strong_have_the_same_weights(
    both: tuple[Surface, Surface], lights: tuple[Light, ...], ambient: float, k: int
) -> None:
    stronger = [light.replace(intensity=light.intensity * 2.0**k) for light in lights]
    one, other = (
        light_mix(PHONG, both, lights, ambient, ()),
        light_mix(PHONG, both, stronger, ambient * 2.0**k, ()),
    )
    assert (one.ambient, one.lights) == (other.ambient, other.lights)


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
        " the light's intensity or the surface's diffuse and specular",
    ),
    (wall_scene(sphere(), ambient=1e39), "ambient must stay below 3.4e+38, not 1e+39; lower it"),
    (
        wall_scene(ambient=1e39).with_view(eye=(0, 40, 0), direction=(0, 1, 0)),
        "ambient must stay below 3.4e+38, not 1e+39; lower it",
    ),
    (
        wall_scene(sphere(), lights=[HUGE]).with_surface("sphere", diffuse=1e300),
        "surface 'sphere' under light 'key': intensities must stay below 3.4e+38, not reach inf; lower the"
        " light's intensity or the surface's diffuse and specular",
    ),
    # The largest factor of a model counts.
    (
        wall_scene(
            reflectance=Reflectance(0.0, 1.0, CookTorrance(0.3, 0.05)),
            lights=[Light("key", (0, -1, 0), 1e37)],
        ),
        "surface 'wall' under light 'key': intensities must stay below 3.4e+38, not reach 9.81012e+38; lower"
        " the light's intensity or the surface's diffuse and specular",
    ),
]
test_intensities_that_float32_cannot_hold_are_refused = refused(lambda scene: render(scene, (12, 9)), REFUSED)


def test_nothing_at_all_has_a_scale_of_1() -> None:
    assert light_mix({}, (), (), 0.0, ()) == (1.0, np.float32(0), {})
