"""The viewer: the interactive system on a display, driven by keys, the mouse and the joystick unit.

It gets what was done as plain values, and draws by display instructions, so that it runs with a window or
without. While something moves, the picture may be coarse; `on_tick` refines it when the movement rests.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final

from autocolor.arrays import Words
from autocolor.errors import AutocolorError
from autocolor.journal.history import History
from autocolor.scene.columns import Tier
from autocolor.scene.scene import Scene
from autocolor.screens.blending_screen import BlendingScreen
from autocolor.screens.board import Board
from autocolor.screens.entries_screen import EntriesScreen
from autocolor.screens.file_screen import FileScreen
from autocolor.screens.help_screen import HelpScreen
from autocolor.screens.input import Gesture, Mouse, Unit
from autocolor.screens.light_and_view.light_and_view_screen import LightAndViewScreen
from autocolor.screens.lights_screen import LightsScreen
from autocolor.screens.mapping_screen import MappingScreen
from autocolor.screens.mixing_screen import MixingScreen
from autocolor.screens.picture.picture_edits import PictureEdits
from autocolor.screens.picture.picture_screen import PictureScreen
from autocolor.screens.picture.watching import ENDING, MESSAGE, Watching
from autocolor.screens.pointing import WHEEL, Doing, Keyboard, Pointing
from autocolor.screens.reflectance_screen import ReflectanceScreen
from autocolor.screens.scalar_screen import ScalarScreen
from autocolor.screens.screen import Screen
from autocolor.screens.session import PICTURE, Session
from autocolor.screens.variants_screen import KeptScreen
from autocolor.studio import Studio
from autocolor.widgets.sheet import Sheet
from ramtek_emu import HostPort, RamtekError

# -------------------- all_screens
# Every screen, in the order of the main menu. A new screen is its module, and its line here.

SCREENS: Final[tuple[type[Screen], ...]] = (
    PictureScreen,
    LightAndViewScreen,
    LightsScreen,
    ReflectanceScreen,
    MixingScreen,
    BlendingScreen,
    MappingScreen,
    ScalarScreen,
    KeptScreen,
    FileScreen,
    EntriesScreen,
    HelpScreen,
)


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
        self.studio = Studio(scene, self.display)
        # From now on the sheet sends what is shown.
        self.studio.sends = False
        self.session = Session(self.studio, self.display, self.folder)
        self.session.has_keyboard = self._has_keyboard
        self.screens = {each.name: each(self.session) for each in SCREENS}
        self.board = Board(self.session, self.screens)
        self.edits = PictureEdits(self.session)
        self._watching = Watching(self.display)
        self._doing = Doing(self.session)
        self._pointing = Pointing(self.board, self._do)
        self._keyboard = Keyboard(self.board, self, self._do)
        self._had_news = True
        self._base: Words | int | None = None
        """What was below everything when it was shown last."""
        self._mouse.forget()
        self._sheet.forget()
        self._unit.show()
        self.session.tell("F1: help; Tab or the right edge: the menu", stands=True)
        self._update()

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

    # What is done.

    def on_key(
        self, name: str, control: bool = False, shift: bool = False, typed: str = "", repeated: bool = False
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
        taken = self._keyboard.press(name, control, shift, typed, repeated)
        self._update()
        return taken

    def on_release(self, name: str) -> None:
        """Handle that a key was let go."""
        if self._keyboard.release(name):
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
        """Handle what the mouse does over an element and a line."""
        # Where there is a mouse, there is a keyboard.
        self._has_keyboard = self.session.has_keyboard = True
        if action == "press" and self._watching.end():
            self._update()
        for gesture in self._mouse.gestures(element, line, action, button, steps, shift, control):
            self.point(gesture)

    def poll(self) -> None:
        """Handle what was done with the joystick unit since the last poll."""
        for gesture in self._unit.poll():
            self.point(gesture)

    def point(self, gesture: Gesture) -> None:
        """Handle a gesture of the mouse or of the joystick unit."""
        self._pointing.take(gesture)
        self._update()

    def on_tick(self, is_at_rest: bool = True) -> None:
        """Refine a coarse picture when the movement rests, and take a message away when its time has passed.

        A picture that is watched comes in by some lines.
        """
        self._watching.advance()
        if is_at_rest and not (self.board.is_dragging or self._watching.is_on):
            self._take_changes()
        has_ended = is_at_rest and self._doing.kind != WHEEL and not self.board.is_dragging
        rests = has_ended or self._doing.has_rested
        if rests and (self.studio.is_coarse or self.session.moving):
            self.session.moving = False
            self._refine()
            self._update()
        elif (rests and self.board.screen.idle()) or self._had_news != self.session.has_news:
            self._update()

    def _take_changes(self) -> None:
        """Show what another program changed in the scene's file."""
        if self.session.disk.was_changed() and self._do(None, self.session.take_changes):
            self._update()

    def tell(self, message: str, stands: bool = False) -> None:
        """Show a message of the window; an empty one takes the last one away at once.

        One that `stands` does so until something is done.
        """
        self.session.tell(message, stands=stands)
        self._update()

    def _update(self) -> None:
        """Show what is to be seen now."""
        if self._watching.is_on:
            # The lines come in over everything, and what stands over the picture is drawn when all are there.
            return
        if self.session.watches:
            self.watch()
            return
        if self.board.turn():
            self._refine()
        self._had_news = self.session.has_news
        self.board.forget()
        page = self.board.page()
        self._sheet.show(page)
        if page.base is not self._base and not self.board.is_dragging:
            # What is pointed at is read back from the display, where it is only now.
            self._sheet.show(self.board.page())
        self._base = page.base
        self._unit.mark(self.board.mark)

    def _refine(self) -> None:
        try:
            self.studio.refine()
        except (AutocolorError, RamtekError) as error:
            # The picture was refused only at its full size: take the movement back, as any refused edit.
            self.studio.undo()
            self.session.warn(error)

    def _do(
        self, source: object, run: Callable[[], object], continues: bool = False, moving: bool = False
    ) -> bool:
        """Do what a key or a gesture asks for; returns False if that does nothing here."""
        self._watching.end()
        taken = self._doing.do(source, run, continues, moving)
        self.board.forget()
        if self._doing.costs > Tier.ENTRIES and not self.board.screen.shows_scene:
            self.session.turn_to(PICTURE)
        return taken

    def on_drop(self, path: Path) -> None:
        """Open a file that was dropped on the window, as one step to undo."""
        self._do(None, lambda: self.session.open(path))
        self._update()

    def on_close(self) -> bool:
        """Whether the window may close: nothing is unsaved, or this is the second attempt in a row."""
        may_close = not self._doing.warns_of_changes("close again to discard the changes")
        self._update()
        return may_close

    # What keys are bound to.

    def toggle(self, screen: str) -> None:
        """Turn to a screen, or back to the picture if it is shown."""
        self.session.turn_to(PICTURE if self.session.screen == screen else screen)

    def toggle_menu(self) -> None:
        """Bring the menu and give it the keys, or take it away."""
        self.board.toggle_menu()

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

        If there is nothing of that, and nothing is unsaved, returns False.
        """
        board, session = self.board, self.session
        if board.is_dragging:
            if self._doing.was_by(self._pointing.source):
                self.studio.undo()
                session.tell("taken back")
            self._mouse.forget()
            board.release()
            return True
        if board.escape():
            return True
        if session.screen != PICTURE:
            session.turn_to(PICTURE)
            return True
        if session.unsaved:
            session.warn(f"{session.unsaved}, Ctrl+Q twice discards the changes")
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
        # What is dragged or typed may be gone with the step.
        self._mouse.forget()
        self.board.release()
        if not self.board.screen.shows_scene:
            self.session.turn_to(PICTURE)

    def save(self) -> None:
        """Save the scene and the picture."""
        self.session.save()

    def reopen(self) -> None:
        """Read the scene's file again, as one step to undo."""
        self._show_scene()
        self.session.reopen()

    def clear(self) -> None:
        """Leave the picture alone on the display, without menu, message and cursors."""
        self._watching.end()
        self.session.turn_to(PICTURE)
        self.session.comparing.end()
        self.board.turn()
        self.board.close()
        self.session.tell("")
        self._update()
        self._unit.hide()
