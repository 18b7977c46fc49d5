from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.scan_orders import SCAN_ORDERS, Window, blocks
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import quick, scan_codes, windows


@quick
@given(windows(), scan_codes)
def test_positions_count_along_the_scan(window: Window, code: int) -> None:
    order = SCAN_ORDERS[code]
    size = window.width * window.height
    places = reference.walk(window, code, order.corner(window), size - 1)
    assert [order.point(window, position) for position in range(size)] == places
    assert [order.position(window, order.point(window, position)) for position in range(size)] == list(
        range(size)
    )


@quick
@given(windows(), scan_codes, st.integers(0, 10_000), st.integers(0, 400))
def test_blocks_take_every_word_once_and_in_order(window: Window, code: int, start: int, count: int) -> None:
    size = window.width * window.height
    done = 0
    for block in blocks(window, SCAN_ORDERS[code], start % size, count):
        assert block.first == done
        assert block.inner > 0
        assert block.outer > 0
        done += block.inner * block.outer
    assert done == count
