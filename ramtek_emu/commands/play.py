"""`ramtek play`: runs a stream of instructions from a file, in a window or into a picture."""

from __future__ import annotations

import os
from typing import Final

import click

from ramtek_emu.command_line import Ended
from ramtek_emu.commands.displays import (
    display_asked_for,
    display_options,
    open_stream,
    refuse_outputs,
    running,
    show,
    tell_the_end,
    tell_unexecuted,
)
from ramtek_emu.errors import MissingInputError, reason_of

EXAMPLES: Final = """\b
Examples:
  ramtek play drawing.ramtek
  ramtek play circling_light.ramtek --loads-per-second 30
  ramtek play drawing.ramtek -o drawing.png --configuration princeton_9300
  old_program | ramtek play - -o drawing.png --record drawing.ramtek
"""


@click.command(epilog=EXAMPLES)
@click.argument("stream", type=click.Path())
@display_options
@click.option("--window", is_flag=True, help="Open the window even if a picture is written.")
@click.option(
    "--loads-per-second",
    type=click.IntRange(1, 1000),
    metavar="RATE",
    help="In the window, load the table at most so often: an animation of table loads.",
)
def play(
    stream: str,
    output: str | None,
    snapshot: str | None,
    configuration: str | None,
    start: str | None,
    force: bool,
    record: str | None,
    window: bool,
    loads_per_second: int | None,
) -> None:
    """Run STREAM, a file of 16-bit words with the low byte first; - is stdin.

    Without -o or --snapshot it is shown in a window. The replies to instructions that read are dropped.
    """
    in_window = window or (output is None and snapshot is None)
    if loads_per_second is not None and not in_window:
        raise click.UsageError("--loads-per-second is for the window; add --window, or leave it out")
    refuse_outputs(force, output, snapshot, record)
    file = open_stream(stream)
    display = display_asked_for(configuration, start)

    from ramtek_emu.host.pipe import PacedReader, PolledPipe, serve_pipe
    from ramtek_emu.host.port import waiting_bytes
    from ramtek_emu.host.server import HostSession

    number = file.fileno()
    with file, running(display, output, snapshot, record, force) as run:

        def read(most: int) -> bytes:
            try:
                return os.read(number, most) if run.wait(number) else b""
            except OSError as cause:
                raise MissingInputError(
                    f"a stream must be readable to its end, not fail ({reason_of(cause)}); try a copy of it"
                ) from None

        session = HostSession(display, run.record)
        if in_window:
            paced = read
            if loads_per_second is not None:
                paced = PacedReader(read, loads_per_second, display.configuration)
            show(display, run, PolledPipe(session, paced).serve_for)
            return
        serve_pipe(session, read, None, lambda: run.ends)
        tell_the_end(session)
        tell_unexecuted(session.unexecuted + waiting_bytes(number) // 2)
    if run.signal:
        raise Ended(run.signal)
