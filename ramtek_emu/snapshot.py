"""Snapshots: a display in a 16-bit PNG file, with its words as pixels and all other state in text chunks.

What is saved: the configuration, the words, the lookup table and its address counter, the current parameters
and the saved ones, loaded characters, cursors and switches, the status, the time and the image on the
monitor. What is **not**: the words of an incomplete instruction, and unread replies; both belong to a host,
and the file has none.

The pixels are the words themselves, so that any program for 16-bit gray pictures can read them. The picture
looks dark, since only ten of sixteen bits are used. The texts are JSON. A value that is read must have the
type, the length and the fields of the same value in a new display, or the error names the place.

Snapshots may come from anywhere, so every size is checked before memory of that size is used: the file, the
picture, the texts and the unpacked values.
"""

from __future__ import annotations

import base64
import binascii
import json
import os
import warnings
import zlib
from collections.abc import Callable, Mapping
from dataclasses import fields as fields_of
from io import BytesIO
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import AnyArray, Words
from ramtek_emu.configuration import Configuration, EntryFormat
from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import ConfigurationError, MissingInputError, SnapshotError, reason_of
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.png import chunks
from ramtek_emu.processor.environment_executors import MOST_SAVED
from ramtek_emu.timing import Timing
from ramtek_emu.writing import PNG, check_suffix, write_atomically

SOFTWARE: Final = "ramtek_emu snapshot 1"
"""The text chunk `Software`; the number is the version of the format."""
TEXTS: Final[dict[str, tuple[str, ...]]] = {
    "lookup table": ("address", "entries"),
    "parameters": ("now", "saved"),
    "processor": ("loaded_characters", "illegal", "illegal_words", "named_only", "nanoseconds"),
    "cursors": ("all", "track", "enter_is_pressed", "driven"),
    "glass": ("lines", "pixels"),
}
"""The text chunks and their fields; "glass" only with a beam."""
NAMES: Final = {
    "address": "table_address",
    "now": "parameters",
    "named_only": "without_effect",
    "all": "cursors",
    "driven": "tracking_devices",
    "lines": "lines_painted",
    "pixels": "monitor_image",
}
"""The names in `Ramtek9300.state()` of the fields that have another name there."""


def write_snapshot(display: Ramtek9300, path: str | PathLike[str], overwrite: bool = False) -> None:
    """Write a snapshot of a display to a PNG file, whole or not at all.

    Raises OutputError for a name that does not end in .png, and if no file can be created there;
    OutputExistsError if the file exists and `overwrite` is false; WriteError if writing fails.
    """
    check_suffix(path, PNG, "a snapshot")
    write_atomically(path, snapshot_bytes(display), overwrite=overwrite)


def read_snapshot(path: str | PathLike[str]) -> Ramtek9300:
    """The display of a snapshot file; MissingInputError if it cannot be read, SnapshotError if not valid."""
    try:
        # A pipe might never end.
        if not Path(path).is_file():
            raise OSError("there is none")
        with open(path, "rb") as file:
            data = file.read(MOST_FILE + 1)
    except (OSError, ValueError) as cause:
        raise MissingInputError(
            f"a snapshot must be a file that can be read, not {os.fspath(path)!r} ({reason_of(cause)}); "
            "check the name"
        ) from None
    if len(data) > MOST_FILE:
        raise refusal(f"have at most {MOST_FILE} bytes", f"more ({os.fspath(path)})")
    return display_of(data)


def snapshot_bytes(display: Ramtek9300) -> bytes:
    """The display as the bytes of a PNG file."""
    values, configuration = _values(display), display.configuration
    timing = configuration.timing and vars(configuration.timing)
    kinds = {"entry_format": configuration.entry_format.name, "timing": timing}
    plain: dict[str, Any] = {"configuration": vars(configuration) | kinds}
    for keyword, names in TEXTS.items():
        if keyword != "glass" or timing:
            plain[keyword] = {name: to_plain(values[NAMES.get(name, name)]) for name in names}
    texts = {keyword: json.dumps(text, separators=(",", ":")) for keyword, text in plain.items()}
    return picture_bytes(display.words, {"Software": SOFTWARE} | texts)


def _values(display: Ramtek9300) -> dict[str, Any]:
    """The state of a display by the names of its values, the parameters as one; without a beam, time is 0."""
    parts = display.state()
    values: dict[str, Any] = {"nanoseconds": 0, "parameters": parts.pop("parameters")}
    return values | {name: value for part in parts.values() for name, value in part.items()}


