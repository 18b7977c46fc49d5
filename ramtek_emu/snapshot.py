"""Snapshots: a display in a 16-bit PNG file, with its words as pixels and all other state in text chunks.

What is saved: the configuration, the words, the lookup table and its address counter, the current parameters
and the saved ones, loaded characters, cursors and switches, the status, the time and the image on the
monitor. What is **not**: the words of an incomplete instruction, and unread replies; both belong to a host,
and the file has none.

The pixels are the words themselves, so that any program for 16-bit gray pictures can read them. The picture
looks dark, since only ten of sixteen bits are used. The texts are JSON. A value that is read must have the
type, the length and the fields of the same value in a new display, or the error names the place.

Snapshots may come from anywhere, so every size is checked before memory of that size is used: the file, the
picture, the texts and the unpacked pixels. Pillow is not used here: it raises a dozen kinds of errors for
such files. This module reads and writes the small part of the PNG format that snapshots need, and refuses
the rest: other depths, interlacing, filters, unknown critical chunks.
"""

from __future__ import annotations

import base64
import binascii
import json
import os
import struct
import zlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import AnyArray, Words
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import ConfigurationError, MissingInputError, SnapshotError, reason_of
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.processor.environment_executors import MOST_SAVED
from ramtek_emu.processor.processor import Processor, Status
from ramtek_emu.timing import Timing
from ramtek_emu.video.beam import Beam
from ramtek_emu.writing import PNG, check_suffix, write_atomically

SOFTWARE: Final = "ramtek_emu snapshot 1"
"""The text chunk `Software`; the number is the version of the format.

The file keeps some names of that version: "glass" for the monitor image, "named_only" for `unimplemented`.
"""


def write_snapshot(display: Ramtek9300, path: str | PathLike[str], overwrite: bool = False) -> None:
    """Write a snapshot to a PNG file, whole or not at all.

    Raises OutputError for a name that does not end in .png, and if no file can be created there;
    OutputExistsError if the file exists and `overwrite` is false; WriteError if writing fails.
    """
    if not isinstance(display, Ramtek9300):
        raise SnapshotError(
            f"a snapshot must be of a Ramtek9300, not of a {type(display).__name__}; "
            "give the display first, then the path"
        )
    check_suffix(path, PNG, "a snapshot")
    write_atomically(path, snapshot_bytes(display), overwrite=overwrite)


def read_snapshot(path: str | PathLike[str]) -> Ramtek9300:
    """The display of a snapshot file; MissingInputError if it cannot be read, SnapshotError if not valid."""
    try:
        if not Path(path).is_file():
            raise MissingInputError(f"a snapshot must be a file, not {os.fspath(path)}; check the name")
        with open(path, "rb") as file:
            data = file.read(MOST_FILE + 1)
    except MissingInputError:
        raise
    except (OSError, ValueError) as cause:
        raise MissingInputError(
            f"a snapshot must be a file that can be read, not {os.fspath(path)!r} ({reason_of(cause)}); "
            "check the name"
        ) from None
    if len(data) > MOST_FILE:
        raise SnapshotError(
            f"a snapshot must be at most {MOST_FILE} bytes, not more ({os.fspath(path)}); take a new one"
        )
    return display_of(data)


