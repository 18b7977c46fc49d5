"""The keys of the interactive system: the bindings, and what they do."""

from __future__ import annotations

from typing import Final, Protocol

from autocolor.checks import Color
from autocolor.errors import UsageError
from autocolor.scene.kinds import in_digits
from autocolor.scene.orbit import sides_of
from autocolor.screens.board import Board
from autocolor.screens.file_actions import read_again, save, save_image
from autocolor.screens.input import Binding, Chord
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

    def watch(self) -> None:
        """Let the picture come in line by line."""

    def escape(self) -> bool:
        """Take back, close or leave something; returns whether there was anything."""

    def save_screen(self) -> None:
        """Save what the display shows."""


def toggle(viewer: Driven, screen: str) -> None:
    """Turn to a screen, or back to the picture if it is shown."""
    viewer.session.turn_to(PICTURE if viewer.session.screen == screen else screen)


def names_in_strip(viewer: Driven) -> list[str]:
    """The names of the screens that have a word in the strip, from the left."""
    return [name for name, screen in viewer.board.screens.items() if screen.word]


def turn_along(viewer: Driven, number: int) -> None:
    """Turn to a screen of the strip, counted from 0 at the left; after the last comes the first."""
    names = names_in_strip(viewer)
    viewer.session.turn_to(names[number % len(names)])


def place_in_strip(viewer: Driven) -> int:
    """The place of the present screen in the strip; 0 if it has no word there."""
    names = names_in_strip(viewer)
    return names.index(viewer.session.screen) if viewer.session.screen in names else 0


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


def undo_step(viewer: Driven) -> None:
    """Undo the last step."""
    viewer.show_scene()
    undo(viewer.session)


def redo_step(viewer: Driven) -> None:
    """Redo the last undone step."""
    viewer.show_scene()
    redo(viewer.session)


def go_to_view(viewer: Driven, back: bool) -> None:
    """Return to the view before, or forward to the view that was left."""
    viewer.show_scene()
    studio = viewer.session.studio
    if not (studio.view_back() if back else studio.view_forward()):
        viewer.session.tell(f"there is no view {'before' if back else 'after'} this one")


def reopen(viewer: Driven) -> None:
    """Read the scene's file again, as one step to undo."""
    viewer.show_scene()
    read_again(viewer.session)


def take_sample(viewer: Driven, is_color: bool) -> None:
    """Take the paint of the surface under the pointer, or the color that is seen there.

    Raises UsageError if there is none.
    """
    sample = viewer.board.sample
    if sample is None or not sample.surface:
        raise UsageError("no surface is under the pointer; point at it in the picture")
    if is_color:
        take_color(viewer.board, sample.color)
    else:
        take_paint(viewer.session, sample.surface)


def take_color(board: Board, color: Color | str) -> None:
    """Let the screen take a color, with the pointer where it is."""
    board.content.take_color(color, *board.pointer)


def text_to_copy(board: Board) -> str:
    """The typed text, the text of the row under the pointer, or the color there; empty without any."""
    if board.typing.is_on:
        return board.typing.text
    if isinstance(board.lit, Entry):
        return board.lit.value
    color, sample = board.content.color_at(*board.pointer), board.content.sample(*board.pointer)
    if color is None and sample is not None:
        color = sample.color
    return "" if color is None else in_digits(color)


def copy(viewer: Driven) -> None:
    """Copy the color or the text under the pointer to the clipboard; UsageError if there is none."""
    text, clipboard = text_to_copy(viewer.board), viewer.session.clipboard
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
        take_color(board, text)


FINE_TURN: Final = 1.0
"""Degrees for each press of a key that turns, with Shift."""

BLEND: Final = 0.05
"""The step of the blend for each press of its keys."""

