"""The state folder of the program, the locks in it, and the lists of recent colors and files.

Each list is a JSON file, the newest entry first. The lists are a convenience: a list that is damaged, or that
cannot be read or written, is empty and no error. Programs that run at the same time share the lists; of two
entries at the same moment, one may be lost.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final

import platformdirs

from autocolor.checks import Color
from autocolor.errors import AutocolorError, OutputError
from autocolor.files.reading import read_bytes
from autocolor.files.writing import lock, write_atomically
from autocolor.scene.kinds import SIX_DIGITS, ColorKind, in_digits

MOST_COLORS: Final = 12
MOST_FILES: Final = 10

COLORS: Final = "recent-colors.json"
FILES: Final = "recent-files.json"

LONGEST_PATH: Final = 4096
"""Letters; no system has longer paths."""

LARGEST: Final = 1 << 18
"""Bytes: more than MOST_FILES paths of LONGEST_PATH letters, each letter written in six bytes."""


def state_folder() -> Path:
    """The folder for the state of `autocolor`, which need not exist. Raises OutputError if there is no home.

    It is in `XDG_STATE_HOME`, or `~/.local/state` without it; on Windows in `LOCALAPPDATA`, and on macOS in
    `~/Library/Application Support`.
    """
    with suppress(RuntimeError):
        folder = Path(platformdirs.user_state_dir("autocolor", appauthor=False))
        # Some versions return a relative path if there is no home.
        if folder.is_absolute():
            return folder
    raise OutputError("the state folder must be in a home folder, and there is none; set XDG_STATE_HOME")


def lock_file(path: Path) -> int | None:
    """A descriptor that has the lock on a file; None if another program has the lock.

    The file is created if there is none. The lock lasts until `os.close`, or until the program ends, however
    it ends. Raises OSError if the file cannot be opened, or is a link.
    """
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0), 0o600)
    try:
        lock(descriptor)
    except OSError:
        os.close(descriptor)
        return None
    return descriptor


def recent_colors() -> tuple[Color, ...]:
    """The colors that were picked last, newest first, at most MOST_COLORS."""
    return tuple(ColorKind().accepted(text) for text in _entries(COLORS, MOST_COLORS, _is_color))


def note_color(color: Color) -> None:
    """Put a color first among the recent ones."""
    _note(COLORS, in_digits(color), MOST_COLORS, _is_color)


def recent_files() -> tuple[Path, ...]:
    """The files and folders that were opened last, newest first, at most MOST_FILES; some may be gone."""
    return tuple(map(Path, _entries(FILES, MOST_FILES, _is_path)))


def note_file(path: str | os.PathLike[str]) -> None:
    """Put a file or folder first among the recent ones, by its absolute path."""
    _note(FILES, os.path.abspath(path), MOST_FILES, _is_path)


def _is_color(entry: str) -> bool:
    return SIX_DIGITS.fullmatch(entry) is not None


def _is_path(entry: str) -> bool:
    return os.path.isabs(entry) and "\0" not in entry and len(entry) <= LONGEST_PATH


def _entries(name: str, most: int, is_valid: Callable[[str], bool]) -> list[str]:
    """The entries of a list, without damaged and repeated entries."""
    try:
        entries = json.loads(read_bytes(state_folder() / name, LARGEST))
    except (AutocolorError, ValueError, RecursionError):
        return []
    if not isinstance(entries, list):
        return []
    valid = [entry for entry in entries if isinstance(entry, str) and is_valid(entry)]
    return list(dict.fromkeys(valid))[:most]


def _note(name: str, entry: str, most: int, is_valid: Callable[[str], bool]) -> None:
    """Put an entry first in a list; nothing happens if it is invalid, or the list cannot be written."""
    if not is_valid(entry):
        return
    with suppress(AutocolorError, OSError):
        folder = state_folder()
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        others = [other for other in _entries(name, most, is_valid) if other != entry]
        data = json.dumps([entry, *others][:most], indent=1).encode()
        write_atomically(folder / name, data, overwrite=True)
