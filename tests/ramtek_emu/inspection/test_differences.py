from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.inspection.differences import first_difference, first_different_instruction
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.memory.cursors import ENTER
from ramtek_emu.snapshot import snapshot_bytes
from ramtek_emu.testing import streams
from tests.ramtek_emu.inspection.replays import moments, replay_of
from tests.ramtek_emu.strategies import SMALL


@given(streams(), streams(), streams())
def test_the_first_difference(begin: list[int], one: list[int], other: list[int]) -> None:
    first, second = replay_of(begin + one), replay_of(begin + other)
    found = first_difference(first.stream, second.stream)
    pairs = [moments(first), moments(second)]
    silence = np.zeros(0, np.uint16)
    expected = None
    for number in range(max(map(len, pairs))):
        # A display whose stream has ended stays as it is, and replies nothing.
        sides = [side[number] if number < len(side) else (side[-1][0], silence) for side in pairs]
        if sides[0][0] != sides[1][0] or sides[0][1].tolist() != sides[1][1].tolist():
            expected = number
            break
    assert (None if found is None else found.number) == expected
    assert found is None or found.where


@given(streams(), st.integers(0, 60))
def test_the_first_different_instruction(words: list[int], number: int) -> None:
    stream = Stream(SMALL, np.array(words, np.uint16))
    number %= len(stream) + 1
    shorter = Stream(SMALL, stream.words_between(0, number))
    assert first_different_instruction(stream, shorter) == number + 1
    assert first_different_instruction(stream, stream) == len(stream) + 1


def test_a_cursor_that_only_one_stream_reads_differs_by_its_enter() -> None:
    start = Ramtek9300(SMALL)
    start.joystick.press_enter()
    alike, read = instructions.no_operation(), instructions.read_cursor(0)
    words = [np.concatenate((alike, last)) for last in (instructions.no_operation(), read)]
    words[0][0] |= 1
    found = first_difference(Stream(SMALL, words[0]), Stream(SMALL, words[1]), start)
    assert found is not None
    assert found.number == 2
    states = [cursors[0]["state"] for cursors in found.where["cursors"]]
    assert states == [ENTER, 0]


def test_a_difference_says_where() -> None:
    alike = instructions.erase((0, 0, 12, 8), 5)
    first = Stream(SMALL, np.concatenate((alike, instructions.erase((2, 1, 4, 3), 6))))
    second = Stream(SMALL, np.concatenate((alike, instructions.erase((2, 1, 4, 2), 6))))
    start = Ramtek9300(SMALL)
    before = snapshot_bytes(start)
    found = first_difference(first, second, start)
    assert found is not None
    assert found.where["words"] == {
        "count": 3,
        "window": [2, 3, 4, 3],
        "line": 3,
        "element": 2,
        "values": [6, 5],
    }
    assert snapshot_bytes(start) == before
    table = [Stream(SMALL, instructions.load_entries(7, [(red, 0, 0)])) for red in (1, 2)]
    found = first_difference(table[0], table[1])
    assert found is not None
    assert found.where == {"entries": {"count": 1, "first": 7, "values": ["#010000", "#020000"]}}
