"""Pointing: the gestures of the mouse and of the joystick unit, each drag one step to undo."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final, Protocol

from autocolor.errors import AutocolorError
from autocolor.scene.columns import Tier
from autocolor.scene.scene import cost_of_edit
from autocolor.screens.board import Board
from autocolor.screens.input import Binding, Chord, Gesture, bound_to
from autocolor.screens.picture.picture_edits import PictureEdits
from autocolor.screens.session import Session
from ramtek_emu import PortError, RamtekError, ReplyError

# -------------------- bindings
# The key bindings of the viewer, in the order of the help page.


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


# -------------------- keyboard
# The keyboard: a key goes to the text that is typed, the menu, the screen, or what it is bound to.


class Do(Protocol):
    """Does what a key asks for; False if that does nothing."""

    def __call__(
        self, source: object, run: Callable[[], object], continues: bool = False, moving: bool = False
    ) -> bool: ...


class Keyboard:
    """The keys of a board; those that are bound do what `actions` do."""

    def __init__(self, board: Board, actions: Actions, do: Do) -> None:
        self._board = board
        self._actions = actions
        self._do = do

    def press(self, name: str, control: bool, shift: bool, typed: str, repeated: bool) -> bool:
        """Do what a key asks for; returns False if it does nothing here."""
        if not control and self._typed(name, typed, repeated):
            return True
        chosen = bound_to(BINDINGS, name, control, shift, typed)
        if chosen is None:
            return False
        binding, number = chosen
        if repeated and not (binding.held or binding.repeats):
            # A switch would flip for as long as its key is down.
            return True
        continues = repeated and binding.held
        return self._do(chosen, lambda: binding.run(self._actions, number), continues, binding.held)

    def release(self, name: str) -> bool:
        """Do what letting go of a key asks for; returns False if that is nothing."""
        released = [
            each.release
            for each in BINDINGS
            if each.release is not None and any(chord.name == name for chord in each.chords)
        ]
        for release in released:
            release(self._actions)
        return bool(released)

    def _typed(self, name: str, typed: str, repeated: bool) -> bool:
        """Let the text that is being typed, the menu or the screen take a key."""
        board, source = self._board, ("key", name)
        if board.typing.is_on:
            return self._do(None, lambda: board.typing.key(name, typed))
        return self._do(source, lambda: board.key(name, typed), repeated, repeated) or self._do(
            source, lambda: board.screen.key(name, typed), repeated, repeated
        )


WHEEL: Final = "wheel"
"""What makes edits by the wheel, which has steps but no beginning and no end."""


class Pointing:
    """The gestures on a board."""

    def __init__(self, board: Board, do: Do) -> None:
        self._board = board
        self._do = do
        self._drags = 0

    @property
    def source(self) -> tuple[str, int]:
        """What makes the edits of the last drag or pick."""
        return "drag", self._drags

    def take(self, gesture: Gesture) -> None:
        """Do what a gesture asks for."""
        board, kind = self._board, gesture.kind
        if kind in ("hover", "drop"):
            board.take(gesture)
        elif kind == "wheel":
            # On each widget it makes a step of its own.
            board.point_at(gesture)
            self._do((WHEEL, board.lit), lambda: board.take(gesture), True, True)
        elif kind == "drag":
            self._do(self.source, lambda: board.take(gesture), True, True)
        elif not (kind == "pick" and board.is_dragging) and self._has_taken_text():
            # ENTER during a drag does nothing, or it would end the step.
            self._drags += 1
            self._do(self.source, lambda: board.take(gesture))

    def _has_taken_text(self) -> bool:
        """Take the text that is being typed, if any; False if it is refused, and stays to be mended."""
        if self._board.typing.is_on:
            self._do(None, self._board.typing.take)
        return not self._board.typing.is_on


# -------------------- doing
# Doing what keys and gestures ask for: an error becomes a message, and one movement one step to undo.

REST_SECONDS: Final = 0.1
"""Assumed: the time without a change after which a movement rests that has not ended by a release: while a
key is held down, and after a step of the wheel."""


class Doing:
    """What makes the edits of a session, and when the last one was made."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._source: object = None
        """The key or the movement of the pointer by which the last edit was made, if any."""
        self._edited_at = 0.0
        self.costs = Tier.NOTHING
        """What the edit cost that was done last, if it was one."""
        self.is_warned = False
        """Whether unsaved changes were announced by what was done last."""

    def was_by(self, source: object) -> bool:
        """Whether the last edit was made by a key or a movement."""
        return self._source == source

    @property
    def kind(self) -> object:
        """The first part of what the last edit was made by; None if there is nothing."""
        return self._source[0] if isinstance(self._source, tuple) else None

    @property
    def has_rested(self) -> bool:
        """Whether the last edit was made a while ago."""
        return time.monotonic() - self._edited_at > REST_SECONDS

    def warns_of_changes(self, otherwise: str) -> bool:
        """Whether to stop because of unsaved changes. They are announced once; the next attempt succeeds."""
        unsaved = self._session.unsaved
        if not unsaved or self.is_warned:
            return False
        self.is_warned = True
        self._session.warn(f"{unsaved}, {otherwise}")
        return True

    def do(self, source: object, run: Callable[[], object], continues: bool, moving: bool) -> bool:
        """Do what a key or a gesture asks for.

        If it continues what made the last edit, both are one step to undo. Returns False if `run` does, as
        there is nothing to do.
        """
        session, warned = self._session, self.is_warned
        news, before = session.news, session.scene
        session.tell("")
        session.same_step = continues and self._source == source
        session.moving = moving
        self.costs = Tier.NOTHING
        try:
            if run() is False:
                session.news = news
                return False
        except (PortError, ReplyError):
            # Without the display and its replies, there is nothing to show a message on.
            raise
        except (AutocolorError, RamtekError) as error:
            session.warn(error)
        # A warning applies to the next key only.
        self.is_warned = self.is_warned and not warned
        costs = None
        if session.scene is not before:
            session.comparing.end()
            costs = cost_of_edit(before, session.scene)
        if costs is not None:
            self._source, self._edited_at, self.costs = source, time.monotonic(), costs
        elif not continues:
            self._source = None
        return True
