"""Names of files made from names of scenes, which may come from any file."""

from __future__ import annotations

from pathlib import Path
from typing import Final

LONGEST_STEM: Final = 100
REFUSED: Final = frozenset('/\\:*?"<>|')
"""What a system would take for something else than a part of a name."""


def file_stem(name: str) -> str:
    """The name as the beginning of a file's name in one folder.

    >>> file_stem("scenes/coupe"), file_stem("a: b"), file_stem("..")
    ('coupe', 'a_ b', 'scene')
    """
    stem = "".join("_" if letter in REFUSED or ord(letter) < 32 else letter for letter in Path(name).name)
    return stem[:LONGEST_STEM].strip() if stem.strip(" .") else "scene"
