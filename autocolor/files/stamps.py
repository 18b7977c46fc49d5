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


def stamp_of(path: Path) -> str | None:
    """The SHA-256 of the bytes of a file, in hexadecimal digits; None if it cannot be read.

    The stamp of a store includes its write-ahead log, the changes that are not yet in the store file. The
    stamp of a scene file includes the times and sizes of the mesh files that it names.
    """
    digest = hashlib.sha256()
    try:
        for each in (path, *_logs(path)):
            with opened(each) as (file, _):
                hashlib.file_digest(file, lambda: digest)
        if path.suffix.lower() == ".toml":
            for numbers in _mesh_numbers(path):
                digest.update(repr(numbers).encode())
    except (OSError, ValueError):
        return None
    return digest.hexdigest()


def numbers_of(path: Path) -> tuple[int, ...] | None:
    """Numbers that differ after a file was changed; None if it is missing. The file is not opened."""
    try:
        status, *logs = [os.stat(each) for each in (path, *_logs(path))]
    except (OSError, ValueError):
        return None
    # A program may set the time of a change, but not the time when the status changed.
    numbers = status.st_ino, status.st_mtime_ns, status.st_ctime_ns, status.st_size
    return (*numbers, *(number for log in logs for number in (log.st_mtime_ns, log.st_size)))


def look_at(path: Path) -> tuple[int, ...] | None:
    """`numbers_of` a file; None also while a program writes to a store, and has a journal to go back."""
    is_store = path.suffix.lower() in STORE_SUFFIXES
    # A journal that is not needed begins with zeros.
    has_journal = is_store and read_head(_beside(path, "-journal"))[:1].strip(b"\0")
    return None if has_journal else numbers_of(path)


def _beside(store: Path, ending: str) -> Path:
    """The write-ahead log or the journal of a store."""
    return Path(f"{os.path.realpath(store)}{ending}")


def _logs(path: Path) -> list[Path]:
    """The write-ahead log of a store, if there is any; SQLite creates an empty log even to read."""
    log = _beside(path, "-wal")
    return [log] if path.suffix.lower() in STORE_SUFFIXES and log.exists() and log.stat().st_size else []


def _mesh_numbers(scene_file: Path) -> Iterator[tuple[str | int, ...]]:
    """The names, times and sizes of the mesh files that a scene file names. Raises OSError."""
    try:
        entries = entries_of(read_bytes(scene_file, LARGEST_TEXT))
    except InputError:
        return
    for entry in entries:
        names = entry.items() if isinstance(entry, Mapping) else ()
        for name in [name for key, name in names if key in MESH_FILE_KEYS and isinstance(name, str)]:
            path = path_within([], scene_file.parent, name)
            if path is None or not path.exists():
                continue
            for file in sorted(path.iterdir()) if path.is_dir() else [path]:
                status = file.stat()
                yield file.name, status.st_mtime_ns, status.st_size