def snapshot_bytes(display: Ramtek9300) -> bytes:
    """The display as the bytes of a PNG file."""
    processor, cursors, table = display.processor, display.processor.cursors, display.lookup_table
    texts = {
        "configuration": to_plain(display.configuration),
        "lookup table": {"address": table.address, "entries": to_plain(table.packed.view("<u2"))},
        "parameters": {"now": to_plain(processor.parameters), "saved": to_plain(processor.saved)},
        "processor": {
            "loaded_characters": to_plain(processor.loaded_characters),
            "illegal": bool(processor.status & Status.ILLEGAL),
            "illegal_words": processor.illegal_words,
            "named_only": processor.unimplemented,
            "nanoseconds": 0 if processor.beam is None else processor.beam.nanoseconds,
        },
        "cursors": {
            "all": to_plain(cursors.all),
            "track": cursors.track,
            "enter_is_pressed": cursors.enter_is_pressed,
            "driven": sorted([device, mask] for device, mask in cursors.driven.items()),
        },
    }
    if display.beam is not None:
        lines, pixels = display.scan_out.monitor_image
        colors = pixels.astype("<u4").view(np.uint8).reshape(-1, 4)[:, :3]
        texts["glass"] = {"lines": lines, "pixels": packed(colors.tobytes())}
    written = {keyword: json.dumps(state, separators=(",", ":")) for keyword, state in texts.items()}
    return picture_bytes(display.words, {"Software": SOFTWARE} | written)


def display_of(data: bytes) -> Ramtek9300:
    """The display of a snapshot; SnapshotError if the bytes are no valid snapshot."""
    words, texts = picture_of(data)
    if texts.get("Software") != SOFTWARE:
        raise refusal(f"be of the format {SOFTWARE!r}", repr(texts.get("Software", "unknown")[:40]))
    configuration = configuration_of(_state(texts, "configuration"))
    if words.shape != (configuration.lines, configuration.elements):
        raise refusal(
            f"have {configuration.elements} x {configuration.lines} words, as its configuration says",
            f"{words.shape[1]} x {words.shape[0]}",
        )
    if int(words.max()) > configuration.largest_word:
        raise value_refusal("a word", f"0 to {configuration.largest_word}", int(words.max()))
    display = Ramtek9300(configuration)
    display.frame_buffer.write(words)
    _restore_table(display, _state(texts, "lookup table", "address", "entries"))
    _restore_parameters(display.processor, _state(texts, "parameters", "now", "saved"))
    names = ("loaded_characters", "illegal", "illegal_words", "named_only", "nanoseconds")
    _restore_processor(display.processor, _state(texts, "processor", *names))
    _restore_cursors(display, _state(texts, "cursors", "all", "track", "enter_is_pressed", "driven"))
    if display.beam is not None:
        _restore_monitor_image(display, display.beam, _state(texts, "glass", "lines", "pixels"))
    return display


def configuration_of(state: dict[str, Any]) -> Configuration:
    """The configuration of plain values; SnapshotError if they are not valid."""
    pattern = replace(
        GMR_9300,
        visible_elements=None if state.get("visible_elements") is None else 1,
        visible_lines=None if state.get("visible_lines") is None else 1,
        timing=None if state.get("timing") is None else Timing(),
    )
    names = [field.name for field in fields(pattern)]
    if set(state) != set(names):
        raise value_refusal("the configuration", f"an object of {', '.join(names)}", state)
    values = {
        name: from_plain(getattr(pattern, name), state[name], f"configuration.{name}") for name in names
    }
    if values["timing"] is not None and values["timing"].line < 1:
        raise value_refusal("configuration.timing.line", "1 or more", values["timing"].line)
    try:
        return Configuration(**values)
    except ConfigurationError as cause:
        raise SnapshotError(f"a snapshot must have a configuration that can be built: {cause}") from None


def _restore_table(display: Ramtek9300, state: dict[str, Any]) -> None:
    table = display.lookup_table
    halves: Any = from_plain(np.zeros(2 * table.size, np.uint16), state["entries"], "entries")
    table.write(0, halves.astype("<u2").view(np.uint8).reshape(-1, 4)[:, 2::-1])
    table.address = whole_number(state["address"], (0, table.word_count - 1), "address")


def _restore_parameters(processor: Processor, state: dict[str, Any]) -> None:
    pattern = processor.parameters
    processor.parameters = from_plain(pattern, state["now"], "parameters")
    processor.saved[:] = listed(pattern, state["saved"], "saved", MOST_SAVED)


