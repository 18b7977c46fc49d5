"""What the user does with files: open, read again, save, export, leave; and changes by other programs."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Final

from autocolor.arrays import Bytes
from autocolor.errors import InputError, UsageError
from autocolor.files.opening import MESH, RIG, hinted_up, kind_of, stays_within
from autocolor.files.palette_file import Palette, is_palette, read_palette
from autocolor.files.paths import file_stem, free_path, is_example
from autocolor.files.rig_file import RIG_SUFFIX, read_rig, write_rig
from autocolor.files.stamps import look_at
from autocolor.files.state import note_file
from autocolor.journal.autosave import Autosave, newest_session
from autocolor.screens.session import MIXING, PICTURE, Session
from autocolor.sending import shown_colors
from autocolor.widgets.items import fitted

LONGEST_NAME: Final = 24
"""Assumed: letters of a scene's name in a message that must also say what to do."""


def seeming_up(session: Session) -> str:
    """The axis that seems to be up in the mesh file that was opened; empty if the mesh seems to stand."""
    source, mesh = session.studio.history.place.source, session.scene.mesh
    if source is None or source.up != "z":
        return ""
    return session.seeming_up.of(lambda: hinted_up(source.path, mesh), mesh, source)


def remark(session: Session) -> str:
    """What to know about the file that was opened: its first repair, or that it seems to lie on its side."""
    repairs = session.studio.history.place.repairs
    if not repairs:
        return "lies on its side? the menu turns it" if seeming_up(session) else ""
    return repairs[0] + (f" (and {len(repairs) - 1} more)" if len(repairs) > 1 else "")


def stand_up(session: Session) -> None:
    """Read the mesh file again with the axis up that seems to be up, as one step to undo."""
    source, up = session.studio.history.place.source, seeming_up(session)
    if source is not None and up:
        session.studio.open(source.path, up=up, scale=source.scale, surfaces=source.surfaces)
        session.tell(f"read again with {up} up; undo goes back")


def open_file(session: Session, path: Path, as_example: bool = False) -> None:
    """Open a file or a folder as one step to undo: a scene, a mesh, a picture, or a rig of lights.

    The colors of a palette file become `paints`, which is no step, and color mixing shows them. A scene that
    is opened `as_example` is saved to new files, and is no recent file. Raises InputError or
    MissingInputError.
    """
    kind, studio = kind_of(path), session.studio
    if is_palette(path):
        bring_paints(session, read_palette(path), path.name)
        session.turn_to(MIXING)
        return
    if kind == RIG:
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
    before = studio.history.to_undo
    if kind == MESH:
        studio.open(path, up=session.mesh_up, scale=session.mesh_scale)
    else:
        studio.open(path)
    if as_example:
        studio.history.forget_files()
    else:
        note_file(path.resolve())
    is_repaired = bool(studio.history.place.repairs)
    back = "it is the present scene" if studio.history.to_undo == before else "undo goes back"
    parts = ["" if is_repaired else f"opened {path.name}", remark(session), back]
    session.tell("; ".join(filter(None, parts)), is_repaired)


def bring_paints(session: Session, paints: Palette, name: str) -> None:
    """Let the user take colors from the paints of a file of this name; they replace earlier paints."""
    session.paints, session.paints_name = paints, name
    count = "a paint" if len(paints) == 1 else f"{len(paints):,} paints"
    session.tell(f"{count} of {fitted(name, LONGEST_NAME)}: take them in color mixing")


def read_again(session: Session) -> None:
    """Read the scene's file again, as one step to undo. Raises UsageError or InputError."""
    is_other = session.studio.reopen()
    session.tell("read again; undo goes back" if is_other else "the file holds this scene")


def may_reach(session: Session, path: Path) -> bool:
    """Whether the user may open a path, or save in it.

    From elsewhere, no link may lead out of `root`; the example scenes can be opened.
    """
    return session.is_at_hand or is_example(path) or stays_within(path, session.root)


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


def recover(session: Session) -> None:
    """Go on with the newest session that was not closed; a session with unsaved changes is left in turn.

    Raises InputError, MissingInputError or WriteError.
    """
    studio, autosave = session.studio, session.autosave
    assert autosave is not None
    folder, recovered = newest_session()
    autosave.update(studio.history, at_once=True)
    other, unsaved = Autosave(folder), unsaved_changes(session)
    studio.go_on(recovered.history)
    if unsaved:
        autosave.leave()
    else:
        autosave.end()
    session.autosave = other
    back = "; recover again goes back" if unsaved else ""
    session.turn_to(PICTURE)
    session.tell(f"{session.scene.name} with all its steps{back}")


def unsaved_changes(session: Session) -> str:
    """The changes that leaving the program would lose, and how to save them; empty without changes."""
    history = session.studio.history
    if session.outlives_window:
        return ""
    if history.is_changed:
        return "not saved: Ctrl+S saves" if session.has_keyboard else "not saved: save it"
    if history.left_unsaved:
        return f"{fitted(history.left_unsaved[-1], LONGEST_NAME)} is not saved: undo goes back to it"
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
    """The file of a session's scene, and whether another program changed it."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._looked_at = time.monotonic()
        self._last_look: tuple[int | bytes, ...] | None = None
        self._is_refused = False
        """Whether the file had an error when it was last read."""

    def was_changed(self) -> bool:
        """Whether another program changed the file since the last call; it is looked at twice a second."""
        now, studio = time.monotonic(), self._session.studio
        if now - self._looked_at < SECONDS_BETWEEN:
            return False
        self._looked_at = now
        look = None if studio.file is None else look_at(studio.file)
        if look is None or look == self._last_look:
            return False
        self._last_look = look
        return self._is_refused or studio.history.on_disk.was_changed(str(studio.file))

    def take(self) -> bool:
        """Show the scene of the file, or ask whether to; returns False if nothing differs.

        Raises InputError if the file has an error; the scene stays as it was.
        """
        session, studio = self._session, self._session.studio
        assert studio.file is not None
        name, was_refused = studio.file.name, self._is_refused
        if studio.is_changed:
            message = f"{name} was changed elsewhere: Ctrl+R shows that, Ctrl+S saves yours beside"
        else:
            self._is_refused = True
            try:
                is_other = studio.reopen()
            except InputError as error:
                raise InputError(f"not shown: {problem}" for problem in error.problems) from None
            self._is_refused = False
            same = f"{name} holds this scene again" if was_refused else ""
            message = f"{name} was changed elsewhere; undo goes back" if is_other else same
        if message:
            session.tell(message, is_warning=studio.is_changed, persistent=True)
        return bool(message)
