"""Checks of the arguments of Python callers: numbers, words, streams and colors.

The hardware drops bits that do not fit. For a Python program an error names the wrong number instead.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from ramtek_emu.arrays import Colors, WholeNumbers, Words
from ramtek_emu.errors import ColorsError, InstructionError, RamtekError, WordsError

BYTE: Final = np.dtype(np.uint8)


def is_whole(value: object) -> bool:
    """Whether a value is a whole number of Python or numpy; True and False are not."""
    # Test for a plain int first: most values are.
    return type(value) is int or (isinstance(value, int | np.integer) and not isinstance(value, bool))


def checked_number(
    value: object, thing: str, least: int, most: int, advice: str, error: type[RamtekError]
) -> int:
    """The value as an int; raises `error` unless it is a whole number from `least` to `most`.

    >>> checked_number(np.int64(3), "a factor", 1, 16, "choose a smaller one", WordsError)
    3
    """
    shown = value.item() if isinstance(value, np.generic) else value
    if not isinstance(shown, int) or isinstance(shown, bool):
        raise error(f"{thing} must be a whole number from {least} to {most}, not {shown!r}; {advice}")
    if not least <= shown <= most:
        raise error(f"{thing} must be {least} to {most}, not {shown}; {advice}")
    return shown


def checked_coordinate(value: object, thing: str) -> int:
    """The value as an element or a line, perhaps outside the memory; InstructionError if no word holds it."""
    return checked_number(value, thing, -0x8000, 0xFFFF, "round or clip it", InstructionError)


def checked_cursor(number: object) -> int:
    """The value as a cursor number, 0 to 255; InstructionError if it is not."""
    return checked_number(number, "a cursor's number", 0, 255, "choose one there is", InstructionError)


def checked_table_address(address: object) -> int:
    """The value as a word address of the lookup table; InstructionError if no word holds it."""
    return checked_number(address, "a table's address", 0, 0xFFFF, "count in words", InstructionError)


def checked_size(size: object) -> tuple[int, int]:
    """The size factors of text, across and down, from one or two numbers; InstructionError otherwise."""
    factors = tuple(size) if isinstance(size, Sequence) else (size, size)
    if len(factors) != 2:
        raise InstructionError(f"the size of text must be one number or two, not {size!r}; give both")
    across, down = (
        checked_number(factor, "the size of text", 1, 16, "write it smaller", InstructionError)
        for factor in factors
    )
    return across, down


def whole_numbers(values: object, thing: str, error: type[WordsError] | type[ColorsError]) -> WholeNumbers:
    """The values as an array of whole numbers; raises `error` if they are anything else."""
    try:
        array = np.asarray(values)
    except (ValueError, TypeError, OverflowError) as cause:
        raise error(
            f"{thing} must be an array of whole numbers, not {type(values).__name__}; pass a numpy array"
        ) from cause
    if array.size == 0 and array.dtype.kind == "f":
        array = array.astype(np.uint16)
    if array.dtype.kind not in "ui":
        if array.dtype.kind in "fb":
            raise error(
                f"{thing} must be whole numbers, not {array.dtype}; convert them first, rounding half up"
            )
        other = "objects" if array.ndim else type(values).__name__
        kind = {"U": "text", "S": "bytes"}.get(array.dtype.kind, other)
        raise error(f"{thing} must be whole numbers, not {kind}; pass a list or an array of them")
    return array


def checked_words(words: object, planes: int = 10) -> Words:
    """The words as a (lines, elements) uint16 array; WordsError if a word has more bits than `planes`.

    >>> checked_words([[1024]])
    Traceback (most recent call last):
    ramtek_emu.errors.WordsError: a word must be 0 to 1023, not 1024 (line 0, element 0); use fewer levels
    """
    array = whole_numbers(words, "words", WordsError)
    if array.ndim != 2 or 0 in array.shape:
        raise WordsError(
            f"words must be a (lines, elements) array with at least one word, not of shape {array.shape}; "
            "pass words[np.newaxis] for one line"
        )
    largest = (1 << planes) - 1
    if array.max() > largest or (array.dtype.kind == "i" and array.min() < 0):
        line, element = np.argwhere((array < 0) | (array > largest))[0]
        raise WordsError(
            f"a word must be 0 to {largest}, not {array[line, element]} "
            f"(line {line}, element {element}); use fewer levels"
        )
    return array.astype(np.uint16, copy=False)


def checked_stream(words: object) -> Words:
    """A stream of 16-bit words as a flat uint16 array; such an array is returned unchanged."""
    if isinstance(words, np.ndarray) and words.dtype == np.uint16 and words.ndim == 1:
        return words
    if isinstance(words, bytes | bytearray) or (isinstance(words, memoryview) and words.itemsize == 1):
        raise WordsError(
            f"a stream of words must be whole numbers, not {type(words).__name__}; "
            "pass np.frombuffer(data, '<u2') if its low bytes come first"
        )
    array = whole_numbers(words, "a stream of words", WordsError)
    if array.ndim == 0:
        raise WordsError(f"a stream of words must be one row, not the number {array}; put it in a list")
    if array.ndim != 1:
        raise WordsError(f"a stream of words must be one row, not of shape {array.shape}; flatten it first")
    if array.size and (array.max() > 0xFFFF or array.min() < 0):
        (place,) = np.argwhere((array < 0) | (array > 0xFFFF))[0]
        raise WordsError(
            f"a word of a stream must be 0 to 65535, not {array[place]} (word {place}); mask it to 16 bits"
        )
    return array.astype(np.uint16)


def checked_colors(first: int, colors: object, entries: int = 1024) -> Colors:
    """The (n, 3) colors as uint8; ColorsError if a number is not 0 to 255 or a color has no entry."""
    array = whole_numbers(colors, "colors", ColorsError)
    if array.shape == (0,):
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ColorsError(
            f"colors must be an (n, 3) array of red, green, blue, not of shape {array.shape}; reshape it"
        )
    if not is_whole(first) or not 0 <= first < entries:
        raise ColorsError(
            f"the first entry must be 0 to {entries - 1}, not {first!r}; choose an entry of the table"
        )
    first = int(first)
    if first + len(array) > entries:
        raise ColorsError(
            f"a run of entries must end at {entries - 1}, not {first + len(array) - 1} "
            f"({len(array)} from {first} on); send fewer"
        )
    if array.dtype == BYTE:
        return array  # type: ignore[return-value]
    if array.size and (array.max() > 255 or array.min() < 0):
        row, column = np.argwhere((array < 0) | (array > 255))[0]
        raise ColorsError(
            f"a color must be 0 to 255, not {array[row, column]} "
            f"(entry {first + row}, {('red', 'green', 'blue')[column]}); clip it first"
        )
    return array.astype(np.uint8)
