"""Differences: the first instruction after which two streams have made different displays, and where.

Instructions are paired by their numbers. After the end of the shorter stream, its display does not change.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from dataclasses import fields
from typing import Any, NamedTuple

import numpy as np

from ramtek_emu.arrays import AnyArray, Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection.replay import Replay, reply_of
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.instruction import NO_WORDS
from ramtek_emu.memory.parameters import Parameters


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
    display = Replay(first, start).display
    # Displays that execute the same instructions are alike.
    display.send(first.words_between(0, number))
    reply_of(display)
    other = deepcopy(display)
    for later in range(number + 1, max(len(first), len(second)) + 1):
        words, other_words = (_words_of(stream, later) for stream in (first, second))
        replies = _reply_to(display, words), _reply_to(other, other_words)
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
    length = min(first.ends[both], second.ends[both])
    differing = np.flatnonzero(first.words[:length] != second.words[:length])
    place = int(differing[0]) if len(differing) else int(length)
    # Equal words make equal instructions, so the ends of both streams are equal up to this place.
    return int(np.searchsorted(first.ends, place, side="right"))


def _words_of(stream: Stream, number: int) -> Words:
    """The words of an instruction; no words after the end of the stream."""
    return stream.words_between(number - 1, number) if number <= len(stream) else NO_WORDS


def _reply_to(display: Ramtek9300, words: Words) -> Words:
    display.send(words)
    return reply_of(display)


def _differences(
    first: Ramtek9300, second: Ramtek9300, reply: Words, other_reply: Words
) -> Iterator[tuple[str, Any]]:
    differing = _differing(first.words, second.words)
    if len(differing):
        (top, left), (bottom, right) = differing.min(axis=0).tolist(), differing.max(axis=0).tolist()
        line, element = differing[0].tolist()
        yield (
            "words",
            {
                "count": len(differing),
                "window": [left, top, right, bottom],
                "line": line,
                "element": element,
                "values": [int(first.words[line, element]), int(second.words[line, element])],
            },
        )
    differing = _differing(first.lookup_table.packed, second.lookup_table.packed)
    if len(differing):
        entry = int(differing[0, 0])
        yield (
            "entries",
            {
                "count": len(differing),
                "first": entry,
                "values": [f"#{display.lookup_table.packed[entry]:06x}" for display in (first, second)],
            },
        )
    values, other_values = plain_values(first), plain_values(second)
    for name, value in values.items():
        if value != other_values[name]:
            yield name, [value, other_values[name]]
    if not np.array_equal(first.processor.loaded_characters, second.processor.loaded_characters):
        yield "loaded_characters", "differ"
    for number, pair in enumerate(zip(first.cursors.all, second.cursors.all, strict=True)):
        if not np.array_equal(pair[0].shape, pair[1].shape):
            yield f"shape of cursor {number}", "differ"
    if not np.array_equal(reply, other_reply):
        yield "reply", [reply.tolist(), other_reply.tolist()]


def plain_values(display: Ramtek9300) -> dict[str, Any]:
    """The small parts of a display by name, in plain values: parameters, cursors, status."""
    processor = display.processor
    values = plain_parameters(processor.parameters)
    values["saved"] = [plain_parameters(saved) for saved in processor.saved]
    values["cursors"] = [
        {"element": cursor.element, "line": cursor.line, "state": display.cursors.state_of(number)}
        for number, cursor in enumerate(display.cursors.all)
    ]
    values["tracking_devices"] = {str(device): mask for device, mask in display.cursors.driven.items()}
    values["table_address"] = display.lookup_table.address
    values["status"] = str(display.status.name)
    values["illegal_words"] = processor.illegal_words
    values["without_effect"] = processor.unimplemented
    return values


def plain_parameters(parameters: Parameters) -> dict[str, Any]:
    """The parameters by name; those that no instruction changes are left out."""
    return {field.name: getattr(parameters, field.name) for field in fields(parameters) if field.repr}


def _differing(first: AnyArray, second: AnyArray) -> AnyArray:
    """The indices of items that differ, (n, dimensions)."""
    if np.array_equal(first, second):
        return np.zeros((0, first.ndim), np.intp)
    return np.argwhere(first != second)
