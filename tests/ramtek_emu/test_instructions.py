from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import (
    GMR_9300,
    PRINCETON_9300,
    Configuration,
    InstructionError,
    Ramtek9300,
    WordsError,
    instructions,
)
from ramtek_emu.processor.processor import Status

PLACES = st.integers(-30, 60) | st.sampled_from([-0x8000, 0x7FFF])


@given(
    st.lists(st.tuples(PLACES, PLACES, PLACES, PLACES), min_size=1, max_size=20),
    st.integers(0, 7),
    st.sampled_from(
        [GMR_9300, PRINCETON_9300, Configuration(name="WIDE", elements=4096, lines=200, planes=8)]
    ),
)
def test_unlinked_lines_are_those_of_a_vector_instruction_each(
    segments: list[tuple[int, int, int, int]], scan_order: int, configuration: Configuration
) -> None:
    display, twin = Ramtek9300(configuration), Ramtek9300(configuration)
    display.send(instructions.set_parameters(scan_order=scan_order, window=(3, 4, 5, 6)))
    display.send(instructions.write_segments(segments, 7))
    for segment in segments:
        twin.send(instructions.write_vectors(np.reshape(segment, (2, 2)), 7))
    assert (display.words == twin.words).all()
    assert display.status == Status.READY


def test_what_is_too_long_for_an_instruction_goes_on_in_the_next() -> None:
    for count, instructions_sent in ((1, 1), (10_922, 1), (10_923, 2)):
        words = instructions.write_circles([(1, 1, 1)] * count)
        assert len(words) == 2 * instructions_sent + 3 * count
    with pytest.raises(WordsError, match="a circle must be within"):
        instructions.write_circles([(1, 1, -1)])


def test_the_lookup_table_is_addressed_by_words() -> None:
    assert instructions.park_table(5).tolist() == [0x0300, 5, 0]
    assert instructions.read_entries().tolist() == [0x0400, 0, 4096]
    assert instructions.read_entries(6, 3).tolist() == [0x0400, 6, 6]
    assert instructions.load_entries(7, [[1, 2, 3]]).tolist() == [0x0300, 14, 4, 0x0203, 1]
    assert instructions.load_entries(7, [[16, 32, 255]], short=True).tolist() == [0x0300, 7, 2, 0x012F]
    assert instructions.read_entries(0, 32767)[2] == 65534
    for wrong in (-1, 32768):
        with pytest.raises(InstructionError, match="the words to read must be 0 to 32767"):
            instructions.read_entries(0, wrong)


def test_encoders_take_numbers_and_rows_of_python_and_of_numpy_alike() -> None:
    encoders: Any = instructions
    one, two, three = np.int64(1), np.uint8(2), np.int16(3)
    window = np.array([1, 2, 3, 9])
    pairs = [
        (encoders.set_parameters(foreground=np.array(3)), encoders.set_parameters(foreground=3)),
        (encoders.erase(window, three), encoders.erase((1, 2, 3, 9), 3)),
        (encoders.write_image([[1, 2]], one, two, three), encoders.write_image([[1, 2]], 1, 2, 3)),
        (encoders.write_text("ab", 1, two, size=[two, three]), encoders.write_text(b"ab", 1, 2, size=(2, 3))),
        (encoders.write_vectors([(1, 2)], start=window[:2]), encoders.write_vectors([(1, 2)])),
        (encoders.zoom(three, two), encoders.zoom(3, 2)),
        (encoders.write_cursor(one, two, three), encoders.write_cursor(1, 2, 3)),
        (encoders.concatenate([0x0500], range(2)), np.array([0x0500, 0, 1], np.uint16)),
    ]
    for encoded, expected in pairs:
        assert encoded.dtype == np.uint16
        assert encoded.tolist() == expected.tolist()
    ((read, count),) = encoders.read_image(one, one, two, three)
    assert (read.tolist(), count) == (next(encoders.read_image(1, 1, 2, 3))[0].tolist(), 6)