def _restore_processor(processor: Processor, state: dict[str, Any]) -> None:
    characters = processor.loaded_characters
    processor.loaded_characters = from_plain(characters, state["loaded_characters"], "loaded_characters")
    processor.illegal_words = from_plain(0, state["illegal_words"], "illegal_words")
    processor.unimplemented = from_plain(0, state["named_only"], "named_only")
    if from_plain(False, state["illegal"], "illegal"):
        processor.flag_illegal()
    nanoseconds = from_plain(0, state["nanoseconds"], "nanoseconds")
    if processor.beam is not None:
        processor.beam.nanoseconds = nanoseconds


def _restore_cursors(display: Ramtek9300, state: dict[str, Any]) -> None:
    cursors = display.processor.cursors
    for cursor, saved in zip(cursors.all, from_plain(cursors.all, state["all"], "cursors"), strict=True):
        for attribute in fields(cursor):
            setattr(cursor, attribute.name, getattr(saved, attribute.name))
    cursors.track = from_plain(False, state["track"], "track")
    cursors.enter_is_pressed = from_plain(False, state["enter_is_pressed"], "enter_is_pressed")
    cursors.driven = {device: mask for device, mask in listed((0, 0), state["driven"], "driven", 256)}
    cursors.shape_changes += 1


def _restore_monitor_image(display: Ramtek9300, beam: Beam, state: dict[str, Any]) -> None:
    lines = whole_number(state["lines"], (0, beam.lines_done), "lines")
    _, pixels = display.scan_out.monitor_image
    colors = np.zeros((pixels.size, 4), np.uint8)
    data = unpacked(state["pixels"], 3 * pixels.size, "pixels")
    colors[:, :3] = np.frombuffer(data, np.uint8).reshape(-1, 3)
    display.scan_out.monitor_image = lines, colors.view("<u4").reshape(pixels.shape)


def _state(texts: dict[str, str], keyword: str, *names: str) -> dict[str, Any]:
    """The JSON object of a text chunk; SnapshotError if it is missing or its fields are not `names`."""
    try:
        state = json.loads(texts.get(keyword, "null"))
    except (ValueError, RecursionError):
        state = None
    if not isinstance(state, dict) or (names and set(state) != set(names)):
        raise refusal(
            f"have a text {keyword!r} that says {', '.join(names) or 'what it is'}",
            repr(texts.get(keyword, "none")[:40]),
        )
    return state


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


