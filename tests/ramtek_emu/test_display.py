"""The whole display: streams of the time, streams that nobody would send, and its own switches."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from ramtek_emu import (
    GMR_9300,
    NCAR_9460,
    PRINCETON_9300,
    Configuration,
    Ramtek9300,
    instructions,
)
from tests.ramtek_emu.displays import sent
from tests.ramtek_emu.strategies import SMALL, cuts, sent_words, streams, thorough


@thorough
@given(streams(200), st.lists(st.integers(0, 200), max_size=5))
def test_no_words_at_all_raise_or_leave_the_planes(stream: list[int], places: list[int]) -> None:
    whole = Ramtek9300(SMALL)
    whole.send(np.array(stream, np.uint16))
    assert whole.words.max() <= 1023
    assert whole.field().shape == (9, 13, 3)
    cut = Ramtek9300(SMALL)
    for piece in cuts(stream, places):
        cut.send(piece)
    assert (cut.words == whole.words).all()
    assert (cut.entries == whole.entries).all()
    assert cut.status == whole.status
    assert cut.processor.parameters == whole.processor.parameters
    assert cut.processor.waiting == whole.processor.waiting
    assert (cut.receive(cut.processor.waiting) == whole.receive(whole.processor.waiting)).all()


def test_recorded_band_draws_vertical_bars() -> None:
    texts = [f"0802 0040 {2 * i:04X} 0000 {2 * i + 1:04X} 0100 0902 0004 {i:04X}" for i in range(320)]
    display = sent(*texts)
    assert (display.words[:257] == np.arange(640) // 2).all()
    assert not display.words[257:].any()


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300, NCAR_9460])
def test_random_words_leave_a_display_that_works(configuration: Configuration) -> None:
    display = Ramtek9300(configuration)
    random = np.random.default_rng(1983)
    for _ in range(5):
        display.send(random.integers(0, 0x10000, 100_000).astype(np.uint16))
        assert display.words.max() <= configuration.largest_word
        display.field()
    display.reset()
    assert not display.words.any()
    picture = random.integers(0, 256, (480, 640))
    display.send(instructions.write_image(picture))
    assert (display.words[:480, :640] == picture).all()
    assert display.processor.waiting == 0


WORST = {
    "lines across everything": [0x0E01, 65528, *[0x8000, 0x8000, 0x7FFF, 0x7FFF] * 8191],
    "texture across everything": [0x0E05, 8, 0xAAAA, 0, 65528, *[0x8000, 0x8000, 0x7FFF, 0x7FFF] * 8191],
    "giant text in a small window": [
        0x0C23,
        0x0740,
        9,
        9,
        9,
        9,
        16,
        16,
        0,
        0,
        0x0F0F,
        65534,
        *[0x4142] * 32767,
    ],
    "text in the narrowest window": [0x0C03, 0x0040, 9, 0x8000, 9, 0x7FFF, 65534, *[0x4142] * 32767],
    "rasters in one pixel": [0x0D23, 0x0040, 9, 9, 9, 9, 65534, *[0x5555] * 32767],
    "images in one pixel": [0x0A03, 0x0040, 9, 9, 9, 9, 65534, *[3] * 32767],
    "images in the largest window": [0x0A03, 0x0040, 0x8000, 0x8000, 0x7FFF, 0x7FFF, 65534, *[3] * 32767],
    "erasing the largest window": [0x0902, 0x0040, 0x8000, 0x8000, 0x7FFF, 0x7FFF],
    "copying the largest window": [0x6903, 0x0040, 0x8000, 0x8000, 0x7FFF, 0x7FFF, 4, 5, 5],
    "circles": [0x6D01, 65532, *[320, 240, 200] * 10922],
    "circles of any size": [0x6D01, 65532, *range(32766)],
    "a conic without an end": [0x0F02, 0x1000, *[0] * 9, 1, 0, 0],
    "a conic of large numbers": [0x0F02, 0x1000, *[0x7FFF] * 12],
    "filling": [0x3A02, 0x8002, 5, 3, 3],
}


@pytest.mark.parametrize("name", WORST)
def test_no_instruction_takes_long(name: str) -> None:
    display = Ramtek9300()
    display.send(sent_words([*WORST[name], 0x0700]))
    assert display.decoder.held_words == 0
    assert display.words.max() <= 1023


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


def test_a_display_shows_itself_in_a_notebook_and_in_a_file(tmp_path: Path) -> None:
    display = Ramtek9300()
    display.send(instructions.load_entries(0, [[10, 20, 30]]))
    display.save_png(tmp_path / "display.png")
    assert (tmp_path / "display.png").read_bytes() == display._repr_png_()
    with Image.open(tmp_path / "display.png") as picture:
        assert picture.size == (640, 480)
        assert picture.getpixel((5, 5)) == (10, 20, 30)
