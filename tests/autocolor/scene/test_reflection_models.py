from __future__ import annotations

import itertools
import math
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import InputError
from autocolor.arrays import Singles, power
from autocolor.scene.columns.column import Field, fields_of
from autocolor.scene.reflection_models import (
    LEAST_FACING,
    MODELS,
    BlinnPhong,
    CookTorrance,
    Cosines,
    Phong,
    ReflectionModel,
)
from autocolor.scene.specular_growth import SpecularGrowth
from tests.autocolor import reference
from tests.autocolor.meshes import ramp
from tests.autocolor.strategies import growths, numbers

exponents = st.sampled_from([0.0, 1e-3, 0.3, 1.0, 5.0, 20.0, 100.0])
models: st.SearchStrategy[ReflectionModel] = st.one_of(
    st.builds(Phong, exponents, growths),
    st.builds(BlinnPhong, exponents, growths),
    st.builds(CookTorrance, numbers(0.01, 1), numbers(0.001, 1)),
)
WIDEST = float(np.nextafter(np.float32(1), np.float32(2)))
cosines = numbers(-1, 1) | st.sampled_from([-WIDEST, -1.0, -1e-30, 0.0, 1e-45, 1e-30, 1.0, WIDEST])


def unused() -> Singles:
    raise AssertionError("N.V must not be computed")


def specular(
    model: ReflectionModel, incidence: list[float], eye: list[float], view: list[float]
) -> list[float]:
    rows = [np.array(each, np.float32) for each in (incidence, eye, view)]
    out = model.specular(Cosines(rows[0], rows[1], lambda: rows[2]), out=np.empty_like(rows[1]))
    return [float(each) for each in out]


def directions(polar: float, turn: float) -> list[float]:
    """A unit vector at a polar angle from z."""
    return [math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar)]


def factor_at(model: ReflectionModel, light: list[float], eye: list[float]) -> float:
    """The factor where the normal is z."""
    reflected = [-eye[0], -eye[1], eye[2]]
    return specular(model, [light[2]], [reference.dot(light, reflected)], [eye[2]])[0]


@given(
    models, numbers(0, math.pi / 2), numbers(0, math.pi / 2), numbers(0, 2 * math.pi), numbers(0, 2 * math.pi)
)
def test_the_factor_is_that_of_the_slow_twin(
    model: ReflectionModel, polar: float, eye_polar: float, turn: float, eye_turn: float
) -> None:
    light, eye = directions(polar, turn), directions(eye_polar, eye_turn)
    together = reference.plus(light, eye)
    # Where the half vector is hardly defined, float32 rounds as much as it says.
    assume(reference.dot(together, together) > 0.05)
    expected = reference.specular_factor(model, light, [0.0, 0.0, 1.0], eye)
    if isinstance(model, CookTorrance):
        # The slope of the distribution is the steeper the smoother the surface is.
        error = 1e-4 + 1e-5 / model.roughness**2
        assert factor_at(model, light, eye) == pytest.approx(expected, rel=error, abs=1e-6 * model.largest)
    else:
        # So much does a growth of S change where the cosine is rounded to float32.
        growth = vars(model).get("growth", SpecularGrowth())
        low, high = (reference.specular_growth(growth, light[2] + step) for step in (-2e-7, 2e-7))
        error = 2e-5 * model.largest + 2 * abs(high - low)
        assert factor_at(model, light, eye) == pytest.approx(expected, rel=2e-3, abs=error)


