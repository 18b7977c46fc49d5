from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Surface
from autocolor.scene.columns import Column, difference, fields_of
from autocolor.scene.kinds import AngleCurve
from autocolor.scene.reflection_models import (
    MODELS,
    BlinnPhong,
    CookTorrance,
    Phong,
    ReflectionModel,
    SpecularGrowth,
)
from autocolor.testing import growths, numbers
from tests.autocolor.twins.light import specular_factor, specular_growth
from tests.autocolor.twins.point import dot, plus
from tests.closeness import all_close
from tests.tables import refused

exponents = st.sampled_from([0.0, 1e-3, 0.3, 1.0, 5.0, 20.0, 100.0])
models: st.SearchStrategy[ReflectionModel] = st.one_of(
    st.builds(Phong, exponents, growths()),
    st.builds(BlinnPhong, exponents, growths()),
    st.builds(CookTorrance, numbers(0.01, 1), numbers(0.001, 1)),
)
WIDEST = float(np.nextafter(np.float32(1), np.float32(2)))
cosines = numbers(-1, 1) | st.sampled_from([-WIDEST, -1.0, -1e-30, 0.0, 1e-45, 1e-30, 1.0, WIDEST])


def specular(
    model: ReflectionModel, incidence: list[float], eye: list[float], view: list[float]
) -> list[float]:
    rows = [np.array(each, np.float32) for each in (incidence, eye, view)]
    return [float(each) for each in model.specular(*rows)]


def directions(polar: float, turn: float) -> list[float]:
    """A unit vector at a polar angle from z."""
    return [math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar)]


def factor_at(model: ReflectionModel, light: list[float], eye: list[float]) -> float:
    """The factor where the normal is z."""
    reflected = [-eye[0], -eye[1], eye[2]]
    return specular(model, [light[2]], [dot(light, reflected)], [eye[2]])[0]


@given(
    models, numbers(0, math.pi / 2), numbers(0, math.pi / 2), numbers(0, 2 * math.pi), numbers(0, 2 * math.pi)
)
def test_the_factor_is_that_of_the_slow_twin(
    model: ReflectionModel, polar: float, eye_polar: float, turn: float, eye_turn: float
) -> None:
    light, eye = directions(polar, turn), directions(eye_polar, eye_turn)
    together = plus(light, eye)
    # Where the half vector is hardly defined, float32 rounds as much as it says.
    assume(dot(together, together) > 0.05)
    expected = specular_factor(model, light, [0.0, 0.0, 1.0], eye)
    if isinstance(model, CookTorrance):
        # The slope of the distribution is the steeper the smoother the surface is.
        error = 1e-4 + 1e-5 / model.roughness**2
        assert factor_at(model, light, eye) == pytest.approx(expected, rel=error, abs=1e-6 * model.largest)
    else:
        # So much does a growth of S change where the cosine is rounded to float32.
        growth = vars(model).get("growth", SpecularGrowth())
        low, high = (specular_growth(growth, light[2] + step) for step in (-2e-7, 2e-7))
        error = 2e-5 * model.largest + 2 * abs(high - low)
        assert factor_at(model, light, eye) == pytest.approx(expected, rel=2e-3, abs=error)


@pytest.mark.parametrize(
    ("model", "polar", "eye_polar", "turn", "expected"),
    [
        # No microfacet shadows another.
        (CookTorrance(0.4, 0.2), 50, 35, 100, 0.24320810065),
        (CookTorrance(0.3, 0.04), 60, 65, 170, 4.5210660812),
        # Microfacets shadow the light, and those of the eye hide it.
        (CookTorrance(0.6, 0.1), 75, 20, 140, 0.49639410995),
        (CookTorrance(0.9, 0.5), 70, 40, 30, 0.44442499471),
        # The eye is lower than the divisor counts.
        (CookTorrance(0.8, 0.05), 55, 80, 60, 0.01826360354),
        # In the mirror direction D is 1, and so is G at less than 60 degrees.
        (CookTorrance(0.2, 1.0), 30, 30, 180, 2 / math.sqrt(3)),
    ],
)
def test_cook_torrance_is_the_product_of_its_terms_at_oblique_angles(
    model: CookTorrance, polar: float, eye_polar: float, turn: float, expected: float
) -> None:
    # Computed by hand: D from the angle of the half vector, F from Fresnel's sines and tangents of the
    # angles on both sides (Snell's law), G from its two ratios.
    light = directions(math.radians(polar), 0.0)
    eye = directions(math.radians(eye_polar), math.radians(turn))
    assert factor_at(model, light, eye) == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("model", [Phong(1e5), BlinnPhong(1e5), CookTorrance(0.02, 0.1)], ids=repr)
