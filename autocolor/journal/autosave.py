"""The journal of a session that is kept in the state folder until the session ends orderly.

Each session has a folder of its own there: the journal, a lock, the first scene if that is in no file, and
the meshes that were changed.
The journal is written anew in one piece, so that whatever ends the program leaves a whole one. The lock goes
with the program: a session whose lock is free is one that did not end orderly.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from autocolor.errors import AutocolorError, WriteError, reason_of
from autocolor.files.scene_writing import write_scene
from autocolor.files.state import lock_file, state_folder
from autocolor.files.writing import write_atomically
from autocolor.journal.history import History, Step
from autocolor.journal.places import Source
from autocolor.journal.script import MeshesBeside, first_lines, step_line

SESSIONS: Final = "sessions"
JOURNAL: Final = "session.py"
LOCK: Final = "lock"
FIRST_SCENE: Final = "scene"

SECONDS_BETWEEN: Final = 1.0
"""Assumed: half of the two seconds of work that may be lost; the other half is for writing."""


class Autosave:
    """Keeps the journal of one running session; nothing is written before its first step.

    `folder` is that of a session that was left, which is gone on with.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        self._lock = None if folder is None else _locked(folder)
        self._first_lines: list[str] = []
        self._lines: list[tuple[Step, str]] = []
        self._beside = MeshesBeside(folder)
        self._written: tuple[int, Step | None] = 0, None
        self._written_at = -SECONDS_BETWEEN

    def update(self, history: History, at_once: bool = False) -> None:
        """Write the journal if there were steps since it was written, at most once a second unless `at_once`.

        The history is always that of the same session: a file that is opened is a step of it. Raises
        AutocolorError if it cannot be written; the session goes on, and the next update tries again.
        """
        steps = history.steps
        now = len(steps), steps[-1] if steps else None
        is_due = at_once or time.monotonic() - self._written_at >= SECONDS_BETWEEN
        if now == self._written or not is_due:
            return
        self._written_at = time.monotonic()
        with _told():
            folder = self._own_folder()
            if not self._first_lines:
                self._first_lines = first_lines(history.start, _source_of(history, folder))
            text = "\n".join([*self._first_lines, *self._step_lines(history), ""])
            write_atomically(folder / JOURNAL, text.encode(), overwrite=True)
        self._written = now

    def end(self) -> None:
        """Remove what was kept, as the session ended orderly."""
        folder, self._folder = self._folder, None
        if folder is not None:
            with suppress(OSError):
                os.unlink(folder / JOURNAL)
            if self._lock is not None:
                os.close(self._lock)
            shutil.rmtree(folder, ignore_errors=True)

    def _own_folder(self) -> Path:
        """The folder of this session, which is made if there is none. Raises OSError."""
        if self._folder is None:
            sessions = state_folder() / SESSIONS
            sessions.mkdir(mode=0o700, parents=True, exist_ok=True)
            folder = sessions / f"{time.strftime('%Y-%m-%d-%H%M%S')}-{os.getpid()}-{time.time_ns():x}"
            folder.mkdir(mode=0o700)
            self._folder, self._lock = folder, lock_file(folder / LOCK)
            self._beside = MeshesBeside(folder)
        return self._folder

    def _step_lines(self, history: History) -> list[str]:
        """The lines of the steps; only those of steps that are new are made."""
        kept, steps = self._lines, history.steps
        while kept and (len(kept) > len(steps) or kept[-1][0] is not steps[len(kept) - 1]):
            kept.pop()
        # One by one: if a mesh cannot be saved, the lines before are not made again.
        for step in steps[len(kept) :]:
            kept.append((step, step_line(step, history.start, self._beside)))
        return [line for _, line in kept]


def _source_of(history: History, folder: Path) -> Source:
    """What the first scene can be read from; it is saved beside the journal if it is in no file."""
    source = history.first_place.source
    if source is None:
        source = Source(str(folder / FIRST_SCENE))
        write_scene(source.path, history.start, overwrite=True)
    return source


def left_sessions() -> list[Path]:
    """The folders of sessions that did not end orderly, the last one first."""
    try:
        folders = [path for path in (state_folder() / SESSIONS).iterdir() if (path / JOURNAL).is_file()]
        folders.sort(key=lambda path: (path / JOURNAL).stat().st_mtime, reverse=True)
        return [folder for folder in folders if _is_left(folder)]
    except (OSError, AutocolorError):
        return []


def forget(folder: Path) -> None:
    """Remove a session that was left. Raises WriteError if another program goes on with it."""
    Autosave(folder).end()


def _is_left(folder: Path) -> bool:
    """Whether no program has the lock on the folder of a session."""
    try:
        descriptor = lock_file(folder / LOCK)
    except OSError:
        return False
    if descriptor is not None:
        os.close(descriptor)
    return descriptor is not None


def _locked(folder: Path) -> int:
    """The lock on the folder of a session that was left. Raises WriteError if another program took it."""
    with _told():
        descriptor = lock_file(folder / LOCK)
    if descriptor is None:
        raise WriteError("a session must be recovered by one program, and another one does; try again later")
    return descriptor


@contextmanager
def _told() -> Iterator[None]:
    """Raise OSError as WriteError."""
    try:
        yield
    except OSError as error:
        raise WriteError(
            "the journal of the session must be kept in the state folder, and cannot be"
            f" ({reason_of(error)}); save often"
        ) from None
