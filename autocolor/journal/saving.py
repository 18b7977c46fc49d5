"""Saving a session by Ctrl+S: its scene and its picture, under names that the program chooses.

A scene that was opened from a scene file or a store, or a picture that was opened from a picture file, is
saved to that file, unless another program changed the file since. Content that the session did not write is
first copied to a backup beside the file, under a numbered name. Otherwise new files are made in a folder:
`coupe/scene.toml` and `coupe.npz`, or `coupe-2/scene.toml` and `coupe-2.npz` if one of those exists. Later
saves overwrite these files, unless another program changed them since. A name that the user gives is for new
files alone.
"""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import NamedTuple

from autocolor.errors import OutputError
from autocolor.files.paths import (
    PICTURE_SUFFIX,
    SCENE_FILE,
    STORE_SUFFIXES,
    check_stem,
    file_stem,
    free_path,
)
from autocolor.files.picture_file import write_picture
from autocolor.files.scene_writing import write_scene
from autocolor.files.stamps import stamp_of
from autocolor.files.writing import write_atomically
from autocolor.journal.history import History, is_picture
from autocolor.journal.places import NO_STAMP, OnDisk
from autocolor.lighting.picture import Picture


class SavedFiles(NamedTuple):
    """The scene file and the picture file that were saved, and the `backups` of their old contents.

    `changed` are files that another program changed: they were left alone, and new names were chosen.
    """

    scene: Path
    picture: Path
    backups: tuple[Path, ...] = ()
    changed: tuple[Path, ...] = ()

    def message(self, folder: Path) -> str:
        """One sentence about the files. Files in the folder are named without it."""

        def names(*paths: Path) -> str:
            return " and ".join(
                str(path.relative_to(inside) if path.is_relative_to(inside) else path) for path in paths
            )

        inside = os.path.abspath(folder)
        text = f"saved {names(self.scene, self.picture)}"
        if self.backups:
            text += f"; what was there is in {names(*self.backups)}"
        if self.changed:
            text += f"; {names(*self.changed)} was changed since, and is left alone"
        return text


class _Targets(NamedTuple):
    """The files to save to, and which of them are overwritten. `changed` files are left alone."""

    scene: Path
    picture: Path
    overwritten: tuple[Path, ...]
    changed: tuple[Path, ...]


def save_session(history: History, picture: Picture, folder: Path, name: str | None = None) -> SavedFiles:
    """Save the current scene of a session and its picture, and mark the scene as saved.

    New files are made in `folder`. With a `name`, both files are new files of this name; see `new_files`. If
    it raises OutputError or WriteError, no file is lost.
    """
    targets = _targets(history, folder) if name is None else _Targets(*new_files(folder, name), (), ())
    scene_file, picture_file, overwritten, changed = targets
    guard, backups = history.on_disk.guard, list[Path]()
    try:
        for path in overwritten:
            file = history.on_disk[str(path)]
            if file is None or not file.is_own:
                backups.append(_backup_of(path))
        overwrite = picture_file in overwritten
        write_picture(picture_file, history.scene, picture, overwrite=overwrite, guard=guard)
    except BaseException:
        # No file was written yet, so backups are not needed.
        for path in backups:
            path.unlink(missing_ok=True)
        raise
    # If writing the scene fails, the picture is still known to be ours.
    written = OnDisk(history.scene, stamp_of(picture_file) or NO_STAMP, is_own=True)
    history.on_disk.note(str(picture_file), written)
    overwrite = scene_file in overwritten
    write_scene(scene_file, history.scene, overwrite=overwrite, guard=guard)
    history.mark_saved({str(path): stamp_of(path) or NO_STAMP for path in (scene_file, picture_file)})
    return SavedFiles(scene_file, picture_file, tuple(backups), changed)


def _targets(history: History, folder: Path) -> _Targets:
    """The files to save to. A file that nobody else changed since we read or wrote it is overwritten."""
    # The scene file by False, the picture file by True.
    unchanged: dict[bool, Path] = {}
    changed = []
    for name in history.files:
        path = Path(name)
        if history.on_disk.was_changed(name):
            changed.append(path)
        elif os.path.exists(name) and _is_writable(path):
            unchanged[is_picture(name)] = path
    scene, picture = _new_names(history.scene.name, folder, False in unchanged, True in unchanged)
    return _Targets(
        unchanged.get(False, scene),
        unchanged.get(True, picture),
        tuple(unchanged[kind] for kind in sorted(unchanged)),
        tuple(changed),
    )


def free_name(name: str, folder: Path) -> str:
    """The name of a scene, with a number if a scene or a picture in the folder has that name."""
    return _new_names(name, folder, False, False)[0].parent.name


def new_files(folder: Path, name: str) -> tuple[Path, Path]:
    """The scene file and the picture file of a name, neither of which exists.

    Raises UsageError for an invalid name, OutputError if a file has it.
    """
    check_stem(name)
    path = Path(os.path.abspath(folder)) / name
    picture = path.with_name(f"{name}{PICTURE_SUFFIX}")
    for each in (path, picture):
        if os.path.lexists(each):
            raise OutputError(
                f"a new file must have a name of its own, and {each.name} exists; choose another"
            )
    return path / SCENE_FILE, picture


def _new_names(name: str, folder: Path, has_scene: bool, has_picture: bool) -> tuple[Path, Path]:
    """A scene file and a picture file with the same name, which is free for the files that are needed."""
    stem = file_stem(name)
    for number in count(1):
        path = Path(os.path.abspath(folder)) / (stem if number == 1 else f"{stem}-{number}")
        picture = path.with_name(f"{path.name}{PICTURE_SUFFIX}")
        is_free = has_scene or not os.path.lexists(path)
        if is_free and (has_picture or not os.path.lexists(picture)):
            break
    return path / SCENE_FILE, picture


def _backup_of(path: Path) -> Path:
    """Copy a file to a free numbered name beside it; returns the copy."""
    backup = free_path(path)
    if path.suffix.lower() in STORE_SUFFIXES:
        # SQLite is loaded for stores alone. The latest changes may be beside the store, in its log.
        from autocolor.files.store.connections import store_content

        data = store_content(path)
    else:
        data = path.read_bytes()
    write_atomically(backup, data, overwrite=False)
    return backup


def _is_writable(path: Path) -> bool:
    return os.access(path, os.W_OK) and os.access(path.parent, os.W_OK)
