from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

from autocolor import (
    BlinnPhong,
    CookTorrance,
    Flap,
    Flaps,
    HalfSpace,
    Light,
    Mesh,
    Phong,
    Scene,
    View,
    scene_of,
)
from autocolor.explanation.light import (
    along_points,
    controls_at,
    edge_share,
    specular_factor,
    specular_growth,
)
from autocolor.explanation.point import (
    Camera,
    PointExplained,
    corner_rows,
    dot,
    length,
    minus,
    point_at,
    unit,
)
from autocolor.explanation.text import LABEL, PAGE, WIDTH, TextRow, rows_of_text
from autocolor.scene.reflection_models import SpecularGrowth
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.reference import ray
from tests.small import car, opened, sphere, wall_scene


def page_of(scene: Scene) -> list[TextRow]:
    return rows_of_text(opened(scene)[0].explain(12, 16))


def many_lights(count: int) -> list[Light]:
    return [Light(f"lamp {number} of a long row", (number, -5.0, 3.0)) for number in range(count)]


SCENES = {
    "plain": car(),
    "no light": car().replace(lights=[]),
    "many lights": car().replace(lights=many_lights(40)),
    "bands": car().with_scalar(name="z"),
    "missing": car().with_scalar(name="stress"),
    "dithered": car().replace(dither="ordered", mapping="gamma", contrast="floor"),
    "ramp": car().with_paint("body", ramp=[(number % 256, 0, 0) for number in range(1024)]),
    "normals": car().replace(words="normals"),
    "very bright": car().replace(ambient=1e9),
    "long names": car().replace(name="a name " * 20),
}


@pytest.mark.parametrize("name", SCENES)
def test_an_explanation_fits_on_a_page_of_80_columns(name: str) -> None:
    rows = page_of(SCENES[name])
    assert len(rows) <= PAGE
    for row in rows:
        assert len(row.label) < LABEL
        assert len(str(row)) <= WIDTH
        assert str(row).isprintable()


def test_lights_that_do_not_fit_are_counted_and_added_up() -> None:
    explanation = opened(car().replace(lights=many_lights(40)))[0].explain(12, 16)
    rows = rows_of_text(explanation)
    (rest,) = [row.says for row in rows if row.says.startswith("and ")]
    shown = [row for row in rows if re.match(r"[0-9]+ lamp", row.label)]
    count, total = re.match(r"and ([0-9]+) more +([0-9.]+)$", rest).groups()  # type: ignore[union-attr]
    assert int(count) == 40 - len(shown)
    left_out = sum(light.contribution for light in explanation.lights[len(shown) :])
    assert float(total) == pytest.approx(left_out, abs=1e-4)
    for row, light in zip(shown, explanation.lights, strict=False):
        assert row.label.startswith(f"{light.light} lamp")


def test_the_rows_say_the_word_and_the_color() -> None:
    explanation = opened()[0].explain(12, 16)
    says = {row.label: row.says for row in rows_of_text(explanation)}
    assert says["word"].startswith(f"{explanation.word} = first word ")
    assert says["color"].startswith("#{:02x}{:02x}{:02x}  red".format(*explanation.color))
    assert says["part"] == "1  hood"


def test_the_background_has_a_short_explanation() -> None:
    rows = rows_of_text(opened()[0].explain(0, 0))
    assert [row.label for row in rows] == ["pixel", "seen", "word", "color"]


LINES, ELEMENTS = 24, 32


def every_point(scene: Scene) -> list[PointExplained]:
    """The points at all pixels that see a polygon."""
    points = visible_surfaces(scene.mesh, scene.view, (1,), LINES, ELEMENTS)
    camera = Camera(scene.view, LINES, ELEMENTS)
    return [
        point_at(scene, camera, polygon, *divmod(pixel, ELEMENTS))
        for pixel, polygon in zip(points.pixels.tolist(), points.polygon_numbers.tolist(), strict=True)
    ]


def plane_scene(eye: tuple[float, float, float], target: tuple[float, float, float]) -> Scene:
    """A large floor at z = 0, which reaches behind the eye."""
    corners = np.array([(-9.0, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)])
    return scene_of(Mesh(corners, np.array([[0, 1, 2, 3]])), view=View(eye, target=target))


