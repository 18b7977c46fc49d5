"""Noticing that another program changed a file: a store by its count of changes, any by place and time.

To look costs two system calls, so that it can be done often.
"""

from __future__ import annotations

import os
import sqlite3
from contextlib import suppress
from pathlib import Path

from autocolor.errors import AutocolorError
from autocolor.files.store.connections import closed, connected

Stamp = tuple[int, int, int, int, int]


class FileChanges:
    """Tells whether a file was changed since it was `seen` last.

    A store is kept open for reading: what others wrote beside it, and not yet into it, counts too.
    """

    def __init__(self, path: Path, is_store: bool) -> None:
        self.path = path
        self._is_store = is_store
        self._connection: sqlite3.Connection | None = None
        self._opened: tuple[int, int] | None = None
        self._seen = self._stamp()

    def have_come(self) -> bool:
        """Whether the file was changed. A file that is not there, or is being written, was not yet."""
        stamp = self._stamp()
        return stamp is not None and stamp != self._seen

    def seen(self) -> None:
        """Take the file as it is now for seen."""
        self._seen = self._stamp() or self._seen

    def close(self) -> None:
        """Let go of the file."""
        if self._connection is not None:
            closed(self._connection)
        self._connection = self._opened = None

    def __del__(self) -> None:
        self.close()

    def _stamp(self) -> Stamp | None:
        try:
            status = os.stat(self.path)
        except (OSError, ValueError):
            return None
        version = self._version((status.st_dev, status.st_ino)) if self._is_store else 0
        if version is None:
            return None
        return status.st_dev, status.st_ino, status.st_mtime_ns, status.st_size, version

    def _version(self, place: tuple[int, int]) -> int | None:
        """How often others changed the store since it was opened; None while one is writing."""
        if self._opened != place:
            # Another file was put in its place.
            self.close()
            with suppress(AutocolorError):
                self._connection, self._opened = connected(self.path, wait=0.0), place
        if self._connection is None:
            return 0
        try:
            (version,) = self._connection.execute("PRAGMA data_version").fetchone()
        except sqlite3.OperationalError:
            return None
        except sqlite3.Error:
            return 0
        return int(version)
