"""Safe file names from the names of scenes and surfaces, which may contain any characters."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

LONGEST_STEM: Final = 100
REFUSED: Final = frozenset('/\\:*?"<>|')
"""Characters that have a special meaning in the paths of some system."""


def file_stem(name: str) -> str:
    """The name as a file name without an ending, free of folders and special characters.

    >>> file_stem("scenes/coupe"), file_stem("a: b"), file_stem("..")
    ('coupe', 'a_ b', 'scene')
    """
    stem = "".join("_" if letter in REFUSED or ord(letter) < 32 else letter for letter in Path(name).name)
    stem = stem.strip()[:LONGEST_STEM].strip()
    return stem if stem.strip(" .") else "scene"


def free_path(path: Path) -> Path:
    """The path if nothing is there, else with the lowest number from 2 that makes it free: "rig-2.toml"."""
    stem, number, free = path.stem, 1, path
    while os.path.lexists(free):
        number += 1
        free = path.with_name(f"{stem}-{number}{path.suffix}")
    return free
