"""What a scene is written as: one format, what it holds beside nodes and polygons, and how it is written."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from autocolor.files.meshes.formats import HELD
from autocolor.scene.scene import Scene

SURFACES: Final = "surfaces"
LIGHTS: Final = "lights"
VIEW: Final = "view"
SETTINGS: Final = "settings"
WHOLE_SCENE: Final = frozenset((*HELD, SURFACES, LIGHTS, VIEW, SETTINGS))
"""What a format holds that holds a whole scene."""

SceneWriter = Callable[[Path, Scene, bool], list[Path]]
"""A function that writes a scene to a path, and overwrites what is there if that is allowed.

It returns the files that it wrote, and raises OutputError or WriteError, with nothing left half written."""


@dataclass(frozen=True)
class Output:
    """One format that a scene is written in.

    `suffixes` are those of its file, or of its folder; `in_folder` are the names of the files of a folder.
    `holds` is what is read back from it, of WHOLE_SCENE.
    """

    name: str
    suffixes: tuple[str, ...]
    write: SceneWriter
    holds: frozenset[str] = WHOLE_SCENE
    in_folder: tuple[str, ...] = ()
