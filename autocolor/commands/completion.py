"""Completion in a shell by click: the names and keys in the scene or the picture of the command line.

A shell asks at each press of Tab, so large scenes are not read. If the scene cannot be read, nothing is
completed, without a message.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

if TYPE_CHECKING:
    from autocolor.scene.scene import Scene

LARGEST_SCENE: Final = 16 << 20
"""Limit: bytes of the files of a scene that is read for completion. Measured: less than a second."""

Complete = Callable[[click.Context, click.Parameter, str], list[str]]
"""A function that completes the value of a parameter, as click calls it."""


def _completing(candidates: Callable[[click.Context, str], Iterable[str]]) -> Complete:
    """The function for click that returns the candidates which begin with the incomplete word."""

    @wraps(candidates)
    def completed(context: click.Context, _: click.Parameter, incomplete: str) -> list[str]:
        try:
            return [each for each in candidates(context, incomplete) if each.startswith(incomplete)]
        except Exception:
            # The command itself will report the error. A message here would garble the command line.
            return []

    return completed


def _names_in(table: str) -> Complete:
    """The completion of the name of a row in a table of the scene."""
    return _completing(lambda context, _: [row.name for row in vars(_scene(context))[table]])


complete_lights = _names_in("lights")
complete_views = _names_in("views")
complete_surfaces = _names_in("surfaces")


@_completing
def complete_settings(context: click.Context, incomplete: str) -> Iterable[str]:
    """The keys of `--set`, or the values of a whole key."""
    from autocolor.commands.settings import settings_after

    return settings_after(_scene(context), incomplete)


@_completing
def complete_colors(_: click.Context, incomplete: str) -> Iterable[str]:
    """The names of colors."""
    from autocolor.scene.kinds import color_names

    return color_names()


def _scene(context: click.Context) -> Scene:
    """The scene on the command line. Raises an exception if it is missing or its files are too large."""
    from autocolor.files.opening import read_scene_with_report

    given = context.params
    # While the value of an option is incomplete, click has not assigned the arguments.
    path = Path(given.get("scene") or given.get("picture") or context.args[0])
    files = [file for file in path.iterdir() if file.is_file()] if path.is_dir() else [path]
    if sum(file.stat().st_size for file in files) > LARGEST_SCENE:
        raise ValueError
    options = {name: given[name] for name in ("up", "scale", "surfaces") if given.get(name)}
    return read_scene_with_report(path, **options).scene
