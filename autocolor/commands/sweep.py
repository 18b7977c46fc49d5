"""`autocolor sweep`: make pictures of many variants of a scene or a picture."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import chain
from typing import TYPE_CHECKING, Final

import click

from autocolor.checks import brief
from autocolor.commands.completion import complete_settings
from autocolor.commands.options import flag, force_option, option
from autocolor.commands.outputs import progress
from autocolor.commands.scenes import REPAIRED, SceneSource, scene_in, scene_options, start_of
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

vary_option = option(
    "--vary varies",
    "KEY=VALUES",
    "Vary a field: A,B,C, where @FILE stands for the colors of a palette; or START:STOP:COUNT, evenly"
    " spaced numbers. Several --vary make every combination, the last changing fastest.",
    str,
    multiple=True,
    shell_complete=complete_settings,
)

table_option = option(
    "--table",
    "CSV|JSON",
    "Variants: a CSV table with a key at the top of each column, or a JSON list of objects. An empty"
    " cell leaves a field as it is. The keys name and time are optional.",
)

jobs_option = option("--jobs", "N", "Make pictures in so many processes.", click.IntRange(1, 256), default=1)


@click.command(epilog=EXAMPLES)
@scene_options("settings", "stage", "size", "smooth", "hold_exposure")
@vary_option
@table_option
@option(
    "-o --output",
    "PATTERN",
    "Name pattern of the pictures, which ends in .png or .webp (lossless). {number:03} is a number of"
    " three digits, {name} the name of the variant, and a key such as {ambient} its value.",
    required=True,
)
@option("--sheet", "PNG", "Write a labeled contact sheet.")
@option(
    "--columns", "N", "Columns of the contact sheet. Default: about as many as rows.", click.IntRange(1, 100)
)
@option("--made", "CSV", "Write a table of the pictures and the problems.")
@jobs_option
@flag(
    "--resume",
    "Go on with a batch that was stopped: skip each picture that is whole and was made from the same"
    " scene and settings, and replace the others.",
)
@option("--level", "0-9", "Compression of PNG files: 0 is the fastest, 9 the smallest.", click.IntRange(0, 9))
@force_option
def sweep(
    source: SceneSource,
    varies: tuple[str, ...],
    table: str | None,
    output: str,
    sheet: str | None,
    columns: int | None,
    made: str | None,
    jobs: int,
    resume: bool,
    level: int | None,
    force: bool,
) -> int:
    """Make a picture of each variant of SCENE: a scene, a mesh file or a picture file.

    Each picture costs only what its edit changes: recolorings of a picture file render nothing. A variant
    that cannot be made is listed on stderr, and the others are made; if all variants fail, the exit code is
    65, and if some fail, it is 1 with --strict.
    """
    import warnings

    from autocolor.batches.making import VariantWarning, batch
    from autocolor.batches.table import products

    if not varies and table is None:
        raise UsageError(
            "sweep must have --vary or --table; write it as in --vary surfaces.body.object_color=red,navy"
        )
    if made is not None and any(same_outputs([made, read]) for read in (source.path, table) if read):
        raise UsageError(f"--made must be a file of its own, not {made}, which is read; name another")
    start, tables, code = started(source, varies, table)
    variants = products(tables)
    with warnings.catch_warnings(), progress(len(variants)) as bar, workers(jobs) as executor:
        # Problems are printed as messages of the command.
        warnings.simplefilter("ignore", VariantWarning)
        results = batch(
            start,
            variants,
            output,
            executor=executor,
            **source.given_sizes,
            level=level,
            overwrite=force,
            resume=resume,
            sheet=sheet,
            columns=columns,
            table=made,
            progress=lambda _: bar.update(1),
        )
    return print_counts(results, source.strict) or code


def started(
    source: SceneSource, varies: tuple[str, ...], table: str | None
) -> tuple[Scene | SavedPicture, list[tuple[Variant, ...]], int]:
    """The start of `start_of`, the variants of `--table` and of each `--vary`, and the exit code.

    Keys that the scene does not have are refused, before anything is made: InputError for a key in the table,
    UsageError for a key of --vary. Paints that variants unset are listed on stderr.
    """
    from autocolor.batches.making import check_keys
    from autocolor.batches.table import read_variants, varied
    from autocolor.files.settings import scene_with
    from autocolor.scene.scene import unset_paints

    tables = [] if table is None else [read_variants(table)]
    tables += [varied(text) for text in varies]
    start, code = start_of(source)
    for number, variants in enumerate(tables):
        try:
            check_keys(scene_in(start), variants)
        except UsageError as error:
            if table is not None and number == 0:
                raise InputError(f"{brief(table)}, column {error}") from None
            raise UsageError(f"--vary {error}") from None
    sentences = dict[str, None]()
    for variant in chain(*tables):
        with suppress(AutocolorError):
            edited = scene_with(scene_in(start), variant.settings)
            sentences |= dict.fromkeys(unset_paints(scene_in(start), edited))
    tell(*(f"autocolor: {sentence}" for sentence in sentences))
    return start, tables, code


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
    try:
        yield executor
    except BaseException:
        for process in multiprocessing.active_children():
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
