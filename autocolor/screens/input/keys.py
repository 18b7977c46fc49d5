"""Keys and key bindings, from which the viewer and its help page work."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

Viewer = TypeVar("Viewer")


@dataclass(frozen=True)
class Chord:
    """A key and its modifiers. `shift` is significant for letters, but not for digits and signs."""

    name: str
    control: bool = False
    shift: bool = False

    @property
    def is_sign(self) -> bool:
        """Whether it is a digit or a sign, whose key depends on the keyboard layout."""
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
            "tab": "Tab",
        }
        return "+".join([*held, names.get(self.name, self.name.upper())])


@dataclass(frozen=True)
class Binding(Generic[Viewer]):
    """Keys that are bound to an action.

    `run` is called with the viewer and the index in `chords` of the key that was pressed. While the key is
    held down, it is called again and again only with `held`, where all is undone as one step, or with
    `repeats`, where each is a step. `release` is called when one of the keys is let go.
    `does` describes the action on the help page; `label` replaces the names of the keys there.
    """

    chords: tuple[Chord, ...]
    does: str
    run: Callable[[Viewer, int], object]
    label: str | None = None
    held: bool = False
    repeats: bool = False
    release: Callable[[Viewer], object] | None = None

    def __str__(self) -> str:
        return self.label or ", ".join(map(str, self.chords))


def bound_to(
    bindings: Sequence[Binding[Viewer]], name: str, control: bool, shift: bool, typed: str
) -> tuple[Binding[Viewer], int] | None:
    """The binding of a key that was pressed, and the index of its chord; None if it has none.

    Signs are matched by the typed character, as keyboards place them differently, letters by the key's name.
    """
    chords = [
        (binding, number, chord)
        for binding in bindings
        for number, chord in enumerate(binding.chords)
        if chord.control == control
    ]
    by_sign = [row for row in chords if row[2].is_sign and row[2].name == typed]
    by_name = [row for row in chords if row[2].name == name and (row[2].is_sign or row[2].shift == shift)]
    return next(((binding, number) for binding, number, _ in by_sign or by_name), None)
