"""Autosaving: the journal of a session stays in the state folder until the session ends in order.

Each session has its own folder there, with the journal, a lock, the meshes that edits changed, and the first
scene if no file has it. However the program ends, its lock ends with it. A session whose lock is free did not
end in order: it was left, and can be recovered or forgotten. Of a folder or file that is a link, nothing is
locked, written or removed but the link itself.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from autocolor.errors import AutocolorError, InputError, MissingInputError, WriteError, reason_of
from autocolor.files.scene_writing import write_scene
from autocolor.files.state import lock_file, state_folder
from autocolor.files.writing import write_atomically
from autocolor.journal.history import Edit, History, Step
from autocolor.journal.journal import JournalSession, MeshesBeside, first_line, read_journal, step_line
from autocolor.journal.places import Source

SESSIONS: Final = "sessions"
JOURNAL: Final = "session.jsonl"
LOCK: Final = "lock"
FIRST_SCENE: Final = "scene"

SECONDS_BETWEEN: Final = 1.0
"""Limit: half of the two seconds of work that may be lost; the other half is for writing."""


class Autosave:
    """The journal of one running session; nothing is written before its first step.

    `folder` is the folder of a left session that goes on. Raises WriteError if another program has it.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        self._lock: int | None = None
        if folder is not None:
            with _write_errors():
                self._lock = _lock_of(folder)
        self._meshes = MeshesBeside(folder)
        self._count = 0
        """The number of steps in the journal file; 0 until the whole file was written."""
        self._last: Step | None = None
        """The last step in the file."""
        self._written_at = -SECONDS_BETWEEN

    def update(self, history: History, at_once: bool = False) -> None:
        """Append the steps since the last update to the journal, at most once a second unless `at_once`.

        Give the history of the same session every time. Raises AutocolorError if the journal cannot be
        written; the session goes on, and the next update writes the whole journal.
        """
        steps, count, last = history.steps, self._count, self._last
        is_written = not steps or (len(steps) == count and steps[-1] is last)
        is_due = at_once or time.monotonic() - self._written_at >= SECONDS_BETWEEN
        if is_written or not is_due:
            return
        self._written_at = time.monotonic()
        # If writing fails, the next update writes the whole file.
        self._count, self._last = 0, None
        with _write_errors():
            folder = self._own_folder()
            new = steps[count:]
            extended = steps[count - 1]
            if isinstance(last, Edit) and isinstance(extended, Edit) and extended is not last:
                # The last edit was a drag that went on since it was written.
                new.insert(0, Edit(last.after, extended.after, joins=True))
            lines = [step_line(step, history.start, self._meshes) for step in new]
            if count:
                _append(folder / JOURNAL, "".join(lines).encode())
            else:
                lines.insert(0, first_line(history.start, _source_of(history, folder)))
                write_atomically(folder / JOURNAL, "".join(lines).encode(), overwrite=True)
        self._count, self._last = len(steps), steps[-1]

    def end(self) -> None:
        """Remove the folder of the session, because the session ended in order."""
        folder, self._folder = self._folder, None
        if folder is not None:
            _remove(folder, self._lock)

    def leave(self) -> None:
        """Leave the folder of the session, to be recovered."""
        self._folder = None
        if self._lock is not None:
            os.close(self._lock)

    def _own_folder(self) -> Path:
        """The folder of this session; the first call creates it. Raises OSError."""
        if self._folder is None:
            sessions = state_folder() / SESSIONS
            sessions.mkdir(mode=0o700, parents=True, exist_ok=True)
            for is_last in (False, False, True):
                folder = sessions / f"{time.strftime('%Y-%m-%d-%H%M%S')}-{os.getpid()}-{time.time_ns():x}"
                folder.mkdir(mode=0o700)
                with suppress(FileNotFoundError):
                    self._lock = lock_file(folder / LOCK)
                if is_last or (self._lock is not None and folder.exists()):
                    break
                _remove(folder, self._lock)
                self._lock = None
                # Another program removed the empty folder before it was locked.
            self._folder = folder
            self._meshes = MeshesBeside(folder)
        return self._folder


