"""Formats that a whole scene comes in: a registry that each format enters where it is defined.

A format is a module beside this one that calls `register`; nothing else names it.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Final, Protocol

from autocolor.files.reading import read_head
from autocolor.files.scenes.scene_report import SceneReport


class SceneReader(Protocol):
    """Reads a scene."""

    def __call__(self, path: Path, *, outside: bool = False) -> SceneReport:
        """The scene of a file; `outside` allows it to name files outside its folder. Raises InputError."""
        ...


@dataclass(frozen=True)
class SceneFormat:
    """One format.

    `suffixes` are how the names of its files end, in small letters; `in_folder` is the file that makes a
    folder a scene. `begins` tells by a file's first bytes whether it may be one.
    """

    name: str
    read: SceneReader
    suffixes: tuple[str, ...]
    in_folder: str | None = None
    begins: Callable[[bytes], bool] | None = None


_REGISTERED: Final[list[SceneFormat]] = []


def register(scene_format: SceneFormat) -> SceneFormat:
    """Enter a format."""
    _REGISTERED.append(scene_format)
    return scene_format


@cache
def scene_formats() -> tuple[SceneFormat, ...]:
    """Every format, in the order of their names."""
    package = import_module(__name__.rpartition(".")[0])
    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        import_module(module.name)
    return tuple(sorted(_REGISTERED, key=lambda each: each.name))


def scene_suffixes() -> tuple[str, ...]:
    """How the names of scene files end."""
    return tuple(suffix for each in scene_formats() for suffix in each.suffixes)


def scene_format_named(path: Path) -> SceneFormat | None:
    """The format that the end of a file's name says; None for no known one."""
    return next((each for each in scene_formats() if path.suffix.lower() in each.suffixes), None)


def scene_format_within(path: Path) -> SceneFormat | None:
    """The format that a file begins as; None for no known one."""
    head = read_head(path)
    return next((each for each in scene_formats() if each.begins is not None and each.begins(head)), None)