@pytest.mark.parametrize("polar", [0.3, 1.2])
def test_a_narrow_highlight_is_exact_for_exact_cosines(model: ReflectionModel, polar: float) -> None:
    # The light is at up to a hundredth of a radian from the mirrored eye.
    away, turn = np.meshgrid(np.linspace(0, 0.01, 21), np.linspace(0, 6, 7))
    eye = np.array(directions(polar, math.pi))
    mirrored, side = np.array(directions(polar, 0.0)), np.array([0.0, 1.0, 0.0])
    over = np.cross(mirrored, side)
    lights = np.cos(away)[..., None] * mirrored + np.sin(away)[..., None] * (
        np.cos(turn)[..., None] * side + np.sin(turn)[..., None] * over
    )
    lights = lights.reshape(-1, 3)
    found = model.specular(lights[:, 2], lights @ mirrored, np.full(len(lights), eye[2]))
    assert found.dtype == np.float64
    expected = [specular_factor(model, light, [0.0, 0.0, 1.0], eye.tolist()) for light in lights.tolist()]
    assert found == pytest.approx(expected, abs=1e-6 * max(expected))


@given(models, st.lists(st.tuples(cosines, cosines, cosines), min_size=1))
def test_no_cosines_give_anything_but_a_number_from_0_to_the_largest(
    model: ReflectionModel, some: list[tuple[float, float, float]]
) -> None:
    incidence, eye, view = (list(column) for column in zip(*some, strict=True))
    values = np.array(specular(model, incidence, eye, view))
    assert np.isfinite(values).all()
    assert (values >= 0).all()
    assert (values <= model.largest * 1.0001).all()


@pytest.mark.parametrize("exponent", [1e4, 1e7, 1e30, 1e300])
def test_rounding_above_1_never_makes_a_peak(exponent: float) -> None:
    assert specular(Phong(exponent), [1, 1], [1.0000002, 1.0], [1, 1]) == [1, 1]


def test_models_are_values_under_their_names() -> None:
    assert {"phong": Phong, "blinn": BlinnPhong, "cook-torrance": CookTorrance} == MODELS
    assert Phong(3) == Phong(3.0) != BlinnPhong(3)  # type: ignore[comparison-overlap]
    assert [model() for model in MODELS.values()] == [
        Phong(20.0),
        BlinnPhong(20.0),
        CookTorrance(0.3, 0.05),
    ]


def test_models_that_share_a_key_describe_it_alike() -> None:
    shared: dict[str, Column] = {}
    for model in MODELS.values():
        for name, field in fields_of(model).items():
            assert shared.setdefault(name, field) == field
            assert vars(model())[name] == next(
                vars(other())[name] for other in MODELS.values() if name in fields_of(other)
            )


COSINES = np.linspace(0, 1, 20001, dtype=np.float32)
GLASS: AngleCurve = ((0, 0.04), (30, 0.042), (60, 0.09), (75, 0.25), (85, 0.61), (90, 1))
WAYS: list[dict[str, Any]] = [
    {"base_reflectance": 0.04},
    {"refractive_index": 1.5},
    {"fresnel_curve": GLASS},
]


