"""The keys of the interactive system: the bindings, and what they do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final, NamedTuple, Protocol

from autocolor.errors import UsageError
from autocolor.scene.kinds import in_digits
from autocolor.scene.orbit import sides_of
from autocolor.screens.board import Board
from autocolor.screens.file_actions import read_again, save, save_image
from autocolor.screens.picture import picture_edits as edits
from autocolor.screens.picture.picture_edits import CLOSER, TURN
from autocolor.screens.session import PICTURE, SENT, Session
from autocolor.screens.steps import compare, end_comparing, redo, undo
from autocolor.screens.surface.painting import blend, repaint, take_paint
from autocolor.widgets.widget import Entry


class Driven(Protocol):
    """The system that the keys drive; a viewer."""

    session: Session
    board: Board

    def show_scene(self) -> None:
        """Let go of everything, and show the scene."""

    def escape(self) -> bool:
        """Take back, close or leave something; returns whether there was anything."""

    def save_screen(self) -> None:
        """Save what the display shows."""


class Chord(NamedTuple):
    """A key and its modifiers. `shift` matters for letters, but not for digits and signs."""

    name: str
    control: bool = False
    shift: bool = False
    alt: bool = False

    @property
    def is_sign(self) -> bool:
        """Whether it is a digit or a sign, whose key depends on the keyboard layout."""
        return len(self.name) == 1 and not self.name.isalpha()


@dataclass(frozen=True)
class Binding:
    """Keys that are bound to an action, such as "Left Shift+Left".

    `run` is called with the viewer and the number of the key among `keys`, from 0. While the key stays down,
    `run` is called again and again only with `held`, as one step to undo, or with `repeats`, as a step for
    each call. `release` is called when one of the keys is let go. `does` describes the action on the help
    page; `label` replaces the keys there.
    """

    keys: str
    does: str
    run: Callable[[Driven, int], object]
    label: str = ""
    held: bool = False
    repeats: bool = False
    release: Callable[[Driven], object] | None = None

    @property
    def chords(self) -> list[Chord]:
        """The keys with their modifiers."""
        chords = []
        for key in self.keys.split():
            *modifiers, name = key.split("+") if len(key) > 1 else [key]
            chords.append(Chord(name.lower(), *(each in modifiers for each in ("Ctrl", "Shift", "Alt"))))
        return chords

    def __str__(self) -> str:
        return self.label or ", ".join(self.keys.split())


def toggle(viewer: Driven, screen: str) -> None:
    """Turn to a screen, or back to the picture if it is shown."""
    viewer.session.turn_to(PICTURE if viewer.session.screen == screen else screen)


def names_in_strip(viewer: Driven) -> list[str]:
    """The names of the screens that have a word in the strip, from the left."""
    return [name for name, screen in viewer.board.screens.items() if screen.word]


def turn_along(viewer: Driven, step: int) -> None:
    """Turn to the next screen of the strip, or the previous one. After the last screen comes the first."""
    names, present = names_in_strip(viewer), viewer.session.screen
    place = names.index(present) if present in names else 0
    viewer.session.turn_to(names[(place + step) % len(names)])


def watch(viewer: Driven) -> None:
    """Let the picture come in line by line."""
    viewer.session.watches = True


def show_other(viewer: Driven) -> None:
    """Show the state to compare with, over the picture."""
    session = viewer.session
    session.compared_from = PICTURE
    if not viewer.board.screen.shows_picture:
        session.compared_from = session.screen
        session.turn_to(PICTURE)
    compare(session)


def show_present(viewer: Driven) -> None:
    """Show the present state again, on the screen from which the other state was asked for."""
    session = viewer.session
    end_comparing(session)
    if session.screen == PICTURE:
        session.turn_to(session.compared_from)
    session.compared_from = PICTURE


def with_scene(viewer: Driven, run: Callable[[Session], object]) -> None:
    """Let go of everything, show the scene, and run an action that may change all of it."""
    viewer.show_scene()
    run(viewer.session)


def take_sample(viewer: Driven, is_color: bool) -> None:
    """Take the paint of the surface under the pointer, or the color that is seen there.

    Raises UsageError if there is none.
    """
    board, sample = viewer.board, viewer.board.sample
    if sample is None or not sample.surface:
        raise UsageError("no surface is under the pointer; point at it in the picture")
    if is_color:
        board.content.take_color(sample.color, *board.pointer)
    else:
        take_paint(viewer.session, sample.surface)


def copy(viewer: Driven) -> None:
    """Copy the typed text, the text of the row under the pointer, or the color there to the clipboard.

    Raises UsageError if there is none.
    """
    board, clipboard = viewer.board, viewer.session.clipboard
    if board.typing.is_on:
        text = board.typing.text
    elif isinstance(board.lit, Entry):
        text = board.lit.value
    else:
        color, sample = board.content.color_at(*board.pointer), board.content.sample(*board.pointer)
        if color is None and sample is not None:
            color = sample.color
        text = "" if color is None else in_digits(color)
    if not text:
        raise UsageError("nothing is there to copy; point at a color")
    if clipboard is None or not clipboard.copy(text):
        raise UsageError(f"{text} is not copied, because this display has no clipboard; write it down")
    viewer.session.tell(f"copied {text}")


def paste(viewer: Driven) -> None:
    """Paste the first line of the clipboard's text, without letters that cannot be typed.

    Raises UsageError without a clipboard or a text.
    """
    clipboard = viewer.session.clipboard
    if clipboard is None:
        raise UsageError("this display has no clipboard; type the color")
    line = clipboard.paste().split("\n")[0]
    # Some systems end the text by a character 0.
    text = "".join(letter for letter in line if letter.isprintable()).strip()
    if not text:
        raise UsageError("the clipboard has no text; copy a color first")
    paste_text(viewer.board, text)


def paste_text(board: Board, text: str) -> None:
    """Put a text into the typed text or the row under the pointer, or let the screen take it as a color.

    Over a row with a proposed text, typing begins. Raises UsageError or InputError if it is refused.
    """
    lit = board.lit
    if isinstance(lit, Entry) and lit.is_proposed and not board.typing.is_on:
        board.typing.begin(lit)
    if board.typing.is_on:
        board.typing.insert(text)
    elif isinstance(lit, Entry) and not lit.why_not:
        lit.take(text)
    else:
        board.content.take_color(text, *board.pointer)


def of_session(run: Callable[..., object], *values: object) -> Callable[[Driven, int], object]:
    """A session's action for a binding: `run` also gets the value of the key that was pressed, if any."""
    return lambda viewer, number: run(viewer.session, *values[number : number + 1])


