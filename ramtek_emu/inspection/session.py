"""Session: an inspection of a stream as a plain value, and functions that return the next value.

An inspection stands at an instruction: its replay's display shows the state after it. `panels` puts all of it
into words. An inspection of a running display follows the display, or is paused: then the host waits, and the
inspection goes over the instructions that were executed, and lets the host's next instructions through.

Long work, such as the first pass over a stream or a search, is done in pieces by `tick`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Dots
from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection import histories
from ramtek_emu.inspection.histories import EntryRange, Search, Selection, Write
from ramtek_emu.inspection.listing import meaning_of, moved, next_with, pattern_of, rows_from
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.running_host import MOST_BYTES, PIECE_SECONDS, RunningHost
from ramtek_emu.inspection.watching import watched
from ramtek_emu.instruction_set.disassembler import IN_HEXADECIMAL
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.video.view import pixel_at

FOLLOW_SECONDS: Final = 0.05
"""How often the panels follow a running display, whose field follows at every tick, or a preparation."""
AT_ONCE: Final = 10
"""So many instructions are executed at once, even if no states are prepared there."""
MOST_TYPED: Final = 60
"""The most characters of a text that is typed."""
PAUSED: Final = "paused: the host waits"
PARAMETERS: Final = (
    "mask", "foreground", "background", "start", "window", "scan_order", "dimensions", "spacing", "texture",
    "write_window", "read_mask", "write_offset", "index_1", "index_2", "origin", "conic", "scale", "function",
    "base_line", "scroll", "display_class", "image_mode", "zoom", "origin_at_bottom", "font",
)  # fmt: skip
"""The parameters in the order of the panel; two more values of the display follow."""


class PendingSearch(NamedTuple):
    """A search that runs in pieces, and the inspection with its result."""

    search: Search[Any]
    found: Callable[[Inspection, Any], Inspection]


@dataclass(frozen=True, kw_only=True)
class Inspection:
    """An inspection of the instructions of a replay, or of a running display."""

    replay: Replay
    host: RunningHost | None = None
    number: int = 0
    """The instruction after which the display is shown; 0 is the start."""
    target: int = 0
    """The instruction to go to; `number` follows as soon as states are prepared."""
    length: int = 0
    """The number of instructions in the stream."""
    prepared: int = 0
    """States are prepared up to this instruction."""
    written: Dots | None = field(default=None, compare=False)
    """The (lines, elements) words that the instruction writes, also words that stay the same."""
    is_following: bool = False
    """Whether the session shows a running display as it runs."""
    wanted: int = 0
    """The number of instructions that a paused host may still execute."""
    awaited: Callable[[], bool] | None = None
    """Whether the last instruction is what a paused host's instructions are let through for."""
    work: PendingSearch | None = None
    pointer: Point | None = None
    pointed_entry: int | None = None
    """The entry under the pointer, on the page of entries."""
    selection: Selection | None = None
    writes: tuple[Write, ...] | None = None
    """The instructions that wrote the selected pixel or entry, newest first; None if nothing was asked."""
    writes_until: int = 0
    """The last instruction that `writes` may have."""
    page: str = ""
    """"help" or "entries" instead of the field; "" for the field."""
    prompt: str = ""
    """What is being typed: "instruction" or "text"; "" for nothing."""
    typed: str = ""
    text: str = ""
    """The text that was last searched for."""
    message: str = ""
    listing_rows: int = 20
    history_rows: int = 20
    """The rows of the listing and of the history that are seen."""
    first_listed: int = 0
    """The first instruction of the listing."""
    first_write: int = 0
    """The first row of the history."""
    before: Mapping[str, str] = field(default_factory=dict, compare=False)
    """The values of the parameters at the position before; empty while a display runs."""
    followed: float = field(default=0.0, compare=False)
    """When the panels last followed a display or a preparation."""


def inspection_of(replay: Replay, host: RunningHost | None = None) -> Inspection:
    """The inspection of a replay where it stands; with a host and its replay, of a running display."""
    return Inspection(
        replay=replay, host=host, number=replay.number, target=replay.number, length=len(replay.stream),
        prepared=replay.prepared, is_following=host is not None,
    )  # fmt: skip


