"""Input queue: the inputs of a user that the program has not handled yet, without outdated inputs.

A program may be slower than the repeats of a key. Of the waiting repeats of a key, only the last stays, and
none after the key is released. Of successive movements of the mouse, only the last stays. So at most one
repeat of a key and one movement of the mouse wait, however slow the program is, and nothing goes on after a
key is released. The release waits in its place behind the press.
"""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import NamedTuple, TypeAlias


class Key(NamedTuple):
    """A pressed key: its name ("a", "f1", "return", "escape", ...), its text, and the modifiers."""

    name: str
    text: str = ""
    control: bool = False
    shift: bool = False
    alt: bool = False
    repeated: bool = False
    """Whether the key was down already, so that this is a repeat."""


class Release(NamedTuple):
    """The release of a key."""

    name: str


class Pointer(NamedTuple):
    """An action of the mouse at an element and a line of the display."""

    element: int
    line: int
    action: str
    """"move", "press", "release", "wheel up" or "wheel down"."""
    button: int = 0
    """0: none, 1: left, 2: middle, 3: right."""
    steps: int = 1
    """The steps of the wheel."""
    shift: bool = False
    control: bool = False
    """Whether Shift and Ctrl are down on the keyboard."""


class Close(NamedTuple):
    """The request to close the window."""


Input: TypeAlias = Key | Release | Pointer | Path | Close
"""An input; a path is a file that was dropped on the window."""


class InputQueue:
    """The waiting inputs, oldest first, and the keys and buttons that are down."""

    def __init__(self) -> None:
        self._waiting: deque[Input] = deque()
        self._down: set[str | int] = set()

    def __len__(self) -> int:
        return len(self._waiting)

    @property
    def down(self) -> frozenset[str | int]:
        """The names of the keys and the numbers of the mouse's buttons that are down."""
        return frozenset(self._down)

    def add(self, added: Input) -> None:
        """Add an input, and drop the waiting inputs that it replaces. Marks a key that is a repeat."""
        if isinstance(added, Key):
            if added.control and added.alt and added.text.isprintable() and added.text:
                # Windows reports AltGr as Ctrl and Alt.
                added = added._replace(control=False, alt=False)
            added = added._replace(repeated=added.name in self._down)
            self._down.add(added.name)
            if added.repeated:
                self._drop_repeats(added.name)
        elif isinstance(added, Pointer):
            added = self._merged(added)
        self._waiting.append(added)

    def release(self, name: str) -> None:
        """Release a key: drop its waiting repeats, and add the release if the key was down."""
        self._drop_repeats(name)
        if name in self._down:
            self._down.discard(name)
            self._waiting.append(Release(name))

    def release_everything(self) -> None:
        """Release all keys and buttons, as when another window gets the keyboard."""
        for name in sorted(down for down in self._down if isinstance(down, str)):
            self.release(name)
        self._down.clear()

    def take(self) -> Input:
        """Remove and return the oldest input; IndexError if none is waiting."""
        return self._waiting.popleft()

    def _drop_repeats(self, name: str) -> None:
        """Drop the waiting repeats of a key. Its first press stays."""
        self._waiting = deque(
            waiting
            for waiting in self._waiting
            if not (isinstance(waiting, Key) and waiting.repeated and waiting.name == name)
        )

    def _merged(self, added: Pointer) -> Pointer:
        """The input of the mouse, merged with the newest waiting input if both are the same movement."""
        if added.action == "press":
            self._down.add(added.button)
        elif added.action == "release":
            self._down.discard(added.button)
        elif (
            self._waiting
            and isinstance(last := self._waiting[-1], Pointer)
            and last._replace(element=added.element, line=added.line, steps=added.steps) == added
        ):
            self._waiting.pop()
            return added if added.action == "move" else added._replace(steps=last.steps + added.steps)
        return added
