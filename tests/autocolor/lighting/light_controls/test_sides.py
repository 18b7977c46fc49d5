from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Flap, Flaps, Light, View
from autocolor.lighting.light_controls.flap_sides import FlapSides, flap_sides
from autocolor.lighting.light_controls.sides import FARTHEST_PLANE, is_inside, side_of
from autocolor.visibility.visible_points import POINT
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.lighting.light_controls.lit_points import wall_points
from tests.autocolor.meshes import wall
from tests.autocolor.reference import dot, unit
from tests.autocolor.strategies import Vector, directions, numbers, views

EPSILON = float(np.finfo(np.float32).eps)


@given(directions, numbers(-2, 2))
def test_the_row_of_a_side_gives_the_distance_from_its_plane(direction: Vector, least: float) -> None:
    points = wall_points()
    x, y, z = unit(direction)
    side = side_of(points, (x, y, z), least, 0.5)
    distance = (side.row[:3] @ points.rows[POINT] + side.row[3]) * points.unit
    expected = [dot((x, y, z), point) - least for point in points.world_points.tolist()]
    assert distance == pytest.approx(expected, abs=1e-6)
    assert side.edge_width * points.unit == 0.5


def test_a_sharp_side_has_room_for_the_rounding_of_points_and_a_soft_one_has_none() -> None:
    points = wall_points()
    sharp, soft = (side_of(points, (0.0, 1.0, 0.0), 0.0, width) for width in (0.0, 0.1))
    assert sharp.row[3] - soft.row[3] == pytest.approx(4 * EPSILON * points.radius)
    assert is_inside(sharp, points.rows).all()


@pytest.mark.parametrize(("least", "inside"), [(1e300, False), (-1e300, True), (1e36, False)])
def test_a_plane_may_be_farther_than_a_single_can_hold(least: float, inside: bool) -> None:
    points = wall_points()
    side = side_of(points, (1.0, 0.0, 0.0), least, 0.0)
    assert abs(side.row[3]) == pytest.approx(FARTHEST_PLANE)
    assert is_inside(side, points.rows).tolist() == [inside] * len(points.pixels)


@given(views(), numbers(-1, 1), numbers(0, 1))
def test_sharp_flaps_have_the_sides_they_always_had(view: View, least: float, extent: float) -> None:
    points = visible_surfaces(wall(), view, (1,), 12, 12)
    light = Light("light", (0, -1, 0), flaps=Flaps(*[Flap(least, least + extent)] * 3))
    rows = []
    for axis in range(3):
        coordinate = points.world_coordinate(axis)
        for sign, limit in ((1.0, least), (-1.0, least + extent)):
            in_units = sign * limit / points.unit - 4 * EPSILON * points.radius
            rows.append(sign * coordinate - np.array([0, 0, 0, in_units]))
    control = FlapSides.of(light, points)
    assert control is not None
    assert np.array_equal(control.sides, np.array(rows, np.float32))
    assert len(flap_sides(light, points)) == 6
