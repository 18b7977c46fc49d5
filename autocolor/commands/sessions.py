"""Sessions of `autocolor view` and `show`: keeping a journal while one lasts, and those that were left.

The journal of a session stays if the session does not end orderly, such as by a signal.
"""

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


NEWEST: Final = "newest"
"""The choice of the newest session that can be read."""


def when(folder: Path) -> str:
    """The time of the last write of a session's journal, in local time."""
    return time.strftime("%Y-%m-%d %H:%M", time.localtime((folder / JOURNAL).stat().st_mtime))


def list_sessions() -> None:
    """Print a line for each session that was left, the newest first: name, time and steps."""
    for folder in left_sessions():
        try:
            session = read_journal(folder / JOURNAL)
        except InputError as error:
            description = str(error).replace("\n", "; ")
        else:
            steps = len(session.history.steps)
            description = f"{session.source.path}, {steps} step{'' if steps == 1 else 's'}"
        click.echo(f"{folder.name}  {when(folder)}  {description}")


def forget_session(name: str) -> None:
    """Remove a session that was left, by the beginning of its name, and say so on stderr."""
    folder = _named(name)
    forget(folder)
    click.echo(f"autocolor: {folder.name} is removed", err=True)


def chosen_session(name: str) -> tuple[Path, Session]:
    """The session whose name begins so, or the NEWEST that can be read, and its folder.

    Raises UsageError if no session or several have such a name, InputError if the session cannot be read,
    MissingInputError if no session is left.
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
    """The folder of the only session whose name begins so. Raises UsageError."""
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
    """Keep the journal of the session of a viewer; call the function that it yields often.

    A journal that cannot be written is reported once, in the viewer. Sessions that were left before are
    reported on stderr. `left` is the folder of the session that is continued, if any. SIGTERM and SIGHUP end
    the program at once, and leave the journal.
    """
    autosave = Autosave(left)
    _tell_left(viewer)
    reported: set[str] = set()

    def update(at_once: bool = False) -> None:
        try:
            autosave.update(viewer.studio.history, at_once)
        except AutocolorError as error:
            if str(error) not in reported:
                reported.add(str(error))
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
    """Report sessions that were left before, on stderr and in the viewer."""
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
        "a session was left: autocolor view --recover opens it; the right edge: the menu", stands=True
    )
