"""The viewer: the interactive system on a display, driven by keys, the mouse and the joystick unit.

Input comes as values, and the viewer draws by display instructions, so it runs with a window or without.
While something moves, the picture may be coarse; `on_tick` refines it when the movement rests. The tables of
the screens and of the keys are at the foot.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from autocolor.arrays import Words
from autocolor.errors import AutocolorError, UsageError
from autocolor.files.palette_file import Palette
from autocolor.journal.history import History
from autocolor.scene.columns import Tier
from autocolor.scene.scene import Scene, cost_of_edit
from autocolor.screens.board import Board
from autocolor.screens.entries_screen import EntriesScreen
from autocolor.screens.file_screen import FileScreen
from autocolor.screens.help_screen import HelpScreen
from autocolor.screens.input import Binding, Chord, Gesture, Mouse, Unit, bound_to
from autocolor.screens.light_and_view.light_and_view_screen import LightAndViewScreen
from autocolor.screens.lights_screen import LightsScreen
from autocolor.screens.mapping_screen import MappingScreen
from autocolor.screens.picture.explain_screen import ExplainScreen
from autocolor.screens.picture.history_screen import HistoryScreen
from autocolor.screens.picture.picture_edits import PictureEdits, sides_of
from autocolor.screens.picture.picture_screen import PictureScreen
from autocolor.screens.picture.split_screen import SplitScreen
from autocolor.screens.picture.watching import ENDING, MESSAGE, Watching
from autocolor.screens.scalar_screen import ScalarScreen
from autocolor.screens.screen import Screen
from autocolor.screens.sent_screen import SentScreen
from autocolor.screens.session import PICTURE, SENT, LastEdit, Session
from autocolor.screens.surface.blending_screen import BlendingScreen
from autocolor.screens.surface.mixing_screen import MixingScreen
from autocolor.screens.surface.reflectance_screen import ReflectanceScreen
from autocolor.screens.variants_screen import VariantsScreen
from autocolor.sending import configuration_of
from autocolor.studio import Studio
from autocolor.widgets.sheet import Sent, Sheet
from ramtek_emu import HostPort, PortError, RamtekError, ReplyError

REST_SECONDS: Final = 0.1
"""Assumed: the time after which a movement without a release rests: by a key held down, or by the wheel."""

WHEEL: Final = "wheel"
DRAG: Final = "drag"
"""The kinds of sources of edits by the pointer. The wheel has steps, but no beginning and no end."""


class Action:
    """The last action of a session: the key or movement that made its edit, and when.

    An error of an action becomes a message, and one movement one step to undo.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._source: object = None
        """The key or the movement of the pointer that made the last edit; None if there is none."""
        self._edited_at = 0.0
        self.costs = Tier.NOTHING
        """The cost of the edit; NOTHING if the action was no edit."""
        self.is_warned = False
        """Whether the action announced unsaved changes."""

    def was_by(self, source: object) -> bool:
        """Whether this key or movement made the last edit."""
        return self._source == source

    @property
    def kind(self) -> object:
        """The kind of key or movement that made the last edit: the first part of its source."""
        return self._source[0] if isinstance(self._source, tuple) else None

    @property
    def has_rested(self) -> bool:
        """Whether the last edit was made a while ago."""
        return time.monotonic() - self._edited_at > REST_SECONDS

    def warns_of_changes(self, otherwise: str) -> bool:
        """Whether unsaved changes forbid an attempt. They are announced once; the next attempt succeeds."""
        unsaved = self._session.unsaved
        if not unsaved or self.is_warned:
            return False
        self.is_warned = True
        self._session.warn(f"{unsaved}, {otherwise}")
        return True

    def do(self, source: object, run: Callable[[], object], continues: bool, moving: bool) -> bool:
        """Run the action of a key or a gesture; returns False if `run` does, which then did nothing.

        With `continues`, edits of the same source are one step to undo.
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


class Viewer:
    """The interactive system with one scene on a display. `folder` is where new files are saved."""

    def __init__(self, scene: Scene | History, display: HostPort, folder: Path | None = None) -> None:
        self.display = display
        self.folder = Path.cwd() if folder is None else folder
        self._sheet = Sheet(display)
        self._unit = Unit(display)
        self._mouse = Mouse()
        self._has_keyboard = False
        self._open(scene)

    def _open(self, scene: Scene | History) -> None:
        # The sheet sends the picture, and draws the items over it.
        self.studio = Studio(scene, self.display, sends=False)
        self.session = Session(self.studio, self.display, self.folder)
        self.session.has_keyboard = self._has_keyboard
        self.screens = {each.name: each(self.session) for each in SCREENS}
        self.board = Board(self.session, self.screens)
        self.edits = PictureEdits(self.session)
        self._watching = Watching(self.display)
        self.session.keys = rows_of_help()
        self._action = Action(self.session)
        self._drags = 0
        """How many drags and picks there were."""
        self._had_news = True
        self._base: Words | int | None = None
        """The base of the page that was shown last."""
        self._words: Words | None = None
        """The words of the studio's picture when that page was shown."""
        self._mouse.forget()
        self._sheet.forget()
        lying = f"; {self.session.lying}" if self.session.lying else ""
        self.session.tell(f"F1: help; Tab or the right edge: the menu{lying}", persistent=True)
        self._update()
        self._unit.show()

    @property
    def page(self) -> str:
        """The name of the screen that is shown."""
        return self.session.screen

    @property
    def message(self) -> str:
        """The last message."""
        return self.session.message

    @property
    def caption(self) -> str:
        """The title of a window: the scene, the chosen surface, and the last message."""
        changed = "*" if self.studio.is_changed else ""
        name = f"{self.studio.scene.name}{changed}"
        surface = f"[{self.session.surface_name}]" if self.session.surface_name else ""
        message = MESSAGE if self._watching.is_on else self.message
        return " - ".join(part for part in ("autocolor", name, surface, message) if part)

    # Input.

    def on_key(
        self,
        name: str,
        control: bool = False,
        shift: bool = False,
        alt: bool = False,
        typed: str = "",
        repeated: bool = False,
    ) -> bool:
        """Handle a key press; returns False if the key does nothing here.

        `typed` is the character that the key produces; `repeated` is whether the key is being held down.
        """
        self._has_keyboard = self.session.has_keyboard = True
        if self._watching.is_on and name in ENDING and not control:
            # The key that began it may still be down.
            if not repeated:
                self._watching.end()
                self._update()
            return True
        taken = self._press(name, control, shift, alt, typed, repeated)
        self._update()
        return taken

    def _press(
        self, name: str, control: bool, shift: bool, alt: bool, typed: str, repeated: bool
    ) -> bool:
        """Offer a key to the typed text, the menu, the screen and the key bindings, in this order."""
        if not control and not alt and self._type(name, typed, repeated):
            return True
        chosen = bound_to(BINDINGS, name, control, shift, alt, typed)
        if chosen is None:
            return False
        binding, number = chosen
        if repeated and not (binding.held or binding.repeats):
            # A switch would flip for as long as its key is down.
            return True
        return self._do(chosen, lambda: binding.run(self, number), repeated and binding.held, binding.held)

    def _type(self, name: str, typed: str, repeated: bool) -> bool:
        """Offer a key to the text that is being typed, the menu and the screen."""
        board, source = self.board, ("key", name)
        if board.typing.is_on:
            return self._do(None, lambda: board.typing.key(name, typed))
        return self._do(source, lambda: board.key(name, typed), repeated, repeated) or self._do(
            source, lambda: board.screen.key(name, typed), repeated, repeated
        )

    def on_release(self, name: str) -> None:
        """Handle the release of a key."""
        for binding in BINDINGS:
            if binding.release is not None and name in [chord.name for chord in binding.chords]:
                binding.release(self)
                self._update()

    def on_pointer(
        self,
        element: int,
        line: int,
        action: str,
        button: int = 0,
        steps: int = 1,
        shift: bool = False,
        control: bool = False,
    ) -> None:
        """Handle an action of the mouse at an element and a line."""
        # A user with a mouse has a keyboard, too.
        self._has_keyboard = self.session.has_keyboard = True
        if action == "press" and self._watching.end():
            self._update()
        for gesture in self._mouse.gestures(element, line, action, button, steps, shift, control):
            self.point(gesture)

    def poll(self) -> None:
        """Handle the gestures of the joystick unit since the last poll, and show one page for all of them.

        The next poll waits until the display has drawn the page, so that the pointer is never further ahead.
        """
        gestures = self._unit.poll()
        for gesture in gestures:
            self._point(gesture)
        if gestures:
            self._update()

    def point(self, gesture: Gesture) -> None:
        """Handle a gesture of the mouse or of the joystick unit."""
        self._point(gesture)
        self._update()

    def _point(self, gesture: Gesture) -> None:
        board, kind = self.board, gesture.kind
        if kind in ("hover", "drop"):
            board.take(gesture)
        elif kind == "wheel":
            # On each widget the wheel makes a step of its own.
            board.point_at(gesture)
            self._do((WHEEL, board.lit), lambda: board.take(gesture), True, True)
        elif kind == "drag":
            self._do((DRAG, self._drags), lambda: board.take(gesture), True, True)
        elif not (kind == "pick" and board.is_dragging) and (
            board.is_on_letters(gesture.element, gesture.line) or self._has_left_text()
        ):
            # ENTER during a drag does nothing, or it would end the step.
            self._drags += 1
            self._do((DRAG, self._drags), lambda: board.take(gesture))

    def _has_left_text(self) -> bool:
        """Leave the text that is being typed, if any; returns False if the text is refused and stays open."""
        if self.board.typing.is_on:
            self._do(None, self.board.typing.leave)
        return not self.board.typing.is_on

    def on_tick(self, is_at_rest: bool = True) -> None:
        """Refine a coarse picture when the movement rests, and take a message away when its time has passed.

        A picture that comes in line by line gets its next lines.
        """
        self._watching.advance()
        if is_at_rest and not (self.board.is_dragging or self._watching.is_on):
            self._take_changes()
        has_ended = is_at_rest and self._action.kind != WHEEL and not self.board.is_dragging
        rests = has_ended or self._action.has_rested
        if rests and (self.studio.is_coarse or self.session.moving):
            self.session.moving = False
            self._refine()
            self._update()
        elif (rests and self.board.screen.idle()) or self._had_news != self.session.has_news:
            self._update()
        if rests and not self.board.is_dragging and self.session.tell_effect():
            self._update()

    def _take_changes(self) -> None:
        """Show the changes that another program made to the scene's file."""
        if self.session.disk.was_changed() and self._reopen_by(self.session.take_changes):
            self._update()

    def _reopen_by(self, run: Callable[[], object]) -> bool:
        """Run an action that may open a scene without the user's pointing; returns as `_do`."""
        before = self.session.scene
        taken = self._do(None, run)
        if self.session.scene is not before:
            # The thing that is picked or typed into may be gone.
            self.board.release()
        return taken

    def tell(self, message: str, persistent: bool = False) -> None:
        """Show a message of the window; an empty one takes the last one away at once.

        With `persistent`, the message stays until the next action.
        """
        self.session.tell(message, persistent=persistent)
        self._update()

    def bring_paints(self, paints: Palette, name: str) -> None:
        """Let the user take colors from the paints of a file of this name."""
        self.session.bring_paints(paints, name)
        self._update()

    def _update(self) -> None:
        """Show the present page."""
        if self._watching.is_on:
            # The lines come in over the whole page. Its items are drawn after the last line.
            return
        if self.session.watches:
            self.watch()
            return
        has_turned = self.board.turn()
        if has_turned:
            self._refine()
        self._had_news = self.session.has_news
        self.board.forget()
        page = self.board.page()
        self._note(self._sheet.show(page), has_turned)
        if page.base is not self._base and not self.board.is_dragging:
            # The hint for the pointer reads a word back from the display, which has the new base only now.
            self._sheet.show(self.board.page())
        self._base = page.base
        self._unit.mark(self.board.mark)

    def _note(self, sent: Sent, has_turned: bool) -> None:
        """Note the words of a page that shows an edit, or the refined picture of the last edit."""
        scene, words, last = self.studio.scene, self.studio.words, self.session.last_edit
        is_edited = last is None or scene is not last.after
        has_other_words = words is not self._words
        self._words = words
        if is_edited or (has_other_words and not has_turned):
            before = scene if last is None else last.after if is_edited else last.before
            count = sent.entry_words + (sent.base_words if has_other_words else 0)
            self.session.last_edit = LastEdit(before, scene, sent.words[:count], len(sent.words) - count)

    def _refine(self) -> None:
        try:
            self.studio.refine()
        except (AutocolorError, RamtekError) as error:
            # The coarse picture was accepted, but its full size is refused.
            self.studio.take_back()
            self.session.warn(error)

    def _do(
        self, source: object, run: Callable[[], object], continues: bool = False, moving: bool = False
    ) -> bool:
        """Run the action of a key or a gesture; returns False if it does nothing here."""
        self._watching.end()
        taken = self._action.do(source, run, continues, moving)
        self.board.forget()
        if self._action.costs > Tier.ENTRIES and not self.board.screen.shows_scene:
            self.session.turn_to(PICTURE)
        return taken

    def on_drop(self, path: Path) -> None:
        """Open a file that was dropped on the window, as one step to undo."""
        self._reopen_by(lambda: self.session.open(path))
        self._update()

    def on_close(self) -> bool:
        """Whether the window may close: nothing is unsaved, or this is the second attempt in a row."""
        may_close = not self._action.warns_of_changes("close again to discard the changes")
        self._update()
        return may_close

    # The actions of keys.

    def toggle(self, screen: str) -> None:
        """Turn to a screen, or back to the picture if it is shown."""
        self.session.turn_to(PICTURE if self.session.screen == screen else screen)

    def watch(self) -> None:
        """Blank the picture and let it come in line by line as it is computed; any key shows it at once."""
        self.session.watches = False
        self.session.turn_to(PICTURE)
        self.session.comparing.end()
        self.board.turn()
        self.board.close()
        # Nothing stands over a picture that comes in.
        self._sheet.show(self.board.page()._replace(items=()))
        self._watching.begin(self.studio)

    def compare(self) -> None:
        """Show the state to compare with, over the picture."""
        if not self.board.screen.shows_picture:
            self.session.turn_to(PICTURE)
        self.session.compare()

    def escape(self) -> bool:
        """Take a drag back, close what is open, or return to the picture.

        Returns False if there is nothing to take back, close or leave.
        """
        board, session = self.board, self.session
        if board.is_dragging:
            if self._action.was_by((DRAG, self._drags)):
                self.studio.take_back()
                session.tell("taken back")
            self._mouse.forget()
            board.release()
            return True
        if board.escape():
            return True
        if session.screen != PICTURE:
            session.turn_to(PICTURE)
            return True
        return False

    def undo(self) -> None:
        """Undo the last step."""
        self._show_scene()
        self.session.undo()

    def redo(self) -> None:
        """Redo the last undone step."""
        self._show_scene()
        self.session.redo()

    def _show_scene(self) -> None:
        # The step may remove the thing that is dragged or typed into.
        self._mouse.forget()
        self.board.release()
        if not self.board.screen.shows_scene:
            self.session.turn_to(PICTURE)

    def reopen(self) -> None:
        """Read the scene's file again, as one step to undo."""
        self._show_scene()
        self.session.reopen()

    def take_sample(self, is_color: bool) -> None:
        """Take the paint of the surface under the pointer, or the color that is seen there.

        Raises UsageError if there is none.
        """
        sample = self.board.sample
        if sample is None or not sample.surface:
            raise UsageError("no surface is under the pointer; point at it in the picture")
        if is_color:
            self.board.take_color(sample.color)
        else:
            self.session.take_paint(sample.surface)

    def copy(self) -> None:
        """Copy the color or the text under the pointer to the clipboard; UsageError if there is none."""
        text, clipboard = self.board.text_to_copy, self.session.clipboard
        if not text:
            raise UsageError("nothing is there to copy; point at a color")
        if clipboard is None or not clipboard.copy(text):
            raise UsageError(f"{text} is not copied, because this display has no clipboard; write it down")
        self.session.tell(f"copied {text}")

    def paste(self) -> None:
        """Paste the first line of the clipboard's text, without letters that cannot be typed.

        Raises UsageError without a clipboard or a text.
        """
        clipboard = self.session.clipboard
        if clipboard is None:
            raise UsageError("this display has no clipboard; type the color")
        line = clipboard.paste().split("\n")[0]
        # Some systems end the text by a character 0.
        text = "".join(letter for letter in line if letter.isprintable()).strip()
        if not text:
            raise UsageError("the clipboard has no text; copy a color first")
        self.board.paste(text)

    def save_screen(self) -> None:
        """Save what the display shows, without message and cursors, as the next screenshot."""
        page = self.board.page()
        self._sheet.show(page)
        sizes = configuration_of(self.display)
        words = self.session.words_at(0, 0, sizes.shown_elements, sizes.shown_lines)
        self.session.save_screenshot(page.entries[words])

    def clear(self) -> None:
        """Leave the picture alone on the display, with its legend, without panels, message and cursors."""
        self._watching.end()
        self.session.turn_to(PICTURE)
        self.session.comparing.end()
        self.board.turn()
        self.board.clear()
        self.session.tell("")
        self._update()
        self._sheet.show(self.board.page()._replace(items=self.board.screen.items()))
        self._unit.hide()


