"""The session on the screens: the studio, what is chosen, which screen is shown, and the message.

Every screen edits the scene through `edit`: so a gesture is one step to undo, and its pictures may be coarse
until it ends. At the foot are the comparison with another state, and the file on the disk.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple, Unpack

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.errors import InputError, UsageError
from autocolor.files.opening import MESH, hinted_up, kind_of, stays_within
from autocolor.files.palette_file import Palette, is_palette, read_palette
from autocolor.files.paths import SCENE_FILE, file_stem, free_path
from autocolor.files.rig_file import RIG_SUFFIX, is_rig, read_rig, write_rig
from autocolor.files.stamps import look_at
from autocolor.files.state import note_file
from autocolor.images import save_image
from autocolor.journal.description import describe
from autocolor.journal.places import Source
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import held_exposure, stage_surfaces
from autocolor.scene.changes import LightChanges, PaintChanges, SurfaceChanges
from autocolor.scene.columns import fields_of
from autocolor.scene.lights import Light
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import AUTO, LEVELS, Scene, unset_paints
from autocolor.scene.surfaces import Paint, Part, Surface
from autocolor.scene.swatches import finished
from autocolor.scene.view import View
from autocolor.sending import shown_colors
from autocolor.studio import Studio
from autocolor.widgets.rows import TableNames, World
from autocolor.widgets.widget import short_name, titled
from ramtek_emu import HostPort, instructions
from ramtek_emu.errors import escaped

PICTURE: Final = "picture"
"""The name of the screen that a session begins with, and comes back to."""

MIXING: Final = "mixing"
"""The name of the screen where colors are mixed, and taken from swatches and paints."""

HISTORY: Final = "history"
"""The name of the screen with the steps of the session."""

SPLIT: Final = "split"
"""The name of the screen with two states, left and right of a line."""

EXPLAIN: Final = "explain"
"""The name of the screen that explains a pixel."""

SENT: Final = "sent"
"""The name of the screen that lists what the last edit sent."""

MESSAGE_SECONDS: Final = 5.0
"""Assumed: how long a message is shown."""

LEAST_SECONDS: Final = 1.0
"""Assumed: how long a message is shown at least while the pointer moves from thing to thing."""

MOST_DESCRIBED: Final = 70
"""Assumed: letters of the description of a difference, which leaves room in the message line for a verb."""

LONGEST_NAME: Final = 24
"""Assumed: letters of a scene's name in a message that must also say what to do."""


class Message(NamedTuple):
    """A message, whether it is a warning, and when it was shown first."""

    text: str
    is_warning: bool
    shown_at: float
    persistent: bool = False
    """Whether it is shown until the next action, or until the menu comes."""
    seconds: float = MESSAGE_SECONDS
    """How long it is shown if it is not persistent."""


class Clipboard(NamedTuple):
    """The clipboard of the user's window. `copy` returns whether it took a text; `paste` returns its text."""

    copy: Callable[[str], bool]
    paste: Callable[[], str]


class Solo(NamedTuple):
    """A light that was switched on alone, and whether each light was on before, by name."""

    name: str
    switches: Mapping[str, bool]


class LastEdit(NamedTuple):
    """The last edit that was shown, and the words that it sent to the display.

    At first this is the opening of the scene; `before` is then the same scene.
    """

    before: Scene
    after: Scene
    words: Words
    """The instructions that changed the entries and the words of the picture, (n,) uint16, read-only.

    At most the words of one page are held: the array that was sent.
    """
    other_words: int
    """The number of further words for the same page: for menus, panels and the legend.

    If the edit did not change the words of the picture, and another screen turned to the picture, they also
    include the picture.
    """


