from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Floats
from autocolor.widgets.areas import Area
from autocolor.widgets.strokes import between, clipped, drawn, joined, together

AREA = Area(10, 20, 40, 40)

places = st.tuples(st.floats(-100, 100), st.floats(-100, 100))


def stroke(*numbers: float) -> Floats:
    return np.array([numbers], np.float64)


def test_a_stroke_within_the_area_stays_as_it_is() -> None:
    inside = stroke(10, 20, 40.0, 33.3)
    assert clipped(inside, AREA).tolist() == inside.tolist()


def test_a_stroke_across_the_area_ends_at_its_borders() -> None:
    assert clipped(stroke(0, 30, 100, 30), AREA).tolist() == [[10, 30, 40, 30]]
    assert clipped(stroke(15, 90, 15, -90), AREA).tolist() == [[15, 40, 15, 20]]
    assert clipped(stroke(0, 20, 30, 50), AREA) == pytest.approx(stroke(10, 30, 20, 40))


def test_a_stroke_beside_the_area_is_left_out() -> None:
    assert len(clipped(stroke(0, 19, 100, 19), AREA)) == 0
    assert len(clipped(stroke(41, 0, 41, 100), AREA)) == 0
    # Between the borders of either axis at some time, but never of both.
    assert len(clipped(stroke(0, 25, 15, 0), AREA)) == 0


def test_a_point_is_kept_where_it_is_in_the_area() -> None:
    assert clipped(stroke(12, 22, 12, 22), AREA).tolist() == [[12, 22, 12, 22]]
    assert len(clipped(stroke(9, 22, 9, 22), AREA)) == 0


def test_nothing_is_clipped_to_nothing() -> None:
    assert clipped(np.empty((0, 4)), AREA).shape == (0, 4)


@given(places, places)
def test_what_is_left_of_a_stroke_is_all_of_it_that_is_in_the_area(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    found = clipped(between(np.array([start]), np.array([end])), AREA)
    along = np.linspace(0, 1, 201)[:, None]
    points = np.array(start) + along * (np.array(end) - np.array(start))
    inside = [point for point in points.tolist() if AREA.has(*point)]
    if not len(found):
        assert not inside
        return
    (kept,) = found.tolist()
    first, last = kept[:2], kept[2:]
    # Both ends are in the area and on the stroke, and each of its points in the area is between them.
    for place in (first, last):
        assert AREA.has(*place)
        whole = math.dist(start, place) + math.dist(place, end)
        assert whole == pytest.approx(math.dist(start, end), abs=1e-6)
    for point in inside:
        around = math.dist(first, point) + math.dist(point, last)
        assert around == pytest.approx(math.dist(first, last), abs=1e-6)


def test_strokes_of_any_size_end_within_the_area() -> None:
    rng = np.random.default_rng(0)
    strokes = rng.uniform(-1, 1, (2000, 4)) * 10.0 ** rng.uniform(-30, 60, (2000, 1))
    strokes = np.concatenate([strokes, strokes + np.array([20, 25, 20, 25]), [(12, 22, 12, 22 + 1e-14)]])
    strokes = np.concatenate([strokes, [(0, 22, 1e-320, 22), (12, 0, 12, 1e-320)]])
    with np.errstate(all="raise", under="ignore"):
        found = clipped(strokes, AREA)
    assert 0 < len(found) < len(strokes)
    assert (found >= np.tile([AREA.left, AREA.top], 2)).all()
    assert (found <= np.tile([AREA.right, AREA.bottom], 2)).all()


def test_a_polyline_is_joined_by_one_stroke_less_than_it_has_positions() -> None:
    assert joined([(1, 2), (3, 4), (5, 6)]).tolist() == [[1, 2, 3, 4], [3, 4, 5, 6]]
    assert joined([(1, 2)]).shape == (0, 4)
    assert together([joined([(0, 0), (1, 1)]), joined([])]).tolist() == [[0, 0, 1, 1]]
    assert together([]).shape == (0, 4)


def test_drawn_strokes_go_from_pixel_to_pixel_and_none_twice() -> None:
    strokes = np.array([(0.4, 0.5, 9.6, 0.4), (10.2, -0.5, 0.49, 1.0), (10, 0, 0, 1), (3, 3, 3.2, 3.1)])
    assert drawn(strokes).tolist() == [[10, 0, 0, 1]]
    strokes = np.array([(5.0, 5, 3, 5), (3, 5, 5, 5), (3, 5, 6, 5)])
    assert drawn(strokes).tolist() == [[3, 5, 5, 5], [3, 5, 6, 5]]


def test_a_mesh_smaller_than_a_pixel_is_a_point() -> None:
    assert drawn(np.array([(4.1, 4.1, 4.2, 4.2), (4.2, 4.2, 4.1, 4.1)])).tolist() == [[4, 4, 4, 4]]
    assert drawn(np.empty((0, 4))).shape == (0, 4)


def test_of_too_many_strokes_the_longest_are_drawn() -> None:
    strokes = np.array([(0, line, line + 1, line) for line in range(100)], np.float64)
    assert drawn(strokes, most=10).tolist() == strokes[90:].tolist()
