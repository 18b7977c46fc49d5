"""Panels: what an inspection shows beside the field, as lines of text with colors."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Final, NamedTuple

from ramtek_emu.inspection.histories import Write
from ramtek_emu.inspection.session import (
    EntryRange,
    InspectionSession,
    parameter_texts,
    selection_text,
    values_of,
)
from ramtek_emu.instruction_set.disassembler import WORDS_PER_LINE
from ramtek_emu.instruction_set.instruction import NO_WORDS
from ramtek_emu.memory.parameters import Parameters
from ramtek_emu.memory.scan_orders import Window
from ramtek_emu.monitor.overlay import ORANGE, WHITE, YELLOW
from ramtek_emu.video.view import PLAIN_VIEW, pixel_at, view_of

GRAY: Final = 0x8C929C
BLUE: Final = 0x9CC4FF
PAUSE: Final = "pause"
"""The button that pauses a host, or lets it go on."""
MARKED: Final = 0x26405F
"""The background of the current instruction."""


class Span(NamedTuple):
    """Text of one color."""

    text: str
    color: int = WHITE
    background: int | None = None
    """The color behind the text; None for that of the page."""


Line = tuple[Span, ...]


def title(session: InspectionSession) -> Line:
    """The position in the stream."""
    state = session.state
    stream = session.replay.stream
    rest = len(stream.words) - int(stream.ends[-1])
    parts = [Span(f"instruction {state.number:,} of {state.length:,}", YELLOW)]
    if state.is_following:
        parts.append(Span("  running", ORANGE))
    elif session.host is not None:
        parts.append(Span("  paused", ORANGE))
    if rest:
        parts.append(Span(f"  {rest} words of the next", GRAY))
    return tuple(parts)


def listing(session: InspectionSession) -> list[Line]:
    """The instructions around the current instruction, which is marked."""
    state = session.state
    first = min(state.first_listed, state.length)
    return [
        listed(session, number)
        for number in range(first, min(state.length + 1, first + session.listing_rows))
    ]


def listed(session: InspectionSession, number: int) -> Line:
    """A row of the listing."""
    state = session.state
    is_current, is_written = number == state.number, number in session.written
    background = MARKED if is_current else None
    mark = ">" if is_current else "*" if is_written else " "
    number_span = Span(f"{mark}{number:7} ", ORANGE if is_current or is_written else GRAY, background)
    if number == 0:
        return number_span, Span("the start", WHITE if is_current else GRAY, background)
    name, _, rest = session.meaning(number).partition(" ")
    is_ahead = number > state.number
    name_span = Span(f"{name:5} ", GRAY if is_ahead else BLUE, background)
    return number_span, name_span, Span(rest, GRAY if is_ahead else WHITE, background)


def words_of_the_instruction(session: InspectionSession, rows: int, width: int) -> list[Line]:
    """The current instruction as `ramtek list` lists it, and its reply below, in one row more.

    Lines that are longer than `width` characters are wrapped.
    """
    number = session.state.number
    if not number:
        return [(Span("before the first instruction", GRAY),)]
    item = session.replay.stream.item(number)
    texts = list(islice(wrapped(item.lines(), width), rows + 1))
    if len(texts) > rows:
        texts[rows - 1 :] = [f"{'':7}..."]
    lines: list[Line] = [(Span(text),) for text in texts]
    reply = session.replay.reply if session.replay.number == number else NO_WORDS
    if reply is None and item.instruction is not None and item.instruction.format.replies:
        lines.append((Span("reply  ", YELLOW), Span("not known", GRAY)))
    elif reply is not None and len(reply):
        more = f" .. {len(reply):,} words"
        shown = (width - len("reply  ") - len(more)) // len("0000 ")
        words = " ".join(f"{word:04X}" for word in reply[:shown].tolist())
        lines.append((Span("reply  ", YELLOW), Span(words + (more if len(reply) > shown else ""))))
    return lines


def parameters(session: InspectionSession) -> list[Line]:
    """The parameters: gray as after a reset; orange if they have changed since the last position."""
    display = session.display
    reset = parameter_texts(Parameters.at_reset(display.configuration))
    words = {
        "foreground": display.processor.parameters.foreground,
        "background": display.processor.parameters.background,
    }
    lines: list[Line] = []
    before = session.state.parameters_before
    for name, value in values_of(display).items():
        differs, moved = value != reset.get(name, "0"), value != before.get(name, value)
        color = ORANGE if moved else WHITE if differs else GRAY
        line = Span(f"{name:12}", GRAY), Span(f"{'*' if differs else ' '}{value}", color)
        swatch = (Span(" "), word_spans(session, words[name])[0]) if name in words else ()
        lines.append((*line, *swatch))
    return lines


def cursors(session: InspectionSession) -> list[Line]:
    """A line for each cursor: its place, and what is on; the joystick's switches in the first."""
    lines: list[Line] = []
    unit = session.display.cursors
    for number, cursor in enumerate(unit.all):
        states = [
            name
            for name, is_on in (
                ("visible", cursor.is_visible),
                ("blinks", cursor.blinks),
                ("ENTER", cursor.enter),
                ("TRACK", unit.track and not number),
            )
            if is_on
        ]
        color = WHITE if states else GRAY
        text = f"{cursor.element},{cursor.line} {' '.join(states)}"
        lines.append((Span(f"cursor {number}     ", GRAY), Span(text, color)))
    return lines


