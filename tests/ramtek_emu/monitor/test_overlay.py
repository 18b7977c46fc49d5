from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu.memory.character_rom import characters
from ramtek_emu.monitor.boxes import BLACK, ORANGE, WHITE, YELLOW, entries_page, help_page, write
from ramtek_emu.monitor.overlay import KEYS, Overlay


@pytest.mark.parametrize(
    ("words", "columns"), [(1, 1), (2, 2), (16, 4), (64, 8), (512, 32), (1024, 32), (4096, 64)]
)
def test_the_colors_of_all_words_stand_in_cells_row_by_row(words: int, columns: int) -> None:
    colors = np.arange(words, dtype=np.uint32) + 7
    rows = words // columns
    page = entries_page(colors, 480, 640)
    assert page.shape == (480, 640)
    middles = page[
        ((np.arange(rows) + 0.5) * 480 / rows).astype(int)[:, np.newaxis],
        ((np.arange(columns) + 0.5) * 640 / columns).astype(int),
    ]
    assert np.array_equal(middles.ravel(), colors)


def test_text_is_drawn_in_whole_multiples_and_clipped() -> None:
    plain, twice = np.zeros((12, 20), np.uint32), np.zeros((24, 40), np.uint32)
    write(plain, "Hi", 1, 2)
    write(twice, "Hi", 2, 4, size=2)
    assert np.array_equal(plain.repeat(2, axis=0).repeat(2, axis=1), twice)
    small = np.zeros((12, 6), np.uint32)
    write(small, "Hi", 1, 2)
    assert np.array_equal(small, plain[:, :6])
    for left, letter in ((1, "H"), (9, "i")):
        cell = plain[2:11, left : left + 8]
        assert np.array_equal(cell[:, :7], np.where(characters()[ord(letter)], WHITE, BLACK))
        assert (cell[:, 7] == BLACK).all()
    plain[2:11, 1:17] = 0
    assert not plain.any()


@pytest.mark.parametrize("size", [1, 2])
def test_a_message_stands_on_the_last_lines_and_ends_in_two_periods_if_it_is_too_long(size: int) -> None:
    for message, shown in (("x" * 78, "x" * 78), ("x" * 79, "x" * 76 + "..")):
        pixels, expected = np.zeros((2, 480 * size, 640 * size), np.uint32)
        overlay = Overlay()
        overlay.message = message
        overlay.draw(pixels, pixels[0], "")
        expected[464 * size :] = BLACK
        write(expected, shown, 8 * size, 467 * size, size=size)
        assert np.array_equal(pixels, expected)


@pytest.mark.parametrize(("lines", "elements"), [(480, 640), (512, 512), (256, 320), (1024, 1280)])
def test_the_help_has_a_line_for_each_key(lines: int, elements: int) -> None:
    size = 2 if elements == 1280 else 1
    expected = np.full((lines, elements), BLACK, np.uint32)
    write(expected, "RAMTEK 9300", 8 * size, 8 * size, YELLOW, size=2 * size)
    for number, (keys, action) in enumerate(KEYS):
        write(expected, keys, 8 * size, (46 + 15 * number) * size, ORANGE, size=size)
        write(expected, action, 136 * size, (46 + 15 * number) * size, size=size)
    assert np.array_equal(help_page(lines, elements, "RAMTEK 9300", KEYS), expected)


def test_a_page_is_turned_to_and_back() -> None:
    overlay = Overlay()
    field = np.full((480, 640), 5, np.uint32)
    colors = np.arange(1024, dtype=np.uint32)
    overlay.draw(field, colors, "title")
    assert (field == 5).all()
    overlay.turn_to("entries")
    overlay.draw(field, colors, "title")
    assert np.array_equal(field, entries_page(colors, 480, 640))
    overlay.turn_to("help")
    overlay.draw(field, colors, "title")
    assert np.array_equal(field, help_page(480, 640, "title", KEYS))
    overlay.turn_to("help")
    assert overlay.stamp == ("", "", False)


def test_a_message_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    overlay = Overlay()
    monkeypatch.setattr("time.monotonic", lambda: 100.0)
    overlay.message = "saved"
    for now, message in ((100.0, "saved"), (104.9, "saved"), (105.0, "")):
        monkeypatch.setattr("time.monotonic", lambda now=now: now)
        assert overlay.stamp == ("", message, False)
