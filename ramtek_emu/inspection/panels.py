"""Panels: what an inspection shows beside the field, as lines of text with colors."""

from __future__ import annotations

import textwrap
from bisect import bisect_left
from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import islice
from operator import attrgetter
from typing import Final

from ramtek_emu.configuration import Configuration
from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection.histories import EntryRange, Selection, Write, is_single
from ramtek_emu.inspection.listing import meaning_of
from ramtek_emu.inspection.session import (
    Inspection,
    display_of,
    is_preparing,
    parameter_texts,
    selection_text,
    shown_rows,
    shown_writes,
)
from ramtek_emu.instruction_set.disassembler import WORDS_PER_LINE
from ramtek_emu.memory.cursors import BLINK, VISIBLE
from ramtek_emu.memory.scan_orders import Window
from ramtek_emu.monitor.boxes import BLUE, GRAY, ORANGE, WHITE, YELLOW, Line, Span
from ramtek_emu.video.view import PLAIN_VIEW, pixel_at, view_of

MARKED: Final = 0x26405F
"""The background of the current instruction."""


def title(session: Inspection) -> Line:
    """The position in the stream."""
    stream = session.replay.stream
    rest = len(stream.words) - int(stream.ends[-1])
    parts = [Span(f"instruction {session.number:,} of {session.length:,}", YELLOW)]
    if session.host is not None:
        parts.append(Span("  running" if session.is_following else "  paused", ORANGE))
    if rest:
        parts.append(Span(f"  {rest} words of the next", GRAY))
    return tuple(parts)


def listing(session: Inspection) -> list[Line]:
    """The instructions around the current instruction, which is marked."""
    return [listed(session, row) for row in shown_rows(session)]


def listed(session: Inspection, row: range) -> Line:
    """A row of the listing; equal polls are a single row."""
    is_current = session.number in row
    writes = session.writes or ()
    following = bisect_left(writes, row.start, key=attrgetter("number"))
    is_written = following < len(writes) and writes[following].number in row
    number = session.number if is_current else row.start
    background = MARKED if is_current else None
    mark = ">" if is_current else "*" if is_written else " "
    number_span = Span(f"{mark}{number:7} ", ORANGE if is_current or is_written else GRAY, background)
    if number == 0:
        return number_span, Span("the start", WHITE if is_current else GRAY, background)
    name, _, rest = meaning_of(session.replay.stream, row.start).partition(" ")
    count = f"x {len(row):,}  " if len(row) > 1 else ""
    is_ahead = number > session.number
    return (
        number_span,
        Span(f"{name:5} ", GRAY if is_ahead else BLUE, background),
        Span(count, GRAY if is_ahead else YELLOW, background),
        Span(rest, GRAY if is_ahead else WHITE, background),
    )


def words_of_the_instruction(session: Inspection, rows: int, width: int) -> list[Line]:
    """The current instruction as `ramtek list` lists it, and its reply below, in one row more.

    Lines that are longer than `width` characters are wrapped.
    """
    number = session.number
    if not number:
        return [(Span("before the first instruction", GRAY),)]
    item = session.replay.stream.item(number)
    texts = list(islice(wrapped(item.lines(), width), rows + 1))
    if len(texts) > rows:
        texts[rows - 1 :] = [f"{'':7}..."]
    lines: list[Line] = [(Span(text),) for text in texts]
    reply = session.replay.reply
    if session.replay.number == number and len(reply):
        more = f" .. {len(reply):,} words"
        shown = (width - len("reply  ") - len(more)) // len("0000 ")
        words = " ".join(f"{word:04X}" for word in reply[:shown].tolist())
        lines.append((Span("reply  ", YELLOW), Span(words + (more if len(reply) > shown else ""))))
    return lines


def parameters(session: Inspection) -> list[Line]:
    """The parameters: gray as after a reset; orange if they have changed since the last position."""
    display = display_of(session)
    reset = texts_at_reset(display.configuration)
    processor, lines = display.processor.parameters, list[Line]()
    swatches = {"foreground": processor.foreground, "background": processor.background}
    for name, value in parameter_texts(display).items():
        differs, moved = value != reset[name], value != session.before.get(name, value)
        color = ORANGE if moved else WHITE if differs else GRAY
        line = Span(f"{name:12}", GRAY), Span(f"{'*' if differs else ' '}{value}", color)
        swatch = (Span(" "), word_spans(session, swatches[name])[0]) if name in swatches else ()
        lines.append((*line, *swatch))
    return lines


@lru_cache(8)
def texts_at_reset(configuration: Configuration) -> dict[str, str]:
    """The values of the parameters after a reset."""
    return parameter_texts(Ramtek9300(configuration))


def cursors(session: Inspection) -> list[Line]:
    """A line for each cursor: its place, and what is on; the joystick's switches in the first."""
    lines: list[Line] = []
    state = display_of(session).cursors.state()
    for number, cursor in enumerate(state["cursors"]):
        switches = {
            "visible": cursor["state"] & VISIBLE,
            "blinks": cursor["state"] & BLINK,
            "ENTER": cursor["enter"],
            "TRACK": state["track"] and not number,
        }
        on = " ".join(name for name, is_on in switches.items() if is_on)
        text = Span(f"{cursor['element']},{cursor['line']} {on}", WHITE if on else GRAY)
        lines.append((Span(f"cursor {number}     ", GRAY), text))
    return lines


