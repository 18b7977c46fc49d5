"""What every key of the viewer does, in the order of the help page."""

from __future__ import annotations

from typing import Final, Protocol

from autocolor.screens.keys import Binding, Chord


class Actions(Protocol):
    """What the keys make a viewer do."""

    def show_help(self) -> object:
        """Show the help page, or go back."""

    def show_entries(self) -> object:
        """Show the entries, or go back."""

    def turn(self, right: float, up: float) -> object:
        """Go around the object by degrees."""

    def move(self, ratio: float) -> object:
        """Move closer or farther."""

    def tilt(self, degrees: float) -> object:
        """Turn the picture plane."""

    def rescale(self) -> object:
        """Fill the picture with the object."""

    def switch_light(self, number: int) -> object:
        """Switch a light on or off."""

    def choose_surface(self, step: int) -> object:
        """Choose another surface."""

    def blend(self, step: float) -> object:
        """Move the blend."""

    def repaint(self, step: int) -> object:
        """Give another object color."""

    def undo(self) -> object:
        """Undo a step."""

    def redo(self) -> object:
        """Do a step again."""

    def save(self) -> object:
        """Save."""

    def escape(self) -> object:
        """Go back one step."""


TURN: Final = 5.0
"""Degrees that one press of an arrow goes around the object."""

CLOSER: Final = 0.9
BLEND: Final = 0.05

BINDINGS: Final[tuple[Binding[Actions], ...]] = (
    Binding((Chord("f1"),), "this help, and back", lambda viewer, _: viewer.show_help()),
    Binding(
        (Chord("f4"),), "the 1024 entries of the table, and back", lambda viewer, _: viewer.show_entries()
    ),
    Binding(
        (Chord("left"), Chord("right")),
        "go around the object",
        lambda viewer, number: viewer.turn((-TURN, TURN)[number], 0),
        held=True,
    ),
    Binding(
        (Chord("up"), Chord("down")),
        "look from higher, from lower",
        lambda viewer, number: viewer.turn(0, (TURN, -TURN)[number]),
        held=True,
    ),
    Binding(
        (Chord("+"), Chord("="), Chord("-")),
        "move closer, farther",
        lambda viewer, number: viewer.move((CLOSER, CLOSER, 1 / CLOSER)[number]),
        label="+ and -",
        held=True,
    ),
    Binding(
        (Chord(","), Chord(".")),
        "turn the picture's horizontal axis",
        lambda viewer, number: viewer.tilt((-TURN, TURN)[number]),
        label="comma, period",
        held=True,
    ),
    Binding((Chord("r"),), "rescale: fill the picture with the object", lambda viewer, _: viewer.rescale()),
    Binding(
        tuple(Chord(str(digit)) for digit in range(1, 10)),
        "switch a light on or off",
        lambda viewer, number: viewer.switch_light(number),
        label="1 to 9",
    ),
    Binding(
        (Chord("s"), Chord("s", shift=True)),
        "choose the next surface, the one before",
        lambda viewer, number: viewer.choose_surface((1, -1)[number]),
    ),
    Binding(
        (Chord("["), Chord("]")),
        "blend: the light color from lower, from higher levels",
        lambda viewer, number: viewer.blend((-BLEND, BLEND)[number]),
        label="[ and ]",
        held=True,
    ),
    Binding(
        (Chord("c"), Chord("c", shift=True)),
        "the next object color, the one before",
        lambda viewer, number: viewer.repaint((1, -1)[number]),
    ),
    Binding((Chord("z", control=True),), "undo", lambda viewer, _: viewer.undo()),
    Binding(
        (Chord("y", control=True), Chord("z", control=True, shift=True)),
        "do again",
        lambda viewer, _: viewer.redo(),
    ),
    Binding((Chord("s", control=True),), "save the picture with its scene", lambda viewer, _: viewer.save()),
    Binding(
        (Chord("escape"),), "one step back; leave, if nothing is unsaved", lambda viewer, _: viewer.escape()
    ),
)
WINDOW_KEYS: Final = (
    ("F11, Alt+Enter", "full screen, and back"),
    ("F12", "save a numbered screenshot"),
    ("Ctrl+Q", "leave"),
    ("a file dropped", "open it: a scene, a mesh or a picture file"),
)
"""The keys that the window itself answers to."""