FINE_TURN: Final = 1.0
"""Degrees for each press of a key that turns, with Shift."""

BLEND: Final = 0.05
"""The step of the blend for each press of its keys."""

BINDINGS: Final = (
    Binding("F1", "this help, and back", lambda viewer, _: toggle(viewer, "help")),
    Binding(
        "F2", "the instructions that the last edit sent, and back", lambda viewer, _: toggle(viewer, SENT)
    ),
    Binding(
        "F4", "the 1024 entries of the lookup table, and back", lambda viewer, _: toggle(viewer, "entries")
    ),
    Binding(
        "Tab",
        "the menu (or the right edge); its keys: arrows, Return",
        lambda viewer, _: viewer.board.toggle_menu(),
    ),
    Binding(
        "Ctrl+1 Ctrl+2 Ctrl+3 Ctrl+4 Ctrl+5 Ctrl+6 Ctrl+7 Ctrl+8 Ctrl+9 Ctrl+0",
        "the screens of the strip, from the left",
        lambda viewer, number: viewer.session.turn_to(names_in_strip(viewer)[number]),
        label="Ctrl+1 to 0",
    ),
    Binding(
        "Ctrl+Tab Ctrl+Shift+Tab",
        "the next screen of the strip, the previous one",
        lambda viewer, number: turn_along(viewer, (1, -1)[number]),
    ),
    Binding(
        "H",
        "hide the menu and all panels, and bring them back",
        lambda viewer, _: viewer.board.switch_panels(),
    ),
    Binding(
        "Left Right Shift+Left Shift+Right",
        "turn around the object; finely with Shift",
        lambda viewer, number: edits.turn(viewer.session, (-TURN, TURN, -FINE_TURN, FINE_TURN)[number], 0),
        label="Left, Right",
        held=True,
    ),
    Binding(
        "Up Down Shift+Up Shift+Down",
        "look from above, from below; finely with Shift",
        lambda viewer, number: edits.turn(viewer.session, 0, (TURN, -TURN, FINE_TURN, -FINE_TURN)[number]),
        label="Up, Down",
        held=True,
    ),
    Binding(
        "+ = -",
        "move closer, farther",
        of_session(edits.move, CLOSER, CLOSER, 1 / CLOSER),
        label="+ and -",
        held=True,
    ),
    Binding(
        ", .",
        "rotate the picture's horizontal axis",
        of_session(edits.tilt, -1, 1),
        label="comma, period",
        held=True,
    ),
    Binding(
        "F5 F6 F7 F8 F9 Shift+F6",
        "view from front, left (Shift: right), back, top, corner",
        lambda viewer, number: edits.see_from(viewer.session, list(sides_of(viewer.session.scene))[number]),
        label="F5 to F9",
    ),
    Binding(
        "R Shift+R",
        "rescale: fill the picture with the object, the surface",
        lambda viewer, number: edits.rescale(viewer.session, ("", viewer.session.surface_name)[number]),
    ),
    Binding("Home", "the view as opened", of_session(edits.as_opened)),
    Binding(
        "1 2 3 4 5 6 7 8 9",
        "switch a light on or off",
        of_session(edits.switch_light, *range(9)),
        label="1 to 9",
    ),
    Binding(
        "S Shift+S",
        "select the next surface, the previous one",
        of_session(edits.next_surface, 1, -1),
        repeats=True,
    ),
    Binding(
        "[ ]",
        "blend: light color from a lower, from a higher level",
        of_session(blend, -BLEND, BLEND),
        label="[ and ]",
        held=True,
    ),
    Binding("C Shift+C", "the next object color, the previous one", of_session(repaint, 1, -1), repeats=True),
    Binding(
        "P Shift+P",
        "take the paint, the color that is under the pointer",
        lambda viewer, number: take_sample(viewer, number == 1),
    ),
    Binding("Ctrl+C", "copy the color under the pointer", lambda viewer, _: copy(viewer)),
    Binding("Ctrl+V", "paste a color", lambda viewer, _: paste(viewer)),
    Binding("E", "hold the exposure (less light is darker), release it", of_session(edits.switch_exposure)),
    Binding("W", "watch the picture being computed, line by line", lambda viewer, _: watch(viewer)),
    Binding(
        "B",
        "while held: the state before the last step",
        lambda viewer, _: show_other(viewer),
        release=show_present,
    ),
    Binding(
        "Alt+Left Alt+Right",
        "the view before, and forward again",
        lambda viewer, number: with_scene(viewer, partial(edits.view_again, back=number == 0)),
        repeats=True,
    ),
    Binding("Ctrl+Z", "undo", lambda viewer, _: with_scene(viewer, undo), repeats=True),
    Binding("Ctrl+Y Ctrl+Shift+Z", "redo", lambda viewer, _: with_scene(viewer, redo), repeats=True),
    Binding("Ctrl+S", "save the picture with its scene", of_session(save)),
    Binding("F12", "save a numbered screenshot", lambda viewer, _: viewer.save_screen()),
    Binding("Shift+F12", "save the picture alone under the next number", of_session(save_image)),
    Binding("Ctrl+R", "read the scene's file again", lambda viewer, _: with_scene(viewer, read_again)),
    Binding(
        "Escape",
        "take a drag back; leave full screen, a list, a page",
        lambda viewer, _: viewer.escape(),
        label="Esc",
    ),
)
CHORDS: Final = {chord: (each, number) for each in BINDINGS for number, chord in enumerate(each.chords)}
"""The binding of each chord, and the number of the chord there."""


