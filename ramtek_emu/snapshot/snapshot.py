"""Snapshots: a whole display in a 16-bit PNG file, its words as pixels, everything else in text chunks.

What is kept: the configuration, the words, the lookup table and its address counter, the parameters and those
that PUSHE saved, loaded characters, cursors and switches, the status, the time and the image on the monitor.
What is **not**: the words of an incomplete instruction, and replies that were not read; both belong to a
host, which is not in the file.

The pixels are the words themselves, so that any program for 16-bit gray pictures can read them. The picture
looks dark, since only ten of sixteen bits are used.
"""

from __future__ import annotations

import json
import os
from dataclasses import fields, replace
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np

from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import ConfigurationError, MissingInputError, SnapshotError, reason_of
from ramtek_emu.processor.environment_executors import MOST_SAVED
from ramtek_emu.processor.processor import Status
from ramtek_emu.snapshot.plain_values import listed, packed, plain, refusal, restored, unpacked, whole_number
from ramtek_emu.snapshot.png_chunks import MOST_FILE, picture_bytes, picture_of
from ramtek_emu.timing import Timing
from ramtek_emu.video.beam import Beam
from ramtek_emu.writing import write_atomically

SOFTWARE: Final = "ramtek_emu snapshot 1"
"""The text chunk `Software`; the number is the version of the format.

The file keeps some names of that version: "glass" for the monitor image, "named_only" for `unimplemented`.
"""


