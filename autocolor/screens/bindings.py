"""The key bindings of the viewer, in the order of the help page."""

from __future__ import annotations

from typing import Final, Protocol

from autocolor.screens.input.keys import Binding, Chord
from autocolor.screens.picture.picture_edits import PictureEdits
from autocolor.screens.session import Session


class Actions(Protocol):
    """The actions that keys can be bound to."""

    @property
    def session(self) -> Session:
        """The session, for the keys that edit nothing."""

    @property
    def edits(self) -> PictureEdits:
        """The edits of the picture."""

    def toggle(self, screen: str) -> object:
        """Turn to a screen, or back to the picture if it is shown."""

    def toggle_menu(self) -> object:
        """Bring the menu, or take it away."""

    def watch(self) -> object:
        """Let the picture come in line by line."""

    def compare(self) -> object:
        """Show the state to compare with."""

    def undo(self) -> object:
        """Undo the last step."""

    def redo(self) -> object:
        """Redo the last undone step."""

    def save(self) -> object:
        """Save the picture with its scene."""

    def reopen(self) -> object:
        """Read the scene's file again."""

    def escape(self) -> object:
        """Take back, close, return to the picture, or leave."""


TURN: Final = 5.0
FINE_TURN: Final = 1.0
"""Degrees for each press of a key that turns, and with Shift."""

CLOSER: Final = 0.9
BLEND: Final = 0.05

BINDINGS: Final[tuple[Binding[Actions], ...]] = (
    Binding((Chord("f1"),), "this help, and back", lambda viewer, _: viewer.toggle("help")),
    Binding(
        (Chord("f4"),),
        "the 1024 entries of the lookup table, and back",
        lambda viewer, _: viewer.toggle("entries"),
    ),
    Binding(
        (Chord("tab"),),
        "the menu (or the right edge); its keys: arrows, Return",
        lambda viewer, _: viewer.toggle_menu(),
    ),
    Binding(
        (Chord("left"), Chord("right"), Chord("left", shift=True), Chord("right", shift=True)),
        "turn around the object; finely with Shift",
        lambda viewer, number: viewer.edits.turn((-TURN, TURN, -FINE_TURN, FINE_TURN)[number], 0),
        label="Left, Right",
        held=True,
    ),
    Binding(
        (Chord("up"), Chord("down"), Chord("up", shift=True), Chord("down", shift=True)),
        "look from above, from below; finely with Shift",
        lambda viewer, number: viewer.edits.turn(0, (TURN, -TURN, FINE_TURN, -FINE_TURN)[number]),
        label="Up, Down",
        held=True,
    ),
    Binding(
        (Chord("+"), Chord("="), Chord("-")),
        "move closer, farther",
        lambda viewer, number: viewer.edits.move((CLOSER, CLOSER, 1 / CLOSER)[number]),
        label="+ and -",
        held=True,
    ),
    Binding(
        (Chord(","), Chord(".")),
        "rotate the picture's horizontal axis",
        lambda viewer, number: viewer.edits.tilt((-TURN, TURN)[number]),
        label="comma, period",
        held=True,
    ),
    Binding(
        tuple(Chord(f"f{number}") for number in range(5, 10)),
        "view from the front, side, back, top, three quarters",
        lambda viewer, number: viewer.edits.see_from(number),
        label="F5 to F9",
    ),
    Binding(
        (Chord("r"), Chord("r", shift=True)),
        "rescale: fill the picture with the object, the surface",
        lambda viewer, number: viewer.edits.rescale(number == 1),
    ),
    Binding(
        tuple(Chord(str(digit)) for digit in range(1, 10)),
        "switch a light on or off",
        lambda viewer, number: viewer.edits.switch_light(number),
        label="1 to 9",
    ),
    Binding(
        (Chord("s"), Chord("s", shift=True)),
        "select the next surface, the previous one",
        lambda viewer, number: viewer.edits.choose_surface((1, -1)[number]),
        repeats=True,
    ),
    Binding(
        (Chord("["), Chord("]")),
        "blend: light color from a lower, from a higher level",
        lambda viewer, number: viewer.edits.blend((-BLEND, BLEND)[number]),
        label="[ and ]",
        held=True,
    ),
    Binding(
        (Chord("c"), Chord("c", shift=True)),
        "the next object color, the previous one",
        lambda viewer, number: viewer.edits.repaint((1, -1)[number]),
        repeats=True,
    ),
    Binding(
        (Chord("e"),),
        "hold the exposure (less light is darker), release it",
        lambda viewer, _: viewer.edits.switch_exposure(),
    ),
    Binding(
        (Chord("w"),),
        "watch the picture being computed, line by line",
        lambda viewer, _: viewer.watch(),
    ),
    Binding(
        (Chord("b"),),
        "while held: the state before the last step",
        lambda viewer, _: viewer.compare(),
        release=lambda viewer: viewer.session.end_comparing(),
    ),
    Binding((Chord("z", control=True),), "undo", lambda viewer, _: viewer.undo(), repeats=True),
    Binding(
        (Chord("y", control=True), Chord("z", control=True, shift=True)),
        "redo",
        lambda viewer, _: viewer.redo(),
        repeats=True,
    ),
    Binding((Chord("s", control=True),), "save the picture with its scene", lambda viewer, _: viewer.save()),
    Binding((Chord("r", control=True),), "read the scene's file again", lambda viewer, _: viewer.reopen()),
    Binding(
        (Chord("escape"),),
        "leave full screen, a page, and if saved the window",
        lambda viewer, _: viewer.escape(),
    ),
)
WINDOW_KEYS: Final = (
    ("F11, Alt+Enter", "full screen, and back"),
    ("F12", "save a numbered screenshot"),
    ("Ctrl+Q", "leave"),
    ("mouse", "drag: turn; Shift, middle: move; Ctrl, wheel: closer"),
    ("mouse, highlight", "drag it, or click, and click where it goes"),
    ("joystick unit", "ENTER picks and places; TRACK, held, drags"),
    ("a file dropped", "open it: a scene, a mesh or a picture file"),
)
"""The keys that the window itself handles, and the mouse."""


def rows_of_help() -> list[tuple[str, str]]:
    """Each key with what it does."""
    return [(str(binding), binding.does) for binding in BINDINGS] + list(WINDOW_KEYS)
