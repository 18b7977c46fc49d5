"""`autocolor animate`: the frames between variants of a scene or a picture, as a film or a stream."""

from __future__ import annotations

from contextlib import nullcontext
from typing import Final

import click

from autocolor.checks import brief
from autocolor.commands.completion import complete_settings
from autocolor.commands.options import as_usage, flag, force_option, option
from autocolor.commands.outputs import progress
from autocolor.commands.scenes import SceneSource, scene_in, scene_options
from autocolor.commands.sweep import jobs_option, started, table_option, workers
from autocolor.errors import InputError, UsageError
from ramtek_emu.command_line import tell

EXAMPLES: Final = """\b
Examples:
  autocolor animate scenes/coupe --turn 360 --frames 72 -o around.webp
  autocolor animate scenes/coupe --vary lights.key.position=[-8,-6,5],[2,-6,5] -o sweep.webp
  autocolor animate coupe.npz --vary surfaces.body.object_color=red,navy,red -o fade.webp
  autocolor animate scenes/coupe --table looks.csv -o "looks/{number:04}.png" --jobs 4
  autocolor animate coupe.npz --vary surfaces.body.object_color=red,navy -o fade.ramtek
"""

FRAMES: Final = 48
"""Assumed: by default, an animation lasts two seconds."""


@click.command(epilog=EXAMPLES)
@scene_options("settings", "stage", "normals", "size", "smooth", "hold_exposure")
@option(
    "--vary varies",
    "KEY=VALUES",
    "Vary a field over the whole duration: A,B,C, evenly spaced in time. Several --vary run together.",
    str,
    multiple=True,
    shell_complete=complete_settings,
)
@table_option
@option(
    "--turn",
    "DEGREES",
    "Turn the eye around the view's target, counterclockwise as seen from above; 360 is a whole round.",
    float,
    default=0.0,
)
@option("--frames count", "N", "Number of frames.", click.IntRange(1, 100_000), default=FRAMES)
@option(
    "-o --output",
    "FILE",
    "File to write: .webp, which loses nothing, a name pattern for numbered pictures"
    " such as {number:04}.png, or .ramtek, a load of the lookup table a frame.",
    required=True,
)
@option("--fps", "RATE", "Frames per second of a film.", float, default=24.0)
@flag("--once", "Show the film once; otherwise it begins again at its end.")
@jobs_option
@force_option
def animate(
    source: SceneSource,
    varies: tuple[str, ...],
    table: str | None,
    turn: float,
    count: int,
    output: str,
    fps: float,
    once: bool,
    jobs: int,
    force: bool,
) -> int:
    """Animate SCENE: a scene, a mesh file or a picture file.

    Between two variants, numbers, points, colors and the view are interpolated, and everything else holds. If
    the last variant equals the first, the last frame is left out, because the film begins again. Each frame
    costs only what its edit changes: a fade of paint renders once.
    """
    from autocolor.batches import films
    from autocolor.batches.frames import frames_of_tracks, in_step, times_of

    if not varies and table is None and not turn:
        raise UsageError("animate must have --vary, --table or --turn; write it as in --turn 360")
    kind = films.kind_of(output)
    films.check_rate(fps)
    if kind == films.STREAM and source.smooth is None:
        source = source._replace(smooth=1)
    start, tables, code = started(source, varies, table)
    own = [] if table is None else tables[:1]
    for variants in own:
        try:
            times_of(variants)
        except UsageError as error:
            raise InputError(f"{brief(str(table))}: {error}") from None
    tracks = [*own, *in_step(tables[len(own) :])]
    with as_usage() if table is None else nullcontext():
        frames = frames_of_tracks(scene_in(start), tracks, count, turn=turn)
    with progress(len(frames)) as bar, workers(jobs) as executor:
        film = films.animate(
            start,
            frames,
            output,
            fps=fps,
            loop=not once,
            **source.given_sizes,
            executor=executor,
            overwrite=force,
            progress=lambda _: bar.update(1),
        )
    tell(f"wrote {film.path}, {film.frames:,} frame{'' if film.frames == 1 else 's'}")
    return code
