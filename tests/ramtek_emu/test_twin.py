"""The display beside its slow twin: random instructions leave the same words, replies and parameters."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.instruction_set.decoder import Decoder
from tests.ramtek_emu.reference import Twin
from tests.ramtek_emu.strategies import SMALL, drawing_instructions


@given(st.integers(0, 2**32 - 1), st.lists(drawing_instructions(farthest=300), min_size=1, max_size=4))
def test_random_instructions_do_what_the_slow_twin_does(seed: int, sent: list[NDArray[np.uint16]]) -> None:
    picture = np.random.default_rng(seed).integers(0, 4, (9, 13))
    display, twin = Ramtek9300(SMALL), Twin(SMALL)
    for stream in (instructions.write_image(picture), np.array([0x0600], np.uint16), *sent):
        display.send(stream)
        (instruction,) = Decoder(SMALL).feed(stream)
        twin.send(instruction)
        assert display.words.tolist() == twin.words
        assert display.processor.parameters.start == twin.start
        assert display.receive(display.processor.waiting).tolist() == twin.replies
        twin.replies.clear()