def factor(growth: SpecularGrowth, cosines: np.ndarray[Any, Any] = COSINES) -> np.ndarray[Any, Any]:
    found = growth.factor(cosines.astype(np.float32))
    assert found is not None
    assert found.dtype == np.float32
    return found.astype(np.float64)


def schlick(f0: float, cosines: np.ndarray[Any, Any] = COSINES) -> np.ndarray[Any, Any]:
    """Schlick's factor over F0, by the closed form in float64."""
    return (f0 + (1 - f0) * (1 - cosines.astype(np.float64)) ** 5) / f0


@pytest.mark.parametrize(
    ("index", "f0"),
    [(1.07, 0.0011435), (4 / 3, 1 / 49), (1.5, 0.04), (2.42, 0.172398), (3.0, 0.25), (9, 0.64)],
)
def test_a_refractive_index_is_schlicks_curve_of_its_reflectance(index: float, f0: float) -> None:
    growth = SpecularGrowth(refractive_index=index)
    assert growth.normal_reflectance == pytest.approx(f0, rel=1e-4)
    assert growth.normal_reflectance is not None
    assert all_close(factor(growth), schlick(growth.normal_reflectance), rel=1e-5)


@given(growths(), st.lists(numbers(-2, 2), min_size=1))
def test_cosines_out_of_their_range_count_as_its_ends(growth: SpecularGrowth, cosines: list[float]) -> None:
    given_as = np.array(cosines, np.float32)
    kept = given_as.copy()
    found = growth.factor(given_as)
    within = growth.factor(np.clip(given_as, np.float32(0), np.float32(1)))
    assert given_as.tobytes() == kept.tobytes()
    if found is not None and within is not None:
        assert found.tobytes() == within.tobytes()
        assert (found >= 0).all()
        assert (found <= growth.largest * 1.00001).all()


@given(growths())
def test_the_factor_is_1_at_normal_incidence_and_its_largest_is_reached(growth: SpecularGrowth) -> None:
    cosines = np.cos(np.radians(np.arange(91.0))).astype(np.float32)
    found = growth.factor(cosines)
    if found is None:
        assert growth.largest == 1
        return
    assert found[0] == pytest.approx(1, abs=1e-6)
    # The cosine of an angle of a steep curve is rounded: the twin is asked at the same cosines.
    at_cosines = max(specular_growth(growth, cosine) for cosine in cosines.tolist())
    assert found.max() == pytest.approx(at_cosines, rel=2e-5)
    if growth.fresnel_curve is None:
        assert found.max() == pytest.approx(growth.largest, rel=2e-5)
    else:
        shares = [share for _, share in growth.fresnel_curve]
        assert growth.largest == pytest.approx(max(shares) / shares[0])


def test_another_column_of_the_growth_removes_the_first() -> None:
    surface = Surface("body")
    for way in WAYS:
        before, surface = surface, surface.replace(**way)
        assert surface.reflectance.model == Phong(growth=SpecularGrowth(**way))
        assert before.replace(**difference(before, surface)) == surface  # type: ignore[arg-type]
    assert surface.replace(fresnel_curve=None) == Surface("body")


GO_WITH = (
    "must go with model = 'phong' or 'blinn', not with 'cook-torrance'; leave it out, or change the model"
)
BODY: Any = Surface("body")

test_a_growth_that_does_not_go_with_the_other_columns_is_refused = refused(
    lambda changes: BODY.replace(**changes),
    [
        (changes, f"surface 'body': {sentence}")
        for changes, sentence in (
            (
                {"base_reflectance": 0.04, "refractive_index": 1.5},
                "refractive_index must stand without base_reflectance, not beside it; leave one out",
            ),
            (
                {"refractive_index": 1.5, "fresnel_curve": GLASS},
                "fresnel_curve must stand without refractive_index, not beside it; leave one out",
            ),
            ({"model": "cook-torrance", "base_reflectance": 0.04}, f"base_reflectance {GO_WITH}"),
            ({"model": CookTorrance(), "fresnel_curve": GLASS}, f"fresnel_curve {GO_WITH}"),
        )
    ],
)