def pixels(session: InspectionSession) -> list[Line]:
    """The pixel or entry under the pointer, the selection, and, in another view, the place on the screen."""
    state = session.state
    lines: list[Line] = []
    view: list[Line] = []
    if state.pointed_entry is not None:
        lines.append((Span("pointer   ", YELLOW), *entry_spans(session, state.pointed_entry)))
    elif state.pointer is not None:
        display = session.display
        parameters = display.processor.parameters
        element, line = pixel_at(parameters, display.configuration, *state.pointer)
        lines.append((Span("pointer   ", YELLOW), *pixel_spans(session, element, line)))
        if view_of(parameters) != PLAIN_VIEW:
            view = [(Span(f"screen    {state.pointer.element},{state.pointer.line}", GRAY),)]
    else:
        lines.append((Span("pointer", YELLOW),))
    selection = state.selection
    if isinstance(selection, EntryRange) and selection.end - selection.first == 1:
        lines.append((Span("selected  ", YELLOW), *entry_spans(session, selection.first)))
    elif isinstance(selection, Window) and selection.width == selection.height == 1:
        lines.append((Span("selected  ", YELLOW), *pixel_spans(session, selection.left, selection.top)))
    elif selection is not None:
        lines.append((Span("selected  ", YELLOW), Span(selection_text(selection))))
    else:
        lines.append(())
    return lines + view


def pixel_spans(session: InspectionSession, element: int, line: int) -> Line:
    """A pixel of the memory: place, word, entry and color."""
    word = int(session.display.words[line, element])
    first = session.display.scan_out.first_entry
    return (
        Span(f"{element},{line}  word {word:04X} = {word}  entry {first + word} "),
        *word_spans(session, word),
    )


def entry_spans(session: InspectionSession, entry: int) -> Line:
    """An entry of the lookup table: number and color."""
    return Span(f"entry {entry} "), *color_spans(int(session.display.lookup_table.packed[entry]))


def word_spans(session: InspectionSession, word: int) -> Line:
    """The color that a word is shown in."""
    table = session.display.scan_out.table()
    return color_spans(int(table[word % len(table)]))


def history_title(session: InspectionSession) -> Line:
    """What the history is about."""
    state = session.state
    if state.writes is None or state.selection is None:
        return (
            Span("history", YELLOW),
            Span("  click a pixel, or an entry on the page of entries", GRAY),
        )
    count = len(state.writes)
    text = f"history of {selection_text(state.selection)}: {count:,} write{'' if count == 1 else 's'}"
    until = "" if state.writes_until == state.length else f" up to instruction {state.writes_until:,}"
    return Span(text, YELLOW), Span(until, GRAY)


def history(session: InspectionSession) -> list[Line]:
    """The instructions that wrote the selected pixel or entry: the word or color before and after."""
    state = session.state
    writes = (state.writes or ())[state.first_write : state.first_write + session.history_rows]
    return [write_line(session, write) for write in writes]


def write_line(session: InspectionSession, write: Write) -> Line:
    """A row of the history."""
    is_current = write.number == session.state.number
    background = MARKED if is_current else None
    if isinstance(session.state.selection, EntryRange):
        pairs = [(f"#{color:06X}", color) for color in (write.before, write.after)]
    else:
        table = session.display.scan_out.table()
        pairs = [(f"{word:04X}", int(table[word % len(table)])) for word in (write.before, write.after)]
    (before, old), (after, new) = pairs
    return (
        Span(f"{'>' if is_current else ' '}{write.number:7}  {before} ", WHITE, background),
        Span("  ", WHITE, old),
        Span(f" to {after} ", WHITE, background),
        Span("  ", WHITE, new),
        Span(f"  {session.meaning(write.number)}", WHITE if is_current else GRAY, background),
    )


def status(session: InspectionSession) -> Line:
    """The prompt, the message, or how far the preparation is."""
    state = session.state
    if state.prompt:
        asked = "go to instruction" if state.prompt == "instruction" else "go to the next (name, or Enter)"
        return Span(f"{asked}: ", YELLOW), Span(state.typed), Span("_", ORANGE)
    if state.message:
        return (Span(state.message, ORANGE),)
    if state.number != state.target:
        return (Span(f"preparing {state.prepared:,} of {state.target:,} ... Esc stops", ORANGE),)
    if session.host is None and state.prepared < state.length:
        return (Span(f"preparing {100 * state.prepared // state.length} %", GRAY),)
    return ()


def button_text(session: InspectionSession, button: str) -> str:
    """The text of a button: "pause" reads "go on" while a host waits."""
    return "go on" if button == PAUSE and not session.state.is_following else button


def wrapped(lines: Iterable[str], width: int) -> Iterator[str]:
    """The lines of a listing; the meaning of the words is on lines of its own where it does not fit."""
    for line in lines:
        place, _, rest = line.partition(":")
        words, text = rest[: 1 + 5 * WORDS_PER_LINE].strip(), rest[1 + 5 * WORDS_PER_LINE :].strip()
        if not words and len(place) + 3 + len(text) <= width:
            # Many data are listed without their words.
            yield f"{place}:  {text}"
        elif len(line) <= width:
            yield line
        else:
            if words:
                yield f"{place}: {words}"
            first = "" if words else f"{place}: "
            yield from textwrap.wrap(text, width, initial_indent=f"{first:7}", subsequent_indent=f"{'':7}")


def color_spans(color: int) -> Line:
    """A color as a swatch and a number."""
    return Span("   ", WHITE, color), Span(f" #{color:06X}")
