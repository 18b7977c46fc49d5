"""Sessions: autosaved while a viewer runs. An abandoned session can be listed, recovered or removed.

A session is abandoned if its program ended without closing it, for example by a signal.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.errors import AutocolorError, InputError, UsageError
from autocolor.journal.autosave import (
    Autosave,
    forget,
    left_sessions,
    newest_session,
    session_in,
    written_at,
)
from autocolor.screens.viewer import Viewer
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from autocolor.journal.journal import JournalSession

NEWEST: Final = "newest"
"""The choice of the newest session that can be read."""


@contextmanager
def autosaved_session(viewer: Viewer, folder: Path | None = None) -> Iterator[Callable[[], None]]:
    """Autosave the session of a viewer. Yields a function that the caller calls often.

    `folder` is the folder of a recovered session. If the journal cannot be written, the viewer shows a
    message once. Messages on stderr and in the viewer mention abandoned sessions. After an exception, such as
    `Ended` by a signal, the journal remains, with every step.
    """
    viewer.session.autosave = Autosave(folder)
    _mention_left_sessions(viewer)
    messages: set[str] = set()

    def autosave() -> Autosave:
        """The journal of the present session: the user may recover another one."""
        assert viewer.session.autosave is not None
        return viewer.session.autosave

    def update() -> None:
        try:
            autosave().update(viewer.studio.history)
        except AutocolorError as error:
            if str(error) not in messages:
                messages.add(str(error))
                viewer.tell(str(error))

    try:
        yield update
    except BaseException:
        with suppress(AutocolorError):
            autosave().update(viewer.studio.history, at_once=True)
        raise
    autosave().end()


def _mention_left_sessions(viewer: Viewer) -> None:
    """Mention abandoned sessions on stderr and in the viewer."""
    folders = left_sessions()
    if not folders:
        return
    count = f"{len(folders)} sessions were" if len(folders) > 1 else "a session was"
    click.echo(
        f"autocolor: {count} not closed, last written {_time_of(folders[0])}; `autocolor view --recover`"
        " opens the last session, `--sessions` lists them, `--forget SESSION` removes a session",
        err=True,
    )
    way = "file, recover" if viewer.session.is_at_hand else "autocolor view --recover"
    viewer.tell(f"a session was not closed: {way} opens it; {viewer.message}", persistent=True)


def list_sessions() -> None:
    """Print a line for each abandoned session, the newest first: its name, time, source and steps."""
    for folder in left_sessions():
        try:
            session = session_in(folder)
        except InputError as error:
            text = "; ".join(error.problems)
        else:
            steps = len(session.history.steps)
            text = f"{session.source.path}, {steps} step{'' if steps == 1 else 's'}"
        tell(f"{folder.name}  {_time_of(folder)}  {text}", err=False)


def forget_session(name: str) -> None:
    """Remove an abandoned session, by the beginning of its name, and say so on stderr."""
    folder = _folder_named(name)
    forget(folder)
    tell(f"autocolor: {folder.name} is removed")


def chosen_session(name: str) -> tuple[Path, JournalSession]:
    """The folder of an abandoned session and the session, by the beginning of its name.

    NEWEST is the newest session that can be read. Raises UsageError unless exactly one session has the name,
    InputError if the session cannot be read, MissingInputError for NEWEST if no session can be read.
    """
    if name != NEWEST:
        folder = _folder_named(name)
        return folder, session_in(folder)
    return newest_session(lambda problem: tell(f"autocolor: {problem}"))


def _folder_named(name: str) -> Path:
    """The folder of the only abandoned session whose name begins with `name`. Raises UsageError."""
    folders = [folder for folder in left_sessions() if name and folder.name.startswith(name)]
    if len(folders) != 1:
        raise UsageError(
            f"SESSION must begin the name of one session, and {name!r} begins {len(folders)}; choose a name"
            " from `autocolor view --sessions`"
        )
    return folders[0]


def _time_of(folder: Path) -> str:
    """The time of the last write to the journal of a session, in local time."""
    try:
        return time.strftime("%Y-%m-%d %H:%M", time.localtime(written_at(folder)))
    except (OverflowError, ValueError, OSError):
        # A file may have any time.
        return "at no valid time"
