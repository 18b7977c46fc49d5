"""ScanOut: makes fields. Words go through the lookup table, and the cursors are drawn on top.

What is modeled: each word selects its entry; display origin, zoom and video origin select the part of the
memory that is shown; with fewer planes than the table has address bits, the upper bits of the table's address
counter select the section of the table; the cursors; a black-and-white monitor; with a beam, lines that show
the memories as they were when the beam passed; a table of grays instead of the display's. What is **not**:
interlace, the levels of blanking and border.

Hardware: GM (one word selects all three components); LIN, JPL, BTL (parking the address counter); PRG cmap.c,
introdoc (a black-and-white monitor sees the low eight bits of an entry).
Assumed: a cursor is white on dark pixels and black on light pixels, so that it is always visible. No source
says how the 9300 mixed cursors into the video.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Colors, Dots, PackedColors, Words
from ramtek_emu.configuration import Configuration, EntryFormat
from ramtek_emu.memory.cursors import BLINK, SHAPE_CENTER, SHAPE_SIZE, VISIBLE, Cursors
from ramtek_emu.memory.frame_buffer import FrameBuffer
from ramtek_emu.memory.lookup_table import LookupTable
from ramtek_emu.memory.parameters import Parameters
from ramtek_emu.video.beam import Beam
from ramtek_emu.video.view import PLAIN_VIEW, View, copy_shown, view_of

Run = tuple[int, int]
"""A range of lines of a field, or of entries of the table: the first, and the end after the last."""


class Mark(NamedTuple):
    """A cursor drawn on a field. Equal marks look the same."""

    number: int
    element: int
    line: int
    shape_changes: int
    """The count `Cursors.shape_changes`; a new shape makes a new mark."""

    @property
    def lines(self) -> Run:
        """The lines of the cursor, even beyond the edges of the field."""
        return self.line - SHAPE_CENTER, self.line - SHAPE_CENTER + SHAPE_SIZE


class Stamp(NamedTuple):
    """Identifies a field. Fields with equal stamps are equal."""

    entries: int
    """The count of words of entries written."""
    marks: tuple[Mark, ...]
    """The cursors that are drawn."""
    rest: tuple[object, ...]
    """All else that a field depends on."""


PAINTED_AT_ONCE: Final = 1 << 20
"""The pixels that are painted at once behind a beam. Limit: a bound on the time between two pauses, 5 ms."""
TABLES: Final = ("gray", "gray8")
"""Tables of grays that may replace the display's: rising from word 1, or by the low eight bits of a word."""

DARKEST: Final = 64
"""Assumed: the gray of word 1 in the table "gray", 25 % of white, well apart from black."""


@lru_cache(2)
def gray_table(name: str, words: int) -> PackedColors:
    """The colors 0x00RRGGBB of the first `words` words, (words,) uint32, in a table of `TABLES`.

    >>> [f"{color:06x}" for color in gray_table("gray", 4)]
    ['000000', '404040', 'a0a0a0', 'ffffff']
    """
    if name == "gray8":
        levels = np.arange(words) & 0xFF
    else:
        # From white down: with one plane, word 1 is white.
        levels = np.append(np.linspace(255, DARKEST, words - 1) + 0.5, 0)[::-1]
    return levels.astype(np.uint32) * np.uint32(0x010101)


