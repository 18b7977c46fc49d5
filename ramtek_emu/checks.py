"""Checks of the arguments of Python callers: numbers, words, streams and colors.

The hardware drops bits that do not fit. For a Python program an error names the wrong number instead.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ramtek_emu.arrays import Colors, WholeNumbers, Words
from ramtek_emu.errors import ColorsError, InstructionError, RamtekError, WordsError


def is_whole(value: object) -> bool:
    """Whether a value is a whole number of Python or numpy; True and False are not."""
    # Test for a plain int first: most values are.
    return type(value) is int or (isinstance(value, int | np.integer) and not isinstance(value, bool))


def checked_number(
    value: Any, thing: str, least: int, most: int, advice: str, error: type[RamtekError]
) -> int:
    """The value as an int; raises `error` unless it is a whole number from `least` to `most`.

    >>> checked_number(np.int64(3), "a factor", 1, 16, "choose a smaller one", WordsError)
    3
    """
    if is_whole(value) and least <= value <= most:
        return int(value)
    kind = "" if is_whole(value) else "a whole number from "
    shown = value.item() if isinstance(value, np.generic) else value
    raise error(f"{thing} must be {kind}{least} to {most}, not {shown!r}; {advice}")


def checked_coordinate(value: object, thing: str) -> int:
    """The value as a number that a word holds, with a sign or without one; InstructionError otherwise."""
    return checked_number(value, thing, -0x8000, 0xFFFF, "round or clip it", InstructionError)


def checked_factors(factors: Any, thing: str, advice: str) -> tuple[int, int]:
    """The factors across and down from one number or two, 1 to 16 each; InstructionError otherwise."""
    pair = tuple(factors) if isinstance(factors, Sequence) else (factors, factors)
    if len(pair) != 2:
        raise InstructionError(f"{thing} must be one number or two, not {factors!r}; give both")
    across, down = (checked_number(each, thing, 1, 16, advice, InstructionError) for each in pair)
    return across, down


def whole_numbers(values: object, thing: str, error: type[WordsError] | type[ColorsError]) -> WholeNumbers:
    """The values as an array of whole numbers; raises `error` if they are anything else."""
    try:
        array = np.asarray(values)
    except (ValueError, TypeError, OverflowError):
        array = np.empty(1, np.object_)
    if array.size == 0 and array.dtype.kind == "f":
        array = array.astype(np.uint16)
    if array.dtype.kind not in "ui":
        raise error(f"{thing} must be whole numbers, not {array.dtype}; convert them first, rounding half up")
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
    if isinstance(words, bytes | bytearray | memoryview):
        raise WordsError(
            f"a stream of words must be whole numbers, not {type(words).__name__}; "
            "pass np.frombuffer(data, '<u2') if its low bytes come first"
        )
    array = whole_numbers(words, "a stream of words", WordsError)
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
    if array.ndim != 2 or array.shape[1] != 3:
        raise ColorsError(
            f"colors must be an (n, 3) array of red, green, blue, not of shape {array.shape}; reshape it"
        )
    if len(array) > entries:
        raise ColorsError(
            f"colors must be at most {entries}, as the table's entries, not {len(array)}; send fewer"
        )
    thing = f"the first of {len(array)} entries"
    first = checked_number(first, thing, 0, entries - len(array), "choose entries of the table", ColorsError)
    if array.dtype == np.uint8:
        return array  # type: ignore[return-value]
    if array.size and (array.max() > 255 or array.min() < 0):
        row, column = np.argwhere((array < 0) | (array > 255))[0]
        raise ColorsError(
            f"a color must be 0 to 255, not {array[row, column]} "
            f"(entry {first + row}, {('red', 'green', 'blue')[column]}); clip it first"
        )
    return array.astype(np.uint8)