def pixels(session: Inspection) -> list[Line]:
    """The pixel or entry under the pointer, the selection, and, in another view, the place on the screen."""
    pointed: Selection | None = None
    view: list[Line] = []
    if isinstance(session.pointed, EntryRange):
        pointed = session.pointed
    elif session.pointed is not None:
        display = display_of(session)
        parameters = display.processor.parameters
        if view_of(parameters) != PLAIN_VIEW:
            view = [(Span(f"screen    {session.pointed.element},{session.pointed.line}", GRAY),)]
        element, line = (
            int(place) for place in pixel_at(parameters, display.configuration, *session.pointed)
        )
        pointed = Window(element, line, element, line)
    parts = {"pointer   ": pointed, "selected  ": session.selection}
    return [(Span(name, YELLOW), *selection_spans(session, part)) for name, part in parts.items()] + view


def selection_spans(session: Inspection, selection: Selection | None) -> Line:
    """A pixel of the memory with its word, entry and color; an entry with its color; or a range."""
    if selection is None:
        return ()
    display = display_of(session)
    if not is_single(selection):
        return (Span(selection_text(selection)),)
    if isinstance(selection, EntryRange):
        entry = selection.first
        return Span(f"entry {entry} "), *color_spans(int(display.lookup_table.packed[entry]))
    element, line = selection.left, selection.top
    word = int(display.words[line, element])
    text = f"{element},{line}  word {word:04X} = {word}  entry {display.scan_out.first_entry + word} "
    return Span(text), *word_spans(session, word)


def word_spans(session: Inspection, word: int) -> Line:
    """The color that a word is shown in."""
    table = display_of(session).scan_out.table()
    return color_spans(int(table[word % len(table)]))


def history_title(session: Inspection) -> Line:
    """What the history is about."""
    if session.writes is None or session.selection is None:
        return (
            Span("history", YELLOW),
            Span("  click a pixel, or an entry on the page of entries", GRAY),
        )
    count = len(session.writes)
    text = f"history of {selection_text(session.selection)}: {count:,} write{'' if count == 1 else 's'}"
    until = "" if session.writes_until == session.length else f" up to instruction {session.writes_until:,}"
    return Span(text, YELLOW), Span(until, GRAY)


def history(session: Inspection) -> list[Line]:
    """The instructions that wrote the selected pixel or entry: the word or color before and after."""
    return [write_line(session, write) for write in shown_writes(session)]


def write_line(session: Inspection, write: Write) -> Line:
    """A row of the history."""
    is_current = write.number == session.number
    background = MARKED if is_current else None
    if isinstance(session.selection, EntryRange):
        pairs = [(f"#{color:06X}", color) for color in (write.before, write.after)]
    else:
        table = display_of(session).scan_out.table()
        pairs = [(f"{word:04X}", int(table[word % len(table)])) for word in (write.before, write.after)]
    (before, old), (after, new) = pairs
    return (
        Span(f"{'>' if is_current else ' '}{write.number:7}  {before} ", WHITE, background),
        Span("  ", WHITE, old),
        Span(f" to {after} ", WHITE, background),
        Span("  ", WHITE, new),
        Span(
            f"  {meaning_of(session.replay.stream, write.number)}", WHITE if is_current else GRAY, background
        ),
    )


def status(session: Inspection) -> Line:
    """The prompt, the message, or how far the preparation is."""
    if session.typed is not None:
        prompt = Span("go to, or find with (Shift+) Enter: ", YELLOW), Span(session.typed), Span("_", ORANGE)
        return (*prompt, Span(f"  {session.message}", ORANGE))
    if session.message:
        return (Span(session.message, ORANGE),)
    prepared = session.replay.prepared
    if session.number != session.target:
        return (Span(f"preparing {prepared:,} of {session.target:,} ... Esc stops", ORANGE),)
    if is_preparing(session):
        return (Span(f"preparing {100 * prepared // session.length} %", GRAY),)
    return ()


def wrapped(lines: Iterable[str], width: int) -> Iterator[str]:
    """The lines of a listing; the meaning of the words is on lines of its own where it does not fit."""
    for line in lines:
        if len(line) <= width:
            yield line
            continue
        place, _, rest = line.partition(":")
        words, text = rest[: 1 + 5 * WORDS_PER_LINE].strip(), rest[1 + 5 * WORDS_PER_LINE :].strip()
        if words:
            yield f"{place}: {words}"
        first = "" if words else f"{place}: "
        yield from textwrap.wrap(text, width, initial_indent=f"{first:7}", subsequent_indent=f"{'':7}")


def color_spans(color: int) -> Line:
    """A color as a swatch and a number."""
    return Span("   ", WHITE, color), Span(f" #{color:06X}")
