"""Stamps: how a program notices that another program changed a file.

A stamp is made of the whole content of a file. `numbers_of` and `look_at` take a few system calls: call them
often, and compare the stamps only if the numbers differ.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Final

from autocolor.errors import InputError, MissingInputError
from autocolor.files.paths import STORE_SUFFIXES, path_within
from autocolor.files.reading import opened, read_bytes, read_head
from autocolor.files.scene_toml.scene_meshes import MESH_FILE_KEYS, entries_of
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT

CHANGE_COUNTER: Final = slice(24, 28)
"""The place of the count of changes in the header of a store; in WAL mode it counts checkpoints only."""


def stamp_of(path: Path) -> str | None:
    """The SHA-256 of the bytes of a file, in hexadecimal digits; None if it cannot be read.

    The stamp of a store includes its write-ahead log, the changes that are not yet in the store file. The
    stamp of a scene file includes the times and sizes of the mesh files that it names.
    """
    digest, suffix = hashlib.sha256(), path.suffix.lower()
    try:
        for data in _bytes_of(path):
            digest.update(data)
        if suffix in STORE_SUFFIXES:
            with suppress(MissingInputError):
                for data in _bytes_of(_log_of(path)):
                    digest.update(data)
        elif suffix == ".toml":
            for numbers in _mesh_numbers(path):
                digest.update(repr(numbers).encode())
    except (OSError, ValueError):
        return None
    return digest.hexdigest()


def numbers_of(path: Path) -> tuple[int | bytes, ...] | None:
    """Numbers that differ after a file was changed; None if it is missing. The file is not opened."""
    try:
        status = os.stat(path)
        log = os.stat(_log_of(path)) if os.path.exists(_log_of(path)) else None
    except (OSError, ValueError):
        return None
    numbers = status.st_dev, status.st_ino, status.st_mtime_ns, status.st_size
    # SQLite creates an empty log even to read.
    return (*numbers, log.st_mtime_ns, log.st_size) if log is not None and log.st_size else numbers


def look_at(path: Path) -> tuple[int | bytes, ...] | None:
    """`numbers_of` a file, and the count of changes of a store; None also while a store is being written."""
    numbers = numbers_of(path)
    if numbers is None or path.suffix.lower() not in STORE_SUFFIXES:
        return numbers
    # SQLite is loaded for stores alone.
    from autocolor.files.store.connections import played_files

    try:
        # While a commit of another program writes to the store, a journal is beside it.
        if "-journal" in played_files(path):
            return None
    except InputError:
        return None
    return *numbers, read_head(path)[CHANGE_COUNTER]


def _log_of(store: Path) -> Path:
    """The write-ahead log of a store."""
    return Path(f"{os.path.realpath(store)}-wal")


def _bytes_of(path: Path) -> Iterator[bytes]:
    """The bytes of a regular file in pieces. Raises InputError."""
    with opened(path) as (file, _):
        while data := file.read(1 << 20):
            yield data


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
