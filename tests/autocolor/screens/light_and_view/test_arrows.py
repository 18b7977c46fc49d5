from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.screens.light_and_view.arrows import HEAD, arrow

places = st.tuples(st.floats(-300, 300), st.floats(-300, 300))


def test_an_arrow_that_points_at_the_viewer_has_no_head() -> None:
    assert arrow((5, 5), (5, 5)).tolist() == [[5, 5, 5, 5]]
    assert len(arrow((5, 5), (6, 6))) == 1


def test_the_head_of_a_short_arrow_is_half_of_it() -> None:
    assert arrow((0, 0), (0, 8))[1, 1] == pytest.approx(4)


@given(places, places)
def test_a_head_is_symmetrical_and_ends_where_the_shaft_does(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    strokes = arrow(start, end)
    assert strokes[0].tolist() == [*start, *end]
    if len(strokes) == 1:
        return
    assert strokes[1, 2:].tolist() == strokes[2, :2].tolist() == list(end)
    one, other = strokes[1, :2], strokes[2, 2:]
    assert math.dist(one, end) == pytest.approx(math.dist(other, end))
    assert math.dist(one, start) == pytest.approx(math.dist(other, start))
    shaft = math.dist(start, end)
    assert math.dist((one + other) / 2, end) == pytest.approx(min(HEAD, shaft / 2))
    assert np.dot(one - end, np.array(start) - end) > 0
