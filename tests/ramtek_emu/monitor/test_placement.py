from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.monitor.placement import placement
from tests.ramtek_emu.strategies import quick


@quick
@given(st.integers(1, 700), st.integers(1, 500), st.integers(1, 4000), st.integers(1, 3000))
def test_the_field_is_placed_at_the_largest_whole_multiple(w: int, h: int, width: int, height: int) -> None:
    left, top, across, down = placement((w, h), (width, height))
    multiple = across // w
    assert (across, down) == (multiple * w, multiple * h)
    assert (multiple + 1) * w > width or (multiple + 1) * h > height
    assert multiple == 1 or (across <= width and down <= height)
    assert abs(2 * left + across - width) <= 1
    assert abs(2 * top + down - height) <= 1


def test_a_fitted_field_fills_one_side() -> None:
    assert placement((640, 480), (1000, 1000), fit=True) == (0, 125, 1000, 750)