class Session:
    """The state that the screens share.

    New files are saved to `folder`, which the file screen shows. It begins as `root`.
    """

    def __init__(self, studio: Studio, display: HostPort, folder: Path) -> None:
        self.studio = studio
        self.display = display
        self.root = self.folder = folder.resolve()
        self.comparing = Comparing(studio)
        """Another state that is shown in place of the present one."""
        self.screen = PICTURE
        """The name of the screen that is shown; setting it turns to another screen."""
        self.watches = False
        """Whether the user asked to see the picture come in line by line."""
        self.explains = False
        """Whether the next click in the picture explains its pixel."""
        self.pixel = (0, 0)
        """The line and the element of the pixel that is explained."""
        self.last_edit: LastEdit | None = None
        """The last edit, once a page has shown the scene."""
        self.leaves = False
        """Whether the user asked to leave the program."""
        self.same_step = False
        """Whether the next edit is undone together with the one before."""
        self.moving = False
        """Whether the next edit is part of a movement, whose pictures may be coarse."""
        self.has_keyboard = False
        """Whether the user has a keyboard."""
        self.clipboard: Clipboard | None = None
        """The clipboard; None on a display elsewhere."""
        self.keys: Sequence[tuple[str, str]] = ()
        """Each key and what it does, for the help page."""
        self.is_at_hand = False
        """Whether the user sits at this machine; a pointer from elsewhere stays within `root`."""
        self.outlives_window = False
        """Whether the steps remain in a studio when the user leaves, who then loses nothing."""
        self.mesh_up, self.mesh_scale = "z", 1.0
        """The up axis and the scale of mesh files that are opened; other files give their own."""
        self.paints: Palette | None = None
        """The paints that the user brought as a palette file, to take colors from."""
        self.paints_name = ""
        """The name of that file."""
        self.surface = 0
        """The number of the chosen surface among the surfaces in use; see `surface_name`."""
        self.side_view: tuple[View, str] | None = None
        """The view from a named side that was taken last, and the name of the side."""
        self.camera = ""
        """The name of the named view that was taken last."""
        self.part_name = ""
        """The name of the part that was pointed at last; empty at first."""
        self._light = ""
        self._before_solo: Solo | None = None
        """The light that was last switched on alone, and the switches before."""
        self._blended: dict[str, tuple[Mesh, Paint]] = {}
        """By the name of a surface that was given a ramp: the mesh then, and its paint before."""
        self._world: tuple[Mesh, tuple[Part, ...], World] | None = None
        self._up: tuple[Mesh, Source, str] | None = None
        """The mesh and the source that were last looked at, and the axis that seems to be up."""
        self._names = TableNames(self._names_in, {})
        self._edits: tuple[DisplayImage, Scene] | None = None
        """The image before the last edits, and the scene that they made, for `tell_effect`."""
        self._refused_to_leave: Scene | None = None
        """The scene that the user was last warned about when leaving would have discarded its changes."""
        self.news = Message("", False, 0.0)
        """The last message."""
        self.disk = FileOnDisk(studio)
        """The file that the scene is in, which other programs may change."""

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self.studio.scene

    @property
    def world(self) -> World:
        """The bounds of the object, from which bars get their range, and the names of the tables."""
        scene = self.scene
        mesh = scene.staged.mesh
        if self._world is None or self._world[0] is not mesh or self._world[1] != scene.parts:
            low, high = (tuple(corner.tolist()) for corner in mesh.bounds)
            world = World(*scene.object_bounds, self._names, (low, high))
            self._world = mesh, scene.parts, world
        return self._world[2]

    def _names_in(self, table: str) -> tuple[str, ...]:
        return tuple([row.name for row in vars(self.scene)[table]])

    def turn_to(self, screen: str) -> None:
        """Turn to a screen by its name."""
        if screen != self.screen:
            self.comparing.end()
        self.screen = screen

    def explain(self, line: int, element: int) -> None:
        """Turn to the explanation of a pixel."""
        self.explains, self.pixel = False, (line, element)
        self.turn_to(EXPLAIN)

    def words_at(self, element: int, line: int, elements: int = 1, lines: int = 1) -> Words:
        """The words of a window, (lines, elements), read back from the display."""
        parts = []
        for read, count in instructions.read_image(element, line, elements, lines):
            self.display.send(read)
            parts.append(self.display.receive(count))
        return np.concatenate(parts).reshape(lines, elements)

    def word_at(self, element: int, line: int) -> int:
        """The word of a pixel, read back from the display."""
        return int(self.words_at(element, line)[0, 0])

    def surface_of(self, word: int) -> str:
        """The name of the surface that owns a word; empty for the background and the words of screens."""
        ranges = self.studio.level_ranges.items()
        return next((name for name, levels in ranges if levels.first <= word <= levels.last), "")

    # The message.

    @property
    def message(self) -> str:
        """The text of the last message."""
        return self.news.text

    @property
    def has_news(self) -> bool:
        """Whether there is a message whose time has not passed. While states are compared, no time passes."""
        is_recent = time.monotonic() - self.news.shown_at < self.news.seconds
        return bool(self.news.text) and (is_recent or self.news.persistent or self.comparing.is_on)

    @property
    def news_may_go(self) -> bool:
        """Whether a hint may take the place of the message: it is no warning, and need not stay."""
        return self.has_news and not (self.news.is_warning or self.news.persistent)

    def shorten_news(self) -> None:
        """Let the message go as soon as it was shown for LEAST_SECONDS."""
        self.news = self.news._replace(seconds=LEAST_SECONDS)

    def tell(self, message: str, is_warning: bool = False, persistent: bool = False) -> None:
        """Show a message for some seconds; with `persistent`, until the next action.

        An empty message takes the last message away. Letters that cannot be printed, as in names of files,
        are escaped. Users of another machine do not see the folders above `root`.
        """
        if not self.is_at_hand:
            message = message.replace(str(self.root), self.root.name or "/")
        self.news = Message(escaped(message), is_warning, time.monotonic(), persistent, MESSAGE_SECONDS)

    def warn(self, message: object) -> None:
        """Show an error in one line; of several problems, the first and the number of the others."""
        more = ""
        if isinstance(message, InputError) and len(message.problems) > 1:
            first, *others = message.problems
            message, more = first, f" (and {len(others)} more)"
        self.tell(str(message).replace("\n", "; ") + more, is_warning=True)

    # The chosen surface and light.

    @property
    def surface_name(self) -> str:
        """The name of the chosen surface; empty if the scene has none in use."""
        names = list(self.studio.level_ranges)
        return names[self.surface % len(names)] if names else ""

    @property
    def chosen_surface(self) -> Surface | None:
        """The chosen surface; None if the scene has none in use."""
        return self.scene.surfaces[self.surface_name] if self.surface_name else None

    def choose_surface(self, name: str) -> None:
        """Choose a surface in use by its name; another name changes nothing."""
        names = list(self.studio.level_ranges)
        if name in names:
            self.surface = names.index(name)

    @property
    def light_name(self) -> str:
        """The name of the chosen light; empty if the scene has none."""
        names = [light.name for light in self.scene.lights]
        return self._light if self._light in names else next(iter(names), "")

    @property
    def chosen_light(self) -> Light | None:
        """The chosen light; None if the scene has none."""
        return self.scene.lights[self.light_name] if self.light_name else None

    def choose_light(self, name: str) -> None:
        """Choose a light by its name."""
        self._light = name

    # Comparing.

    def compare(self) -> None:
        """Show the state to compare with, over the picture, until the present one is edited."""
        if not self.comparing.is_on:
            self.tell(f"shown: {self.comparing.begin()}; {self.comparing.difference}")

    def end_comparing(self) -> None:
        """Show the present state again."""
        if self.comparing.end():
            self.tell(f"shown: {NOW}")

    def switch_comparing(self) -> None:
        """Show the state to compare with, or the present one again."""
        (self.end_comparing if self.comparing.is_on else self.compare)()

    def switch_split(self) -> None:
        """Show both states, left and right of a line, or the picture again."""
        self.turn_to(PICTURE if self.screen == SPLIT else SPLIT)

    # Edits.

    def edit(self, scene: Scene) -> None:
        """Make a scene the current scene. All edits of a gesture are undone as one step."""
        before = self.studio.display_image
        self.studio.edit(scene, same_step=self.same_step, moving=self.moving)
        if self.studio.scene is not before.scene:
            first = self._edits[0] if self._edits is not None and self.same_step else before
            self._edits = first, self.studio.scene
            # Further edits of the same gesture belong to its step; an edit without a change makes no step.
            self.same_step = True

    def tell_effect(self) -> bool:
        """If the last edits of lights changed nothing that is seen, say why; returns whether they did not."""
        edits, self._edits = self._edits, None
        if edits is None or edits[1] is not self.scene:
            return False
        reason = reason_of_no_change(self.studio, edits[0])
        if reason == AUTOMATIC:
            reason += "E holds all" if self.has_keyboard else "hold the exposure in the menu of lights"
        if reason:
            self.tell(f"no change: {reason}", is_warning=True)
        return bool(reason)

    def change_light(self, name: str, /, **changes: Unpack[LightChanges]) -> None:
        """Change fields of a light."""
        self.edit(self.scene.with_light(name, **changes))

    def change_surface(self, name: str, /, **changes: Unpack[SurfaceChanges]) -> None:
        """Change fields of a surface."""
        self.edit(self.scene.with_surface(name, **changes))

    @property
    def solo(self) -> str:
        """The name of the light that was switched on alone, while it still is; else empty."""
        on = [light.name for light in self.scene.lights if light.on]
        return on[0] if self._before_solo is not None and on == [self._before_solo.name] else ""

    def light_alone(self, name: str) -> None:
        """Switch one light on and all others off; if it is alone, switch all as before."""
        scene, before, alone = self.scene, self._before_solo, self.solo
        if before is not None and alone == name:
            switches = [before.switches.get(light.name, light.on) for light in scene.lights]
            lights = zip(scene.lights, switches, strict=True)
            self.edit(scene.replace(lights=tuple([light.replace(on=on) for light, on in lights])))
            self.tell("the lights are switched as before")
            return
        self.edit(scene.only_lights(name))
        switches_now = {light.name: light.on for light in scene.lights}
        self._before_solo = Solo(name, before.switches if before is not None and alone else switches_now)
        self.tell(f"{titled('light', name)} alone; again: the lights as before")

    def all_lights_on(self) -> None:
        """Switch all lights on."""
        self.edit(self.scene.with_all_lights_on())
        self.tell("all lights on")

    def paint(
        self, message: Callable[[Paint], str] | None = None, /, **changes: Unpack[PaintChanges]
    ) -> None:
        """Change the colors of the chosen surface, if there is one, and show a message about its new paint.

        If two colors replace a ramp, colors and blend are as before the ramp, if this session gave it, else
        the color in its middle and its last color, unless they are given.
        """
        if self.surface_name:
            paint = self.scene.surfaces[self.surface_name].paint
            if paint.ramp is not None and changes.get("ramp") is None:
                mesh, before = self._blended.get(self.surface_name, (None, paint))
                if mesh is not self.scene.mesh:
                    before = Paint(paint.color, paint.ramp[-1])
                scene = self.scene.with_surface(self.surface_name, paint=before.replace(**changes))
            else:
                scene = self.scene.with_paint(self.surface_name, **changes)
            self._edit_paint(scene, message(scene.surfaces[self.surface_name].paint) if message else "")

    def finish(self, name: str) -> None:
        """Give the chosen surface a finish. Raises UsageError for an unknown finish."""
        surface = self.scene.surfaces[self.surface_name]
        scene = self.scene.with_surface(surface.name, **finished(surface, name))
        self._edit_paint(scene, f"{surface.name}: {name}")

    def _edit_paint(self, scene: Scene, message: str) -> None:
        """Make a scene with other paints the current scene, and tell the colors that the edit unsets."""
        before = self.scene
        # A message is about the chosen surface already.
        chosen = f"{self.surface_name}: " if message else ""
        messages = [message, *(each.removeprefix(chosen) for each in unset_paints(before, scene))]
        self.edit(scene)
        for old, new in zip(before.surfaces, scene.surfaces, strict=True):
            if old.paint.ramp is None and new.paint.ramp is not None:
                self._blended[old.name] = before.mesh, old.paint
        if any(messages):
            self.tell("; ".join(filter(None, messages)))

    def color_of(self, color: Sequence[int] | str) -> Sequence[int] | str:
        """The color that a text names among `paints`; every other color itself."""
        if not isinstance(color, str) or self.paints is None:
            return color
        return self.paints.color_named(color.strip()) or color

    def take_paint(self, name: str) -> None:
        """Give the chosen surface the paint of another: both colors, the blend and the percentage, or a ramp.

        Raises UsageError if that is the chosen surface.
        """
        chosen = self.surface_name
        if name == chosen:
            raise UsageError(f"{name} is the chosen surface; point at another, whose paint it takes")
        scene = self.scene.with_surface(chosen, paint=self.scene.surfaces[name].paint)
        self._edit_paint(scene, f"{chosen}: the paint of {name}; undo goes back")

    # Files.

    def place_meshes(self, up: str, scale: float) -> None:
        """Take this up axis and scale for the mesh files that are opened from now on."""
        self.mesh_up, self.mesh_scale = up, scale

    @property
    def hinted_up(self) -> str:
        """The axis that seems to be up in the mesh file that was opened; empty if the mesh seems to stand."""
        source, mesh = self.studio.history.place.source, self.scene.mesh
        if source is None or source.up != "z":
            return ""
        if self._up is None or self._up[0] is not mesh or self._up[1] != source:
            self._up = mesh, source, hinted_up(source.path, mesh)
        return self._up[2]

    @property
    def lying(self) -> str:
        """The hint of a mesh that seems to lie on its side, and the label of its row; else empty."""
        return f"lying? up: {self.hinted_up}" if self.hinted_up else ""

    def stand_up(self) -> None:
        """Read the mesh file again with the axis up that seems to be up, as one step to undo."""
        source, up = self.studio.history.place.source, self.hinted_up
        if source is not None and up:
            self.studio.open(source.path, up=up, scale=source.scale, surfaces=source.surfaces)
            self.tell(f"read again with {up} up; undo goes back")

    def open(self, path: Path) -> None:
        """Open a file or a folder as one step to undo: a scene, a mesh, a picture, or a rig of lights.

        The colors of a palette file become `paints`, which is no step, and color mixing shows them. Raises
        InputError or MissingInputError.
        """
        if is_palette(path):
            self.bring_paints(read_palette(path), path.name)
            self.turn_to(MIXING)
            return
        if path.suffix.lower() == RIG_SUFFIX and path.name != SCENE_FILE and is_rig(path):
            rig = read_rig(path)
            try:
                lit = self.scene.with_rig(rig)
            except InputError as error:
                raise InputError(f"{path.name}, {problem}" for problem in error.problems) from None
            self.edit(lit)
            links = [[light.links for light in lights] for lights in (rig.lights, self.scene.lights)]
            left_out = "" if links[0] == links[1] else ", without links to what it lacks"
            self.tell(f"the lights of {path.name}, fitted to {self.scene.name}{left_out}; undo goes back")
            return
        if kind_of(path) == MESH:
            self.studio.open(path, up=self.mesh_up, scale=self.mesh_scale)
        else:
            self.studio.open(path)
        note_file(path.resolve())
        self.tell("; ".join(part for part in (f"opened {path.name}", self.lying, "undo goes back") if part))

    def bring_paints(self, paints: Palette, name: str) -> None:
        """Let the user take colors from the paints of a file of this name; they replace earlier paints."""
        self.paints, self.paints_name = paints, name
        count = "a paint" if len(paints) == 1 else f"{len(paints):,} paints"
        self.tell(f"{count} of {short_name(name, LONGEST_NAME)}: take them in color mixing")

    def reopen(self) -> None:
        """Read the scene's file again, as one step to undo. Raises UsageError or InputError."""
        is_other = self.studio.reopen()
        self.tell("read again; undo goes back" if is_other else "the file holds this scene")

    def take_changes(self) -> bool:
        """Show the scene's file that another program changed, or ask first; False if nothing differs."""
        message = self.disk.take()
        if message:
            self.tell(message, is_warning=self.studio.is_changed, persistent=True)
        return bool(message)

    def may_reach(self, path: Path) -> bool:
        """Whether the user may open a path, or save in it: from elsewhere, no link may lead out of `root`."""
        return self.is_at_hand or stays_within(path, self.root)

    def check_reach(self, path: Path, noun: str) -> None:
        """Raise UsageError if the user may not open a path, or save in it; `noun` names the path."""
        if not self.may_reach(path):
            raise UsageError(
                f"{path.name}: {noun} must be in the folder {self.root.name}, and not a link to elsewhere;"
                " choose another"
            )

    def _shown_folder(self) -> Path:
        """The folder for new files. Raises UsageError if it became a link that leads out of `root`."""
        self.check_reach(self.folder, "a folder to save in")
        return self.folder

    def save(self, name: str | None = None) -> None:
        """Save the scene and the picture; the message says the names of the files.

        With a `name`, they are saved as new files of this name. Raises as `Studio.save_session`.
        """
        saved = self.studio.save_session(self._shown_folder(), name)
        note_file(saved.scene)
        self.tell(saved.message(self.root))

    def save_rig(self) -> None:
        """Save the lights, to put them on another scene."""
        path = free_path(self._shown_folder() / f"{file_stem(self.scene.name)}-rig{RIG_SUFFIX}")
        write_rig(path, self.scene)
        self.tell(f"saved {path.name}")

    def export(self, size: tuple[int, int], smooth: int) -> None:
        """Save the picture at a size as a new PNG file, named after the scene, with a smoothness."""
        path = free_path(self._shown_folder() / f"{file_stem(self.scene.name)}.png")
        save_image(path, self.scene, size=size, smooth=smooth)
        width, height = size
        self.tell(f"saved {path.name}: {width}x{height}, smoothness {smooth}")

    def save_image(self) -> None:
        """Save the picture alone, with the legend of a scalar, as the next screenshot."""
        self.studio.refine()
        self.save_screenshot(shown_colors(self.studio.display_image))

    def save_screenshot(self, colors: Bytes) -> None:
        """Save (lines, elements, 3) colors as the next screenshot, "autocolor-0001.png"."""
        from ramtek_emu.png import save_numbered

        self.tell(f"saved {save_numbered(colors, self._shown_folder(), 'autocolor')}")

    def undo(self, steps: int = 1) -> None:
        """Undo the last step, or some steps at once."""
        after = self.scene
        if self.studio.undo(steps):
            self._tell_steps("undone", steps, describe(self.scene, after, MOST_DESCRIBED))
        else:
            self.tell("nothing to undo")

    def redo(self, steps: int = 1) -> None:
        """Redo the last undone step, or some steps at once."""
        before = self.scene
        if self.studio.redo(steps):
            self._tell_steps("redone", steps, describe(before, self.scene, MOST_DESCRIBED))
        else:
            self.tell("nothing to redo")

    def _tell_steps(self, verb: str, steps: int, difference: str) -> None:
        count = f"{steps} steps " if steps > 1 else ""
        self.tell(f"{count}{verb}: {difference or 'no change'}")

    # The end.

    @property
    def unsaved(self) -> str:
        """The changes that leaving the program would lose, and how to save them; empty without changes."""
        history = self.studio.history
        if self.outlives_window:
            return ""
        if history.is_changed:
            return "not saved: Ctrl+S saves" if self.has_keyboard else "not saved: save it"
        if history.left_unsaved:
            return f"{short_name(history.left_unsaved[-1], LONGEST_NAME)} is not saved: undo goes back to it"
        if history.unsaved_variants:
            return f"variant {history.unsaved_variants[-1]} is not saved: come back to it and save it"
        return ""

    def leave(self) -> None:
        """Ask to leave the program. Unsaved changes are announced first, and lost at the next attempt."""
        unsaved = self.unsaved
        if unsaved and self._refused_to_leave is not self.scene:
            self._refused_to_leave = self.scene
            self.warn(f"{unsaved}, or leave once more to discard the changes")
        else:
            self.leaves = True


