"""Keeping the session of a window: its journal stays unless the window is closed by its user."""

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
from autocolor.journal.autosave import JOURNAL, Autosave, forget, left_sessions
from autocolor.journal.reading import read_journal
from autocolor.screens.viewer import Viewer

if TYPE_CHECKING:
    from autocolor.journal.reading import Session


# -------------------- left_sessions
# Sessions that did not end orderly, for `autocolor view`: listing, choosing and forgetting them.

NEWEST: Final = "newest"
"""The choice of the newest session that can be read."""


def when(folder: Path) -> str:
    """When the journal of a session was written last, in local time."""
    return time.strftime("%Y-%m-%d %H:%M", time.localtime((folder / JOURNAL).stat().st_mtime))


def list_sessions() -> None:
    """Print a line for each session that was left, the newest first: its name, its time and its steps."""
    for folder in left_sessions():
        try:
            session = read_journal(folder / JOURNAL)
        except InputError as error:
            told = str(error).replace("\n", "; ")
        else:
            steps = len(session.history.steps)
            told = f"{session.source.path}, {steps} step{'' if steps == 1 else 's'}"
        click.echo(f"{folder.name}  {when(folder)}  {told}")


def forget_session(name: str) -> None:
    """Remove a session that was left, by the beginning of its name, and say so on stderr."""
    folder = _named(name)
    forget(folder)
    click.echo(f"autocolor: {folder.name} is removed", err=True)


def chosen_session(name: str) -> tuple[Path, Session]:
    """The folder of a session by the beginning of its name, or of the NEWEST that is readable, and itself.

    Raises UsageError for no name or that of several, InputError if it cannot be read, MissingInputError if
    there is none.
    """
    if name != NEWEST:
        folder = _named(name)
        return folder, read_journal(folder / JOURNAL)
    for folder in left_sessions():
        try:
            return folder, read_journal(folder / JOURNAL)
        except InputError as error:
            click.echo(f"autocolor: {folder}: {error}", err=True)
    raise MissingInputError(
        "--recover: there must be a session that did not end orderly and can be read, and there is none;"
        " name a scene"
    )


def _named(name: str) -> Path:
    """The one folder of a session that was left whose name begins so. Raises UsageError."""
    folders = [folder for folder in left_sessions() if name and folder.name.startswith(name)]
    if len(folders) != 1:
        found = "several of these" if folders else "none of these"
        raise UsageError(
            f"a session must be named by the beginning of its name and no other's, and {name!r} is {found};"
            " `autocolor view --sessions` lists them"
        )
    return folders[0]


ENDING: Final = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""The signals that end a program from outside."""

BY_SIGNAL: Final = 128
"""What a shell adds to the number of the signal that ended a program."""


@contextmanager
def kept_session(viewer: Viewer, left: Path | None = None) -> Iterator[Callable[[], None]]:
    """Keep the journal of the session of a viewer; the function that is given must be called often.

    A journal that cannot be written is told once, and sessions that were left before on stderr. `left` is the
    folder of one that is gone on with. SIGTERM and SIGHUP end the program at once, and leave the journal.
    """
    autosave = Autosave(left)
    _tell_left(viewer)
    told: set[str] = set()

    def update(at_once: bool = False) -> None:
        try:
            autosave.update(viewer.studio.history, at_once)
        except AutocolorError as error:
            if str(error) not in told:
                told.add(str(error))
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


def _tell_left(viewer: Viewer) -> None:
    """Tell of sessions that were left before."""
    left = left_sessions()
    if not left:
        return
    many = len(left) > 1
    what = f"{len(left)} sessions, the last one" if many else "a session"
    click.echo(
        f"autocolor: {what} of {when(left[0])}, did not end orderly; `autocolor view --recover` opens it,"
        f" `--sessions` lists {'them' if many else 'it'}, `--forget` removes {'one' if many else 'it'}",
        err=True,
    )
    viewer.tell(
        "a session was left: autocolor view --recover opens it; the right edge: the menu", persistent=True
    )