def to_plain(value: Any) -> Any:
    """The value for JSON: arrays of dots and words become base64, dataclasses objects."""
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, np.ndarray):
        data = np.packbits(value) if value.dtype == np.bool_ else value.astype("<u2")
        return base64.b64encode(data.tobytes()).decode("ascii")
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: to_plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, dict):
        return {str(key): to_plain(item) for key, item in value.items()}
    if isinstance(value, tuple | list):
        return [to_plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def from_plain(pattern: Any, value: Any, place: str) -> Any:
    """The value converted to the type of the pattern; SnapshotError names the place of a wrong value."""
    if isinstance(pattern, Enum):
        return _named(pattern, value, place)
    if isinstance(pattern, np.ndarray):
        return _array(pattern, value, place)
    if isinstance(pattern, bool | str | None):
        if type(value) is not type(pattern) or (isinstance(value, str) and not _is_a_name(value)):
            raise value_refusal(place, "a name" if isinstance(pattern, str) else "true or false", value)
        return value
    if isinstance(pattern, int):
        return whole_number(value, LIMITS.get(place.rpartition(".")[2].partition("[")[0], WORD), place)
    if isinstance(pattern, Point | Window):
        if not isinstance(value, list) or len(value) != len(pattern):
            raise value_refusal(place, f"{len(pattern)} numbers", value)
        return type(pattern)(*(whole_number(number, COORDINATE, place) for number in value))
    if is_dataclass(pattern) and not isinstance(pattern, type):
        names = [field.name for field in fields(pattern)]
        if not isinstance(value, dict) or set(value) != set(names):
            raise value_refusal(place, f"an object of {', '.join(names)}", value)
        return replace(
            pattern,
            **{name: from_plain(getattr(pattern, name), value[name], f"{place}.{name}") for name in names},
        )
    if isinstance(pattern, tuple):
        if not isinstance(value, list) or len(value) != len(pattern):
            raise value_refusal(place, f"{len(pattern)} items", value)
        pairs = enumerate(zip(pattern, value, strict=True))
        return tuple(from_plain(kind, item, f"{place}[{number}]") for number, (kind, item) in pairs)
    raise TypeError(f"a state must be made of plain values, not {type(pattern).__name__} ({place})")


def packed(data: bytes) -> str:
    """The bytes compressed, as base64 text."""
    return base64.b64encode(zlib.compress(data, 6)).decode("ascii")


def unpacked(text: Any, size: int, place: str) -> bytes:
    """The bytes of a compressed text; SnapshotError unless they are `size`. Unpacks at most one byte more."""
    unpacker = zlib.decompressobj()
    try:
        data = unpacker.decompress(base64.b64decode(text, validate=True), size + 1)
    except (binascii.Error, zlib.error, ValueError, TypeError):
        data = b""
    if len(data) != size or not unpacker.eof:
        raise value_refusal(place, f"{size} packed bytes", text)
    return data


def listed(pattern: Any, value: Any, place: str, most: int) -> list[Any]:
    """The items of a list, at most `most`, converted to the type of the pattern."""
    if not isinstance(value, list) or len(value) > most:
        raise value_refusal(place, f"a list of at most {most}", value)
    return [from_plain(pattern, item, f"{place}[{number}]") for number, item in enumerate(value)]


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


def _is_a_name(text: str) -> bool:
    return 1 <= len(text) <= 60 and text.isascii() and text.isprintable()


def _named(pattern: Enum, value: Any, place: str) -> Enum:
    kinds = type(pattern).__members__
    if not isinstance(value, str) or value not in kinds:
        raise value_refusal(place, f"one of {', '.join(kinds)}", value)
    return kinds[value]


def _array(pattern: AnyArray, value: Any, place: str) -> AnyArray:
    dots = pattern.dtype == np.bool_
    size = (pattern.size + 7) // 8 if dots else 2 * pattern.size
    try:
        data = base64.b64decode(value, validate=True) if isinstance(value, str) else b""
    except (binascii.Error, ValueError):
        data = b""
    if len(data) != size:
        raise value_refusal(place, f"{size} bytes in base64", value)
    if dots:
        return (
            np.unpackbits(np.frombuffer(data, np.uint8), count=pattern.size)
            .astype(np.bool_)
            .reshape(pattern.shape)
        )
    return np.frombuffer(data, "<u2").astype(pattern.dtype).reshape(pattern.shape)


SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"
MOST_FILE: Final = 48 << 20
"""Limit: the longest file, in bytes."""
MOST_SIDE: Final = 4096
"""Limit: the most elements, and the most lines."""
MOST_TEXT: Final = 8 << 20
"""Limit: the most bytes of all texts together."""
MOST_CHUNKS: Final = 1 << 16
"""Limit: the most chunks."""


def picture_bytes(words: Words, texts: Mapping[str, str]) -> bytes:
    """A PNG file of (lines, elements) words, 16 bits gray, and of ASCII texts by keyword."""
    lines, elements = words.shape
    # A line begins with the number of its filter; 0 means no filter.
    rows = np.zeros((lines, 1 + 2 * elements), np.uint8)
    rows[:, 1:] = words.astype(">u2").view(np.uint8).reshape(lines, -1)
    parts = [SIGNATURE, _chunk(b"IHDR", struct.pack(">IIBBBBB", elements, lines, 16, 0, 0, 0, 0))]
    parts += [
        _chunk(b"tEXt", keyword.encode("ascii") + b"\0" + text.encode("ascii"))
        for keyword, text in texts.items()
    ]
    parts += [_chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)), _chunk(b"IEND", b"")]
    return b"".join(parts)


