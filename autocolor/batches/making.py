"""Making batches: in this process or by any executor, in bounded memory, and resuming a stopped batch.

An executor gets runs of variants one by one, and returns the bytes of finished files; only this process
writes files.
"""

from __future__ import annotations

import os
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from itertools import islice
from os import PathLike, fspath
from pathlib import Path
from typing import Final, TypedDict, Unpack

from autocolor.arrays import Bytes
from autocolor.batches.outputs import (
    ARRAY,
    SHEET_MARK,
    base_mark,
    form_of,
    mark_in,
    mark_of,
    paths_of,
    same_file,
)
from autocolor.batches.runs import Drawing, Made, Start, VariantTask, cut, make_run, runs_of
from autocolor.batches.sheet import Box, ContactSheet, read_thumbnail
from autocolor.batches.table import TABLE_BEGINS, Result, Rows, Variant, results_bytes, variants_of
from autocolor.budget import allowed_memory, validated_limit
from autocolor.checks import brief, nearest, shown
from autocolor.errors import InputError, OutputError, UnavailableError, UsageError, reason_of
from autocolor.files.opening import is_picture, read_scene
from autocolor.files.picture_file import read_picture
from autocolor.files.settings import field_of, place_of, scene_with
from autocolor.files.writing import check_suffix, refuse_output, write_atomically
from autocolor.images import check_png_level, default_smooth
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.rendering import SIZE, checked_size
from autocolor.scene.scene import Scene, check_scene

Source = Scene | tuple[Scene, Picture] | str | PathLike[str]
"""What variants are made from: a scene, a scene with its picture, or the path of either."""

VARIANTS_OF_RUN: Final = 16
"""The most variants of a run.

Measured: handing out the coupe's picture takes this process 1.6 ms for a run of one variant, and 0.2 ms a
variant for runs of 16. With runs of 1, 4, 16 and 64, two processes take the same time within a tenth.
"""

BYTES_OF_RUN: Final = 1 << 28
"""Limit: bytes that a run returns; runs of large pictures are shorter."""

BYTES_UNDER_WAY: Final = 1 << 29
"""Limit: bytes of the pictures that an executor computes or has finished. It always gets two runs."""

WORKERS: Final = 62
"""Assumed: the workers of an executor that does not say how many it has."""

MORE_THAN_WORKERS: Final = 2
"""Runs that wait for a worker, so that no worker waits for a run."""

PROBLEMS_SHOWN: Final = 10
"""The problems in the message about a batch of which no variant could be made."""


class VariantWarning(UserWarning):
    """A variant of a batch could not be made; the others are."""


class Options(TypedDict, total=False):
    """How a batch is made; see `batch`."""

    executor: Executor | None
    size: tuple[int, int] | None
    smooth: int | None
    form: str | None
    level: int | None
    sync: bool
    overwrite: bool
    resume: bool
    ordered: bool