# Another state of the scene can be shown in place of the present state, to see what was gained: the state
# before the last step, or a scene that was chosen, such as a variant. An edit ends the comparison first. The
# words and entries of both states are at hand, so that switching sends only what differs: where only colors
# differ, no word.

BEFORE: Final = "the state before the last step"
NOW: Final = "the present state"
"""The names of the two states in the message line."""


class NamedScene(NamedTuple):
    """A scene to compare with, and its name in the message line."""

    name: str
    scene: Scene


class Comparing:
    """The state that the scene of a studio is compared with, and whether that state is shown."""

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._chosen: NamedScene | None = None
        self._seen: tuple[Scene, View, NamedScene] | None = None
        """A scene, the present view, and that scene in this view."""
        self._cached: tuple[Scene, Scene, DisplayImage] | None = None
        """The present scene, the scene that it was last compared with, and the image of that other scene."""
        self._shown: DisplayImage | None = None

    @property
    def other(self) -> NamedScene | None:
        """The chosen scene to compare with, else the look before the last step, if there is one.

        It is in the present view if it has the present mesh.
        """
        steps, present = self._studio.history.to_undo, self._studio.scene
        other = self._chosen or (NamedScene(BEFORE, steps[-1]) if steps else None)
        if other is None or other.scene.mesh is not present.mesh or other.scene.view == present.view:
            return other
        if self._seen is None or self._seen[:2] != (other.scene, present.view):
            seen = other._replace(scene=other.scene.replace(view=present.view))
            self._seen = other.scene, present.view, seen
        return self._seen[2]

    def choose(self, other: NamedScene | None) -> None:
        """Choose the scene to compare with from now on; None for the state before the last step."""
        self.end()
        self._chosen = other

    def forget(self, scene: Scene) -> None:
        """Compare with the state before the last step again if this scene was chosen."""
        if self._chosen is not None and self._chosen.scene is scene:
            self.choose(None)

    @property
    def difference(self) -> str:
        """How the present state differs from the other state, for a message."""
        difference = describe(self.other.scene, self._studio.scene, MOST_DESCRIBED) if self.other else ""
        return f"now: {difference}" if difference else "now the same"

    @property
    def other_image(self) -> DisplayImage | None:
        """The image of the state to compare with, if there is one; the present image is refined first."""
        return None if self.other is None else self._image_of(self.other.scene)

    @property
    def image(self) -> DisplayImage | None:
        """The image that is shown in place of the present state; None while comparing is off."""
        return self._shown

    @property
    def is_on(self) -> bool:
        """Whether another state is shown."""
        return self._shown is not None

    def begin(self) -> str:
        """Show the other state; returns its name. Raises UsageError if there is none."""
        other = self.other
        if other is None:
            raise UsageError(
                "to compare, there must be a step to undo or a kept variant; edit something first"
            )
        if self._shown is None:
            self._shown = self._image_of(other.scene)
        return other.name

    def end(self) -> bool:
        """Show the present state again; returns False if it was shown."""
        was_on, self._shown = self.is_on, None
        return was_on

    def _image_of(self, other: Scene) -> DisplayImage:
        """The image of another scene, computed once for a pair of scenes."""
        studio = self._studio
        studio.refine()
        if self._cached is None or self._cached[0] is not studio.scene or self._cached[1] is not other:
            self._cached = studio.scene, other, studio.image_of(other)
        return self._cached[2]


