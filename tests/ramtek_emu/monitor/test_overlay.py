from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu.monitor.overlay import BLACK, WHITE, Overlay, entries_page, help_page, write, write_message


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
    write(plain, "Hi", 1, 1)
    write(twice, "Hi", 2, 2, size=2)
    assert np.array_equal(plain.repeat(2, axis=0).repeat(2, axis=1), twice)
    assert {0, BLACK, WHITE} == set(plain.ravel().tolist())
    small = np.zeros((12, 6), np.uint32)
    write(small, "Hi", 1, 1)
    assert np.array_equal(small, plain[:, :6])


def test_a_message_that_is_too_long_ends_in_two_periods() -> None:
    pixels, expected = np.zeros((2, 480, 640), np.uint32)
    write_message(pixels, "x" * 100)
    write_message(expected, "x" * 76 + "..")
    assert np.array_equal(pixels, expected)
    assert not pixels[:464].any()


def test_the_help_fits_on_every_display() -> None:
    for lines, elements in ((480, 640), (512, 512), (256, 320), (1024, 1280)):
        page = help_page(lines, elements, "RAMTEK 9300")
        assert page.shape == (lines, elements)
        assert WHITE in page


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
    assert np.array_equal(field, help_page(480, 640, "title"))
    overlay.turn_to("help")
    assert overlay.stamp == ("", "")


def test_a_message_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    overlay = Overlay()
    monkeypatch.setattr("time.monotonic", lambda: 100.0)
    overlay.message = "saved"
    assert overlay.stamp == ("", "saved")
    monkeypatch.setattr("time.monotonic", lambda: 106.0)
    assert overlay.stamp == ("", "")
