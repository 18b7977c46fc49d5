from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, HalfSpace, Light, View, render
from autocolor.arrays import Floats
from autocolor.lighting.light_controls.control import LitPoints
from autocolor.lighting.light_controls.soft_sides import SoftSides
from autocolor.visibility.visible_points import POINT, VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.lighting.light_controls.lit_points import wall_points
from tests.autocolor.meshes import wall, wall_scene
from tests.autocolor.reference import soft
from tests.autocolor.strategies import Vector, directions, numbers, vectors

VIEW = View((1.0, -4.0, 1.0), target=(0.0, 0.0, 0.0))


def left_at(light: Light, points: VisiblePoints) -> list[float]:
    """What soft edges leave at the points."""
    control = SoftSides.of(light, points)
    assert control is not None

    def positions() -> Any:
        return points.rows[POINT]

    def nobody_asks() -> Any:
        raise AssertionError

    out = np.empty(len(points.pixels), np.float32)
    assert control.factor(LitPoints(None, nobody_asks, positions), out) is out
    return out.tolist()


def ratio(light: Light) -> tuple[Floats, VisiblePoints]:
    """What all controls leave of a light on a wall, and the points there."""
    scene = wall_scene(wall(half=2.0), view=VIEW, lights=[light])
    free = wall_scene(wall(half=2.0), view=VIEW, lights=[Light("light", light.position)])
    points = visible_surfaces(scene.mesh, VIEW, (1,), 60, 80)
    lit, whole = (render(each, 60, 80).intensity.ravel()[points.pixels] for each in (scene, free))
    assert whole.min() > 0
    return lit.astype(np.float64) / whole, points


@given(vectors(numbers(-1, 1)), directions, numbers(0.05, 2))
def test_a_soft_half_space_on_a_wall_is_the_closed_form(
    point: Vector, direction: Vector, width: float
) -> None:
    light = Light("light", (0.3, -2.0, 0.2), half_spaces=(HalfSpace("left", point, direction, width),))
    left, points = ratio(light)
    distance = (points.world_points - point) @ direction / np.linalg.norm(direction)
    assert left == pytest.approx([soft(each, width) for each in distance.tolist()], abs=1e-4)


@given(numbers(-1, 0.5), numbers(0.1, 1.5), numbers(0.05, 2), st.sampled_from("xz"))
def test_a_soft_flap_goes_from_nothing_at_its_ends_to_all_of_it_inside(
    least: float, extent: float, width: float, axis: str
) -> None:
    flap = Flap(least, least + extent, edge_width=width)
    left, points = ratio(Light("light", (0.3, -2.0, 0.2), flaps=Flaps(**{axis: flap})))
    coordinates = points.world_points[:, "xyz".index(axis)].tolist()
    expected = [soft(each - least, width) * soft(least + extent - each, width) for each in coordinates]
    assert left == pytest.approx(expected, abs=1e-4)


def test_a_soft_edge_is_smooth_at_both_ends_and_grows_between_them() -> None:
    width, step = 0.5, 1e-3
    light = Light("light", (0, -1, 0), half_spaces=(HalfSpace("left", (0, 0, 0), (1, 0, 0), width),))
    at = np.arange(-0.2, 0.8, step)
    rows = np.array([wall_points().camera_point((x, 0.0, 0.0)) for x in at.tolist()], np.float32).T
    control = SoftSides.of(light, wall_points())
    assert control is not None
    left = control.factor(LitPoints(None, lambda: rows, lambda: rows), np.empty(len(at), np.float32))
    slope = np.diff(left.astype(np.float64)) / step
    assert left[0] == 0
    assert left[-1] == 1
    assert slope.min() > -1e-3
    # Its slope is largest in the middle, and changes by no more than its second derivative, 6 / width^2.
    assert slope.max() == pytest.approx(1.5 / width, rel=1e-3)
    assert at[np.argmax(slope)] == pytest.approx(width / 2, abs=0.02)
    assert np.abs(np.diff(slope)).max() <= 6 / width**2 * step + 2e-3
    for end in (0.0, width):
        assert abs(slope[np.argmin(np.abs(at - end))]) < 0.05


def test_several_soft_edges_leave_the_product_of_what_each_leaves() -> None:
    planes = (
        HalfSpace("a", (-0.3, 0, 0), (1, 0, 0.4), 0.7),
        HalfSpace("b", (0.4, 0, 0), (-1, 0, 0.2), 0.9),
    )
    flaps = Flaps(z=Flap(-0.6, 0.7, edge_width=0.5))
    light, points = Light("light", (0, -1, 0)), wall_points()
    each: list[Light] = [light.replace(half_spaces=(plane,)) for plane in planes]
    expected = np.prod([left_at(one, points) for one in (*each, light.replace(flaps=flaps))], axis=0)
    assert left_at(light.replace(half_spaces=planes, flaps=flaps), points) == pytest.approx(expected)
    assert np.ptp(expected) > 0


def test_edges_that_are_sharp_or_off_or_at_infinity_are_no_soft_ones() -> None:
    plane = HalfSpace("left", (0, 0, 0), (1, 0, 0))
    for light in (
        Light("light", (0, -1, 0), flaps=Flaps(x=Flap(0, 1)), half_spaces=(plane,)),
        Light(
            "light", (0, -1, 0), flaps=Flaps(x=Flap(0, 1, on=False, edge_width=1.0), y=Flap(edge_width=1.0))
        ),
        Light("light", (0, -1, 0), half_spaces=(plane.replace(edge_width=0.5, on=False),)),
    ):
        assert SoftSides.of(light, wall_points()) is None
