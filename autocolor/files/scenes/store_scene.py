"""Stores as a scene format: a scene in one SQLite file."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from autocolor.files.scene_report import SceneReport
from autocolor.files.scenes.formats import SceneFormat, register
from autocolor.scene.creation import MATERIALS, SurfaceSource

BEGINS: Final = b"SQLite format 3\0"


def read_store_scene(
    path: Path, *, outside: bool = False, surfaces: SurfaceSource = MATERIALS
) -> SceneReport:
    """The scene of a store, which names no other files: `outside` has no effect. Raises InputError."""
    # SQLite is loaded for stores alone.
    from autocolor.files.store.store_file import read_store

    return read_store(path, surfaces=surfaces)


STORE: Final = register(
    SceneFormat("store", read_store_scene, (".sqlite", ".db"), begins=lambda head: head.startswith(BEGINS))
)
