"""Input queue: the inputs of a user that the program has not handled yet, without outdated ones.

A program may take longer for a key than the keyboard takes to repeat it. Of the repeats of a key that wait,
only the last is kept, and none when the key is released; of successive places of the mouse, only the last.
So however long the program takes, one repeat of a key and one movement of the mouse wait at most, and nothing
goes on after a key is released. The release itself waits in its place behind the press.
"""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import Final, NamedTuple, TypeAlias


class Key(NamedTuple):
    """A key that was pressed: its name ("a", "f1", "return", "escape", ...), its text, the modifiers held."""

    name: str
    text: str = ""
    control: bool = False
    shift: bool = False
    alt: bool = False
    repeated: bool = False
    """Whether the key was down already and the event is a repeat."""

    @property
    def as_typed(self) -> Key:
        """The key without Ctrl and Alt if it types a sign with both: Windows reports AltGr as both."""
        types_a_sign = self.control and self.alt and self.text.isprintable() and self.text != ""
        return self._replace(control=False, alt=False) if types_a_sign else self


class Release(NamedTuple):
    """A key that was pressed is not down any more."""

    name: str


class Pointer(NamedTuple):
    """Something the mouse did over an element and a line of the display."""

    element: int
    line: int
    enter: bool
    """Whether the left button is down; set when the input is handled."""
    action: str
    """"move", "press", "release", "wheel up" or "wheel down"."""
    button: int = 0
    """0: none, 1: left, 2: middle, 3: right."""
    steps: int = 1
    """The steps of the wheel."""
    shift: bool = False
    control: bool = False
    """Whether Shift and Ctrl are held on the keyboard."""


class Close(NamedTuple):
    """The window was asked to close."""


Input: TypeAlias = Key | Release | Pointer | Path | Close
"""One input; a path names a file that was dropped on the window."""

MOVEMENTS: Final = frozenset(("move", "wheel up", "wheel down"))
"""The actions of the mouse that are united if several wait in a row."""


class InputQueue:
    """The inputs that wait, oldest first, and which keys and buttons are down."""

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
        """Let an input wait, in place of those that it overtakes; tell whether a key is a repeat."""
        if isinstance(added, Key):
            added = added._replace(repeated=added.name in self._down).as_typed
            self._down.add(added.name)
            if added.repeated:
                self._drop_repeats(added.name)
        elif isinstance(added, Pointer):
            added = self._merged(added)
        self._waiting.append(added)

    def release(self, name: str) -> None:
        """Take a key for released: its repeats wait no longer, and the release waits if the key was down."""
        self._drop_repeats(name)
        if name in self._down:
            self._down.discard(name)
            self._waiting.append(Release(name))

    def release_everything(self) -> None:
        """Take all keys and buttons for released, as when another window gets the keyboard."""
        for name in sorted(down for down in self._down if isinstance(down, str)):
            self.release(name)
        self._down.clear()

    def take(self) -> Input:
        """The oldest input; IndexError if none waits."""
        return self._waiting.popleft()

    def _drop_repeats(self, name: str) -> None:
        """Drop the repeats of a key that wait. Its first press stays."""
        self._waiting = deque(
            each
            for each in self._waiting
            if not (isinstance(each, Key) and each.repeated and each.name == name)
        )

    def _merged(self, added: Pointer) -> Pointer:
        """The input of the mouse, in place of the one that waits last if both are the same movement."""
        if added.action == "press":
            self._down.add(added.button)
        elif added.action == "release":
            self._down.discard(added.button)
        last = self._waiting[-1] if self._waiting else None
        if not isinstance(last, Pointer) or movement(last) != movement(added) or movement(added) is None:
            return added
        self._waiting.pop()
        return added if added.action == "move" else added._replace(steps=last.steps + added.steps)


def movement(pointer: Pointer) -> tuple[str, bool, bool] | None:
    """Of which kind a movement is, with the modifiers held; None if the mouse did anything else."""
    if pointer.action not in MOVEMENTS:
        return None
    return pointer.action, pointer.shift, pointer.control
