"""Paths of files that a scene file names: within the scene's folder, and never from a network."""

from __future__ import annotations

import os
from pathlib import Path, PureWindowsPath
from typing import Final

from autocolor.files.reading import shown

SCENE_FILE: Final = "scene.toml"
"""The name of the scene file in a scene's folder."""


def path_within(problems: list[str], folder: Path, name: str, *, outside: bool = False) -> Path | None:
    """The path of a file named in a scene file; None if it is refused, with the reason added to `problems`.

    The path must be within the folder, also after symbolic links are resolved, unless `outside` is true.
    """
    if not name or not name.isprintable():
        problems.append(f"must be the name of a file, not {shown(name)}; correct it")
    elif "://" in name or name.startswith("file:"):
        problems.append(
            f"must be the name of a file, not the address {shown(name)}; fetch it and name the file"
        )
    elif outside:
        return folder / name
    elif "\\" in name:
        problems.append(f"must have / between folders, not \\ as in {shown(name)}; correct it")
    elif os.path.isabs(name) or PureWindowsPath(name).drive or ".." in name.split("/"):
        problems.append(
            f"must be the name of a file in the scene's folder, not {shown(name)}; copy the file there"
        )
    elif not _is_within(folder, folder / name):
        problems.append(
            f"must be a file in the scene's folder, not a link to one outside like {shown(name)};"
            " copy the file there"
        )
    else:
        return folder / name
    return None


def _is_within(folder: Path, path: Path) -> bool:
    try:
        real_folder, real = os.path.realpath(folder), os.path.realpath(path)
        return os.path.commonpath([real_folder, real]) == real_folder
    except (OSError, ValueError):
        return False
