"""`autocolor sweep`: make pictures of many variants of a scene or a picture."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Final

import click
from click.core import ParameterSource

from autocolor.checks import brief
from autocolor.commands.completion import complete_settings
from autocolor.commands.options import (
    hold_option,
    print_log,
    size_option,
    smooth_option,
    with_held_exposure,
    with_normals,
)
from autocolor.commands.outputs import progress
from autocolor.commands.scenes import REPAIRED, SceneSource, ended, read_edited, scene_options, set_option
from autocolor.errors import AutocolorError, InputError, UsageError
from ramtek_emu.command_line import tell
from ramtek_emu.writing import same_outputs

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from autocolor.batches.table import Result, Variant
    from autocolor.files.picture_file import SavedPicture
    from autocolor.scene.scene import Scene

EXAMPLES: Final = """\b
Examples:
  autocolor sweep scenes/coupe --vary surfaces.body.object_color=red,navy -o {name}.png
  autocolor sweep scenes/coupe --vary lights.key.intensity=0.5:2:4 --vary ambient=0.05,0.2 \\
      -o sweep/{number:03}-{name}.png --sheet sweep.png --made sweep.csv
  autocolor sweep coupe.npz --vary surfaces.body.object_color=@paints.gpl -o {name}.webp
  autocolor sweep scenes/coupe --table looks.csv -o looks/{name}.png --jobs 4 --resume
