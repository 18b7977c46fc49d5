from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu import GMR_9300, NCAR_9460, PRINCETON_9300, Ramtek9300, instructions
from ramtek_emu.memory.cursors import cross
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu.strategies import sent_words


def read(display: Ramtek9300, *words: int) -> list[int]:
    """What the display answers to these words."""
    display.send(sent_words(words))
    answer: list[int] = display.receive(display.processor.waiting).tolist()
    return answer


def colored(display: Ramtek9300) -> Ramtek9300:
    """The display with a dark picture."""
    entries = display.configuration.largest_word + 1
    display.send(instructions.load_entries(0, np.full((entries, 3), 40)))
    display.send(instructions.park_table())
    return display


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


def test_track_stands_and_enter_is_told_once() -> None:
    display = Ramtek9300()
    display.joystick.move_to(320, 200)
    display.joystick.track = True
    display.joystick.press_enter()
    assert display.status == Status.READY | Status.CURSOR
    assert read(display, 0x1700) == [320, 200 | 0x3000]
    assert read(display, 0x1700) == [320, 200 | 0x1000]
    # The other cursor tells of it as well, each on its own.
    assert read(display, 0x1701) == [0, 0x3000]
    display.joystick.track = False
    assert read(display, 0x1701) == [0, 0]
    assert read(display, 0x2500) == [Status.CURSOR]
    assert display.status == Status.READY


def test_reset_forgets_an_enter_that_nobody_read_and_leaves_the_cursors() -> None:
    display = Ramtek9300()
    display.send(sent_words([0x1600, 5, 0x406]))
    display.joystick.press_enter()
    display.send(instructions.reset())
    assert display.status == Status.READY
    assert read(display, 0x1700) == [5, 0x406]


def test_the_joystick_stays_on_the_screen_and_moves_what_it_is_connected_to() -> None:
    display = Ramtek9300()
    display.joystick.move_to(10_000, -5)
    assert display.joystick.position == (639, 0)
    display.joystick.move_by(-9, 7)
    assert read(display, 0x1700, 0x1701) == [630, 7, 0, 0]
    display.send(sent_words([0x3300, 0x0002]))
    display.joystick.move_to(5, 6)
    assert read(display, 0x1700, 0x1701) == [630, 7, 5, 6]
    display.send(sent_words([0x3300, 0x0000]))
    display.joystick.move_to(50, 60)
    assert display.joystick.position == (0, 0)
    assert read(display, 0x1700, 0x1701) == [630, 7, 5, 6]


def test_a_cursor_is_drawn_on_the_field_and_not_in_the_memory() -> None:
    display = colored(Ramtek9300())
    plain = display.field()
    stamp = display.scan_out.stamp
    display.send(sent_words([0x1600, 300, 0x400 | 200]))
    assert display.scan_out.stamp != stamp
    assert not display.words.any()
    field = display.field()
    changed = (field != plain).any(axis=2)
    assert (changed[185:217, 285:317] == cross()).all()
    assert np.count_nonzero(changed) == np.count_nonzero(cross())
    assert (field[changed] == 255).all()
    display.send(sent_words([0x1600, 300, 200]))
    assert (display.field() == plain).all()


def test_a_cursor_is_dark_on_a_light_picture_and_clipped_at_the_edges() -> None:
    display = Ramtek9300()
    display.send(instructions.load_entries(0, [[250, 250, 250]]))
    for element, line in ((0, 0), (639, 479), (1023, 1023), (646, 100)):
        display.send(sent_words([0x1600, element, 0x400 | line]))
        field = display.field()
        assert set(np.unique(field)) <= {0, 250}
    display.send(sent_words([0x1600, 0, 0x400]))
    assert np.count_nonzero(display.field()[..., 0] == 0) == 12


def test_a_blinking_cursor_follows_the_monitor() -> None:
    display = colored(Ramtek9300())
    plain = display.field()
    display.send(sent_words([0x1600, 300, 0xC00 | 200]))
    assert (display.field() != plain).any()
    stamp = display.scan_out.stamp
    display.scan_out.blink_is_on = False
    assert (display.field() == plain).all()
    assert display.scan_out.stamp != stamp


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
    # Where the origin wraps, so does what lies under the cursor.
    display.send(sent_words([0x2700, 0x0802, 0x0020, 1270, 1020, 0x1600, 80, 0x400 | 20]))
    assert read(display, 0x2E00) == [(1270 + 20) % 1280, 0x400 | (1020 + 10) % 1024]


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300])
def test_cursors_that_are_not_there_answer_and_are_flagged(configuration: object) -> None:
    display = Ramtek9300(configuration)  # type: ignore[arg-type]
    display.send(sent_words([0x1607, 5, 6]))
    assert read(display, 0x1709) == [0, 0]
    assert Status.ILLEGAL in display.status


def test_the_reset_switch_hides_the_cursors_and_forgets_what_was_unfinished() -> None:
    display = Ramtek9300()
    display.send(sent_words([0x1600, 5, 0x406, 0x1700, 0x0802, 2, 9, 0x0A01, 0xFFFF, 1, 2, 3]))
    assert display.decoder.held_words
    display.reset()
    assert not display.cursors[0].is_visible
    assert not display.decoder.held_words
    assert not display.processor.waiting
    assert display.processor.parameters.foreground == 1023
    display.send(instructions.write_image([[7]]))
    assert display.words[0, 0] == 7
