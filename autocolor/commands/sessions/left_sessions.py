"""Sessions that did not end orderly, for `autocolor view`: listing, choosing and forgetting them."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.errors import InputError, MissingInputError, UsageError
from autocolor.journal.autosave import JOURNAL, forget, left_sessions
from autocolor.journal.reading import read_journal

if TYPE_CHECKING:
    from autocolor.journal.reading import Session

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
