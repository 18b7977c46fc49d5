"""The interactive viewer: a picture on the display, and the keys that change it.

The viewer gets key names and paths from the window as plain values, and draws by display instructions, so
that tests can run it without a window.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple, Unpack

from autocolor.errors import AutocolorError
from autocolor.files.file_stem import file_stem
from autocolor.files.scene_sources import read_scene
from autocolor.scene.changes import PaintChanges
from autocolor.scene.defaults import OBJECT_COLORS, framed
from autocolor.scene.scene import Exposure, Scene
from autocolor.scene.view import View
from autocolor.screens.bindings import BINDINGS, WINDOW_KEYS, Actions
from autocolor.screens.entries_screen import draw_entries
from autocolor.screens.help_screen import draw_help
from autocolor.screens.keys import Binding
from autocolor.screens.orbit import moved, turned
from autocolor.studio import Studio
from ramtek_emu import HostPort, RamtekError


class Hold(NamedTuple):
    """The exposure before it was held, and the one that holds it."""

    before: Exposure
    held: Exposure


class Viewer:
    """The viewer of one scene on a display: its studio, the page that is shown, and the file to save to."""

    def __init__(self, scene: Scene, display: HostPort, folder: Path | None = None) -> None:
        self.display = display
        self.folder = Path.cwd() if folder is None else folder
        self.page = "picture"
        self.message = ""
        self._warned = False
        self._edited_by: tuple[Binding[Actions], int] | None = None
        self._same_step = False
        self._open(scene)

    def _open(self, scene: Scene) -> None:
        self.studio = Studio(scene, self.display)
        self.saved: Path | None = None
        self.surface = 0
        self._hold: Hold | None = None
        self.page = "picture"
        self.message = "F1 help"
        self._edited_by = None

    @property
    def caption(self) -> str:
        """The title of the window: the scene, the selected surface, and the last message."""
        changed = "*" if self.studio.is_changed else ""
        name = f"{self.studio.scene.name}{changed}"
        surface = f"[{self.surface_name}]" if self.surface_name else ""
        return " - ".join(part for part in ("autocolor", name, surface, self.message) if part)

    @property
    def surface_name(self) -> str:
        """The name of the surface that the color keys change; empty if the scene has none in use."""
        names = list(self.studio.level_ranges)
        return names[self.surface % len(names)] if names else ""

    def on_key(
        self, name: str, control: bool = False, shift: bool = False, typed: str = "", repeated: bool = False
    ) -> bool:
        """Handle a key press; returns False if the key does nothing here.

        `typed` is the character that the key produces; `repeated` is whether the key is being held down.
        """
        chords = [
            (binding, number, chord)
            for binding in BINDINGS
            for number, chord in enumerate(binding.chords)
            if chord.control == control
        ]
        # Match signs by the typed character, as keyboards place them differently; match letters by key name.
        by_sign = [row for row in chords if row[2].is_sign and row[2].name == typed]
        by_name = [row for row in chords if row[2].name == name and (row[2].is_sign or row[2].shift == shift)]
        for binding, number, _ in (by_sign or by_name)[:1]:
            return self._run(binding, number, repeated)
        return False

    def _run(self, binding: Binding[Actions], number: int, repeated: bool) -> bool:
        warned, self.message = self._warned, ""
        before, last = self.studio.scene, self._edited_by
        self._same_step = repeated and binding.held and last == (binding, number)
        try:
            taken = binding.run(self, number)
        except (AutocolorError, RamtekError) as error:
            self.message = str(error).replace("\n", "; ")
            taken = True
        if self.studio.scene is not before or not repeated:
            self._edited_by = (binding, number) if self.studio.scene is not before else None
        # A warning applies to the next key only.
        self._warned = self._warned and not warned
        return taken is not False

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

    def _edit(self, scene: Scene) -> None:
        """Make a scene the current one; the edits of a key that is held down are one step to undo."""
        self.studio.edit(scene, same_step=self._same_step)

    def _look(self, view: View) -> None:
        """Change the view and return to the picture; an equal view is not an edit."""
        self.back()
        if view != self.studio.scene.view:
            self._edit(self.studio.scene.replace(view=view))

    def _paint(self, **changes: Unpack[PaintChanges]) -> None:
        """Change the paint of the selected surface; an equal paint is not an edit."""
        scene = self.studio.scene
        changed = scene.with_surface(self.surface_name, **changes)
        if changed.surfaces != scene.surfaces:
            self._edit(changed)

    def back(self) -> bool:
        """Return to the picture from another page; returns False if it is already shown."""
        if self.page == "picture":
            return False
        self.page = "picture"
        self.studio.send_everything()
        return True

    def show_help(self) -> None:
        """Show the help page, or return to the picture if it is already shown."""
        if self.page == "help":
            self.back()
            return
        self.page = "help"
        rows = [(str(binding), binding.does) for binding in BINDINGS] + list(WINDOW_KEYS)
        draw_help(self.display, "AUTOCOLOR", rows)

    def show_entries(self) -> None:
        """Show the lookup table, or return to the picture if it is already shown."""
        if self.page == "entries":
            self.back()
            return
        self.back()
        self.page = "entries"
        draw_entries(self.display, self.studio.level_ranges)

    def escape(self) -> bool:
        """Return to the picture. If it is already shown and nothing is unsaved, returns False, to leave."""
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

    def turn(self, right: float, up: float) -> None:
        """Move the eye around the object, in degrees."""
        self._look(turned(self.studio.scene, right, up))

    def move(self, ratio: float) -> None:
        """Multiply the distance of the eye by a ratio."""
        self._look(moved(self.studio.scene, ratio))

    def rescale(self) -> None:
        """Move the eye so that the object fills the picture (Paper: Figure 5, RESCALE)."""
        scene = self.studio.scene
        self._look(framed(scene.view, scene.object_coordinates))

    def tilt(self, degrees: float) -> None:
        """Rotate the horizontal axis of the picture plane (Paper: Figure 5, ANGLE)."""
        view = self.studio.scene.view
        self._look(view.replace(angle=view.angle + degrees))

    def switch_light(self, number: int) -> None:
        """Switch a light, counted from 0, on or off."""
        lights = self.studio.scene.lights
        if number >= len(lights):
            self.message = f"the scene has no light {number + 1}"
            return
        light = lights[number]
        self.back()
        self._edit(self.studio.scene.with_light(light.name, on=not light.on))
        self.message = f"light {light.name} {'off' if light.on else 'on'}"

    def switch_exposure(self) -> None:
        """Hold the intensity ranges of the picture; if they were held by this, hold what was held before."""
        self.back()
        present = self.studio.scene.exposure
        if self._hold is not None and present == self._hold.held:
            self._edit(self.studio.scene.replace(exposure=self._hold.before))
            self.message = "exposure released"
            return
        self.studio.hold_exposure()
        held = self.studio.scene.exposure
        if held != present:
            self._hold = Hold(present, held)
        self.message = "exposure held" if held != present else "there is nothing more to hold"

    def choose_surface(self, step: int) -> None:
        """Select another surface in use for the color keys, `step` positions further."""
        self.surface = (self.surface + step) % max(1, len(self.studio.level_ranges))

    def blend(self, step: float) -> None:
        """Change the blend of the selected surface."""
        if self.surface_name:
            blend = self.studio.scene.surface(self.surface_name).paint.blend
            blend = min(1.0, max(0.0, round(blend + step, 6)))
            self._paint(blend=blend)
            self.message = f"blend {blend:.2f}"

    def repaint(self, step: int) -> None:
        """Give the selected surface another of OBJECT_COLORS, `step` positions further."""
        if self.surface_name:
            red, green, blue = self.studio.scene.surface(self.surface_name).paint.object_color
            present = f"#{red:02x}{green:02x}{blue:02x}"
            place = OBJECT_COLORS.index(present) + step if present in OBJECT_COLORS else 0
            color = OBJECT_COLORS[place % len(OBJECT_COLORS)]
            self._paint(object_color=color)
            self.message = f"object color {color}"
