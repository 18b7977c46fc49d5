from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, View, render
from autocolor.lighting.light_controls.soft_cone import SoftCone
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.lighting.light_controls.lit_points import lit_at, wall_points
from tests.autocolor.meshes import wall, wall_scene
from tests.autocolor.reference import soft
from tests.autocolor.strategies import numbers

VIEW = View((1.0, -4.0, 1.0), target=(0.0, 0.0, 0.0))


def cosine(degrees: float) -> float:
    return math.cos(math.radians(degrees))


def spot(cone_angle: float, inner_angle: float | None, **given: float) -> Light:
    return Light(
        "light",
        (0.3, -2, 0.2),
        aim=(0.1, 0, 0),
        cone_angle=cone_angle,
        inner_angle=inner_angle,
        **given,  # type: ignore[arg-type]
    )


@given(numbers(4, 60), numbers(0, 1), st.sampled_from([0.0, 3.0]))
def test_a_soft_cone_on_a_wall_is_the_closed_form(
    cone_angle: float, fraction: float, concentration: float
) -> None:
    inner = fraction * (cone_angle - 2)
    light = spot(cone_angle, inner, concentration=concentration)
    scene = wall_scene(wall(half=2.0), view=VIEW, lights=[light])
    free = scene.with_light("light", cone_angle=None, inner_angle=None, concentration=0)
    points = visible_surfaces(scene.mesh, VIEW, (1,), 60, 80)
    lit, whole = (render(each, 60, 80).intensity.ravel()[points.pixels] for each in (scene, free))
    rays = points.world_points - light.position
    assert light.axis is not None
    cosines = rays @ light.axis / np.linalg.norm(rays, axis=1)
    rim, width = cosine(cone_angle), cosine(inner) - cosine(cone_angle)
    # Each rounding of a cosine counts as many times as the edge is steep.
    rounding = 1e-4 + 1e-6 / width
    expected = [soft(each - rim, width) * each**concentration for each in cosines.tolist()]
    assert lit.astype(np.float64) / whole == pytest.approx(expected, abs=rounding)


@given(numbers(1, 180), numbers(0, 1))
def test_all_is_left_up_to_the_inner_angle_and_nothing_at_the_rim(cone_angle: float, share: float) -> None:
    inner = share * (cone_angle - 1)
    control = SoftCone.of(spot(cone_angle, inner), wall_points())
    assert control is not None
    cosines = np.array(
        [1.0, cosine(inner / 2), cosine(inner) + 1e-6, cosine(cone_angle) - 1e-6, -1], np.float32
    )
    left = control.factor(lit_at(cosines), out=np.empty_like(cosines))
    assert left[:3] == pytest.approx(1, abs=1e-6)
    assert left[3:].tolist() == [0, 0]


def test_a_soft_cone_is_smooth_at_both_angles_and_on_the_axis() -> None:
    control = SoftCone.of(spot(40, 0), wall_points())
    assert control is not None
    degrees = np.arange(0, 50, 0.05)
    cosines = np.cos(np.radians(degrees)).astype(np.float32)
    left = control.factor(lit_at(cosines), out=np.empty_like(cosines)).astype(np.float64)
    slope = np.diff(left) / 0.05
    assert slope.max() < 1e-4
    assert np.abs(slope[:10]).max() < 1e-3
    assert np.abs(slope[np.abs(degrees[:-1] - 40) < 0.06]).max() < 1e-3
    assert np.abs(np.diff(slope)).max() < 1e-3


def test_a_cone_without_an_inner_angle_or_with_that_of_the_cone_is_sharp() -> None:
    assert SoftCone.of(spot(30, None), wall_points()) is None
    assert SoftCone.of(spot(30, 30), wall_points()) is None
    sharp, soft_one, narrow = (
        render(wall_scene(lights=[spot(15, inner)]), 30, 40).intensity for inner in (None, 15, 14)
    )
    assert sharp.tobytes() == soft_one.tobytes()
    assert (narrow <= sharp).all()
    assert narrow.tobytes() != sharp.tobytes()


@pytest.mark.parametrize(("outer", "inner"), [(1e-6, 0.0), (180.0, math.nextafter(180.0, 0.0)), (30.0, 0.0)])
def test_what_is_left_stays_within_0_and_1_however_narrow_the_edge(outer: float, inner: float) -> None:
    control = SoftCone.of(spot(outer, inner), wall_points())
    assert control is not None
    cosines = np.linspace(-1.0000002, 1.0000002, 1001).astype(np.float32)
    left = control.factor(lit_at(cosines), out=cosines)
    assert left is cosines
    assert ((left >= 0) & (left <= 1)).all()
