from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration
from ramtek_emu.inspection import stream as module
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.testing import streams
from tests.ramtek_emu.strategies import cuts


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300])
@given(words=streams(), places=st.lists(st.integers(0, 60), max_size=5), piece=st.integers(1, 70))
def test_instructions_are_counted_as_the_listing_shows_them(
    configuration: Configuration, words: list[int], places: list[int], piece: int
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "PIECE", piece)
        stream = Stream(configuration)
        for part in cuts(words, places):
            stream.append(part)
    data = np.array(words, "<u2").tobytes()
    listed = [item for item in items([data], configuration) if "the stream ends" not in item.note]
    assert len(stream) == len(listed) == len(stream.opcodes)
    for number, item in enumerate(listed, 1):
        assert list(stream.item(number).lines()) == list(item.lines())
        assert stream.place(number) == item.place
        assert stream.opcodes[number - 1] == item.words[0] >> 8
    assert stream.words.tolist() == words
    assert stream.words_between(0, len(stream)).tolist() == words[: stream.ends[-1]]
