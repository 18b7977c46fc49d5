"""The viewer: the interactive system on a display, driven by keys, the mouse and the joystick unit.

It gets what was done as plain values, and draws by display instructions, so that it runs with a window or
without. While something moves, the picture may be coarse; `on_tick` refines it when the movement rests.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from autocolor.errors import AutocolorError
from autocolor.files.scene_sources import read_scene
from autocolor.journal.history import History
from autocolor.scene.columns.column import Tier
from autocolor.scene.scene import Scene, cost_of_edit
from autocolor.screens.all_screens import SCREENS
from autocolor.screens.bindings import BINDINGS
from autocolor.screens.board import Board
from autocolor.screens.gestures import Gesture, Mouse
from autocolor.screens.picture_edits import PictureEdits
from autocolor.screens.session import PICTURE, Session
from autocolor.screens.unit import Unit
from autocolor.screens.watching import ENDING, MESSAGE, Watching
from autocolor.studio import Studio
from autocolor.widgets.sheet import Sheet
from ramtek_emu import HostPort, PortError, RamtekError, ReplyError

REST_SECONDS: Final = 0.1
"""Assumed: the time without a change after which a movement rests that has not ended by a release: while a
key is held down, and after a step of the wheel."""

WHEEL: Final = "wheel"
"""What makes edits by the wheel, which has steps but no beginning and no end."""


class Viewer:
    """The interactive system with one scene on a display. `folder` is where new files are saved."""

    def __init__(self, scene: Scene | History, display: HostPort, folder: Path | None = None) -> None:
        self.display = display
        self.folder = Path.cwd() if folder is None else folder
        self._sheet = Sheet(display)
        self._unit = Unit(display)
        self._mouse = Mouse()
        self._drags = 0
        self._edited_at = 0.0
        self._open(scene)

    def _open(self, scene: Scene | History) -> None:
        self.studio = Studio(scene, self.display)
        # From now on the sheet sends what is shown.
        self.studio.sends = False
        self.session = Session(self.studio, self.display, self.folder)
        self.screens = {each.name: each(self.session) for each in SCREENS}
        self.board = Board(self.session, self.screens)
        self.edits = PictureEdits(self.session)
        self._watching = Watching(self.display)
        self._edited_by: object = None
        """The key or the movement of the pointer by which the last edit was made, if any."""
        self._warned = False
        self._had_news = True
        self._mouse.forget()
        self._sheet.forget()
        self._unit.show()
        self.session.tell("F1 help, Tab menu")
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
        self.session.has_keyboard = True
        # The key that began it may still be down.
        if not repeated and self._watching.end() and name in ENDING and not control:
            return True
        taken = (not control and self._typed(name, typed, repeated)) or self._bound(
            name, control, shift, typed, repeated
        )
        self._update()
        return taken

    def _typed(self, name: str, typed: str, repeated: bool) -> bool:
        """Let the text that is being typed, the menu or the screen take a key."""
        board = self.board
        if board.typing.is_on:
            self._do(None, lambda: board.typing.key(name, typed))
            return True
        source = "key", name
        return (
            self._do(source, lambda: board.key(name, typed), repeated, repeated) is not False
            or self._do(source, lambda: board.screen.key(name, typed), repeated, repeated) is not False
        )

    def _bound(self, name: str, control: bool, shift: bool, typed: str, repeated: bool) -> bool:
        """Do what a key is bound to."""
        chords = [
            (binding, number, chord)
            for binding in BINDINGS
            for number, chord in enumerate(binding.chords)
            if chord.control == control
        ]
        # Match signs by the typed character, as keyboards place them differently; match letters by key name.
        by_sign = [row for row in chords if row[2].is_sign and row[2].name == typed]
        by_name = [row for row in chords if row[2].name == name and (row[2].is_sign or row[2].shift == shift)]
        chosen = (by_sign or by_name)[:1]
        if not chosen:
            return False
        binding, number, _ = chosen[0]
        if repeated and not (binding.held or binding.repeats):
            # A switch would flip for as long as its key is down.
            return True
        source, continues = (binding, number), repeated and binding.held
        return self._do(source, lambda: binding.run(self, number), continues, binding.held) is not False

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
        for gesture in self._mouse.gestures(element, line, action, button, steps, shift, control):
            self.point(gesture)

    def poll(self) -> None:
        """Handle what was done with the joystick unit since the last poll."""
        for gesture in self._unit.poll():
            self.point(gesture)

    def point(self, gesture: Gesture) -> None:
        """Handle a gesture of the mouse or of the joystick unit."""
        board, kind = self.board, gesture.kind
        if kind in ("hover", "drop"):
            board.take(gesture)
        else:
            if kind in ("pick", "grab"):
                board.typing.end()
                self._drags += 1
            continues = kind in ("drag", "wheel")
            source = WHEEL if kind == "wheel" else ("drag", self._drags)
            self._do(source, lambda: board.take(gesture), continues, continues)
        self._update()

    def on_tick(self, is_at_rest: bool = True) -> None:
        """Refine a coarse picture when the movement rests, and take a message away when its time has passed.

        A picture that is watched comes in by some lines.
        """
        self._watching.advance()
        has_ended = is_at_rest and self._edited_by != WHEEL and not self.board.is_dragging
        rests = has_ended or time.monotonic() - self._edited_at > REST_SECONDS
        if rests and self.studio.is_coarse:
            self._refine()
            self._update()
        elif self._had_news != self.session.has_news:
            self._update()

    def tell(self, message: str) -> None:
        """Show a message of the window; an empty one takes the last one away at once."""
        self.session.tell(message)
        self._update()

    def _update(self) -> None:
        """Show what is to be seen now."""
        if self._watching.is_on:
            # The lines come in over everything, and what stands over the picture is drawn when all are there.
            return
        if self.board.turn():
            self._refine()
        self._had_news = self.session.has_news
        self._sheet.show(self.board.page())
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
    ) -> object:
        """Do what a key or a gesture asks for, and turn an error into a message; returns what `run` does.

        If it continues what made the last edit, both are one step to undo.
        """
        self._watching.end()
        session = self.session
        warned, news = self._warned, session.news
        session.tell("")
        before = session.scene
        session.same_step = continues and self._edited_by == source
        session.moving = moving
        taken: object = True
        try:
            taken = run()
        except (PortError, ReplyError):
            # The display is lost, or its replies are: nothing can be shown any more.
            raise
        except (AutocolorError, RamtekError) as error:
            session.warn(error)
        if taken is False:
            session.news = news
            return False
        if session is self.session:
            costs = cost_of_edit(before, session.scene) if session.scene is not before else None
            if costs is not None:
                self._edited_by, self._edited_at = source, time.monotonic()
                if costs > Tier.ENTRIES and not self.board.screen.shows_scene:
                    session.turn_to(PICTURE)
            elif not continues:
                self._edited_by = None
        # A warning applies to the next key only.
        self._warned = self._warned and not warned
        return taken

    def on_drop(self, path: Path) -> None:
        """Open a file that was dropped on the window."""
        if self._unsaved("drop it again to discard the changes"):
            self._update()
            return
        try:
            self._open(read_scene(path))
        except (AutocolorError, RamtekError) as error:
            self.session.warn(error)
            self._update()

    def on_close(self) -> bool:
        """Whether the window may close: nothing is unsaved, or this is the second attempt in a row."""
        may_close = not self._unsaved("close again to discard the changes")
        self._update()
        return may_close

    def _unsaved(self, otherwise: str) -> bool:
        """Whether to stop because of unsaved changes. They are announced once; the next attempt succeeds."""
        if not self.studio.is_changed or self._warned:
            return False
        self._warned = True
        self.session.warn(f"not saved: Ctrl+S saves, {otherwise}")
        return True

    # What keys are bound to.

    def toggle(self, screen: str) -> None:
        """Turn to a screen, or back to the picture if it is shown."""
        self.session.turn_to(PICTURE if self.session.screen == screen else screen)

    def toggle_menu(self) -> None:
        """Bring the menu and give it the keys, or take it away."""
        self.board.toggle_menu()

    def watch(self) -> None:
        """Blank the picture and let it come in line by line as it is computed; any key shows it at once."""
        self.session.turn_to(PICTURE)
        self.board.turn()
        self.board.close()
        self._update()
        self._watching.begin(self.studio)

    def escape(self) -> bool:
        """Take a drag back, close what is open, or return to the picture.

        If there is nothing of that, and nothing is unsaved, returns False.
        """
        board, session = self.board, self.session
        if board.is_dragging:
            if self._edited_by == ("drag", self._drags):
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
        if self.studio.is_changed:
            session.warn("not saved: Ctrl+S saves, Ctrl+Q twice discards the changes")
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
        if not self.board.screen.shows_scene:
            self.session.turn_to(PICTURE)

    def save(self) -> None:
        """Save the scene and its picture."""
        self.session.save()

    def clear(self) -> None:
        """Leave the picture alone on the display, without menu, message and cursors."""
        self.session.turn_to(PICTURE)
        self.board.turn()
        self.board.close()
        self.session.tell("")
        self._update()
        self._unit.hide()
