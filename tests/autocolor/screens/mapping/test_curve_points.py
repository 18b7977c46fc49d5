from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.curves import CurvePoints
from autocolor.screens.mapping.curve_points import LEAST_APART, STRAIGHT, added, moved, removed

FRACTIONS = st.floats(0, 1)


def is_a_curve(points: CurvePoints) -> bool:
    xs, ys = zip(*points, strict=True)
    return (
        xs[0] == 0
        and xs[-1] == 1
        and all(a < b for a, b in pairwise(xs))
        and all(a <= b for a, b in pairwise(ys))
        and min(ys) >= 0
        and max(ys) <= 1
    )


@given(
    st.lists(st.tuples(st.sampled_from(["move", "add", "remove"]), st.integers(0, 30), FRACTIONS, FRACTIONS))
)
def test_whatever_is_done_the_curve_rises_from_end_to_end(acts: list[tuple[str, int, float, float]]) -> None:
    points = STRAIGHT
    for act, number, x, y in acts:
        if act == "move":
            points = moved(points, number % len(points), x, y)
        elif act == "add":
            points, number = added(points, x, y)
            assert abs(points[number][0] - x) <= LEAST_APART
        else:
            points = removed(points, number % len(points))
        assert is_a_curve(points)


def test_a_point_goes_where_it_is_put_between_its_neighbors() -> None:
    assert moved(STRAIGHT, 1, 0.3, 0.4)[1] == (0.3, 0.4)
    assert moved(STRAIGHT, 1, 0.9, 0.9)[1] == (0.49, 0.5)
    assert moved(STRAIGHT, 2, 0.0, 0.0)[2] == (0.26, 0.25)


def test_the_ends_move_up_and_down_alone() -> None:
    assert moved(STRAIGHT, 0, 0.5, 0.2)[0] == (0, 0.2)
    assert moved(STRAIGHT, 4, 0.5, 0.8)[4] == (1, 0.8)


def test_a_point_between_close_neighbors_moves_up_and_down_alone() -> None:
    close = ((0.0, 0.0), (0.5, 0.2), (0.505, 0.4), (0.51, 0.6), (1.0, 1.0))
    assert moved(close, 2, 0.9, 0.5)[2] == (0.505, 0.5)


def test_a_new_point_has_a_level_between_its_neighbors() -> None:
    points, number = added(STRAIGHT, 0.3, 0.9)
    assert (points[number], number, len(points)) == ((0.3, 0.5), 2, 6)


def test_a_point_too_close_to_another_is_that_one() -> None:
    assert added(STRAIGHT, 0.252, 0.9) == (STRAIGHT, 1)


def test_ends_are_not_removed() -> None:
    assert removed(STRAIGHT, 0) == removed(STRAIGHT, 4) == STRAIGHT
    assert removed(STRAIGHT, 2) == (*STRAIGHT[:2], *STRAIGHT[3:])
