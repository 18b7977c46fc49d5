"""The session on the screens: the studio, what is chosen, which screen is shown, and the message.

Every screen edits the scene through `edit`, so that a gesture is one step to undo, and its pictures may be
coarse while it moves.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Final, NamedTuple, Unpack

from autocolor.checks import printable
from autocolor.errors import InputError, UsageError
from autocolor.files.paths import SCENE_FILE
from autocolor.files.rig_file import RIG_SUFFIX, is_rig, read_rig, write_rig
from autocolor.files.scene_files import MESH, kind_of
from autocolor.files.state import note_file
from autocolor.files.store.connections import FileChanges
from autocolor.files.store.store_file import STORE_SUFFIXES
from autocolor.files.writing import file_stem, free_path
from autocolor.mapping.display_image import DisplayImage
from autocolor.scene.changes import LightChanges, PaintChanges, SurfaceChanges
from autocolor.scene.lights import Light
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface
from autocolor.scene.view import View
from autocolor.studio import Studio
from autocolor.widgets.rows import KnownNames, World
from autocolor.widgets.widget import short_name
from ramtek_emu import HostPort, instructions

# -------------------- comparing
# Comparing: another state of the scene is shown in place of the present one, to see what was gained.
#
# That is the state before the last step, or a scene that was chosen, such as a kept variant. Nothing is
# edited meanwhile; who edits ends it first. The words and entries of both are at hand, so that switching
# sends no more than what differs: where only colors do, no word.

BEFORE: Final = "the state before the last step"
NOW: Final = "the present state"
"""What the message line calls what is shown."""


class Other(NamedTuple):
    """A scene to compare with, and what the message line calls it."""

    name: str
    scene: Scene


class Comparing:
    """What the scene of a studio is compared with, and whether that is shown."""

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._chosen: Other | None = None
        self._kept: tuple[Scene, Scene, DisplayImage] | None = None
        """A scene that was compared with another, that one, and what that looks like."""
        self._shown: DisplayImage | None = None

    @property
    def other(self) -> Other | None:
        """What is compared with: what was chosen, else the state before the last step, if there is one."""
        steps = self._studio.history.to_undo
        return self._chosen or (Other(BEFORE, steps[-1]) if steps else None)

    def choose(self, other: Other | None) -> None:
        """Choose what to compare with from now on; None for the state before the last step."""
        self.end()
        self._chosen = other

    def forget(self, scene: Scene) -> None:
        """Do not compare with a scene any longer that was chosen."""
        if self._chosen is not None and self._chosen.scene is scene:
            self.choose(None)

    @property
    def image(self) -> DisplayImage | None:
        """What is shown in place of the present state, if anything."""
        return self._shown

    @property
    def is_on(self) -> bool:
        """Whether another state is shown."""
        return self._shown is not None

    def begin(self) -> str:
        """Show the other state; returns what it is called. Raises UsageError if there is none."""
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
        """What another scene looks like, computed once for each two that are compared."""
        studio = self._studio
        studio.refine()
        if self._kept is None or self._kept[0] is not studio.scene or self._kept[1] is not other:
            self._kept = studio.scene, other, studio.image_of(other)
        return self._kept[2]


# -------------------- file_on_disk
# The file that the scene is in: what another program changes there is shown as one step to undo.
#
# With edits that are not saved, the user is asked first. A file that is wrong for a while, as half edited
# ones are, is told, and the scene stays as it was.

SECONDS_BETWEEN: Final = 0.5
"""Assumed: often enough to see an edit at once, and seldom enough to cost nothing."""


class FileOnDisk:
    """Looks at the file of a studio's scene."""

    def __init__(self, studio: Studio) -> None:
        self._studio = studio
        self._changes: FileChanges | None = None
        self._looked_at = time.monotonic()
        self._bind()

    def was_changed(self) -> bool:
        """Whether another program changed the file since it was `seen`; it is looked at twice a second."""
        now = time.monotonic()
        if now - self._looked_at < SECONDS_BETWEEN:
            return False
        self._looked_at = now
        self._bind()
        return self._changes is not None and self._changes.have_come()

    def seen(self) -> None:
        """Take the file as it is now for seen, as after it was saved or opened."""
        self._bind()
        if self._changes is not None:
            self._changes.seen()

    def take(self) -> str:
        """Show what the file holds now, or ask whether to; returns what to tell, empty for nothing.

        Raises InputError if it cannot be shown; the scene stays as it was.
        """
        assert self._changes is not None
        name = self._changes.path.name
        # What is written from now on is another change.
        self._changes.seen()
        if self._studio.is_changed:
            return f"{name} was changed elsewhere: Ctrl+R shows that, Ctrl+S saves yours beside"
        try:
            is_other = self._studio.reopen()
        except InputError as error:
            raise InputError(f"not shown: {problem}" for problem in error.problems) from None
        return f"{name} was changed elsewhere; undo goes back" if is_other else ""

    def _bind(self) -> None:
        """Look at the file that the scene is in now."""
        path = self._studio.file
        if path is None:
            self._changes = None
        elif self._changes is None or self._changes.path != path:
            self._changes = FileChanges(path, path.suffix.lower() in STORE_SUFFIXES)


