"""Names and paths of files: fixed names and endings, the files that a scene file names, and new files."""

from __future__ import annotations

import os
from pathlib import Path, PureWindowsPath
from typing import Final

from autocolor.errors import UsageError
from autocolor.files.reading import shown

SCENE_FILE: Final = "scene.toml"
"""The name of the scene file in a scene's folder."""

PACKAGE: Final = Path(__file__).resolve().parents[1]
"""The folder of this package; nothing is saved there."""

DEMO: Final = "coupe"
EXAMPLES: Final = (DEMO, "bracket", "row", "pyramid")
EXAMPLE_PLACES: Final = (PACKAGE / "examples", PACKAGE.parent / "scenes")
"""Where the example scenes are: in the installed package, or in a checkout."""

STORE_SUFFIXES: Final = (".sqlite", ".db")
PICTURE_SUFFIX: Final = ".npz"

LONGEST_STEM: Final = 100
REFUSED: Final = frozenset('/\\:*?"<>|')
"""Characters with a special meaning in the paths of some system."""


def example_scenes() -> dict[str, Path]:
    """The folders of the example scenes that are installed, by their names."""
    for place in EXAMPLE_PLACES:
        if folders := {name: place / name for name in EXAMPLES if (place / name / SCENE_FILE).is_file()}:
            return folders
    return {}


def is_example(path: Path) -> bool:
    """Whether a path is the folder of an example scene."""
    return path.parent in EXAMPLE_PLACES and path.name in EXAMPLES


def path_within(problems: list[str], folder: Path, name: str, *, outside: bool = False) -> Path | None:
    """The path of a file that another file names; None if it is refused, with the reason added to `problems`.

    Unless `outside` is true, the path must be within the folder, also after symbolic links are resolved. So
    network addresses are refused, too.
    """
    if not name or not name.isprintable():
        problems.append(f"must be the name of a file, not {shown(name)}; correct it")
        return None
    is_relative = not (os.path.isabs(name) or PureWindowsPath(name).drive or "\\" in name or "://" in name)
    if outside or (is_relative and ".." not in name.split("/") and is_within(folder, folder / name)):
        return folder / name
    problems.append(
        f"must be the name of a file in the scene's folder, not {shown(name)}; copy the file there"
    )
    return None


def is_within(folder: Path, path: Path) -> bool:
    """Whether a path is in a folder, or is the folder, after symbolic links are resolved."""
    return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))


def file_stem(name: str) -> str:
    """The name of a scene or a surface, which may have any characters, as a file name without an ending.

    >>> file_stem("scenes/coupe"), file_stem("a: b"), file_stem("..")
    ('coupe', 'a_ b', 'scene')
    """
    stem = "".join("_" if letter in REFUSED or ord(letter) < 32 else letter for letter in Path(name).name)
    stem = stem.strip()[:LONGEST_STEM].strip()
    return stem if stem.strip(" .") else "scene"


def check_stem(name: str) -> None:
    """Raise UsageError unless a name can be the name of a new file, without an ending.

    Hidden files are refused, too: the lists of files leave them out.
    """
    if file_stem(name) != name or name.startswith(".") or not name.isprintable():
        raise UsageError(
            f"a name must be 1 to {LONGEST_STEM} characters, none of {''.join(sorted(REFUSED))}, no period or"
            f" space first, not {shown(name)}; choose another"
        )


def free_path(path: Path) -> Path:
    """The path if no file has it; otherwise the path with the lowest free number from 2: "rig-2.toml"."""
    stem, number, free = path.stem, 1, path
    while os.path.lexists(free):
        number += 1
        free = path.with_name(f"{stem}-{number}{path.suffix}")
    return free