def bound_to(name: str, control: bool, shift: bool, alt: bool, typed: str) -> tuple[Binding, int] | None:
    """The binding of a key that was pressed, and the number of its chord; None if it has none.

    Signs are matched by the typed character, as keyboards place them differently, letters by the key's name.
    """
    sign, key = Chord(typed, control, alt=alt), Chord(name, control, shift, alt)
    by_sign = CHORDS.get(sign) if sign.is_sign else None
    return by_sign or CHORDS.get(key._replace(shift=False) if key.is_sign else key)


WINDOW_KEYS: Final = (
    ("F3", "record the window as a film, with a red mark; again: end it"),
    ("F10", "fill the window, or show whole multiples"),
    ("F11, Alt+Enter", "full screen, and back"),
    ("Ctrl+Q", "leave; you are asked first about unsaved changes"),
    ("mouse", "drag: turn; Shift, middle: move; Ctrl, wheel: closer"),
    ("mouse, Shift+click", "explain the pixel: every number that leads to its color"),
    ("mouse, highlight", "drag it, or click, and click where it goes"),
    ("joystick unit", "ENTER (left button): pick, place; TRACK (right), held: drag"),
    ("a file dropped", "open it: a scene, a mesh, a picture file, or paints"),
)
"""The keys that the window itself handles, and the mouse."""


def rows_of_help() -> list[tuple[str, str]]:
    """Each key and what it does, for the help page."""
    return [(str(binding), binding.does) for binding in BINDINGS] + list(WINDOW_KEYS)