def _remove(folder: Path, lock: int | None) -> None:
    """Remove the folder of a session, and release its lock; links in it are removed alone."""
    with suppress(OSError):
        os.unlink(folder / JOURNAL)
    if lock is not None:
        os.close(lock)
    shutil.rmtree(folder, ignore_errors=True)


def _append(path: Path, data: bytes) -> None:
    """Append bytes to an existing file, and sync it. Raises OSError."""
    with open(path, "r+b") as file:
        file.seek(0, os.SEEK_END)
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def _source_of(history: History, folder: Path) -> Source:
    """The source of the first scene. A scene without a source is saved beside the journal."""
    source = history.first_place.source
    if source is None:
        source = Source(str(folder / FIRST_SCENE))
        write_scene(source.path, history.start, overwrite=True)
    return source


def left_sessions() -> list[Path]:
    """The folders of sessions that did not end in order, the last session first.

    A session that cannot be read is among them. Folders of sessions that wrote nothing are removed.
    """
    try:
        paths = list((state_folder() / SESSIONS).iterdir())
    except (OSError, AutocolorError):
        return []
    left = [path for path in paths if (path.is_symlink() or os.path.isdir(path)) and _is_left(path)]
    return sorted(left, key=written_at, reverse=True)


def session_in(folder: Path) -> JournalSession:
    """The left session in a folder. Raises InputError if it is invalid."""
    refuse_links(folder)
    return read_journal(folder / JOURNAL)


def newest_session(report: Callable[[str], object] = lambda _: None) -> tuple[Path, JournalSession]:
    """The folder of the newest left session that can be read, and the session.

    `report` is called with the problems of newer sessions. Raises MissingInputError if there is no session.
    """
    for folder in left_sessions():
        try:
            return folder, session_in(folder)
        except InputError as error:
            for problem in error.problems:
                report(f"{folder}: {problem}")
    raise MissingInputError(
        "there must be a session that was not closed and can be read, and there is none; open a scene instead"
    )


def written_at(folder: Path) -> float:
    """The time of the last write to the journal of a session, or to its folder without a journal."""
    for path in (folder / JOURNAL, folder):
        with suppress(OSError):
            return os.lstat(path).st_mtime
    return 0.0


def refuse_links(folder: Path) -> None:
    """Raise InputError if the folder, the journal or the lock of a session is a link."""
    for path in (folder, folder / JOURNAL, folder / LOCK):
        if os.path.islink(path):
            raise InputError(
                f"{path.name}: it must not be a link; `autocolor view --forget` removes the session"
            )


def forget(folder: Path) -> None:
    """Remove a session that was left. Links are removed, and what they lead to stays.

    Raises WriteError if another program goes on with the session, or if it cannot be removed.
    """
    if folder.is_symlink():
        with suppress(OSError):
            os.unlink(folder)
    else:
        lock = None
        # A lock that cannot be opened, such as a link, is none of ours.
        with suppress(OSError):
            lock = _lock_of(folder)
        _remove(folder, lock)
    if os.path.lexists(folder):
        raise WriteError(f"a session must be removed whole, and {folder} could not be; remove it by hand")


def _is_left(folder: Path) -> bool:
    """Whether no program has the lock on the folder of a session, and the session wrote anything."""
    if folder.is_symlink():
        return True
    try:
        descriptor = lock_file(folder / LOCK)
    except OSError:
        return os.path.lexists(folder)
    if descriptor is None:
        return False
    try:
        names = os.listdir(folder)
        if any(name != LOCK and not name.endswith(".part") for name in names):
            return True
        with suppress(OSError):
            for name in names:
                os.unlink(folder / name)
            os.rmdir(folder)
        return False
    except OSError:
        return True
    finally:
        os.close(descriptor)


def _lock_of(folder: Path) -> int:
    """The lock on the folder of a session that was left. Raises OSError, WriteError if it is in use."""
    descriptor = lock_file(folder / LOCK)
    if descriptor is None:
        raise WriteError("a session must be recovered by one program, and another one does; try again later")
    return descriptor


@contextmanager
def _write_errors() -> Iterator[None]:
    """Raise OSError as WriteError."""
    try:
        yield
    except OSError as error:
        raise WriteError(
            "the journal of the session must be kept in the state folder, and cannot be"
            f" ({reason_of(error)}); save often"
        ) from None