@pytest.mark.parametrize("roughness", [0.15, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("normal_reflectance", [0.02, 0.3, 1.0])
def test_cook_torrance_is_the_slow_twin_all_around(roughness: float, normal_reflectance: float) -> None:
    model = CookTorrance(roughness, normal_reflectance)
    for polar, eye_polar, turn in itertools.product(
        (0.1, 0.5, 0.9, 1.3), (0.0, 0.3, 0.7, 1.1, 1.5), (0, 1, 2, 3)
    ):
        light, eye = directions(polar, turn), directions(eye_polar, 0.0)
        expected = reference.specular_factor(model, light, [0.0, 0.0, 1.0], eye)
        assert factor_at(model, light, eye) == pytest.approx(expected, rel=1e-3, abs=1e-6)


@given(models)
def test_the_factor_is_1_at_normal_incidence_and_view(model: ReflectionModel) -> None:
    up = [0.0, 0.0, 1.0]
    assert factor_at(model, up, up) == pytest.approx(1, rel=1e-5)


@given(models, st.lists(st.tuples(cosines, cosines, cosines), min_size=1))
def test_no_cosines_give_anything_but_a_number_from_0_to_the_largest(
    model: ReflectionModel, some: list[tuple[float, float, float]]
) -> None:
    incidence, eye, view = (list(column) for column in zip(*some, strict=True))
    values = np.array(specular(model, incidence, eye, view))
    assert np.isfinite(values).all()
    assert (values >= 0).all()
    assert (values <= model.largest * 1.0001).all()


@given(models, st.lists(st.tuples(cosines, cosines, cosines), min_size=1))
def test_the_factor_may_overwrite_the_cosines_with_the_eye(
    model: ReflectionModel, some: list[tuple[float, float, float]]
) -> None:
    incidence, eye, view = (np.array(column, np.float32) for column in zip(*some, strict=True))
    expected = specular(model, incidence.tolist(), eye.tolist(), view.tolist())
    given_as = Cosines(incidence.copy(), eye, lambda: view)
    assert model.specular(given_as, out=eye) is eye
    assert eye.tolist() == expected
    assert given_as.incidence.tolist() == incidence.tolist()


@given(st.lists(cosines, min_size=1), exponents)
def test_phong_is_the_power_of_one_cosine_and_asks_for_no_other(
    cosines: list[float], exponent: float
) -> None:
    eye = np.array(cosines, np.float32)
    got = Phong(exponent).specular(Cosines(np.ones_like(eye), eye, unused), out=np.empty_like(eye))
    assert got.tobytes() == power(eye, exponent).tobytes()


@given(st.lists(st.tuples(cosines, cosines, cosines), min_size=1), exponents, growths)
def test_a_growth_multiplies_the_factor_without_it_by_a_function_of_incidence_alone(
    some: list[tuple[float, float, float]], exponent: float, growth: SpecularGrowth
) -> None:
    rows = [list(column) for column in zip(*some, strict=True)]
    times = growth.factor(np.array(rows[0], np.float32))
    for model in (Phong, BlinnPhong):
        plain = np.array(specular(model(exponent), *rows), np.float32)
        grown = specular(model(exponent, growth), *rows)
        assert grown == (plain if times is None else plain * times).tolist()


@given(st.lists(st.tuples(cosines, cosines, cosines), min_size=1), exponents, growths)
def test_the_factor_may_overwrite_the_cosines_of_incidence_too(
    some: list[tuple[float, float, float]], exponent: float, growth: SpecularGrowth
) -> None:
    for model in (Phong(exponent, growth), BlinnPhong(exponent, growth)):
        incidence, eye, view = (np.array(column, np.float32) for column in zip(*some, strict=True))
        expected = specular(model, incidence.tolist(), eye.tolist(), view.tolist())
        assert model.specular(Cosines(incidence, eye, partial(np.copy, view)), out=incidence) is incidence
        assert incidence.tolist() == expected


@pytest.mark.parametrize("model", [Phong, BlinnPhong])
def test_a_model_without_growth_computes_none(
    model: type[Phong | BlinnPhong], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("autocolor.scene.specular_growth._schlick", unused)
    monkeypatch.setattr("autocolor.scene.reflection_models.np.multiply", unused)
    assert specular(model(0.0), [0.5], [0.5], [0.5]) == [1]
    assert model(7).largest == 1


def test_a_growth_is_given_as_keys_too() -> None:
    assert Phong(5, growth={"refractive_index": 1.5}) == Phong(5, SpecularGrowth(refractive_index=1.5))  # type: ignore[arg-type]
    assert repr(Phong(5, SpecularGrowth(refractive_index=1.5))) == (
        "Phong(exponent=5.0, growth=SpecularGrowth(refractive_index=1.5))"
    )


@pytest.mark.parametrize("exponent", [1e4, 1e7, 1e30, 1e300])
def test_rounding_above_1_never_makes_a_peak(exponent: float) -> None:
    assert specular(Phong(exponent), [1, 1], [1.0000002, 1.0], [1, 1]) == [1, 1]


@pytest.mark.parametrize("exponent", [1.0, 3.0, 50.0])
def test_phong_never_falls_toward_the_reflected_view(exponent: float) -> None:
    steps = ramp(5000).tolist()
    assert (np.diff(specular(Phong(exponent), steps, steps, steps)) >= 0).all()


@given(
    st.builds(CookTorrance, numbers(0.05, 1), numbers(0.01, 1)),
    numbers(0, 1.2),
    numbers(0, 1.2),
    numbers(0, 2 * math.pi),
)
def test_cook_torrance_is_reciprocal_without_its_divisor(
    model: CookTorrance, polar: float, eye_polar: float, turn: float
) -> None:
    light, eye = directions(polar, 0.0), directions(eye_polar, turn)
    there = factor_at(model, light, eye) * max(eye[2], LEAST_FACING)
    back = factor_at(model, eye, light) * max(light[2], LEAST_FACING)
    assert there == pytest.approx(back, rel=1e-4 + 1e-5 / model.roughness**2, abs=1e-5)


@given(st.builds(BlinnPhong, exponents), numbers(0, 1.2), numbers(0, 1.2), numbers(0, 2 * math.pi))
def test_blinn_is_reciprocal(model: BlinnPhong, polar: float, eye_polar: float, turn: float) -> None:
    light, eye = directions(polar, 0.0), directions(eye_polar, turn)
    assert factor_at(model, light, eye) == pytest.approx(factor_at(model, eye, light), rel=1e-4, abs=1e-6)


def test_a_perfect_reflector_has_no_fresnel_term() -> None:
    for polar in (0.3, 0.9):
        ahead, back = directions(polar, 0.0), directions(polar, math.pi)
        # In the mirror direction D is 1, and so is G at less than 60 degrees.
        assert factor_at(CookTorrance(0.2, 1.0), ahead, back) == pytest.approx(1 / math.cos(polar), rel=1e-4)


def test_glancing_light_is_reflected_wholly() -> None:
    polar = math.radians(89)
    ahead, back = directions(polar, 0.0), directions(polar, math.pi)
    glancing = factor_at(CookTorrance(0.3, 0.05), ahead, back) * LEAST_FACING
    assert 0.85 / 0.05 < glancing < 1 / 0.05


@pytest.mark.parametrize(
    ("model", "fields", "problem"),
    [
        (Phong, {"exponent": -1}, "exponent must be a finite number of at least 0, not -1"),
        (BlinnPhong, {"exponent": math.inf}, "exponent must be a finite number of at least 0, not inf"),
        (CookTorrance, {"roughness": 0}, "roughness must be a number from 0.01 to 1, not 0"),
        (
            CookTorrance,
            {"normal_reflectance": 2},
            "normal_reflectance must be a number from 0.001 to 1, not 2",
        ),
    ],
)
def test_a_parameter_out_of_its_bounds_is_refused(model: Any, fields: dict[str, float], problem: str) -> None:
    with pytest.raises(InputError) as refusal:
        model(**fields)
    assert refusal.value.problems == (problem,)


def test_models_are_values_under_their_names() -> None:
    assert {"phong": Phong, "blinn": BlinnPhong, "cook-torrance": CookTorrance} == MODELS
    assert Phong(3) == Phong(3.0) != BlinnPhong(3)  # type: ignore[comparison-overlap]
    assert [model() for model in MODELS.values()] == [
        Phong(20.0),
        BlinnPhong(20.0),
        CookTorrance(0.3, 0.05),
    ]


def test_models_that_share_a_key_describe_it_alike() -> None:
    shared: dict[str, Field] = {}
    for model in MODELS.values():
        for name, field in fields_of(model).items():
            assert shared.setdefault(name, field).column == field.column
            assert vars(model())[name] == next(
                vars(other())[name] for other in MODELS.values() if name in fields_of(other)
            )
