"""The files of a folder that can be opened: scenes, stores, meshes, pictures, paints, and further folders.

Kinds are recognized by names alone, which is quick: listing a folder opens no file. So CSV files are not
listed, neither as tables of a mesh nor as paints.
"""

from __future__ import annotations

import os
import re
from itertools import islice
from pathlib import Path
from typing import Final, NamedTuple

from autocolor.errors import InputError, reason_of
from autocolor.files.formats import format_named, format_of_folder, mesh_suffixes
from autocolor.files.palette_file import GPL
from autocolor.files.paths import SCENE_FILE
from autocolor.files.scene_sources import SCENE_FORMATS

FOLDER: Final = "folder"
MESH: Final = "mesh"
PAINTS: Final = "paints"

MOST_LISTED: Final = 1000
"""Limit: the names that are listed of a folder; nobody finds a file in a longer list."""


class Openable(NamedTuple):
    """A path, and its kind: "scene", "store", "picture", "mesh", "paints" or "folder"."""

    path: Path
    kind: str


def openables_of(folder: Path) -> list[Openable]:
    """The files of a folder that can be opened, then its folders, by name; hidden names are left out.

    At most MOST_LISTED names of a folder are read. Raises InputError if the folder cannot be read.
    """
    try:
        with os.scandir(folder) as listed:
            names = [entry.name for entry in islice(listed, MOST_LISTED)]
    except OSError as error:
        raise InputError(
            f"{folder.name or folder}: a folder must be readable, and is not ({reason_of(error)});"
            " choose another"
        ) from None
    paths = [folder / name for name in sorted(names, key=_in_order) if not name.startswith(".")]
    openables = [Openable(path, kind) for path in paths if (kind := kind_of(path))]
    return sorted(openables, key=lambda openable: openable.kind == FOLDER)


def kind_of(path: Path) -> str:
    """The kind of a path, as in `Openable`; empty if it cannot be opened, or does not exist."""
    try:
        if path.is_dir():
            if (path / SCENE_FILE).is_file():
                return "scene"
            return FOLDER if format_of_folder(path) is None else MESH
        if not path.is_file():
            return ""
    except OSError:
        return ""
    scene_format = format_named(path, SCENE_FORMATS)
    if scene_format is not None:
        return scene_format.name.removesuffix(" file")
    if path.suffix.lower() == GPL:
        return PAINTS
    return MESH if path.suffix.lower() in mesh_suffixes() else ""


def stays_within(path: Path, folder: Path) -> bool:
    """Whether a path, and the files to read first when it is opened, are in a folder, links resolved."""
    real = os.path.realpath(folder)
    read = [path]
    if path.is_dir():
        mesh_format = format_of_folder(path)
        names = () if mesh_format is None else mesh_format.in_folder
        read += [path / name for name in (SCENE_FILE, *names)]
    return all(Path(os.path.realpath(file)).is_relative_to(real) for file in read)


def _in_order(name: str) -> list[tuple[int, str]]:
    """The sort key of a name: car2 comes before car10."""
    parts = re.split(r"(\d+)", name.casefold())
    return [(int(part), "") if part.isdecimal() and part.isascii() else (0, part) for part in parts]
