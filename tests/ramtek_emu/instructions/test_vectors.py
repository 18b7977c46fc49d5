from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import PRINCETON_9300, Ramtek9300, WordsError, instructions
from ramtek_emu.instruction_set.decoder import Decoder
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, quick, windows
from tests.ramtek_emu.words import hexadecimal

WHOLE = (0, 0, 639, 479)
far = st.integers(-40, 60)


def test_lines_are_sent_in_the_words_of_the_time() -> None:
    assert hexadecimal(instructions.write_vectors([(0, 0), (639, 479)], 5)) == (
        "0E03 8002 0005 0000 0000 0004 027F 01DF"
    )
    assert hexadecimal(instructions.write_segments([(1, 2, 3, 4), (-1, 6, 7, 8)], 5)) == (
        "3503 0002 0005 0010 0001 0002 0003 0004 FFFF 0006 0007 0008"
    )
    assert hexadecimal(instructions.write_segments([(1, 2, 3, 4)], window=WHOLE)) == (
        "3505 000A 0000 0000 027F 01DF FFFF 0000 0008 0001 0002 0003 0004"
    )
    assert hexadecimal(instructions.write_vectors([(1, 2)], 5, (3, 4), WHOLE)) == (
        "0E07 8002 000A 0005 0003 0004 0000 0000 027F 01DF FFFF 0000 0004 0001 0002"
    )


@quick
@given(st.lists(st.tuples(far, far, far, far), min_size=1, max_size=8), windows())
def test_segments_are_the_nearest_pixels_with_both_ends_inside_the_window(
    segments: list[tuple[int, int, int, int]], window: tuple[int, int, int, int]
) -> None:
    display, linked = Ramtek9300(SMALL), Ramtek9300(SMALL)
    # What another program left behind does not matter.
    left_behind = instructions.set_parameters(write_window=(3, 3, 4, 4), texture=(0x1234, 2), foreground=3)
    display.send(left_behind)
    display.send(instructions.write_segments(segments, 9, window))
    twin = [[0] * 13 for _ in range(9)]
    for *start, element, line in segments:
        for place in reference.line_places((start[0], start[1]), (element, line)):
            reference.write_pixel(twin, place, 9, 1023, window)
        linked.send(left_behind)
        linked.send(instructions.write_vectors([start, (element, line)], 9, window=window))
    assert display.words.tolist() == twin
    assert linked.words.tolist() == twin
    assert display.processor.parameters.start == segments[-1][2:]


def test_without_a_window_lines_keep_window_and_texture() -> None:
    for encoded in (
        instructions.write_segments([(0, 0, 12, 0)], 9),
        instructions.write_vectors([(0, 0), (12, 0)], 9),
    ):
        display = Ramtek9300(SMALL)
        display.send(instructions.set_parameters(write_window=(2, 0, 9, 8), texture=(0xCCCC, 0)))
        display.send(encoded)
        assert display.words[0].tolist() == [0] * 4 + [9, 9, 0, 0, 9, 9] + [0] * 3


def test_vectors_without_a_window_are_drawn_by_a_display_without_the_second_operand_word() -> None:
    display = Ramtek9300(PRINCETON_9300)
    display.send(instructions.write_vectors([(5, 6), (7, 6)], 9))
    assert display.words[6, 4:9].tolist() == [0, 9, 9, 9, 0]


@quick
@given(st.integers(1, 20000))
def test_long_rows_of_vertices_are_sent_in_several_instructions(count: int) -> None:
    stream = instructions.write_vectors(np.arange(2 * count).reshape(-1, 2) % 600, 1)
    found = list(Decoder().feed(stream))
    assert sum(len(instruction.data) // 2 for instruction in found) == max(1, count - 1)


def test_many_segments_are_those_of_as_many_instructions() -> None:
    segments = np.random.default_rng(5).integers(-100, 700, (18400, 4))
    stream = instructions.write_segments(segments, 9, WHOLE)
    found = list(Decoder().feed(stream))
    assert [len(each.data) // 4 for each in found] == [8191, 8191, 2018]
    assert [list(each.operands) for each in found[1:]] == [[], []]
    together, apart = Ramtek9300(), Ramtek9300()
    together.send(stream)
    for first in range(0, len(segments), 100):
        apart.send(instructions.write_segments(segments[first : first + 100], 9))
    assert (together.words == apart.words).all()


@pytest.mark.parametrize("vertices", [[], [[1, 2, 3]], [[0.5, 1.0]], [[40000000, 1]]])
def test_vertices_that_do_not_fit_are_refused(vertices: object) -> None:
    with pytest.raises(WordsError):
        instructions.write_vectors(vertices)


@pytest.mark.parametrize(
    ("segments", "sentence"),
    [
        (
            np.zeros((0, 4), int),
            "segments must be an (n, 4) array of element, line, element and line with at least one row, "
            "not of shape (0, 4); reshape it",
        ),
        (
            [[1, 2]],
            "segments must be an (n, 4) array of element, line, element and line with at least one row, "
            "not of shape (1, 2); reshape it",
        ),
        (
            [[1, 2, 3, 70000]],
            "a segment must be within -32768 to 65535, not 1 to 70000; clip the lines first",
        ),
        (
            [[0.5, 1, 2, 3]],
            "segments must be whole numbers, not float64; convert them first, rounding half up",
        ),
    ],
)
def test_segments_that_do_not_fit_are_refused_in_words(segments: object, sentence: str) -> None:
    with pytest.raises(WordsError) as refusal:
        instructions.write_segments(segments)
    assert str(refusal.value) == sentence
