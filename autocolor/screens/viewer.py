"""The viewer: the interactive system on a display, driven by keys, the mouse and the joystick unit.

Input comes as values, and the viewer draws by display instructions, so it runs with a window or without.
While something moves, the picture may be coarse; `on_tick` refines it when the movement rests. The tables of
the screens and of the keys are at the foot.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final

from autocolor.arrays import Words
from autocolor.errors import AutocolorError
from autocolor.files.palette_file import Palette
from autocolor.journal.history import History
from autocolor.scene.columns import Tier
from autocolor.scene.scene import Scene
from autocolor.screens.action import DRAG, NO_SOURCE, WHEEL, Action, EditSource
from autocolor.screens.board import Board
from autocolor.screens.effects import tell_effect
from autocolor.screens.entries_screen import EntriesScreen
from autocolor.screens.file_actions import FileOnDisk, bring_paints, open_file, remark, save_screenshot
from autocolor.screens.file_screen import FileScreen
from autocolor.screens.help_screen import HelpScreen
from autocolor.screens.input import Gesture, Mouse, Unit
from autocolor.screens.keys import BINDINGS, bound_to, rows_of_help
from autocolor.screens.light_and_view.light_and_view_screen import LightAndViewScreen
from autocolor.screens.lights_screen import LightsScreen
from autocolor.screens.mapping_screen import MappingScreen
from autocolor.screens.picture.explain_screen import ExplainScreen
from autocolor.screens.picture.history_screen import HistoryScreen
from autocolor.screens.picture.picture_screen import PictureScreen
from autocolor.screens.picture.split_screen import SplitScreen
from autocolor.screens.picture.watching import ENDING, MESSAGE, Watching
from autocolor.screens.scalar_screen import ScalarScreen
from autocolor.screens.screen import Screen
from autocolor.screens.sent_screen import SentScreen
from autocolor.screens.session import PICTURE, LastEdit, Session
from autocolor.screens.surface.blending_screen import BlendingScreen
from autocolor.screens.surface.mixing_screen import MixingScreen
from autocolor.screens.surface.reflectance_screen import ReflectanceScreen
from autocolor.screens.variants_screen import VariantsScreen
from autocolor.studio import Studio
from autocolor.widgets.sheet import Page, Sent, Sheet
from ramtek_emu import HostPort, RamtekError


class Viewer:
    """The interactive system with one scene on a display. `folder` is where new files are saved."""

    def __init__(self, scene: Scene | History, display: HostPort, folder: Path | None = None) -> None:
        self.display = display
        self.folder = Path.cwd() if folder is None else folder
        self._sheet = Sheet(display)
        self._unit = Unit(display)
        self._mouse = Mouse()
        # The sheet sends the picture, and draws the items over it.
        self.studio = Studio(scene, self.display, sends=False)
        self.session = Session(self.studio, self.display, self.folder)
        self.screens = {each.name: each(self.session) for each in SCREENS}
        self.board = Board(self.session, self.screens)
        self._watching = Watching(self.display)
        self.session.keys = rows_of_help()
        self._disk = FileOnDisk(self.session)
        self._action = Action(self.session)
        self._drags = 0
        """How many drags and picks there were."""
        self._had_news = True
        self._words: Words | None = None
        """The words of the studio's picture on the last page."""
        self._pictured: tuple[Scene, Words | None] = self.studio.scene, None
        """The scene and the words of the last page whose base was the picture."""
        hints = "F1: help", "Tab or the right edge: the menu", remark(self.session)
        self.session.tell("; ".join(filter(None, hints)), persistent=True)
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
        typed: str = "",
        repeated: bool = False,
        alt: bool = False,
    ) -> bool:
        """Handle a key press; returns False if the key does nothing here.

        `typed` is the character that the key produces; `repeated` is whether the key is being held down.
        """
        self.session.has_keyboard = True
        if self._watching.is_on and name in ENDING and not control:
            # The key that began it may still be down.
            if not repeated:
                self._watching.end()
                self._update()
            return True
        taken = self._press(name, control, shift, alt, typed, repeated)
        self._update()
        return taken

    def _press(self, name: str, control: bool, shift: bool, alt: bool, typed: str, repeated: bool) -> bool:
        """Offer a key to the typed text, the menu, the screen and the key bindings, in this order."""
        board = self.board
        if not control and not alt:
            if board.typing.is_on:
                return self._do(NO_SOURCE, lambda: board.typing.key(name, typed))
            if self._do(
                ("key", name),
                lambda: board.key(name, typed) or board.content.key(name, typed),
                repeated,
                repeated,
            ):
                return True
        chosen = bound_to(name, control, shift, alt, typed)
        if chosen is None:
            return False
        binding, number = chosen
        if repeated and not (binding.held or binding.repeats):
            # A switch would flip for as long as its key is down.
            return True
        return self._do(chosen, lambda: binding.run(self, number), repeated and binding.held, binding.held)

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
        self.session.has_keyboard = True
        if action == "press" and self._watching.end():
            self._update()
        place = Gesture("hover", element, line, button, float(steps), shift, control)
        for gesture in self._mouse.gestures(action, place):
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
            board.take(gesture._replace(kind="hover"))
            self._do((WHEEL, board.lit and board.lit.key), lambda: board.take(gesture), True, True)
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
            self._do(NO_SOURCE, self.board.typing.leave)
        return not self.board.typing.is_on

    def on_tick(self, is_at_rest: bool = True) -> None:
        """Refine a coarse picture when the movement rests, and take a message away when its time has passed.

        A picture that comes in line by line gets its next lines.
        """
        self._watching.advance()
        if is_at_rest and not (self.board.is_dragging or self._watching.is_on):
            self._take_changes()
        has_ended = is_at_rest and self._action.source[0] != WHEEL and not self.board.is_dragging
        rests = has_ended or self._action.has_rested
        if rests and (self.studio.is_coarse or self.session.moving):
            self.session.moving = False
            self._refine()
            self._update()
        elif (rests and self.board.content.idle()) or self._had_news != self.session.has_news:
            self._update()
        if rests and not self.board.is_dragging and tell_effect(self.session):
            self._update()

    def _take_changes(self) -> None:
        """Show the changes that another program made to the scene's file."""
        if self._disk.was_changed() and self._reopen_by(self._disk.take):
            self._update()

    def _reopen_by(self, run: Callable[[], object]) -> bool:
        """Run an action that may open a scene without the user's pointing; returns as `_do`."""
        before = self.session.scene
        taken = self._do(NO_SOURCE, run)
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
        bring_paints(self.session, paints, name)
        self._update()

    def _update(self) -> None:
        """Show the present page."""
        if self._watching.is_on:
            # The lines come in over the whole page. Its items are drawn after the last line.
            return
        if self.session.watches:
            self._watch()
            return
        has_turned = self.board.turn()
        if has_turned:
            self._refine()
        self._had_news = self.session.has_news
        self.board.forget()
        page = self.board.page()
        self._note(page, self._sheet.show(page), has_turned)
        self._unit.mark(self.board.mark)

    def _note(self, page: Page, sent: Sent, has_turned: bool) -> None:
        """Note the words of a page that shows an edit, or the picture of edits for the first time."""
        scene, words, last = self.studio.scene, self.studio.words, self.session.last_edit
        (pictured, pictured_words), is_picture = self._pictured, page.base is self.studio.words
        is_edited = last is None or scene is not last.after
        is_refined = words is not self._words and not has_turned
        is_sent = is_picture and words is not pictured_words
        self._words = words
        if is_picture:
            self._pictured = scene, words
        if is_edited or is_refined or is_sent:
            before = scene if last is None else last.after if is_edited else last.before
            if is_sent and not is_edited and pictured is not scene:
                # The edits on screens without the picture are shown together.
                before = pictured
            count = sent.entry_words + (sent.base_words if is_sent else 0)
            self.session.last_edit = LastEdit(before, scene, sent.words[:count], len(sent.words) - count)

    def _refine(self) -> None:
        try:
            self.studio.refine()
        except (AutocolorError, RamtekError) as error:
            # The coarse picture was accepted, but its full size is refused.
            self.studio.take_back()
            self.session.warn(error)

    def _do(
        self, source: EditSource, run: Callable[[], object], continues: bool = False, moving: bool = False
    ) -> bool:
        """Run the action of a key or a gesture; returns False if it does nothing here."""
        self._watching.end()
        taken = self._action.do(source, run, continues, moving)
        if taken:
            self.board.forget()
        naming, self.session.naming = self.session.naming, None
        if naming is not None and self.session.has_keyboard:
            self.board.typing.begin(naming)
        if self._action.costs > Tier.ENTRIES and not self.board.screen.shows_scene:
            self.session.turn_to(PICTURE)
        return taken

    def on_drop(self, path: Path) -> None:
        """Open a file that was dropped on the window, as one step to undo."""
        self._reopen_by(lambda: open_file(self.session, path))
        self._update()

    def on_close(self) -> bool:
        """Whether the window may close: nothing is unsaved, or this is the second attempt in a row."""
        may_close = not self._action.warns_of_changes("close again to discard the changes")
        self._update()
        return may_close

    def _watch(self) -> None:
        """Blank the picture and let it come in line by line as it is computed; any key shows it at once."""
        self.session.watches = False
        self.session.turn_to(PICTURE)
        self.session.comparing.end()
        self.board.turn()
        self.board.close()
        # Nothing stands over a picture that comes in.
        self._sheet.show(self.board.page()._replace(items=()))
        self._watching.begin(self.studio)

    def escape(self) -> bool:
        """Take a drag back, close what is open, or return to the picture.

        Returns False if there is nothing to take back, close or leave.
        """
        board, session = self.board, self.session
        if board.is_dragging:
            if self._action.source == (DRAG, self._drags):
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

    def show_scene(self) -> None:
        """Let go of everything, which the next step may remove, and show the scene."""
        self._mouse.forget()
        self.board.release()
        if not self.board.screen.shows_scene:
            self.session.turn_to(PICTURE)

    def save_screen(self) -> None:
        """Save what the display shows, without message and cursors, as the next screenshot."""
        page = self.board.page()
        self._sheet.show(page)
        save_screenshot(self.session, page.entries[self._sheet.words()])

    def clear(self) -> None:
        """Leave the picture alone on the display, with its legend, without panels, message and cursors."""
        self._watching.end()
        self.session.turn_to(PICTURE)
        self.session.comparing.end()
        self.board.turn()
        self.board.take(Gesture("hover", -1, -1))
        self.board.close()
        self.session.tell("")
        self._update()
        self._sheet.show(self.board.page()._replace(items=self.board.content.items))
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
    EntriesScreen,
    FileScreen,
    HistoryScreen,
    ExplainScreen,
    SplitScreen,
    SentScreen,
    HelpScreen,
)
"""Every screen, in the order of the main menu. A new screen is its module, and its line here."""
