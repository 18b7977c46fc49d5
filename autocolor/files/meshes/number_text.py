"""Numbers in the text of mesh files, and the problems of their lines.

`NumberText` is for formats of numbers separated by white space. It first finds where each number begins. Then
any run of numbers can be converted, counts are compared with the file before memory is allocated, and a wrong
number is refused with its line.
"""

from __future__ import annotations

import math
import re
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, Numbers, chunks
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.reading import shown

MOST_PROBLEMS: Final = 20
"""Limit: problems reported for one mesh file; a file with more usually repeats the same one."""

NUMBER: Final = re.compile(rb"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
"""A decimal number. `float` would accept more, such as digits of other scripts."""

BLOCK: Final = 1 << 17
"""Numbers to convert at once, so that there are few Python values at a time."""

D_TO_E: Final = bytes.maketrans(b"dD", b"eE")
"""Fortran writes exponents with D."""

IN_WHOLES: Final = b"0123456789+- \t\n\r\f\v"
IN_VALUES: Final = IN_WHOLES + b".eEdDnNaAiIfFtTyY"
"""With the letters of nan, inf and infinity; `float` accepts no other word of these letters."""

DIGITS: Final = b"0123456789 \t\n"
MOST_DIGITS: Final = 18
"""Any whole number with this many digits fits in 64 bits."""

COORDINATE: Final = "a coordinate must be a decimal number of at most 1e30 in size"


def decimal(word: bytes) -> float:
    """The value of a decimal number, whose exponent may be written with D; NaN for any other word.

    >>> decimal(b"2.0D+00"), decimal(b"1_0")
    (2.0, nan)
    """
    word = word.translate(D_TO_E)
    return float(word) if NUMBER.fullmatch(word) else math.nan


class Problems:
    """Collects the problems of a file, up to MOST_PROBLEMS, in the order of its lines.

    `unit` is what messages call a line: "line" or "row".
    """

    def __init__(self, unit: str) -> None:
        self._unit = unit
        self._sentences: list[tuple[int, str]] = []

    def note(self, place: str, line: int, sentence: str) -> None:
        """Add a problem; raise InputError once there are MOST_PROBLEMS."""
        self._sentences.append((line, f"{place}, {self._unit} {line}: {sentence}"))
        if len(self._sentences) >= MOST_PROBLEMS:
            self.raise_any()

    def raise_any(self) -> None:
        """Raise InputError with the problems, if any."""
        if self._sentences:
            raise InputError(sentence for _, sentence in sorted(self._sentences, key=lambda each: each[0]))


GROWTH: Final = 3
"""Measured: how many times its size a text takes until its words are counted."""

BYTES_OF_WORD: Final = 40
"""Measured: bytes that a word takes until its mesh is made; a word of a Movie.BYU file takes a bit less."""


class NumberText:
    """The text of a file, `data`, and where its words begin, `starts`; `place` is its name in messages.

    If the text is a part of a file, `first_line` is the line in which it begins. Raises InputError if a mesh
    of so many words takes more memory than the budget allows.
    """

    def __init__(self, data: bytes, place: str, first_line: int = 1) -> None:
        self.data = data
        self.place = place
        self.first_line = first_line
        is_word = np.frombuffer(data, np.uint8) > ord(" ")
        begins = is_word.copy()
        np.greater(is_word[1:], is_word[:-1], out=begins[1:])
        words = int(np.count_nonzero(begins))
        require_memory(
            len(data) + BYTES_OF_WORD * words, f"{place}: to read {words:,} words", "split or simplify it"
        )
        self.starts: Numbers = np.flatnonzero(begins)

    def __len__(self) -> int:
        return len(self.starts)

    def line(self, at: int) -> int:
        """The line of a word, from 1."""
        return self.data.count(b"\n", 0, int(self.starts[at])) + self.first_line

    def word(self, at: int) -> bytes:
        """A word."""
        end = int(self.starts[at + 1]) if at + 1 < len(self) else len(self.data)
        return self.data[int(self.starts[at]) : end].split()[0]

    def wrong(self, at: int, rule: str) -> InputError:
        """The error for a word that breaks a rule, with its line."""
        return InputError(
            f"{self.place}, line {self.line(at)}: {rule}, not {shown(self.word(at))}; correct it"
        )

    def lines(self) -> Indices:
        """The first word of each line that has words."""
        # Two words are on different lines if a line ends between them.
        ends = np.flatnonzero(np.frombuffer(self.data, np.uint8) == ord("\n"))
        firsts: Indices = np.searchsorted(self.starts, np.append(0, ends))
        return firsts[(np.diff(firsts, prepend=-1) > 0) & (firsts < len(self))]

    def require(self, end: int, what: str) -> None:
        """Raise InputError if there are fewer than `end` words; `what` names the last of them."""
        if end > len(self):
            raise InputError(
                f"{self.place}: there must be {end:,} numbers up to the end of the {what}, not {len(self):,};"
                " the file is cut short or its counts are wrong"
            )

    def vectors(self, begins: Indices, end: int, width: int = 3) -> Floats:
        """The numbers, (n, width), that begin at each of some ascending words. Raises InputError.

        The first three are coordinates. The others, and the words between them up to the word `end`, may also
        be nan or inf.
        """
        first = int(begins[0])
        values = self._converted(first, end - first, IN_VALUES, COORDINATE, float)
        vectors: Floats = values[(begins - first)[:, None] + np.arange(width)]
        wrong = np.argwhere(~(np.abs(vectors[:, :3]) <= LARGEST_COORDINATE))
        if len(wrong):
            raise self.wrong(int(begins[wrong[0, 0]] + wrong[0, 1]), COORDINATE)
        return vectors

    def values(self, first: int, count: int) -> Floats:
        """The values of some words, which may be nan or inf. Raises InputError for other words."""
        return self._converted(first, count, IN_VALUES, "a value must be a decimal number, nan or inf", float)

    def wholes(self, first: int, count: int, what: str) -> Numbers:
        """The whole numbers of some words, below 2^63; `what` names them in messages. Raises InputError."""
        return self._converted(first, count, IN_WHOLES, f"{what} must be a whole number", int)

    def _converted(
        self, first: int, count: int, letters: bytes, rule: str, convert: type[float] | type[int]
    ) -> AnyArray:
        """Some words as float64 or int64. Raises InputError for other letters or words."""

        def converted(text: bytes) -> AnyArray:
            if text.translate(None, letters):
                raise ValueError
            words = text.translate(D_TO_E).decode("ascii").split()
            return np.fromiter(map(convert, words), values.dtype, len(words))

        values = np.empty(count, np.float64 if convert is float else np.int64)
        for chunk in chunks(first + count, BLOCK, first):
            end = int(self.starts[chunk.stop]) if chunk.stop < len(self) else len(self.data)
            text = self.data[int(self.starts[chunk.start]) : end]
            longest = int(np.diff(self.starts[chunk], append=end).max())
            rows = slice(chunk.start - first, chunk.stop - first)
            if longest <= MOST_DIGITS and not text.translate(None, DIGITS):
                # Measured: a tenth of the time of converting word by word. With digits alone, parsing cannot
                # stop.
                values[rows] = np.fromstring(text, np.int64, sep=" ")
                continue
            try:
                values[rows] = converted(text)
            except (ValueError, OverflowError):
                for at in range(chunk.start, chunk.stop):
                    try:
                        converted(self.word(at))
                    except (ValueError, OverflowError):
                        raise self.wrong(at, rule) from None
        return values
