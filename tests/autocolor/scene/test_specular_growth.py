from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import CookTorrance, InputError, Phong, Surface
from autocolor.scene.columns.angle_kinds import AngleCurve
from autocolor.scene.columns.column import Tier
from autocolor.scene.columns.rows import cost, difference, plain
from autocolor.scene.reflection_models import MODELS
from autocolor.scene.specular_growth import START_CURVE, SpecularGrowth
from tests.autocolor import reference
from tests.autocolor.strategies import angle_curves, growths, numbers

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


@pytest.mark.parametrize("f0", [0.001, 0.02, 0.04, 0.17, 0.5, 0.95, 1.0])
def test_a_given_reflectance_is_schlicks_curve(f0: float) -> None:
    assert factor(SpecularGrowth(base_reflectance=f0)) == pytest.approx(schlick(f0), rel=1e-5)


@pytest.mark.parametrize(
    ("index", "f0"),
    [(1.07, 0.0011435), (4 / 3, 1 / 49), (1.5, 0.04), (2.42, 0.172398), (3.0, 0.25), (9, 0.64)],
)
def test_a_refractive_index_is_schlicks_curve_of_its_reflectance(index: float, f0: float) -> None:
    growth = SpecularGrowth(refractive_index=index)
    assert growth.normal_reflectance == pytest.approx(f0, rel=1e-4)
    assert growth.normal_reflectance is not None
    assert factor(growth) == pytest.approx(schlick(growth.normal_reflectance), rel=1e-5)


def test_glass_and_its_refractive_index_grow_alike() -> None:
    one, other = SpecularGrowth(base_reflectance=0.04), SpecularGrowth(refractive_index=1.5)
    assert factor(one) == pytest.approx(factor(other), rel=1e-6)


@given(angle_curves)
def test_a_curve_is_met_at_its_points_and_is_linear_in_the_angle_between_them(curve: AngleCurve) -> None:
    growth = SpecularGrowth(fresnel_curve=curve)
    angles, shares = zip(*curve, strict=True)
    expected = np.interp(np.degrees(np.arccos(COSINES.astype(np.float64))), angles, shares) / shares[0]
    assert factor(growth) == pytest.approx(expected, rel=1e-5, abs=1e-6)
    for (left, low), (right, high) in pairwise(curve):
        middle = np.float32(math.cos(math.radians((left + right) / 2)))
        at = math.degrees(math.acos(float(middle)))
        share = low + (high - low) * (at - left) / (right - left)
        assert factor(growth, np.array([middle]))[0] == pytest.approx(share / curve[0][1], rel=1e-5)


def test_a_curve_through_points_of_schlicks_is_close_to_it() -> None:
    shares = 0.04 * schlick(0.04, np.cos(np.radians(np.arange(91.0))))
    curve = tuple(zip(range(91), np.clip(shares, 0, 1).tolist(), strict=True))
    assert factor(SpecularGrowth(fresnel_curve=curve)) == pytest.approx(schlick(0.04), rel=2e-3)


@given(growths, numbers(0, 1))
def test_the_factor_is_that_of_the_slow_twin(growth: SpecularGrowth, cosine: float) -> None:
    single = np.array([cosine], np.float32)
    found = growth.factor(single)
    expected = reference.specular_growth(growth, float(single[0]))
    assert (1.0 if found is None else float(found[0])) == pytest.approx(expected, rel=1e-5, abs=1e-6)


@given(growths, st.lists(numbers(-2, 2), min_size=1))
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


@given(growths)
def test_the_factor_is_1_at_normal_incidence_and_its_largest_is_reached(growth: SpecularGrowth) -> None:
    cosines = np.cos(np.radians(np.arange(91.0))).astype(np.float32)
    found = growth.factor(cosines)
    if found is None:
        assert growth.largest == 1
        return
    assert found[0] == pytest.approx(1, abs=1e-6)
    # The cosine of an angle of a steep curve is rounded: the twin is asked at the same cosines.
    at_cosines = max(reference.specular_growth(growth, cosine) for cosine in cosines.tolist())
    assert found.max() == pytest.approx(at_cosines, rel=2e-5)
    if growth.fresnel_curve is None:
        assert found.max() == pytest.approx(growth.largest, rel=2e-5)
    else:
        shares = [share for _, share in growth.fresnel_curve]
        assert growth.largest == pytest.approx(max(shares) / shares[0])


