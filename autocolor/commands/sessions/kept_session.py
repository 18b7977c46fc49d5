"""Keeping the session of a window: its journal stays unless the window is closed by its user."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType
from typing import Final, NoReturn

import click

from autocolor.commands.sessions.left_sessions import when
from autocolor.errors import AutocolorError
from autocolor.journal.autosave import Autosave, left_sessions
from autocolor.screens.viewer import Viewer

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
        "a session was left: autocolor view --recover opens it; the right edge: the menu", stands=True
    )
