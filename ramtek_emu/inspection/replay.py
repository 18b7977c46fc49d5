"""Replay: the display after any number of instructions of a stream, forward and back.

A display cannot run backwards. So states are kept on the way, and a display is brought to a number by running
from the last state before it. States are STATE_SECONDS of work apart while they take at most STATE_BYTES for
each word of the stream; if they would take more, every second state is dropped.

Replies are dropped, as by `ramtek play`. Only the reply of the last instruction is kept, in `reply`, and
`written` has the words that the instruction wrote.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from itertools import pairwise
from operator import attrgetter
from time import perf_counter, thread_time
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots, Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.inspection.states import Packer, State, size_of, thinned
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.instruction import NO_WORDS
from ramtek_emu.memory.scan_orders import Window

STATE_SECONDS: Final = 0.02
"""How long the instructions between two states take."""
STATE_BYTES: Final = 64
"""Limit: the bytes of states for each word of the stream, on average."""
LEAST_STATE_BYTES: Final = 64 << 20
"""Limit: the bytes of states that even a short stream may take."""
STEPS_AT_ONCE: Final = 256
"""The number of instructions that a display is given at once while states are kept."""


class Replay:
    """A stream, and a display that goes to any of its instructions, forward or back."""

    def __init__(self, stream: Stream, start: Ramtek9300 | None = None) -> None:
        """Begin with a display as it is at power-on, or like `start` without its pending words."""
        start = Ramtek9300(stream.configuration) if start is None else start
        self.stream = stream
        self.number = 0
        """How many instructions the display has executed; 0 is power-on."""
        self.reply: Words = NO_WORDS
        """The reply of the last instruction, uint16."""
        self.written: Dots | None = None
        """The (lines, elements) words that the last instruction wrote, also words that stayed the same.

        Read-only; None at power-on.
        """
        self._packer = Packer()
        self._seconds = STATE_SECONDS
        self._due = 0.0
        self.state_bytes = 0
        """The bytes that the states take."""
        self._states: list[State] = []
        self._keep(start, 0, np.ones(start.words.shape, np.bool_))
        self.display = self.display_at(0)
        """The display after `number` instructions."""
        self.display.scan_out.shown_table = start.scan_out.shown_table
        self._preparing = self._prepare()

    @property
    def prepared(self) -> int:
        """The number of instructions up to which states are kept."""
        return self._states[-1].number

    def prepare_for(self, seconds: float) -> bool:
        """Run on for up to `seconds`, and keep states; returns whether instructions are left."""
        end = perf_counter() + seconds
        for _ in self._preparing:
            if perf_counter() >= end:
                break
        else:
            self._preparing = self._prepare()
        return self.prepared < len(self.stream)

    def _prepare(self) -> Iterator[None]:
        """Run a display over the stream, and keep states; pauses after each instruction."""
        number = self.prepared
        display = self.display_at(number)
        while number < len(self.stream):
            due = thread_time() + self._seconds
            touched = display.frame_buffer.touched = np.zeros(display.words.shape, np.bool_)
            for step in self.steps(display, number, len(self.stream)):
                number = step
                display.processor.replies.clear()
                if thread_time() >= due:
                    break
                yield
            self._keep(display, number, touched)
            yield

    def _keep(self, display: Ramtek9300, number: int, touched: Dots) -> None:
        """Keep a state, in place of an older state with its number; drop states if there are too many."""
        state = self._packer.pack(display, number, touched)
        if self._states and self._states[-1].number == state.number:
            self._drop_last()
        self.state_bytes += self._bytes_of_next(state)
        self._states.append(state)
        most = max(LEAST_STATE_BYTES, STATE_BYTES * len(self.stream.words))
        if self.state_bytes > most:
            self._seconds *= 2
            self._states = thinned(self._states)
            self.state_bytes = size_of(self._states)

    def _drop_last(self) -> None:
        state = self._states.pop()
        self.state_bytes -= self._bytes_of_next(state)

    def _bytes_of_next(self, state: State) -> int:
        """The bytes of a state that follows the last state and shares blocks with it."""
        last = self._states[-1:]
        return size_of([*last, state]) - size_of(last)

    def append(self, words: Words) -> None:
        """Append whole instructions that a running display has executed."""
        count, end = len(self.stream), self.stream.ends[-1]
        self.stream.append(words)
        if self.stream.ends[count] > end:
            # A row of illegal words goes on. Forget the display within the row.
            if self.number == count:
                self.go_to(count - 1)
            if self.prepared == count:
                self._drop_last()

    def note(self, display: Ramtek9300, has_moved: bool = False) -> None:
        """Keep the state of a running display after the last instruction of the stream, if a state is due.

        With `has_moved`, something other than an instruction has changed the display, such as its joystick,
        and a state is due.
        """
        if has_moved or (self.prepared < len(self.stream) and thread_time() >= self._due):
            self._keep(display, len(self.stream), np.ones(display.words.shape, np.bool_))
            self._due = thread_time() + self._seconds

    def go_to(self, number: int) -> None:
        """Bring the display to an instruction, forward or back."""
        state = self.state_before(max(0, number - 1))
        if not state.number <= self.number < number:
            state.restore(self.display)
            self.number, self.reply, self.written = state.number, NO_WORDS, None
        if number > self.number:
            self._run(self.display, self.number, number - 1)
            written = self.display.frame_buffer.touched = np.zeros(self.display.words.shape, np.bool_)
            self.display.send(self.stream.words_between(number - 1, number))
            self.display.frame_buffer.touched = None
            written.flags.writeable = False
            self.number, self.reply, self.written = number, reply_of(self.display), written
            if (state := self.state_before(number)).number == number:
                # The joystick of a running display may have moved after the instruction.
                state.restore(self.display)

    def display_at(self, number: int) -> Ramtek9300:
        """A new display after `number` instructions."""
        display, state = Ramtek9300(self.stream.configuration), self.state_before(number)
        state.restore(display)
        self._run(display, state.number, number)
        return display

    def _run(self, display: Ramtek9300, after: int, until: int) -> None:
        """Execute instructions, and drop their replies."""
        display.send(self.stream.words_between(after, until))
        display.processor.replies.clear()

    def state_before(self, number: int) -> State:
        """The last state that was kept before an instruction, or after it exactly."""
        return self._states[bisect_right(self._states, number, key=attrgetter("number")) - 1]

    def stretches(self, window: Window, after: int, until: int) -> list[tuple[int, int]]:
        """The parts of the stream between states that may write to a window: (the number before, the last).

        Only instructions after `after` and up to `until` are in them.
        """
        pairs = pairwise(self._states)
        parts = [(state.number, later.number) for state, later in pairs if later.may_touch(window)]
        parts.append((self.prepared, until))
        clipped = ((max(begin, after), min(end, until)) for begin, end in parts)
        return [(begin, end) for begin, end in clipped if begin < end]

    def steps(self, display: Ramtek9300, number: int, end: int) -> Iterator[int]:
        """Run a display from `number` to `end`; yields the number after each instruction."""
        while number < end:
            # The decoder looks at all words that it is given before the first instruction is executed.
            piece = self.stream.words_between(number, min(number + STEPS_AT_ONCE, end))
            place = 0
            for used in display.send_stepwise(piece):
                # A long instruction pauses with the count of the words before it.
                if used > place:
                    place = used
                    number += 1
                    yield number


def reply_of(display: Ramtek9300) -> Words:
    """The replies that wait, which are taken."""
    waiting = display.processor.waiting
    return display.receive(waiting) if waiting else NO_WORDS
