from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu import NCAR_9460, Ramtek9300
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu.displays import sent
from tests.ramtek_emu.recorded_streams import OUTLINE
from tests.ramtek_emu.strategies import sent_words


def test_recorded_rrr_draws_its_figure_and_its_letters() -> None:
    display = Ramtek9300()
    display.send(OUTLINE)
    words = display.words
    assert set(np.unique(words)) == {0, 128, 256}
    assert (words[200, 201:350] == 256).all()
    assert (words[51:200, 200] == 256).all()
    assert (words[100, 101:200] == 128).all()
    shapes = characters()
    for letter, element, line, word in (("a", 90, 90, 256), ("c", 205, 40, 256), ("f", 240, 110, 128)):
        cell = words[line : line + 9, element : element + 7]
        assert (cell == np.where(shapes[ord(letter)], word, 0)).all()
    assert display.status == Status.READY


def test_a_circle_that_was_drawn_is_filled_from_its_center() -> None:
    display = Ramtek9300()
    # The disabled code of the weather driver: circle, then fill until the foreground.
    display.send(sent_words([0x6D0B, 0x0002, 9, 6, 300, 200, 50, 0x3A0D, 0x0001, 0xFF, 2, 0]))
    lines, elements = np.ogrid[:480, :640]
    away = np.sqrt((lines - 200) ** 2 + (elements - 300) ** 2)
    assert (display.words[away < 49.5] == 9).all()
    assert not display.words[away > 50.5].any()


def test_a_conic_comes_as_pairs_of_words_or_as_single_ones() -> None:
    pairs, singles = Ramtek9300(), Ramtek9300()
    pairs.send(sent_words([0x0F03, 0x9002, 7, 0, 1, 0, 1, 0, 0, 0, -80, 0, 0, 0, 0, 100, 100, 4, 140, 60]))
    singles.send(sent_words([0x0F03, 0x9002, 7, 1, 1, 0, -80, 0, 0, 100, 100, 4, 140, 60]))
    assert (pairs.words == singles.words).all()
    assert pairs.processor.parameters.start == (140, 60)
    assert np.count_nonzero(pairs.words) > 40
    lines, elements = np.nonzero(pairs.words)
    assert np.abs(np.hypot(elements - 140, lines - 100) - 40).max() < 0.75
    # The coefficients stay: another quarter with a number of pixels, as extended pairs.
    pairs.send(sent_words([0x0F02, 0x9000, 0, 1, 0, 1, 0, 0, -1, -80, 0, 0, 0, 5, 300, 300]))
    assert np.count_nonzero(pairs.words[250:350, 250:350]) == 5


def test_a_loaded_character_takes_the_place_of_its_code() -> None:
    display = Ramtek9300()
    rows = [0x80, 0x40, 0x20, 0x10, 0x08, 0x04, 0x02, 0x01, 0xFF, 0x00, 0xAA, 0x55]
    display.send(sent_words([0x1541] + [rows[row] << 8 | rows[row + 1] for row in range(0, 12, 2)]))
    # Cells of 8 x 12, at (20, 30).
    display.send(sent_words([0x0C03, 0x0142, 5, 20, 30, 99, 99, 8, 12, 1, 0x4100]))
    dots = np.unpackbits(np.array(rows, np.uint8)[:, np.newaxis], axis=1)
    assert (display.words[30:42, 20:28] == 5 * dots).all()
    # The standard font is the ROM; the loaded font can be attached again, and survives RSET.
    display.send(sent_words([0x4EFF, 0x0C03, 0x0140, 20, 30, 99, 99, 7, 9, 1, 0x4100]))
    assert (display.words[30:39, 20:27] == 5 * characters()[0x41]).all()
    display.send(sent_words([0x0500, 0x0C03, 0x0142, 5, 20, 30, 99, 99, 8, 12, 1, 0x4100]))
    assert (display.words[30:42, 20:28] == 5 * dots).all()
    display.send(sent_words([0x2142] + [rows[row + 1] << 8 | rows[row] for row in range(0, 12, 2)]))
    assert (display.processor.loaded_characters[0x42] == dots).all()


def test_the_recorded_polyline_of_the_weather_driver_has_gaps() -> None:
    display = Ramtek9300(NCAR_9460)
    display.send(sent_words([0x0E0F, 0x8002, 8, 7, 10, 532, 0xFF00, 0x1000, 8, 100, 532, 100, 602]))
    assert display.words[532, 10:42].tolist() == ([7] * 8 + [0] * 8) * 2
    # The pattern runs on around the corner: 90 pixels before it, 5 more eights and 10.
    assert display.words[533:541, 100].tolist() == [0] * 5 + [7] * 3


@pytest.mark.parametrize(
    ("text", "pixels"),
    [
        ("0EC3 8002 5 2 2 8 3 0 FFFF 2", [(2, 2), (3, 2), (4, 2), (5, 2), (4, 3), (4, 4)]),
        ("3503 0002 5 10 1 1 3 1 6 4 6 4", [(1, 1), (2, 1), (3, 1), (6, 4)]),
        ("3803 0002 5 8 2 3 4 5", [(2, 3), (4, 5)]),
        ("6D03 0002 5 C 5 5 1 3 6 0", [(5, 4), (4, 5), (6, 5), (5, 6), (3, 6)]),
    ],
)
def test_lines_points_and_circles_leave_the_operating_point_at_the_last(
    text: str, pixels: list[tuple[int, int]]
) -> None:
    display = sent(text)
    lines, elements = np.nonzero(display.words == 5)
    assert sorted(zip(elements.tolist(), lines.tolist(), strict=True)) == sorted(pixels)
    assert np.count_nonzero(display.words) == len(pixels)
    assert display.processor.parameters.start == pixels[-1]
