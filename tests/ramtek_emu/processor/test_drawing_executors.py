from __future__ import annotations

import numpy as np

from ramtek_emu import Ramtek9300
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu.displays import box, sent
from tests.ramtek_emu.recorded_streams import OUTLINE, SQUARES


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


def test_recorded_sqap_numbers_its_squares_in_the_background() -> None:
    display = Ramtek9300()
    display.send(SQUARES)
    words = display.words
    assert (words[9:32, :32] == 4).all()
    assert (words[9:32, 32:64] == 6).all()
    shapes = characters()
    for number, letter in enumerate("004"):
        assert (words[:9, 7 * number : 7 * number + 7] == np.where(shapes[ord(letter)], 0, 4)).all()
    assert (words[:9, 46:53] == np.where(shapes[ord("6")], 0, 6)).all()


def test_recorded_polyline_of_the_vicar_driver() -> None:
    display = sent("0E03 8003 00FF 0005 0000 0000 0008 027F 01DF 013F 00EF")
    assert display.words[0, 0] == 5
    assert display.words[479, 639] == 5
    assert display.processor.parameters.start == (319, 239)


def test_text_packed_low_byte_first_is_the_same_text() -> None:
    low_first = sent("0C0B 0040 0064 01C3 026B 01FF 0006 4548 4C4C 204F")
    high_first = sent("0C03 0040 0064 01C3 026B 01FF 0006 4845 4C4C 4F20")
    assert (low_first.words == high_first.words).all()
    assert box(low_first)[:2] == (101, 452)