# The scene's file may be edited by another program while the scene is shown: the session shows the change as
# one step to undo. With unsaved edits, the user is asked first. If the file has an error, as a half edited
# file does, the message line shows it and the scene stays as it was.

SECONDS_BETWEEN: Final = 0.5
"""Assumed: the time between two looks at the file. An edit is shown at once, and looking costs nothing."""


class FileOnDisk:
    """The file of a studio's scene, and whether another program changed it."""

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._looked_at = time.monotonic()
        self._last_look: tuple[int | bytes, ...] | None = None
        self._is_refused = False
        """Whether the file had an error when it was last read."""

    def was_changed(self) -> bool:
        """Whether another program changed the file since the last call; it is looked at twice a second."""
        now = time.monotonic()
        if now - self._looked_at < SECONDS_BETWEEN:
            return False
        self._looked_at = now
        path = self._studio.file
        look = None if path is None else look_at(path)
        if look is None or look == self._last_look:
            return False
        self._last_look = look
        return self._is_refused or self._studio.history.on_disk.was_changed(str(path))

    def take(self) -> str:
        """Show the file's scene, or ask whether to; returns the message, empty if nothing differs.

        Raises InputError if the file has an error; the scene stays as it was.
        """
        path = self._studio.file
        assert path is not None
        name = path.name
        if self._studio.is_changed:
            return f"{name} was changed elsewhere: Ctrl+R shows that, Ctrl+S saves yours beside"
        was_refused, self._is_refused = self._is_refused, True
        try:
            is_other = self._studio.reopen()
        except InputError as error:
            raise InputError(f"not shown: {problem}" for problem in error.problems) from None
        self._is_refused = False
        if is_other:
            return f"{name} was changed elsewhere; undo goes back"
        return f"{name} holds this scene again" if was_refused else ""


