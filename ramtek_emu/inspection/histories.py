"""Histories: which instructions wrote a pixel or an entry, and which is the next to change something.

A write counts even if the value stays. A search runs at most one and a half replays of the stream, so it is a
generator that pauses often. `finished` runs it without pauses.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import Final, NamedTuple, TypeAlias, TypeVar

import numpy as np

from ramtek_emu.arrays import AnyArray, Dots
from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME
from ramtek_emu.memory.scan_orders import Window

LOAD: Final = FORMAT_OF_NAME["LAM"].opcode
"""The only opcode that writes entries."""


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
    for change in _changes(replay, selection, 0, until):
        if change is not None:
            found.append(Write(change.number, change.before.item(), change.after.item()))
        yield
    return found


def next_change(replay: Replay, selection: Selection, after: int) -> Search[int | None]:
    """The first instruction after `after` that changes a word or color of a selection, or None."""
    for change in _changes(replay, selection, after, len(replay.stream)):
        if change is not None and not np.array_equal(change.before, change.after):
            return change.number
        yield
    return None


def last_change(replay: Replay, selection: Selection, before: int) -> Search[int | None]:
    """The last instruction before `before` that changes a word or color of a selection, or None."""
    parts = [(0, max(0, before - 1))]
    if isinstance(selection, Window):
        parts = [(begin, end) for begin, end, _ in replay.stretches(selection, 0, before - 1)]
    for begin, end in reversed(parts):
        number = None
        for change in _changes(replay, selection, begin, end):
            if change is not None and not np.array_equal(change.before, change.after):
                number = change.number
            yield
        if number is not None:
            return number
    return None


class SelectionWrite(NamedTuple):
    """An instruction that wrote to a selection, with its words or colors before and after."""

    number: int
    before: AnyArray
    after: AnyArray


def _changes(replay: Replay, selection: Selection, after: int, until: int) -> Iterator[SelectionWrite | None]:
    """The instructions that write to a selection; None for any other instruction, or part of the stream."""
    if isinstance(selection, EntryRange):
        # No other instruction changes entries, so only loads are executed.
        loads = np.flatnonzero(replay.stream.opcodes[after:until] == LOAD) + after + 1
        display = replay.display_at(after)
        table, part = display.lookup_table, slice(selection.first, selection.end)
        written = table.touched = np.zeros(table.size, np.bool_)
        numbers = _executed(replay, display, loads.tolist())
        yield from _noted(display, written[part], table.packed[part], numbers)
        return
    for begin, end, may_write in replay.stretches(selection, after, until):
        if not may_write:
            yield None
            continue
        display = replay.display_at(begin)
        touched = display.frame_buffer.touched = np.zeros(display.words.shape, np.bool_)
        place = slice(selection.top, selection.bottom + 1), slice(selection.left, selection.right + 1)
        yield from _noted(display, touched[place], display.words[place], replay.steps(display, begin, end))


def _executed(replay: Replay, display: Ramtek9300, numbers: list[int]) -> Iterator[int]:
    """Execute some instructions, and pause after each."""
    for number in numbers:
        display.send(replay.stream.words_between(number - 1, number))
        yield number


def _noted(
    display: Ramtek9300, touched: Dots, memory: AnyArray, numbers: Iterator[int]
) -> Iterator[SelectionWrite | None]:
    """The changes of a part of a memory that executed instructions touch."""
    before = memory.copy()
    for number in numbers:
        display.processor.replies.clear()
        if not touched.any():
            yield None
            continue
        touched[...] = False
        now = memory.copy()
        yield SelectionWrite(number, before, now)
        before = now
