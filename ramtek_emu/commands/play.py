"""`ramtek play`: runs a stream of instructions from a file, in a window, into a picture or into a film."""

from __future__ import annotations

import errno
import os
from functools import partial
from typing import Final

import click

from ramtek_emu.command_line import Ended, report
from ramtek_emu.commands.displays import (
    TICK_SECONDS,
    display_asked_for,
    display_options,
    open_stream,
    refuse_given,
    refuse_outputs,
    running,
    show,
    tell_the_end,
    unreadable,
)

EXAMPLES: Final = """\b
Examples:
  ramtek play drawing.ramtek
  ramtek play circling_light.ramtek --loads-per-second 30
  ramtek play drawing.ramtek -o drawing.png --configuration princeton_9300
  ramtek play drawing.ramtek --film drawing.webp --every 1 --once
  ramtek play circling_light.ramtek --film "circling/{number:04}.png"
  old_program | ramtek play - -o drawing.png --record drawing.ramtek
"""


@click.command(epilog=EXAMPLES)
@click.argument("stream", type=click.Path())
@display_options
@click.option(
    "--loads-per-second",
    type=click.IntRange(1, 1000),
    metavar="RATE",
    help="In the window, load the table at most so often: an animation of table loads.",
)
@click.option(
    "--film",
    metavar="FILE",
    help="Write a film: .webp, which loses nothing, or a name pattern for numbered pictures such as"
    " {number:04}.png. Its last frame is the picture at the end.",
)
@click.option(
    "--every",
    type=click.IntRange(min=1),
    metavar="N",
    help="A frame of the film after every N instructions; without it, after every load of the table (LAM).",
)
@click.option(
    "--fps",
    # The limits are those of `films`, whose module would import Pillow for each command.
    type=click.FloatRange(0.1, 100),
    default=24.0,
    show_default=True,
    metavar="RATE",
    help="Frames per second of the film.",
)
@click.option("--once", is_flag=True, help="Show the film once; otherwise it begins again at its end.")
@click.pass_context
def play(
    context: click.Context,
    stream: str,
    output: str | None,
    snapshot: str | None,
    configuration: str | None,
    table: str | None,
    start: str | None,
    force: bool,
    record: str | None,
    loads_per_second: int | None,
    film: str | None,
    every: int | None,
    fps: float,
    once: bool,
) -> None:
    """Run STREAM, a file of 16-bit words with the low byte first; - is stdin.

    Without -o, --snapshot or --film it is shown in a window. The replies to instructions that read are
    dropped.
    """
    film_file = None
    in_window = output is None and snapshot is None and film is None
    if not in_window:
        refuse_given(context, "with an output", "loads_per_second")
    if film is None:
        refuse_given(context, "without --film", "every", "fps", "once")
    else:
        from ramtek_emu.films import check_film, write_film

        film_file = check_film(film, fps, force)
    refuse_outputs(force, record, film_file, pictures=[output, snapshot])
    file = open_stream(stream)
    display = display_asked_for(configuration, start, table)

    from ramtek_emu.host import pipe

    number = file.fileno()
    with file, running(display, output, snapshot, record, force) as run:

        def read(most: int) -> bytes:
            try:
                return os.read(number, most) if run.wait(number) else b""
            except OSError as cause:
                # The window stays open, and outputs are written, with the words that were read. The file is
                # closed once the window is.
                if cause.errno != errno.EBADF:
                    run.fail(unreadable(cause))
                return b""

        if in_window:
            shown: pipe.Read = read
            if loads_per_second is not None:
                shown = pipe.paced(read, loads_per_second, display.configuration)
            from ramtek_emu.monitor.window import Monitor

            caption = f"RAMTEK {display.configuration.name.replace('_', ' ')}"
            with pipe.PipeServer(display, shown, record=run.record) as server:
                show(Monitor(display, caption, on_tick=partial(server.serve_for, TICK_SECONDS)), run)
            return
        server = pipe.PipeServer(display, read, record=run.record)
        if film is None:
            server.serve(lambda: run.ends)
        else:
            is_cut = pipe.is_load if every is None else pipe.every(every)
            cut = pipe.stream_pieces(read, display.configuration, is_cut)
            fields = pipe.stream_fields(server.session, cut, lambda: run.ends)
            write = partial(write_film, film, fields, fields_per_second=fps, loop=not once, overwrite=force)
            if run.attempt(write):
                report(f"wrote {film}")
            # After a film that failed, the stream goes on.
            for _ in fields:
                pass
        tell_the_end(server.session, run)
    if run.signal:
        raise Ended(run.signal)
