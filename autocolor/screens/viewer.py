"""The picture on the display, and the keys that change it.

The viewer knows the window's events as plain values only, and draws by instructions; tests drive it without
a window.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Unpack

from autocolor.errors import AutocolorError
from autocolor.files.file_stem import file_stem
from autocolor.files.scene_sources import read_scene
from autocolor.scene.changes import PaintChanges
from autocolor.scene.defaults import OBJECT_COLORS, framed
from autocolor.scene.scene import Scene
from autocolor.scene.view import View
from autocolor.screens.bindings import BINDINGS, WINDOW_KEYS, Actions
from autocolor.screens.entries_screen import draw_entries
from autocolor.screens.help_screen import draw_help
from autocolor.screens.keys import Binding
from autocolor.screens.orbit import moved, turned
from autocolor.studio import Studio
from ramtek_emu import HostPort, RamtekError


class Viewer:
    """A session on a display: a scene, its studio, which page is shown, and where Ctrl+S saves."""

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
        self.page = "picture"
        self.message = "F1 help"
        self._edited_by = None

    @property
    def caption(self) -> str:
        """What the window's title says: the scene, the chosen surface, and the last message."""
        changed = "*" if self.studio.is_changed else ""
        name = f"{self.studio.scene.name}{changed}"
        surface = f"[{self.surface_name}]" if self.surface_name else ""
        return " - ".join(part for part in ("autocolor", name, surface, self.message) if part)

    @property
    def surface_name(self) -> str:
        """The name of the surface that the color keys change; nothing where the scene has none."""
        names = list(self.studio.level_ranges)
        return names[self.surface % len(names)] if names else ""

    def on_key(
        self, name: str, control: bool = False, shift: bool = False, typed: str = "", repeated: bool = False
    ) -> bool:
        """Do what a key does; False where it does nothing here. `repeated`: it was down already."""
        chords = [
            (binding, number, chord)
            for binding in BINDINGS
            for number, chord in enumerate(binding.chords)
            if chord.control == control
        ]
        # A sign is where the keyboard has it, whatever the key is called; a letter is its key.
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
        # A warning holds for the next key only.
        self._warned = self._warned and not warned
        return taken is not False

    def on_drop(self, path: Path) -> None:
        """Open a scene or a mesh that was dropped on the window."""
        if self._unsaved("drop it again to open it all the same"):
            return
        try:
            self._open(read_scene(path))
        except (AutocolorError, RamtekError) as error:
            self.message = str(error).replace("\n", "; ")

    def on_close(self) -> bool:
        """Whether the window may close; the second time in a row it may in any case."""
        return not self._unsaved("close again to leave without it")

    def _unsaved(self, otherwise: str) -> bool:
        """Whether to stop for work that is not saved, which is said once."""
        if not self.studio.is_changed or self._warned:
            return False
        self._warned = True
        self.message = f"not saved: Ctrl+S saves, {otherwise}"
        return True

    def _edit(self, scene: Scene) -> None:
        """Make a scene the current one; a key held down is one step to undo."""
        self.studio.edit(scene, same_step=self._same_step)

    def _look(self, view: View) -> None:
        """Look from elsewhere; the same view again is no step."""
        self.back()
        if view != self.studio.scene.view:
            self._edit(self.studio.scene.replace(view=view))

    def _paint(self, **changes: Unpack[PaintChanges]) -> None:
        """Change the paint of the chosen surface; the same paint again is no step."""
        scene = self.studio.scene
        changed = scene.with_surface(self.surface_name, **changes)
        if changed.surfaces != scene.surfaces:
            self._edit(changed)

    def back(self) -> bool:
        """Go back to the picture from another page; False where it is shown already."""
        if self.page == "picture":
            return False
        self.page = "picture"
        self.studio.send_everything()
        return True

    def show_help(self) -> None:
        """Show the help page, or go back from it."""
        if self.page == "help":
            self.back()
            return
        self.page = "help"
        rows = [(str(binding), binding.does) for binding in BINDINGS] + list(WINDOW_KEYS)
        draw_help(self.display, "AUTOCOLOR", rows)

    def show_entries(self) -> None:
        """Show the 1024 entries, or go back from them."""
        if self.page == "entries":
            self.back()
            return
        self.back()
        self.page = "entries"
        draw_entries(self.display, self.studio.level_ranges)

    def escape(self) -> bool:
        """Go back one step: to the picture, or out of the window when nothing would be lost."""
        if self.back():
            return True
        if self.studio.is_changed:
            self.message = "not saved: Ctrl+S saves, Ctrl+Q twice leaves without it"
            return True
        return False

    def undo(self) -> None:
        """Undo one step."""
        self.back()
        self.message = "undone" if self.studio.undo() else "nothing to undo"

    def redo(self) -> None:
        """Do a step again."""
        self.back()
        self.message = "done again" if self.studio.redo() else "nothing to do again"

    def save(self) -> None:
        """Save the picture with its scene: the first time under a new name, then over it."""
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
        """Go around the object by degrees."""
        self._look(turned(self.studio.scene, right, up))

    def move(self, ratio: float) -> None:
        """Move closer or farther."""
        self._look(moved(self.studio.scene, ratio))

    def rescale(self) -> None:
        """Move so that the object fills the picture (Paper: Figure 5, RESCALE)."""
        scene = self.studio.scene
        self._look(framed(scene.view, scene.mesh))

    def tilt(self, degrees: float) -> None:
        """Turn the horizontal axis of the picture plane (Paper: Figure 5, ANGLE)."""
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

    def choose_surface(self, step: int) -> None:
        """Choose the next surface for the color keys, of those that parts have."""
        self.surface = (self.surface + step) % max(1, len(self.studio.level_ranges))

    def blend(self, step: float) -> None:
        """Move the blend of the chosen surface."""
        if self.surface_name:
            blend = self.studio.scene.surface(self.surface_name).paint.blend
            blend = min(1.0, max(0.0, round(blend + step, 6)))
            self._paint(blend=blend)
            self.message = f"blend {blend:.2f}"

    def repaint(self, step: int) -> None:
        """Give the chosen surface the next object color."""
        if self.surface_name:
            red, green, blue = self.studio.scene.surface(self.surface_name).paint.object_color
            present = f"#{red:02x}{green:02x}{blue:02x}"
            place = OBJECT_COLORS.index(present) + step if present in OBJECT_COLORS else 0
            color = OBJECT_COLORS[place % len(OBJECT_COLORS)]
            self._paint(object_color=color)
            self.message = f"object color {color}"
