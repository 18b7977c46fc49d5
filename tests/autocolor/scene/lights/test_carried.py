from __future__ import annotations

import pytest
from hypothesis import given

from autocolor import HalfSpace, Light
from autocolor.scene.lights.carried import set_down, taken_up
from tests.autocolor.strategies import Vector, directions, vectors

LEFT = HalfSpace("left", (0.5, 2.0, 0.25), (1.0, 0.0, 0.0), edge_width=0.1, carried=True)


def test_what_a_light_carries_is_told_to_its_right_along_it_and_up() -> None:
    light = Light("light", (1.0, 2.0, 3.0), direction=(1.0, 0.0, 0.0))
    placed = set_down(LEFT, light)
    assert placed.point == pytest.approx((3.0, 1.5, 3.25))
    assert placed.direction == pytest.approx((0.0, -1.0, 0.0))
    assert (placed.carried, placed.edge_width, placed.on) == (False, 0.1, True)


def test_a_point_source_carries_along_the_axes_of_the_world() -> None:
    placed = set_down(LEFT, Light("light", (1.0, 2.0, 3.0)))
    assert placed.point == (1.5, 4.0, 3.25)
    assert placed.direction == (1.0, 0.0, 0.0)


@given(vectors(), directions, vectors(), directions)
def test_what_is_taken_up_and_set_down_again_is_where_it_was(
    position: Vector, toward: Vector, point: Vector, direction: Vector
) -> None:
    light = Light("light", position, direction=toward)
    there = HalfSpace("left", point, direction)
    carried = taken_up(there, light)
    assert carried.carried
    back = set_down(carried, light)
    assert back.point == pytest.approx(point, abs=1e-12)
    assert back.direction == pytest.approx(direction, abs=1e-12)
    assert not back.carried


def test_what_is_carried_already_or_not_stays_as_it_is() -> None:
    light = Light("light", (1.0, 2.0, 3.0), direction=(1.0, 0.0, 0.0))
    placed = set_down(LEFT, light)
    assert set_down(placed, light) is placed
    assert taken_up(LEFT, light) is LEFT
