from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from autocolor import InputError, Paint, Part, Reflectance, Surface
from autocolor.checks import shown
from autocolor.scene.columns import difference, from_plain, replaced, to_plain
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong
from autocolor.testing import paints


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Reflectance(diffuse=-1), "diffuse must be a finite number of at least 0, not -1"),
        (lambda: Reflectance(0.7, 0.5, -1), "exponent must be a finite number of at least 0, not -1"),
        (
            lambda: Reflectance(0.7, 0.5, 10**400),
            f"exponent must be a finite number of at least 0, not {shown(10**400)}",
        ),
        (lambda: Reflectance(exponent=math.inf), "exponent must be a finite number of at least 0, not inf"),
        (lambda: Paint(blend=1.5), "blend must be a number from 0 to 1, not 1.5"),
        (lambda: Paint(light_percentage=101), "light_percentage must be a number from 0 to 100, not 101"),
        (lambda: Surface(""), "surface: name must be a string of at least one character, not ''"),
        (
            lambda: Surface("body", levels=1),
            "surface 'body': levels must be a whole number from 2 to 1000000, not 1",
        ),
        (lambda: Surface("body", two_sided=1), "surface 'body': two_sided must be true or false, not 1"),  # type: ignore[arg-type]
    ],
)
def test_a_row_that_breaks_a_rule_is_refused(make: Any, sentence: str) -> None:
    with pytest.raises(InputError) as refusal:
        make()
    assert str(refusal.value) == sentence


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


def test_a_ramp_beside_another_color_is_refused() -> None:
    sentence = (
        "ramp must stand without object_color, light_color, blend and light_percentage, not beside them;"
        " leave out the ramp or these"
    )
    makes: list[Callable[[], object]] = [
        lambda: Paint((1, 2, 3), ramp=RAMP),
        lambda: from_plain(Paint, {"ramp": RAMP, "blend": 0.5}),
        lambda: Paint().replace(ramp=RAMP, light_percentage=0),
        lambda: Surface("body").replace(object_color="red").replace(ramp=RAMP, blend=0.6),
    ]
    for make in makes:
        with pytest.raises(InputError) as refusal:
            make()
        assert str(refusal.value).removeprefix("surface 'body': ") == sentence


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


def test_a_refused_field_is_told_with_the_surface() -> None:
    with pytest.raises(InputError) as refusal:
        Surface("body").replace(blend=2)
    assert str(refusal.value) == "surface 'body': blend must be a number from 0 to 1, not 2"
    with pytest.raises(
        InputError, match=r"surface 'body': there is no field 'difuse'; did you mean 'diffuse'"
    ):
        Surface("body").replace(difuse=2)  # type: ignore[call-arg]
    with pytest.raises(
        InputError, match=r"part 'door': there is no field 'surfaces'; did you mean 'surface'"
    ):
        Part("door", "body").replace(surfaces="glass")  # type: ignore[call-arg]


def test_every_problem_of_a_change_is_told_and_in_its_order() -> None:
    with pytest.raises(InputError) as refusal:
        Surface("body").replace(blend=2, object_color="rde")
    assert refusal.value.problems == (
        "surface 'body': blend must be a number from 0 to 1, not 2",
        'surface \'body\': object_color must be "#rrggbb", a name such as "red", or three whole numbers from'
        " 0 to 255, not 'rde'; did you mean 'red'?",
    )


def test_parts_and_surfaces_of_other_kinds_are_refused_in_a_sentence() -> None:
    with pytest.raises(InputError, match="part: name must be a string of at least one character, not 3"):
        Part(3, "wall")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="part 'hood': surface must be a string"):
        Part("hood", None)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="surface 'a': paint must be a Paint, not"):
        Surface("a", paint=0.5)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="surface 'a': reflectance must be a Reflectance, not 5"):
        Surface("a").replace(reflectance=5, diffuse=0.5)  # type: ignore[arg-type]


def test_numpy_scalars_serve_as_numbers_and_switches() -> None:
    surface = Surface("a", two_sided=np.False_, levels=np.int64(5))  # type: ignore[arg-type]
    assert (surface.two_sided, surface.levels) == (False, 5)
    assert type(surface.two_sided) is bool
    assert type(surface.levels) is int


def test_a_reflectance_has_phongs_model_unless_it_is_given_another() -> None:
    assert Reflectance().model == Phong(20)
    assert Reflectance(0.1, 0.2, 30) == Reflectance(0.1, 0.2, Phong(30)) == Reflectance(0.1, 0.2, exponent=30)
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


def test_a_key_of_another_model_is_refused_by_name() -> None:
    with pytest.raises(InputError) as refusal:
        Surface("body").replace(normal_reflectance=0.1)
    assert str(refusal.value) == (
        "surface 'body': normal_reflectance must go with model = 'cook-torrance', not with 'phong'; leave it"
        " out, or change the model"
    )
    with pytest.raises(InputError) as other:
        Surface("body").replace(model="cook-torrance", exponent=9)
    assert str(other.value) == (
        "surface 'body': exponent must go with model = 'phong' or 'blinn', not with 'cook-torrance'; leave it"
        " out, or change the model"
    )
    with pytest.raises(InputError, match=r"model must be .*, not 'phonk'; did you mean 'phong'\?"):
        Reflectance(model="phonk")


def test_an_exponent_may_be_any_kind_of_number_and_stands_once() -> None:
    for exponent in (np.float32(20), np.int64(20), 20):
        assert Reflectance(0.7, 0.5, exponent).model == Phong(20)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="exponent must be given once, not twice; leave one out"):
        Reflectance(0.7, 0.5, 20, exponent=3)


@pytest.mark.parametrize("wrong", [None, 5, Phong(3), np.zeros(3)])
def test_what_is_no_reflectance_is_refused_beside_one_of_its_keys_too(wrong: Any) -> None:
    with pytest.raises(InputError, match="surface 'a': reflectance must be a Reflectance, not"):
        Surface("a").replace(reflectance=wrong, diffuse=0.5)


def test_a_class_that_derives_from_a_model_is_none_of_the_models() -> None:
    class Duller(Phong):
        pass

    with pytest.raises(InputError, match=r"model must be 'phong', .* not Duller\(\)"):
        Reflectance(model=Duller())


@pytest.mark.parametrize("value", [dict, {"x": 1}, type("Keyed", (), {"keys": 3})()])
def test_a_value_with_keys_is_no_number(value: Any) -> None:
    with pytest.raises(InputError, match="surface 'a': levels must be a whole number from 2 to 1000000, not"):
        Surface("a").replace(levels=value)
