"""Page: the picture of an inspector, with the field of a display at its left and panels around it.

Below the field are the parameters; at its right the listing, the words of the instruction, the pixels and the
history; at the bottom the buttons, the bar of the whole stream and the messages. Beside a tall field, the
parameters are at the right, too. A field of few lines is enlarged by a whole number.

Only rows and lines that changed are drawn again. Measured with Xvfb, from a key to the new page, with the
work of the display in it: a step takes 2 ms and a step back 13 ms in a stream of 60,000 lines on 640 x 480,
and 4 and 12 ms on 1280 x 1024. A drag on the bar takes 14 ms, and 22 ms at most.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Colors, PackedColors
from ramtek_emu.inspection import panels
from ramtek_emu.inspection.panels import GRAY, Line, Span
from ramtek_emu.inspection.session import EntryRange, InspectionSession
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.monitor.overlay import ADVANCE, BLACK, ORANGE, WHITE, cells_of, entries_page, help_page, write
from ramtek_emu.video.scan_out import Run, united
from ramtek_emu.video.view import screen_at

ROW: Final = 11
"""The lines of a row of text."""
GAP: Final = 8
SIDE_CHARACTERS: Final = 64
"""The characters in a row of the panels at the right."""
STAGE: Final = Point(640, 480)
"""The least elements and lines for the field."""
TALL_LINES: Final = 800
"""A field with so many lines has all panels at its right."""
PARAMETERS: Final = 27
PARAMETER_COLUMNS: Final = {2: (34, 30), 3: (30, 30, 19)}
"""The widths of the columns of parameters in characters, by the number of columns."""
MARK_DISTANCE: Final = 3
"""The pixels between a selected pixel and the outline around it."""
BUTTON_LINES: Final = 15
BAR_LINES: Final = 13
RAISED: Final = 0x2B3038
"""Behind buttons, and the unprepared part of the bar."""
PREPARED: Final = 0x3F5F86


class PageBox(NamedTuple):
    """A rectangle of the page: left and top, width and height in elements and lines."""

    left: int
    top: int
    width: int
    height: int

    def holds(self, place: Point) -> bool:
        """Whether a place is in the rectangle."""
        element, line = place[0] - self.left, place[1] - self.top
        return 0 <= element < self.width and 0 <= line < self.height

    @property
    def rows(self) -> int:
        """How many rows of text fit."""
        return self.height // ROW


class PageLayout(NamedTuple):
    """The parts of a page."""

    elements: int
    lines: int
    zoom: int
    stage: PageBox
    """The place for the field or a page."""
    field: PageBox
    boxes: dict[str, PageBox]
    """The panels by name; the first row of some is their title."""
    buttons: tuple[PageBox, ...]
    bar: PageBox


def layout_of(elements: int, lines: int, cursors: int, buttons: Sequence[str]) -> PageLayout:
    """The layout around a field of some elements and lines, with these buttons."""
    zoom = max(1, min(STAGE.element // elements, STAGE.line // lines))
    stage = PageBox(0, 0, max(STAGE.element, elements * zoom), max(STAGE.line, lines * zoom))
    left, top = (stage.width - elements * zoom) // 2, (stage.height - lines * zoom) // 2
    field = PageBox(left, top, elements * zoom, lines * zoom)
    is_tall = stage.height >= TALL_LINES
    right, side = stage.width + GAP, SIDE_CHARACTERS * ADVANCE
    columns = 2 if is_tall else 3
    parameter_rows = -(-PARAMETERS // columns)
    below = 0 if is_tall else (parameter_rows + cursors) * ROW + 2 * GAP
    bottom = stage.height + below
    boxes: dict[str, PageBox] = {}
    top = GAP // 2

    def place(name: str, rows: int) -> None:
        nonlocal top
        boxes[name] = PageBox(right, top, side, rows * ROW)
        top += rows * ROW + GAP

    left_rows = (bottom - top - 4 * GAP) // ROW - 4
    if is_tall:
        left_rows -= parameter_rows + cursors + 1
    place("listing", left_rows * 45 // 100)
    place("words", left_rows * 22 // 100)
    if is_tall:
        place("parameters", parameter_rows)
        top -= GAP
        place("cursors", cursors)
    else:
        down = stage.height + GAP
        boxes["parameters"] = PageBox(GAP, down, stage.width - GAP, parameter_rows * ROW)
        boxes["cursors"] = PageBox(GAP, down + parameter_rows * ROW, stage.width - GAP, cursors * ROW)
    place("pixels", 3)
    place("history", (bottom - top) // ROW)
    places = []
    left = GAP
    for label in buttons:
        width = (len(label) + 2) * ADVANCE
        places.append(PageBox(left, bottom + 4, width, BUTTON_LINES))
        left += width + 4
    whole = right + side + GAP
    bar = PageBox(GAP, bottom + 4 + BUTTON_LINES + 5, whole - 2 * GAP, BAR_LINES)
    boxes["status"] = status = PageBox(GAP, bar.top + bar.height + 3, whole - 2 * GAP, ROW)
    return PageLayout(whole, status.top + ROW + 2, zoom, stage, field, boxes, tuple(places), bar)


def with_margin(window: Window, margin: int) -> Window:
    """A window with a margin around it."""
    return Window(window.left - margin, window.top - margin, window.right + margin, window.bottom + margin)


class InspectorPage:
    """The page of a session, as a field for a window; the help page shows `help_rows`: keys and actions."""

    def __init__(
        self,
        session: InspectionSession,
        buttons: Sequence[str],
        help_rows: Sequence[tuple[str, str]],
        title: str,
    ) -> None:
        self.session = session
        scan_out = session.display.scan_out
        self.layout = layout_of(
            scan_out.elements, scan_out.lines, session.display.configuration.cursors, buttons
        )
        self.elements, self.lines = self.layout.elements, self.layout.lines
        self.blink_is_on = True
        self._buttons = tuple(buttons)
        self._help_rows, self._title = help_rows, title
        boxes = self.layout.boxes
        session.set_rows(boxes["listing"].rows - 1, boxes["history"].rows - 1)
        self._pixels: PackedColors = np.full((self.lines, self.elements), BLACK, np.uint32)
        self._field: PackedColors = np.zeros((scan_out.lines, scan_out.elements), np.uint32)
        self._of: object = None
        """The display whose field was scanned out last."""
        self._field_stamp: Any = None
        self._stage_stamp: Any = None
        """What the stage shows beside the field."""
        self._marks: tuple[Run, ...] = ()
        """The lines of the stage with marks on them."""
        self._rows: dict[tuple[str, int, int], Line] = {}
        """The rows of the panels as they were drawn, by panel, column and row."""
        self._drawn: Any = None
        self._before: Any = None
        self._runs: tuple[Run, ...] = ()
        """The lines that the last drawing changed."""
        self._bar: tuple[object, ...] = ()
        """What the bar shows."""
        self._draw_frame()

    # A field for the window.

    @property
    def stamp(self) -> Any:
        """A value that changes whenever a pixel may have changed."""
        display = self.session.display
        # The display may be another than at the last blink.
        display.scan_out.blink_is_on = self.blink_is_on
        return self.session.state, display.scan_out.stamp

    def lines_changed_since(self, last: Any) -> tuple[Run, ...]:
        """The lines that may have changed since the page with the stamp `last`; all lines for None."""
        self.draw()
        if last == self._drawn:
            return ()
        if last is not None and last == self._before:
            return self._runs
        return ((0, self.lines),)

    def scan_out_changes_into(self, pixels: PackedColors, last: Any) -> Any:
        """Bring pixels with the stamp `last` up to date, and return their new stamp."""
        for first, end in self.lines_changed_since(last):
            pixels[first:end] = self._pixels[first:end]
        return self._drawn

    def table(self) -> PackedColors:
        """The colors of all words of the display."""
        return self.session.display.scan_out.table()

    def field(self) -> Colors:
        """The field of the display, without the page around it."""
        return self.session.display.field()

    def colors(self) -> Colors:
        """The whole page, (lines, elements, 3) uint8."""
        self.draw()
        return self._pixels.astype("<u4").view(np.uint8).reshape(self.lines, self.elements, 4)[:, :, 2::-1]

    # Drawing.

    def draw(self) -> None:
        """Draw everything that changed."""
        stamp = self.stamp
        if stamp == self._drawn:
            return
        runs: list[Run] = []
        self._draw_stage(runs)
        session, boxes = self.session, self.layout.boxes
        self._draw_rows("listing", [panels.title(session), *panels.listing(session)], runs)
        words = panels.words_of_the_instruction(session, boxes["words"].rows - 1, SIDE_CHARACTERS)
        self._draw_rows("words", words, runs)
        self._draw_rows("parameters", panels.parameters(session), runs)
        self._draw_rows("cursors", panels.cursors(session), runs)
        self._draw_rows("pixels", panels.pixels(session), runs)
        self._draw_rows("history", [panels.history_title(session), *panels.history(session)], runs)
        self._draw_rows("status", [panels.status(session)], runs)
        self._draw_buttons(runs)
        self._draw_bar(runs)
        self._before, self._drawn = self._drawn, stamp
        self._runs = united(runs, self.lines)

    def _draw_frame(self) -> None:
        stage = self.layout.stage
        bottom = self.layout.bar.top - BUTTON_LINES - 9
        self._pixels[: stage.height, : stage.width] = 0
        self._pixels[:bottom, stage.width] = RAISED
        self._pixels[stage.height, : stage.width] = self._pixels[bottom] = RAISED

    def _draw_stage(self, runs: list[Run]) -> None:
        session, stage, field = self.session, self.layout.stage, self.layout.field
        state, scan_out = session.state, session.display.scan_out
        if self._of is not session.display:
            self._of, self._field_stamp, self._stage_stamp = session.display, None, None
        if state.page:
            table = (session.display.lookup_table.written, scan_out.first_entry)
            chosen = state.selection if isinstance(state.selection, EntryRange) else None
            shown: Any = (state.page, chosen, *table) if state.page == "entries" else state.page
            if shown != self._stage_stamp:
                self._stage_stamp, self._field_stamp = shown, None
                pixels = self._pixels[: stage.height, : stage.width]
                if state.page == "help":
                    pixels[...] = help_page(stage.height, stage.width, self._title, self._help_rows)
                else:
                    pixels[...] = entries_page(scan_out.table(), stage.height, stage.width)
                    if chosen is not None:
                        self._mark_entries(pixels, chosen)
                runs.append((0, stage.height))
            return
        marks = self._marked_windows()
        changed = scan_out.lines_changed_since(self._field_stamp)
        if self._field_stamp is None:
            # A page, or the field of another display, was here.
            self._pixels[: stage.height, : stage.width] = 0
            runs.append((0, stage.height))
        self._field_stamp = scan_out.scan_out_changes_into(self._field, self._field_stamp)
        margin = MARK_DISTANCE + 1
        lines_of_marks = tuple((window.top - margin, window.bottom + 1 + margin) for window in marks)
        if self._stage_stamp != marks:
            changed = united([*changed, *self._marks, *lines_of_marks], len(self._field))
        elif changed:
            changed = united([*changed, *lines_of_marks], len(self._field))
        self._stage_stamp, self._marks = marks, lines_of_marks
        zoom = self.layout.zoom
        for first, end in changed:
            part = self._field[first:end]
            if zoom > 1:
                part = part.repeat(zoom, axis=0).repeat(zoom, axis=1)
            top = field.top + first * zoom
            self._pixels[top : top + len(part), field.left : field.left + field.width] = part
            runs.append((top, top + len(part)))
        if changed:
            for window in marks:
                self._mark(window)

    def _marked_windows(self) -> tuple[Window, ...]:
        """The selection as a rectangle of the screen, if it is seen."""
        session = self.session
        selection = session.state.selection
        if not isinstance(selection, Window):
            return ()
        parameters, configuration = session.display.processor.parameters, session.display.configuration
        across, down = parameters.zoom
        left, top = screen_at(parameters, configuration, selection.left, selection.top)
        width, height = selection.width * across, selection.height * down
        top = top - height + 1 if parameters.origin_at_bottom else top
        if left >= configuration.shown_elements or not -height < top < configuration.shown_lines:
            return ()
        return (
            Window(left, max(0, top), left + width - 1, min(top + height, configuration.shown_lines) - 1),
        )

    def _mark(self, window: Window) -> None:
        """Draw an outline around a window, at some distance from a single pixel."""
        zoom, field = self.layout.zoom, self.layout.field
        if window.width * zoom < MARK_DISTANCE and window.height * zoom < MARK_DISTANCE:
            window = with_margin(window, MARK_DISTANCE)
        left, top = field.left + window.left * zoom - 1, field.top + window.top * zoom - 1
        right, bottom = field.left + (window.right + 1) * zoom, field.top + (window.bottom + 1) * zoom
        for line in (top, bottom):
            self._contrast(left, line, right + 1, line + 1)
        for element in (left, right):
            self._contrast(element, top + 1, element + 1, bottom)

    def _contrast(self, left: int, top: int, right: int, bottom: int) -> None:
        """Draw white where it is dark and black where it is light, clipped to the field."""
        field = self.layout.field
        lines = slice(max(field.top, top), max(0, min(bottom, field.top + field.height)))
        elements = slice(max(field.left, left), max(0, min(right, field.left + field.width)))
        part = self._pixels[lines, elements]
        part[...] = np.where(part >> 15 & 1, np.uint32(0), np.uint32(0xFFFFFF))

    def _mark_entries(self, pixels: PackedColors, entries: EntryRange) -> None:
        first = self.session.display.scan_out.first_entry
        for entry in range(entries.first, entries.end):
            box = self._cell(entry - first)
            part = pixels[box.top : box.top + box.height, box.left : box.left + box.width]
            color = np.uint32(0 if int(part[-1, -1]) >> 15 & 1 else 0xFFFFFF)
            part[0, :] = part[-1, :] = color
            part[:, 0] = part[:, -1] = color

    def _cell(self, word: int) -> PageBox:
        """The cell of a word on the page of entries, as `entries_page` divides the stage."""
        columns, rows = cells_of(len(self.table()))
        stage = self.layout.stage
        row, column = divmod(word, columns)
        left, top = -(-column * stage.width // columns), -(-row * stage.height // rows)
        right, bottom = -(-(column + 1) * stage.width // columns), -(-(row + 1) * stage.height // rows)
        return PageBox(left, top, right - left, bottom - top)

    def _draw_rows(self, name: str, lines: Sequence[Line], runs: list[Run]) -> None:
        """Draw the rows of a panel that changed; parameters are in columns, which are read down."""
        box = self.layout.boxes[name]
        widths: Sequence[int] = (box.width // ADVANCE,)
        if name == "parameters":
            widths = PARAMETER_COLUMNS[-(-PARAMETERS // box.rows)]
        for index in range(len(widths) * box.rows):
            column, row = divmod(index, box.rows)
            line = lines[index] if index < len(lines) else ()
            key = name, column, row
            if self._rows.get(key) != line:
                self._rows[key] = line
                left, top = box.left + sum(widths[:column]) * ADVANCE, box.top + row * ROW
                self._write(line, PageBox(left, top, widths[column] * ADVANCE, ROW))
                runs.append((top, top + ROW))

    def _write(self, line: Line, box: PageBox, background: int = BLACK) -> None:
        """Write a line of spans into a box; text that is too long ends in two periods."""
        row = self._pixels[box.top : box.top + box.height, box.left : box.left + box.width]
        row[...] = background
        left, most = 0, box.width // ADVANCE
        for span in line:
            text = span.text
            if left + len(text) > most:
                text = f"{text[: max(0, most - left - 2)]}.."[: most - left]
            begin, left = left * ADVANCE, left + len(text)
            if span.background is None:
                write(row, text, begin, 1, span.color, background)
            elif text.isspace():
                # A swatch, apart from the swatches above and below it.
                row[1:-1, begin : left * ADVANCE] = span.background
            else:
                # A marked row is marked to its end.
                row[:, begin:] = span.background
                write(row, text, begin, 1, span.color, span.background)

    def _draw_buttons(self, runs: list[Run]) -> None:
        labels = [panels.button_text(self.session, button) for button in self._buttons]
        for number, (box, label) in enumerate(zip(self.layout.buttons, labels, strict=True)):
            key, line = ("button", number, 0), (Span(f" {label} "),)
            if self._rows.get(key) != line:
                self._rows[key] = line
                self._pixels[box.top : box.top + box.height, box.left : box.left + box.width] = RAISED
                self._write(line, PageBox(box.left, box.top + 2, box.width, ROW), RAISED)
                runs.append((box.top, box.top + box.height))

    def _draw_bar(self, runs: list[Run]) -> None:
        state, box = self.session.state, self.layout.bar
        prepared = state.length if self.session.host is not None else state.prepared
        numbers = prepared, state.number, state.target
        prepared_to, number, target = places = [self.bar_place(number) for number in numbers]
        shown = *places, state.length, state.writes
        if shown == self._bar:
            return
        self._bar = shown
        bar = self._pixels[box.top : box.top + box.height, box.left : box.left + box.width]
        bar[...] = RAISED
        bar[:, : prepared_to + 1] = PREPARED
        bar[3:-3, list({self.bar_place(write.number) for write in state.writes or ()})] = ORANGE
        for place, color in ((target, GRAY), (number, WHITE)):
            bar[:, max(0, place - 1) : place + 2] = color
        runs.append((box.top, box.top + box.height))

    def bar_place(self, number: int) -> int:
        """The element of the bar, counted from its left, of an instruction."""
        return number * (self.layout.bar.width - 1) // max(1, self.session.state.length)

    # The places of the mouse.

    def number_at(self, element: int) -> int:
        """The instruction at an element of the page, on the bar or beyond its ends."""
        width = self.layout.bar.width - 1
        place = min(max(element - self.layout.bar.left, 0), width)
        return (place * self.session.state.length + width // 2) // width

    def panel_at(self, place: Point) -> tuple[str, int]:
        """The part of the page at a place, and its row or number: ("listing", 3), ("button", 0), ("bar", 0).

        Rows are counted below the titles. ("stage", 0) is the field or a page; ("", 0) is nothing.
        """
        if self.layout.stage.holds(place):
            return "stage", 0
        for number, button in enumerate(self.layout.buttons):
            if button.holds(place):
                return "button", number
        if self.layout.bar._replace(top=self.layout.bar.top - 3).holds(place):
            return "bar", 0
        for name in ("listing", "history"):
            box = self.layout.boxes[name]
            if box.holds(place):
                return name, (place.line - box.top) // ROW - 1
        return "", 0

    def field_place(self, place: Point) -> Point:
        """The place of the screen at a place of the page; outside the field, the nearest."""
        field, zoom = self.layout.field, self.layout.zoom
        element, line = (place.element - field.left) // zoom, (place.line - field.top) // zoom
        lines, elements = self._field.shape
        return Point(min(max(element, 0), elements - 1), min(max(line, 0), lines - 1))

    def entry_at(self, place: Point) -> int | None:
        """The entry at a place of the page of entries; None if there is none."""
        columns, rows = cells_of(len(self.table()))
        stage = self.layout.stage
        element = min(max(place.element, 0), stage.width - 1)
        line = min(max(place.line, 0), stage.height - 1)
        word = line * rows // stage.height * columns + element * columns // stage.width
        return self.session.display.scan_out.first_entry + word if word < len(self.table()) else None
