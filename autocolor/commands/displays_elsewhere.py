"""Displays elsewhere: their addresses, and the interactive system on one until its user leaves.

There the unit is all that a user has: a place, ENTER and TRACK. It is polled; everything else is a menu row.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from autocolor.errors import UnavailableError, UsageError

if TYPE_CHECKING:
    from autocolor.journal.history import History
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import TcpPort, UnixPort


def refuse_address(address: str) -> None:
    """Check an address: tcp://host:port, or the path of a Unix socket, which has a slash.

    Raises UsageError for any other.
    """
    from ramtek_emu import PortError
    from ramtek_emu.host.port import host_and_port

    if _is_path(address):
        return
    try:
        host_and_port(address)
    except PortError as error:
        raise UsageError(f"--to: {error}, or the path of a Unix socket with a slash in it") from None


def port_to(address: str) -> TcpPort | UnixPort:
    """A port to the display at an address. Raises PortError if it is not reached."""
    from ramtek_emu import TcpPort, UnixPort

    return UnixPort(address) if _is_path(address) else TcpPort(address)


def _is_path(address: str) -> bool:
    return "/" in address and "://" not in address


def session_elsewhere(
    history: History,
    address: str,
    folder: Path,
    left: Path | None = None,
    prepare: Callable[[Viewer], object] = lambda _: None,
) -> None:
    """The interactive system with the scene of a session on the display at an address, until its user leaves.

    Files are opened and saved in the folder. The journal is kept in the state folder until then; `left` is
    its folder there if the session was left before. `prepare` is called with the viewer at the beginning.
    Raises UnavailableError if the display goes away or does not answer, PortError if it is not reached.
    """
    from autocolor.commands.sessions import autosaved_session
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import PortError, ReplyError

    with port_to(address) as port:
        try:
            viewer = Viewer(history, port, folder)
            viewer.tell("the right edge brings the menu; ENTER picks, TRACK drags", persistent=True)
            prepare(viewer)
            click.echo(f"shown on {address}; pick `leave` in the menu there, or press Ctrl+C here", err=True)
            with autosaved_session(viewer, left) as update:
                attend(viewer, update)
            viewer.clear()
        except (PortError, ReplyError) as error:
            told = str(error)
            if isinstance(error, ReplyError):
                told = (
                    f"a display must answer within {port.timeout:g} seconds, and {address} does not; it may"
                    " be serving another host first"
                )
            if history.steps:
                told += "; `autocolor show --recover --to ADDRESS` goes on with the session"
            raise UnavailableError(told) from None


def attend(viewer: Viewer, update: Callable[[], object]) -> None:
    """Poll the unit, and call `update` after each poll, until the user leaves; sleep between the polls."""
    from autocolor.screens.input import POLL_SECONDS

    due = time.monotonic()
    while not viewer.session.leaves:
        viewer.poll()
        viewer.on_tick()
        update()
        # A poll that was late is not made up for.
        due = max(due + POLL_SECONDS, time.monotonic())
        time.sleep(max(0.0, due - time.monotonic()))
