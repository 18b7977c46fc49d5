"""Histories: which instructions wrote a pixel or an entry, and which is the next to change something.

A write counts even if the value stays. A search runs at most one and a half replays of the stream, so it is a
generator that pauses often. `finished` runs it without pauses.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import Final, NamedTuple, TypeAlias, TypeVar

import numpy as np

from ramtek_emu.arrays import Dots, PackedColors, Words
from ramtek_emu.inspection.replay import Replay, reply_of
from ramtek_emu.inspection.watching import watched, watched_table
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME
from ramtek_emu.memory.scan_orders import Window

LOAD: Final = FORMAT_OF_NAME["LAM"].opcode
"""The only opcode that writes entries."""

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


def writes_to_pixel(replay: Replay, line: int, element: int, until: int) -> Search[list[Write]]:
    """The writes to a word of the memory up to the instruction `until`, oldest first.

    An instruction that writes the word several times is a single write.
    """
    writes = []
    for change in _words_written(replay, Window(element, line, element, line), 0, until):
        if change is not None:
            writes.append(Write(change.number, int(change.before[0, 0]), int(change.after[0, 0])))
        yield
    return writes


def next_change(replay: Replay, window: Window, after: int) -> Search[int | None]:
    """The first instruction after `after` that changes a word in a window; None if none does."""
    for change in _words_written(replay, window, after, len(replay.stream)):
        if change is not None and not np.array_equal(change.before, change.after):
            return change.number
        yield
    return None


def last_change(replay: Replay, window: Window, before: int) -> Search[int | None]:
    """The last instruction before the instruction `before` that changes a word in a window, or None."""
    for stretch in reversed([*replay.stretches(0, before - 1)]):
        number = None
        for change in _words_written(replay, window, stretch.state.number, stretch.end):
            if change is not None and not np.array_equal(change.before, change.after):
                number = change.number
            yield
        if number is not None:
            return number
    return None


def writes_to_entry(replay: Replay, entry: int, until: int) -> Search[list[Write]]:
    """The writes to an entry of the lookup table up to the instruction `until`, oldest first."""
    writes = []
    for load in _entries_written(replay, 0, until):
        if load.touched[entry]:
            writes.append(Write(load.number, int(load.before[entry]), int(load.after[entry])))
        yield
    return writes


def next_entry_change(replay: Replay, first: int, end: int, after: int) -> Search[int | None]:
    """The first instruction after `after` that changes a color of the entries from `first` to before `end`.

    None if none does.
    """
    for load in _entries_written(replay, after, len(replay.stream)):
        if not np.array_equal(load.before[first:end], load.after[first:end]):
            return load.number
        yield
    return None


def last_entry_change(replay: Replay, first: int, end: int, before: int) -> Search[int | None]:
    """The last instruction before `before` that changes a color of the entries `first` to `end`, or None."""
    number = None
    for load in _entries_written(replay, 0, before - 1):
        if not np.array_equal(load.before[first:end], load.after[first:end]):
            number = load.number
        yield
    return number


class WordsWritten(NamedTuple):
    """An instruction that wrote to a window, with the words of the window before and after it."""

    number: int
    before: Words
    after: Words


def _words_written(replay: Replay, window: Window, after: int, until: int) -> Iterator[WordsWritten | None]:
    """The instructions that write to a window; for any other instruction, or a part of the stream, None."""
    part = slice(window.top, window.bottom + 1), slice(window.left, window.right + 1)
    for stretch in replay.stretches(after, until):
        if not stretch.may_touch(part):
            yield None
            continue
        display, begin = stretch.state.display(), max(stretch.state.number, after)
        display.send(replay.stream.words_between(stretch.state.number, begin))
        touched = watched(display).watch(window)
        before = display.words[part].copy()
        for number in replay.steps(display, begin, stretch.end):
            reply_of(display)
            if not touched.any():
                yield None
                continue
            touched[...] = False
            now = display.words[part].copy()
            yield WordsWritten(number, before, now)
            before = now


class EntriesWritten(NamedTuple):
    """A load of the lookup table: the entries that it touched, and the colors of all before and after it."""

    number: int
    touched: Dots
    before: PackedColors
    after: PackedColors


def _entries_written(replay: Replay, after: int, until: int) -> Iterator[EntriesWritten]:
    """The loads of the lookup table. No other instruction changes entries, so only loads are executed."""
    state = replay.state_before(after)
    display = state.display()
    touched = watched_table(display).watch()
    loads = np.flatnonzero(replay.stream.opcodes[state.number : until] == LOAD) + state.number + 1
    before = display.lookup_table.packed.copy()
    for number in loads.tolist():
        touched[...] = False
        display.send(replay.stream.words_between(number - 1, number))
        now = display.lookup_table.packed.copy()
        if number > after:
            yield EntriesWritten(number, touched, before, now)
        before = now
