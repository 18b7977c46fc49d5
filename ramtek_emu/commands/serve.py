"""`ramtek serve`: runs a display for programs, over TCP, on a Unix socket or on a pipe."""

from __future__ import annotations

import os
import select
import stat
import sys
import time
from collections.abc import Callable
from contextlib import nullcontext, suppress
from functools import partial
from typing import TYPE_CHECKING, Final

import click

from ramtek_emu.commands.displays import (
    display_asked_for,
    display_options,
    refuse_outputs,
    running,
    show,
    tell,
    tell_the_end,
    tell_unexecuted,
)

if TYPE_CHECKING:
    from ramtek_emu.commands.displays import Run
    from ramtek_emu.display import Ramtek9300
    from ramtek_emu.host.pipe import Read, Write
    from ramtek_emu.host.server import HostSession, Server
    from ramtek_emu.inspection.running_host import RunningHost

Obey = Callable[[], object]
"""A function that obeys the waiting lines for the joystick."""

EXAMPLES: Final = """\b
Examples:
  ramtek serve --port 9300                          a display at tcp://127.0.0.1:9300
  ramtek serve --port 0 --window                    any free port, which is printed, and a window
  ramtek serve --port 9300 --inspect                stop its host, step, ask who wrote a pixel
  ramtek serve --unix /tmp/display                  a display for programs that open a device
  ramtek serve --port 9300 --joystick -             type `cursor 100 200 enter` to point at something
  old_program | ramtek serve --stdio -o out.png     a program that only draws
  socat EXEC:./old_program EXEC:'ramtek serve --stdio'    one that reads back as well
"""

STEP_SECONDS: Final = 0.1
JOYSTICK_SECONDS: Final = 0.02
"""How long a line for the joystick may wait while no words arrive."""
PIPE_SECONDS: Final = 0.002
"""How long words on a pipe may wait if `--joystick` is given."""
WRITTEN_AT_ONCE: Final[int] = getattr(select, "PIPE_BUF", 512)
"""The most bytes that any pipe takes without waiting, if it can be written."""
MOST_WRITTEN: Final = 1 << 16
"""The most bytes that are written at once to a pipe that never waits."""


@click.command(epilog=EXAMPLES)
@click.option("--port", type=click.IntRange(0, 65535), help="Listen here; 0 is any free port.")
@click.option("--unix", type=click.Path(), metavar="PATH", help="Listen at a Unix socket: whole writes.")
@click.option("--stdio", is_flag=True, help="Words on stdin, replies on stdout.")
@click.option("--host", default="127.0.0.1", show_default=True, help="The address to listen at.")
@click.option("--window", is_flag=True, help="Show the display in a window.")
@click.option("--inspect", is_flag=True, help="In a window, pause the host, step, and look back.")
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
    inspect: bool,
    joystick: str | None,
    idle: float,
    once: bool,
    output: str | None,
    snapshot: str | None,
    record: str | None,
    configuration: str | None,
    table: str | None,
    start: str | None,
    force: bool,
) -> None:
    """Run a display. Programs send and receive 16-bit words, low byte first.

    With --port or --unix it serves one host after the other until Ctrl+C; other hosts wait in line. At a Unix
    socket every write is rounded down to whole words, as the drivers of the time did. With --stdio it ends at
    the end of its input. There is no password: keep to the loopback address unless everyone who reaches the
    port may draw. Only its owner may use a Unix socket.
    """
    if (port is not None) + (unix is not None) + stdio != 1:
        raise click.UsageError(
            "a display must be served on one of --port, --unix and --stdio; give one of them"
        )
    if stdio and joystick == "-":
        raise click.UsageError(
            "stdin must be for words or for the joystick, not both; give --joystick a FIFO"
        )
    refuse_outputs(force, record, pictures=[output, snapshot])
    display = display_asked_for(configuration, start, table)

    from ramtek_emu.host.server import HostSession, TcpServer, UnixServer

    with running(display, output, snapshot, record, force) as run:
        inspected: RunningHost | None = None
        if inspect:
            from ramtek_emu.inspection.running_host import RunningHost

            inspected = RunningHost(display, run.record)
        recording = run.record if inspected is None else inspected.record
        server: Server | None = None
        if unix is not None:
            server = UnixServer(display, unix, idle_seconds=idle, record=recording)
        elif port is not None:
            server = TcpServer(display, port, host, idle_seconds=idle, record=recording)
        with server or nullcontext():
            session = HostSession(display, recording) if server is None else server.session
            if inspected is not None:
                inspected.session = session
            obey: Obey | None = None
            if joystick is not None:
                from ramtek_emu.host.joystick import JoystickLines

                obey = JoystickLines(joystick, display.joystick, session.reset, tell).obey
            if server is None:
                serve_stdio(session, run, window, obey, inspected)
            else:
                serve_hosts(server, run, window, once, obey, inspected)
                tell_unexecuted(server.unexecuted)


