"""Histories: which instructions wrote a pixel or an entry, and which is the next to change something.

A write counts even if the value stays. A search runs at most one and a half replays of the stream, so it is a
generator that pauses often. `finished` runs it without pauses.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import NamedTuple, TypeAlias, TypeVar

import numpy as np

from ramtek_emu.arrays import AnyArray
from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME
from ramtek_emu.memory.scan_orders import Window


class EntryRange(NamedTuple):
    """A range of entries of the lookup table: the first, and the end after the last."""

    first: int
    end: int


Selection: TypeAlias = Window | EntryRange
"""Pixels of the memory, or entries of the lookup table."""


def is_single(selection: Selection) -> bool:
    """Whether a selection is one pixel or one entry."""
    if isinstance(selection, EntryRange):
        return selection.end - selection.first == 1
    return selection.width == selection.height == 1


Result = TypeVar("Result")
Search: TypeAlias = Generator[None, None, Result]
"""A search that pauses after each instruction, and returns its result at the end."""


class Write(NamedTuple):
    """An instruction that wrote a pixel or an entry, with the word there, or the color as 0xRRGGBB."""

    number: int
    before: int
    after: int


def finished(search: Search[Result]) -> Result:
    """The result of a search, without pauses."""
    while True:
        try:
            next(search)
        except StopIteration as end:
            result: Result = end.value
            return result


def history_of(replay: Replay, selection: Selection, until: int) -> Search[list[Write]]:
    """The writes to a pixel or an entry up to the instruction `until`, oldest first.

    An instruction that writes several times is a single write.
    """
    found = []
    for write in _writes(replay, selection, 0, until):
        if write is not None:
            number, before, after = write
            found.append(Write(number, before.item(), after.item()))
        yield
    return found


def next_change(replay: Replay, selection: Selection, after: int) -> Search[int | None]:
    """The first instruction after `after` that changes a word or color of a selection, or None."""
    for number in _changes(replay, selection, after, len(replay.stream)):
        if number is not None:
            return number
        yield
    return None


def last_change(replay: Replay, selection: Selection, before: int) -> Search[int | None]:
    """The last instruction before `before` that changes a word or color of a selection, or None."""
    for part in reversed(_parts(replay, selection, 0, before - 1)):
        last = None
        for number in _changes(replay, selection, *part):
            last = last if number is None else number
            yield
        if last is not None:
            return last
    return None


def _parts(replay: Replay, selection: Selection, after: int, until: int) -> list[tuple[int, int]]:
    """The parts of the stream that may write to a selection, after `after` up to `until`."""
    if isinstance(selection, EntryRange):
        return [(after, max(after, until))]
    return replay.stretches(selection, after, until)


def _changes(replay: Replay, selection: Selection, after: int, until: int) -> Iterator[int | None]:
    """The numbers of instructions that change a selection; None for any other instruction."""
    for write in _writes(replay, selection, after, until):
        yield None if write is None or np.array_equal(*write[1:]) else write[0]


def _writes(
    replay: Replay, selection: Selection, after: int, until: int
) -> Iterator[tuple[int, AnyArray, AnyArray] | None]:
    """The instructions that write to a selection, with its words or colors before and after.

    None stands for any other instruction that is executed.
    """
    touched: AnyArray
    memory: AnyArray
    for begin, end in _parts(replay, selection, after, until):
        display = replay.display_at(begin)
        if isinstance(selection, EntryRange):
            # No other instruction changes entries, so only loads are executed.
            opcodes = replay.stream.words[replay.stream.ends[begin:end]] >> 8
            loads = np.flatnonzero(opcodes == FORMAT_OF_NAME["LAM"].opcode) + begin + 1
            numbers = _executed(replay, display, loads.tolist())
            table, part = display.lookup_table, slice(selection.first, selection.end)
            table.touched = np.zeros(table.size, np.bool_)
            touched, memory = table.touched[part], table.packed[part]
        else:
            numbers = replay.steps(display, begin, end)
            frame_buffer = display.frame_buffer
            place = slice(selection.top, selection.bottom + 1), slice(selection.left, selection.right + 1)
            frame_buffer.touched = np.zeros(display.words.shape, np.bool_)
            touched, memory = frame_buffer.touched[place], frame_buffer.words[place]
        before = memory.copy()
        for number in numbers:
            display.processor.replies.clear()
            if not touched.any():
                yield None
                continue
            touched[...] = False
            now = memory.copy()
            yield number, before, now
            before = now


def _executed(replay: Replay, display: Ramtek9300, numbers: list[int]) -> Iterator[int]:
    """Execute some instructions, and pause after each."""
    for number in numbers:
        display.send(replay.stream.words_between(number - 1, number))
        yield number