SCREENS: Final[tuple[type[Screen], ...]] = (
    PictureScreen,
    LightAndViewScreen,
    LightsScreen,
    ReflectanceScreen,
    MixingScreen,
    BlendingScreen,
    MappingScreen,
    ScalarScreen,
    VariantsScreen,
    HistoryScreen,
    ExplainScreen,
    FileScreen,
    SplitScreen,
    EntriesScreen,
    SentScreen,
    HelpScreen,
)
"""Every screen, in the order of the main menu. A new screen is its module, and its line here."""

TURN: Final = 5.0
FINE_TURN: Final = 1.0
"""Degrees for each press of a key that turns, and with Shift."""

CLOSER: Final = 0.9
"""The ratio of distances for each press of a key that moves closer."""

BLEND: Final = 0.05
"""The step of the blend for each press of its keys."""

BINDINGS: Final[tuple[Binding[Viewer], ...]] = (
    Binding((Chord("f1"),), "this help, and back", lambda viewer, _: viewer.toggle("help")),
    Binding(
        (Chord("f2"),),
        "the instructions that the last edit sent, and back",
        lambda viewer, _: viewer.toggle(SENT),
    ),
    Binding(
        (Chord("f4"),),
        "the 1024 entries of the lookup table, and back",
        lambda viewer, _: viewer.toggle("entries"),
    ),
    Binding(
        (Chord("tab"),),
        "the menu (or the right edge); its keys: arrows, Return",
        lambda viewer, _: viewer.board.toggle_menu(),
    ),
    Binding(
        (Chord("h"),),
        "hide the menu and all panels, and bring them back",
        lambda viewer, _: viewer.board.switch_panels(),
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
        (*(Chord(f"f{number}") for number in range(5, 10)), Chord("f6", shift=True)),
        "view from front, left (Shift: right), back, top, corner",
        lambda viewer, number: viewer.edits.see_from(tuple(sides_of(viewer.session.scene))[number]),
        label="F5 to F9",
    ),
    Binding(
        (Chord("r"), Chord("r", shift=True)),
        "rescale: fill the picture with the object, the surface",
        lambda viewer, number: viewer.edits.rescale(number == 1),
    ),
    Binding(
        (Chord("home"),),
        "the view as opened",
        lambda viewer, _: viewer.edits.as_opened(),
        label="Home",
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
        (Chord("p"), Chord("p", shift=True)),
        "take the paint, the color that is under the pointer",
        lambda viewer, number: viewer.take_sample(number == 1),
    ),
    Binding(
        (Chord("c", control=True),),
        "copy the color under the pointer",
        lambda viewer, _: viewer.copy(),
    ),
    Binding((Chord("v", control=True),), "paste a color", lambda viewer, _: viewer.paste()),
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
    Binding(
        (Chord("left", alt=True), Chord("right", alt=True)),
        "the view before, and forward again",
        lambda viewer, number: viewer.edits.view_again(number == 0),
        repeats=True,
    ),
    Binding((Chord("z", control=True),), "undo", lambda viewer, _: viewer.undo(), repeats=True),
    Binding(
        (Chord("y", control=True), Chord("z", control=True, shift=True)),
        "redo",
        lambda viewer, _: viewer.redo(),
        repeats=True,
    ),
    Binding(
        (Chord("s", control=True),),
        "save the picture with its scene",
        lambda viewer, _: viewer.session.save(),
    ),
    Binding((Chord("f12"),), "save a numbered screenshot", lambda viewer, _: viewer.save_screen()),
    Binding(
        (Chord("f12", shift=True),),
        "save the picture alone under the next number",
        lambda viewer, _: viewer.session.save_image(),
    ),
    Binding((Chord("r", control=True),), "read the scene's file again", lambda viewer, _: viewer.reopen()),
    Binding(
        (Chord("escape"),),
        "take a drag back; leave full screen, a list, a page",
        lambda viewer, _: viewer.escape(),
    ),
)
WINDOW_KEYS: Final = (
    ("F3", "record the window as a film; again: end it"),
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
