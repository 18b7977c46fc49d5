"""Session: an inspection of a stream, as plain values; no window is needed.

A session stands at an instruction: the display shows the state after it. The user steps, searches, selects
pixels or entries, and asks which instructions wrote them. `panels` puts all of it into words.

A session of a running display follows the display, or is paused: then the host waits, and the session goes
back and forth over the instructions that were executed, and lets the host's next instructions through.

Long work, such as the first pass over a stream or a search, is done in pieces by `tick`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, Final

import numpy as np

from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection import histories
from ramtek_emu.inspection.histories import EntryRange as EntryRange
from ramtek_emu.inspection.histories import Search, Write
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.running_host import MOST_BYTES, PIECE_SECONDS, RunningHost
from ramtek_emu.instruction_set.disassembler import (
    ListingItem,
    data_texts,
    head_text,
    operand_text,
)
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME, FORMATS
from ramtek_emu.memory.parameters import Parameters
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.video.view import pixel_at

FOLLOW_SECONDS: Final = 0.05
"""How often the panels follow a running display, whose field follows at every tick, or a preparation."""
AT_ONCE: Final = 10
"""So many instructions are executed at once, even if no states are prepared there."""
MOST_TYPED: Final = 9
"""The most characters of a number or a name that is typed."""
LONGEST_MEANING: Final = 200
"""The most characters of an instruction in the listing."""
SHOWN_OPERANDS: Final = (
    "mask", "foreground", "background", "start", "window", "scan_order", "dimensions", "spacing", "texture",
    "write_window", "read_mask", "write_offset", "index_1", "index_2", "origin", "conic", "scale", "function",
    "base_line", "scroll", "display_class", "image_mode",
)  # fmt: skip
"""The operands in the order of the panel."""


@dataclass(frozen=True)
class SessionState:
    """Everything that the user has chosen, and what was found."""

    number: int = 0
    """The instruction after which the display is shown; 0 is the start."""
    target: int = 0
    """The instruction to go to; `number` follows as soon as states are prepared."""
    length: int = 0
    """The number of instructions in the stream."""
    prepared: int = 0
    """States are prepared up to this instruction."""
    is_following: bool = False
    """Whether the session shows a running display as it runs."""
    wanted: int = 0
    """The number of instructions that a paused host may still execute."""
    awaited: str = ""
    """What a paused host's instructions are let through for; "" for nothing."""
    pointer: Point | None = None
    pointed_entry: int | None = None
    """The entry under the pointer, on the page of entries."""
    selection: Window | EntryRange | None = None
    writes: tuple[Write, ...] | None = None
    """The instructions that wrote the selected pixel or entry, newest first; None if nothing was asked."""
    writes_until: int = 0
    """The last instruction that `writes` may have."""
    page: str = ""
    """"help" or "entries" instead of the field; "" for the field."""
    prompt: str = ""
    """What is being typed: "instruction" or "opcode"; "" for nothing."""
    typed: str = ""
    message: str = ""
    search: str = ""
    """What is being searched for; "" for nothing."""
    first_listed: int = 0
    """The first row of the listing."""
    first_write: int = 0
    """The first row of the history."""
    parameters_before: Mapping[str, str] = field(default_factory=dict)
    """The values of the parameters at the position before; empty while a display runs."""
    opcode: int | None = None
    """The opcode that was last searched for."""


