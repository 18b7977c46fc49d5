from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import View
from autocolor.checks import Vector
from autocolor.testing import directions, numbers, vectors, views
from tests.autocolor.reference import ray
from tests.tables import refused


@given(vectors(), directions(), numbers(-720, 720))
def test_the_axes_are_a_rotation_with_the_view_direction_last(
    eye: Vector, direction: Vector, angle: float
) -> None:
    axes = View(eye, direction=direction, angle=angle).axes
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
    # Right, down and forward, in this order, are right-handed.
    assert np.linalg.det(axes) == pytest.approx(1)
    assert np.cross(axes[2], direction) == pytest.approx(np.zeros(3), abs=1e-12)
    assert axes[2] @ np.array(direction) > 0


@given(vectors(), directions())
def test_without_an_angle_the_horizon_is_level_and_up_is_up(eye: Vector, direction: Vector) -> None:
    right, down, _ = View(eye, direction=direction).axes
    if direction[0] or direction[1]:
        assert right[2] == pytest.approx(0, abs=1e-12)
        assert down[2] < 0
    else:
        assert down == pytest.approx((0, -1, 0))


def test_looking_down_the_top_of_the_picture_is_y() -> None:
    for direction in ((0, 0, -1), (1e-12, -1e-12, -1)):
        right, down, _ = View((0, 0, 5), direction=direction).axes
        assert right == pytest.approx((1, 0, 0), abs=1e-9)
        assert down == pytest.approx((0, -1, 0), abs=1e-9)


def test_along_y_right_is_x_and_down_is_minus_z_and_an_angle_turns_right_toward_the_top() -> None:
    for angle in (0, 30):
        turn = math.radians(angle)
        axes = View((0, 0, 0), direction=(0, 2, 0), angle=angle).axes
        right, down = (math.cos(turn), 0, math.sin(turn)), (math.sin(turn), 0, -math.cos(turn))
        assert axes == pytest.approx(np.array([right, down, (0, 1, 0)]))


def test_a_picture_narrower_than_4_to_3_shows_more_above_and_below() -> None:
    view = View((0, 0, 0), direction=(0, 1, 0), field_of_view=60)
    heights = [view.half_height(aspect) * math.sqrt(3) for aspect in (2, 4 / 3, 1, 2 / 3)]
    assert heights == pytest.approx([1, 1, 4 / 3, 2])


@given(vectors(), directions(), numbers(-180, 180))
def test_the_reference_ray_agrees_with_the_axes(eye: Vector, direction: Vector, angle: float) -> None:
    view = View(eye, direction=direction, angle=angle, field_of_view=60)
    focal = 6 / 2 / math.tan(math.radians(30))
    expected = np.array([(7 + 0.5 - 4) / focal, (1 + 0.5 - 3) / focal, 1]) @ view.axes
    assert ray(view, 6, 8, 1, 7) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("size", [1e-300, 1e-20, 1e20, 1e30])
def test_a_direction_of_any_length_will_do(size: float) -> None:
    axes = View((0, 0, 0), direction=(size, size, 0)).axes
    assert axes == pytest.approx(View((0, 0, 0), direction=(1, 1, 0)).axes)


def test_giving_a_direction_drops_the_target_and_the_other_way_round() -> None:
    view = View((0, 0, 0), target=(1, 0, 0))
    directed = view.replace(direction=(0, 1, 0))
    assert (directed.direction, directed.target) == ((0, 1, 0), None)
    assert directed.replace(target=(1, 0, 0)) == view
    assert View((1, 2, 3), target=(4, 6, 3)).axes == pytest.approx(View((1, 2, 3), direction=(3, 4, 0)).axes)


EITHER = "view: it must have either a direction or a target; give one of them"

test_a_view_that_breaks_a_rule_is_refused = refused(
    lambda fields: View((0, 0, 0), **fields),
    [
        ({}, EITHER),
        ({"direction": (1, 0, 0), "target": (1, 1, 1)}, EITHER),
        (
            {"target": (0, 0, 0)},
            "view: the target must differ from the eye, (0.0, 0.0, 0.0); move one of them",
        ),
    ],
)


@given(views(), views(), st.floats(0.01, 0.99))
def test_the_eye_turns_around_the_target_the_shortest_way(one: View, other: View, share: float) -> None:
    one, other = (view.replace(target=view.orbit_target((-1, -1, -1), (1, 1, 1))) for view in (one, other))
    assert one.target is not None
    assert other.target is not None
    between = one.between(other, share)
    assert between.target is not None
    assert between.target == pytest.approx(
        np.array(one.target) * (1 - share) + np.array(other.target) * share
    )
    polars = one.polar(one.target), other.polar(other.target), between.polar(between.target)
    start, end, middle = (np.array(polar) for polar in polars)
    if one.eye == other.eye:
        assert between.eye == one.eye
        return
    assert middle[1:] == pytest.approx((1 - share) * start[1:] + share * end[1:], abs=1e-6)
    right = (end[0] - start[0] + 180) % 360 - 180
    if abs(abs(right) - 180) > 1e-6 and abs(middle[1]) < 89.999:
        assert math.cos(math.radians(middle[0] - start[0] - share * right)) == pytest.approx(1, abs=1e-9)


def test_a_quarter_of_a_turn_stays_on_its_circle() -> None:
    one, other = View((5, 0, 3), target=(1, 0, 0)), View((1, 4, 3), target=(1, 0, 0))
    root = 4 / math.sqrt(2)
    assert one.between(other, 0.5).eye == pytest.approx((1 + root, root, 3))
    # From 170 to -170 degrees, the shortest way is through 180.
    one, other = (
        View((math.cos(math.radians(a)), math.sin(math.radians(a)), 0), target=(0, 0, 0)) for a in (170, -170)
    )
    assert one.between(other, 0.5).eye == pytest.approx((-1, 0, 0))


def test_an_eye_stays_while_its_target_moves() -> None:
    one = View((5, 0, 3), target=(1, 0, 0))
    between = one.between(one.replace(target=(1, 2, 4)), 0.5)
    assert (between.eye, between.target) == ((5, 0, 3), (1, 1, 2))


def test_a_view_from_above_descends_without_a_swing() -> None:
    # The picture's bottom is -y from above, as from the side of -y.
    above, front = View((0, 0, 5), target=(0, 0, 0)), View((0, -5, 0), target=(0, 0, 0))
    for one, other in ((above, front), (front, above)):
        right, down, _ = one.between(other, 0.5).axes
        assert right == pytest.approx((1, 0, 0))
        assert down == pytest.approx((0, -math.sqrt(0.5), -math.sqrt(0.5)))


def test_a_direction_turns_with_a_level_horizon_while_the_eye_moves_along_a_line() -> None:
    one, other = View((0, 0, 0), direction=(1, 0, 1)), View((2, 4, 0), direction=(0, 3, 3))
    between = one.between(other, 0.5)
    assert (between.eye, between.target) == ((1, 2, 0), None)
    assert between.direction == pytest.approx((0.5, 0.5, math.sqrt(0.5)))
    # A view with a target looks at it at first, and then turns away from it.
    aimed = View((0, 0, 0), target=(7, 0, 7)).between(other, 0.5)
    assert aimed.direction == pytest.approx(between.direction)


@given(views())
def test_the_point_to_orbit_is_on_the_line_of_sight(view: View) -> None:
    target = np.array(view.orbit_target((-1, -1, -1), (1, 1, 1))) - np.array(view.eye)
    _, _, depth = view.axes @ target
    assert view.axes @ target == pytest.approx((0, 0, depth), abs=1e-6 * depth)
    assert depth > 0
