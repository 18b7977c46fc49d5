"""`ramtek serve`: a display for programs, over TCP or on a pipe."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import click

from ramtek_emu.commands.displays import (
    display_asked_for,
    display_options,
    recording,
    refuse_outputs,
    show,
    tell,
    tell_the_end,
    write_outputs,
)

if TYPE_CHECKING:
    from ramtek_emu.host.host_session import HostSession
    from ramtek_emu.host.pipe import Read, Write
    from ramtek_emu.host.server import Server

EXAMPLES: Final = """\b
Examples:
  ramtek serve --port 9300                          a display at tcp://127.0.0.1:9300
  ramtek serve --port 0 --window                    any free port, which is printed, and a window
  old_program | ramtek serve --stdio -o out.png     a program that only draws
  socat EXEC:./old_program EXEC:'ramtek serve --stdio'    one that reads back as well
"""

STEP_SECONDS: Final = 0.25


@click.command(epilog=EXAMPLES)
@click.option("--port", type=click.IntRange(0, 65535), help="Listen here; 0 is any free port.")
@click.option("--stdio", is_flag=True, help="Words on stdin, what is read back on stdout.")
@click.option("--host", default="127.0.0.1", show_default=True, help="The address to listen at.")
@click.option("--window", is_flag=True, help="Show what is drawn, as it is drawn.")
@click.option(
    "--idle",
    type=click.FloatRange(min=0.1),
    default=600.0,
    show_default=True,
    metavar="SECONDS",
    help="Show a silent host out after this long.",
)
@click.option("--once", is_flag=True, help="End when the first host has left.")
@display_options
def serve(
    port: int | None,
    stdio: bool,
    host: str,
    window: bool,
    idle: float,
    once: bool,
    output: str | None,
    snapshot: str | None,
    record: str | None,
    configuration: str | None,
    start: str | None,
    force: bool,
) -> None:
    """Be a display that a program sends words to, low byte first, and receives words from.

    Over TCP it serves one host after the other until Ctrl+C; a second one at the same time is refused. With
    --stdio it ends at the end of its input. Nobody is asked for a password: keep to the loopback address
    unless everyone who reaches the port may draw.
    """
    if stdio == (port is not None):
        raise click.UsageError("a display must be served on one of --port and --stdio; give one of them")
    refuse_outputs(force, output, snapshot, record)
    display = display_asked_for(configuration, start)

    from ramtek_emu.host.host_session import HostSession
    from ramtek_emu.host.server import Server

    with recording(record, force) as kept:
        if stdio:
            serve_stdio(HostSession(display, kept), window)
        else:
            with Server(display, port or 0, host, idle_seconds=idle, record=kept) as server:
                serve_port(server, window, once)
    write_outputs(display, output, snapshot, force)


def serve_stdio(session: HostSession, window: bool) -> None:
    """Serve the program at the other ends of stdin and stdout until it closes its end."""
    from ramtek_emu.host.pipe import PolledPipe, serve_pipe

    read, write = standard_streams()
    if window:
        show(session.display, PolledPipe(session, read, write).serve_for)
        return
    with end_signals() as signals:
        serve_pipe(session, signals.until_received(read), write)
    tell_the_end(session.display, session.held_words, session.odd_byte)


def standard_streams() -> tuple[Read, Write | None]:
    """Functions that read stdin and write stdout. From here on, nothing else can write to stdout."""
    if sys.stdin is None:
        return lambda _: b"", None
    number = sys.stdin.fileno()

    def read(most: int) -> bytes:
        return os.read(number, most)

    try:
        kept = os.dup(sys.stdout.fileno())
        # Redirect what is printed from here on, so that it does not mix with the words.
        os.dup2(sys.stderr.fileno() if sys.stderr is not None else kept, sys.stdout.fileno())
    except OSError:
        return read, None

    def write(data: bytes) -> None:
        view = memoryview(data)
        while view:
            view = view[os.write(kept, view) :]

    return read, write


def serve_port(server: Server, window: bool, once: bool) -> None:
    """Serve hosts over TCP until Ctrl+C, until the window is closed, or, with `once`, until a host leaves."""
    if window:
        announce(server)
        show(server.display, server.serve_for)
        return
    with end_signals() as signals:
        announce(server)
        while not signals.received and not (once and server.served):
            server.step(STEP_SECONDS)


def announce(server: Server) -> None:
    """Print the address for hosts, with a warning if other machines can reach it."""
    if server.host not in ("127.0.0.1", "localhost", "::1"):
        tell(
            f"warning: whoever reaches {server.address} can draw on this display and read it back; "
            "leave --host out to keep to this machine"
        )
    click.echo(server.address)
    sys.stdout.flush()


class EndSignals:
    """Remembers Ctrl+C or a termination signal, which end a server without an error."""

    def __init__(self) -> None:
        self.received = False
        self._waiting = False

    def receive(self, *_: object) -> None:
        """Remember the signal, and interrupt a read that is waiting."""
        self.received = True
        if self._waiting:
            raise InterruptedError

    def until_received(self, read: Read) -> Read:
        """A function like `read` that returns nothing after the signal, or if reading fails."""

        def read_until_received(most: int) -> bytes:
            try:
                self._waiting = True
                return b"" if self.received else read(most)
            except OSError:
                # Also raised by a terminal or a socket whose other end was closed.
                return b""
            finally:
                self._waiting = False

        return read_until_received


@contextmanager
def end_signals() -> Iterator[EndSignals]:
    """Handle Ctrl+C and termination signals within a `with` block."""
    signals = EndSignals()
    before = {number: signal.signal(number, signals.receive) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield signals
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
