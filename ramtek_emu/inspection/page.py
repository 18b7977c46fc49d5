"""Page: the picture of an inspector, with the field of a display at its left and panels around it.

Below the field are the parameters; at its right the listing, the words of the instruction, the pixels and the
history; at the bottom the buttons, the bar of the whole stream and the messages. Beside a tall field, the
parameters are at the right, too. A field of few lines is enlarged by a whole number.

A black and a white ring are around the pixels that the current instruction writes, for half a second after it
is reached and every other half second. An orange ring is around what is selected.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, NamedTuple, cast

import numpy as np

from ramtek_emu.arrays import Colors, Dots, PackedColors
from ramtek_emu.inspection import panels
from ramtek_emu.inspection.histories import EntryRange, is_single
from ramtek_emu.inspection.session import Inspection, display_of, is_preparing, shown_pixels
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.monitor.boxes import (
    ADVANCE,
    BLACK,
    GRAY,
    ORANGE,
    ROW,
    WHITE,
    Line,
    PageBox,
    Span,
    cells,
    entries_page,
    grown,
    help_page,
    mark,
    write_rows,
)
from ramtek_emu.video.scan_out import Run

GAP: Final = 8
SIDE_CHARACTERS: Final = 64
"""The characters in a row of the panels at the right."""
STAGE: Final = Point(640, 480)
"""The least elements and lines for the field."""
EDGE: Final = 2
"""The pixels around the field, for the rings."""
TALL_LINES: Final = 800
"""A field with so many lines has all panels at its right."""
PARAMETER_ROWS: Final = {True: 14, False: 9}
PARAMETER_WIDTHS: Final = {True: (34, 30), False: (33, 28, 18)}
"""The rows and the widths of the columns in characters, by whether the field is tall."""
DISTANCE: Final = 2
"""The pixels between a selected pixel and the rings around it."""
BUTTON_LINES: Final = 15
BAR_LINES: Final = 13
RAISED: Final = 0x2B3038
"""Behind buttons, and the unprepared part of the bar."""
PREPARED: Final = 0x3F5F86


class PageLayout(NamedTuple):
    """The parts of a page."""

    elements: int
    lines: int
    zoom: int
    stage: PageBox
    """The place for a page, or for the field and the rings around it."""
    field: PageBox
    boxes: dict[str, PageBox]
    """The panels by name; the first row of some is their title."""
    buttons: tuple[PageBox, ...]
    bar: PageBox


def layout_of(elements: int, lines: int, cursors: int, buttons: Sequence[str]) -> PageLayout:
    """The layout around a field of some elements and lines, with these buttons."""
    zoom = max(1, min(STAGE.element // elements, STAGE.line // lines))
    width, height = max(STAGE.element, elements * zoom), max(STAGE.line, lines * zoom)
    stage = PageBox(0, 0, width + 2 * EDGE, height + 2 * EDGE)
    left, top = (stage.width - elements * zoom) // 2, (stage.height - lines * zoom) // 2
    field = PageBox(left, top, elements * zoom, lines * zoom)
    is_tall = stage.height >= TALL_LINES
    rows = PARAMETER_ROWS[is_tall]
    right, side, top = stage.width + GAP, SIDE_CHARACTERS * ADVANCE, GAP // 2
    bottom = stage.height + (0 if is_tall else (rows + cursors) * ROW + 2 * GAP)
    listed = (bottom - top - 4 * GAP) // ROW - 4 - (rows + cursors + 1 if is_tall else 0)
    panels_at_right = {"listing": listed * 45 // 100, "words": listed * 22 // 100}
    boxes = {}
    if is_tall:
        panels_at_right |= {"parameters": rows, "cursors": cursors}
    else:
        down = stage.height + GAP
        boxes["parameters"] = PageBox(GAP, down, stage.width - GAP, rows * ROW)
        boxes["cursors"] = PageBox(GAP, down + rows * ROW, stage.width - GAP, cursors * ROW)
    for name, rows in (panels_at_right | {"pixels": 3}).items():
        boxes[name] = PageBox(right, top, side, rows * ROW)
        top += rows * ROW + (0 if name == "parameters" else GAP)
    left, down, _, height = boxes.pop("parameters")
    for column, width in enumerate(PARAMETER_WIDTHS[is_tall]):
        boxes[f"parameters {column}"] = PageBox(left, down, width * ADVANCE, height)
        left += width * ADVANCE
    boxes["history"] = PageBox(right, top, side, (bottom - top) // ROW * ROW)
    places, left = [], GAP
    for label in buttons:
        places.append(PageBox(left, bottom + 4, (len(label) + 2) * ADVANCE, BUTTON_LINES))
        left += places[-1].width + 4
    whole = right + side + GAP
    bar = PageBox(GAP, bottom + BUTTON_LINES + 9, whole - 2 * GAP, BAR_LINES)
    boxes["status"] = status = PageBox(GAP, bar.top + bar.height + 3, whole - 2 * GAP, ROW)
    return PageLayout(whole, status.top + ROW + 1, zoom, stage, field, boxes, tuple(places), bar)


class InspectorPage:
    """The page of an inspection, as a field for a window; the help page shows rows of keys and actions."""

    def __init__(
        self,
        session: Inspection,
        layout: PageLayout,
        buttons: Sequence[str],
        help_rows: Sequence[tuple[str, str]],
        title: str,
    ) -> None:
        self.session = session
        self.layout = layout
        self.elements, self.lines = layout.elements, layout.lines
        self.blink_is_on = True
        self._help_rows, self._title = help_rows, title
        self._pixels: PackedColors = np.full((self.lines, self.elements), BLACK, np.uint32)
        bottom = layout.bar.top - BUTTON_LINES - 9
        self._pixels[:bottom, layout.stage.width] = RAISED
        self._pixels[layout.stage.height, : layout.stage.width] = self._pixels[bottom] = RAISED
        for box, text in zip(layout.buttons, buttons, strict=True):
            box.of(self._pixels)[...] = RAISED
            write_rows(box.of(self._pixels)[2:], [(Span(f" {text} "),)], RAISED)
        self._marked: tuple[int, bool] = (-1, True)
        """The current instruction, and the phase of the blinking when it was reached."""
        self._shown: dict[str, Any] = {}
        """What the parts of the page show."""
        self._drawn: Any = None
        """The stamp of the page as it is drawn."""

    # A field for the window.

    @property
    def stamp(self) -> Any:
        """A value that changes whenever a pixel may have changed."""
        scan_out = display_of(self.session).scan_out
        # The display may be another than at the last blink.
        scan_out.blink_is_on = self.blink_is_on
        if self._marked[0] != self.session.number:
            self._marked = self.session.number, self.blink_is_on
        replay = self.session.replay
        place = len(replay.stream.words), replay.prepared
        return self.session, place, scan_out, scan_out.stamp, self._marks_are_shown

    @property
    def _marks_are_shown(self) -> bool:
        """Whether rings are around the pixels that the instruction writes now."""
        session, phase = self.session, self._marked[1]
        has_written = session.replay.written is not None and session.replay.number == session.number
        return has_written and not session.is_following and phase == self.blink_is_on

    def scan_out_changes_into(self, pixels: PackedColors, _: Any) -> tuple[Any, tuple[Run, ...]]:
        """Bring any pixels up to date; returns their stamp, and the lines that differed."""
        self.draw()
        differing = np.flatnonzero((pixels != self._pixels).any(axis=1))
        runs = [(int(differing[0]), int(differing[-1]) + 1)] if len(differing) else []
        for first, end in runs:
            pixels[first:end] = self._pixels[first:end]
        return self._drawn, tuple(runs)

    def field(self) -> Colors:
        """The field of the display, without the page around it."""
        return display_of(self.session).field()

    def colors(self) -> Colors:
        """The whole page, (lines, elements, 3) uint8."""
        self.draw()
        return self._pixels.astype("<u4").view(np.uint8).reshape(self.lines, self.elements, 4)[:, :, 2::-1]

    # Drawing.

    def draw(self) -> None:
        """Draw the parts of the page that have changed."""
        stamp = self.stamp
        if stamp == self._drawn:
            return
        session, layout = self.session, self.layout
        self._drawn = stamp
        marks = self._marks_are_shown and session.number
        self._part(
            "stage", layout.stage, (stamp[2:], marks, session.page, session.selection), self._draw_stage
        )
        for name, rows in self._rows().items():
            self._part(name, layout.boxes[name], rows, partial(write_rows, rows=rows))
        prepared = session.replay.prepared if is_preparing(session) else session.length
        numbers = session.length, prepared, session.target, session.number
        self._part("bar", layout.bar, (numbers, session.writes), partial(self._draw_bar, prepared=prepared))

    def _part(self, name: str, box: PageBox, shown: Any, draw: Callable[[PackedColors], None]) -> None:
        """Draw a part of the page if what it shows has changed."""
        if shown != self._shown.get(name):
            self._shown[name] = shown
            pixels = box.of(self._pixels)
            pixels[...] = BLACK
            draw(pixels)

    def _rows(self) -> dict[str, Sequence[Line]]:
        """The rows of the panels."""
        session, boxes = self.session, self.layout.boxes
        rows: dict[str, Sequence[Line]] = {
            "listing": [panels.title(session), *panels.listing(session)],
            "words": panels.words_of_the_instruction(session, boxes["words"].rows - 1, SIDE_CHARACTERS),
            "cursors": panels.cursors(session),
            "pixels": panels.pixels(session),
            "history": [panels.history_title(session), *panels.history(session)],
            "status": [panels.status(session)],
        }
        parameters, height = panels.parameters(session), boxes["parameters 0"].rows
        for column, first in enumerate(range(0, len(parameters), height)):
            rows[f"parameters {column}"] = parameters[first : first + height]
        return rows

    def _draw_stage(self, stage: PackedColors) -> None:
        session, scan_out = self.session, display_of(self.session).scan_out
        lines, elements = stage.shape
        selection, dots = session.selection, cast(Dots, np.zeros(stage.shape, np.bool_))
        stage[...] = 0
        if session.page == "help":
            stage[...] = help_page(lines, elements, self._title, self._help_rows)
        elif session.page == "entries":
            stage[EDGE:-EDGE, EDGE:-EDGE] = entries_page(scan_out.table(), *self._cells().shape)
            if isinstance(selection, EntryRange):
                words = self._cells() + scan_out.first_entry
                dots[EDGE:-EDGE, EDGE:-EDGE] = (words >= selection.first) & (words < selection.end)
                mark(stage, dots, BLACK, ORANGE)
        else:
            field = self.layout.field.of(stage)
            scan_out.scan_out_into(pixels := np.empty((scan_out.lines, scan_out.elements), np.uint32))
            field[...] = self._enlarged(pixels)
            shown = self.layout.field.of(dots)
            places, rows = shown_pixels(display_of(session))
            written = session.replay.written
            if written is not None and self._marks_are_shown:
                shown[...] = self._enlarged(written[rows[:, np.newaxis], places])
                mark(stage, dots, BLACK, WHITE)
            if isinstance(selection, Window):
                inside = (places >= selection.left) & (places <= selection.right)
                within = (rows >= selection.top) & (rows <= selection.bottom)
                shown[...] = self._enlarged(within[:, np.newaxis] & inside)
                if is_single(selection):
                    for _ in range(DISTANCE):
                        dots = grown(dots)
                mark(stage, dots, BLACK, ORANGE)

    def _enlarged(self, pixels: Any) -> Any:
        zoom = self.layout.zoom
        return pixels if zoom == 1 else pixels.repeat(zoom, axis=0).repeat(zoom, axis=1)

    def _cells(self) -> Any:
        """The words at the pixels of the page of entries."""
        stage = self.layout.stage
        words = len(display_of(self.session).scan_out.table())
        return cells(words, stage.height - 2 * EDGE, stage.width - 2 * EDGE)

    def _draw_bar(self, bar: PackedColors, prepared: int) -> None:
        session = self.session
        bar[...] = RAISED
        bar[:, : self.bar_place(prepared) + 1] = PREPARED
        for place in {self.bar_place(write.number) for write in session.writes or ()}:
            bar[3:-3, place] = ORANGE
        for number, color in ((session.target, GRAY), (session.number, WHITE)):
            place = self.bar_place(number)
            bar[:, max(0, place - 1) : place + 2] = color

    def bar_place(self, number: int) -> int:
        """The element of the bar, counted from its left, of an instruction."""
        return number * (self.layout.bar.width - 1) // max(1, self.session.length)

    # The places of the mouse.

    def number_at(self, element: int) -> int:
        """The instruction at an element of the page, on the bar or beyond its ends."""
        width = self.layout.bar.width - 1
        place = min(max(element - self.layout.bar.left, 0), width)
        return (place * self.session.length + width // 2) // width

    def panel_at(self, place: Point) -> tuple[str, int]:
        """The part of the page at a place, and its row or number: ("listing", 3), ("button", 0), ("bar", 0).

        Rows are counted below the titles. ("stage", 0) is the field or a page; ("", 0) is nothing.
        """
        layout = self.layout
        parts = {("stage", 0): layout.stage, ("bar", 0): layout.bar}
        parts |= {("button", number): box for number, box in enumerate(layout.buttons)}
        parts |= {(name, 0): layout.boxes[name] for name in ("listing", "history")}
        for (name, number), box in parts.items():
            if box.holds(*place):
                return name, (place.line - box.top) // ROW - 1 if name in layout.boxes else number
        return "", 0

    def field_place(self, place: Point) -> Point:
        """The place of the screen at a place of the page; outside the field, the nearest."""
        field, zoom = self.layout.field, self.layout.zoom
        element = min(max(place.element - field.left, 0), field.width - 1)
        return Point(element // zoom, min(max(place.line - field.top, 0), field.height - 1) // zoom)

    def entry_at(self, place: Point) -> EntryRange | None:
        """The entry at a place of the page of entries; None if there is none."""
        words = self._cells()
        line, element = (
            min(max(at - EDGE, 0), size - 1)
            for at, size in zip((place.line, place.element), words.shape, strict=True)
        )
        word, scan_out = int(words[line, element]), display_of(self.session).scan_out
        entry = scan_out.first_entry + word
        return EntryRange(entry, entry + 1) if word < len(scan_out.table()) else None
