"""Listing: the rows of a stream as an inspector lists them, with folded polls, and texts found in them.

A poll is an instruction that reads, such as RCSS. Consecutive polls with equal words are a single row.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from functools import lru_cache
from typing import Final

import numpy as np

from ramtek_emu.inspection.histories import Search
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.disassembler import data_texts, head_text
from ramtek_emu.instruction_set.table import FORMATS

LONGEST_MEANING: Final = 200
"""The most characters of an instruction in a row of the listing."""
POLLS: Final = frozenset(format.opcode for format in FORMATS if format.meaning.startswith("read "))
"""The opcodes of instructions that read."""


def meaning_of(stream: Stream, number: int) -> str:
    """The right side of an instruction's listing in one line, cut after LONGEST_MEANING characters."""
    return _meaning(stream, number, int(stream.ends[number]))


@lru_cache(256)
def _meaning(stream: Stream, number: int, _: int) -> str:
    return whole_meaning_of(stream, number, LONGEST_MEANING)


def whole_meaning_of(stream: Stream, number: int, most: int = sys.maxsize) -> str:
    """The right side of an instruction's listing in one line, cut after `most` characters."""
    item = stream.item(number)
    if item.instruction is None:
        words = " ".join(f"{word:04X}" for word in item.words[:8].tolist())
        return f"raw {words} ; {item.note}"
    text = head_text(item.instruction)
    for _, data in data_texts(item.instruction):
        text += f"  {data}"
        if len(text) > most:
            break
    return text[:most]


def row_at(stream: Stream, number: int) -> range:
    """The instructions in the row of an instruction: equal polls, or itself; 0 is the start."""
    if number == 0:
        return range(1)
    if int(stream.words[stream.ends[number - 1]]) >> 8 not in POLLS:
        return range(number, number + 1)
    return range(number - _equal(stream, number, -1), number + 1 + _equal(stream, number, 1))


def _equal(stream: Stream, number: int, direction: int) -> int:
    """How many instructions before or after an instruction, in a row, have its words."""
    words, place = stream.words_between(number - 1, number), stream.ends[number - 1]
    most, count = (len(stream) - number if direction > 0 else number - 1), 64
    while True:
        steps = direction * np.arange(1, min(count, most) + 1)
        begins = stream.ends[number - 1 + steps]
        places = begins[:, np.newaxis] + np.arange(len(words))
        are_equal = (stream.words.take(places, mode="clip") == words).all(axis=1)
        others = np.flatnonzero(~are_equal | (begins != place + steps * len(words)))
        if len(others) or count >= most:
            return int(others[0]) if len(others) else most
        count *= 8


def rows_from(stream: Stream, number: int, count: int) -> list[range]:
    """So many rows of the listing, the first of them with an instruction in it."""
    rows: list[range] = []
    while len(rows) < count and number <= len(stream):
        rows.append(row_at(stream, number))
        number = rows[-1].stop
    return rows


def moved(stream: Stream, number: int, rows: int) -> int:
    """The first instruction of the row that is so many rows after the row of an instruction, or before."""
    row = row_at(stream, number)
    for _ in range(abs(rows)):
        following = row.stop if rows > 0 else row.start - 1
        if not 0 <= following <= len(stream):
            break
        row = row_at(stream, following)
    return row.start


def pattern_of(text: str) -> re.Pattern[str]:
    """A pattern for rows that have the parts of a text, in their order, as whole words and numbers.

    >>> [bool(pattern_of("wi win=").search(row)) for row in ("WI FORE=7 WIN=0,0..9,9", "ERS WIN=0,0..9,9")]
    [True, False]
    """
    parts = (
        (r"\b" if part[0].isalnum() else "") + re.escape(part) + (r"\b" if part[-1].isalnum() else "")
        for part in text.split()
    )
    return re.compile(".*".join(parts), re.IGNORECASE)


def next_with(stream: Stream, text: str, numbers: Iterable[int]) -> Search[int | None]:
    """The first of some instructions whose whole listing has a text; None if there is none."""
    pattern = pattern_of(text)
    for number in numbers:
        if pattern.search(whole_meaning_of(stream, number)):
            return number
        yield
    return None