# The display and the position.


def display_of(session: Inspection) -> Ramtek9300:
    """The display at the current instruction: the running display itself at the end of its stream."""
    host = session.host
    if host is not None and (session.is_following or session.number == session.length):
        return host.display
    return session.replay.display


def is_busy(session: Inspection) -> bool:
    """Whether a tick has work to do, or waits for a host itself."""
    host = session.host
    waits = session.is_following or session.wanted or session.awaited
    if host is not None and waits and host.is_connected():
        return True
    is_prepared = host is not None or session.prepared >= session.length
    return session.work is not None or session.number != session.target or not is_prepared


def with_rows(session: Inspection, listing: int, history: int) -> Inspection:
    """The inspection with so many rows of the listing and of the history on its page."""
    session = replace(session, listing_rows=listing, history_rows=history)
    return replace(session, first_listed=_first_listed(session, session.number))


def go(session: Inspection, number: int) -> Inspection:
    """Go to an instruction: at once if states are prepared, otherwise as soon as they are."""
    session = stopped(pause(session))
    number = min(max(number, 0), session.length)
    first = _first_listed(session, number)
    session = replace(session, target=number, wanted=0, awaited=None, message="", first_listed=first)
    return _arrived(session)


def step(session: Inspection, count: int) -> Inspection:
    """Go forward, or back, by some instructions; at its end a paused host executes them."""
    left = session.length - session.target
    if session.host is not None and not session.is_following and count > left:
        message = "waiting for the host's next instruction"
        return replace(go(session, session.length), wanted=count - left, message=message)
    return go(session, session.target + count)


def _arrived(session: Inspection) -> Inspection:
    """The inspection at its target, if going there takes a moment."""
    replay, ahead = session.replay, session.target - session.replay.number
    if session.host is None and session.target > replay.prepared and not 0 <= ahead <= AT_ONCE:
        return session
    return _standing(session, session.target)


def _standing(session: Inspection, number: int) -> Inspection:
    """The inspection at an instruction; the words that the instruction writes are noted."""
    replay = session.replay
    if session.number == number == replay.number and (session.written is not None or not number):
        return session
    before = session.before if number == replay.number else parameter_texts(replay.display)
    written = None
    if number:
        replay.go_to(number - 1)
        display = replay.display
        written = watched(display).watch(display.frame_buffer.window)
        if replay.state_before(number).number == number:
            # The state that was kept here is restored without executing the instruction.
            display.send(replay.stream.words_between(number - 1, number))
            written = written.copy()
    replay.go_to(number)
    return replace(
        session, number=number, target=number, prepared=replay.prepared, written=written, before=before
    )


