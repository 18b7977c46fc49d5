"""`autocolor animate`: the frames between variants of a scene or a picture, as a film or a stream."""

from __future__ import annotations

from contextlib import nullcontext
from typing import Final

import click
from click.core import ParameterSource

from autocolor.checks import brief
from autocolor.commands.completion import complete_settings
from autocolor.commands.options import (
    as_usage,
    hold_option,
    normals_option,
    size_option,
    smooth_option,
)
from autocolor.commands.outputs import progress
from autocolor.commands.scenes import SceneSource, scene_options, set_option
from autocolor.commands.sweep import (
    jobs_option,
    refuse_keys,
    scene_in,
    start_of,
    table_option,
    tell_paints,
    workers,
)
from autocolor.errors import InputError, UsageError
from ramtek_emu.command_line import tell

EXAMPLES: Final = """\b
Examples:
  autocolor animate scenes/coupe --turn 360 --frames 72 -o around.webp
  autocolor animate scenes/coupe --vary lights.key.position=[-8,-6,5],[2,-6,5] -o sweep.apng
  autocolor animate coupe.npz --vary surfaces.body.object_color=red,navy,red -o fade.gif
  autocolor animate scenes/coupe --table looks.csv -o "looks/{number:04}.png" --jobs 4
  autocolor animate coupe.npz --vary surfaces.body.object_color=red,navy -o fade.ramtek
"""

FRAMES: Final = 48
"""Assumed: by default, an animation lasts two seconds."""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option(
    "--vary",
    "varies",
    multiple=True,
    metavar="KEY=VALUES",
    shell_complete=complete_settings,
    help="Vary a field over the whole duration: A,B,C, evenly spaced in time. Several --vary run together.",
)
@table_option
@click.option(
    "--turn",
    type=float,
    default=0.0,
    metavar="DEGREES",
    help="Turn the eye around the view's target, counterclockwise as seen from above; 360 is a whole round.",
)
@click.option(
    "--frames",
    "count",
    type=click.IntRange(1, 100_000),
    default=FRAMES,
    show_default=True,
    metavar="N",
    help="Number of frames.",
)
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="FILE",
    help="File to write: .webp or .apng (lossless), .gif (256 colors a frame), a name pattern for numbered"
    " pictures such as {number:04}.png, or .ramtek, a load of the lookup table a frame.",
)
@click.option(
    "--fps",
    type=float,
    default=24.0,
    show_default=True,
    metavar="RATE",
    help="Frames per second of a film.",
)
@click.option("--once", is_flag=True, help="Show the film once; otherwise it begins again at its end.")
@hold_option
@set_option
@normals_option
@jobs_option
@size_option
@smooth_option
@click.option("--force", is_flag=True, help="Overwrite an existing file.")
@click.pass_context
def animate(
    context: click.Context,
    source: SceneSource,
    varies: tuple[str, ...],
    table: str | None,
    turn: float,
    count: int,
    output: str,
    fps: float,
    once: bool,
    hold_exposure: bool,
    settings: tuple[str, ...],
    normals: bool,
    jobs: int,
    size: tuple[int, int],
    smooth: int | None,
    force: bool,
) -> None:
    """Animate SCENE: a scene, a mesh file or a picture file.

    Between two variants, numbers, points, colors and the view are interpolated, and everything else holds. If
    the last variant equals the first, the last frame is left out, because the film begins again. Each frame
    costs only what its edit changes: a fade of paint renders once.
    """
    from autocolor.batches import films
    from autocolor.batches.frames import frames_of_tracks, in_step, times_of
    from autocolor.batches.table import read_variants, varied
    from autocolor.images import default_smooth

    if not varies and table is None and not turn:
        raise UsageError("animate must have --vary, --table or --turn; write it as in --turn 360")
    kind = films.kind_of(output)
    films.check_rate(fps, kind)
    is_sized = context.get_parameter_source("size") is ParameterSource.COMMANDLINE
    tables = [] if table is None else [read_variants(table)]
    if table is not None:
        try:
            times_of(tables[0])
        except UsageError as error:
            raise InputError(f"{brief(table)}: {error}") from None
    tables += [varied(text) for text in varies]
    samples = smooth or (1 if kind == films.STREAM else default_smooth(size))
    start, code = start_of(source, settings, size, samples if hold_exposure else 0, normals)
    refuse_keys(start, tables, table)
    tell_paints(start, tables)
    is_picture = isinstance(start, tuple)
    own = tables[: 0 if table is None else 1]
    tracks = [*own, *in_step(tables[len(own) :])]
    with as_usage() if table is None else nullcontext():
        frames = frames_of_tracks(scene_in(start), tracks, count, turn=turn)
    with progress(len(frames)) as step, workers(jobs) as executor:
        film = films.animate(
            start,
            frames,
            output,
            frames_per_second=fps,
            loop=not once,
            size=size if is_sized or not is_picture else None,
            smooth=smooth,
            executor=executor,
            overwrite=force,
            progress=lambda _: step(),
        )
    if film.lossy:
        from ramtek_emu.films import Loss

        tell(Loss(film.lossy, film.largest_loss).sentence(film.frames))
    tell(f"wrote {film.path}, {film.frames:,} frame{'' if film.frames == 1 else 's'}")
    context.exit(code)