@given(
    st.builds(SpecularGrowth, base_reflectance=numbers(0.001, 1))
    | st.builds(SpecularGrowth, refractive_index=numbers(1.07, 10))
    | st.just(SpecularGrowth(fresnel_curve=START_CURVE))
)
def test_s_never_falls_toward_grazing_incidence(growth: SpecularGrowth) -> None:
    assert (np.diff(factor(growth)) <= 0).all()


def test_without_a_material_there_is_nothing_to_multiply_by() -> None:
    assert SpecularGrowth().factor(COSINES) is None
    assert (SpecularGrowth().largest, SpecularGrowth().normal_reflectance) == (1, None)


@pytest.mark.parametrize("model", ["phong", "blinn"])
@pytest.mark.parametrize("way", WAYS)
def test_each_way_to_tell_it_is_a_key_of_the_surface(model: str, way: dict[str, Any]) -> None:
    surface = Surface("body").replace(model=model, exponent=9, **way)
    assert plain(surface).items() >= way.items()
    assert surface.reflectance.model == MODELS[model](9, SpecularGrowth(**way))  # type: ignore[call-arg]


def test_telling_it_in_another_way_takes_the_first_one_back() -> None:
    surface = Surface("body")
    for way in WAYS:
        before, surface = surface, surface.replace(**way)
        assert surface.reflectance.model == Phong(growth=SpecularGrowth(**way))
        assert before.replace(**difference(before, surface)) == surface  # type: ignore[arg-type]
    assert surface.replace(fresnel_curve=None) == Surface("body")


def test_an_edit_of_it_costs_the_lights_on_its_surface_and_one_of_s_a_sum() -> None:
    surface = Surface("body")
    for way in WAYS:
        assert cost(surface, surface.replace(**way)) == Tier.LIGHT
    grown = surface.replace(refractive_index=1.5)
    assert cost(grown, grown.replace(specular=0.9)) == Tier.MIX


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        (
            {"base_reflectance": 0},
            "base_reflectance must be a number from 0.001 to 1, not 0",
        ),
        (
            {"refractive_index": 1},
            "refractive_index must be a number from 1.07 to 10, not 1",
        ),
        (
            {"base_reflectance": 0.04, "refractive_index": 1.5},
            "refractive_index must stand without base_reflectance, not beside it; leave one out",
        ),
        (
            {"refractive_index": 1.5, "fresnel_curve": GLASS},
            "fresnel_curve must stand without refractive_index, not beside it; leave one out",
        ),
        (
            {"fresnel_curve": [[0, 0.04], [80, 1]]},
            "fresnel_curve must be 2 to 91 points [angle, share], with angles that rise from"
            " 0 to 90 and shares from 0 to 1, the first at least 0.001, not [[0, 0.04], [80, 1]]; write them"
            " as in [[0.0, 0.04], [50.0, 0.06], [70.0, 0.17], [80.0, 0.39], [90.0, 1.0]]",
        ),
        (
            {"model": "cook-torrance", "base_reflectance": 0.04},
            "base_reflectance must go with model = 'phong' or 'blinn', not with"
            " 'cook-torrance'; leave it out, or change the other",
        ),
    ],
)
def test_what_tells_no_growth_is_refused_in_a_sentence(changes: dict[str, Any], problem: str) -> None:
    with pytest.raises(InputError) as refusal:
        Surface("body").replace(**changes)
    assert refusal.value.problems == (f"surface 'body': {problem}",)


@pytest.mark.parametrize("way", WAYS)
def test_cook_and_torrance_have_a_fresnel_term_and_refuse_a_second(way: dict[str, Any]) -> None:
    (key,) = way
    for surface, changes in (
        (Surface("body"), {"model": CookTorrance(), **way}),
        (Surface("body").replace(model="cook-torrance"), way),
    ):
        with pytest.raises(InputError) as refusal:
            surface.replace(**changes)
        assert refusal.value.problems == (
            f"surface 'body': {key} must go with model = 'phong' or 'blinn', not with 'cook-torrance'; leave"
            " it out, or change the other",
        )