@dataclass(frozen=True)
class Batch:
    """A checked batch: what to make, how, where, and by whom."""

    scene: Scene
    picture: Picture | None
    variants: tuple[Variant, ...]
    paths: tuple[str, ...]
    drawing: Drawing
    base: str
    """The checksum of the scene, its picture and the drawing."""
    options: Options

    def results(self) -> Generator[tuple[int, Result, Bytes | None], None, None]:
        """The number, the result and the thumbnail of each variant: whole files first, then new pictures."""
        missing = []
        for number, variant in enumerate(self.variants):
            mark = mark_in(self.paths[number], self.drawing.form) if self.options.get("resume") else ""
            if mark and mark == mark_of(self.base, variant):
                yield self._skipped(number)
            else:
                missing.append(number)
        if not missing:
            return
        # A small batch has at least a run for each worker.
        executor = self.options.get("executor")
        most = min(VARIANTS_OF_RUN, -(-len(missing) // (_workers(executor) or 1)))
        most = max(1, min(most, BYTES_OF_RUN // self.drawing.bytes_of_picture))
        rows = [self.variants[number] for number in missing]
        is_ordered = self.options.get("ordered")
        order = cut(range(len(missing)), most) if is_ordered else runs_of(self.scene, rows, most)
        runs = ([self._task(missing[place]) for place in run] for run in order)
        made = self._made_here(runs) if executor is None else self._made_by(executor, runs)
        with closing(made):
            for each in made:
                yield self._finished(each)

    def _task(self, number: int) -> VariantTask:
        variant = self.variants[number]
        mark = "" if self.drawing.form == ARRAY else mark_of(self.base, variant)
        return VariantTask(number, dict(variant.settings), mark)

    def _made_here(self, runs: Iterator[list[VariantTask]]) -> Generator[Made, None, None]:
        """The pictures of the runs, made in this process."""
        start = Start(self.scene, self.picture)
        for task in (task for run in runs for task in run):
            yield from make_run(start, self.drawing, [task])

    def _made_by(self, executor: Executor, runs: Iterator[list[VariantTask]]) -> Generator[Made, None, None]:
        """The pictures of the runs, made by an executor, in their order.

        Raises UnavailableError if its workers end, or if it returns something else.
        """
        start = Start(self.scene, self.picture)
        most = max(2, BYTES_UNDER_WAY // (self.drawing.bytes_of_picture * VARIANTS_OF_RUN))
        most = min(most, (_workers(executor) or WORKERS) + MORE_THAN_WORKERS)
        under_way: deque[tuple[list[VariantTask], Future[list[Made]]]] = deque()
        try:
            while True:
                for run in islice(runs, most - len(under_way)):
                    with _working(RuntimeError, CancelledError):
                        under_way.append((run, executor.submit(make_run, start, self.drawing, run)))
                if not under_way:
                    return
                tasks, future = under_way.popleft()
                with _working(BrokenExecutor, CancelledError):
                    made = future.result()
                if not _is_made_of(made, tasks):
                    raise UnavailableError(
                        "an executor must return what its function returns, the picture of each variant, and"
                        " this one returned something else; use an executor of concurrent.futures"
                    )
                yield from made
        finally:
            for _, future in under_way:
                future.cancel()

    def _skipped(self, number: int) -> tuple[int, Result, Bytes | None]:
        """The result of a variant whose file is whole."""
        variant, path, size = self.variants[number], self.paths[number], self.drawing.thumbnail
        small = None if size is None else read_thumbnail(path, size)
        return number, Result(variant.name, variant.settings, path, was_made=False), small

    def _finished(self, made: Made) -> tuple[int, Result, Bytes | None]:
        """The result of a variant that was made, after its file is written. Raises WriteError."""
        number, image, problem, seconds, tier, small = made
        variant, path = self.variants[number], self.paths[number] if self.paths else None
        if path is not None:
            if isinstance(image, bytes):
                try:
                    self._write(path, image)
                except OutputError as error:
                    problem = str(error)
            image = None
        if problem:
            path, small = None, None
        return number, Result(variant.name, variant.settings, path, image, problem, seconds, tier), small

    def _write(self, path: str, data: bytes) -> None:
        """Write a file and, if it is missing, its folder. Raises OutputError, WriteError."""
        _make_folder(path)
        # Replace an earlier picture of a batch, and never any other file.
        overwrites = self.options.get("overwrite", False)
        is_ours = self.options.get("resume", False) and mark_in(path, self.drawing.form) != ""
        write_atomically(path, data, overwrite=overwrites or is_ours, sync=self.options.get("sync", True))


def _workers(executor: Executor | None) -> int | None:
    """How many workers an executor has; None if it does not say."""
    workers = getattr(executor, "_max_workers", None)
    return workers if isinstance(workers, int) and workers > 0 else None


def _make_folder(path: str | PathLike[str]) -> None:
    """Make the folder of a file if it is missing. Raises OutputError."""
    folder = Path(path).parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"an output must have a folder, and {brief(str(folder))} cannot be made ({reason_of(error)});"
            " choose another place"
        ) from None


@contextmanager
def _working(*broken: type[Exception]) -> Iterator[None]:
    """Raise UnavailableError for the errors of an executor that is broken or shut down."""
    try:
        yield
    except Exception as error:
        # Dask's error for a task whose workers ended is known by its name.
        if not isinstance(error, broken) and type(error).__name__ != "KilledWorker":
            raise
        reason = f" ({brief(str(error))})" if str(error) else ""
        raise UnavailableError(
            f"the workers of a batch must run until it ends, and they stopped{reason}; finished files are"
            " whole: go on with resume, perhaps with fewer workers if memory was short"
        ) from error


def _is_made_of(made: object, tasks: Sequence[VariantTask]) -> bool:
    """Whether an executor returned a picture or a problem for each variant of a run."""
    numbers = (
        [each.number if isinstance(each, Made) else None for each in made] if isinstance(made, list) else []
    )
    return numbers == [task.number for task in tasks]


def scene_and_picture(source: Source) -> tuple[Scene, Picture | None]:
    """The scene and, if there is one, the picture of a source. Raises InputError, UsageError."""
    if isinstance(source, (str, PathLike)):
        if not is_picture(Path(source)):
            return read_scene(source), None
        source = read_picture(source)
    if isinstance(source, tuple) and len(source) == 2:
        check_surfaces(*source)
        return source
    check_scene(source)
    return source, None


def _drawing(picture: Picture | None, form: str, thumbnail: Box | None, options: Options) -> Drawing:
    """How to draw the pictures of a batch. Raises UsageError for a wrong or contradicting size."""
    size, smooth, level = options.get("size"), options.get("smooth"), options.get("level")
    check_png_level(level)
    if size is None:
        size = SIZE if picture is None else picture.size
    if smooth is None:
        smooth = default_smooth(size) if picture is None else picture.smooth
    size = checked_size(size, smooth)
    if picture is not None and (size, smooth) != (picture.size, picture.smooth):
        raise UsageError(
            "the size and smooth of a batch must be those of its picture, {} x {} and {}; leave them out, or"
            " give the scene alone".format(*picture.size, picture.smooth)
        )
    elements, lines = size
    return Drawing(lines, elements, int(smooth), form, level, thumbnail, validated_limit(None))


def check_keys(scene: Scene, variants: Iterable[Variant]) -> None:
    """Raise UsageError, which begins with the key, if a variant sets a key that the scene does not have."""
    values: dict[str, object] = {}
    for variant in variants:
        values = {**variant.settings, **values} if variant.settings.keys() - values.keys() else values
    for key, value in values.items():
        if field_of(place_of(scene, key)) is None:
            # A whole inline row has no field of its own, but a value.
            try:
                scene_with(scene, {key: value})
            except InputError as error:
                raise UsageError(f"{brief(key)}: {problem}" for problem in error.problems) from None


def checked_batch(
    source: Source,
    variants: Rows,
    output: str | PathLike[str] | None,
    thumbnail: Box | None = None,
    **options: Unpack[Options],
) -> Batch:
    """The checked batch. Raises the errors of `batch_results`, before anything is made."""
    for name in options:
        if name not in Options.__annotations__:
            raise UsageError(
                f"there is no option {shown(name)} of a batch{nearest(name, Options.__annotations__)}"
            )
    form, executor = form_of(output, options.get("form")), options.get("executor")
    is_class = isinstance(executor, type)
    if executor is not None and (is_class or not callable(getattr(executor, "submit", None))):
        raise UsageError(
            f"an executor must be one of concurrent.futures or the like, not {shown(executor)}; leave it out"
            " for this process"
        )
    if options.get("resume") and output is None:
        raise UsageError("only a batch with an output can be resumed; give a name pattern as output")
    rows = variants_of(variants)
    if not rows:
        raise UsageError(
            "a batch must have at least one variant, not none; add a row, or {} for the scene itself"
        )
    scene, picture = scene_and_picture(source)
    check_keys(scene, rows)
    drawing = _drawing(picture, form, thumbnail, options)
    paths = () if output is None else paths_of(output, scene, rows)
    if not (options.get("overwrite") or options.get("resume")):
        existing = [path for path in paths if os.path.lexists(path)]
        if existing:
            others = f" and {len(existing) - 1:,} more, which exist" if existing[1:] else ", which exists"
            raise OutputError(
                f"the pictures of a batch must be new files, not {brief(existing[0])}{others}; resume the"
                " batch with --resume (resume=True in Python), or overwrite with --force (overwrite=True)"
            )
    base = "" if form == ARRAY else base_mark(scene, picture, drawing.numbers)
    return Batch(scene, picture, rows, paths, drawing, base, options)


def batch_results(
    source: Source,
    variants: Rows,
    output: str | PathLike[str] | None = None,
    **options: Unpack[Options],
) -> Generator[Result, None, None]:
    """The results of variants as their pictures are made; see `batch` for the arguments.

    With `ordered`, the variants are made in their own order, each after the variant before it; otherwise in
    the order in which they cost least. Memory is bounded, however many variants there are. To stop a batch,
    close the generator: files are then whole, and waiting runs are canceled.
    """
    return (result for _, result, _ in checked_batch(source, variants, output, **options).results())


def batch(
    source: Source,
    variants: Rows,
    output: str | PathLike[str] | None = None,
    *,
    sheet: str | PathLike[str] | None = None,
    columns: int | None = None,
    table: str | PathLike[str] | None = None,
    progress: Callable[[Result], object] | None = None,
    **options: Unpack[Options],
) -> list[Result]:
    """Make a picture of each variant of a scene or a picture; the results are in the order of the variants.

        paints = autocolor.grid({"surfaces.body.object_color": ["red", "navy"], "ambient": [0.05, 0.2]})
        autocolor.batch("scenes/coupe", paints, "out/{number:03}-{name}.png", sheet="paints.png")

    `source` is a scene, a pair of a scene and its picture as `read_picture` returns, or a path of either.
    A picture is only rendered again for variants that change the light or the view.

    `variants` are a list of `Variant`s, or of tables of values by key; see `grid` and `read_variants`.
    `output` is a name pattern that ends in .png or .webp (lossless); its fields are {number}, {name} and
    keys. Without it, each result has an `image`, whose `form` is "array" (the default), "png" or "webp".

    The options:

    - `executor`: any executor of concurrent.futures, also Dask's `Client.get_executor()`; by default this
      process does the work. Runs of variants travel to it, at least a run for each worker.
    - `size`, by default (640, 480), and `smooth`, by default 2, as in `save_image`; a picture has its own.
    - `level`: the compression of PNG files, 0 to 9; `sync=False` as in `save_image`.
    - `resume`: skip each variant whose file is whole and was made from the same scene or picture and the
      same settings, and replace the other files that a batch wrote. `overwrite` replaces any file.
    - `ordered`: make the variants in their own order, as frames of an animation.

    `sheet` is a PNG file for a labeled contact sheet of so many `columns`, by default in the shape of a grid.
    `table` is a CSV file for the results. Both are also written if the batch is stopped. `progress` is called
    with each result.

    A variant that cannot be made has a `problem` in its result, is told by a VariantWarning, and loses no
    other. Raises UsageError for a wrong argument, a key that the scene does not have, and arrays that exceed
    the memory budget; InputError for an invalid source, and if no variant can be made; OutputError if a file
    exists; WriteError if a file cannot be written; UnavailableError if the executor fails.
    """
    rows = variants_of(variants)
    if columns is not None and sheet is None:
        raise UsageError("columns are for a contact sheet; give a sheet, or leave them out")
    cells = None if sheet is None else ContactSheet(rows, columns)
    checked = checked_batch(source, rows, output, thumbnail=None if cells is None else cells.box, **options)
    if output is None and checked.drawing.form == ARRAY:
        needed = len(rows) * checked.drawing.bytes_of_picture
        if needed > allowed_memory():
            raise UsageError(
                f"the arrays of a batch must have at most {allowed_memory():,} bytes, not {needed:,}; give an"
                " output, or take the results one by one from batch_results"
            )
    for path, suffix, what in ((sheet, ".png", "a contact sheet"), (table, ".csv", "a table of results")):
        if path is not None:
            check_suffix(path, suffix, what)
            if same_file(path) in map(same_file, checked.paths):
                raise UsageError(f"{what} must have a file of its own, not {path}, a picture's; rename it")
            _make_folder(path)
            is_ours = options.get("resume", False) and _is_of_batch(path)
            refuse_output(path, overwrite=options.get("overwrite", False) or is_ours)
    results: dict[int, Result] = {}
    try:
        with closing(checked.results()) as made:
            for number, result, small in made:
                results[number] = result
                if cells is not None:
                    cells.put(number, small)
                if progress is not None:
                    progress(result)
    finally:
        # A stopped batch has these files, too.
        in_order = [results[number] for number in sorted(results)]
        if table is not None:
            write_atomically(table, results_bytes(in_order), overwrite=True)
        if sheet is not None and cells is not None:
            write_atomically(sheet, cells.png(), overwrite=True)
    failed = [result for result in in_order if result.problem]
    sentences = [f"{brief(result.name)}: {line}" for result in failed for line in result.problem.splitlines()]
    if len(failed) == len(rows):
        more = len(sentences) - PROBLEMS_SHOWN
        raise InputError(sentences[:PROBLEMS_SHOWN] + [f"and {more:,} problems more"] * (more > 0))
    for sentence in sentences:
        warnings.warn(sentence, VariantWarning, stacklevel=2)
    return in_order


def _is_of_batch(path: str | PathLike[str]) -> bool:
    """Whether a file is the sheet or the table of a batch."""
    if not fspath(path).lower().endswith(".csv"):
        return mark_in(fspath(path), "png") == SHEET_MARK
    with suppress(OSError), open(path, "rb") as file:
        return file.read(len(TABLE_BEGINS)) == TABLE_BEGINS
    return False
