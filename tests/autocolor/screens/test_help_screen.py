from __future__ import annotations

import numpy as np
import pytest
from autocolor.screens.drawing import HEIGHT, NIGHT, ORANGE, WHITE, WIDTH

from autocolor.screens import help_screen
from autocolor.screens.bindings import BINDINGS, WINDOW_KEYS
from autocolor.screens.help_screen import LIMITS, MIDDLE, STEP, TOP, draw_help
from ramtek_emu import HostPort, Ramtek9300
from ramtek_emu.memory.character_rom import CELL_ELEMENTS, CELL_LINES

ROWS = [(str(binding), binding.does) for binding in BINDINGS] + list(WINDOW_KEYS)


def test_every_row_of_the_help_fits_on_the_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[tuple[int, int, int, int]] = []

    def text(_: HostPort, line: str, left: int, top: int, word: int = 0, size: int = 1) -> None:
        assert line.isascii()
        written.append((left, top, left + len(line) * CELL_ELEMENTS * size, top + CELL_LINES * size))

    monkeypatch.setattr(help_screen, "text", text)
    draw_help(Ramtek9300(), "AUTOCOLOR", ROWS)
    assert len(written) == 1 + 2 * len(ROWS) + len(LIMITS)
    for left, top, right, bottom in written:
        assert 0 <= left < right <= WIDTH
        assert 0 <= top < bottom <= HEIGHT
    for number, box in enumerate(written):
        for other in written[:number]:
            apart_across = box[0] >= other[2] or other[0] >= box[2]
            apart_down = box[1] >= other[3] or other[1] >= box[3]
            assert apart_across or apart_down


def test_each_row_has_its_keys_and_what_they_do() -> None:
    display = Ramtek9300()
    draw_help(display, "AUTOCOLOR", ROWS)
    for number in range(len(ROWS)):
        row = display.words[TOP + STEP * number : TOP + STEP * number + CELL_LINES]
        assert set(np.unique(row[:, :MIDDLE])) == {NIGHT, ORANGE}
        assert set(np.unique(row[:, MIDDLE:])) == {NIGHT, WHITE}
