"""`ramtek serve`: runs a display for programs, over TCP, on a Unix socket or on a pipe."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Final

import click

from ramtek_emu.commands.displays import (
    display_asked_for,
    display_options,
    end_signals,
    recording,
    refuse_outputs,
    show,
    tell,
    tell_the_end,
    write_outputs,
)

if TYPE_CHECKING:
    from ramtek_emu.host.joystick import JoystickLines
    from ramtek_emu.host.pipe import Read, Write
    from ramtek_emu.host.server import HostSession, Server, TcpServer, UnixServer

EXAMPLES: Final = """\b
Examples:
  ramtek serve --port 9300                          a display at tcp://127.0.0.1:9300
  ramtek serve --port 0 --window                    any free port, which is printed, and a window
  ramtek serve --unix /tmp/display                  one for `ramtek tty` and programs of the time
  ramtek serve --port 9300 --joystick -             type `cursor 100 200 enter` to point at something
  old_program | ramtek serve --stdio -o out.png     a program that only draws
  socat EXEC:./old_program EXEC:'ramtek serve --stdio'    one that reads back as well
"""

STEP_SECONDS: Final = 0.25
JOYSTICK_SECONDS: Final = 0.02
"""How long a line for the joystick may wait while no words arrive."""
HOST_SECONDS: Final = 0.005
"""How long the input of a window may wait while a connected host sends nothing. Its words never wait."""
PIPE_SECONDS: Final = 0.002
"""How long words on a pipe may wait if `--joystick` is given."""


@click.command(epilog=EXAMPLES)
@click.option("--port", type=click.IntRange(0, 65535), help="Listen here; 0 is any free port.")
@click.option("--unix", type=click.Path(), metavar="PATH", help="Listen at a Unix socket: whole writes.")
@click.option("--stdio", is_flag=True, help="Words on stdin, replies on stdout.")
@click.option("--host", default="127.0.0.1", show_default=True, help="The address to listen at.")
@click.option("--window", is_flag=True, help="Show the display in a window.")
@click.option(
    "--joystick",
    metavar="FILE",
    help="Lines for the joystick from a FIFO or - for stdin: cursor X Y, enter, track on, reset.",
)
@click.option(
    "--idle",
    type=click.FloatRange(min=0.1),
    default=600.0,
    show_default=True,
    metavar="SECONDS",
    help="Disconnect a host that is silent for this long.",
)
@click.option("--once", is_flag=True, help="End when the first host has left.")
@display_options
def serve(
    port: int | None,
    unix: str | None,
    stdio: bool,
    host: str,
    window: bool,
    joystick: str | None,
    idle: float,
    once: bool,
    output: str | None,
    snapshot: str | None,
    record: str | None,
    configuration: str | None,
    start: str | None,
    force: bool,
) -> None:
    """Run a display. Programs send and receive 16-bit words, low byte first.

    With --port or --unix it serves one host after the other until Ctrl+C; others wait in line meanwhile. At a
    Unix socket each write is rounded down to whole words by itself, as the drivers of the time did. With
    --stdio it ends at the end of its input. Nobody is asked for a password: keep to the loopback address
    unless everyone who reaches the port may draw; a Unix socket is for its owner only.
    """
    if (port is not None) + (unix is not None) + stdio != 1:
        raise click.UsageError(
            "a display must be served on one of --port, --unix and --stdio; give one of them"
        )
    if stdio and joystick == "-":
        raise click.UsageError(
            "stdin must be for words or for the joystick, not both; give --joystick a FIFO"
        )
    refuse_outputs(force, output, snapshot, record)
    display = display_asked_for(configuration, start)

    from ramtek_emu.host.joystick import JoystickLines
    from ramtek_emu.host.server import HostSession, TcpServer, UnixServer

    def lines_for(resettable: HostSession | Server) -> JoystickLines | None:
        if joystick is None:
            return None
        return JoystickLines(joystick, display.joystick, resettable.reset, tell)

    with recording(record, force) as write:
        if stdio:
            session = HostSession(display, write)
            serve_stdio(session, window, lines_for(session))
        else:
            server: TcpServer | UnixServer
            if unix is not None:
                server = UnixServer(display, unix, idle_seconds=idle, record=write)
            else:
                server = TcpServer(display, port or 0, host, idle_seconds=idle, record=write)
            with server:
                serve_hosts(server, window, once, lines_for(server))
    write_outputs(display, output, snapshot, force)


def serve_stdio(session: HostSession, window: bool, lines: JoystickLines | None = None) -> None:
    """Serve the program at the other end of stdin and stdout until it closes its end."""
    from ramtek_emu.host.pipe import PolledPipe, serve_pipe

    read, write = standard_streams()
    if window:
        show(session.display, obeying(lines, PolledPipe(session, read, write).serve_for))
        return
    with end_signals() as signals:
        if lines is None:
            serve_pipe(session, signals.until_received(read), write)
        else:
            pipe = PolledPipe(session, read, write)
            while not signals.received and not (pipe.ended and pipe.has_replied):
                lines.obey()
                if pipe.ended or not pipe.step():
                    time.sleep(PIPE_SECONDS)
    tell_the_end(session)


def obeying(lines: JoystickLines | None, serve_for: Callable[[float], None]) -> Callable[[float], None]:
    """A function that obeys the lines for the joystick, then calls `serve_for`."""
    if lines is None:
        return serve_for
    obey = lines.obey

    def obey_and_serve_for(seconds: float) -> None:
        obey()
        serve_for(seconds)

    return obey_and_serve_for


def standard_streams() -> tuple[Read, Write | None]:
    """Functions that read stdin and write stdout. After this call, nothing else can write to stdout."""
    if sys.stdin is None:
        return lambda _: b"", None
    number = sys.stdin.fileno()

    def read(most: int) -> bytes:
        return os.read(number, most)

    try:
        replies = os.dup(sys.stdout.fileno())
        # Redirect all printed text to stderr, so that it does not mix with the words.
        os.dup2(sys.stderr.fileno() if sys.stderr is not None else replies, sys.stdout.fileno())
    except OSError:
        return read, None

    def write(data: bytes) -> None:
        view = memoryview(data)
        while view:
            view = view[os.write(replies, view) :]

    return read, write


def serve_hosts(
    server: TcpServer | UnixServer, window: bool, once: bool, lines: JoystickLines | None = None
) -> None:
    """Serve hosts until Ctrl+C, until the window is closed, or, with `once`, until a host leaves."""
    if window:
        from ramtek_emu.monitor.window import open_screen

        # Fail before the address is printed.
        open_screen()
        announce(server)
        serve_for = partial(server.serve_for, wait=HOST_SECONDS)
        show(server.display, obeying(lines, serve_for), lambda: server.busy)
        return
    with end_signals() as signals:
        announce(server)
        while not signals.received and not (once and server.served):
            if lines is not None:
                lines.obey()
            server.step(STEP_SECONDS if lines is None else JOYSTICK_SECONDS)


def announce(server: TcpServer | UnixServer) -> None:
    """Print the address for hosts, with a warning if other machines can reach it."""
    host = getattr(server, "host", "localhost")
    if host not in ("127.0.0.1", "localhost", "::1"):
        tell(
            f"warning: whoever reaches {server.address} can draw on this display and read it back; "
            "leave --host out to keep to this machine"
        )
    click.echo(server.address)
    sys.stdout.flush()
