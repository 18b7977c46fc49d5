from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Light, render
from autocolor.lighting.light_controls.control import LitPoints, controls_of
from autocolor.lighting.light_controls.falloff import Falloff
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.lighting.light_controls.lit_points import wall_points
from tests.autocolor.meshes import wall, wall_scene
from tests.autocolor.strategies import Vector, numbers, vectors

FALLING = st.sampled_from(["linear", "quadratic"])


@pytest.mark.parametrize("falloff", ["linear", "quadratic"])
@pytest.mark.parametrize("reach", [1.2, 1.7, 9.0])
def test_on_a_wall_the_light_falls_with_the_distance_to_nothing_at_its_reach(
    falloff: Any, reach: float
) -> None:
    light = Light("light", (0.25, -1.0, 0.125))
    free = wall_scene(lights=[light])
    falling = wall_scene(lights=[light.replace(falloff=falloff, reach=reach)])
    points = visible_surfaces(wall(), free.view, (1,), 40, 40)
    x, _, z = points.world_points.T
    left = np.maximum(1 - np.sqrt(1 + (x - 0.25) ** 2 + (z - 0.125) ** 2) / reach, 0)
    left = left if falloff == "linear" else left**2
    intensities = [render(each, 40, 40).intensity.ravel()[points.pixels] for each in (free, falling)]
    assert intensities[1] == pytest.approx(left * intensities[0], abs=1e-5)
    assert (left.min() == 0) == (reach < 1.8)
    assert left.max() > 0.02


def test_a_light_falls_to_a_half_and_to_a_quarter_at_half_its_reach() -> None:
    points = wall_points()
    distances = np.array([0, 0.5, 1, 2, 4], np.float32)
    at = LitPoints(None, lambda: distances / np.float32(points.unit), lambda: np.zeros((3, 5), np.float32))
    for falloff, expected in (("linear", [1, 0.75, 0.5, 0, 0]), ("quadratic", [1, 0.5625, 0.25, 0, 0])):
        (control,) = controls_of(Light("light", (0, -1, 0), falloff=falloff, reach=2), points)
        assert control.factor(at, out=np.empty(5, np.float32)).tolist() == pytest.approx(expected, abs=1e-6)


@given(vectors(numbers(-3, 3)), FALLING, numbers(0.01, 6) | st.sampled_from([1e-300, 1e-9, 1e30, 1e36]))
def test_all_points_that_a_light_reaches_may_be_lit_and_the_factor_is_0_to_1_at_all(
    position: Vector, falloff: str, reach: float
) -> None:
    points = wall_points()
    (control,) = controls_of(Light("light", position, falloff=falloff, reach=reach), points)
    may_be_lit = control.lit_points(points.rows, slice(None))
    away = np.array([math.dist(point, position) for point in points.world_points.tolist()])
    assert may_be_lit is not None
    assert may_be_lit[away < reach].all()
    assert not may_be_lit[away > reach + 1e-2].any()
    lengths = np.maximum(away / points.unit, 1e-18).astype(np.float32)
    at = LitPoints(None, lambda: lengths, lambda: points.rows[:3])
    factor = control.factor(at, out=np.empty_like(lengths))
    assert ((factor >= 0) & (factor <= 1)).all()


@given(FALLING, st.sampled_from([1e12, 1e20, 1e36]))
def test_a_light_beyond_all_that_falls_gives_nothing_here(falloff: str, distance: float) -> None:
    light = Light("light", (0, -distance, 0), falloff=falloff, reach=3)
    assert not render(wall_scene(lights=[light]), 4, 4).intensity.any()


def test_a_light_without_a_falloff_is_left_as_it_is() -> None:
    for light in (Light("light", (0, -1, 0)), Light("light", (0, -1, 0), reach=2)):
        assert not any(isinstance(each, Falloff) for each in controls_of(light, wall_points()))


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        (
            {"falloff": "linear"},
            "light 'light': falloff must come with a reach, not 'linear' alone; add a reach",
        ),
        (
            {"falloff": "linear", "reach": 2, "direction": (0, 1, 0), "at_infinity": True},
            "light 'light': falloff must be 'none' for a light at infinity, not 'linear'; change one of them",
        ),
        ({"reach": 0}, "light 'light': reach must be a number above 0, not 0"),
    ],
)
def test_a_falloff_without_a_reach_or_at_infinity_is_refused(
    fields: dict[str, object], sentence: str
) -> None:
    with pytest.raises(InputError) as refusal:
        Light("light", (0, -1, 0), **fields)  # type: ignore[arg-type]
    assert str(refusal.value) == sentence
