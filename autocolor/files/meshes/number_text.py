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

IN_DECIMALS: Final = b"0123456789+-.eEdD \t\n\r\f\v"
IN_WHOLES: Final = b"0123456789+- \t\n\r\f\v"
IN_VALUES: Final = IN_DECIMALS + b"nNaAiIfF"
"""With the letters of nan and inf; `float` accepts no other word of these letters."""

IN_PLY: Final = IN_VALUES + b"tTyY"
"""With the letters of infinity, which C programs write in PLY files."""

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
    """Collects the problems of files, up to MOST_PROBLEMS, in the order of files and lines.

    `unit` is what messages call a line: "line" or "row".
    """

    def __init__(self, unit: str) -> None:
        self._unit = unit
        self._sentences: list[tuple[int, int, str]] = []
        self._places: list[str] = []

    def note(self, place: str, line: int, sentence: str) -> None:
        """Add a problem; raise InputError once there are MOST_PROBLEMS."""
        if place not in self._places:
            self._places.append(place)
        self._sentences.append((self._places.index(place), line, f"{place}, {self._unit} {line}: {sentence}"))
        if len(self._sentences) >= MOST_PROBLEMS:
            self.raise_any()

    def raise_any(self) -> None:
        """Raise InputError with the problems, if any."""
        if self._sentences:
            in_order = sorted(self._sentences, key=lambda each: each[:2])
            raise InputError([sentence for _, _, sentence in in_order])


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
        """A word, cut to 1,000 bytes."""
        start = int(self.starts[at])
        return self.data[start : start + 1000].split(None, 1)[0]

    def wrong(self, at: int, rule: str) -> InputError:
        """The error for a word that breaks a rule, with its line."""
        return InputError(
            f"{self.place}, line {self.line(at)}: {rule}, not {shown(self.word(at))}; correct it"
        )

    def lines(self) -> Indices:
        """The first word of each line that has words."""
        letters = np.frombuffer(self.data, np.uint8)
        ends = np.flatnonzero(letters == ord("\n"))
        begins = letters[np.minimum(ends + 1, max(len(letters) - 1, 0))]
        if ((begins > ord(" ")) | (begins == ord("\n"))).all() and len(self):
            # Measured: if no line is indented, this takes a third of the time of the general case below.
            is_first = letters[self.starts - 1] == ord("\n")
            is_first[0] = True
            return np.flatnonzero(is_first)
        # Two words are on different lines if a line ends between them.
        firsts: Indices = np.searchsorted(self.starts, np.append(0, ends))
        return firsts[(np.diff(firsts, prepend=-1) > 0) & (firsts < len(self))]

    def require(self, end: int, what: str) -> None:
        """Raise InputError if there are fewer than `end` words; `what` names the last of them."""
        if end > len(self):
            raise InputError(
                f"{self.place}: there must be {end:,} numbers up to the end of the {what}, not {len(self):,};"
                " the file is cut short or its counts are wrong"
            )

    def coordinates(self, first: int, count: int) -> Floats:
        """The decimal numbers of some words, each at most 1e30 in size. Raises InputError."""
        values = self._converted(first, count, IN_DECIMALS, COORDINATE, float)
        large = np.flatnonzero(np.abs(values) > LARGEST_COORDINATE)
        if len(large):
            raise self.wrong(first + int(large[0]), COORDINATE)
        return values

    def coordinates_at(self, begins: Indices, end: int) -> Floats:
        """The three coordinates, (n, 3), that begin at each of some ascending words. Raises InputError.

        The other words between them and up to the word `end` may also be nan or inf.
        """
        vectors = self.vectors_at(begins, end)
        wrong = np.argwhere(~(np.abs(vectors) <= LARGEST_COORDINATE))
        if len(wrong):
            raise self.wrong(int(begins[wrong[0, 0]] + wrong[0, 1]), COORDINATE)
        return vectors

    def vectors_at(self, begins: Indices, end: int) -> Floats:
        """The same, for vectors of which any number may be nan or inf."""
        first = int(begins[0])
        values = self._converted(first, end - first, IN_VALUES, COORDINATE, float)
        vectors: Floats = values[(begins - first)[:, None] + np.arange(3)]
        return vectors

    def values(self, first: int, count: int, letters: bytes = IN_VALUES) -> Floats:
        """The values of some words, which may be nan or inf. Raises InputError for other letters."""
        return self._converted(first, count, letters, "a value must be a decimal number, nan or inf", float)

    def wholes(self, first: int, count: int, what: str) -> Numbers:
        """The whole numbers of some words, below 2^63; `what` names them in messages. Raises InputError."""
        return self._converted(first, count, IN_WHOLES, f"{what} must be a whole number", int)

    def _converted(
        self, first: int, count: int, letters: bytes, rule: str, convert: type[float] | type[int]
    ) -> AnyArray:
        """Some words as float64 or int64. Raises InputError for other letters or words."""
        values = np.empty(count, np.float64 if convert is float else np.int64)
        for chunk in chunks(first + count, BLOCK, first):
            end = int(self.starts[chunk.stop]) if chunk.stop < len(self) else len(self.data)
            text = self.data[int(self.starts[chunk.start]) : end]
            longest = int(np.diff(self.starts[chunk], append=end).max())
            if longest <= MOST_DIGITS and not text.translate(None, DIGITS):
                # Measured: a tenth of the time of converting word by word. With digits alone, parsing cannot
                # stop.
                values[chunk.start - first : chunk.stop - first] = np.fromstring(text, np.int64, sep=" ")
                continue
            try:
                if text.translate(None, letters):
                    raise ValueError
                words = text.translate(D_TO_E).decode("ascii").split()
                values[chunk.start - first : chunk.stop - first] = np.fromiter(
                    map(convert, words), values.dtype, len(words)
                )
            except (ValueError, OverflowError):
                raise self.wrong(self._first_wrong(chunk, letters), rule) from None
        return values

    def _first_wrong(self, chunk: slice, letters: bytes) -> int:
        """The first word of a chunk that is not a number of these letters."""
        for at in range(chunk.start, chunk.stop):
            word = self.word(at)
            try:
                number = int(word) if letters == IN_WHOLES else float(word.translate(D_TO_E))
                if word.translate(None, letters) or (letters == IN_WHOLES and abs(number) >= 1 << 63):
                    return at
            except ValueError:
                return at
        # The words are numbers as far as `word` shows them: the longest is too long.
        lengths = np.diff(self.starts[chunk], append=math.inf)
        start: int = chunk.start
        return start + int(lengths.argmax())
