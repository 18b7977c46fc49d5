"""The elements of a PLY file in text: a line for each, which begins with its first property.

Numbers are decimal; `nan` and `inf` are numbers, too, since scalars may be missing. Empty lines are skipped.
Blocks of lines are converted to arrays at once, and looked at line by line only to say what is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import Final, NamedTuple, NoReturn

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Numbers, runs
from autocolor.errors import InputError
from autocolor.files.meshes.ply.columns import Column, Lists, PlyTables, Rows
from autocolor.files.meshes.ply.header import Element, Header
from autocolor.files.reading import shown, text_problem

BLOCK: Final = 1 << 21
"""Bytes converted at a time: enough for numpy to be efficient, and few enough to save memory."""

LONGEST_LINE: Final = 1 << 20
"""Assumed: in bytes; a polygon of a thousand corners with many scalars has a tenth of it."""

MOST_DIGITS: Final = 18
"""The digits of a whole number that surely is one of 64 bits."""

DIGITS: Final = b"0123456789 \t\n"
NUMERIC: Final = DIGITS + b"+-.eE" + b"nNaAiIfFtTyY"
"""What decimal numbers, `nan` and `infinity` are made of; `float` takes nothing else that is made of it."""

NUMBER: Final = re.compile(
    rb"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|(?i:nan|inf|infinity))"
)


class Block(NamedTuple):
    """Some lines that are not empty: all their numbers, and how many each line has."""

    numbers: Floats
    counts: Numbers


def read_text(data: bytes, header: Header, place: str) -> PlyTables:
    """The elements of a file; `place` is its name in messages. Raises InputError."""
    if problem := text_problem(data):
        raise InputError(f"{place}: an ascii PLY file {problem}")
    body = data[header.length :]
    if b"\r" in body:
        body = body.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    lines = TextLines(body, header.lines, place)
    elements: dict[str, Rows] = {}
    row = 0
    for element in header.elements:
        if not element.properties:
            raise InputError(
                f"{place}: an element must have a property, not none: {element.name!r}; export it again"
            )
        columns = _columns(lines, element, row)

        def place_of(at: int, first: int = row) -> str:
            return f"{place}, line {lines.number_of(first + at)}"

        elements[element.name] = Rows(element.count, columns, place_of)
        row += element.count
    left = lines.left()
    return PlyTables(elements, (f"skipped lines after the last element: {left:,}",) if left else ())


class TextLines:
    """The lines of a text that are not empty, taken one block after the other.

    `before` is how many lines of the file stand before the text.
    """

    def __init__(self, text: bytes, before: int, place: str) -> None:
        self.text = text
        self.before = before
        self.place = place
        self.at = 0
        self.taken = 0
        self.kept = Block(np.empty(0), np.empty(0, np.int64))
        # The numbers of lines are only wanted where something is wrong.
        self.line_numbers = cache(self._line_numbers)

    def take(self, most: int) -> Block:
        """The next lines, at most so many; none at the end. Raises InputError if one has no number."""
        while not len(self.kept.counts) and self.at < len(self.text):
            self.kept = self._next_block()
        numbers, counts = self.kept
        if len(counts) > most:
            end = int(counts[:most].sum())
            self.kept = Block(numbers[end:], counts[most:])
            numbers, counts = numbers[:end], counts[:most]
        else:
            self.kept = Block(numbers[:0], counts[:0])
        self.taken += len(counts)
        return Block(numbers, counts)

    def left(self) -> int:
        """How many lines that are not empty were not taken."""
        has_more = len(self.kept.counts) or self.at < len(self.text)
        return len(self.line_numbers()) - self.taken if has_more else 0

    def bytes_left(self) -> int:
        """How many bytes at most were not taken."""
        return len(self.text) - self.at + 1 + 2 * len(self.kept.numbers)

    def number_of(self, row: int) -> int:
        """The number in the file of a line of those that are not empty, counted from 0."""
        return int(self.line_numbers()[row]) + self.before + 1

    def refuse(self, row: int, sentence: str) -> NoReturn:
        """Raise InputError about one of the lines that are not empty."""
        raise InputError(f"{self.place}, line {self.number_of(row)}: {sentence}")

    def _next_block(self) -> Block:
        end = self.text.find(b"\n", min(self.at + BLOCK, len(self.text)))
        block = self.text[self.at :] if end < 0 else self.text[self.at : end + 1]
        self.at += len(block)
        block = block if block.endswith(b"\n") else block + b"\n"
        lines = np.frombuffer(block, np.uint8)
        is_space = lines <= ord(" ")
        ends = np.flatnonzero(lines == ord("\n"))
        if int(np.diff(ends, prepend=-1).max()) > LONGEST_LINE:
            raise InputError(
                f"{self.place}: a line must have at most {LONGEST_LINE:,} bytes, not more; split it"
            )
        counts = _words_a_line(is_space, ends)
        counts = counts[counts > 0]
        numbers = _numbers(block, is_space, int(counts.sum()))
        if numbers is None:
            self._refuse_number(block)
        return Block(numbers, counts)

    def _refuse_number(self, block: bytes) -> NoReturn:
        """Raise InputError about the first word of a block that is no number."""
        row = self.taken
        for line in block.split(b"\n"):
            words = line.split()
            for word in words:
                if not NUMBER.fullmatch(word):
                    self.refuse(row, f"a value must be a decimal number, not {shown(word)}; correct it")
            row += bool(words)
        raise InputError(f"{self.place}: a file must have numbers between spaces; export it again")

    def _line_numbers(self) -> Indices:
        """The numbers, from 0, of the lines that are not empty."""
        text = self.text if self.text.endswith(b"\n") else self.text + b"\n"
        lines = np.frombuffer(text, np.uint8)
        counts = _words_a_line(lines <= ord(" "), np.flatnonzero(lines == ord("\n")))
        return np.flatnonzero(counts)


def _words_a_line(is_space: Booleans, ends: Indices) -> Numbers:
    """The number of words in each line, given by where there is space and where lines end."""
    starts = ~is_space
    starts[1:] &= is_space[:-1]
    return np.add.reduceat(starts, np.concatenate([[0], ends[:-1] + 1]), dtype=np.int64)


def _numbers(block: bytes, is_space: Booleans, count: int) -> Floats | None:
    """The numbers of a block; None if a word is none."""
    longest = int(np.diff(np.flatnonzero(is_space), prepend=-1).max()) - 1
    if longest <= MOST_DIGITS and not block.translate(None, DIGITS):
        # Measured: a tenth of the time of converting word by word. With digits alone, parsing cannot stop.
        return np.fromstring(block, np.int64, sep=" ").astype(np.float64) if count else np.empty(0)
    if block.translate(None, NUMERIC):
        return None
    try:
        return np.fromiter(map(float, block.decode("ascii").split()), np.float64, count)
    except ValueError:
        return None


def _columns(lines: TextLines, element: Element, first: int) -> dict[str, Column]:
    """The columns of an element whose first row is one of the lines that are not empty."""
    # A number has a byte and one after it.
    least = 2 * (element.count * len(element.properties) + element.least_corners)
    if least > lines.bytes_left():
        raise InputError(
            f"{lines.place}: {element.count:,} elements {element.name!r} must have at least {least:,} bytes,"
            f" not {lines.bytes_left():,}; the file is cut short or its header is wrong, export it again"
        )
    pieces: list[list[Column]] = []
    row = 0
    while row < element.count:
        block = lines.take(element.count - row)
        if not len(block.counts):
            raise InputError(
                f"{lines.place}: there must be {element.count:,} elements {element.name!r}, not {row:,}; the"
                " file is cut short or its header is wrong, export it again"
            )
        pieces.append(list(_split(lines, block, element, first + row)))
        row += len(block.counts)
    if not pieces:
        return {
            each.name: Lists(np.empty(0), np.empty(0, np.intp)) if each.count_type else np.empty(0)
            for each in element.properties
        }
    names = [each.name for each in element.properties]
    return dict(zip(names, map(_joined, zip(*pieces, strict=True)), strict=True))


def _joined(pieces: tuple[Column, ...]) -> Column:
    """One column of those of several blocks."""
    lists = [each for each in pieces if isinstance(each, Lists)]
    if lists:
        return Lists(*(np.concatenate(column) for column in zip(*lists, strict=True)))
    return np.concatenate([each for each in pieces if not isinstance(each, Lists)])


def _split(lines: TextLines, block: Block, element: Element, first: int) -> Iterator[Column]:
    """The columns of the lines of a block; the first of them is so many lines after the header."""
    numbers, counts = block
    ends = np.cumsum(counts)
    at = ends - counts
    for each in element.properties:
        missing = np.flatnonzero(at >= ends)
        if len(missing):
            _refuse_width(lines, element, first + int(missing[0]), "has too few")
        values = numbers[at]
        at = at + 1
        if each.count_type is None:
            yield values
            continue
        # A comparison with NaN is false.
        wrong = np.flatnonzero(~((values >= 0) & (values == np.floor(values))))
        if len(wrong):
            row = int(wrong[0])
            lines.refuse(
                first + row,
                f"the count of a list must be a whole number from 0 on, not {values[row]:g}; correct it",
            )
        short = np.flatnonzero(values > ends - at)
        if len(short):
            _refuse_width(lines, element, first + int(short[0]), "has too few")
        count = values.astype(np.intp)
        yield Lists(numbers[_items(at, count)], count)
        at = at + count
    over = np.flatnonzero(at < ends)
    if len(over):
        _refuse_width(lines, element, first + int(over[0]), "has too many")


def _items(at: Indices, count: Indices) -> Indices:
    """The places of the values of lists that begin at some places."""
    filled = count > 0
    return runs(at[filled], count[filled])


def _refuse_width(lines: TextLines, element: Element, row: int, found: str) -> NoReturn:
    names = ", ".join(each.name for each in element.properties[:8])
    more = ", ..." if len(element.properties) > 8 else ""
    lines.refuse(
        row,
        f"a line of an element {element.name!r} must have the values of {names}{more}, and this {found};"
        " correct it",
    )
