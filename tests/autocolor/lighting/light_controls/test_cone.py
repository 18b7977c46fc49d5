from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from autocolor import Light
from autocolor.lighting.light_controls.control import controls_of
from tests.autocolor.lighting.light_controls.lit_points import wall_points
from tests.autocolor.strategies import numbers


@pytest.mark.parametrize(
    ("cosine", "cone_angle", "concentration", "lit"),
    [
        (0.5, 60.0, 0.0, True),
        (0.49999, 60.0, 0.0, False),
        (-0.5, 121.0, 0.0, True),
        (-0.5, 121.0, 1.0, False),
        (0.0, 90.0, 0.0, True),
        (0.0, 90.0, 1.0, False),
        (0.0, None, 1.0, False),
        (1e-6, None, 1.0, True),
        (1e-45, None, 1.0, True),
        (-1.0, 180.0, 0.0, True),
        (1.0, 0.001, 40.0, True),
    ],
)
def test_a_point_is_in_the_cone_up_to_its_rim_and_before_a_concentrated_light(
    cosine: float, cone_angle: float | None, concentration: float, lit: bool
) -> None:
    light = Light(
        "light", (0, -1, 0), direction=(0, 1, 0), cone_angle=cone_angle, concentration=concentration
    )
    controls = controls_of(light, wall_points())
    assert all(control.directed for control in controls)
    least = max(control.least_cosine for control in controls)
    assert bool(np.float32(cosine) >= np.float32(least)) == lit


@given(numbers(0.001, 180), numbers(-1, 1))
def test_the_largest_least_cosine_is_the_cone_and_the_hemisphere(cone_angle: float, cosine: float) -> None:
    light = Light("light", (0, -1, 0), direction=(0, 1, 0), cone_angle=cone_angle, concentration=1)
    least = np.float32(max(control.least_cosine for control in controls_of(light, wall_points())))
    rim = np.float32(math.cos(math.radians(cone_angle)) - np.finfo(np.float32).eps)
    for each in (np.float32(cosine), rim, np.float32(0), np.nextafter(rim, np.float32(-2))):
        assert (each >= least) == (each >= rim and each > 0)
