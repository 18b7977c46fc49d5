"""`ramtek serve`: runs a display for programs, over TCP, on a Unix socket or on a pipe."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Final

import click

from ramtek_emu.command_line import report
from ramtek_emu.commands.displays import (
    TICK_SECONDS,
    display_asked_for,
    display_options,
    refuse_given,
    refuse_outputs,
    running,
    show,
    tell_the_end,
    tell_unexecuted,
)

if TYPE_CHECKING:
    from ramtek_emu.commands.displays import Run
    from ramtek_emu.host.pipe import Read, Write
    from ramtek_emu.host.server import Server

EXAMPLES: Final = """\b
Examples:
  ramtek serve --port 9300                          a display at tcp://127.0.0.1:9300
  ramtek serve --port 0 --window                    any free port, which is printed, and a window
  ramtek serve --port 9300 --inspect                pause its host, look back, ask who wrote a pixel
  ramtek serve --unix /tmp/display                  a display for programs that open a device
  ramtek serve --port 9300 --joystick -             type `cursor 100 200 enter` to point at something
  old_program | ramtek serve --stdio -o out.png     a program that only draws
  socat EXEC:./old_program EXEC:'ramtek serve --stdio'    one that reads back as well
"""

STEP_SECONDS: Final = 0.02
"""How long a line for the joystick, or a signal, may be unnoticed while no words arrive."""
WRITTEN_AT_ONCE: Final[int] = getattr(select, "PIPE_BUF", 512)
"""The most bytes that any pipe takes without waiting, if it can be written."""


@click.command(epilog=EXAMPLES)
@click.option("--port", type=click.IntRange(0, 65535), help="Listen here; 0 is any free port.")
@click.option("--unix", type=click.Path(), metavar="PATH", help="Listen at a Unix socket: whole writes.")
@click.option("--stdio", is_flag=True, help="Words on stdin, replies on stdout.")
@click.option("--host", default="127.0.0.1", show_default=True, help="The address to listen at.")
@click.option("--window", is_flag=True, help="Show the display in a window.")
@click.option("--inspect", is_flag=True, help="In a window, pause the host and look back.")
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
@click.pass_context
def serve(
    context: click.Context,
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
    if port is None:
        refuse_given(context, "without --port", "host")
    if stdio:
        refuse_given(context, "with --stdio", "idle", "once")
    if window or inspect:
        refuse_given(context, "with a window", "once")
    refuse_outputs(force, record, pictures=[output, snapshot])
    display = display_asked_for(configuration, start, table)

    from ramtek_emu.host.joystick import JoystickLines
    from ramtek_emu.host.pipe import PipeServer
    from ramtek_emu.host.server import TcpServer, UnixServer

    with running(display, output, snapshot, record, force) as run:
        lines = None if joystick is None else JoystickLines(joystick, report)
        server: TcpServer | UnixServer | PipeServer
        if unix is not None:
            server = UnixServer(display, unix, idle_seconds=idle, record=run.record)
        elif port is not None:
            server = TcpServer(display, port, host, idle_seconds=idle, record=run.record)
        else:
            server = PipeServer(display, *standard_streams(run), run.record)

        def obey() -> None:
            if lines is not None:
                lines.obey(display.joystick, server.session.reset)

        with server:
            if window or inspect:
                from ramtek_emu.monitor.window import open_screen

                # Fail before the address is printed.
                open_screen()
            if server.address:
                announce(server.address, host)
            if window or inspect:
                watch(server, run, obey, inspect)
            elif isinstance(server, PipeServer) and joystick is None:
                server.serve(lambda: run.ends)
            else:
                while not run.ends and not ((once or stdio) and server.served):
                    obey()
                    server.step(STEP_SECONDS)
                if isinstance(server, PipeServer):
                    server.finish(lambda: run.ends)
            if stdio:
                tell_the_end(server.session, run)
            else:
                tell_unexecuted(server.session)


def watch(server: Server, run: Run, obey: Callable[[], object], inspect: bool) -> None:
    """Show the display in a window, or in that of an inspector, until it is closed or a signal ends it."""
    caption = f"RAMTEK {server.display.configuration.name.replace('_', ' ')}"
    if inspect:
        from ramtek_emu.inspection.inspector import Inspector
        from ramtek_emu.inspection.running_host import RunningHost
        from ramtek_emu.inspection.session import inspection_of

        inspector = Inspector(inspection_of(RunningHost(server, obey)), caption)
        show(inspector.monitor, run, inspector.is_busy)
        return

    from ramtek_emu.host.server import HOST_SECONDS
    from ramtek_emu.monitor.window import Monitor

    def tick() -> None:
        obey()
        server.serve_for(TICK_SECONDS, HOST_SECONDS)

    show(Monitor(server.display, caption, on_tick=tick), run, lambda: server.busy)


def standard_streams(run: Run) -> tuple[Read, Write]:
    """Functions that read stdin, until a signal ends the display, and write stdout.

    After this call, nothing else can write to stdout.
    """
    stdin = -1 if sys.stdin is None else sys.stdin.fileno()

    def read(most: int) -> bytes:
        # A terminal or a socket raises an error if its other end was closed.
        with suppress(OSError, ValueError):
            return os.read(stdin, most) if run.wait(stdin) else b""
        return b""

    replies = os.dup(sys.stdout.fileno())
    # Redirect all printed text to stderr, so that it does not mix with the words.
    os.dup2(sys.stderr.fileno() if sys.stderr is not None else replies, sys.stdout.fileno())

    def write(data: bytes) -> None:
        view = memoryview(data)
        while view and run.wait(replies, to_write=True):
            view = view[os.write(replies, view[:WRITTEN_AT_ONCE]) :]

    return read, write


def announce(address: str, host: str) -> None:
    """Print the address for hosts, with a warning if other machines can reach it."""
    if host not in ("127.0.0.1", "localhost", "::1"):
        report(
            f"warning: whoever reaches {address} can draw on this display and read it back; "
            "leave --host out to keep to this machine"
        )
    click.echo(address)
    sys.stdout.flush()
