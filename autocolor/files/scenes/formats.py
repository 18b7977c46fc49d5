"""The registry of file formats that hold a whole scene.

To add a format, put a module that calls `register` beside this one; nothing else needs to change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Protocol

from autocolor.files.registry import Registry, format_named, suffixes_of
from autocolor.files.scene_report import SceneReport
from autocolor.scene.creation import MATERIALS, SurfaceSource


class SceneReader(Protocol):
    """A function that reads a scene."""

    def __call__(
        self, path: Path, *, outside: bool = False, surfaces: SurfaceSource = MATERIALS
    ) -> SceneReport:
        """The scene of a file. With `outside`, it may name files outside its folder. Raises InputError.

        `surfaces` tells where the surfaces of parts come from that the file names none for.
        """
        ...


@dataclass(frozen=True)
class SceneFormat:
    """One scene file format.

    `suffixes` are those of its files, in lower case. A folder that contains the file `in_folder` is a scene
    of this format. `begins` tells from the first bytes of a file whether it may have this format.
    """

    name: str
    read: SceneReader
    suffixes: tuple[str, ...]
    in_folder: str | None = None
    begins: Callable[[bytes], bool] | None = None


REGISTRY: Final = Registry[SceneFormat](__name__.rpartition(".")[0])


def register(scene_format: SceneFormat) -> SceneFormat:
    """Add a format to the registry; returns it."""
    return REGISTRY.register(scene_format)


def scene_formats() -> tuple[SceneFormat, ...]:
    """All registered formats, sorted by name."""
    return REGISTRY.formats()


def scene_suffixes() -> tuple[str, ...]:
    """The suffixes of all formats."""
    return suffixes_of(scene_formats())


def scene_format_named(path: Path) -> SceneFormat | None:
    """The format with the suffix of the path; None if there is none."""
    return format_named(path, scene_formats())
