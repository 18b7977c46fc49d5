"""The state folder of the program, the locks in it, and the lists of recent colors and files.

Each list is a JSON file, the newest entry first. The lists are a convenience: a list that is damaged, or that
cannot be read or written, is empty and no error. Programs that run at the same time share the lists; of two
entries at the same moment, one may be lost.
"""

from __future__ import annotations

import json
import os
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


def state_folder() -> Path:
    """The folder for the state of `autocolor`, which need not exist. Raises OutputError if there is no home.

    It is in `XDG_STATE_HOME`, or `~/.local/state` without it; on Windows in `LOCALAPPDATA`, and on macOS in
    `~/Library/Application Support`.
    """
    folder = Path(platformdirs.user_state_dir("autocolor", appauthor=False))
    if not folder.is_absolute():
        raise OutputError("the state folder must be in a home folder, and there is none; set XDG_STATE_HOME")
    return folder


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
    colors = [ColorKind().accepted(text) for text in _entries(COLORS) if SIX_DIGITS.fullmatch(text)]
    return tuple(colors[:MOST_COLORS])


def note_color(color: Color) -> None:
    """Put a color first among the recent ones."""
    _note(COLORS, in_digits(color), MOST_COLORS)


def recent_files() -> tuple[Path, ...]:
    """The files and folders that were opened last, newest first, at most MOST_FILES; some may be gone."""
    paths = [Path(text) for text in _entries(FILES) if os.path.isabs(text) and "\0" not in text]
    return tuple(paths[:MOST_FILES])


def note_file(path: str | os.PathLike[str]) -> None:
    """Put a file or folder first among the recent ones, by its absolute path."""
    _note(FILES, os.path.abspath(path), MOST_FILES)


def _entries(name: str) -> list[str]:
    """The texts in a list."""
    try:
        entries = json.loads(read_bytes(state_folder() / name, 1 << 18))
    except (AutocolorError, ValueError, RecursionError):
        return []
    return [entry for entry in entries if isinstance(entry, str)] if isinstance(entries, list) else []


def _note(name: str, entry: str, most: int) -> None:
    """Put an entry first in a list; nothing happens if the list cannot be written."""
    with suppress(AutocolorError, OSError):
        folder = state_folder()
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        entries = [*dict.fromkeys([entry, *_entries(name)])][:most]
        write_atomically(folder / name, json.dumps(entries, indent=1).encode(), overwrite=True)