class ScanOut:
    """Makes fields from a frame buffer, a lookup table and cursors."""

    def __init__(
        self,
        configuration: Configuration,
        frame_buffer: FrameBuffer,
        lookup_table: LookupTable,
        cursors: Cursors,
        parameters: Parameters,
        beam: Beam | None = None,
    ) -> None:
        self.lines = configuration.shown_lines
        self.elements = configuration.shown_elements
        self.blink_is_on = True
        """Whether blinking cursors are shown; with a beam, the beam decides instead."""
        self.shown_table = ""
        """A table that is shown instead of the display's, one of `TABLES`; "" for the display's own.

        It changes no memory, and it is no state of the display. The beam is ignored while it is shown.
        """
        self._configuration = configuration
        self._frame_buffer = frame_buffer
        self._lookup_table = lookup_table
        self._cursors = cursors
        self._parameters = parameters
        self._beam = beam
        self._words = configuration.largest_word + 1
        self._has_sections = self._words < lookup_table.size
        # With a beam: the image on the monitor, and the number of lines painted since power-on.
        self._monitor_image: PackedColors = np.zeros((self.lines, self.elements), np.uint32)
        self._painted = 0
        # np.take is fastest with indices of type intp; they are updated when words were written. Measured:
        # mode "clip" takes 1.3 times as long; converting the words for each field, 32 lines at a time, 1.8
        # times; indices on huge pages take 3 % less, which is not worth the memory.
        self._indices = np.zeros((self.lines, self.elements), np.intp)
        self._indices_of: tuple[int, View] = (-1, PLAIN_VIEW)
        """The count of words written and the view when the indices were computed."""
        shown_words = self._frame_buffer.words[: self.lines, : self.elements]
        self._lines_with = lru_cache(maxsize=64)(lambda first, end: lines_with(shown_words, first, end))

    @property
    def stamp(self) -> Stamp:
        """A value that changes whenever the field may have changed."""
        beam = self._beam
        rest = (
            self._frame_buffer.written,
            view_of(self._parameters),
            self._has_sections and self.first_entry,
            beam and beam.lines_done,
            self.shown_table,
        )
        return Stamp(self._lookup_table.written, self._marks(), rest)

    def state(self) -> dict[str, Any]:
        """With a beam: the number of lines painted since power-on, and the image on the monitor.

        The image is (lines, elements) uint32, 0x00RRGGBB.
        """
        return {"lines_painted": self._painted, "monitor_image": self._monitor_image.copy()}

    def restore(self, state: dict[str, Any]) -> None:
        """Show the monitor image of a state."""
        self._painted = state["lines_painted"]
        self._monitor_image[...] = state["monitor_image"]

    def scan_out_into(self, pixels: PackedColors) -> None:
        """Write the field as 0x00RRGGBB into a (lines, elements) uint32 array."""
        if self._beam is None or self.shown_table:
            self._update_indices()
            self.table().take(self._indices, out=pixels, mode="wrap")
        else:
            for _ in self.follow_beam():
                pass
            # Lines below the beam show the memories as they are now; in the retrace, all lines do.
            line = self._beam.line if self._beam.line < self.lines else 0
            pixels[:line] = self._monitor_image[:line]
            self._paint(line, self.lines, pixels)
        self._draw_cursors(pixels)

    def scan_out_changes_into(
        self, pixels: PackedColors, last: Stamp | None
    ) -> tuple[Stamp, tuple[Run, ...]]:
        """Bring an array up to date with the current field; returns its stamp, and the runs of lines written.

        `last` is the stamp of the field in the array; None if something else is in the array, or was drawn on
        the field. A load of entries writes the lines that show the entries, and a moved cursor the lines of
        its old and its new place. Any other change, or None, writes all lines.
        """
        stamp = self.stamp
        if last is None or last.rest != stamp.rest or self._beam is not None:
            self.scan_out_into(pixels)
            return stamp, ((0, self.lines),)
        self._update_indices()
        runs = [mark.lines for mark in set(last.marks) ^ set(stamp.marks)]
        if last.entries != stamp.entries:
            # The lines from the first to the last that show an entry that was written; all lines if unknown.
            entries = self._lookup_table.entries_written_since(last.entries)
            is_plain = self._words == self._lookup_table.size and self._indices_of[1] == PLAIN_VIEW
            runs.append(self._lines_with(*entries) if entries and is_plain else (0, self.lines))
        changed = united(runs, self.lines)
        for first, end in changed:
            self.table().take(self._indices[first:end], out=pixels[first:end], mode="wrap")
            self._draw_cursors(pixels[first:end], first)
        return stamp, changed

    def field(self) -> Colors:
        """The field, (lines, elements, 3) uint8: red, green, blue."""
        pixels = np.empty((self.lines, self.elements), "<u4")
        self.scan_out_into(pixels)
        return pixels.view(np.uint8).reshape(self.lines, self.elements, 4)[:, :, 2::-1].copy()

    def follow_beam(self) -> Iterator[None]:
        """Paint the lines that the beam has passed, from the memories as they are now, with pauses."""
        beam = self._beam
        if beam is None:
            return
        total = beam.lines_per_field
        self._painted = max(self._painted, beam.lines_done - total)
        at_once = max(1, PAINTED_AT_ONCE // self.elements)
        while self._painted < beam.lines_done:
            first = self._painted % total
            if first >= self.lines:
                # Skip the blanked lines.
                self._painted = min(beam.lines_done, self._painted - first + total)
                continue
            last = min(first + at_once, self.lines, first + beam.lines_done - self._painted)
            self._paint(first, last, self._monitor_image)
            self._painted += last - first
            if self._painted < beam.lines_done:
                yield

    def _paint(self, first: int, last: int, pixels: PackedColors) -> None:
        indices = np.empty((last - first, self.elements), np.intp)
        copy_shown(indices, first, self._frame_buffer.words, self._parameters, self.lines)
        self._own_table().take(indices, out=pixels[first:last], mode="wrap")

    def _marks(self) -> tuple[Mark, ...]:
        """The marks of the visible cursors, without blinking cursors while those are hidden."""
        blink_is_on = self.blink_is_on if self._beam is None else self._beam.blink_is_on
        return tuple([
            Mark(number, cursor.element, cursor.line, self._cursors.shape_changes)
            for number, cursor in enumerate(self._cursors.all)
            if cursor.state & VISIBLE and (blink_is_on or not cursor.state & BLINK)
        ])  # fmt: skip

    def _draw_cursors(self, pixels: PackedColors, first_line: int = 0) -> None:
        for mark in self._marks():
            draw(pixels, mark, self._cursors[mark.number].shape, first_line)

    def _update_indices(self) -> None:
        # This is `view_of` without the call, which would take a fiftieth of a scan-out with cold caches.
        parameters = self._parameters
        view = parameters.origin, parameters.zoom, parameters.origin_at_bottom
        now = self._frame_buffer.written, view
        if self._indices_of == now:
            return
        self._indices_of = now
        self._lines_with.cache_clear()
        if view == PLAIN_VIEW:
            self._indices[...] = self._frame_buffer.words[: self.lines, : self.elements]
        else:
            copy_shown(self._indices, 0, self._frame_buffer.words, self._parameters, self.lines)

    @property
    def is_dark(self) -> bool:
        """Whether the memory has words other than 0, and every pixel that is shown is black."""
        if not self._frame_buffer.words.any():
            return False
        self._update_indices()
        return not self.table().take(self._indices, mode="wrap").any()

    def table(self) -> PackedColors:
        """The colors of all words, 0x00RRGGBB: those of `shown_table`, or the display's."""
        return gray_table(self.shown_table, self._words) if self.shown_table else self._own_table()

    def _own_table(self) -> PackedColors:
        """The shown section of the display's table, in gray on a monochrome monitor."""
        table = self._lookup_table.packed
        if self._configuration.monochrome:
            short = self._configuration.entry_format is EntryFormat.WORD_12
            low = (table >> 4 & 0xF0 | table & 0x0F) if short else table & 0xFF
            table = (low * 0x010101).astype(np.uint32)
        first = self.first_entry
        return table[first : first + self._words] if self._has_sections else table

    @property
    def first_entry(self) -> int:
        """The first entry of the section of the table that is shown."""
        return self._lookup_table.addressed_entry // self._words * self._words if self._has_sections else 0


def turned(scan_out: ScanOut) -> str:
    """Show words through "gray", then "gray8", then the display's own table; returns a message for people."""
    following = {"": "gray", "gray": "gray8", "gray8": ""}
    scan_out.shown_table = name = following[scan_out.shown_table]
    return f"the table {name}" if name else "the display's table"


def draw(pixels: PackedColors, mark: Mark, shape: Dots, first_line: int = 0) -> None:
    """Draw a cursor, clipped at the edges, on pixels whose first line is line `first_line` of the field."""
    top, left = mark.lines[0] - first_line, mark.element - SHAPE_CENTER
    up, across = max(0, -top), max(0, -left)
    part = pixels[max(0, top) : max(0, top + SHAPE_SIZE), max(0, left) : max(0, left + SHAPE_SIZE)]
    dots = shape[up : up + part.shape[0], across : across + part.shape[1]]
    if part.size:
        # The highest bit of green separates light from dark well enough, and is quick to test.
        light = (part >> 15 & 1).astype(np.bool_)
        part[dots] = np.where(light[dots], np.uint32(0), np.uint32(0xFFFFFF))


def lines_with(words: Words, first: int, end: int) -> Run:
    """The first line with a word from `first` to `end` - 1, and the line after the last such line.

    (0, 0) if no line has such a word.
    """
    # In 16 bits without a sign, a word below `first` has a larger difference than any word in the range.
    lines = np.flatnonzero((words - np.uint16(first)).min(axis=1) < end - first)
    return (int(lines[0]), int(lines[-1]) + 1) if len(lines) else (0, 0)


def united(runs: Iterable[Run], lines: int) -> tuple[Run, ...]:
    """The runs clipped to `lines` lines, sorted from the top; runs that touch are joined.

    >>> united([(40, 72), (9, 9), (-5, 32), (20, 40), (90, 105)], 100)
    ((0, 72), (90, 100))
    """
    apart: list[Run] = []
    clipped = sorted((max(0, first), min(lines, end)) for first, end in runs)
    for first, end in clipped:
        if first >= end:
            continue
        if apart and first <= apart[-1][1]:
            apart[-1] = apart[-1][0], max(end, apart[-1][1])
        else:
            apart.append((first, end))
    return tuple(apart)
