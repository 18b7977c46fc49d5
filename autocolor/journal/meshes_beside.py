"""The meshes that a session changed, saved beside its journal, each in a scene of its own."""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import Final

from autocolor.errors import InputError
from autocolor.files.mesh_sources import source_of
from autocolor.files.paths import SCENE_FILE
from autocolor.files.scene_writing import write_scene
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene

SCENE_STEM: Final = "scene"


class MeshesBeside:
    """The folders of the scenes that hold changed meshes, each written when it is first asked for.

    `folder` is that of the journal, None if nothing may be written.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        self._paths: dict[Mesh, Path] = {}

    def path_of(self, scene: Scene) -> Path:
        """The folder of a scene with the mesh of this one.

        Raises InputError if there is no folder to write to; OutputError or WriteError if writing fails.
        """
        if self._folder is None:
            raise InputError(
                "a mesh that a session changed must be saved beside its journal, and no folder is named for"
                " it; name one with beside="
            )
        if scene.mesh not in self._paths:
            self._paths[scene.mesh] = _there(self._folder, scene.mesh) or _written(self._folder, scene)
        return self._paths[scene.mesh]


def _there(folder: Path, mesh: Mesh) -> Path | None:
    """The folder from which a mesh was read, if it is beside the journal already."""
    source = source_of(mesh)
    if source is None or source.scene_file is None or source.folder.parent != folder.resolve():
        return None
    return folder / source.folder.name


def _written(folder: Path, scene: Scene) -> Path:
    """Write a scene to a folder of a free name."""
    os.makedirs(folder, exist_ok=True)
    for number in count(2):
        path = folder / f"{SCENE_STEM}-{number}"
        if not os.path.lexists(path):
            break
    write_scene(path / SCENE_FILE, scene)
    return path