class InspectionSession:
    """An inspection of the instructions of a replay, or of a running display."""

    def __init__(self, replay: Replay, host: RunningHost | None = None) -> None:
        """A session of a stream, or, with a host and its replay, of a running display."""
        self.replay = replay
        self.host = host
        self.state = SessionState(
            number=replay.number,
            target=replay.number,
            length=len(replay.stream),
            prepared=replay.prepared,
            is_following=host is not None,
        )
        self.listing_rows = self.history_rows = 20
        """The rows of the listing and of the history that are seen."""
        self._search: Search[Any] | None = None
        self._found: Callable[[Any], None] = lambda _: None
        self._is_awaited: Callable[[], bool] = lambda: False
        self._last_followed = 0.0
        self.written: frozenset[int] = frozenset()
        """The instructions of the history."""
        self.meaning = lru_cache(4096)(lambda number: meaning_of(self.replay.stream.item(number)))
        """The right side of an instruction's listing, by its number."""

    # The display and the position.

    @property
    def display(self) -> Ramtek9300:
        """The display at the current instruction: the running display itself at the end of its stream."""
        if self.host is not None and (self.state.is_following or self.state.number == self.state.length):
            return self.host.display
        return self.replay.display

    @property
    def is_busy(self) -> bool:
        """Whether a tick has work to do, or waits for a host itself."""
        state, host = self.state, self.host
        if host is not None and (state.is_following or state.wanted or state.awaited) and host.is_connected():
            return True
        is_prepared = self.host is not None or state.prepared >= state.length
        return bool(state.search) or state.number != state.target or not is_prepared

    def set_rows(self, listing: int, history: int) -> None:
        """Set how many rows of the listing and of the history are seen."""
        self.listing_rows, self.history_rows = listing, history
        self._change(first_listed=self._listed_with(self.state.number))

    def _change(self, **changes: Any) -> None:
        self.state = replace(self.state, **changes)

    def go(self, number: int) -> None:
        """Go to an instruction: at once if states are prepared, otherwise as soon as they are."""
        self.pause()
        self.stop_search()
        number = min(max(number, 0), self.state.length)
        first = self._listed_with(number)
        self._change(target=number, wanted=0, awaited="", message="", first_listed=first)
        self._arrive()

    def step(self, count: int) -> None:
        """Go forward, or back, by some instructions; at its end a paused host executes them."""
        if self.host is not None and not self.state.is_following and count > 0:
            left = self.state.length - self.state.target
            if count > left:
                self.go(self.state.length)
                self._change(wanted=count - left, message="waiting for the host's next instruction")
                return
        self.go(self.state.target + count)

    def _arrive(self) -> None:
        """Go to the target if that takes a moment."""
        state = self.state
        ahead = state.target - self.replay.number
        if self.host is None and state.target > self.replay.prepared and not 0 <= ahead <= AT_ONCE:
            return
        if state.number != state.target:
            self._change(parameters_before=values_of(self.display))
        self.replay.go_to(state.target)
        self._change(number=state.target, prepared=self.replay.prepared)

    def _listed_with(self, number: int) -> int:
        """The first row of the listing that shows an instruction with some neighbors."""
        first, rows = self.state.first_listed, self.listing_rows
        if first + 3 <= number < first + rows - 3:
            return first
        return max(0, min(number - rows // 3, self.state.length + 1 - rows))

    # Work in pieces.

    def tick(self) -> None:
        """Do a piece of the waiting work; it takes some milliseconds at most."""
        if self.host is not None:
            self._serve(self.host)
        # A search begins where the session stands.
        if self._search is not None and self.state.number == self.state.target:
            self._go_on_searching(self._search)
            return
        # The states of a running display are kept while it runs.
        if self.host is None and self.state.prepared < self.state.length:
            is_done, now = not self.replay.prepare_for(PIECE_SECONDS), time.monotonic()
            if is_done or now - self._last_followed > FOLLOW_SECONDS:
                self._last_followed = now
                self._change(prepared=self.replay.prepared)
        if self.state.number != self.state.target:
            self._arrive()

    def _serve(self, host: RunningHost) -> None:
        """Serve the host, and stand at its last instruction unless it is stopped."""
        state = self.state
        if state.awaited:
            self._serve_until_awaited(host)
            return
        host.serve(None if state.is_following else state.wanted)
        if host.replay is not self.replay:
            self._begin_anew(host.replay)
            return
        length, now = len(self.replay.stream), time.monotonic()
        if length == state.length:
            return
        if state.is_following:
            if now - self._last_followed > FOLLOW_SECONDS:
                self._last_followed = now
                self._stand_at_the_end(length)
        else:
            wanted = max(0, state.wanted - (length - state.length))
            self._stand_at_the_end(length)
            self.replay.go_to(length)
            self._change(wanted=wanted, message=state.message if wanted else "")

    def _await(self, what: str, is_awaited: Callable[[], bool]) -> None:
        """Let a paused host's instructions through until `is_awaited()` is true after one of them."""
        self.go(self.state.length)
        self._is_awaited = is_awaited
        self._change(awaited=what, message=f"waiting for the host: {what} ... Esc stops")

    def _serve_until_awaited(self, host: RunningHost) -> None:
        """Let instructions through for some milliseconds, one after the other."""
        end, is_reached = time.monotonic() + PIECE_SECONDS, False
        while not is_reached and time.monotonic() < end:
            length = len(self.replay.stream)
            host.serve(1)
            if len(self.replay.stream) == length:
                break
            is_reached = self._is_awaited()
            if host.replay is not self.replay:
                self._begin_anew(host.replay)
        length, now = len(self.replay.stream), time.monotonic()
        if is_reached:
            self._stand_at_the_end(length)
            self.replay.go_to(length)
            self._change(awaited="", message="")
        elif length != self.state.length and now - self._last_followed > FOLLOW_SECONDS:
            self._last_followed = now
            self._stand_at_the_end(length)

    def _begin_anew(self, replay: Replay) -> None:
        """Follow the running display with another replay, which begins at the display as it is."""
        self.replay = replay
        self.meaning.cache_clear()
        self.select(None)
        message = f"the instructions took {MOST_BYTES >> 20} MB of memory: they are counted from here on"
        self._change(length=0, number=0, target=0, prepared=0, first_listed=0, message=message)

    def _stand_at_the_end(self, length: int) -> None:
        if self.state.is_following:
            self._change(parameters_before={})
        elif self.replay.number == self.state.number != length:
            # The host has changed its display since, but not the display of the replay.
            self._change(parameters_before=values_of(self.replay.display))
        self._change(length=length, number=length, target=length, prepared=self.replay.prepared)
        self._change(first_listed=self._listed_with(length))

    def pause(self) -> None:
        """Stop the host of a running display, if it runs."""
        if self.state.is_following:
            self._change(is_following=False, message="paused: the host waits")
            self._stand_at_the_end(len(self.replay.stream))
            self.replay.go_to(self.state.length)

    def go_on(self) -> None:
        """Let the host of a running display go on, and follow it."""
        if self.host is not None:
            self.stop_search()
            self._change(is_following=True, wanted=0, awaited="", message="")
            self._stand_at_the_end(len(self.replay.stream))

    def _start(self, what: str, search: Search[Any], found: Callable[[Any], None]) -> None:
        self._search, self._found = search, found
        self._change(search=what, message=f"searching for {what} ... Esc stops")
        if self.state.number == self.state.target:
            self._go_on_searching(search)

    def _go_on_searching(self, search: Search[Any]) -> None:
        end = time.monotonic() + PIECE_SECONDS
        try:
            next(search)
            while time.monotonic() < end:
                next(search)
        except StopIteration as result:
            found = self._found
            self.stop_search()
            self._change(prepared=self.replay.prepared)
            found(result.value)

    def stop_search(self) -> None:
        """Stop the search, if there is one."""
        if self._search is not None:
            self._search = None
            self._change(search="", message="")

    # Searches.

    def next_opcode(self, opcode: int | None = None, back: bool = False) -> None:
        """Go to the next instruction with an opcode, or the last one before; None for the last opcode asked.

        At first, None is the opcode of the current instruction. At the end of what a paused host has sent,
        its instructions are let through until the opcode.
        """
        self.pause()
        state = self.state
        if opcode is None:
            opcode = state.opcode
        if opcode is None:
            if not state.target:
                self._change(message="an opcode is searched for from an instruction, or after O and its name")
                return
            opcode = int(self.replay.stream.opcodes[state.target - 1])
        self._change(opcode=opcode)
        opcodes = self.replay.stream.opcodes
        if back:
            places = np.flatnonzero(opcodes[: max(0, state.target - 1)] == opcode)[-1:]
        else:
            places = state.target + np.flatnonzero(opcodes[state.target :] == opcode)[:1]
        if len(places):
            self.go(int(places[0]) + 1)
        elif self.host is not None and not back:
            self._await(name_of(opcode), lambda: self._last_opcode() == opcode)
        else:
            where = "before" if back else "after"
            self._change(message=f"no {name_of(opcode)} {where} instruction {state.target:,}")

    def _last_opcode(self) -> int:
        """The opcode of the last instruction of the stream."""
        stream = self.replay.stream
        return int(stream.words[stream.ends[-2]]) >> 8

    def next_change(self) -> None:
        """Go to the next instruction that changes a selected pixel, rectangle or entry.

        At the end of what a paused host has sent, its instructions are let through until such a change.
        """
        self.pause()
        selection = self.state.selection
        if selection is None:
            self._change(message="drag a rectangle on the field, or click a pixel or an entry first")
            return
        after, host = self.state.target, self.host
        search = histories.next_change(self.replay, selection, after)

        def found(number: int | None) -> None:
            if number is not None:
                self.go(number)
            elif host is not None:
                before = selected_values(host.display, selection)
                what = f"a change of {selection_text(selection)}"
                self._await(what, lambda: selected_values(host.display, selection) != before)
            else:
                self._change(message=f"{selection_text(selection)}: no change after instruction {after:,}")

        self._start(f"a change of {selection_text(selection)}", search, found)

    def select(self, selection: Window | EntryRange | None, is_final: bool = True) -> None:
        """Select a rectangle of the memory, entries, or nothing.

        If the selection is final, the history of a single pixel or entry is searched for.
        """
        self.stop_search()
        self.written = frozenset()
        self._change(selection=selection, writes=None, first_write=0, message="")
        if not is_final or selection is None:
            return
        self.pause()
        until, what = self.state.target, f"writes of {selection_text(selection)}"
        self._change(writes_until=until)
        if isinstance(selection, EntryRange):
            size = selection.end - selection.first
        else:
            size = selection.width * selection.height
        if size == 1:
            self._start(what, histories.history_of(self.replay, selection, until), self._show_writes)

    def _show_writes(self, writes: Sequence[Write]) -> None:
        self.written = frozenset(write.number for write in writes)
        self._change(writes=tuple(reversed(writes)), message="")

    def next_write(self, back: bool) -> None:
        """Go to the next older, or newer, instruction of the history."""
        numbers = [write.number for write in self.state.writes or ()]
        if back:
            numbers = [number for number in numbers if number < self.state.number][:1]
        else:
            numbers = [number for number in numbers if number > self.state.number][-1:]
        if numbers:
            self.go(numbers[0])
        elif self.state.writes is None:
            self._change(message="click a pixel or an entry first")
        else:
            self._change(message=f"no {'earlier' if back else 'later'} instruction in the history")

    # What the user does.

    def takes(self, text: str) -> bool:
        """Whether the prompt takes a character: digits for an instruction, letters too for an opcode."""
        prompt = self.state.prompt
        return prompt != "" and text.isascii() and (text.isdigit() or (prompt == "opcode" and text.isalpha()))

    def type(self, text: str) -> None:
        """Add a character to the number or the name that is being typed."""
        self._change(typed=(self.state.typed + text.upper())[:MOST_TYPED], message="")

    def ask(self, prompt: str, typed: str = "") -> None:
        """Begin to type an instruction's number or an opcode."""
        self._change(prompt=prompt, typed=typed, message="")

    def erase_typed(self) -> None:
        """Erase the last typed character."""
        self._change(typed=self.state.typed[:-1])

    def enter(self) -> None:
        """Go to the instruction, or to the next of the opcode, that was typed."""
        prompt, typed = self.state.prompt, self.state.typed
        self._change(prompt="", typed="")
        if prompt == "instruction" and typed:
            self.go(int(typed))
        elif prompt == "opcode":
            opcode = opcode_of(typed)
            if typed and opcode is None:
                self._change(message=f"an opcode must be a name such as WI, or two digits, not {typed}")
            else:
                self.next_opcode(opcode)

    def escape(self) -> None:
        """Leave what was begun last: typing, a search, waiting, a page, the selection."""
        state = self.state
        if state.prompt:
            self._change(prompt="", typed="")
        elif state.search:
            self.stop_search()
        elif state.wanted or state.awaited:
            self._change(wanted=0, awaited="", message="paused: the host waits")
        elif state.number != state.target:
            self._change(target=state.number, first_listed=self._listed_with(state.number), message="")
        elif state.page:
            self.turn_to(state.page)
        else:
            self.select(None)

    def tell(self, message: str) -> None:
        """Show a message; "" removes it."""
        self._change(message=message)

    def turn_to(self, page: str) -> None:
        """Show a page, or the field if the page is shown already."""
        self._change(page="" if self.state.page == page else page, pointed_entry=None, pointer=None)

    def point_at(self, place: Point | None = None, entry: int | None = None) -> None:
        """Note the place of the screen, or the entry, under the pointer."""
        self._change(pointer=place, pointed_entry=entry)

    def scroll_listing(self, rows: int) -> None:
        """Move the listing, and stay at the current instruction."""
        last = max(0, self.state.length + 1 - self.listing_rows)
        self._change(first_listed=min(max(0, self.state.first_listed + rows), last))

    def scroll_history(self, rows: int) -> None:
        """Move the history."""
        last = max(0, len(self.state.writes or ()) - self.history_rows)
        self._change(first_write=min(max(0, self.state.first_write + rows), last))

    def click_listing(self, row: int) -> None:
        """Go to the instruction in a row of the listing."""
        if (number := self.state.first_listed + row) <= self.state.length:
            self.go(number)

    def click_history(self, row: int) -> None:
        """Go to the instruction in a row of the history."""
        writes = self.state.writes or ()
        if (row := row + self.state.first_write) < len(writes):
            self.go(writes[row].number)

    def memory_window(self, first: Point, last: Point) -> Window:
        """The rectangle of the memory that is seen between two places of the screen.

        If the view wraps around an edge of the memory between them, the rectangle ends at that edge.
        """
        display = self.display
        parameters, configuration = display.processor.parameters, display.configuration
        left, right = sorted((first.element, last.element))
        top, bottom = sorted((first.line, last.line))
        elements, lines = pixel_at(
            parameters, configuration, np.arange(left, right + 1), np.arange(top, bottom + 1)
        )
        if parameters.origin_at_bottom:
            lines = lines[::-1]
        first_element, first_line = int(elements[0]), int(lines[0])
        return Window(
            first_element,
            first_line,
            int(elements[elements >= first_element].max()),
            int(lines[lines >= first_line].max()),
        )


def meaning_of(item: ListingItem) -> str:
    """The right side of an item of a listing in one line, cut after LONGEST_MEANING characters."""
    if item.instruction is None:
        words = " ".join(f"{word:04X}" for word in item.words[:8].tolist())
        return f"raw {words} ; {item.note}"
    text = head_text(item.instruction)
    for _, data in data_texts(item.instruction):
        text += f"  {data}"
        if len(text) > LONGEST_MEANING:
            break
    return text[:LONGEST_MEANING]


def parameter_texts(parameters: Parameters) -> dict[str, str]:
    """The values of parameters by their names, as the listing writes operands; three columns of nine."""
    texts = {name: operand_text(name, parameters.operand(name)) for name in SHOWN_OPERANDS if name != "conic"}
    texts |= {
        "conic": ",".join(map(str, parameters.conic)),
        "zoom": ",".join(map(str, parameters.zoom)),
        "video origin": "bottom" if parameters.origin_at_bottom else "top",
        "font": str(parameters.font),
    }
    order = *SHOWN_OPERANDS, "zoom", "video origin", "font"
    return {name.replace("_", " ").removeprefix("display "): texts[name] for name in order}


def values_of(display: Ramtek9300) -> dict[str, str]:
    """The values of a display's parameters by their names, and two more numbers."""
    return parameter_texts(display.processor.parameters) | {
        "saved": str(len(display.processor.saved)),
        "next entry": str(display.lookup_table.addressed_entry),
    }


def selected_values(display: Ramtek9300, selection: Window | EntryRange) -> bytes:
    """The words of a window, or the colors of entries, to compare."""
    if isinstance(selection, EntryRange):
        return display.lookup_table.packed[selection.first : selection.end].tobytes()
    return display.words[selection.top : selection.bottom + 1, selection.left : selection.right + 1].tobytes()


def selection_text(selection: Window | EntryRange) -> str:
    """A selection in words."""
    if isinstance(selection, EntryRange):
        if selection.end - selection.first == 1:
            return f"entry {selection.first}"
        return f"entries {selection.first} to {selection.end - 1}"
    if selection.width == selection.height == 1:
        return f"pixel {selection.left},{selection.top}"
    return f"rectangle {selection.left},{selection.top}..{selection.right},{selection.bottom}"


def name_of(opcode: int) -> str:
    """The name of an opcode, or its two hexadecimal digits."""
    names: Iterable[str] = (format.name for format in FORMATS if format.opcode == opcode)
    return next(iter(names), f"{opcode:02X}")


def opcode_of(name: str) -> int | None:
    """The opcode of an instruction's name, or of two hexadecimal digits; None if there is none."""
    if name.upper() in FORMAT_OF_NAME:
        return FORMAT_OF_NAME[name.upper()].opcode
    try:
        return int(name, 16) if len(name) == 2 else None
    except ValueError:
        return None
