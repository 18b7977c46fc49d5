from __future__ import annotations

import copy

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from ramtek_emu import PRINCETON_9300, Configuration, EntryFormat, Ramtek9300, instructions
from ramtek_emu.inspection.histories import EntryRange, Write, finished, history_of, next_change
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME
from ramtek_emu.memory.scan_orders import Window
from ramtek_emu.testing import streams
from tests.ramtek_emu.inspection.replays import prepare, replay_of, states_every
from tests.ramtek_emu.strategies import SMALL

READS_WHAT_IT_WRITES = {FORMAT_OF_NAME["COPY"].opcode, FORMAT_OF_NAME["FILL"].opcode}


def watched_writes(stream: Stream, line: int, element: int) -> list[Write]:
    """The slow way: before each instruction every bit of the word is inverted in a copy of the display.

    An instruction that writes the word leaves a bit alike in both, unless it reads what it writes.
    """
    display, writes = Ramtek9300(stream.configuration), []
    for number in range(1, len(stream) + 1):
        twin = copy.deepcopy(display)
        before = int(display.words[line, element])
        twin.frame_buffer.fill(Window(element, line, element, line), before ^ 0x3FF)
        for each in (display, twin):
            each.send(stream.words_between(number - 1, number))
        after = int(display.words[line, element])
        if after ^ int(twin.words[line, element]) != 0x3FF:
            writes.append(Write(number, before, after))
    return writes


@given(
    words=streams(120),
    line=st.integers(0, 8),
    element=st.integers(0, 12),
    most_bytes=st.sampled_from([0, 1 << 30]),
    is_prepared=st.booleans(),
)
def test_the_history_of_a_pixel_has_every_write(
    words: list[int], line: int, element: int, most_bytes: int, is_prepared: bool
) -> None:
    words = [word for word in words if word >> 8 not in READS_WHAT_IT_WRITES]
    with states_every(0, most_bytes):
        replay = replay_of(words)
        if is_prepared:
            prepare(replay)
        until, pixel = len(replay.stream), Window(element, line, element, line)
        writes = finished(history_of(replay, pixel, until))
        # The operands of an instruction may be read as the opcode of another after words were left out.
        opcodes = replay.stream.words[replay.stream.ends[:-1]] >> 8
        if not READS_WHAT_IT_WRITES.intersection(opcodes.tolist()):
            assert writes == watched_writes(replay.stream, line, element)
        for write in writes:
            fewer = finished(history_of(replay, pixel, write.number))
            assert fewer == [each for each in writes if each.number <= write.number]


def test_a_copy_and_a_fill_write_also_words_that_stay_the_same() -> None:
    words = [*instructions.erase((0, 0, 12, 8), 5), *(0x6903, 0x8040, 0, 0, 3, 3, 0, 0, 4, 0, 0)]
    replay = replay_of(words)
    names = [replay.stream.item(number).to_plain().get("name") for number in range(1, len(replay.stream) + 1)]
    assert "COPY" in names
    history = finished(history_of(replay, Window(2, 2, 2, 2), len(names)))
    assert [(write.before, write.after) for write in history][-1] == (5, 5)
    assert history[-1].number == names.index("COPY") + 1


@given(
    words=streams(120),
    corner=st.tuples(st.integers(0, 8), st.integers(0, 12)),
    size=st.tuples(st.integers(0, 8), st.integers(0, 12)),
    after=st.integers(0, 120),
    is_prepared=st.booleans(),
)
def test_the_next_change_of_a_rectangle(
    words: list[int], corner: tuple[int, int], size: tuple[int, int], after: int, is_prepared: bool
) -> None:
    top, left = corner
    window = Window(left, top, min(left + size[1], 12), min(top + size[0], 8))
    with states_every(0):
        replay = replay_of(words)
        if is_prepared:
            prepare(replay)
        after %= len(replay.stream) + 1
        found = finished(next_change(replay, window, after))
    display = Ramtek9300(SMALL)
    expected = None
    for number in range(1, len(replay.stream) + 1):
        before = display.words[top : window.bottom + 1, left : window.right + 1].copy()
        display.send(replay.stream.words_between(number - 1, number))
        now = display.words[top : window.bottom + 1, left : window.right + 1]
        if number > after and expected is None and not np.array_equal(before, now):
            expected = number
    assert found == expected


loads = st.lists(
    st.tuples(st.integers(0, 2100), st.lists(st.integers(0, 3), max_size=6), st.sampled_from([0, 0, 0, 1])),
    max_size=8,
)


@pytest.mark.parametrize("configuration", [SMALL, PRINCETON_9300])
@example([(3, [], 0)], 0, 1)
@given(loads, st.integers(0, 12), st.sampled_from([0, 1, 2, 1022, 1023]))
def test_the_history_of_an_entry(
    configuration: Configuration, loads: list[tuple[int, list[int], int]], after: int, entry: int
) -> None:
    words = [
        word
        for address, data, device in loads
        for word in (0x0300 | device, address, 2 * len(data), *data, 0x0700)
    ]
    # A search may begin at any state.
    with states_every(0):
        replay = Replay(Stream(configuration, np.array(words, np.uint16)))
        prepare(replay)
    # The slow way, word by word.
    per_entry = 1 if configuration.entry_format is EntryFormat.WORD_12 else 2
    display = Ramtek9300(configuration)
    writes: list[Write] = []
    for index, (address, data, device) in enumerate(loads):
        before = int(display.lookup_table.packed[entry])
        display.send(replay.stream.words_between(2 * index, 2 * index + 1))
        places = {(address + offset) % (1024 * per_entry) // per_entry for offset in range(len(data))}
        if device == 0 and entry in places:
            writes.append(Write(2 * index + 1, before, int(display.lookup_table.packed[entry])))
    last, selection = len(replay.stream), EntryRange(entry, entry + 1)
    assert finished(history_of(replay, selection, last)) == writes
    after = min(after, last)
    changes = [write.number for write in writes if write.number > after and write.before != write.after]
    assert finished(next_change(replay, selection, after)) == (changes[0] if changes else None)
