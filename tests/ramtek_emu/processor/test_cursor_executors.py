from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu import GMR_9300, NCAR_9460, PRINCETON_9300, Ramtek9300
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu.displays import colored, read
from tests.ramtek_emu.strategies import sent_words


def test_recorded_cursors_are_read_back_as_they_were_written() -> None:
    display = Ramtek9300(PRINCETON_9300)
    # Cursor 0 at (100, 100), visible and blinking; cursor 1 visible at (100, 64).
    display.send(sent_words([0x1600, 0x0064, 0x0C64, 0x1601, 0x0064, 0x0440]))
    assert read(display, 0x1700) == [100, 0x0C64]
    assert read(display, 0x1701) == [100, 0x0440]
    assert display.cursors[0].is_visible
    assert display.cursors[0].blinks
    assert not display.cursors[1].blinks
    assert display.status == Status.READY


def test_a_loaded_shape_has_its_left_dots_in_the_high_bits_of_the_low_byte() -> None:
    display = colored(Ramtek9300(NCAR_9460))
    plain = display.field()
    # The first row: its first, second and last dot; the others empty.
    display.send(sent_words([0x3001, 0x0080, 0x00C0, 0x0100, *[0] * 62]))
    display.send(sent_words([0x2D01, 1000, 500, 0x0600]))
    lines, elements = np.nonzero((display.field() != plain).any(axis=2))
    assert lines.tolist() == [485] * 3
    assert elements.tolist() == [985, 986, 1016]
    assert read(display, 0x2F01) == [1000, 500, 0x0600]


def test_pixel_coordinates_go_through_origin_zoom_and_video_origin() -> None:
    display = Ramtek9300(NCAR_9460)
    display.send(sent_words([0x2C00, 1200, 0x400 | 900]))
    assert read(display, 0x2E00) == [1200, 0x400 | 900]
    display.send(sent_words([0x0802, 0x0020, 100, 50, 0x2600, 0x0103, 0x2C00, 110, 0x400 | 60]))
    assert (display.cursors[0].element, display.cursors[0].line) == (40, 20)
    assert read(display, 0x2E00) == [110, 0x400 | 60]
    display.send(sent_words([0x2701, 0x2C00, 110, 0x400 | 60]))
    assert (display.cursors[0].element, display.cursors[0].line) == (40, 1003)
    assert read(display, 0x2E00) == [110, 0x400 | 60]
    # If the origin wraps, the pixel under the cursor wraps too.
    display.send(sent_words([0x2700, 0x0802, 0x0020, 1270, 1020, 0x1600, 80, 0x400 | 20]))
    assert read(display, 0x2E00) == [(1270 + 20) % 1280, 0x400 | (1020 + 10) % 1024]


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300])
def test_cursors_that_are_not_there_answer_and_are_flagged(configuration: object) -> None:
    display = Ramtek9300(configuration)  # type: ignore[arg-type]
    display.send(sent_words([0x1607, 5, 6]))
    assert read(display, 0x1709) == [0, 0]
    assert Status.ILLEGAL in display.status
