"""The registry of file formats that hold a whole scene.

To add a format, put a module that calls `register` beside this one; nothing else needs to change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final, Protocol

from autocolor.files.modules import import_modules_of
from autocolor.files.reading import read_head
from autocolor.files.scenes.scene_report import SceneReport
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


_REGISTERED: Final[list[SceneFormat]] = []


def register(scene_format: SceneFormat) -> SceneFormat:
    """Add a format to the registry; returns it."""
    _REGISTERED.append(scene_format)
    return scene_format


@cache
def scene_formats() -> tuple[SceneFormat, ...]:
    """All registered formats, sorted by name."""
    import_modules_of(__name__.rpartition(".")[0])
    return tuple(sorted(_REGISTERED, key=lambda each: each.name))


def scene_suffixes() -> tuple[str, ...]:
    """The suffixes of all formats."""
    return tuple(suffix for each in scene_formats() for suffix in each.suffixes)


def scene_format_named(path: Path) -> SceneFormat | None:
    """The format with the suffix of the path; None if there is none."""
    return next((each for each in scene_formats() if path.suffix.lower() in each.suffixes), None)


def scene_format_within(path: Path) -> SceneFormat | None:
    """The format that the first bytes of the file indicate; None if there is none."""
    head = read_head(path)
    return next((each for each in scene_formats() if each.begins is not None and each.begins(head)), None)
