"""Stamps: how a program notices that another program changed a file.

A stamp is made of the whole content of a file. `numbers_of` and `look_at` take a few system calls: call them
often, and compare the stamps only if the numbers differ.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from autocolor.errors import InputError
from autocolor.files.paths import STORE_SUFFIXES, path_within
from autocolor.files.reading import opened, read_bytes, read_head
from autocolor.files.scene_toml.scene_meshes import MESH_FILE_KEYS, entries_of
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT
from autocolor.files.writing import status_numbers


def stamp_of(path: Path) -> str | None:
    """The SHA-256 of the bytes of a file, in hexadecimal digits; None if it cannot be read.

    The stamp of a store includes its write-ahead log, the changes that are not yet in the store file. The
    stamp of a scene file includes the times and sizes of the mesh files that it names.
    """
    digest = hashlib.sha256()
    try:
        for each in (path, *_beside(path, "-wal")):
            with opened(each) as (file, _):
                hashlib.file_digest(file, lambda: digest)
        if path.suffix.lower() == ".toml":
            for numbers in _mesh_numbers(path):
                digest.update(repr(numbers).encode())
    except (OSError, ValueError):
        return None
    return digest.hexdigest()


def numbers_of(path: Path) -> tuple[int, ...] | None:
    """Numbers that differ after a file or its log was changed; None if it is missing. It is not opened."""
    numbers = status_numbers(path)
    # The time and the size of a log: SQLite changes its status also to read.
    return numbers and sum(((status_numbers(log) or ())[2::2] for log in _beside(path, "-wal")), numbers)


def look_at(path: Path) -> tuple[int, ...] | None:
    """`numbers_of` a file; None also while a program writes to a store, and has a journal to go back."""
    # A journal that is not needed begins with zeros.
    has_journal = any(read_head(each)[:1].strip(b"\0") for each in _beside(path, "-journal"))
    return None if has_journal else numbers_of(path)


def _beside(path: Path, ending: str) -> list[Path]:
    """The write-ahead log or the journal of a store, if there is any; SQLite creates an empty log to read."""
    beside = Path(f"{os.path.realpath(path)}{ending}")
    size = (status_numbers(beside) or (0,))[-1]
    return [beside] if size and path.suffix.lower() in STORE_SUFFIXES else []


def _mesh_numbers(scene_file: Path) -> Iterator[tuple[str, int, int]]:
    """The names, times and sizes of the mesh files that a scene file names. Raises OSError."""
    try:
        entries = entries_of(read_bytes(scene_file, LARGEST_TEXT))
    except InputError:
        return
    for entry in entries:
        names = entry.items() if isinstance(entry, Mapping) else ()
        for name in [name for key, name in names if key in MESH_FILE_KEYS and isinstance(name, str)]:
            path = path_within([], scene_file.parent, name)
            if path is not None and path.exists():
                for file in sorted(path.iterdir()) if path.is_dir() else [path]:
                    status = file.stat()
                    yield file.name, status.st_mtime_ns, status.st_size
