"""Programs that draw, read words back and draw again; and the habits of the drivers of the time."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

from ramtek_emu import GMR_9300, JPL_9460, NCAR_9460, PRINCETON_9300, Configuration, Ramtek9300
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu import reference
from tests.ramtek_emu.clients import (
    Library,
    draft,
    fill_polygon,
    mirror_image,
    pairs,
)
from tests.ramtek_emu.strategies import sent_words


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300], ids=str)
def test_a_polygon_is_filled_between_the_outlines_that_are_read_back(configuration: Configuration) -> None:
    display = Ramtek9300(configuration)
    library = Library(display)
    library.reset()
    corners = [(100, 40), (180, 90), (150, 170), (60, 150), (50, 80)]
    fill_polygon(library, corners, 9, 4)
    words = display.words
    assert set(np.unique(words)) == {0, 4, 9}
    for line in range(40, 171):
        row = words[line]
        edge = np.flatnonzero(row == 9)
        assert (row[edge[0] : edge[-1] + 1] > 0).all()
        assert not row[: edge[0]].any()
        assert not row[edge[-1] + 1 :].any()
    assert display.status == Status.READY
    assert display.processor.waiting == 0


def test_an_image_that_was_read_is_written_mirrored() -> None:
    display = Ramtek9300(PRINCETON_9300)
    library = Library(display)
    picture = np.random.default_rng(4).integers(0, 1024, (30, 50))
    library.write_image((200, 100, 249, 129), picture.reshape(-1))
    mirror_image(library, (200, 100, 249, 129), (10, 300))
    assert (display.words[300:330, 10:60] == picture[:, ::-1]).all()


def test_a_drawing_follows_the_cursor_while_track_is_on_until_enter() -> None:
    display = Ramtek9300(PRINCETON_9300)
    joystick = display.joystick

    def hand() -> Iterator[None]:
        yield
        joystick.track = True
        for step in range(5):
            joystick.move_to(100 + 20 * step, 100 + 7 * step)
            yield
        joystick.track = False
        joystick.move_to(300, 300)
        yield
        joystick.track = True
        yield
        joystick.move_by(0, 50)
        yield
        joystick.press_enter()
        yield

    user = hand()
    strokes = draft(Library(display), 6, lambda: next(user))
    assert strokes == [[(100 + 20 * step, 100 + 7 * step) for step in range(5)], [(300, 300), (300, 350)]]
    twin = np.zeros_like(display.words)
    for stroke in strokes:
        for start, end in itertools.pairwise([stroke[0], *stroke]):
            for element, line in reference.line_places(start, end):
                twin[line, element] = 6
    assert (display.words == twin).all()
    assert not display.cursors[0].is_visible


def test_a_conic_of_the_library_is_an_arc() -> None:
    display = Ramtek9300(PRINCETON_9300)
    library = Library(display)
    library.start(300, 200)
    # A quarter of a circle around (260, 200), whose -80 travels as a word with nothing above it.
    library.conic((1, 1, 0, 80, 0, 0), (260, 240))
    lines, elements = np.nonzero(display.words)
    assert np.abs(np.hypot(elements - 260, lines - 200) - 40).max() < 0.75
    assert (lines >= 200).all()
    assert (elements >= 260).all()


def plot_session(display: Ramtek9300) -> None:
    """The stream of the plot library: table, erase, colors, lines, a box, text with reverse packing."""
    table = [
        sum(part for bit, part in enumerate((0xF00, 0x0F0, 0x00F)) if index >> bit & 1)
        for index in range(512)
    ]
    for words in (
        [0x0300, 0, 1024, *table],
        [0x0300, 1023, 2, 0],
        [0x0802, 0x8000, 0, 511],
        [0x0500],
        [0x0802, 0x0002, 1],
        [0x0802, 0x8000, 10, 501],
        [0x0E01, 4, 100, 451],
        [0x0902, 0x0044, 2, 100, 331, 200, 411],
        [0x0C0B, 0x0040, 100, 451, 619, 511, 6, *pairs(b"HELLO ", low_first=True)],
    ):
        display.send(sent_words(words))


def test_the_plot_library_draws_lines_boxes_and_text() -> None:
    display = Ramtek9300(PRINCETON_9300)
    plot_session(display)
    words = display.words
    assert words[501, 10] == 1
    assert (words[331:412, 100:201] == 2).all()
    cells = np.concatenate([characters()[ord(letter)] for letter in "HELLO "], axis=1)
    # The box's color stayed the background.
    assert (words[451:460, 100:142] == np.where(cells, 1, 2)).all()
    assert display.field()[501, 10].tolist() == [255, 0, 0]
    assert display.field()[340, 110].tolist() == [0, 255, 0]
    # The box left a small window, which did not clip the vectors afterwards.
    assert display.status == Status.READY


def bytes_of(lines: NDArray[np.uint8]) -> list[int]:
    return pairs(lines.tobytes(), low_first=True)


def test_the_image_driver_writes_and_reads_lines_of_bytes() -> None:
    display = Ramtek9300(JPL_9460)
    picture = np.random.default_rng(11).integers(0, 256, (20, 100), np.uint8)
    for line in range(20):
        row = bytes_of(picture[line])
        head = [0x0A0F, 0x80C1, 0x0020, 0x00FF, 0, 0, 639, 479, 0, 50, 60 + line, 1, 100]
        display.send(sent_words([*head, *row]))
    assert (display.words[60:80, 50:150] == picture).all()
    display.send(sent_words([0x0B0F, 0x80C0, 0x0021, 0, 0, 639, 479, 0, 50, 65, 0x00FF, 1, 100]))
    assert display.receive(50).tolist() == bytes_of(picture[5])


def test_the_weather_driver_clips_draws_and_colors() -> None:
    display = Ramtek9300(NCAR_9460)
    clip = [0x080E, 0x0041, 0x0006, 0xFF, 0, 512, 639, 1023, 0, 512, 639, 1023, 0, 512]
    display.send(sent_words([0x2701, *clip, 0x4EFF]))
    display.send(sent_words([0x0802, 0x0004, 3, 0x0909, 0, *clip]))
    assert (display.words[512:, :640] == 3).all()
    assert not display.words[:512].any()
    assert not display.words[:, 640:].any()
    image = [0x0A0F, 0x00C0, 0x0020, 8, 528, 11, 531, 0, 1, 16, *bytes_of(np.arange(1, 17, dtype=np.uint8))]
    display.send(sent_words(image))
    assert display.words[528:532, 8:12].tolist() == np.arange(1, 17).reshape(4, 4).tolist()
    # Draw a line that leaves the clip window.
    display.send(sent_words([0x0E0F, 0x8002, 0x0008, 7, 600, 600, 0xFFFF, 0x1000, 4, 700, 600]))
    assert (display.words[600, 600:640] == 7).all()
    assert not display.words[600, 640:].any()
    table = [0x2901, 0x0300, 0, 1024, 0, 0, 0x0000, 0x00FF, 0xFF00, 0, 0x00FF, 0, *[0] * 504]
    display.send(sent_words([*table, 0x0300, 0, 0]))
    assert display.entries[:4].tolist() == [[0, 0, 0], [255, 0, 0], [0, 255, 0], [0, 0, 255]]
    # The video origin is at the bottom: line 528 of the memory is 528 lines up.
    assert display.field()[1023 - 528, 8].tolist() == [255, 0, 0]
    display.send(sent_words([0x2C00, 700, 0x400 | 900, 0x2E00]))
    assert display.receive(2).tolist() == [700, 0x400 | 900]


def test_sessions_do_not_depend_on_how_they_are_cut() -> None:
    class Cut(Ramtek9300):
        """A display that gets its words one at a time."""

        def send(self, words: NDArray[np.uint16]) -> None:
            for word in words:
                super().send(np.array([word], np.uint16))

    whole, cut = Ramtek9300(PRINCETON_9300), Cut(PRINCETON_9300)
    for display in (whole, cut):
        plot_session(display)
        fill_polygon(Library(display), [(100, 40), (130, 50), (120, 70)], 9, 4)
        mirror_image(Library(display), (90, 30, 140, 80), (300, 300))
    assert (whole.words == cut.words).all()
    assert (whole.entries == cut.entries).all()
    assert whole.processor.parameters == cut.processor.parameters
