"""Saving a session by Ctrl+S: its scene and its picture, under names that the program chooses.

A scene that was opened from a scene file or a store, or a picture that was opened from a picture file, is
saved to that file, unless another program changed the file since. The first time, the old content is copied
to a backup beside the file, under a numbered name. Otherwise new files are made in a folder:
`coupe/scene.toml` and `coupe.npz`, or `coupe-2/scene.toml` and `coupe-2.npz` if one of those exists. Later
saves overwrite these files, unless another program changed them since.
"""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import NamedTuple

from autocolor.files.paths import PICTURE_SUFFIX, SCENE_FILE, file_stem, free_path
from autocolor.files.picture_file import write_picture
from autocolor.files.scene_writing import write_scene
from autocolor.files.writing import write_atomically
from autocolor.journal.history import History
from autocolor.journal.places import file_of, stamp_of
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
    """The files to save to, with the stamps that they must still have. A new file has the stamp None."""

    scene: tuple[Path, str | None]
    picture: tuple[Path, str | None]
    changed: tuple[Path, ...]


def save_session(history: History, picture: Picture, folder: Path) -> SavedFiles:
    """Save the current scene of a session and its picture, and mark the scene as saved.

    New files are made in `folder`. If it raises OutputError or WriteError, no file is lost.
    """
    (scene_file, scene_stamp), (picture_file, picture_stamp), changed = _targets(history, folder)
    own = history.saved.files
    backups: list[Path] = []
    try:
        for path, stamp in ((scene_file, scene_stamp), (picture_file, picture_stamp)):
            if stamp is not None and str(path) not in own:
                backups.append(_backup_of(path))
        write_picture(picture_file, picture, history.scene, overwrite=picture_stamp is not None)
    except BaseException:
        # No file was written yet, so backups are not needed.
        for path in backups:
            path.unlink(missing_ok=True)
        raise
    write_scene(scene_file, history.scene, overwrite=scene_stamp is not None)
    history.mark_saved({str(path): stamp_of(path) or "" for path in (scene_file, picture_file)})
    return SavedFiles(scene_file, picture_file, tuple(backups), changed)


def _targets(history: History, folder: Path) -> _Targets:
    """The files to save to. A file that nobody else changed since our last save is overwritten."""
    last = [(Path(path), stamp) for path, stamp in history.saved.files.items()]
    place = history.place
    if not last and place.source is not None and place.stamp is not None:
        path = file_of(place.source)
        last = [] if path is None else [(Path(os.path.abspath(path)), place.stamp)]
    # The scene file by False, the picture file by True.
    unchanged: dict[bool, tuple[Path, str]] = {}
    changed = []
    for path, stamp in last:
        if stamp_of(path) == stamp and _is_writable(path):
            unchanged[path.suffix.lower() == PICTURE_SUFFIX] = path, stamp
        elif os.path.lexists(path) and stamp_of(path) != stamp:
            changed.append(path)
    scene, picture = _new_names(history.scene.name, folder, False in unchanged, True in unchanged)
    return _Targets(unchanged.get(False, (scene, None)), unchanged.get(True, (picture, None)), tuple(changed))


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
    write_atomically(backup, path.read_bytes(), overwrite=False)
    return backup


def _is_writable(path: Path) -> bool:
    return os.access(path, os.W_OK) and os.access(path.parent, os.W_OK)
