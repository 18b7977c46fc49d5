from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.screens.mapping.curve_panel import (
    ACROSS,
    CURVE,
    MOST_COUNTED,
    PANEL,
    Curve,
    fractions_of,
    panel_items,
    place_of,
    shares_of,
)
from autocolor.screens.mapping.curve_points import STRAIGHT
from autocolor.widgets.colors import YELLOW
from autocolor.widgets.menu import WORK
from ramtek_emu import Ramtek9300


@given(st.floats(0, 1), st.floats(0, 1))
def test_a_place_is_that_of_its_fractions(x: float, y: float) -> None:
    element, line = place_of(x, y)
    assert CURVE.has(element, line)
    assert fractions_of(element, line) == pytest.approx((x, y), abs=0.003)


def test_places_beyond_the_curve_have_its_ends() -> None:
    assert fractions_of(0, 479) == (0, 0)
    assert fractions_of(639, 0) == (1, 1)


def drawn(curve: Curve) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
    display = Ramtek9300()
    for item in panel_items(curve):
        assert PANEL.covers(item.area)
        display.send(np.frombuffer(item.stream, np.uint16))
    return display.words


def test_the_panel_stays_within_its_area_however_long_the_name() -> None:
    zeros = np.zeros_like(ACROSS)
    words = drawn(Curve("fender of the left front door", ACROSS, zeros, STRAIGHT, 0)).copy()
    words[PANEL.top : PANEL.bottom + 1, PANEL.left : PANEL.right + 1] = 0
    assert not words.any()
    assert WORK.covers(PANEL)


def test_the_curve_goes_through_its_points_and_the_touched_one_is_yellow() -> None:
    ys = np.interp(ACROSS, *np.transpose(STRAIGHT)).astype(np.float32)
    words = drawn(Curve("low", ys, np.zeros_like(ACROSS), STRAIGHT, 2))
    for number, (x, y) in enumerate(STRAIGHT[1:-1], 1):
        element, line = place_of(x, y)
        square = words[line - 2 : line + 3, element - 2 : element + 3]
        assert (square == YELLOW).all() == (number == 2)
    element, line = place_of(0.4, 0.4)
    assert (words[line - 1 : line + 2, element] == YELLOW).any()


def test_shares_tell_how_often_intensities_are_seen() -> None:
    values = np.repeat(np.array([0.0, 0.5, 1.0], np.float32), [100, 25, 4])
    shares = shares_of(values, 0.0, 1.0)
    assert shares.shape == ACROSS.shape
    assert (shares[0], shares[len(shares) // 2], shares[-1]) == pytest.approx((1, 0.5, 0.2))
    assert np.count_nonzero(shares) == 3


def test_shares_of_a_range_without_extent_and_of_many_intensities_are_finite() -> None:
    assert shares_of(np.full(3 * MOST_COUNTED, 0.5, np.float32), 0.5, 0.5).max() == 1
    assert not shares_of(np.zeros(0, np.float32), 0.0, 1.0).any()