"""

MOST_JOBS: Final = 256

vary_option = click.option(
    "--vary",
    "varies",
    multiple=True,
    metavar="KEY=VALUES",
    shell_complete=complete_settings,
    help="Vary a field: A,B,C, where @FILE stands for the colors of a palette; or START:STOP:COUNT, evenly"
    " spaced numbers. Several --vary make every combination, the last changing fastest.",
)

table_option = click.option(
    "--table",
    type=click.Path(),
    metavar="CSV|JSON",
    help="Variants: a CSV table with a key at the top of each column, or a JSON list of objects. An empty"
    " cell leaves a field as it is. The keys name and time are optional.",
)

jobs_option = click.option(
    "--jobs",
    type=click.IntRange(1, MOST_JOBS),
    default=1,
    show_default=True,
    metavar="N",
    help="Make pictures in so many processes.",
)


@click.command(epilog=EXAMPLES)
@scene_options
@vary_option
@table_option
@set_option
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="PATTERN",
    help="Name pattern of the pictures, which ends in .png or .webp (lossless). {number:03} is a number of"
    " three digits, {name} the name of the variant, and a key such as {ambient} its value.",
)
@click.option("--sheet", type=click.Path(), metavar="PNG", help="Write a labeled contact sheet.")
@click.option(
    "--columns",
    type=click.IntRange(1, 100),
    metavar="N",
    help="Columns of the contact sheet. Default: about as many as rows.",
)
@click.option(
    "--made", type=click.Path(), metavar="CSV", help="Write a table of the pictures and the problems."
)
@hold_option
@jobs_option
@click.option(
    "--resume",
    is_flag=True,
    help="Go on with a batch that was stopped: skip each picture that is whole and was made from the same"
    " scene and settings, and replace the others.",
)
@size_option
@smooth_option
@click.option(
    "--level",
    type=click.IntRange(0, 9),
    metavar="0-9",
    help="Compression of PNG files: 0 is the fastest, 9 the smallest.",
)
@click.option("--force", is_flag=True, help="Overwrite existing files.")
@click.pass_context
def sweep(
    context: click.Context,
    source: SceneSource,
    varies: tuple[str, ...],
    table: str | None,
    settings: tuple[str, ...],
    output: str,
    sheet: str | None,
    columns: int | None,
    made: str | None,
    hold_exposure: bool,
    jobs: int,
    resume: bool,
    size: tuple[int, int],
    smooth: int | None,
    level: int | None,
    force: bool,
) -> None:
    """Make a picture of each variant of SCENE: a scene, a mesh file or a picture file.

    Each picture costs only what its edit changes: recolorings of a picture file render nothing. A variant
    that cannot be made is listed on stderr, and the others are made; if all variants fail, the exit code is
    65, and if some fail, it is 1 with --strict.
    """
    import warnings

    from autocolor.batches.making import VariantWarning, batch
    from autocolor.batches.table import products, read_variants, varied
    from autocolor.images import default_smooth

    if not varies and table is None:
        raise UsageError(
            "sweep must have --vary or --table; write it as in --vary surfaces.body.object_color=red,navy"
        )
    if made is not None and any(same_outputs([made, read]) for read in (source.path, table) if read):
        raise UsageError(f"--made must be a file of its own, not {made}, which is read; name another")
    is_sized = context.get_parameter_source("size") is ParameterSource.COMMANDLINE
    tables = [] if table is None else [read_variants(table)]
    tables += [varied(text) for text in varies]
    samples = smooth or default_smooth(size)
    start, code = start_of(source, settings, size, samples if hold_exposure else 0)
    refuse_keys(start, tables, table)
    tell_paints(start, tables)
    variants = products(tables)
    is_picture = isinstance(start, tuple)
    with warnings.catch_warnings(), progress(len(variants)) as step, workers(jobs) as executor:
        # Problems are printed as messages of the command.
        warnings.simplefilter("ignore", VariantWarning)
        results = batch(
            start,
            variants,
            output,
            executor=executor,
            size=size if is_sized or not is_picture else None,
            smooth=smooth,
            level=level,
            overwrite=force,
            resume=resume,
            sheet=sheet,
            columns=columns,
            table=made,
            progress=lambda _: step(),
        )
    context.exit(print_counts(results, source.strict) or code)


def start_of(
    source: SceneSource,
    settings: tuple[str, ...],
    size: tuple[int, int],
    hold: int = 0,
    normals: bool = False,
) -> tuple[Scene | SavedPicture, int]:
    """The scene, or the picture with its scene, of a command line, and the exit code of its repairs.

    With `hold`, the scene has the exposure that it has without `settings`, for a picture that is so smooth.
    With `normals`, its words stand for normals.
    """
    from pathlib import Path

    from autocolor.commands.recolor import recolored
    from autocolor.files.opening import is_picture
    from autocolor.files.picture_file import read_picture

    def prepared(scene: Scene) -> Scene:
        from autocolor.rendering import render

        scene = with_normals(scene, normals)
        return with_held_exposure(scene, render(scene, size, smooth=hold)) if hold else scene

    if is_picture(Path(source.path)):
        if normals:
            raise UsageError(
                "--normals is for a scene, not for a picture file, which has no normals; leave it out"
            )
        print_log(click.get_current_context())
        saved = read_picture(source.path)
        original = with_held_exposure(saved.scene, saved.picture) if hold else saved.scene
        edited = recolored(original, None, {}, settings) if settings else original
        return saved._replace(scene=edited), 0
    scene, report = read_edited(source, settings, size, prepared)
    return scene, ended(report, source)


def scene_in(start: Scene | SavedPicture) -> Scene:
    """The scene, or the scene of a picture."""
    return start.scene if isinstance(start, tuple) else start


def refuse_keys(start: Scene | SavedPicture, tables: list[tuple[Variant, ...]], table: str | None) -> None:
    """Refuse keys that the scene does not have, before anything is made.

    Raises InputError for a key in the table, UsageError for a key of --vary.
    """
    from autocolor.batches.making import check_keys

    for number, variants in enumerate(tables):
        try:
            check_keys(scene_in(start), variants)
        except UsageError as error:
            if table is not None and number == 0:
                raise InputError(f"{brief(table)}, column {error}") from None
            raise UsageError(f"--vary {error}") from None


def tell_paints(start: Scene | SavedPicture, tables: list[tuple[Variant, ...]]) -> None:
    """Print a line for each paint that variants unset, once for all variants."""
    from autocolor.files.settings import UNSET, scene_with
    from autocolor.scene.scene import unset_paints

    scene = scene_in(start)
    sentences, checked = dict[str, None](), set[frozenset[str]]()
    for variant in (variant for table in tables for variant in table):
        keys = frozenset(key for key, value in variant.settings.items() if value not in (None, UNSET))
        if keys in checked:
            # Variants that set the same fields unset the same fields.
            continue
        with suppress(AutocolorError):
            sentences |= dict.fromkeys(unset_paints(scene, scene_with(scene, variant.settings)))
            checked.add(keys)
    tell(*(f"autocolor: {sentence}" for sentence in sentences))


def print_counts(results: list[Result], strict: bool) -> int:
    """Print the problems on stderr, and how many pictures were made; returns the exit code."""
    failed = [result for result in results if result.problem]
    for result in failed:
        tell(*(f"autocolor: {brief(result.name)}: {line}" for line in result.problem.splitlines()))
    present = sum(not result.was_made for result in results)
    made = len(results) - len(failed) - present
    counts = [f"made {made:,} picture{'' if made == 1 else 's'}"]
    counts += [f"{present:,} were there"] if present else []
    counts += [f"{len(failed):,} failed"] if failed else []
    tell(", ".join(counts))
    return REPAIRED if failed and strict else 0


@contextmanager
def workers(jobs: int) -> Iterator[Executor | None]:
    """An executor of some processes; None for one job. If the body fails, the processes are ended."""
    if jobs == 1:
        yield None
        return
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    # A process that is forked while this process has threads may hang.
    context = multiprocessing.get_context("spawn")
    executor = ProcessPoolExecutor(jobs, context, initializer=_begin_worker)
    others = multiprocessing.active_children()
    try:
        yield executor
    except BaseException:
        for process in multiprocessing.active_children():
            if process not in others:
                process.terminate()
        executor.shutdown(cancel_futures=True)
        raise
    executor.shutdown()


def _begin_worker() -> None:
    """Let this process end with its parent, and not by Ctrl+C, which reaches all processes of a terminal."""
    import signal
    from threading import Thread

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Wait for the parent to end, even if it is killed, and end this process."""
    import os
    from multiprocessing import parent_process

    parent = parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)
