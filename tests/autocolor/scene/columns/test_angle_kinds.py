from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.columns.angle_kinds import MOST_POINTS, AngleCurve, AngleCurveKind
from autocolor.scene.columns.problems import REFUSED, Problem
from tests.autocolor.strategies import angle_curves

KIND = AngleCurveKind(0.001, ((0.0, 0.04), (60.0, 0.1), (90.0, 1.0)))


def held(value: object) -> tuple[object, list[str]]:
    problems: list[Problem] = []
    return KIND.held(value, ("curve",), problems), [problem.sentence for problem in problems]


@given(angle_curves)
def test_a_curve_is_held_as_it_is_whatever_lists_it_came_in(curve: AngleCurve) -> None:
    assert held([list(point) for point in curve]) == (curve, [])
    assert held(np.array(curve)) == (curve, [])


def test_whole_numbers_become_floats() -> None:
    assert repr(held([[0, 1], [90, 0]])[0]) == "((0.0, 1.0), (90.0, 0.0))"


@pytest.mark.parametrize(
    "value",
    [
        "[[0, 1], [90, 1]]", 0.04, None, [], [[0, 1]], [[0, 1], [45, 1]], [[10, 1], [90, 1]],
        [[0, 0.0], [90, 1]], [[0, 0.0009], [90, 1]], [[0, 1], [90, 1.1]], [[0, 1], [40, -0.1], [90, 1]],
        [[0, 1], [40, 1], [40, 1], [90, 1]], [[0, 1], [50, 1], [40, 1], [90, 1]], [[0, 1, 2], [90, 1, 2]],
        [[0, 1], [float("nan"), 1], [90, 1]], [[0, True], [90, 1]], [[0, "1"], [90, 1]], {0: 1, 90: 1},
        ["ab", "cd"], [0, 90],
    ],
)  # fmt: skip
def test_what_is_no_curve_from_0_to_90_degrees_is_refused_with_an_example(value: object) -> None:
    found, (sentence,) = held(value)
    assert found is REFUSED
    assert sentence.startswith(
        "curve must be 2 to 91 points [angle, share], with angles that rise from 0 to 90 and shares from 0 to"
        " 1, the first at least 0.001, not "
    )
    assert sentence.endswith("; write them as in [[0.0, 0.04], [60.0, 0.1], [90.0, 1.0]]")


@given(st.integers(2, 200))
def test_a_curve_has_at_most_a_point_a_degree(count: int) -> None:
    points = [[angle, 0.5] for angle in np.linspace(0, 90, count)]
    assert (held(points)[0] is REFUSED) == (count > MOST_POINTS)
