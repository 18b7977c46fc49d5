from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from autocolor.checks import Color
from autocolor.mapping.tints import white_of, with_white

COMPONENTS = st.integers(0, 255)
COLORS = st.tuples(COMPONENTS, COMPONENTS, COMPONENTS)


@given(color=COLORS, white=COMPONENTS)
def test_the_same_amount_is_added_to_each_component_until_it_reaches_an_end(color: Color, white: int) -> None:
    found = with_white(color, white)
    added = {after - before for before, after in zip(color, found, strict=True) if 0 < after < 255}
    assert len(added) <= 1
    for amount in added:
        assert found == tuple(np.clip(np.add(color, amount), 0, 255))


@given(color=COLORS, white=COMPONENTS)
def test_the_bar_stands_where_it_was_put(color: Color, white: int) -> None:
    assert white_of(with_white(color, white)) == white


@given(color=COLORS)
def test_the_white_that_a_color_has_changes_it_by_no_more_than_one(color: Color) -> None:
    assert np.abs(np.subtract(with_white(color, white_of(color)), color)).max() <= 1


@given(color=COLORS)
def test_the_ends_are_black_and_white_alone(color: Color) -> None:
    assert with_white(color, 0) == (0, 0, 0)
    assert with_white(color, 255) == (255, 255, 255)
    assert (white_of(color) == 0) == (max(color) <= 1 and sum(color) <= 1)


def test_a_full_red_has_tints_and_shades() -> None:
    assert with_white((255, 0, 0), 170) == (255, 127, 127)
    assert with_white((255, 0, 0), 50) == (150, 0, 0)