PICTURE: Final = "picture"
"""The name of the screen that a session begins with, and comes back to."""

MESSAGE_SECONDS: Final = 5.0
"""Assumed: how long a message stands."""

LONGEST_SHOWN: Final = 24
"""Assumed: letters of a scene's name in a message that must also tell what to do."""


class News(NamedTuple):
    """A message, whether it tells of something that could not be done, and when it was told."""

    text: str
    is_warning: bool
    told_at: float
    stands: bool = False
    """Whether it stands until something is done, or the menu comes."""


class Session:
    """What the screens share. `folder` is where new files are saved."""

    def __init__(self, studio: Studio, display: HostPort, folder: Path) -> None:
        self.studio = studio
        self.display = display
        self.folder = folder
        self.comparing = Comparing(studio)
        """Another state that is shown in place of the present one."""
        self.screen = PICTURE
        """The name of the screen that is shown; setting it turns to another one."""
        self.watches = False
        """Whether the user asked to see the picture come in line by line."""
        self.leaves = False
        """Whether the user asked to leave the program."""
        self.same_step = False
        """Whether the next edit is undone together with the one before."""
        self.moving = False
        """Whether the next edit is one of a movement, whose pictures may be coarse."""
        self.has_keyboard = False
        """Whether something can be typed."""
        self.is_at_hand = False
        """Whether the user sits at this machine; a pointer from elsewhere keeps to the folder."""
        self.mesh_up, self.mesh_scale = "z", 1.0
        """The up axis and the scale of mesh files that are opened; other files give their own."""
        self.surface = 0
        """The number of the chosen surface among those in use; see `surface_name`."""
        self.named_view: tuple[View, str] | None = None
        """The view from one of the sides that have names that was taken last, and that name."""
        self.part_name = ""
        """The part that was pointed at last, if any."""
        self._light = ""
        self._world: tuple[Mesh, tuple[Part, ...], World] | None = None
        self._names = KnownNames(self._names_in, {})
        self._refused_to_leave: Scene | None = None
        """The scene whose changes leaving would have discarded, when the user was told so last."""
        self.news = News("", False, 0.0)
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
        if self._world is None or self._world[0] is not scene.mesh or self._world[1] != scene.parts:
            self._world = scene.mesh, scene.parts, World(*scene.object_bounds, self._names)
        return self._world[2]

    def _names_in(self, table: str) -> tuple[str, ...]:
        return tuple(row.name for row in vars(self.scene)[table])

    def turn_to(self, screen: str) -> None:
        """Turn to a screen by its name."""
        if screen != self.screen:
            self.comparing.end()
        self.screen = screen

    def word_at(self, element: int, line: int) -> int:
        """The word of a pixel, read back from the display."""
        ((read, count),) = instructions.read_image(element, line, 1, 1)
        self.display.send(read)
        return int(self.display.receive(count)[0])

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
        """Whether there is a message whose time has not passed; while states are compared, it does not."""
        is_recent = time.monotonic() - self.news.told_at < MESSAGE_SECONDS
        return bool(self.news.text) and (is_recent or self.news.stands or self.comparing.is_on)

    def tell(self, message: str, is_warning: bool = False, stands: bool = False) -> None:
        """Show a message for some seconds, or one that `stands`; an empty one takes the last one away.

        It is one line. Letters that cannot be printed, as in names of files, become question marks.
        """
        line = printable(message)
        self.news = News(line, is_warning, time.monotonic(), stands)

    def warn(self, message: object) -> None:
        """Show an error in one line; of several problems, the first one and how many others there are."""
        more = ""
        if isinstance(message, InputError) and len(message.problems) > 1:
            first, *others = message.problems
            message, more = first, f" (and {len(others)} more)"
        self.tell(str(message).replace("\n", "; ") + more, is_warning=True)

    # What is chosen.

    @property
    def surface_name(self) -> str:
        """The name of the chosen surface; empty if the scene has none in use."""
        names = list(self.studio.level_ranges)
        return names[self.surface % len(names)] if names else ""

    @property
    def chosen_surface(self) -> Surface | None:
        """The chosen surface; None if the scene has none in use."""
        return self.scene.surface(self.surface_name) if self.surface_name else None

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
        return self.scene.light(self.light_name) if self.light_name else None

    def choose_light(self, name: str) -> None:
        """Choose a light by its name."""
        self._light = name

    # Comparing.

    def compare(self) -> None:
        """Show the state to compare with, over the picture, until the present one is edited."""
        if not self.comparing.is_on:
            self.tell(f"shown: {self.comparing.begin()}")

    def end_comparing(self) -> None:
        """Show the present state again."""
        if self.comparing.end():
            self.tell(f"shown: {NOW}")

    def switch_comparing(self) -> None:
        """Show the state to compare with, or the present one again."""
        (self.end_comparing if self.comparing.is_on else self.compare)()

    # Edits.

    def edit(self, scene: Scene) -> None:
        """Make a scene the current one; the edits of one gesture are one step to undo."""
        before = self.studio.scene
        self.studio.edit(scene, same_step=self.same_step, moving=self.moving)
        # Further edits of the same gesture belong to its step; one that changed nothing has none.
        self.same_step = self.same_step or self.studio.scene is not before

    def change_light(self, name: str, /, **changes: Unpack[LightChanges]) -> None:
        """Change fields of a light."""
        self.edit(self.scene.with_light(name, **changes))

    def change_surface(self, name: str, /, **changes: Unpack[SurfaceChanges]) -> None:
        """Change fields of a surface."""
        self.edit(self.scene.with_surface(name, **changes))

    def light_alone(self, name: str) -> None:
        """Switch one light on and all others off."""
        self.edit(self.scene.only_lights(name))
        self.tell(f"light {name} alone")

    def all_lights_on(self) -> None:
        """Switch all lights on."""
        self.edit(self.scene.with_all_lights_on())
        self.tell("all lights on")

    def paint(self, **changes: Unpack[PaintChanges]) -> None:
        """Change the colors of the chosen surface, if there is one."""
        if self.surface_name:
            self.edit(self.scene.with_paint(self.surface_name, **changes))

    # Files.

    def place_meshes(self, up: str, scale: float) -> None:
        """Take this up axis and scale for the mesh files that are opened from now on."""
        self.mesh_up, self.mesh_scale = up, scale

    def open(self, path: Path) -> None:
        """Open a file or a folder as one step to undo: a scene, a mesh, a picture, or a rig of lights.

        Raises InputError or MissingInputError.
        """
        if path.suffix.lower() == RIG_SUFFIX and path.name != SCENE_FILE and is_rig(path):
            rig = read_rig(path)
            self.edit(self.scene.with_rig(rig))
            links = [[light.links for light in lights] for lights in (rig.lights, self.scene.lights)]
            left_out = "" if links[0] == links[1] else ", without links to what it lacks"
            self.tell(f"the lights of {path.name}, fitted to {self.scene.name}{left_out}; undo goes back")
            return
        if kind_of(path) == MESH:
            self.studio.open(path, up=self.mesh_up, scale=self.mesh_scale)
        else:
            self.studio.open(path)
        self.disk.seen()
        note_file(path.resolve())
        self.tell(f"opened {path.name}; undo goes back")

    def reopen(self) -> None:
        """Read the scene's file again, as one step to undo. Raises UsageError or InputError."""
        is_other = self.studio.reopen()
        self.disk.seen()
        self.tell("read again; undo goes back" if is_other else "the file holds this scene")

    def take_changes(self) -> bool:
        """Show what another program changed in the scene's file, or ask first; False if that is nothing."""
        told = self.disk.take()
        if told:
            self.tell(told, is_warning=self.studio.is_changed, stands=True)
        return bool(told)

    def save(self) -> None:
        """Save the scene and the picture, under names that the message tells."""
        saved = self.studio.save_session(self.folder)
        self.disk.seen()
        note_file(saved.scene)
        self.tell(saved.told(self.folder))

    def save_rig(self) -> None:
        """Save the lights, to put them on another scene."""
        path = free_path(self.folder / f"{file_stem(self.scene.name)}-rig{RIG_SUFFIX}")
        write_rig(path, self.scene)
        self.tell(f"saved {path.name}")

    def save_image(self) -> None:
        """Save the picture, without menus, as a numbered image."""
        from autocolor.images import save_image

        path = free_path(self.folder / f"{file_stem(self.scene.name)}.png")
        self.studio.refine()
        save_image(path, self.scene, self.studio.picture)
        self.tell(f"saved {path.name}")

    def undo(self) -> None:
        """Undo the last step."""
        self.tell("undone" if self.studio.undo() else "nothing to undo")

    def redo(self) -> None:
        """Redo the last undone step."""
        self.tell("redone" if self.studio.redo() else "nothing to redo")

    # The end.

    @property
    def unsaved(self) -> str:
        """What leaving the program would lose, and how that is saved; empty if there is nothing."""
        history = self.studio.history
        if history.is_changed:
            return "not saved: Ctrl+S saves" if self.has_keyboard else "not saved: save it"
        if history.left_unsaved:
            return f"{short_name(history.left_unsaved[-1], LONGEST_SHOWN)} is not saved: undo goes back to it"
        if history.unsaved_variants:
            return f"variant {history.unsaved_variants[-1]} is not saved: come back to it and save it"
        return ""

    def leave(self) -> None:
        """Ask to leave the program; changes that are not saved are told first, and the next time lost."""
        unsaved = self.unsaved
        if unsaved and self._refused_to_leave is not self.scene:
            self._refused_to_leave = self.scene
            self.warn(f"{unsaved}, or leave once more to discard the changes")
        else:
            self.leaves = True