def display_of(data: bytes) -> Ramtek9300:
    """The display of a snapshot; SnapshotError if the bytes are no valid snapshot."""
    words, texts = picture_of(data)
    if texts.get("Software") != SOFTWARE:
        raise refusal(f"be of the format {SOFTWARE!r}", repr(texts.get("Software", "unknown")[:40]))
    configuration = configuration_of(_object(texts, "configuration"))
    if words.shape != (configuration.lines, configuration.elements):
        raise refusal(
            f"have {configuration.elements} x {configuration.lines} words, as its configuration says",
            f"{words.shape[1]} x {words.shape[0]}",
        )
    whole_number(int(words.max()), (0, configuration.largest_word), "a word")
    display = Ramtek9300(configuration)
    values = _values(display)
    values |= {"words": words, "saved": [values["parameters"]]}
    for keyword, fields in TEXTS.items():
        if keyword != "glass" or configuration.timing is not None:
            given = _object(texts, keyword, *fields)
            for field in fields:
                name = NAMES.get(field, field)
                values[name] = from_plain(values[name], given[field], name)
    state = {part: {name: values.get(name) for name in names} for part, names in display.state().items()}
    display.restore(state | {"parameters": values["parameters"]})
    return display


def configuration_of(plain: dict[str, Any]) -> Configuration:
    """The configuration of plain values; SnapshotError if they are not valid."""
    name, timing = plain.get("name"), plain.get("timing")
    if not isinstance(name, str) or not (1 <= len(name) <= 60 and name.isascii() and name.isprintable()):
        raise value_refusal("configuration.name", "a name", name)
    try:
        written: Any = plain["entry_format"]
        entry_format = EntryFormat.__members__.get(written, written)
        kinds = {"entry_format": entry_format, "timing": timing and Timing(**timing)}
        return Configuration(**plain | kinds)
    except (KeyError, TypeError):
        names = ", ".join(field.name for field in fields_of(Configuration))
        raise value_refusal("the configuration", f"an object of {names}", plain) from None
    except ConfigurationError as cause:
        raise SnapshotError(
            f"a snapshot must have a configuration that can be built: {str(cause)[:400]}"
        ) from None


def _object(texts: dict[str, str], keyword: str, *names: str) -> dict[str, Any]:
    """The JSON object of a text chunk; SnapshotError if it is missing or its fields are not `names`."""
    try:
        values = json.loads(texts.get(keyword, "null"))
    except (ValueError, RecursionError):
        values = None
    if not isinstance(values, dict) or (names and set(values) != set(names)):
        raise refusal(
            f"have a text {keyword!r} that says {', '.join(names) or 'what it is'}",
            repr(texts.get(keyword, "none")[:40]),
        )
    return values


WORD: Final = (0, 0xFFFF)
COORDINATE: Final = (-0x8000, 0x7FFF)
SCREEN: Final = (-(1 << 17), 1 << 17)
COUNT: Final = (0, 1 << 62)
LIMITS: Final = {
    "conic": (-(1 << 31), (1 << 32) - 1),
    "zoom": (1, 16),
    "element": SCREEN,
    "line": SCREEN,
    "nanoseconds": COUNT,
    "illegal_words": COUNT,
    "without_effect": COUNT,
    "lines_painted": COUNT,
}
"""The limits of numbers that are not words, by name."""
MOST_LISTED: Final = {"saved": MOST_SAVED, "tracking_devices": 256}
"""Limit: the most items of a list, by name."""


def packed(array: AnyArray) -> str:
    """An array as base64: dots as bits, the monitor image deflated, without the bytes that are 0."""
    data = np.packbits(array).tobytes() if array.dtype == np.bool_ else array.tobytes()
    if array.ndim == 2 and array.dtype == np.uint32:
        data = zlib.compress(array.view(np.uint8).reshape(-1, 4)[:, :3].tobytes(), 6)
    return base64.b64encode(data).decode("ascii")


def to_plain(value: Any, text_of: Callable[[AnyArray], str] = packed) -> Any:
    """A value of a state for JSON; `text_of` makes arrays to texts."""
    if isinstance(value, np.ndarray):
        return text_of(value)
    if isinstance(value, dict):
        return {key: to_plain(item, text_of) for key, item in value.items()}
    return [to_plain(item, text_of) for item in value] if isinstance(value, tuple | list) else value


def from_plain(pattern: Any, value: Any, place: str) -> Any:
    """The value converted to the type of the pattern; SnapshotError names the place of a wrong value.

    The pattern is the same value of another display, or a list of one item.
    """
    name = place.rpartition(".")[2].partition("[")[0]
    if isinstance(pattern, np.ndarray):
        return _array(pattern, value, place)
    if isinstance(pattern, dict):
        if not isinstance(value, dict) or set(value) != set(pattern):
            raise value_refusal(place, f"an object of {', '.join(pattern)}", value)
        return {key: from_plain(pattern[key], value[key], f"{place}.{key}") for key in pattern}
    if isinstance(pattern, list):
        if not isinstance(value, list) or len(value) > MOST_LISTED[name]:
            raise value_refusal(place, f"a list of at most {MOST_LISTED[name]}", value)
        return [from_plain(pattern[0], item, f"{place}[{number}]") for number, item in enumerate(value)]
    if isinstance(pattern, tuple):
        if not isinstance(value, list) or len(value) != len(pattern):
            raise value_refusal(place, f"{len(pattern)} items", value)
        if isinstance(pattern, Point | Window):
            return type(pattern)(*(whole_number(number, COORDINATE, place) for number in value))
        pairs = enumerate(zip(pattern, value, strict=True))
        return tuple(from_plain(kind, item, f"{place}[{number}]") for number, (kind, item) in pairs)
    if isinstance(pattern, bool):
        if not isinstance(value, bool):
            raise value_refusal(place, "true or false", value)
        return value
    return whole_number(value, LIMITS.get(name, WORD), place)


