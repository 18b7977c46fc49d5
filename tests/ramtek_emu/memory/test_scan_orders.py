from __future__ import annotations

from hypothesis import example, given
from hypothesis import strategies as st

from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, Window, paired_parts
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import points, scan_codes, windows


def places(window: Window) -> set[tuple[int, int]]:
    """Every pixel of a window."""
    elements, lines = range(window.left, window.right + 1), range(window.top, window.bottom + 1)
    return {(element, line) for element in elements for line in lines}


small = st.integers(-3, 6)
small_windows = st.builds(Window, small, small, small, small)


@given(small_windows, small_windows, st.builds(Point, small, small))
@example(Window(0, 0, 3, 3), Window(2, 2, 5, 5), Point(3, 3))
def test_windows_meet_where_pixels_are_in_both(one: Window, other: Window, point: Point) -> None:
    assert places(one.intersection(other)) == places(one) & places(other)
    assert one.is_empty is (not places(one))
    assert one.holds(point) is (point in places(one))
    assert (one.width * one.height) == len(places(one))
    assert places(one.moved(2, -1)) == {(element + 2, line - 1) for element, line in places(one)}


@given(windows(), scan_codes, points, st.integers(0, 400))
def test_a_run_steps_along_the_scan(window: Window, code: int, start: Point, count: int) -> None:
    order = SCAN_ORDERS[code]
    places = reference.walk(window, code, start, count)
    assert [order.after(window, start, number) for number in range(1, count + 1)] == places[1:]
    corner = order.corner(window)
    assert [order.stepped(corner, *order.steps(window, Point(*place))) for place in places] == places
    before = order.words_before(window, start)
    assert all(reference.inside(place, window) for place in places[before:] if count)
    assert not 0 < before <= count or not reference.inside(places[0], window)


@given(windows(), scan_codes, points, st.integers(1, 400))
def test_pixels_in_pairs_take_every_place_of_the_twin_in_order(
    window: Window, code: int, start: Point, count: int
) -> None:
    order = SCAN_ORDERS[code]
    parts = list(paired_parts(window, order, start, count))
    assert 1 <= len(parts) <= 2
    found = [
        order.after(part, begin, number) if number else begin
        for part, begin, size in parts
        for number in range(size)
    ]
    assert found == reference.walk(window, code, start, count, pairs=True)[:-1]
