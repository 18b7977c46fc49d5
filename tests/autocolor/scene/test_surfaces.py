from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given

from autocolor import Paint, Part, Reflectance, Surface
from autocolor.scene.columns import difference, from_plain, replaced, to_plain
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong
from autocolor.testing import paints
from tests.tables import call, refused


def test_a_surface_changes_its_own_fields_and_those_of_reflectance_and_paint() -> None:
    surface = Surface("body").replace(diffuse=0.2, blend=0.3, two_sided=False, object_color="#102030")
    assert surface.reflectance == Reflectance(diffuse=0.2)
    assert surface.paint == Paint(object_color=(16, 32, 48), blend=0.3)
    assert not surface.two_sided
    assert surface.replace(paint=Paint(), blend=0.1).paint == Paint(blend=0.1)


RAMP = ((34, 0, 0), (255, 102, 0), (255, 255, 255))


def test_a_ramp_and_two_colors_with_their_blend_unset_each_other() -> None:
    surface = Surface("body").replace(object_color="#102030", light_color="red", blend=0.3, diffuse=0.2)
    glowing = surface.replace(ramp=["#200", "#f60", "#fff"])
    assert glowing.paint == Paint(ramp=RAMP)
    assert glowing.reflectance == surface.reflectance
    changes = {"object_color": "#102030", "light_color": "red", "blend": 0.3, "light_percentage": 50}
    for name, value in changes.items():
        assert glowing.replace(**{name: value}).paint == Paint().replace(**{name: value})  # type: ignore[arg-type]
    assert glowing.replace(ramp=None).paint == Paint()
    assert surface.replace(ramp=None) == surface


@given(paints(), paints())
def test_a_paint_becomes_another_by_their_difference_and_comes_back_from_its_values(
    one: Paint, other: Paint
) -> None:
    assert replaced(one, difference(one, other)) == other
    assert from_plain(Paint, to_plain(one)) == one
    unset = {"object_color", "light_color", "blend", "light_percentage"} if one.ramp else {"ramp"}
    assert not unset & to_plain(one).keys()


def test_the_color_of_a_ramp_is_in_its_middle() -> None:
    assert Paint(ramp=RAMP).color == (255, 102, 0)
    assert Paint(ramp=RAMP[:2]).color == (145, 51, 0)
    assert Paint((176, 16, 32)).color == (176, 16, 32)


def test_a_reflectance_has_phongs_model_unless_it_is_given_another() -> None:
    assert Reflectance().model == Phong(20)
    assert Reflectance(0.1, 0.2, 30) == Reflectance(0.1, 0.2, Phong(30)) == Reflectance(0.1, 0.2, exponent=30)
    for exponent in (np.float32(20), np.int64(20), 20):
        assert Reflectance(0.7, 0.5, exponent).model == Phong(20)  # type: ignore[arg-type]
    assert Reflectance(model="blinn").model == BlinnPhong()
    assert Reflectance(model="blinn", exponent=7).model == BlinnPhong(7)
    assert Reflectance(model=CookTorrance(0.2)).model == CookTorrance(0.2)


def test_the_exponent_of_a_reflectance_is_that_of_its_model() -> None:
    assert Reflectance(exponent=7).exponent == 7
    with pytest.raises(AttributeError, match="must have an exponent, not CookTorrance"):
        _ = Reflectance(model="cook-torrance").exponent


def test_another_model_of_a_surface_begins_with_its_own_defaults() -> None:
    surface = Surface("body").replace(exponent=7)
    assert surface.reflectance.model == Phong(7)
    assert surface.replace(model="blinn").reflectance.model == BlinnPhong()
    assert surface.replace(model="cook-torrance", roughness=0.1).reflectance.model == CookTorrance(0.1)
    assert surface.replace(model="blinn").replace(exponent=9).reflectance.model == BlinnPhong(9)


BODY: Any = Surface("body")
A_RAMP = (
    "ramp must stand without object_color, light_color, blend and light_percentage, not beside them; leave"
    " out the ramp or these"
)
CHANGE_MODEL = "leave it out, or change the model"

test_surfaces_and_parts_that_break_a_rule_are_refused_with_their_names = refused(
    call,
    [
        (lambda: Paint((1, 2, 3), ramp=RAMP), A_RAMP),
        (lambda: from_plain(Paint, {"ramp": RAMP, "blend": 0.5}), A_RAMP),
        (lambda: Paint().replace(ramp=RAMP, light_percentage=0), A_RAMP),
        (lambda: BODY.replace(object_color="red").replace(ramp=RAMP, blend=0.6), f"surface 'body': {A_RAMP}"),
        (
            lambda: BODY.replace(normal_reflectance=0.1),
            "surface 'body': normal_reflectance must go with model = 'cook-torrance', not with 'phong';"
            f" {CHANGE_MODEL}",
        ),
        (
            lambda: BODY.replace(model="cook-torrance", exponent=9),
            "surface 'body': exponent must go with model = 'phong' or 'blinn', not with 'cook-torrance';"
            f" {CHANGE_MODEL}",
        ),
        (
            lambda: Reflectance(0.7, 0.5, 20, exponent=3),
            "exponent must be given once, not twice; leave one out",
        ),
        # Every problem is told, in the order of the changes.
        (
            lambda: BODY.replace(blend=2, object_color="rde", difuse=2),
            "surface 'body': there is no field 'difuse'; did you mean 'diffuse'?\n"
            "surface 'body': blend must be a number from 0 to 1, not 2\n"
            'surface \'body\': object_color must be "#rrggbb", a name such as "red", or three whole numbers'
            " from 0 to 255, not 'rde'; did you mean 'red'?",
        ),
        *(
            (
                lambda wrong=wrong: BODY.replace(reflectance=wrong, diffuse=0.5),
                f"surface 'body': reflectance must be a Reflectance, not {wrong!r}",
            )
            for wrong in (None, 5, Phong(3), np.zeros(3))
        ),
        (lambda: Surface("a", paint=0.5), "surface 'a': paint must be a Paint, not 0.5"),  # type: ignore[arg-type]
        (
            lambda: Part("door", "body").replace(surfaces="glass"),  # type: ignore[call-arg]
            "part 'door': there is no field 'surfaces'; did you mean 'surface'?",
        ),
    ],
)
