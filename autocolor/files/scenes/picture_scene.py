"""Picture files as a scene format: reading the scene that was saved with a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from autocolor.files.picture_file import read_picture
from autocolor.files.scene_report import SceneReport
from autocolor.files.scenes.formats import SceneFormat, register
from autocolor.scene.creation import MATERIALS, SurfaceSource


def read_picture_scene(
    path: Path, *, outside: bool = False, surfaces: SurfaceSource = MATERIALS
) -> SceneReport:
    """The scene of a picture file, which is complete: the options have no effect. Raises InputError."""
    return SceneReport(read_picture(path).scene)


PICTURE_FILE: Final = register(
    SceneFormat(
        "picture file", read_picture_scene, (".npz",), begins=lambda head: head.startswith(b"PK\x03\x04")
    )
)
