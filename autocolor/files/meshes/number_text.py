"""Numbers in the text of mesh files.

`NumberText` is for formats of numbers separated by white space. It first finds where each number begins. Then
any run of numbers can be converted, counts are compared with the file before memory is allocated, and a wrong
number is refused with its line.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, Numbers, chunks
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.reading import shown

BLOCK: Final = 1 << 17
"""Words to convert at once; blocks of whole numbers are converted faster."""

D_TO_E: Final = bytes.maketrans(b"dD", b"eE")
"""Fortran writes exponents with D."""

DIGITS: Final = b"0123456789 \t\n"

LARGEST_WHOLE: Final = 1 << 53
"""Whole numbers below this are exact in floating point."""

VALUE: Final = "a value must be a decimal number, nan or inf"
COORDINATE: Final = "a coordinate must be a decimal number of at most 1e30 in size"


def parsed(text: bytes, count: int) -> AnyArray:
    """The values of `count` words, which may be nan or inf. Raises ValueError for other words.

    >>> parsed(b"1 2.0D+00 nan", 3).tolist()
    [1.0, 2.0, nan]
    """
    # Some versions of numpy stop at a wrong word in silence, before the zero.
    text = text.translate(D_TO_E) + b" 0"
    if not text.translate(None, DIGITS):
        # Measured: an eighth of the time. A number that does not fit becomes the largest of 64 bits.
        wholes = np.fromstring(text, np.int64, sep=" ")
        if wholes.max() < LARGEST_WHOLE:
            return wholes[:-1]
    values = np.fromstring(text, np.float64, sep=" ")
    if len(values) != count + 1:
        raise ValueError
    return values[:-1]


def decimal(word: bytes) -> float:
    """The value of a number, as `parsed`; NaN for any other word."""
    try:
        return float(parsed(word, 1)[0])
    except ValueError:
        return math.nan


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
        self._bounds = np.append(np.flatnonzero(begins), len(data))
        self.starts: Numbers = self._bounds[:-1]

    def __len__(self) -> int:
        return len(self.starts)

    def line(self, at: int) -> int:
        """The line of a word, from 1."""
        return self.data.count(b"\n", 0, int(self.starts[at])) + self.first_line

    def word(self, at: int) -> bytes:
        """A word."""
        return self._text(at, at + 1).strip()

    def _text(self, first: int, end: int) -> bytes:
        """The words from `first` to before `end`."""
        return self.data[int(self._bounds[first]) : int(self._bounds[end])]

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
                f"{self.place}: there must be {end:,} numbers to the end of the {what}, not {len(self):,};"
                " it is cut short or its counts are wrong"
            )

    def vectors(self, begins: Indices, end: int, width: int = 3) -> Floats:
        """The numbers, (n, width), that begin at each of some ascending words. Raises InputError.

        The first three are coordinates. The others, and the words between them up to the word `end`, may also
        be nan or inf.
        """
        first = int(begins[0])
        values = self.values(first, end - first, COORDINATE)
        vectors: Floats = values[(begins - first)[:, None] + np.arange(width)]
        wrong = np.argwhere(~(np.abs(vectors[:, :3]) <= LARGEST_COORDINATE))
        if len(wrong):
            raise self.wrong(int(begins[wrong[0, 0]] + wrong[0, 1]), COORDINATE)
        return vectors

    def wholes(self, first: int, count: int, what: str) -> Numbers:
        """The whole numbers of some words, below 2^53; `what` names them in messages. Raises InputError."""
        rule = f"{what} must be a whole number"
        values = self.values(first, count, rule)
        is_whole = (np.abs(values) < LARGEST_WHOLE) & (np.floor(values) == values)
        if not is_whole.all():
            raise self.wrong(first + int(is_whole.argmin()), rule)
        return values.astype(np.int64)

    def values(self, first: int, count: int, rule: str = VALUE) -> Floats:
        """The values of some words, which may be nan or inf. Raises InputError for other words."""
        values = np.empty(count)
        for chunk in chunks(first + count, BLOCK, first):
            try:
                numbers = parsed(self._text(chunk.start, chunk.stop), chunk.stop - chunk.start)
            except ValueError:
                for at in range(chunk.start, chunk.stop):
                    try:
                        parsed(self.word(at), 1)
                    except ValueError:
                        raise self.wrong(at, rule) from None
            values[chunk.start - first : chunk.stop - first] = numbers
        return values
