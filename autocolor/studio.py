"""The studio: a session with one scene and one display; where renderer and display meet.

It does what the VAX did: it sends RAMTEK instructions through a host port and never touches the display's
memories. Each edit makes a new scene; comparing it with the one before tells what is computed and sent.

| changed | sent to the display |
|---|---|
| mesh, view, lights, ambient, D, S, N | all words |
| mapping, scaling, division of the levels | all words, the entries that differ |
| object color, light color, blend, light percentage | the entries of one range, no word |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from autocolor.checks import nearest
from autocolor.color_blending import entries_of
from autocolor.errors import UsageError
from autocolor.intensity_mapping import words_of
from autocolor.level_ranges import BACKGROUND, SCREEN_COLORS, SCREENS, WORDS, LevelRange, level_ranges
from autocolor.picture import Picture
from autocolor.rendering import rendering
from autocolor.scene import Scene
from autocolor.tables import PAINT_CHECKS, Surface
from ramtek_emu import GMR_9300, Configuration, EntryFormat, HostPort, instructions

if TYPE_CHECKING:
    from os import PathLike


@dataclass(frozen=True, eq=False)
class Shown:
    """What a display holds of a scene and its picture: the words, the entries, and which are whose."""

    scene: Scene
    picture: Picture
    ranges: Mapping[str, LevelRange]
    words: npt.NDArray[np.uint16]

    @cached_property
    def entries(self) -> npt.NDArray[np.uint8]:
        """The whole lookup table, (1024, 3) uint8, read-only."""
        table = np.zeros((WORDS, 3), np.uint8)
        table[BACKGROUND] = self.scene.background
        table[SCREENS.first :] = SCREEN_COLORS
        for name, (first, levels) in self.ranges.items():
            table[first : first + levels] = self.entries_of(self.scene.surface(name))
        table.flags.writeable = False
        return table

    def entries_of(self, surface: Surface) -> npt.NDArray[np.uint8]:
        """The entries of the range of a surface, (levels, 3) uint8, read-only."""
        floor = _floor(self.scene, self.picture, surface.name) if self.scene.contrast == "floor" else 0.0
        return entries_of(surface.paint, self.ranges[surface.name].levels, floor)


def shown(scene: Scene, picture: Picture, before: Shown | None = None) -> Shown:
    """What a display holds of a scene with its picture; `before` lends the words if they did not change."""
    in_use = {scene.parts[number].surface for number in scene.mesh.parts_in_use}
    ranges = level_ranges(scene.surfaces, in_use)
    if (
        before is not None
        and before.picture is picture
        and before.ranges == ranges
        and before.scene.scaling == scene.scaling
        and before.scene.mapping == scene.mapping
    ):
        words = before.words
    else:
        words = words_of(picture, ranges, scene.scaling, scene.mapping)
    return Shown(scene, picture, ranges, words)


def send_picture(scene: Scene, picture: Picture, display: HostPort) -> None:
    """Reset a display and show a picture in the colors of a scene on it; nothing is rendered."""
    display.send(instructions.reset())
    _send(None, shown(scene, picture), display)


def configuration_of(display: HostPort) -> Configuration:
    """The display's sizes and formats; those of the paper's display where the port does not tell.

    Raises UsageError for a display whose words or entries are fewer than the paper's: the ranges of the
    surfaces would run over its end.
    """
    configuration: Configuration = getattr(display, "configuration", GMR_9300)
    if configuration.largest_word < WORDS - 1 or configuration.entries < WORDS:
        raise UsageError(
            f"a display for a studio must have {WORDS} words and entries, not"
            f" {configuration.largest_word + 1} and {configuration.entries} ({configuration.name}); choose"
            " another configuration"
        )
    return configuration


def repainted(before: Scene, now: Scene) -> list[Surface] | None:
    """The surfaces in another paint, where nothing else differs; None where something does."""
    if now.differing_fields(before) != ["surfaces"] or len(before.surfaces) != len(now.surfaces):
        return None
    pairs = [pair for pair in zip(before.surfaces, now.surfaces, strict=True) if pair[0] is not pair[1]]
    return [new for _, new in pairs] if all(new.is_but_for_paint(old) for old, new in pairs) else None


def _send(before: Shown | None, now: Shown, display: HostPort) -> None:
    """Send the entries and the words that differ."""
    components = WORDS * 3
    changed = np.flatnonzero(before.entries != now.entries) if before is not None else np.arange(components)
    if len(changed):
        first, last = int(changed[0]) // 3, int(changed[-1]) // 3
        _send_entries(first, now.entries[first : last + 1], display)
    if before is None or before.words is not now.words:
        display.send(instructions.write_image(now.words))


def _send_entries(first: int, entries: npt.NDArray[np.uint8], display: HostPort) -> None:
    short = configuration_of(display).entry_format is EntryFormat.WORD_12
    load = instructions.load_short_entries if short else instructions.load_entries
    display.send(load(first, entries))


def _floor(scene: Scene, picture: Picture, name: str) -> float:
    """The minimum as a fraction of the maximum, of the surface or of the whole object."""
    number = 0 if scene.scaling == "object" else picture.surfaces.index(name) + 1
    extent = picture.relative_ranges.get(number)
    return extent.minimum / extent.maximum if extent is not None and extent.maximum > 0 else 0.0


class Studio:
    """A session: a scene on a display, edited step by step, each step undone and done again.

    `display` is a host port: a `Ramtek9300`, one behind a network, or a recording. It is reset and gets the
    whole picture; later edits send what changed. An edit that is refused changes nothing.
    """

    def __init__(self, scene: Scene, display: HostPort) -> None:
        configuration = configuration_of(display)
        self._display = display
        self._rendering = rendering(scene, configuration.shown_lines, configuration.shown_elements)
        self._shown = shown(scene, self._rendering.picture)
        self._done: list[Scene] = []
        self._undone: list[Scene] = []
        self._kept = scene
        self.send_everything()

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self._shown.scene

    @property
    def picture(self) -> Picture:
        """The current picture."""
        return self._shown.picture

    @property
    def level_ranges(self) -> Mapping[str, LevelRange]:
        """The words that each surface owns, by its name."""
        return self._shown.ranges

    @property
    def words(self) -> npt.NDArray[np.uint16]:
        """The words of the current picture, (lines, elements) uint16; read-only."""
        return self._shown.words

    @property
    def entries(self) -> npt.NDArray[np.uint8]:
        """The entries of the lookup table, (1024, 3) uint8; read-only."""
        return self._shown.entries

    def recolor(self, surface: str, **changes: Any) -> None:
        """Change the colors of a surface; entries are sent, and no word.

        `changes` are fields of its Paint: object_color, light_color ("#rrggbb" or three numbers), blend,
        light_percentage.
        """
        for name in changes:
            if name not in PAINT_CHECKS:
                guess = nearest(name, PAINT_CHECKS)
                raise UsageError(f"recolor takes {', '.join(PAINT_CHECKS)}, not {name!r}{guess}")
        self.edit(self.scene.with_surface(surface, **changes))

    def surface(self, name: str, /, **changes: Any) -> None:
        """Change any field of a surface, of its reflectance or of its paint."""
        self.edit(self.scene.with_surface(name, **changes))

    def light(self, name: str, /, **changes: Any) -> None:
        """Change any field of a light."""
        self.edit(self.scene.with_light(name, **changes))

    def view(self, **changes: Any) -> None:
        """Change any field of the view; everything is computed again."""
        self.edit(self.scene.with_view(**changes))

    def edit(self, scene: Scene, same_step: bool = False) -> None:
        """Make a scene the current one; with `same_step` it is undone together with the edit before.

        A drag is many edits and one step. A scene that equals the current one is no step.
        """
        before = self.scene
        if not self._show(scene):
            return
        if not (same_step and self._done):
            self._done.append(before)
        self._undone.clear()

    def undo(self) -> bool:
        """Go back one step; False where there is none."""
        return self._step(self._done, self._undone)

    def redo(self) -> bool:
        """Do again the step that was undone last; False where there is none."""
        return self._step(self._undone, self._done)

    @property
    def is_changed(self) -> bool:
        """Whether the scene is another than when it was opened or last kept."""
        return self.scene is not self._kept

    def keep(self) -> None:
        """Note that the current scene is saved."""
        self._kept = self.scene

    def save(self, path: str | PathLike[str], overwrite: bool = False) -> None:
        """Write the picture with its scene to a picture file, and note that it is saved."""
        from autocolor.files.picture_file import write_picture

        write_picture(path, self.picture, self.scene, overwrite=overwrite)
        self.keep()

    def send_everything(self) -> None:
        """Reset the display and send all entries and all words."""
        self._display.send(instructions.reset())
        _send(None, self._shown, self._display)

    def _step(self, source: list[Scene], target: list[Scene]) -> bool:
        if not source:
            return False
        before = self.scene
        self._show(source[-1])
        source.pop()
        target.append(before)
        return True

    def _show(self, scene: Scene) -> bool:
        """Compute what changed and send it, if anything did; nothing is kept of a scene that is refused."""
        before = self._shown
        surfaces = repainted(before.scene, scene)
        if surfaces is not None:
            # Another color is no other intensity: the picture and its words stay.
            now = Shown(scene, before.picture, before.ranges, before.words)
            for surface in surfaces:
                if surface.name in now.ranges:
                    _send_entries(now.ranges[surface.name].first, now.entries_of(surface), self._display)
        elif scene.equals(before.scene):
            return False
        else:
            picture = before.picture
            rendered = rendering(scene, picture.lines, picture.elements, self._rendering)
            now = shown(scene, rendered.picture, before)
            _send(before, now, self._display)
            self._rendering = rendered
        self._shown = now
        return True

    def _repr_png_(self) -> bytes:
        from ramtek_emu.png import png_bytes

        return png_bytes(self.entries[self.words])

    def __repr__(self) -> str:
        return f"Studio({self.scene.name!r}, to undo {len(self._done)}, to redo {len(self._undone)})"
