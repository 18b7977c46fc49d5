from __future__ import annotations

import numpy as np
from autocolor.screens.drawing import NIGHT, WHITE, clear, text

from autocolor.mapping.level_ranges import SCREENS
from autocolor.screens import drawing
from ramtek_emu import Ramtek9300


def test_a_cleared_screen_has_one_word_everywhere() -> None:
    display = Ramtek9300()
    text(display, "old", 600, 470, WHITE)
    clear(display)
    assert (display.words == NIGHT).all()


def test_text_stays_in_its_cells() -> None:
    display = Ramtek9300()
    clear(display)
    text(display, "Hg", 100, 50, size=2)
    lines, elements = np.nonzero(display.words == WHITE)
    assert lines.min() >= 50
    assert lines.max() < 68
    assert elements.min() >= 100
    assert elements.max() < 128


def test_the_words_of_the_screens_belong_to_the_screens() -> None:
    names = ("BLACK", "WHITE", "LIGHT_GRAY", "GRAY", "SLATE", "NIGHT", "YELLOW", "ORANGE")
    words = [getattr(drawing, name) for name in names]
    assert len(set(words)) == len(words)
    assert all(SCREENS.first <= word <= SCREENS.last for word in words)
