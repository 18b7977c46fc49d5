"""Session: an inspection of a stream as a plain value, and functions that return the next value.

An inspection stands at an instruction: its replay's display shows the state after it. `panels` puts all of it
into words. An inspection of a running display follows the display, or is paused: then the host waits, and the
inspection goes over the instructions that were executed.

Long work, such as the first pass over a stream or a search, is done in pieces by `tick`.
"""

from __future__ import annotations

import time
from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from operator import attrgetter
from typing import Any, Final, NamedTuple

import numpy as np

from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection import histories
from ramtek_emu.inspection.histories import EntryRange, Search, Selection, Write, is_single
from ramtek_emu.inspection.listing import moved, next_with, rows_from
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.running_host import MOST_BYTES, PIECE_SECONDS, RunningHost
from ramtek_emu.instruction_set.disassembler import operand_text
from ramtek_emu.instruction_set.table import OPERANDS
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.video.view import pixel_at

AT_ONCE: Final = 10
"""So many instructions are executed at once, even if no states are prepared there."""
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
    is_following: bool = False
    """Whether the session shows a running display as it runs."""
    work: PendingSearch | None = None
    pointed: Point | EntryRange | None = None
    """The place of the screen under the pointer; on the page of entries, the entry."""
    selection: Selection | None = None
    writes: tuple[Write, ...] | None = None
    """The instructions that wrote the selected pixel or entry, oldest first; None if nothing was asked."""
    writes_until: int = 0
    """The last instruction that `writes` may have."""
    page: str = ""
    """"help" or "entries" instead of the field; "" for the field."""
    typed: str | None = None
    """The number or the text that is being typed."""
    text: str = ""
    """The text that was last searched for."""
    message: str = ""
    listing_rows: int = 20
    history_rows: int = 20
    """The rows of the listing and of the history that are seen."""
    before: Mapping[str, str] = field(default_factory=dict, compare=False)
    """The values of the parameters at the position before; empty while a display runs."""

    @property
    def length(self) -> int:
        """The number of instructions in the stream."""
        return len(self.replay.stream)


def inspection_of(inspected: Replay | RunningHost) -> Inspection:
    """The inspection of a replay where it stands, or of the running display of a host."""
    if isinstance(inspected, RunningHost):
        return go_on(Inspection(replay=inspected.replay, host=inspected))
    return Inspection(replay=inspected, number=inspected.number, target=inspected.number)


# The display and the position.


def display_of(session: Inspection) -> Ramtek9300:
    """The display at the current instruction: the running display itself at the end of its stream."""
    host = session.host
    if host is not None and (session.is_following or session.number == session.length):
        return host.display
    return session.replay.display


def is_busy(session: Inspection) -> bool:
    """Whether a tick has work to do, or waits for a host itself."""
    if session.is_following and session.host is not None and session.host.server.busy:
        return True
    return session.work is not None or session.number != session.target or is_preparing(session)


def is_preparing(session: Inspection) -> bool:
    """Whether a stream is not prepared to its end; the states of a running display are kept while it runs."""
    return session.host is None and session.replay.prepared < session.length


def go(session: Inspection, number: int) -> Inspection:
    """Go to an instruction: at once if states are prepared, otherwise as soon as they are."""
    session = stopped(pause(session))
    number = min(max(number, 0), session.length)
    return _arrived(replace(session, target=number, message=""))


def step(session: Inspection, count: int) -> Inspection:
    """Go forward, or back, by some instructions."""
    return go(session, session.target + count)


def _arrived(session: Inspection) -> Inspection:
    """The inspection at its target, if going there takes a moment."""
    replay, number = session.replay, session.target
    if is_preparing(session) and number > replay.prepared and not 0 <= number - replay.number <= AT_ONCE:
        return session
    if session.number == number == replay.number:
        return session
    before = parameter_texts(replay.display)
    replay.go_to(number)
    return replace(session, number=number, before=before)


# Work in pieces.


