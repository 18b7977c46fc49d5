"""Locks on files: one program has each, and it goes when that program ends, in whatever way it does."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def lock_file(path: Path) -> int | None:
    """A descriptor that holds the lock on a file, which is made if there is none; None if another has it.

    The lock lasts until `os.close`, or until the program ends. Raises OSError if the file cannot be opened.
    """
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o600)
    try:
        _lock(descriptor)
    except OSError:
        os.close(descriptor)
        return None
    return descriptor


if sys.platform == "win32":
    import msvcrt

    def _lock(descriptor: int) -> None:
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _lock(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
