"""Places: the file that a scene was opened from, and whether the scene may be saved to it again.

The edits of a scene belong to the place that was opened before them. Two openings of one file are two places.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NamedTuple

from autocolor.files.paths import SCENE_FILE
from autocolor.files.store.store_file import STORE_SUFFIXES
from autocolor.scene.creation import SurfaceSource

PACKAGE: Final = Path(__file__).resolve().parents[1]
"""The folder of this package, with the built-in demo; nothing is saved there."""

PICTURE_SUFFIX: Final = ".npz"


class Source(NamedTuple):
    """What a scene is read from, and how (see `read_scene`)."""

    path: str
    up: str = "z"
    surfaces: SurfaceSource = "materials"
    scale: float = 1.0


@dataclass(frozen=True, eq=False)
class Place:
    """What a scene was opened from; None if it was made in memory.

    `stamp` is that of the file then (see `stamp_of`); None if the scene is never saved to that file.
    """

    source: Source | None = None
    stamp: str | None = None


def place_of(source: Source) -> Place:
    """The place of a source as it is now. Files of this package, and mesh files, are never saved to."""
    path = file_of(source)
    if path is None or path.resolve().is_relative_to(PACKAGE):
        return Place(source)
    return Place(source, stamp_of(path))


def file_of(source: Source) -> Path | None:
    """The scene file, the store or the picture file of a source; None for a mesh."""
    path = Path(source.path)
    path = path / SCENE_FILE if path.is_dir() else path
    return path if path.suffix.lower() in (".toml", PICTURE_SUFFIX, *STORE_SUFFIXES) else None


def stamp_of(path: Path) -> str | None:
    """The SHA-256 of the bytes of a file, in hexadecimal digits; None if it cannot be read.

    Of a store, also of what was written beside it and not yet into it.
    """
    try:
        with open(path, "rb") as file:
            digest = hashlib.file_digest(file, "sha256")
        beside = Path(f"{path}-wal")
        if path.suffix.lower() in STORE_SUFFIXES and beside.exists():
            digest.update(beside.read_bytes())
    except OSError:
        return None
    return digest.hexdigest()