def tick(session: Inspection) -> Inspection:
    """Do a piece of the waiting work; it takes some milliseconds, or as long as an instruction is listed."""
    if session.host is not None:
        session = _served(session, session.host)
    # A search begins where the session stands.
    if session.work is not None and session.number == session.target:
        return _worked(session, session.work)
    if is_preparing(session):
        session.replay.prepare_for(PIECE_SECONDS)
    return session if session.number == session.target else _arrived(session)


def _served(session: Inspection, host: RunningHost) -> Inspection:
    """Serve the host, and stand at its last instruction unless it is paused."""
    host.serve(not session.is_following)
    if session.replay is not host.replay:
        message = f"the instructions took {MOST_BYTES >> 20} MB of memory: they are counted from here on"
        session = tell(replace(select(session, None), replay=host.replay, number=0, target=0), message)
    return _followed(session) if session.is_following and session.length != session.number else session


def _followed(session: Inspection) -> Inspection:
    """The inspection at the end of a stream that grows, without the replay, which follows in a pause."""
    return replace(session, number=session.length, target=session.length)


def pause(session: Inspection) -> Inspection:
    """Stop the host of a running display, if it runs."""
    if not session.is_following:
        return session
    return replace(_arrived(_followed(replace(session, is_following=False))), before={}, message=PAUSED)


def go_on(session: Inspection) -> Inspection:
    """Let the host of a running display go on, and follow it."""
    if session.host is None:
        return session
    return _followed(replace(stopped(session), is_following=True, message="", before={}))


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
        return work.found(stopped(session), result.value)
    return session


def stopped(session: Inspection) -> Inspection:
    """The inspection without its search, if there is one."""
    return session if session.work is None else replace(session, work=None, message="")


# Searches.


def enter(session: Inspection, back: bool = False) -> Inspection:
    """Go to the instruction whose number was typed; else to the next whose listing has the text, or back.

    A text stays typed, to be found again.
    """
    typed = session.typed or ""
    if typed.isascii() and typed.isdigit():
        return go(replace(session, typed=None), int(typed))
    text = typed.strip() or session.text
    session = replace(pause(session), text=text)
    if not text:
        return tell(session, "type a text of the listing first, such as FORE=7 or WI WIN=")
    target, stream = session.target, session.replay.stream
    numbers = range(target - 1, 0, -1) if back else range(target + 1, session.length + 1)
    return _going_to_found(session, text, next_with(stream, text, numbers), back)


def next_change(session: Inspection, back: bool = False) -> Inspection:
    """Go to the next instruction that changes a selected pixel, rectangle or entry, or to the last before."""
    session = pause(session)
    if session.selection is None:
        return tell(session, "drag a rectangle on the field, or click a pixel or an entry first")
    search = histories.last_change if back else histories.next_change
    changes = search(session.replay, session.selection, session.target)
    return _going_to_found(session, f"change of {selection_text(session.selection)}", changes, back)


def _going_to_found(session: Inspection, what: str, search: Search[int | None], back: bool) -> Inspection:
    """Search for an instruction from the current instruction on, and go there."""
    target = session.target

    def found(session: Inspection, number: int | None) -> Inspection:
        if number is not None:
            return go(session, number)
        return tell(session, f"no {what} {'before' if back else 'after'} instruction {target:,}")

    return _started(session, what, PendingSearch(search, found))


def select(session: Inspection, selection: Selection | None, is_final: bool = True) -> Inspection:
    """Select a rectangle of the memory, entries, or nothing.

    If the selection is final, the history of a single pixel or entry is searched for.
    """
    session = replace(stopped(session), selection=selection, writes=None, message="")
    if not is_final or selection is None:
        return session
    session = pause(session)
    session = replace(session, writes_until=session.target)
    if not is_single(selection):
        return session

    def found(session: Inspection, writes: Sequence[Write]) -> Inspection:
        return replace(session, writes=tuple(writes), message="")

    search = histories.history_of(session.replay, selection, session.target)
    return _started(session, f"writes of {selection_text(selection)}", PendingSearch(search, found))


# What the user does.


def ask(session: Inspection, typed: str = "") -> Inspection:
    """Begin, or go on, to type an instruction's number or a text of the listing."""
    return replace(session, typed=typed, message="")


