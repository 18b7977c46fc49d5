from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Light, View
from autocolor.lighting.light_controls import concentrated, controls, inside_cone, inside_flaps
from autocolor.visibility.visible_points import VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import wall
from tests.autocolor.strategies import lights, numbers


def wall_points() -> VisiblePoints:
    return visible_surfaces(wall(), View((1, -4, 1), target=(0, 0, 0)), (1,), 12, 12)


@given(numbers(0, 60), numbers(1e-6, 1))
def test_the_concentrated_light_is_the_cosine_to_the_power_of_the_concentration(
    concentration: float, cosine: float
) -> None:
    value = concentrated(np.array([cosine], np.float32), concentration)[0]
    assert value == pytest.approx(float(np.float32(cosine)) ** concentration, rel=2e-5, abs=1e-30)


@pytest.mark.parametrize(("concentration", "degrees"), [(1, 60.0), (10, 21.1), (40, 10.6)])
def test_half_is_left_at_the_papers_angles(concentration: float, degrees: float) -> None:
    cosine = np.array([math.cos(math.radians(degrees))], np.float32)
    assert concentrated(cosine, concentration)[0] == pytest.approx(0.5, abs=0.005)


@given(st.lists(numbers(1e-6, 1), min_size=2), st.sampled_from([0.5, 1, 2, 40, 1e6, 1e30, 1e300]))
def test_the_multiplier_never_leaves_0_to_1(cosines: list[float], concentration: float) -> None:
    values = concentrated(np.array([*cosines, 1.0000002], np.float32), concentration)
    assert ((values >= 0) & (values <= 1)).all()


def test_a_point_source_without_flaps_needs_no_test() -> None:
    ready = controls(Light("light", (0, -1, 0)), wall_points())
    assert ready.toward is None
    assert inside_flaps(ready, wall_points().rows) is None


@given(lights())
def test_the_light_direction_is_turned_to_the_eyes_axes_and_stays_a_unit(light: Light) -> None:
    ready = controls(light, wall_points())
    if light.axis is None or (light.concentration == 0 and light.cone_angle is None):
        assert ready.toward is None
    else:
        assert ready.toward is not None
        assert np.linalg.norm(ready.toward) == pytest.approx(1)
        back = wall_points().view.axes.T @ ready.toward
        assert back == pytest.approx(np.array(light.axis), abs=1e-12)


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
    points = wall_points()
    assert inside_cone(controls(light, points), np.array([cosine], np.float32)).tolist() == [lit]


@given(numbers(-1, 1), numbers(0, 1), st.sampled_from("xz"))
def test_a_point_is_within_a_flap_up_to_both_its_ends(least: float, extent: float, axis: str) -> None:
    points = wall_points()
    flap = Flap(least, least + extent)
    at = inside_flaps(controls(Light("light", (0, -1, 0), flaps=Flaps(**{axis: flap})), points), points.rows)
    coordinate = points.world_points[:, "xyz".index(axis)]
    clear = np.minimum(np.abs(coordinate - flap.minimum), np.abs(coordinate - flap.maximum)) > 1e-5
    expected = (flap.minimum <= coordinate) & (coordinate <= flap.maximum)
    assert at is not None
    assert at[clear].tolist() == expected[clear].tolist()
