"""The picture on the display, and the keys that change it.

The viewer knows the window's events as plain values only, and draws by instructions; tests drive it without
a window.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from autocolor.checks import Vector
from autocolor.created import OBJECT_COLORS, framed
from autocolor.errors import AutocolorError
from autocolor.files import read_scene
from autocolor.scene import Scene
from autocolor.screens.entries_screen import draw_entries
from autocolor.screens.help_screen import draw_help
from autocolor.screens.keys import Binding, Chord
from autocolor.studio import Studio
from autocolor.view import View
from ramtek_emu import HostPort, RamtekError

TURN = 5.0
"""Degrees that one press of an arrow goes around the object."""

CLOSER = 0.9
BLEND = 0.05


class Viewer:
    """A session on a display: a scene, its studio, which page is shown, and where Ctrl+S saves."""

    def __init__(self, scene: Scene, display: HostPort, folder: Path | None = None) -> None:
        self.display = display
        self.folder = Path.cwd() if folder is None else folder
        self.page = "picture"
        self.message = ""
        self._warned = False
        self._last: tuple[Binding[Viewer], int] | None = None
        self._same_step = False
        self._open(scene)

    def _open(self, scene: Scene) -> None:
        self.studio = Studio(scene, self.display)
        self.saved: Path | None = None
        self.surface = 0
        self.page = "picture"
        self.message = "F1 help"

    @property
    def caption(self) -> str:
        """What the window's title says: the scene, the chosen surface, and the last message."""
        changed = "*" if self.studio.is_changed else ""
        name = f"{self.studio.scene.name}{changed}"
        return " - ".join(
            part for part in ("autocolor", name, f"[{self.surface_name}]", self.message) if part
        )

    @property
    def surface_name(self) -> str:
        """The name of the surface that the color keys change."""
        return self.studio.scene.surfaces[self.surface].name

    def on_key(self, name: str, control: bool = False, shift: bool = False, typed: str = "") -> bool:
        """Do what a key does; False where it does nothing here."""
        for binding in BINDINGS:
            for number, chord in enumerate(binding.chords):
                by_sign = len(chord.name) == 1 and not chord.name.isalnum() and typed == chord.name
                by_name = (name, shift) == (chord.name, chord.shift) or (
                    name == chord.name and name.isdigit()
                )
                if control == chord.control and (by_sign or by_name):
                    return self._run(binding, number)
        return False

    def _run(self, binding: Binding[Viewer], number: int) -> bool:
        warned, self.message = self._warned, ""
        self._same_step = binding.held and self._last == (binding, number)
        self._last = (binding, number)
        try:
            taken = binding.run(self, number)
        except (AutocolorError, RamtekError) as error:
            self.message = str(error).replace("\n", "; ")
            taken = True
        # A warning holds for the next key only.
        self._warned = self._warned and not warned
        return taken is not False

    def on_drop(self, path: Path) -> None:
        """Open a scene or a mesh that was dropped on the window."""
        if self._unsaved("drop it again to open it all the same"):
            return
        try:
            self._open(read_scene(path))
        except AutocolorError as error:
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
        self.back()
        self._edit(self.studio.scene.replace(view=view))

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
            stem, number = Path(self.studio.scene.name).name, 1
            path = self.folder / f"{stem}.npz"
            while path.exists():
                number += 1
                path = self.folder / f"{stem}-{number}.npz"
            self.studio.save(path)
            self.saved = path
        else:
            self.studio.save(self.saved, overwrite=True)
        self.message = f"saved {self.saved.resolve()}"

    def turn(self, right: float, up: float) -> None:
        """Go around the object, keeping the distance; the eye stays away from straight above."""
        scene = self.studio.scene
        target = _target(scene)
        away = np.array(scene.view.eye) - target
        distance = float(np.linalg.norm(away)) or 1.0
        azimuth = math.atan2(away[1], away[0]) + math.radians(right)
        elevation = math.asin(max(-1.0, min(1.0, float(away[2]) / distance))) + math.radians(up)
        elevation = max(math.radians(-85), min(math.radians(85), elevation))
        eye = target + distance * np.array(
            [
                math.cos(elevation) * math.cos(azimuth),
                math.cos(elevation) * math.sin(azimuth),
                math.sin(elevation),
            ]
        )
        self._look(scene.view.replace(eye=_vector(eye), target=_vector(target)))

    def move(self, ratio: float) -> None:
        """Move closer or farther."""
        scene = self.studio.scene
        target = _target(scene)
        eye = target + (np.array(scene.view.eye) - target) * ratio
        self._look(scene.view.replace(eye=_vector(eye)))

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
            self.message = f"there are {len(lights)} lights"
            return
        light = lights[number]
        self.back()
        self._edit(self.studio.scene.with_light(light.name, on=not light.on))
        self.message = f"light {light.name} {'off' if light.on else 'on'}"

    def choose_surface(self, step: int) -> None:
        """Choose the next surface for the color keys."""
        self.surface = (self.surface + step) % len(self.studio.scene.surfaces)
        self.message = ""

    def blend(self, step: float) -> None:
        """Move the blend of the chosen surface."""
        paint = self.studio.scene.surfaces[self.surface].paint
        blend = min(1.0, max(0.0, round(paint.blend + step, 6)))
        self._edit(self.studio.scene.with_surface(self.surface_name, blend=blend))
        self.message = f"blend {blend:.2f}"

    def repaint(self, step: int) -> None:
        """Give the chosen surface the next object color."""
        present = "#{:02x}{:02x}{:02x}".format(*self.studio.scene.surfaces[self.surface].paint.object_color)
        place = OBJECT_COLORS.index(present) + step if present in OBJECT_COLORS else 0
        color = OBJECT_COLORS[place % len(OBJECT_COLORS)]
        self._edit(self.studio.scene.with_surface(self.surface_name, object_color=color))


