"""Plain values: the state of a part of the display as values for JSON, and back with all values checked.

A pattern tells what each value must be: its type, its length, its fields. It is the same state of a display
that was just switched on. So a value that was read from a file fits, or raises an error that names it.
"""

from __future__ import annotations

import base64
import binascii
import zlib
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import AnyArray
from ramtek_emu.errors import SnapshotError
from ramtek_emu.memory.scan_orders import Point, Window

WORD: Final = (-0x8000, 0xFFFF)
COORDINATE: Final = (-0x8000, 0x7FFF)
COUNT: Final = (0, 1 << 62)
LIMITS: Final = {
    "conic": (-(1 << 31), (1 << 32) - 1),
    "zoom": (1, 16),
    "nanoseconds": COUNT,
    "illegal_words": COUNT,
    "named_only": COUNT,
    "line": (-0x8000, 1 << 30),
    "blink_fields": (1, 1 << 30),
    "blanked_lines": (0, 1 << 16),
    "instruction": (0, 1 << 30),
    "word": (0, 1 << 30),
    "pixel": (0, 1 << 30),
    "address": (0, 0xFFFF),
}
"""The limits of numbers that are not words, by the name of the field in the file."""


def plain(value: Any) -> Any:
    """The value as JSON can hold it: arrays of dots and words in base64, dataclasses as objects."""
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, np.ndarray):
        data = np.packbits(value) if value.dtype == np.bool_ else value.astype("<u2")
        return base64.b64encode(data.tobytes()).decode("ascii")
    if is_dataclass(value) and not isinstance(value, type):
        return {each.name: plain(getattr(value, each.name)) for each in fields(value)}
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, tuple | list):
        return [plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def restored(pattern: Any, value: Any, place: str) -> Any:
    """The value converted to the type of the pattern; SnapshotError names the place that does not fit."""
    if isinstance(pattern, Enum):
        return _named(pattern, value, place)
    if isinstance(pattern, np.ndarray):
        return _array(pattern, value, place)
    if isinstance(pattern, bool | str | None):
        if type(value) is not type(pattern) or (isinstance(value, str) and not _is_a_name(value)):
            raise refusal(place, "a name" if isinstance(pattern, str) else "true or false", value)
        return value
    if isinstance(pattern, int):
        return whole_number(value, LIMITS.get(place.rpartition(".")[2].partition("[")[0], WORD), place)
    if isinstance(pattern, Point | Window):
        if not isinstance(value, list) or len(value) != len(pattern):
            raise refusal(place, f"{len(pattern)} numbers", value)
        return type(pattern)(*(whole_number(number, COORDINATE, place) for number in value))
    if is_dataclass(pattern) and not isinstance(pattern, type):
        names = [each.name for each in fields(pattern)]
        if not isinstance(value, dict) or set(value) != set(names):
            raise refusal(place, f"an object of {', '.join(names)}", value)
        return replace(
            pattern,
            **{name: restored(getattr(pattern, name), value[name], f"{place}.{name}") for name in names},
        )
    if isinstance(pattern, tuple):
        if not isinstance(value, list) or len(value) != len(pattern):
            raise refusal(place, f"{len(pattern)} items", value)
        pairs = enumerate(zip(pattern, value, strict=True))
        return tuple(restored(kind, item, f"{place}[{number}]") for number, (kind, item) in pairs)
    raise TypeError(f"a state must be made of plain values, not {type(pattern).__name__} ({place})")


def packed(data: bytes) -> str:
    """Bytes as compressed text."""
    return base64.b64encode(zlib.compress(data, 6)).decode("ascii")


def unpacked(text: Any, size: int, place: str) -> bytes:
    """The bytes of such a text, which must be `size` many; never more than one byte beyond is unpacked."""
    unpacker = zlib.decompressobj()
    try:
        data = unpacker.decompress(base64.b64decode(text, validate=True), size + 1)
    except (binascii.Error, zlib.error, ValueError, TypeError):
        data = b""
    if len(data) != size or not unpacker.eof:
        raise refusal(place, f"{size} packed bytes", text)
    return data


def listed(pattern: Any, value: Any, place: str, most: int) -> list[Any]:
    """A list of at most `most` items, each converted to the type of the pattern."""
    if not isinstance(value, list) or len(value) > most:
        raise refusal(place, f"a list of at most {most}", value)
    return [restored(pattern, item, f"{place}[{number}]") for number, item in enumerate(value)]


def whole_number(value: Any, limits: tuple[int, int], place: str) -> int:
    """The value, if it is a whole number within the limits; SnapshotError if not."""
    if isinstance(value, bool) or not isinstance(value, int) or not limits[0] <= value <= limits[1]:
        raise refusal(place, f"a whole number from {limits[0]} to {limits[1]}", value)
    return value


def refusal(place: str, rule: str, value: Any) -> SnapshotError:
    """The error for a value that does not fit."""
    text = repr(value)
    text = text if len(text) <= 60 else f"{text[:60]}..."
    return SnapshotError(f"{place} of a snapshot must be {rule}, not {text}; take a new one with --snapshot")


def _is_a_name(text: str) -> bool:
    return 1 <= len(text) <= 60 and text.isascii() and text.isprintable()


def _named(pattern: Enum, value: Any, place: str) -> Enum:
    kinds = type(pattern).__members__
    if not isinstance(value, str) or value not in kinds:
        raise refusal(place, f"one of {', '.join(kinds)}", value)
    return kinds[value]


def _array(pattern: AnyArray, value: Any, place: str) -> AnyArray:
    dots = pattern.dtype == np.bool_
    size = (pattern.size + 7) // 8 if dots else 2 * pattern.size
    try:
        data = base64.b64decode(value, validate=True) if isinstance(value, str) else b""
    except (binascii.Error, ValueError):
        data = b""
    if len(data) != size:
        raise refusal(place, f"{size} bytes in base64", value)
    if dots:
        return (
            np.unpackbits(np.frombuffer(data, np.uint8), count=pattern.size)
            .astype(np.bool_)
            .reshape(pattern.shape)
        )
    return np.frombuffer(data, "<u2").astype(pattern.dtype).reshape(pattern.shape)