def whole_number(value: Any, limits: tuple[int, int], place: str) -> int:
    """The value; SnapshotError unless it is a whole number within the limits."""
    if isinstance(value, bool) or not isinstance(value, int) or not limits[0] <= value <= limits[1]:
        raise value_refusal(place, f"a whole number from {limits[0]} to {limits[1]}", value)
    return value


def value_refusal(place: str, rule: str, value: Any) -> SnapshotError:
    """The error for a wrong value at a place of the state."""
    text = repr(value)
    text = text if len(text) <= 60 else f"{text[:60]}..."
    return refusal(f"be {rule}", text, f"{place} of a snapshot")


def refusal(rule: str, value: str, thing: str = "a snapshot") -> SnapshotError:
    """The error for a file that is no valid snapshot."""
    return SnapshotError(f"{thing} must {rule}, not {value}; take a new one with --snapshot")


def _array(pattern: AnyArray, value: Any, place: str) -> AnyArray:
    """The array in a text as long as that of the pattern; unpacks at most one byte more."""
    is_image, is_dots = pattern.ndim == 2 and pattern.dtype == np.uint32, pattern.dtype == np.bool_
    size = 3 * pattern.size if is_image else (pattern.size + 7) // 8 if is_dots else pattern.nbytes
    try:
        data = base64.b64decode(value, validate=True)
        if is_image:
            unpacker = zlib.decompressobj()
            data = unpacker.decompress(data, size + 1) * unpacker.eof
    except (binascii.Error, zlib.error, ValueError, TypeError):
        data = b""
    if len(data) != size:
        raise value_refusal(place, f"{size} bytes in base64", value)
    array = np.frombuffer(data, np.uint8)
    if is_dots:
        array = np.unpackbits(array, count=pattern.size)
    elif is_image:
        array = np.pad(array.reshape(-1, 3), ((0, 0), (0, 1)))
    return array.view(pattern.dtype).reshape(pattern.shape)


MOST_FILE: Final = 48 << 20
"""Limit: the longest file, in bytes."""
MOST_SIDE: Final = 4096
"""Limit: the most elements, and the most lines."""
MOST_TEXT: Final = 8 << 20
"""Limit: the most bytes of all texts together."""
MOST_CHUNKS: Final = 1 << 13
"""Limit: the most chunks; pixels in chunks of 8 KB, as by libpng, take at most half of them."""


def picture_bytes(words: Words, texts: Mapping[str, str]) -> bytes:
    """A PNG file of (lines, elements) words, 16 bits gray, and of ASCII texts by keyword."""
    from PIL import Image
    from PIL.PngImagePlugin import PngInfo

    buffer, info = BytesIO(), PngInfo()
    for keyword, text in texts.items():
        info.add_text(keyword, text)
    Image.fromarray(np.ascontiguousarray(words)).save(buffer, "PNG", pnginfo=info)
    return buffer.getvalue()


def picture_of(data: bytes) -> tuple[Words, dict[str, str]]:
    """The words and the texts of a PNG file of 16-bit grays; SnapshotError if it is not valid."""
    from PIL import Image

    try:
        # Pillow checks no checksums of pixels.
        kinds = [kind for kind, _ in islice(chunks(data), MOST_CHUNKS)]
        if kinds[-1:] != [b"IEND"]:
            raise refusal(f"end within {MOST_CHUNKS} chunks", "go on")
        with (
            warnings.catch_warnings(action="error"),
            Image.open(BytesIO(data), formats=["PNG"]) as picture,
        ):
            if not picture.mode.startswith("I"):
                raise refusal("be 16 bits gray", "another kind of picture")
            if max(picture.size) > MOST_SIDE:
                raise refusal(f"be 1 to {MOST_SIDE} elements and lines", "{} x {}".format(*picture.size))
            words = np.array(picture, np.uint16)
            texts: dict[str, str] = getattr(picture, "text", {})
    except (SnapshotError, MemoryError):
        raise
    except Exception as broken:
        raise refusal("be a whole PNG file", f"a broken or another file ({reason_of(broken)})") from None
    if sum(map(len, texts.values())) > MOST_TEXT:
        raise refusal(f"have texts of at most {MOST_TEXT} bytes", "longer texts")
    return words, texts
