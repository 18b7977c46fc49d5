"""Differences: the first instruction after which two streams have made different displays, and where.

Instructions are paired by their numbers. After the end of the shorter stream, its display does not change.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from copy import deepcopy
from typing import Any, NamedTuple

import numpy as np

from ramtek_emu.arrays import AnyArray, Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection.replay import Replay, reply_of
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.instruction import NO_WORDS
from ramtek_emu.snapshot import to_plain


class Difference(NamedTuple):
    """Two displays that differ."""

    number: int
    """The first instruction after which they do."""
    where: dict[str, Any]
    """The parts of the display that differ, in plain values, each with the values of both."""


def first_difference(first: Stream, second: Stream, start: Ramtek9300 | None = None) -> Difference | None:
    """The first difference of two streams that run from power-on, or from the display `start`.

    None if the displays are alike after every instruction.
    """
    number = first_different_instruction(first, second) - 1
    # Displays that execute the same instructions are alike.
    display = Replay(first, start).display_at(number)
    other = deepcopy(display)
    for later in range(number + 1, max(len(first), len(second)) + 1):
        words, other_words = (
            stream.words_between(later - 1, later) if later <= len(stream) else NO_WORDS
            for stream in (first, second)
        )
        display.send(words)
        other.send(other_words)
        replies = reply_of(display), reply_of(other)
        # Two displays that were alike before the same instruction are alike after it.
        if np.array_equal(words, other_words):
            continue
        where = dict(_differences(display, other, *replies))
        if where:
            return Difference(later, where)
    return None


def first_different_instruction(first: Stream, second: Stream) -> int:
    """The number of the first instruction whose words differ, or that a single stream has."""
    both = min(len(first), len(second))
    # A row of illegal words may be longer in one of them.
    differing = np.flatnonzero(first.ends[: both + 1] != second.ends[: both + 1])
    number = int(differing[0]) if len(differing) else both + 1
    length = first.ends[number - 1]
    differing = np.flatnonzero(first.words[:length] != second.words[:length])
    return int(np.searchsorted(first.ends, differing[0], side="right")) if len(differing) else number


def _differences(
    first: Ramtek9300, second: Ramtek9300, reply: Words, other_reply: Words
) -> Iterator[tuple[str, Any]]:
    values, other_values = values_of(first), values_of(second)
    for name, value in values.items():
        other = other_values[name]
        if isinstance(value, np.ndarray):
            if not np.array_equal(value, other):
                yield name, _where(name, value, other)
        elif (plain := to_json(value)) != (other_plain := to_json(other)):
            yield name, [plain, other_plain]
    if not np.array_equal(reply, other_reply):
        yield "reply", [reply.tolist(), other_reply.tolist()]


def _where(name: str, one: AnyArray, other: AnyArray) -> Any:
    """Where two arrays differ, in plain values."""
    places = np.argwhere(one != other)
    first = places[0].tolist()
    values = [array[tuple(first)].item() for array in (one, other)]
    if name == "words":
        (top, left), (bottom, right) = places.min(axis=0).tolist(), places.max(axis=0).tolist()
        place = {"window": [left, top, right, bottom], "line": first[0], "element": first[1]}
        return {"count": len(places), **place, "values": values}
    if name == "entries":
        return {"count": len(places), "first": first[0], "values": [f"#{color:06x}" for color in values]}
    return "differ"


def values_of(display: Ramtek9300) -> dict[str, Any]:
    """The state of a display by the names of its values, without its sizes, and the name of its status."""
    values = {name: value for part in display.state().values() for name, value in part.items()}
    for name in ("illegal", "enter_is_pressed", "whole_window", "whole_word"):
        del values[name]
    return values | {"status": str(display.status.name)}


def plain_values(display: Ramtek9300) -> dict[str, Any]:
    """The small values of a display for JSON: parameters, cursors, status."""
    values = values_of(display).items()
    return {name: to_json(value) for name, value in values if not isinstance(value, np.ndarray)}


def to_json(value: Any) -> Any:
    """A value of a state for JSON; an array within it becomes its CRC-32."""
    return to_plain(value, lambda array: f"{zlib.crc32(array.tobytes()):08x}")