# An edit of a light may change nothing that is seen: with automatic exposure and one light alone, any
# intensity of the light gives the same levels. The session then says why.

LEAST_CHANGED: Final = 1e-4
"""Assumed: the share of the visible pixels whose words an edit must change by more than rounding."""

AUTOMATIC: Final = "automatic exposure maps the brightest to the highest level; "
"""The reason that ends with how to hold the exposure."""


def looks_equal(one: DisplayImage, other: DisplayImage) -> bool:
    """Whether two images differ by less than rounding: in few words, by one level, and in no entry.

    Measured: 0.2 ms for 640 x 480 words.
    """
    changed = one.words != other.words
    visible = int(np.count_nonzero(other.words))
    if np.count_nonzero(changed) >= LEAST_CHANGED * max(1, visible):
        return False
    differences = one.words[changed].astype(int) - other.words[changed]
    return not (np.abs(differences) > 1).any() and np.array_equal(one.entries, other.entries)


def is_edited(before: Light | None, after: Light) -> bool:
    """Whether an edit of a light is meant to change what is seen; None is for a new light.

    Changing `follows` alone leaves the light where it is, and changing `carried` its half-space.
    """
    if before is None:
        return after.on
    one, other = (
        (light.follows, {plane.name: plane.carried for plane in light.half_spaces})
        for light in (before, after)
    )
    return before != after and one == other