@pytest.mark.parametrize("eye", [(0.3, -20.0, 4.0), (0.3, -4.0, 1.0)])
def test_a_point_is_where_the_ray_meets_the_plane_also_of_a_floor_behind_the_eye(
    eye: tuple[float, float, float],
) -> None:
    scene = plane_scene(eye, (0.0, 0.0, 0.0))
    points = visible_surfaces(scene.mesh, scene.view, (1,), LINES, ELEMENTS)
    found = every_point(scene)
    assert found
    for at, pixel in zip(found, points.pixels.tolist(), strict=True):
        direction = ray(scene.view, LINES, ELEMENTS, *divmod(pixel, ELEMENTS))
        depth = -eye[2] / direction[2]
        expected = [start + depth * each for start, each in zip(eye, direction, strict=True)]
        assert at.point == pytest.approx(expected, abs=1e-9)
        assert at.normal == pytest.approx((0, 0, 1))
        assert at.distance == pytest.approx(math.dist(eye, expected))


def test_the_normal_of_a_ball_points_away_from_its_middle() -> None:
    scene = scene_of(sphere(64, 32), view=View((1.0, -4.0, 2.0), target=(0.0, 0.0, 0.0)))
    for at in every_point(scene):
        assert dot(at.normal, unit(at.point)) == pytest.approx(1, abs=2e-3)
        assert not at.is_turned


def test_the_reflected_view_leaves_as_the_ray_comes() -> None:
    scene = scene_of(sphere(16, 8), view=View((1.0, -4.0, 2.0), target=(0.0, 0.0, 0.0)))
    for at in every_point(scene):
        to_eye = unit(minus(scene.view.eye, at.point))
        assert dot(at.reflected_view, at.normal) == pytest.approx(dot(to_eye, at.normal))
        assert length(at.reflected_view) == pytest.approx(1)


def test_a_normal_is_turned_to_the_eye_unless_the_surface_has_one_side() -> None:
    scene = plane_scene((0.3, -20.0, -4.0), (0.0, 0.0, 0.0))
    name = scene.surfaces[0].name
    one_sided = scene.with_surface(name, two_sided=False)
    assert {(at.is_turned, at.normal[2]) for at in every_point(scene)} == {(True, -1.0)}
    assert {(at.is_turned, at.normal[2]) for at in every_point(one_sided)} == {(False, 1.0)}


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
def test_the_points_and_normals_of_a_zigzag_are_those_of_the_renderer(angle: float) -> None:
    # A dart, which a line crosses four times, with a bent normal at each corner.
    corners = np.array([(-1.0, 0.2, 1.0), (0.0, 0.0, -0.4), (1.0, 0.1, 1.0), (0.0, 0.0, -1.0)])
    view = View((0.2, -5.0, 0.3), target=(0.0, 0.0, 0.0), angle=angle)
    scene = scene_of(Mesh(corners, np.array([[0, 1, 2, 3]]), crease_angle=180.0), view=view)
    points = visible_surfaces(scene.mesh, view, (1,), LINES, ELEMENTS)
    found = every_point(scene)
    assert np.array([at.point for at in found]) == pytest.approx(points.world_points, abs=1e-6)
    assert np.array([at.normal for at in found]) == pytest.approx(points.world_normals, abs=1e-6)


def test_a_triangle_has_three_corners_wherever_it_repeats_one() -> None:
    corners = np.eye(3)
    for nodes in ([0, 1, 2, 2], [0, 0, 1, 2], [0, 1, 1, 2], [0, 1, 2, 0]):
        assert sorted(node for node, _ in corner_rows(Mesh(corners, np.array([nodes])), 0)) == [0, 1, 2]
    assert len(corner_rows(Mesh(corners, np.array([[1, 1, 1, 1]])), 0)) == 1


DOWN: dict[str, Any] = {"position": (0.0, 0.0, 1.0), "direction": (0.0, 0.0, -1.0)}


def at_angle(degrees: float) -> tuple[float, float, float]:
    """A point at an angle to the axis of a light that looks down."""
    return (math.tan(math.radians(degrees)), 0.0, 0.0)


@pytest.mark.parametrize(("exponent", "degrees"), [(1, 60), (10, 21.1), (40, 10.6)])
def test_a_concentration_leaves_half_at_the_papers_angles(exponent: float, degrees: float) -> None:
    light = Light("key", **DOWN, concentration=exponent)
    shares = controls_at(light, at_angle(degrees), wall_scene())
    assert shares == {"concentration": pytest.approx(0.5, abs=3e-3)}