def picture_of(data: bytes) -> tuple[Words, dict[str, str]]:
    """The words and the texts of a PNG file of `picture_bytes`; SnapshotError if it is not valid."""
    if data[:8] != SIGNATURE:
        raise refusal("begin as a PNG file does", "as something else")
    size: tuple[int, int] | None = None
    texts: dict[str, str] = {}
    packed: list[bytes] = []
    place, kind, text_size = 8, b"", 0
    for _ in range(MOST_CHUNKS):
        kind, content, place = _next_chunk(data, place)
        if size is None:
            size = _size(kind, content)
        elif kind == b"IDAT":
            packed.append(content)
        elif kind == b"tEXt":
            keyword, text = _text(content)
            if keyword in texts:
                raise refusal("have each text once", f"{keyword!r} twice")
            texts[keyword] = text
            text_size += len(text)
            if text_size > MOST_TEXT:
                raise refusal(f"have texts of at most {MOST_TEXT} bytes", "longer texts")
        elif kind == b"IEND":
            break
        elif not kind[0] & 0x20:
            raise refusal("have known chunks", f"a chunk {kind.decode('latin-1')!r}")
    if kind != b"IEND" or size is None:
        raise refusal(f"end within {MOST_CHUNKS} chunks", "go on")
    return _words(packed, *size), texts


def _chunk(kind: bytes, content: bytes) -> bytes:
    """The bytes of a chunk, with length and checksum."""
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def _next_chunk(data: bytes, place: int) -> tuple[bytes, bytes, int]:
    """The kind and the content of a chunk, and the place of the next chunk."""
    if len(data) < place + 12:
        raise refusal("have whole chunks", f"end in a chunk, at byte {len(data)}")
    length, kind = struct.unpack_from(">I4s", data, place)
    end = place + 12 + length
    if end > len(data):
        raise refusal("have whole chunks", f"a chunk of {length} bytes at byte {place} of {len(data)}")
    content = data[place + 8 : end - 4]
    if zlib.crc32(content, zlib.crc32(kind)) != struct.unpack_from(">I", data, end - 4)[0]:
        raise refusal("have chunks with a right checksum", f"a wrong checksum at byte {place}")
    return kind, content, end


def _size(kind: bytes, content: bytes) -> tuple[int, int]:
    if kind != b"IHDR" or len(content) != 13:
        raise refusal("begin with its size", "with another chunk")
    elements, lines, *kind_of_pixels = struct.unpack(">IIBBBBB", content)
    if kind_of_pixels != [16, 0, 0, 0, 0]:
        raise refusal("be 16 bits gray, not interlaced", "another kind of picture")
    if not (1 <= elements <= MOST_SIDE and 1 <= lines <= MOST_SIDE):
        raise refusal(f"be 1 to {MOST_SIDE} elements and lines", f"{elements} x {lines}")
    return lines, elements


def _text(content: bytes) -> tuple[str, str]:
    keyword, zero, text = content.partition(b"\0")
    if not zero or not 1 <= len(keyword) <= 79 or not content.isascii():
        raise refusal("have texts with a keyword, in ASCII", "other texts")
    return keyword.decode("ascii"), text.decode("ascii")


def _words(packed: list[bytes], lines: int, elements: int) -> Words:
    expected = lines * (1 + 2 * elements)
    unpacker = zlib.decompressobj()
    try:
        unpacked = unpacker.decompress(b"".join(packed), expected + 1)
    except zlib.error as cause:
        raise refusal("have pixels that can be unpacked", f"broken pixels ({cause})") from None
    if len(unpacked) != expected or not unpacker.eof:
        raise refusal(f"have {lines} lines of {elements} words", "more or fewer")
    rows = np.frombuffer(unpacked, np.uint8).reshape(lines, -1)
    if rows[:, 0].any():
        raise refusal("have unfiltered lines, as they were written", "lines that another program filtered")
    return np.ascontiguousarray(rows[:, 1:]).view(">u2").astype(np.uint16)