def reason_of_no_change(studio: Studio, before: DisplayImage) -> str:
    """Why edits of lights since an image changed nothing that is seen; empty if they did, or were others."""
    scene, start = studio.scene, before.scene
    is_other = any(
        vars(scene)[name] is not vars(start)[name] for name in fields_of(Scene) if name != "lights"
    )
    olds = {light.name: light for light in start.lights}
    edited = [light for light in scene.lights if is_edited(olds.get(light.name), light)]
    is_renamed = len(scene.lights) == len(olds) and olds.keys() != {light.name for light in scene.lights}
    if is_other or is_renamed or not edited or not looks_equal(before, studio.display_image):
        return ""
    which = titled("light", edited[0].name) if len(edited) == 1 else "every edited light"
    versions = [version for light in edited for version in (light, olds.get(light.name, light))]
    if not any(light.on for light in versions):
        return f"{which} is off"
    if not any(light.on and light.intensity for light in versions):
        return f"{which} has the intensity 0"
    names = [light.name for light in edited]
    alone = scene.replace(
        lights=[light.replace(on=light.name in names, intensity=1) for light in scene.lights],
        ambient=0,
        words=LEVELS,
        exposure=AUTO,
    )
    if not studio.image_of(alone).picture.ranges.whole.maximum:
        return f"{which} shines on nothing that is seen"
    held = held_exposure(before.mapped, scene.scaling, scene.exposure, stage_surfaces(scene))
    if held != scene.exposure and not looks_equal(before, studio.image_of(scene.replace(exposure=held))):
        return AUTOMATIC
    return "no point that is seen gets another level"