def snapshot_bytes(display: Ramtek9300) -> bytes:
    """The display as the bytes of a PNG file."""
    processor, cursors, table = display.processor, display.processor.cursors, display.lookup_table
    texts = {
        "configuration": configuration_state(display.configuration),
        "lookup table": {"address": table.address, "entries": plain(table.packed.view("<u2"))},
        "parameters": {"now": plain(processor.parameters), "saved": plain(processor.saved)},
        "processor": {
            "loaded_characters": plain(processor.loaded_characters),
            "illegal": bool(processor.status & Status.ILLEGAL),
            "illegal_words": processor.illegal_words,
            "named_only": processor.unimplemented,
            "nanoseconds": 0 if processor.beam is None else processor.beam.nanoseconds,
        },
        "cursors": {
            "all": plain(cursors.all),
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
        raise SnapshotError(
            f"a snapshot must be of the format {SOFTWARE!r}, not {texts.get('Software', 'unknown')[:40]!r}; "
            "take a new one with --snapshot"
        )
    configuration = configuration_of(_state(texts, "configuration"))
    if words.shape != (configuration.lines, configuration.elements):
        raise SnapshotError(
            f"a snapshot must have {configuration.elements} x {configuration.lines} words, as its "
            f"configuration says, not {words.shape[1]} x {words.shape[0]}; take a new one with --snapshot"
        )
    if int(words.max()) > configuration.largest_word:
        raise refusal("a word", f"0 to {configuration.largest_word}", int(words.max()))
    display = Ramtek9300(configuration)
    display.frame_buffer.write(words)
    _restore_table(display, _state(texts, "lookup table", "address", "entries"))
    _restore_processor(
        display,
        _state(texts, "parameters", "now", "saved"),
        _state(
            texts,
            "processor",
            "loaded_characters",
            "illegal",
            "illegal_words",
            "named_only",
            "nanoseconds",
        ),
    )
    _restore_cursors(display, _state(texts, "cursors", "all", "track", "enter_is_pressed", "driven"))
    if display.beam is not None:
        _restore_monitor_image(display, display.beam, _state(texts, "glass", "lines", "pixels"))
    return display


def write_snapshot(display: Ramtek9300, path: str | PathLike[str], overwrite: bool = True) -> None:
    """Write a snapshot to a file, whole or not at all; OutputExistsError, OutputError or WriteError."""
    if not isinstance(display, Ramtek9300):
        raise SnapshotError(
            f"a snapshot must be of a Ramtek9300, not of a {type(display).__name__}; "
            "give the display first, then the path"
        )
    write_atomically(path, snapshot_bytes(display), overwrite=overwrite)


def read_snapshot(path: str | PathLike[str]) -> Ramtek9300:
    """The display of a snapshot file; MissingInputError if it cannot be read, SnapshotError if not valid."""
    try:
        if not Path(path).is_file():
            raise MissingInputError(
                f"a snapshot must be a file, and {os.fspath(path)} is none; check the name"
            )
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


def configuration_state(configuration: Configuration) -> dict[str, Any]:
    """A configuration as plain values."""
    state: dict[str, Any] = plain(configuration)
    return state


def configuration_of(state: dict[str, Any]) -> Configuration:
    """The configuration of plain values; SnapshotError if they are not valid."""
    pattern = replace(
        GMR_9300,
        visible_elements=None if state.get("visible_elements") is None else 1,
        visible_lines=None if state.get("visible_lines") is None else 1,
        timing=None if state.get("timing") is None else Timing(),
    )
    names = [each.name for each in fields(pattern)]
    if set(state) != set(names):
        raise refusal("the configuration", f"an object of {', '.join(names)}", state)
    values = {name: restored(getattr(pattern, name), state[name], f"configuration.{name}") for name in names}
    if values["timing"] is not None and values["timing"].line < 1:
        raise refusal("configuration.timing.line", "1 or more", values["timing"].line)
    try:
        return Configuration(**values)
    except ConfigurationError as cause:
        raise SnapshotError(f"a snapshot must have a configuration that can be built: {cause}") from None


def _restore_table(display: Ramtek9300, state: dict[str, Any]) -> None:
    table = display.lookup_table
    halves: Any = restored(np.zeros(2 * table.size, np.uint16), state["entries"], "entries")
    table.write(0, halves.astype("<u2").view(np.uint8).reshape(-1, 4)[:, 2::-1])
    table.address = whole_number(state["address"], (0, table.word_count - 1), "address")


def _restore_processor(display: Ramtek9300, parameters: dict[str, Any], state: dict[str, Any]) -> None:
    processor = display.processor
    pattern = processor.parameters
    processor.parameters = restored(pattern, parameters["now"], "parameters")
    processor.saved[:] = listed(pattern, parameters["saved"], "saved", MOST_SAVED)
    for name, attribute in (
        ("loaded_characters", "loaded_characters"),
        ("illegal_words", "illegal_words"),
        ("named_only", "unimplemented"),
    ):
        setattr(processor, attribute, restored(getattr(processor, attribute), state[name], name))
    if restored(False, state["illegal"], "illegal"):
        processor.flag_illegal()
    nanoseconds = restored(0, state["nanoseconds"], "nanoseconds")
    if processor.beam is not None:
        processor.beam.nanoseconds = nanoseconds


def _restore_cursors(display: Ramtek9300, state: dict[str, Any]) -> None:
    cursors = display.processor.cursors
    for cursor, kept in zip(cursors.all, restored(cursors.all, state["all"], "cursors"), strict=True):
        for each in fields(cursor):
            setattr(cursor, each.name, getattr(kept, each.name))
    cursors.track = restored(False, state["track"], "track")
    cursors.enter_is_pressed = restored(False, state["enter_is_pressed"], "enter_is_pressed")
    cursors.driven = {device: mask for device, mask in listed((0, 0), state["driven"], "driven", 256)}
    cursors.changed += 1


def _restore_monitor_image(display: Ramtek9300, beam: Beam, state: dict[str, Any]) -> None:
    lines = whole_number(state["lines"], (0, beam.lines_done), "lines")
    _, pixels = display.scan_out.monitor_image
    colors = np.zeros((pixels.size, 4), np.uint8)
    data = unpacked(state["pixels"], 3 * pixels.size, "pixels")
    colors[:, :3] = np.frombuffer(data, np.uint8).reshape(-1, 3)
    display.scan_out.monitor_image = lines, colors.view("<u4").reshape(pixels.shape)


def _state(texts: dict[str, str], keyword: str, *names: str) -> dict[str, Any]:
    """A text chunk as an object; SnapshotError if it is none, or if its fields are not the given names."""
    try:
        state = json.loads(texts.get(keyword, "null"))
    except (ValueError, RecursionError):
        state = None
    if not isinstance(state, dict) or (names and set(state) != set(names)):
        raise SnapshotError(
            f"a snapshot must have a text {keyword!r} that says {', '.join(names) or 'what it is'}, not "
            f"{texts.get(keyword, 'none')[:40]!r}; take a new one with --snapshot"
        )
    return state