BINDINGS: Final[tuple[Binding[Driven], ...]] = (
    Binding((Chord("f1"),), "this help, and back", lambda viewer, _: toggle(viewer, "help")),
    Binding(
        (Chord("f2"),),
        "the instructions that the last edit sent, and back",
        lambda viewer, _: toggle(viewer, SENT),
    ),
    Binding(
        (Chord("f4"),),
        "the 1024 entries of the lookup table, and back",
        lambda viewer, _: toggle(viewer, "entries"),
    ),
    Binding(
        (Chord("tab"),),
        "the menu (or the right edge); its keys: arrows, Return",
        lambda viewer, _: viewer.board.toggle_menu(),
    ),
    Binding(
        tuple(Chord(digit, control=True) for digit in "1234567890"),
        "the screens of the strip, from the left",
        turn_along,
        label="Ctrl+1 to 0",
    ),
    Binding(
        (Chord("tab", control=True), Chord("tab", control=True, shift=True)),
        "the next screen of the strip, the previous one",
        lambda viewer, number: turn_along(viewer, place_in_strip(viewer) + (1, -1)[number]),
    ),
    Binding(
        (Chord("h"),),
        "hide the menu and all panels, and bring them back",
        lambda viewer, _: viewer.board.switch_panels(),
    ),
    Binding(
        (Chord("left"), Chord("right"), Chord("left", shift=True), Chord("right", shift=True)),
        "turn around the object; finely with Shift",
        lambda viewer, number: edits.turn(viewer.session, (-TURN, TURN, -FINE_TURN, FINE_TURN)[number], 0),
        label="Left, Right",
        held=True,
    ),
    Binding(
        (Chord("up"), Chord("down"), Chord("up", shift=True), Chord("down", shift=True)),
        "look from above, from below; finely with Shift",
        lambda viewer, number: edits.turn(viewer.session, 0, (TURN, -TURN, FINE_TURN, -FINE_TURN)[number]),
        label="Up, Down",
        held=True,
    ),
    Binding(
        (Chord("+"), Chord("="), Chord("-")),
        "move closer, farther",
        lambda viewer, number: edits.move(viewer.session, (CLOSER, CLOSER, 1 / CLOSER)[number]),
        label="+ and -",
        held=True,
    ),
    Binding(
        (Chord(","), Chord(".")),
        "rotate the picture's horizontal axis",
        lambda viewer, number: edits.tilt(viewer.session, (-1, 1)[number]),
        label="comma, period",
        held=True,
    ),
    Binding(
        (*(Chord(f"f{number}") for number in range(5, 10)), Chord("f6", shift=True)),
        "view from front, left (Shift: right), back, top, corner",
        lambda viewer, number: edits.see_from(viewer.session, list(sides_of(viewer.session.scene))[number]),
        label="F5 to F9",
    ),
    Binding(
        (Chord("r"), Chord("r", shift=True)),
        "rescale: fill the picture with the object, the surface",
        lambda viewer, number: edits.rescale(viewer.session, ("", viewer.session.surface_name)[number]),
    ),
    Binding(
        (Chord("home"),),
        "the view as opened",
        lambda viewer, _: edits.as_opened(viewer.session),
        label="Home",
    ),
    Binding(
        tuple(Chord(str(digit)) for digit in range(1, 10)),
        "switch a light on or off",
        lambda viewer, number: edits.switch_light(viewer.session, number),
        label="1 to 9",
    ),
    Binding(
        (Chord("s"), Chord("s", shift=True)),
        "select the next surface, the previous one",
        lambda viewer, number: edits.next_surface(viewer.session, (1, -1)[number]),
        repeats=True,
    ),
    Binding(
        (Chord("["), Chord("]")),
        "blend: light color from a lower, from a higher level",
        lambda viewer, number: blend(viewer.session, (-BLEND, BLEND)[number]),
        label="[ and ]",
        held=True,
    ),
    Binding(
        (Chord("c"), Chord("c", shift=True)),
        "the next object color, the previous one",
        lambda viewer, number: repaint(viewer.session, (1, -1)[number]),
        repeats=True,
    ),
    Binding(
        (Chord("p"), Chord("p", shift=True)),
        "take the paint, the color that is under the pointer",
        lambda viewer, number: take_sample(viewer, number == 1),
    ),
    Binding(
        (Chord("c", control=True),),
        "copy the color under the pointer",
        lambda viewer, _: copy(viewer),
    ),
    Binding((Chord("v", control=True),), "paste a color", lambda viewer, _: paste(viewer)),
    Binding(
        (Chord("e"),),
        "hold the exposure (less light is darker), release it",
        lambda viewer, _: edits.switch_exposure(viewer.session),
    ),
    Binding(
        (Chord("w"),),
        "watch the picture being computed, line by line",
        lambda viewer, _: viewer.watch(),
    ),
    Binding(
        (Chord("b"),),
        "while held: the state before the last step",
        lambda viewer, _: show_other(viewer),
        release=show_present,
    ),
    Binding(
        (Chord("left", alt=True), Chord("right", alt=True)),
        "the view before, and forward again",
        lambda viewer, number: go_to_view(viewer, number == 0),
        repeats=True,
    ),
    Binding((Chord("z", control=True),), "undo", lambda viewer, _: undo_step(viewer), repeats=True),
    Binding(
        (Chord("y", control=True), Chord("z", control=True, shift=True)),
        "redo",
        lambda viewer, _: redo_step(viewer),
        repeats=True,
    ),
    Binding(
        (Chord("s", control=True),),
        "save the picture with its scene",
        lambda viewer, _: save(viewer.session),
    ),
    Binding((Chord("f12"),), "save a numbered screenshot", lambda viewer, _: viewer.save_screen()),
    Binding(
        (Chord("f12", shift=True),),
        "save the picture alone under the next number",
        lambda viewer, _: save_image(viewer.session),
    ),
    Binding((Chord("r", control=True),), "read the scene's file again", lambda viewer, _: reopen(viewer)),
    Binding(
        (Chord("escape"),),
        "take a drag back; leave full screen, a list, a page",
        lambda viewer, _: viewer.escape(),
    ),
)
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
