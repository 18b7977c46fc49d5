from __future__ import annotations

import zlib

import numpy as np
import pytest

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, Ramtek9300
from ramtek_emu.monitor.pattern import pattern, ramp_words
from ramtek_emu.processor.processor import Status

EIGHT = Configuration(name="EIGHT_PLANES", elements=1280, lines=1024, planes=8)


@pytest.mark.parametrize(
    ("configuration", "number"), [(GMR_9300, 2928258339), (PRINCETON_9300, 1649409050), (EIGHT, 290906280)]
)
def test_the_pattern_is_drawn_as_it_was(configuration: Configuration, number: int) -> None:
    # If the pattern changes on purpose, look at it, and copy the new number from the failure.
    assert zlib.crc32(pattern(configuration).tobytes()) == number


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300, EIGHT])
def test_the_pattern_uses_every_ramp_on_every_display(configuration: Configuration) -> None:
    display = Ramtek9300(configuration)
    display.send(pattern(configuration))
    assert display.status == Status.READY
    assert display.decoder.pending_words == 0
    assert display.words.max() == configuration.largest_word
    shown = {tuple(color) for color in np.unique(display.field().reshape(-1, 3), axis=0).tolist()}
    for ramp in ramp_words(configuration).values():
        middle = display.entries[ramp[len(ramp) // 2]].tolist()
        assert tuple(middle) in shown