def _first_listed(session: Inspection, number: int) -> int:
    """The first instruction of a listing that shows an instruction with some neighbors."""
    stream, rows = session.replay.stream, session.listing_rows
    shown = rows_from(stream, session.first_listed, rows)
    if len(shown) == rows and shown[3].start <= number < shown[-3].start:
        return session.first_listed
    return min(moved(stream, number, -(rows // 3)), moved(stream, len(stream), 1 - rows))


# Work in pieces.


def tick(session: Inspection) -> Inspection:
    """Do a piece of the waiting work; it takes some milliseconds at most."""
    if session.host is not None:
        session = _served(session, session.host)
    # A search begins where the session stands.
    if session.work is not None and session.number == session.target:
        return _worked(session, session.work)
    # The states of a running display are kept while it runs.
    if session.host is None and session.prepared < session.length:
        is_done, now = not session.replay.prepare_for(PIECE_SECONDS), time.monotonic()
        if is_done or now - session.followed > FOLLOW_SECONDS:
            session = replace(session, prepared=session.replay.prepared, followed=now)
    return session if session.number == session.target else _arrived(session)


def _served(session: Inspection, host: RunningHost) -> Inspection:
    """Serve the host, and stand at its last instruction unless it is stopped."""
    is_reached, end = False, time.monotonic() + PIECE_SECONDS
    if session.awaited is None:
        host.serve(None if session.is_following else session.wanted)
    else:
        while not is_reached and time.monotonic() < end:
            length = len(host.replay.stream)
            host.serve(1)
            if len(host.replay.stream) == length:
                break
            is_reached = session.awaited()
    if host.replay is not session.replay:
        message = f"the instructions took {MOST_BYTES >> 20} MB of memory: they are counted from here on"
        session = replace(select(session, None), replay=host.replay, written=None, message=message)
        session = replace(session, length=0, number=0, target=0, prepared=0, first_listed=0)
    length, now = len(session.replay.stream), time.monotonic()
    if is_reached:
        return replace(_at_the_end(session), awaited=None, message="")
    if length == session.length:
        return session
    if session.is_following or session.awaited is not None:
        is_due = now - session.followed > FOLLOW_SECONDS
        return replace(_followed(session), followed=now) if is_due else session
    wanted = max(0, session.wanted - (length - session.length))
    return replace(_at_the_end(session), wanted=wanted, message=session.message if wanted else "")


def _followed(session: Inspection) -> Inspection:
    """The inspection at the end of a stream that grows, without the replay, which follows in a pause."""
    length = len(session.replay.stream)
    session = replace(session, number=length, target=length, length=length, written=None)
    return replace(session, first_listed=_first_listed(session, length))


def _at_the_end(session: Inspection) -> Inspection:
    return _standing(_followed(session), len(session.replay.stream))


def pause(session: Inspection) -> Inspection:
    """Stop the host of a running display, if it runs."""
    if not session.is_following:
        return session
    return replace(_at_the_end(replace(session, is_following=False)), before={}, message=PAUSED)


def go_on(session: Inspection) -> Inspection:
    """Let the host of a running display go on, and follow it."""
    if session.host is None:
        return session
    session = replace(stopped(session), is_following=True, wanted=0, awaited=None, message="", before={})
    return _followed(session)


def _started(session: Inspection, what: str, work: PendingSearch) -> Inspection:
    session = replace(session, work=work, message=f"searching for {what} ... Esc stops")
    return _worked(session, work) if session.number == session.target else session


def _worked(session: Inspection, work: PendingSearch) -> Inspection:
    end = time.monotonic() + PIECE_SECONDS
    try:
        next(work.search)
        while time.monotonic() < end:
            next(work.search)
    except StopIteration as result:
        return work.found(replace(stopped(session), prepared=session.replay.prepared), result.value)
    return session


def stopped(session: Inspection) -> Inspection:
    """The inspection without its search, if there is one."""
    return session if session.work is None else replace(session, work=None, message="")


def _awaiting(session: Inspection, what: str, is_reached: Callable[[], bool]) -> Inspection:
    """Let a paused host's instructions through until `is_reached()` is true after one of them."""
    message = f"waiting for the host: {what} ... Esc stops"
    return replace(go(session, session.length), awaited=is_reached, message=message)


# Searches.


def find(session: Inspection, back: bool = False) -> Inspection:
    """Go to the next instruction whose row of the listing has the typed text, or to the last one before.

    At the end of what a paused host has sent, its instructions are let through until one has the text.
    """
    text = session.typed.strip() if session.prompt == "text" and session.typed.strip() else session.text
    session = replace(pause(session), text=text)
    if not text:
        return replace(session, message="type a text of the listing first, such as FORE=7 or WI WIN=")
    target, stream, host = session.target, session.replay.stream, session.host
    numbers = range(target - 1, 0, -1) if back else range(target + 1, session.length + 1)

    def found(session: Inspection, number: int | None) -> Inspection:
        if number is not None:
            return go(session, number)
        if host is not None and not back:
            pattern = pattern_of(text)

            def is_reached() -> bool:
                stream = host.replay.stream
                return len(stream) > 0 and pattern.search(meaning_of(stream, len(stream))) is not None

            return _awaiting(session, text, is_reached)
        where = "before" if back else "after"
        return replace(session, message=f"no {text} {where} instruction {target:,}")

    return _started(session, text, PendingSearch(next_with(stream, text, numbers), found))


def next_change(session: Inspection, back: bool = False) -> Inspection:
    """Go to the next instruction that changes a selected pixel, rectangle or entry, or to the last before.

    At the end of what a paused host has sent, its instructions are let through until such a change.
    """
    session = pause(session)
    selection, target, host = session.selection, session.target, session.host
    if selection is None:
        return tell(session, "drag a rectangle on the field, or click a pixel or an entry first")
    search = histories.last_change if back else histories.next_change
    changes = search(session.replay, selection, target)

    def found(session: Inspection, number: int | None) -> Inspection:
        if number is not None:
            return go(session, number)
        if host is not None and not back:
            values = selected_values(host.display, selection)
            what = f"a change of {selection_text(selection)}"
            return _awaiting(session, what, lambda: selected_values(host.display, selection) != values)
        where = "before" if back else "after"
        return tell(session, f"{selection_text(selection)}: no change {where} instruction {target:,}")

    return _started(session, f"a change of {selection_text(selection)}", PendingSearch(changes, found))


def select(session: Inspection, selection: Selection | None, is_final: bool = True) -> Inspection:
    """Select a rectangle of the memory, entries, or nothing.

    If the selection is final, the history of a single pixel or entry is searched for.
    """
    session = replace(stopped(session), selection=selection, writes=None, first_write=0, message="")
    if not is_final or selection is None:
        return session
    session = pause(session)
    until = session.target
    session = replace(session, writes_until=until)
    if isinstance(selection, EntryRange):
        size = selection.end - selection.first
    else:
        size = selection.width * selection.height
    if size != 1:
        return session

    def found(session: Inspection, writes: Sequence[Write]) -> Inspection:
        return replace(session, writes=tuple(reversed(writes)), message="")

    return _started(
        session,
        f"writes of {selection_text(selection)}",
        PendingSearch(histories.history_of(session.replay, selection, until), found),
    )


def next_write(session: Inspection, back: bool) -> Inspection:
    """Go to the next older, or newer, instruction of the history."""
    if session.writes is None:
        return tell(session, "click a pixel or an entry first")
    numbers = [write.number for write in session.writes]
    if back:
        numbers = [number for number in numbers if number < session.number][:1]
    else:
        numbers = [number for number in numbers if number > session.number][-1:]
    if numbers:
        return go(session, numbers[0])
    return tell(session, f"no {'earlier' if back else 'later'} instruction in the history")


# What the user does.


def takes(session: Inspection, text: str) -> bool:
    """Whether the prompt takes a character: digits for an instruction, all for a text of the listing."""
    if session.prompt == "instruction":
        return text.isascii() and text.isdigit()
    return session.prompt == "text" and text.isprintable() and text != ""


def ask(session: Inspection, prompt: str, typed: str = "") -> Inspection:
    """Begin, or go on, to type an instruction's number or a text."""
    return replace(session, prompt=prompt, typed=typed[:MOST_TYPED], message="")


def enter(session: Inspection, back: bool = False) -> Inspection:
    """Go to the instruction that was typed; else find the text, whose prompt stays."""
    if session.prompt != "instruction":
        return find(session, back)
    typed = session.typed
    session = replace(session, prompt="", typed="")
    return go(session, int(typed)) if typed else session


def escape(session: Inspection) -> Inspection:
    """Leave what was begun last: a search, waiting, typing, a page, the selection."""
    if session.work is not None:
        return stopped(session)
    if session.wanted or session.awaited is not None:
        return replace(session, wanted=0, awaited=None, message=PAUSED)
    if session.number != session.target:
        first = _first_listed(session, session.number)
        return replace(session, target=session.number, first_listed=first, message="")
    if session.prompt:
        return replace(session, prompt="", typed="", message="")
    return turn_to(session, session.page) if session.page else select(session, None)


def tell(session: Inspection, message: str) -> Inspection:
    """Show a message; "" removes it."""
    return replace(session, message=message)


def turn_to(session: Inspection, page: str) -> Inspection:
    """Show a page, or the field if the page is shown already."""
    return replace(session, page="" if session.page == page else page, pointed_entry=None, pointer=None)


def scroll_listing(session: Inspection, rows: int) -> Inspection:
    """Move the listing, and stay at the current instruction."""
    stream = session.replay.stream
    last = moved(stream, len(stream), 1 - session.listing_rows)
    return replace(session, first_listed=min(moved(stream, session.first_listed, rows), last))


def scroll_history(session: Inspection, rows: int) -> Inspection:
    """Move the history."""
    last = max(0, len(session.writes or ()) - session.history_rows)
    return replace(session, first_write=min(max(0, session.first_write + rows), last))


def click_listing(session: Inspection, row: int) -> Inspection:
    """Go to the instruction in a row of the listing."""
    rows = rows_from(session.replay.stream, session.first_listed, row + 1)
    return go(session, rows[row].start) if row < len(rows) else session


def click_history(session: Inspection, row: int) -> Inspection:
    """Go to the instruction in a row of the history."""
    writes = (session.writes or ())[session.first_write :]
    return go(session, writes[row].number) if row < len(writes) else session


def shown_pixels(display: Ramtek9300) -> tuple[Any, Any]:
    """The elements of the memory that are seen from left to right, and the lines from top to bottom."""
    sizes, parameters = display.configuration, display.processor.parameters
    return pixel_at(parameters, sizes, np.arange(sizes.shown_elements), np.arange(sizes.shown_lines))


def memory_window(display: Ramtek9300, first: Point, last: Point) -> Window:
    """The rectangle of the memory that is seen between two places of the screen.

    If the view wraps around an edge of the memory between them, the rectangle ends at that edge.
    """
    elements, lines = shown_pixels(display)
    left, right = sorted((first.element, last.element))
    top, bottom = sorted((first.line, last.line))
    elements, lines = elements[left : right + 1], lines[top : bottom + 1]
    if display.processor.parameters.origin_at_bottom:
        lines = lines[::-1]
    ends = (int(places[places >= places[0]].max()) for places in (elements, lines))
    return Window(int(elements[0]), int(lines[0]), *ends)


def parameter_texts(display: Ramtek9300) -> dict[str, str]:
    """The values of a display's parameters by their names, as the listing writes operands."""
    state = display.state()
    values = {name: state["parameters"][name] for name in PARAMETERS}
    values |= {"saved": len(state["processor"]["saved"])}
    values |= {"next entry": state["lookup_table"]["table_address"]}
    short = {"display_class": "class", "origin_at_bottom": "at bottom"}
    return {
        short.get(name, name.replace("_", " ")): value_text(name, value) for name, value in values.items()
    }


def value_text(name: str, value: Any) -> str:
    """The text of a parameter: masks and bits in hexadecimal, a window by its corners."""
    numbers = value if isinstance(value, tuple) else (int(value),)
    if name in IN_HEXADECIMAL and name != "conic":
        return ",".join(f"0x{number:04X}" for number in numbers)
    if isinstance(value, Window):
        return "{},{}..{},{}".format(*value)
    return ",".join(map(str, numbers))


def selected_values(display: Ramtek9300, selection: Selection) -> bytes:
    """The words of a window, or the colors of entries, to compare."""
    if isinstance(selection, EntryRange):
        return display.lookup_table.packed[selection.first : selection.end].tobytes()
    return display.words[selection.top : selection.bottom + 1, selection.left : selection.right + 1].tobytes()


def selection_text(selection: Selection) -> str:
    """A selection in words."""
    if isinstance(selection, EntryRange):
        if selection.end - selection.first == 1:
            return f"entry {selection.first}"
        return f"entries {selection.first} to {selection.end - 1}"
    if selection.width == selection.height == 1:
        return f"pixel {selection.left},{selection.top}"
    return f"rectangle {selection.left},{selection.top}..{selection.right},{selection.bottom}"
