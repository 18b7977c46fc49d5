from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300
from ramtek_emu.inspection.watching import watched
from ramtek_emu.memory.frame_buffer import WriteEnable
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Window
from tests.ramtek_emu.strategies import SMALL, masks, scan_codes, windows


@given(st.data(), windows(), scan_codes, masks, windows())
def test_a_scan_touches_the_words_that_it_writes(
    data: st.DataObject, window: Window, code: int, mask: int, enabled: Window
) -> None:
    along = data.draw(st.integers(1, 40))
    dots = data.draw(st.none() | st.lists(st.booleans(), min_size=along, max_size=along))
    watch = data.draw(windows().map(lambda window: window.intersection(Window(0, 0, 12, 8))))
    if watch.is_empty:
        watch = Window(0, 0, 12, 8)
    written = []
    touched = np.zeros((9, 13), np.bool_)
    # A word that becomes 0 whether it was 0 or all ones before is written.
    for before in (0, 0x3FF):
        frame_buffer = watched(Ramtek9300(SMALL))
        frame_buffer.fill(frame_buffer.window, before)
        touched = frame_buffer.watch(watch)
        frame_buffer.write_scan(
            window,
            SCAN_ORDERS[code],
            SCAN_ORDERS[code].corner(window),
            np.zeros(along, np.uint16),
            WriteEnable(mask, enabled),
            None if dots is None else np.array(dots),
        )
        written.append(frame_buffer.words.copy())
    differs_less = (written[0] ^ written[1]) != 0x3FF
    assert (touched == differs_less[watch.top : watch.bottom + 1, watch.left : watch.right + 1]).all()
