from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, Ramtek9300
from ramtek_emu.monitor.pattern import pattern, ramp_words
from ramtek_emu.processor.processor import Status

EIGHT = Configuration(name="EIGHT_PLANES", elements=1280, lines=1024, planes=8)


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
