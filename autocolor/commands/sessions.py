"""Sessions of a window: autosaved while it is open; listed, recovered or forgotten if they were left."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Final, NoReturn

import click

from autocolor.errors import AutocolorError, InputError, MissingInputError, UsageError
from autocolor.journal.autosave import OLD_SCRIPT, Autosave, forget, journal_in, left_sessions
from autocolor.journal.journal import read_journal
from autocolor.screens.viewer import Viewer

if TYPE_CHECKING:
    from autocolor.journal.journal import JournalSession

NEWEST: Final = "newest"
"""The choice of the newest session that can be read."""

OLD: Final = (
    "the session was left by an older version of autocolor, and cannot be recovered; `autocolor view"
    " --forget` removes it"
)

ENDING: Final = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""The signals that end a program from outside."""

BY_SIGNAL: Final = 128
"""What a shell adds to the number of the signal that ended a program."""


@contextmanager
def autosaved_session(viewer: Viewer, folder: Path | None = None) -> Iterator[Callable[[], None]]:
    """Autosave the session of a viewer; yields a function to call often.

    `folder` is the folder of a left session that goes on. A journal that cannot be written is told once in
    the viewer, and left sessions are told on stderr. SIGTERM and SIGHUP end the program at once, and leave
    the journal.
    """
    autosave = Autosave(folder)
    _mention_left_sessions(viewer)
    messages: set[str] = set()

    def update() -> None:
        try:
            autosave.update(viewer.studio.history)
        except AutocolorError as error:
            if str(error) not in messages:
                messages.add(str(error))
                viewer.tell(str(error))

    before = {number: signal.signal(number, _end) for number in ENDING}
    try:
        yield update
    except BaseException:
        with suppress(AutocolorError):
            autosave.update(viewer.studio.history, at_once=True)
        raise
    finally:
        for number, handler in before.items():
            # None is a handler that is not Python's.
            signal.signal(number, signal.SIG_DFL if handler is None else handler)
    autosave.end()


def _end(number: int, _: FrameType | None) -> NoReturn:
    raise SystemExit(BY_SIGNAL + number)


def _mention_left_sessions(viewer: Viewer) -> None:
    """Mention sessions that were left, on stderr and in the viewer."""
    left = left_sessions()
    if not left:
        return
    many = len(left) > 1
    sessions = f"{len(left)} sessions, the last one" if many else "a session"
    click.echo(
        f"autocolor: {sessions} of {_time_of(left[0])}, did not end orderly; `autocolor view --recover` opens"
        f" it, `--sessions` lists {'them' if many else 'it'}, `--forget` removes {'one' if many else 'it'}",
        err=True,
    )
    viewer.tell(
        "a session was left: autocolor view --recover opens it; the right edge: the menu", persistent=True
    )


def list_sessions() -> None:
    """Print a line for each session that was left, the newest first: its name, its time and its steps."""
    for folder in left_sessions():
        try:
            session = _session_in(folder)
        except InputError as error:
            text = str(error).replace("\n", "; ")
        else:
            steps = len(session.history.steps)
            text = f"{session.source.path}, {steps} step{'' if steps == 1 else 's'}"
        click.echo(f"{folder.name}  {_time_of(folder)}  {text}")


def forget_session(name: str) -> None:
    """Remove a session that was left, by the beginning of its name, and say so on stderr."""
    folder = _folder_named(name)
    forget(folder)
    click.echo(f"autocolor: {folder.name} is removed", err=True)


def chosen_session(name: str) -> tuple[Path, JournalSession]:
    """A left session and its folder, by the beginning of its name; NEWEST is the newest that can be read.

    Raises UsageError if none or several have the name, InputError if the session cannot be read,
    MissingInputError if there is no session.
    """
    if name != NEWEST:
        folder = _folder_named(name)
        return folder, _session_in(folder)
    for folder in left_sessions():
        try:
            return folder, _session_in(folder)
        except InputError as error:
            click.echo(f"autocolor: {folder}: {error}", err=True)
    raise MissingInputError(
        "--recover: there must be a session that did not end orderly and can be read, and there is none;"
        " name a scene"
    )


def _session_in(folder: Path) -> JournalSession:
    """The session in a folder. Raises InputError if an older version left it, and as `read_journal`."""
    journal = journal_in(folder)
    if journal.name == OLD_SCRIPT:
        raise InputError(OLD)
    return read_journal(journal)


def _folder_named(name: str) -> Path:
    """The folder of the only left session whose name begins with `name`. Raises UsageError."""
    folders = [folder for folder in left_sessions() if name and folder.name.startswith(name)]
    if len(folders) != 1:
        matches = "several of these" if folders else "none of these"
        raise UsageError(
            f"a session must be named by the beginning of its name and no other's, and {name!r} is {matches};"
            " `autocolor view --sessions` lists them"
        )
    return folders[0]


def _time_of(folder: Path) -> str:
    """When the journal of a session was written last, in local time."""
    return time.strftime("%Y-%m-%d %H:%M", time.localtime(journal_in(folder).stat().st_mtime))
