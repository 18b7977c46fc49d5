from __future__ import annotations

import math
from typing import Any

import pytest

from autocolor import BlinnPhong, CookTorrance, Flap, Flaps, HalfSpace, Light, Phong
from autocolor.explanation.light import (
    along_points,
    controls_at,
    edge_share,
    specular_factor,
    specular_growth,
)
from autocolor.explanation.point import dot, unit
from autocolor.scene.reflection_models import SpecularGrowth
from tests.small import wall_scene

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
