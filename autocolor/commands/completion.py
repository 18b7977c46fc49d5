"""Completion in a shell: scene and picture files, and the names and keys in the scene of the command line.

A shell asks at each press of Tab, so large scenes are not read. If the scene cannot be read, nothing is
completed, without a message.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import wraps
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

if TYPE_CHECKING:
    from autocolor.scene.scene import Scene

LARGEST_SCENE: Final = 16 << 20
"""Limit: bytes of the files of a scene that is read for completion. Measured: less than a second."""

MOST_ENTRIES: Final = 10_000
"""Limit: entries of a folder that are read."""

Complete = Callable[[click.Context, click.Parameter, str], list[str]]
"""A function that completes the value of a parameter, as click calls it."""


def _silent(complete: Complete) -> Complete:
    """The function, but if it fails, it completes nothing."""

    @wraps(complete)
    def completed(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
        try:
            return complete(context, parameter, incomplete)
        except Exception:
            # The command itself will report the error. A message here would garble the command line.
            return []

    return completed


@_silent
def complete_scenes(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """Folders with a scene, scene files, mesh files and picture files."""
    from autocolor.files.formats import suffixes_of
    from autocolor.files.opening import FILES, FOLDER, kind_of

    def is_scene(folder: str) -> bool:
        return kind_of(Path(folder)) != FOLDER

    suffixes = suffixes_of(FILES)
    return narrowed(incomplete, _folder_of(incomplete), lambda start: _entries(start, suffixes, is_scene))


@_silent
def complete_pictures(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """Picture files."""

    def pictures(start: str) -> list[str]:
        return _entries(start, (".npz",), lambda _: False)

    return narrowed(incomplete, _folder_of(incomplete), pictures)


@_silent
def complete_lights(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """The names of the lights of the scene on the command line."""
    return [light.name for light in _scene(context).lights if light.name.startswith(incomplete)]


@_silent
def complete_views(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """The names of the named views of the scene on the command line."""
    return [row.name for row in _scene(context).views if row.name.startswith(incomplete)]


@_silent
def complete_surfaces(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """The names of the surfaces of the scene or picture on the command line."""
    return [surface.name for surface in _scene(context).surfaces if surface.name.startswith(incomplete)]


@_silent
def complete_settings(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """The keys of `--set` for the scene on the command line, or the values of a whole key."""
    from autocolor.commands.settings import keys_after

    scene = _scene(context)

    def after(start: str) -> list[str]:
        return keys_after(scene, start)

    return narrowed(incomplete, _start_of_key(incomplete, after), after)


@_silent
def complete_colors(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """The names of colors."""
    from autocolor.scene.kinds import color_names

    return [name for name in color_names() if name.startswith(incomplete.lower())]


def narrowed(incomplete: str, start: str, after: Callable[[str], Sequence[str]]) -> list[str]:
    """The candidates that begin with the incomplete word, among those that `after` returns for a start.

    A candidate that ends in "/", "." or "=" is a start itself. A shell puts a space after a single candidate,
    so a single start is replaced by the candidates after it.

    >>> narrowed("a", "", lambda start: ["a.", "b="] if start == "" else ["a.x=", "a.y="])
    ['a.x=', 'a.y=']
    """
    candidates = [candidate for candidate in after(start) if candidate.startswith(incomplete)]
    while len(candidates) == 1 and candidates[0][-1] in "/.=" and (inside := after(candidates[0])):
        if candidates[0].endswith("="):
            return [*candidates, *inside]
        candidates = list(inside)
    return candidates


def _start_of_key(incomplete: str, after: Callable[[str], Sequence[str]]) -> str:
    """The longest start that an incomplete key begins with. Names in a key may contain periods."""
    start, longer = "", [""]
    while longer:
        start = max(longer, key=len)
        longer = [key for key in after(start) if key[-1] in ".=" and incomplete.startswith(key)]
    return start


def _folder_of(incomplete: str) -> str:
    """The folder in an incomplete path, with its slash; "" for the current folder."""
    return incomplete[: incomplete.rfind("/") + 1]


def _entries(start: str, suffixes: tuple[str, ...], is_scene: Callable[[str], bool]) -> list[str]:
    """The files with a suffix in a folder, and its folders; a folder that is not a scene ends in "/"."""
    paths = []
    with os.scandir(start or ".") as entries:
        for entry in islice(entries, MOST_ENTRIES):
            if entry.name.startswith("."):
                continue
            if entry.is_dir():
                paths.append(f"{start}{entry.name}{'' if is_scene(entry.path) else '/'}")
            elif entry.name.lower().endswith(suffixes):
                paths.append(f"{start}{entry.name}")
    return sorted(paths)


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