def escape(session: Inspection) -> Inspection:
    """Leave what was begun last: a search, going far, typing, a page, the selection."""
    if session.work is not None:
        return stopped(session)
    if session.number != session.target:
        return replace(session, target=session.number, message="")
    if session.typed is not None:
        return replace(session, typed=None, message="")
    return turn_to(session, session.page) if session.page else select(session, None)


def tell(session: Inspection, message: str) -> Inspection:
    """Show a message; "" removes it."""
    return replace(session, message=message)


def turn_to(session: Inspection, page: str) -> Inspection:
    """Show a page, or the field if the page is shown already."""
    return replace(session, page="" if session.page == page else page, pointed=None)


def click(session: Inspection, panel: str, row: int) -> Inspection:
    """Go to the instruction in a row of the "listing" or of the "history"."""
    listed = [instructions.start for instructions in shown_rows(session)]
    numbers = listed if panel == "listing" else [write.number for write in shown_writes(session)]
    return go(session, numbers[row]) if row < len(numbers) else session


def shown_rows(session: Inspection) -> list[range]:
    """The rows of the listing that are seen: around the instruction that is gone to."""
    stream, rows = session.replay.stream, session.listing_rows
    first = min(moved(stream, session.target, -(rows // 3)), moved(stream, len(stream), 1 - rows))
    return rows_from(stream, first, rows)


def shown_writes(session: Inspection) -> Sequence[Write]:
    """The writes in the rows of the history that are seen, newest first: around the current instruction."""
    writes, rows = session.writes or (), session.history_rows
    done = bisect_right(writes, session.number, key=attrgetter("number"))
    end = min(len(writes), max(rows, done + rows // 3))
    return writes[max(0, end - rows) : end][::-1]


def shown_pixels(display: Ramtek9300) -> tuple[Any, Any]:
    """The elements of the memory that are seen from left to right, and the lines from top to bottom."""
    sizes, parameters = display.configuration, display.processor.parameters
    return pixel_at(parameters, sizes, np.arange(sizes.shown_elements), np.arange(sizes.shown_lines))


def memory_window(display: Ramtek9300, first: Point, last: Point) -> Window:
    """The rectangle of the memory that is seen between two places of the screen.

    If the view wraps around an edge of the memory between them, the rectangle ends at that edge.
    """
    sizes, parameters = display.configuration, display.processor.parameters
    left, right = sorted((first.element, last.element))
    top, bottom = sorted((first.line, last.line), reverse=parameters.origin_at_bottom)
    left, top = pixel_at(parameters, sizes, left, top)
    right, bottom = pixel_at(parameters, sizes, right, bottom)
    ends = right if right >= left else sizes.elements - 1, bottom if bottom >= top else sizes.lines - 1
    return Window(left, top, *ends)


def parameter_texts(display: Ramtek9300) -> dict[str, str]:
    """The values of a display's parameters by their names, as the listing writes operands."""
    state = display.processor.parameters.state()
    values = {name: state[name] for name in PARAMETERS}
    values |= {"saved": len(display.processor.saved), "next entry": display.lookup_table.address}
    short = {"display_class": "class", "origin_at_bottom": "at bottom"}
    return {
        short.get(name, name.replace("_", " ")): value_text(name, value) for name, value in values.items()
    }


def value_text(name: str, value: Any) -> str:
    """The text of a parameter, as operands are listed; the numbers of a conic in decimal."""
    numbers = value if isinstance(value, tuple) else (int(value),)
    if name in OPERANDS and name != "conic":
        return operand_text(name, tuple(number & 0xFFFF for number in numbers))
    return ",".join(map(str, numbers))


def selection_text(selection: Selection) -> str:
    """A selection in words."""
    if isinstance(selection, EntryRange):
        first, last = selection.first, selection.end - 1
        return f"entry {first}" if is_single(selection) else f"entries {first} to {last}"
    left, top, right, bottom = selection
    return f"pixel {left},{top}" if is_single(selection) else f"rectangle {left},{top}..{right},{bottom}"
