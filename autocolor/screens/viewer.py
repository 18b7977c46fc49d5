"""The interactive viewer: a picture on the display, and the keys and the mouse that change it.

The viewer gets keys, places of the mouse and paths from the window as plain values, and draws by display
instructions, so that tests can run it without a window. While a key is held down or the mouse drags, the
picture may be coarse; `on_tick` refines it when the movement rests.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from autocolor.errors import AutocolorError
from autocolor.files.file_stem import file_stem
from autocolor.files.scene_sources import read_scene
from autocolor.journal.history import History
from autocolor.scene.scene import Scene
from autocolor.screens.bindings import BINDINGS, WINDOW_KEYS
from autocolor.screens.entries_screen import draw_entries
from autocolor.screens.help_screen import draw_help
from autocolor.screens.message_line import TOP, MessageLine
from autocolor.screens.picture_edits import PictureEdits
from autocolor.screens.pointing import LEFT, MIDDLE, Drag, wheel_ratio
from autocolor.screens.watching import ENDING, MESSAGE, Watching
from autocolor.studio import Studio
from ramtek_emu import HostPort, RamtekError, instructions

REST_SECONDS: Final = 0.1
"""Assumed: the time without a change after which a movement rests that has not ended by a release: while a
key is held down, and after a step of the wheel."""

WHEEL: Final = "wheel"
"""The gesture of the wheel, which has steps but no beginning and no end."""


class Viewer(PictureEdits):
    """The viewer of one scene on a display: its studio, the page that is shown, and the file to save to."""

    def __init__(self, scene: Scene | History, display: HostPort, folder: Path | None = None) -> None:
        self.display = display
        self.folder = Path.cwd() if folder is None else folder
        self._line = MessageLine(display, self._restore_line)
        self._warned = False
        self._drag: Drag | None = None
        self._drags = 0
        self._is_full_screen = False
        self._edited_at = 0.0
        self._open(scene)

    def _open(self, scene: Scene | History) -> None:
        self.begin(Studio(scene, self.display))
        self._watching = Watching(self.display)
        self.saved: Path | None = None
        self.page = "picture"
        self.message = "F1 help"
        self._drag = None
        self._edited_by: object = None
        """The key or the movement of the mouse by which the last edit was made, if any."""

    @property
    def message(self) -> str:
        """The last message."""
        return self._line.text

    @message.setter
    def message(self, message: str) -> None:
        self._line.text = message

    @property
    def caption(self) -> str:
        """The title of the window: the scene, the selected surface, and the last message."""
        changed = "*" if self.studio.is_changed else ""
        name = f"{self.studio.scene.name}{changed}"
        surface = f"[{self.surface_name}]" if self.surface_name else ""
        message = MESSAGE if self._watching.is_on else self.message
        return " - ".join(part for part in ("autocolor", name, surface, message) if part)

    def on_key(
        self, name: str, control: bool = False, shift: bool = False, typed: str = "", repeated: bool = False
    ) -> bool:
        """Handle a key press; returns False if the key does nothing here.

        `typed` is the character that the key produces; `repeated` is whether the key is being held down.
        """
        # The key that began it may still be down.
        if not repeated and self._watching.end() and name in ENDING and not control:
            return True
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
        gesture, continues = (binding, number), repeated and binding.held
        return self._do(gesture, lambda: binding.run(self, number), continues, binding.held) is not False

    def on_pointer(self, element: int, line: int, action: str, button: int = 0, steps: int = 1) -> None:
        """Handle what the mouse does over an element and a line: a drag, or a step of the wheel."""
        if action == "press":
            self._watching.end()
        if self.page != "picture":
            self._drag = None
        elif action == "press" and button in (LEFT, MIDDLE):
            self._drags += 1
            self._drag = Drag(self._drags, element, line, button)
        elif action == "release" and self._drag is not None and button == self._drag.button:
            self._drag = None
        elif action == "move" and self._drag is not None:
            drag, self._drag = self._drag, self._drag._replace(element=element, line=line)
            self._do(
                ("drag", drag.number), lambda: self._drag_to(drag, element, line), continues=True, moving=True
            )
        elif action.startswith("wheel"):
            ratio = wheel_ratio(action, steps)
            self._do(WHEEL, lambda: self.move(ratio), continues=True, moving=True)

    def _drag_to(self, drag: Drag, element: int, line: int) -> None:
        if drag.button == MIDDLE:
            self.pan(element - drag.element, line - drag.line)
        else:
            self.turn(*drag.turn_to(element, line))

    def on_tick(self, is_at_rest: bool = True, is_full_screen: bool = False) -> None:
        """Refine a coarse picture when the movement rests, and show the message where there is no title.

        A picture that is watched comes in by some lines.
        """
        self._watching.advance()
        has_ended = is_at_rest and self._edited_by != WHEEL
        rests = has_ended or time.monotonic() - self._edited_at > REST_SECONDS
        if rests and self.studio.is_coarse:
            self._refine()
        self._is_full_screen = is_full_screen
        self._update_line()

    def tell(self, message: str) -> None:
        """Show a message of the window; an empty one takes the last one away at once."""
        self.message = message
        self._update_line()

    def _refine(self) -> None:
        try:
            self.studio.refine()
        except (AutocolorError, RamtekError) as error:
            # The picture was refused only at its full size: take the movement back, as any refused edit.
            self.studio.undo()
            self.message = str(error).replace("\n", "; ")

    def _update_line(self) -> None:
        if self._watching.is_on:
            # The lines come in over the message, which is drawn anew when all are there.
            self._line.update(False, self._watching)
            return
        below = self.studio.words if self.page == "picture" else self.page
        self._line.update(self._is_full_screen, below)

    def _restore_line(self) -> None:
        """Draw again what the message covered."""
        if self.page == "picture":
            self.display.send(instructions.write_image(self.studio.words[TOP:], top=TOP))
        else:
            self._draw_page()

    def _do(self, gesture: object, run: Callable[[], object], continues: bool, moving: bool) -> object:
        """Do what a key or the mouse asks for, and turn an error into a message; returns what `run` does.

        If it continues the gesture by which the last edit was made, both are one step to undo.
        """
        self._watching.end()
        warned, self.message = self._warned, ""
        before = self.studio.scene
        self.same_step = continues and self._edited_by == gesture
        self.moving = moving
        taken: object = True
        try:
            taken = run()
        except (AutocolorError, RamtekError) as error:
            self.message = str(error).replace("\n", "; ")
        if self.studio.scene is not before:
            self._edited_by, self._edited_at = gesture, time.monotonic()
        elif not continues:
            self._edited_by = None
        # A warning applies to the next key only.
        self._warned = self._warned and not warned
        return taken

    def on_drop(self, path: Path) -> None:
        """Open a file that was dropped on the window."""
        if self._unsaved("drop it again to discard the changes"):
            return
        try:
            self._open(read_scene(path))
        except (AutocolorError, RamtekError) as error:
            self.message = str(error).replace("\n", "; ")

    def on_close(self) -> bool:
        """Whether the window may close: nothing is unsaved, or this is the second attempt in a row."""
        return not self._unsaved("close again to discard the changes")

    def _unsaved(self, otherwise: str) -> bool:
        """Whether to stop because of unsaved changes. They are announced once; the next attempt succeeds."""
        if not self.studio.is_changed or self._warned:
            return False
        self._warned = True
        self.message = f"not saved: Ctrl+S saves, {otherwise}"
        return True

    def back(self) -> bool:
        """Return to the picture from another page; returns False if it is already shown."""
        if self.page == "picture":
            return False
        self.page = "picture"
        self.studio.send_everything()
        return True

    def show_help(self) -> None:
        """Show the help page, or return to the picture if it is already shown."""
        self._turn_to("help")

    def show_entries(self) -> None:
        """Show the lookup table, or return to the picture if it is already shown."""
        self._turn_to("entries")

    def _turn_to(self, page: str) -> None:
        if self.page == page:
            self.back()
            return
        # A coarse picture is refined first: its page would come and go with other ranges.
        self._refine()
        self.page = page
        self._draw_page()

    def _draw_page(self) -> None:
        if self.page == "help":
            rows = [(str(binding), binding.does) for binding in BINDINGS] + list(WINDOW_KEYS)
            draw_help(self.display, "AUTOCOLOR", rows)
        else:
            self.display.send(instructions.reset())
            draw_entries(self.display, self.studio.level_ranges)

    def watch(self) -> None:
        """Blank the picture and let it come in line by line as it is computed; any key shows it at once."""
        self.back()
        self._watching.begin(self.studio)

    def escape(self) -> bool:
        """Take a drag back, or return to the picture; if neither, and nothing is unsaved, returns False."""
        if self._drag is not None:
            dragged, self._drag = ("drag", self._drag.number), None
            if self._edited_by == dragged:
                self.studio.undo()
                self.message = "taken back"
            return True
        if self.back():
            return True
        if self.studio.is_changed:
            self.message = "not saved: Ctrl+S saves, Ctrl+Q twice discards the changes"
            return True
        return False

    def undo(self) -> None:
        """Undo the last step."""
        self.back()
        self.message = "undone" if self.studio.undo() else "nothing to undo"

    def redo(self) -> None:
        """Redo the last undone step."""
        self.back()
        self.message = "redone" if self.studio.redo() else "nothing to redo"

    def save(self) -> None:
        """Save the picture with its scene: to a new file the first time, then to the same file."""
        if self.saved is None:
            stem, number = file_stem(self.studio.scene.name), 1
            path = self.folder / f"{stem}.npz"
            while os.path.lexists(path):
                number += 1
                path = self.folder / f"{stem}-{number}.npz"
            self.studio.save(path)
            self.saved = path
        else:
            self.studio.save(self.saved, overwrite=True)
        self.message = f"saved {self.saved.resolve()}"