def test_only_the_controls_that_a_light_uses_are_named() -> None:
    scene, origin = wall_scene(), (0.0, 0.0, 0.0)
    off = Flaps(x=Flap(5.0, 6.0, on=False))
    assert controls_at(Light("point", (0.0, 0.0, 1.0), flaps=off), origin, scene) == {}
    half_space = HalfSpace("door", (0.5, 0.0, 0.0), (1.0, 0.0, 0.0))
    light = Light(
        "all",
        **DOWN,
        on=False,
        concentration=1,
        cone_angle=10,
        flaps=Flaps(z=Flap(0.0, 1.0)),
        half_spaces=(half_space,),
        falloff="quadratic",
        reach=2.0,
    )
    # The floor lies in the plane of the flap, and is lit.
    assert controls_at(light, origin, scene) == {
        "switch": 0.0,
        "concentration": 1.0,
        "cone": 1.0,
        "flap z": 1.0,
        "half-space door": 0.0,
        "falloff": 0.25,
    }


def test_a_cone_ends_at_its_angle_and_a_soft_one_begins_at_its_inner_angle() -> None:
    scene = wall_scene()
    for angle, share in ((19.9, 1.0), (20.1, 0.0)):
        assert controls_at(Light("key", **DOWN, cone_angle=20), at_angle(angle), scene)["cone"] == share
    soft = Light("key", **DOWN, cone_angle=20, inner_angle=10)
    shares = [controls_at(soft, at_angle(angle), scene)["cone"] for angle in (9.9, 15.0, 20.1)]
    assert shares[0] == 1
    assert 0 < shares[1] < 1
    assert shares[2] == 0


def test_a_soft_edge_is_half_lit_in_its_middle_and_a_sharp_one_is_lit_on_the_edge() -> None:
    assert [edge_share(inside, 2.0) for inside in (-1.0, 0.0, 1.0, 2.0, 9.0)] == [0, 0, 0.5, 1, 1]
    assert [edge_share(inside, 0.0) for inside in (-1e-12, 0.0)] == [0, 1]
    assert edge_share(-1e-12, 0.0, 1e-9) == 1


@pytest.mark.parametrize("model", [Phong(20), BlinnPhong(20), CookTorrance(0.3, 0.05)])
def test_every_model_gives_1_where_light_and_eye_are_along_the_normal(model: Any) -> None:
    up = (0.0, 0.0, 1.0)
    assert specular_factor(model, up, up, up) == pytest.approx(1)
    aside = (math.sin(1.0), 0.0, math.cos(1.0))
    assert 0 <= specular_factor(model, aside, up, up) < 0.1


def test_no_power_exceeds_1_where_a_cosine_is_rounded_above_it() -> None:
    for components in ((1, 1, 1), (1, 1, 2), (1, 3, 7)):
        vector = unit(components)
        assert dot(vector, vector) > 1
        assert specular_factor(Phong(1e20), vector, vector, vector) <= 1
        assert specular_factor(BlinnPhong(1e20), vector, vector, vector) <= 1
        light = Light("key", position=vector, aim=(0.0, 0.0, 0.0), concentration=1e20)
        assert controls_at(light, (0.0, 0.0, 0.0), wall_scene())["concentration"] <= 1


def test_growth_is_1_at_normal_incidence_and_largest_at_a_grazing_one() -> None:
    assert specular_growth(SpecularGrowth(), 0.3) == 1
    for growth in (SpecularGrowth(base_reflectance=0.04), SpecularGrowth(refractive_index=1.5)):
        assert specular_growth(growth, 1.0) == pytest.approx(1)
        assert specular_growth(growth, 0.0) == pytest.approx(25)
    curve = SpecularGrowth(fresnel_curve=((0.0, 0.1), (60.0, 0.2), (90.0, 0.5)))
    assert specular_growth(curve, 0.5) == pytest.approx(2)


def test_a_line_through_points_keeps_the_ends_beyond_them() -> None:
    points = ((0.0, 1.0), (1.0, 3.0), (2.0, 3.0))
    assert [along_points(points, x) for x in (-1.0, 0.5, 1.5, 9.0)] == [1, 2, 3, 3]
