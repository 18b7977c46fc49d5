from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given

from autocolor import HalfSpace, InputError
from tests.autocolor.reference import cross, dot, minus
from tests.autocolor.strategies import Vector, directions, numbers, vectors


@given(vectors(), vectors(), vectors())
def test_the_plane_goes_through_all_three_points(a: Vector, b: Vector, c: Vector) -> None:
    assume(any(cross(minus(b, a), minus(c, a))))
    half_space = HalfSpace.through("left", a, b, c)
    assert half_space.point == a
    assert math.hypot(*half_space.direction) == pytest.approx(1)
    for point in (b, c):
        assert dot(minus(point, a), half_space.direction) == pytest.approx(0, abs=1e-12)


@given(vectors(), vectors(), vectors(), directions)
def test_from_the_lit_side_the_points_turn_counterclockwise(
    a: Vector, b: Vector, c: Vector, eye: Vector
) -> None:
    # As an eye sees them: to its left of the way from a to b is c.
    turn = dot(cross(minus(b, a), minus(c, a)), minus(eye, a))
    assume(abs(turn) > 1e-6)
    is_lit = dot(minus(eye, a), HalfSpace.through("left", a, b, c).direction) > 0
    assert is_lit == (turn > 0)
    assert HalfSpace.through("left", a, c, b).direction == pytest.approx(
        [-each for each in HalfSpace.through("left", a, b, c).direction]
    )


@pytest.mark.parametrize("size", [1e-150, 1e-20, 1.0, 1e20, 1e36])
def test_the_size_of_the_triangle_does_not_matter(size: float) -> None:
    points = [(0.0, 0.0, 0.0), (size, 0.0, 0.0), (0.0, size, size)]
    direction = HalfSpace.through("left", *points).direction
    assert direction == pytest.approx((0, -math.sqrt(0.5), math.sqrt(0.5)))


@given(vectors(), directions, numbers(-3, 3))
def test_three_points_in_one_line_are_refused(a: Vector, toward: Vector, far: float) -> None:
    b, c = (tuple((np.array(a) + step * np.array(toward)).tolist()) for step in (1.0, far))
    with pytest.raises(InputError, match=r"^half-space 'left': its three points must not be in one line, "):
        HalfSpace.through("left", a, b, c)


@pytest.mark.parametrize("wrong", [(1, 2), "x", (math.nan, 0, 0), None])
def test_a_point_that_is_none_is_refused_by_its_letter(wrong: Any) -> None:
    with pytest.raises(InputError, match=r"^half-space 'left': b must be three finite numbers"):
        HalfSpace.through("left", (0, 0, 0), wrong, (0, 1, 0))


def test_further_fields_are_given_with_the_points() -> None:
    half_space = HalfSpace.through("left", (0, 0, 1), (1, 0, 1), (0, 1, 1), edge_width=0.2, on=False)
    assert half_space == HalfSpace("left", (0, 0, 1), (0, 0, 1), edge_width=0.2, on=False)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"direction": (0, 0, 0)}, "direction must not be zero, not (0, 0, 0); give it a length"),
        ({"edge_width": -1}, "edge_width must be a finite number of at least 0, not -1"),
        ({"carried": 2}, "carried must be true or false, not 2"),
    ],
)
def test_an_invalid_half_space_is_refused(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as refusal:
        HalfSpace("left", **{"point": (0, 0, 0), "direction": (1, 0, 0), **fields})
    assert str(refusal.value).startswith(f"half-space 'left': {message}")
