"""Saving a session: its scene and its picture, under names that are found and told.

A scene that was opened from a scene file or a store, or a picture that was opened from a picture file, is
saved to that file, if it still holds what was opened; what it held is kept beside it under a numbered name.
All else is saved to new files in a folder: `coupe/scene.toml` and `coupe.npz`, or `coupe-2/scene.toml` and
`coupe-2.npz` if one of those exists. After that the same names are saved to again, unless the files were
changed since.
"""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import NamedTuple

from autocolor.files.paths import SCENE_FILE
from autocolor.files.picture_file import write_picture
from autocolor.files.scene_writing import write_scene
from autocolor.files.writing import file_stem, free_path, write_atomically
from autocolor.journal.history import History
from autocolor.journal.places import PICTURE_SUFFIX, file_of, stamp_of
from autocolor.lighting.picture import Picture


class SavedFiles(NamedTuple):
    """The files that were saved: the scene file and the picture file.

    `kept` are those that hold what these two held before; `changed` are those that were changed since they
    were opened or saved, so that new names were taken.
    """

    scene: Path
    picture: Path
    kept: tuple[Path, ...] = ()
    changed: tuple[Path, ...] = ()

    def told(self, folder: Path) -> str:
        """What was saved in one sentence, with names as they are seen from a folder."""

        def names(paths: tuple[Path, ...]) -> str:
            return " and ".join(_seen_from(folder, path) for path in paths)

        text = f"saved {names((self.scene, self.picture))}"
        if self.kept:
            text += f"; what was there is in {names(self.kept)}"
        if self.changed:
            text += f"; {names(self.changed)} was changed since, and is left alone"
        return text


class _Targets(NamedTuple):
    """The files to save to with the stamps that they must have; a stamp of None is for a new file."""

    scene: tuple[Path, str | None]
    picture: tuple[Path, str | None]
    changed: tuple[Path, ...]


def save_session(history: History, picture: Picture, folder: Path) -> SavedFiles:
    """Save the current scene of a session and its picture, and mark the scene as saved.

    `folder` is where new files are made. Raises OutputError or WriteError; no file is lost then.
    """
    (scene_file, scene_stamp), (picture_file, picture_stamp), changed = _targets(history, folder)
    own = history.saved.files
    kept: list[Path] = []
    try:
        for path, stamp in ((scene_file, scene_stamp), (picture_file, picture_stamp)):
            if stamp is not None and str(path) not in own:
                kept.append(_copied(path))
        write_picture(picture_file, picture, history.scene, overwrite=picture_stamp is not None)
    except BaseException:
        # Nothing was changed, so the copies are of no use.
        for path in kept:
            path.unlink(missing_ok=True)
        raise
    write_scene(scene_file, history.scene, overwrite=scene_stamp is not None)
    history.mark_saved({str(path): stamp_of(path) or "" for path in (scene_file, picture_file)})
    return SavedFiles(scene_file, picture_file, tuple(kept), changed)


def _targets(history: History, folder: Path) -> _Targets:
    """The files to save to: those from before as far as they are still as they were, and new ones."""
    known = [(Path(path), stamp) for path, stamp in history.saved.files.items()]
    place = history.place
    if not known and place.source is not None and place.stamp is not None:
        path = file_of(place.source)
        known = [] if path is None else [(Path(os.path.abspath(path)), place.stamp)]
    same: dict[bool, tuple[Path, str]] = {}
    changed = []
    for path, stamp in known:
        if stamp_of(path) == stamp and _is_writable(path):
            same[path.suffix.lower() == PICTURE_SUFFIX] = path, stamp
        elif os.path.lexists(path) and stamp_of(path) != stamp:
            changed.append(path)
    scene, picture = _new_names(history.scene.name, folder, False in same, True in same)
    return _Targets(same.get(False, (scene, None)), same.get(True, (picture, None)), tuple(changed))


def _new_names(name: str, folder: Path, has_scene: bool, has_picture: bool) -> tuple[Path, Path]:
    """A scene file and a picture file of one name, those of which that are needed free."""
    stem = file_stem(name)
    for number in count(1):
        path = Path(os.path.abspath(folder)) / (stem if number == 1 else f"{stem}-{number}")
        picture = path.with_name(f"{path.name}{PICTURE_SUFFIX}")
        is_free = has_scene or not os.path.lexists(path)
        if is_free and (has_picture or not os.path.lexists(picture)):
            break
    return path / SCENE_FILE, picture


def _copied(path: Path) -> Path:
    """Copy a file to a numbered name beside it that is free; returns that."""
    other = free_path(path)
    write_atomically(other, path.read_bytes(), overwrite=False)
    return other


def _is_writable(path: Path) -> bool:
    return os.access(path, os.W_OK) and os.access(path.parent, os.W_OK)


def _seen_from(folder: Path, path: Path) -> str:
    """A path as it is seen from a folder; whole if it is not in it."""
    try:
        return str(path.relative_to(os.path.abspath(folder)))
    except ValueError:
        return str(path)