def serve_stdio(
    session: HostSession, run: Run, window: bool, obey: Obey | None, inspected: RunningHost | None
) -> None:
    """Serve the program at the other end of stdin and stdout until it closes its end."""
    from ramtek_emu.host.pipe import PolledPipe, serve_pipe
    from ramtek_emu.host.port import waiting_bytes

    read, write = standard_streams(run)
    source: HostSession | PolledPipe = session
    if not window and inspected is None and obey is None:
        serve_pipe(session, read, write, lambda: run.ends)
    else:
        source = pipe = PolledPipe(session, read, write)
        if window or inspected is not None:
            watch(session.display, run, obey, inspected, lambda _: pipe.step(), pipe.serve_for)
        while obey and not (window or inspected or run.ends or (pipe.ended and pipe.has_replied)):
            obey()
            if pipe.ended or not pipe.step():
                time.sleep(PIPE_SECONDS)
    tell_the_end(session, is_cut_off=run.ends)
    tell_unexecuted(source.unexecuted + (waiting_bytes(sys.stdin.fileno()) // 2 if sys.stdin else 0))


def watch(
    display: Ramtek9300,
    run: Run,
    obey: Obey | None,
    inspected: RunningHost | None,
    step: Callable[[float], bool],
    serve_for: Callable[[float], None],
    is_busy: Callable[[], bool] = lambda: False,
) -> None:
    """Show the display in a window, or in that of an inspector, until it is closed or a signal ends it."""
    if inspected is not None:
        from ramtek_emu.inspection import inspector

        inspected.step, inspected.is_connected = step, is_busy
        inspected.obey = obey or inspected.obey
        name = display.configuration.name.replace("_", " ")
        hint = partial(run.hint_at_rest, display)
        inspector.inspect_host(inspected, f"RAMTEK {name}", hint, lambda: run.ends)
        return

    def obey_and_serve_for(seconds: float) -> None:
        if obey is not None:
            obey()
        serve_for(seconds)

    show(display, run, obey_and_serve_for, is_busy)


def standard_streams(run: Run) -> tuple[Read, Write | None]:
    """Functions that read stdin and write stdout until a signal ends the display.

    After this call, nothing else can write to stdout.
    """
    if sys.stdin is None:
        return lambda _: b"", None
    number = sys.stdin.fileno()

    def read(most: int) -> bytes:
        # A terminal or a socket raises an error if its other end was closed.
        with suppress(OSError):
            return os.read(number, most) if run.wait(number) else b""
        return b""

    try:
        replies, at_once = replies_to(sys.stdout.fileno())
        # Redirect all printed text to stderr, so that it does not mix with the words.
        os.dup2(sys.stderr.fileno() if sys.stderr is not None else replies, sys.stdout.fileno())
    except OSError:
        return read, None

    def write(data: bytes) -> None:
        view = memoryview(data)
        while view and run.wait(replies, to_write=True):
            with suppress(BlockingIOError):
                view = view[os.write(replies, view[:at_once]) :]

    return read, write


def replies_to(stdout: int) -> tuple[int, int]:
    """A descriptor for replies, and how many bytes it takes without waiting once it can be written."""
    with suppress(OSError):
        if sys.platform == "linux" and stat.S_ISFIFO(os.fstat(stdout).st_mode):
            # A pipe that is opened anew can be set not to wait, and waits as before for other programs.
            return os.open(f"/proc/self/fd/{stdout}", os.O_WRONLY | os.O_NONBLOCK), MOST_WRITTEN
    return os.dup(stdout), WRITTEN_AT_ONCE


def serve_hosts(
    server: Server,
    run: Run,
    window: bool,
    once: bool,
    obey: Obey | None,
    inspected: RunningHost | None,
) -> None:
    """Serve hosts until a signal, until the window is closed, or, with `once`, until a host leaves."""
    if window or inspected is not None:
        from ramtek_emu.host.server import HOST_SECONDS
        from ramtek_emu.monitor.window import open_screen

        # Fail before the address is printed.
        open_screen()
        announce(server)
        serve_for = partial(server.serve_for, wait=HOST_SECONDS)
        watch(server.display, run, obey, inspected, server.step, serve_for, lambda: server.busy)
        return
    announce(server)
    while not run.ends and not (once and server.served):
        if obey is not None:
            obey()
        server.step(STEP_SECONDS if obey is None else JOYSTICK_SECONDS)


def announce(server: Server) -> None:
    """Print the address for hosts, with a warning if other machines can reach it."""
    host = getattr(server, "host", "localhost")
    if host not in ("127.0.0.1", "localhost", "::1"):
        tell(
            f"warning: whoever reaches {server.address} can draw on this display and read it back; "
            "leave --host out to keep to this machine"
        )
    click.echo(server.address)
    sys.stdout.flush()
