"""Noticing that another program changed a file, by its place and time, and a store by its count of changes.

A look costs a few system calls, so it can be taken often. It opens no store with SQLite.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from autocolor.errors import InputError
from autocolor.files.reading import read_head
from autocolor.files.store.connections import refuse_journal

CHANGE_COUNTER: Final = slice(24, 28)
"""Where the header of a store counts its changes; in WAL mode it counts checkpoints only."""

Stamp = tuple[int | bytes, ...]


class FileChanges:
    """Tells whether a file was changed since it was `seen` last.

    For a store, changes that are only in its `-wal` count too.
    """

    def __init__(self, path: Path, is_store: bool) -> None:
        self.path = path
        self._is_store = is_store
        self._seen = self._stamp()

    def have_come(self) -> bool:
        """Whether the file was changed. A file that is missing or being written does not count as changed."""
        stamp = self._stamp()
        return stamp is not None and stamp != self._seen

    def seen(self) -> None:
        """Remember the file as it is now."""
        self._seen = self._stamp() or self._seen

    def _stamp(self) -> Stamp | None:
        """Numbers that differ after a change; None while the file is missing or being written."""
        try:
            status = os.stat(self.path)
            stamp = (status.st_dev, status.st_ino, status.st_mtime_ns, status.st_size)
            if not self._is_store:
                return stamp
            # Its header has bytes other than zero while a commit writes to the store.
            refuse_journal(self.path)
        except (OSError, ValueError, InputError):
            return None
        return *stamp, read_head(self.path)[CHANGE_COUNTER], *self._wal()

    def _wal(self) -> tuple[int, int]:
        """The time and the size of the `-wal` of a store; zeros if it has no changes."""
        try:
            status = os.stat(f"{os.path.realpath(self.path)}-wal")
        except OSError:
            return 0, 0
        return (status.st_mtime_ns, status.st_size) if status.st_size else (0, 0)