def _target(scene: Scene) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """What the eye goes around: the view's target, else the point before it that is as far as the object."""
    view = scene.view
    if view.target is not None:
        return np.array(view.target)
    low, high = scene.mesh.bounds
    eye = np.array(view.eye)
    forward = view.axes[2]
    depth = float(((low + high) / 2 - eye) @ forward)
    least = float(np.linalg.norm(high - low)) / 2 or 1.0
    return np.asarray(eye + forward * max(depth, least))


def _vector(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Vector:
    return (float(values[0]), float(values[1]), float(values[2]))


BINDINGS: tuple[Binding[Viewer], ...] = (
    Binding((Chord("f1"),), "this help, and back", lambda viewer, _: viewer.show_help()),
    Binding(
        (Chord("f4"),), "the 1024 entries of the table, and back", lambda viewer, _: viewer.show_entries()
    ),
    Binding(
        (Chord("left"), Chord("right")),
        "go around the object",
        lambda viewer, number: viewer.turn((-TURN, TURN)[number], 0),
        held=True,
    ),
    Binding(
        (Chord("up"), Chord("down")),
        "look from higher, from lower",
        lambda viewer, number: viewer.turn(0, (TURN, -TURN)[number]),
        held=True,
    ),
    Binding(
        (Chord("+"), Chord("="), Chord("-")),
        "move closer, farther",
        lambda viewer, number: viewer.move((CLOSER, CLOSER, 1 / CLOSER)[number]),
        label="+, -",
        held=True,
    ),
    Binding(
        (Chord(","), Chord(".")),
        "turn the picture's horizontal axis",
        lambda viewer, number: viewer.tilt((-TURN, TURN)[number]),
        held=True,
    ),
    Binding((Chord("r"),), "rescale: fill the picture with the object", lambda viewer, _: viewer.rescale()),
    Binding(
        tuple(Chord(str(digit)) for digit in range(1, 10)),
        "switch a light on or off",
        lambda viewer, number: viewer.switch_light(number),
        label="1 to 9",
    ),
    Binding(
        (Chord("s"), Chord("s", shift=True)),
        "choose the next surface, the one before",
        lambda viewer, number: viewer.choose_surface((1, -1)[number]),
    ),
    Binding(
        (Chord("["), Chord("]")),
        "blend: the light color from lower, from higher levels",
        lambda viewer, number: viewer.blend((-BLEND, BLEND)[number]),
        held=True,
    ),
    Binding(
        (Chord("c"), Chord("c", shift=True)),
        "the next object color, the one before",
        lambda viewer, number: viewer.repaint((1, -1)[number]),
    ),
    Binding((Chord("z", control=True),), "undo", lambda viewer, _: viewer.undo()),
    Binding(
        (Chord("y", control=True), Chord("z", control=True, shift=True)),
        "do again",
        lambda viewer, _: viewer.redo(),
    ),
    Binding((Chord("s", control=True),), "save the picture with its scene", lambda viewer, _: viewer.save()),
    Binding(
        (Chord("escape"),), "one step back; leave, if nothing is unsaved", lambda viewer, _: viewer.escape()
    ),
)
"""What every key of the viewer does."""

WINDOW_KEYS = (
    ("F11, Alt+Enter", "full screen, and back"),
    ("F12", "save a numbered screenshot"),
    ("Ctrl+Q", "leave"),
)
"""The keys that the window itself answers to."""
