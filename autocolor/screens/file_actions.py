"""What the user does with files: open, read again, save, export, leave; and changes by other programs."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Final

from autocolor.arrays import Bytes
from autocolor.errors import InputError, UsageError
from autocolor.files.opening import MESH, hinted_up, kind_of, stays_within
from autocolor.files.palette_file import Palette, is_palette, read_palette
from autocolor.files.paths import SCENE_FILE, file_stem, free_path
from autocolor.files.rig_file import RIG_SUFFIX, is_rig, read_rig, write_rig
from autocolor.files.stamps import look_at
from autocolor.files.state import note_file
from autocolor.images import save_image as save_image_of
from autocolor.screens.session import MIXING, Session
from autocolor.sending import shown_colors
from autocolor.studio import Studio
from autocolor.widgets.widget import short_name

LONGEST_NAME: Final = 24
"""Assumed: letters of a scene's name in a message that must also say what to do."""


def seeming_up(session: Session) -> str:
    """The axis that seems to be up in the mesh file that was opened; empty if the mesh seems to stand."""
    source, mesh = session.studio.history.place.source, session.scene.mesh
    if source is None or source.up != "z":
        return ""
    return session.seeming_up.of(lambda: hinted_up(source.path, mesh), mesh, source)


def lying(session: Session) -> str:
    """The hint of a mesh that seems to lie on its side; else empty."""
    return "lies on its side? the menu turns it" if seeming_up(session) else ""


def stand_up(session: Session) -> None:
    """Read the mesh file again with the axis up that seems to be up, as one step to undo."""
    source, up = session.studio.history.place.source, seeming_up(session)
    if source is not None and up:
        session.studio.open(source.path, up=up, scale=source.scale, surfaces=source.surfaces)
        session.tell(f"read again with {up} up; undo goes back")


def open_file(session: Session, path: Path) -> None:
    """Open a file or a folder as one step to undo: a scene, a mesh, a picture, or a rig of lights.

    The colors of a palette file become `paints`, which is no step, and color mixing shows them. Raises
    InputError or MissingInputError.
    """
    if is_palette(path):
        bring_paints(session, read_palette(path), path.name)
        session.turn_to(MIXING)
        return
    if path.suffix.lower() == RIG_SUFFIX and path.name != SCENE_FILE and is_rig(path):
        rig = read_rig(path)
        try:
            lit = session.scene.with_rig(rig)
        except InputError as error:
            raise InputError(f"{path.name}, {problem}" for problem in error.problems) from None
        session.edit(lit)
        links = [[light.links for light in lights] for lights in (rig.lights, session.scene.lights)]
        left_out = "" if links[0] == links[1] else ", without links to what it lacks"
        session.tell(f"the lights of {path.name}, fitted to {session.scene.name}{left_out}; undo goes back")
        return
    if kind_of(path) == MESH:
        session.studio.open(path, up=session.mesh_up, scale=session.mesh_scale)
    else:
        session.studio.open(path)
    note_file(path.resolve())
    session.tell(
        "; ".join(part for part in (f"opened {path.name}", lying(session), "undo goes back") if part)
    )


def bring_paints(session: Session, paints: Palette, name: str) -> None:
    """Let the user take colors from the paints of a file of this name; they replace earlier paints."""
    session.paints, session.paints_name = paints, name
    count = "a paint" if len(paints) == 1 else f"{len(paints):,} paints"
    session.tell(f"{count} of {short_name(name, LONGEST_NAME)}: take them in color mixing")


def read_again(session: Session) -> None:
    """Read the scene's file again, as one step to undo. Raises UsageError or InputError."""
    is_other = session.studio.reopen()
    session.tell("read again; undo goes back" if is_other else "the file holds this scene")


def take_changes(session: Session, disk: FileOnDisk) -> bool:
    """Show the scene's file that another program changed, or ask first; False if nothing differs."""
    message = disk.take()
    if message:
        session.tell(message, is_warning=session.studio.is_changed, persistent=True)
    return bool(message)


def may_reach(session: Session, path: Path) -> bool:
    """Whether the user may open a path, or save in it: from elsewhere, no link may lead out of `root`."""
    return session.is_at_hand or stays_within(path, session.root)


def check_reach(session: Session, path: Path, noun: str) -> None:
    """Raise UsageError if the user may not open a path, or save in it; `noun` names the path."""
    if not may_reach(session, path):
        raise UsageError(
            f"{path.name}: {noun} must be in the folder {session.root.name}, and not a link to elsewhere;"
            " choose another"
        )


def shown_folder(session: Session) -> Path:
    """The folder for new files. Raises UsageError if it became a link that leads out of `root`."""
    check_reach(session, session.folder, "a folder to save in")
    return session.folder


def save(session: Session, name: str | None = None) -> None:
    """Save the scene and the picture; the message says the names of the files.

    With a `name`, they are saved as new files of this name. Raises as `Studio.save_session`.
    """
    saved = session.studio.save_session(shown_folder(session), name)
    note_file(saved.scene)
    session.tell(saved.message(session.root))


def save_rig(session: Session) -> None:
    """Save the lights, to put them on another scene."""
    path = free_path(shown_folder(session) / f"{file_stem(session.scene.name)}-rig{RIG_SUFFIX}")
    write_rig(path, session.scene)
    session.tell(f"saved {path.name}")


def export(session: Session, size: tuple[int, int], smooth: int) -> None:
    """Save the picture at a size as a new PNG file, named after the scene, with a smoothness."""
    path = free_path(shown_folder(session) / f"{file_stem(session.scene.name)}.png")
    save_image_of(path, session.scene, size=size, smooth=smooth)
    width, height = size
    session.tell(f"saved {path.name}: {width}x{height}, smoothness {smooth}")


def save_image(session: Session) -> None:
    """Save the picture alone, with the legend of a scalar, as the next screenshot."""
    session.studio.refine()
    save_screenshot(session, shown_colors(session.studio.display_image))


def save_screenshot(session: Session, colors: Bytes) -> None:
    """Save (lines, elements, 3) colors as the next screenshot, "autocolor-0001.png"."""
    from ramtek_emu.png import png_bytes
    from ramtek_emu.writing import PNG, write_numbered

    path = write_numbered(png_bytes(colors), shown_folder(session), "autocolor", PNG)
    session.tell(f"saved {path}")


def unsaved_changes(session: Session) -> str:
    """The changes that leaving the program would lose, and how to save them; empty without changes."""
    history = session.studio.history
    if session.outlives_window:
        return ""
    if history.is_changed:
        return "not saved: Ctrl+S saves" if session.has_keyboard else "not saved: save it"
    if history.left_unsaved:
        return f"{short_name(history.left_unsaved[-1], LONGEST_NAME)} is not saved: undo goes back to it"
    if history.unsaved_variants:
        return f"variant {history.unsaved_variants[-1]} is not saved: come back to it and save it"
    return ""


def ask_to_leave(session: Session) -> None:
    """Ask to leave the program. Unsaved changes are announced first, and lost at the next attempt."""
    unsaved = unsaved_changes(session)
    if unsaved and session.refused_to_leave is not session.scene:
        session.refused_to_leave = session.scene
        session.warn(f"{unsaved}, or leave once more to discard the changes")
    else:
        session.leaves = True


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
