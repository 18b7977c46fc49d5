"""The key table: what each key does, in one place, for the window and for its help page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

Viewer = TypeVar("Viewer")


@dataclass(frozen=True)
class Chord:
    """A key by its name, with what is held down. A letter's `shift` counts, that of a sign does not."""

    name: str
    control: bool = False
    shift: bool = False

    @property
    def is_sign(self) -> bool:
        """Whether it is a digit or a sign, which keyboards have in different places."""
        return len(self.name) == 1 and not self.name.isalpha()

    def __str__(self) -> str:
        held = ["Ctrl"] * self.control + ["Shift"] * self.shift
        names = {
            "escape": "Esc",
            "up": "Up",
            "down": "Down",
            "left": "Left",
            "right": "Right",
            "space": "Space",
        }
        return "+".join([*held, names.get(self.name, self.name.upper())])


@dataclass(frozen=True)
class Binding(Generic[Viewer]):
    """Keys that do one thing; `run` gets who is driven and which of the keys it was, counted from 0.

    What a key does while it is `held` down is one step to undo.
    """

    chords: tuple[Chord, ...]
    does: str
    run: Callable[[Viewer, int], object]
    label: str | None = None
    held: bool = False

    def __str__(self) -> str:
        return self.label or ", ".join(map(str, self.chords))
