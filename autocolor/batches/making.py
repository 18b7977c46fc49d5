"""Making batches: in this process or by any executor, in bounded memory, and resuming a stopped batch.

An executor gets runs of variants one by one, and returns the bytes of finished files; only this process
writes files.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable, Sequence, Set
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from contextlib import closing, suppress
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Final, TypedDict, Unpack

from autocolor.arrays import Bytes
from autocolor.batches.order import cut, runs_of, tier_of
from autocolor.batches.outputs import ARRAY, SHEET_MARK, Pattern, base_mark, form_of, mark_in, mark_of
from autocolor.batches.runs import Drawing, Made, Start, VariantTask, forget, make, make_run
from autocolor.batches.sheet import Box, ContactSheet, read_thumbnail
from autocolor.batches.table import TABLE_BEGINS, Result, Rows, Variant, results_bytes, variants_of
from autocolor.budget import allowed_memory, allowing, validated_limit
from autocolor.checks import is_whole, shown
from autocolor.errors import InputError, OutputError, UnavailableError, UsageError, reason_of
from autocolor.files.opening import is_picture, read_scene
from autocolor.files.picture_file import SavedPicture, read_picture
from autocolor.files.writing import check_suffix, refuse_output, write_atomically
from autocolor.images import check_png_level
from autocolor.lighting.picture import Picture, check_smooth, check_surfaces
from autocolor.logs import logger_of
from autocolor.rendering import LARGEST_RASTER, rendering
from autocolor.scene.columns import Tier
from autocolor.scene.scene import Scene, check_scene
from ramtek_emu.errors import escaped

LOG: Final = logger_of(__name__)

Source = Scene | SavedPicture | tuple[Scene, Picture] | str | PathLike[str]
"""What variants are made from: a scene, a scene with its picture, a picture that was read, or a path."""

RUNS: Final = 16
"""The most variants of a run, unless the caller chooses.

Measured: handing out the coupe's picture takes this process 1.6 ms for a run of one variant, and 0.2 ms a
variant for runs of 16. With runs of 1, 4, 16 and 64, two processes take the same time within a tenth.
"""

MOST_IN_RUN: Final = 10_000
"""Limit: variants of a run."""

BYTES_OF_RUN: Final = 1 << 28
"""Limit: bytes that a run returns; runs of large pictures are shorter."""

BYTES_WAITING: Final = 1 << 29
"""Limit: bytes of the pictures that an executor computes or has finished. It always gets two runs."""

LONGEST_PATH: Final = 4096
"""Limit: characters of the path of a picture, as on most systems."""

MORE_THAN_WORKERS: Final = 2
"""Runs that wait for a worker, so that no worker waits for a run."""

WINDOW: Final = 64
"""Runs that an executor gets at once if it does not say how many workers it has."""


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
    executor: Executor | None
    runs: int
    ordered: bool
    overwrite: bool
    resume: bool
    sync: bool

    def results(self) -> Generator[tuple[int, Result, Bytes | None], None, None]:
        """The number, the result and the thumbnail of each variant, as they are made."""
        present = self._present()
        if self.ordered:
            runs = cut(range(len(self.variants)), self._most_in_run(len(self.variants)))
        else:
            for number in sorted(present):
                yield self._skipped(number)
            missing = [number for number in range(len(self.variants)) if number not in present]
            most = self._most_in_run(len(missing))
            ordered = runs_of(self.scene, [self.variants[number] for number in missing], most)
            runs = [[missing[place] for place in run] for run in ordered]
        executor = self.executor
        made = self._made_here(runs, present) if executor is None else self._made_by(executor, runs, present)
        with closing(made):
            for each in made:
                yield self._skipped(each) if isinstance(each, int) else self._finished(each)

    def _most_in_run(self, count: int) -> int:
        """The most variants of a run, so that `count` variants are at least a run for each worker."""
        return max(1, min(self.runs, -(-count // (_workers(self.executor) or 1))))

    def _present(self) -> set[int]:
        """The numbers of the variants whose files are whole."""
        if not self.resume:
            return set()
        return {
            number
            for number, (path, variant) in enumerate(zip(self.paths, self.variants, strict=True))
            if mark_in(path, self.drawing.form) == mark_of(self.base, variant)
        }

    def _task(self, number: int) -> VariantTask:
        variant = self.variants[number]
        mark = "" if self.drawing.form == ARRAY else mark_of(self.base, variant)
        return VariantTask(number, dict(variant.settings), mark)

    def _made_here(
        self, runs: Iterable[Sequence[int]], present: Set[int]
    ) -> Generator[Made | int, None, None]:
        """The pictures of the runs, made in this process. A present variant gives its number alone."""
        start = Start(self.scene, self.picture)
        for number in (number for run in runs for number in run):
            yield number if number in present else make(start, self.drawing, self._task(number))

    def _made_by(
        self, executor: Executor, runs: Iterable[Sequence[int]], present: Set[int]
    ) -> Generator[Made | int, None, None]:
        """The pictures of the runs, made by an executor. A present variant gives its number alone.

        Raises UnavailableError if workers end.
        """
        if len(present) == len(self.variants):
            yield from (number for run in runs for number in run)
            return
        start = Start(self.scene, self.picture if self.picture is not None else self._picture_of_all())
        window, waiting = self._window(executor), iter(runs)
        pending: dict[Future[list[Made]], Sequence[int]] = {}
        try:
            while True:
                while len(pending) < window and (run := next(waiting, None)) is not None:
                    tasks = [self._task(number) for number in run if number not in present]
                    pending[_submitted(executor, start, self.drawing, tasks)] = run
                if not pending:
                    return
                first = next(iter(pending))
                done = {first} if self.ordered else wait(pending, return_when=FIRST_COMPLETED).done
                for future in done:
                    run = pending.pop(future)
                    made = {each.number: each for each in _returned(future)}
                    for number in run:
                        yield made.get(number, number)
        finally:
            for future in pending:
                future.cancel()
            forget(start)

    def _picture_of_all(self) -> Picture | None:
        """The picture of all variants if they only recolor; otherwise None."""
        keys = {key for variant in self.variants for key in variant.settings}
        if any(key == "words" or tier_of(self.scene, key) >= Tier.MIX for key in keys):
            return None
        # If rendering fails, the result of each variant says why.
        with suppress(InputError), allowing(self.drawing.limit):
            return rendering(self.scene, *self.drawing.raster).picture
        return None

    def _window(self, executor: Executor) -> int:
        """How many runs an executor gets at once."""
        workers = _workers(executor)
        window = WINDOW if workers is None else workers + MORE_THAN_WORKERS
        return max(2, min(window, BYTES_WAITING // (self.drawing.bytes_of_picture * self.runs)))

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
        # Replace an earlier picture of a batch, or an empty file, which a power failure leaves if `sync` is
        # false. Never replace any other file.
        is_ours = self.resume and (mark_in(path, self.drawing.form) != "" or _is_empty(path))
        write_atomically(path, data, overwrite=self.overwrite or is_ours, sync=self.sync)


def _workers(executor: Executor | None) -> int | None:
    """How many workers an executor has; None if it does not say."""
    workers = getattr(executor, "_max_workers", None)
    return workers if isinstance(workers, int) and workers > 0 else None


def _is_empty(path: str) -> bool:
    """Whether there is a file without a byte at a path."""
    with suppress(OSError):
        return os.path.isfile(path) and os.path.getsize(path) == 0
    return False


def _make_folder(path: str | PathLike[str]) -> None:
    """Make the folder of a file if it is missing. Raises OutputError."""
    folder = Path(path).parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"an output must have a folder, and {folder} cannot be made ({reason_of(error)}); choose another"
            " place"
        ) from None


def _submitted(
    executor: Executor, start: Start, drawing: Drawing, tasks: list[VariantTask]
) -> Future[list[Made]]:
    """The future of a run. Raises UnavailableError if the executor accepts no run."""
    try:
        return executor.submit(make_run, start, drawing, tasks)
    except RuntimeError as error:
        # An executor is broken or shut down.
        raise _unavailable(error) from error


def _returned(future: Future[list[Made]]) -> list[Made]:
    """What a worker returned. Raises UnavailableError if the worker ended before."""
    try:
        return future.result()
    except (BrokenExecutor, CancelledError) as error:
        raise _unavailable(error) from error
    except Exception as error:
        if type(error).__name__ == KILLED:
            raise _unavailable(error) from error
        raise


KILLED: Final = "KilledWorker"
"""The error of Dask for a task whose workers ended."""


def _unavailable(error: Exception) -> UnavailableError:
    reason = f" ({escaped(str(error))[:200]})" if str(error) else ""
    return UnavailableError(
        f"the workers of a batch must run until it ends, and they stopped{reason}; finished files are whole:"
        " go on with resume, perhaps with fewer workers if memory was short"
    )


def _source(source: Source) -> tuple[Scene, Picture | None]:
    """The scene and, if there is one, the picture of a source. Raises InputError, UsageError."""
    if isinstance(source, (str, PathLike)):
        if not is_picture(Path(source)):
            return read_scene(source), None
        source = read_picture(source)
    if isinstance(source, SavedPicture):
        source = source.scene, source.picture
    if isinstance(source, tuple) and len(source) == 2:
        check_surfaces(*source)
        return source
    check_scene(source)
    return source, None


def _drawing(
    picture: Picture | None,
    size: tuple[int, int] | None,
    smooth: int | None,
    form: str,
    level: int | None,
    thumbnail: Box | None,
) -> Drawing:
    """How to draw the pictures of a batch. Raises UsageError for a wrong or contradicting size."""
    if smooth is not None:
        check_smooth(smooth)
    check_png_level(level)
    counts = None if size is None else tuple(size) if isinstance(size, (tuple, list)) else ()
    if picture is not None:
        own = picture.elements // picture.smooth, picture.lines // picture.smooth
        if counts not in (None, own) or smooth not in (None, picture.smooth):
            raise UsageError(
                f"the size and smooth of a batch must be those of its picture, {own[0]} x {own[1]} and"
                f" {picture.smooth}; leave them out, or give the scene alone"
            )
        counts, smooth = own, picture.smooth
    counts, smooth = (640, 480) if counts is None else counts, smooth or 1
    most = LARGEST_RASTER // smooth
    if len(counts) != 2 or not all(is_whole(count, 1, most) for count in counts):
        raise UsageError(
            f"the size of pictures must be elements and lines, each from 1 to {most}, not {shown(size)};"
            " write it as in (640, 480)"
        )
    elements, lines = map(int, counts)
    return Drawing(lines, elements, int(smooth), form, level, thumbnail, validated_limit(None))


def _paths(pattern: Pattern | None, variants: Sequence[Variant]) -> tuple[str, ...]:
    """The path of each variant; none without a pattern.

    Raises UsageError if two variants have the same file, or if a path is too long.
    """
    if pattern is None:
        return ()
    paths: list[str] = []
    first: dict[str, int] = {}
    for number, variant in enumerate(variants, 1):
        path = pattern.path(number, variant)
        if len(path) > LONGEST_PATH:
            raise UsageError(
                f"the path of a picture must have at most {LONGEST_PATH:,} characters, not {len(path):,} as"
                f" for {shown(variant.name)}; shorten the name pattern"
            )
        paths.append(path)
        other = first.setdefault(_same_file(path), number)
        if other != number:
            raise UsageError(
                f"a name pattern must give each variant a file of its own, and {path} is the file of both"
                f" {shown(variants[other - 1].name)} and {shown(variants[number - 1].name)}; add {{name}} or"
                " {number}"
            )
    return tuple(paths)


def checked_batch(
    source: Source,
    variants: Rows,
    output: str | PathLike[str] | None,
    *,
    executor: Executor | None = None,
    runs: int = RUNS,
    size: tuple[int, int] | None = None,
    smooth: int | None = None,
    form: str | None = None,
    level: int | None = None,
    sync: bool = True,
    overwrite: bool = False,
    resume: bool = False,
    ordered: bool = False,
    thumbnail: Box | None = None,
) -> Batch:
    """The checked batch. Raises the errors of `batch_results`, before anything is made."""
    form = form_of(output, form)
    if not is_whole(runs, 1, MOST_IN_RUN):
        raise UsageError(
            f"runs must be a whole number from 1 to {MOST_IN_RUN:,}, not {shown(runs)}; give one such as"
            f" {RUNS}"
        )
    is_class = isinstance(executor, type)
    if executor is not None and (is_class or not callable(getattr(executor, "submit", None))):
        raise UsageError(
            f"an executor must be one of concurrent.futures or the like, not {shown(executor)}; leave it out"
            " for this process"
        )
    if resume and output is None:
        raise UsageError("only a batch with an output can be resumed; give a name pattern as output")
    rows = variants_of(variants)
    scene, picture = _source(source)
    drawing = _drawing(picture, size, smooth, form, level, thumbnail)
    paths = _paths(None if output is None else Pattern(output, scene), rows)
    if not (overwrite or resume):
        existing = [path for path in paths if os.path.lexists(path)]
        if existing:
            others = f" and {len(existing) - 1:,} more, which exist" if existing[1:] else ", which exists"
            raise OutputError(
                f"the pictures of a batch must be new files, not {existing[0]}{others}; resume the batch with"
                " --resume (resume=True in Python), or overwrite with --force (overwrite=True)"
            )
    base = "" if form == ARRAY else base_mark(scene, picture, drawing.numbers)
    most = max(1, min(runs, BYTES_OF_RUN // drawing.bytes_of_picture))
    return Batch(scene, picture, rows, paths, drawing, base, executor, most, ordered, overwrite, resume, sync)


class Options(TypedDict, total=False):
    """How a batch is made; see `batch`."""

    executor: Executor | None
    runs: int
    size: tuple[int, int] | None
    smooth: int | None
    form: str | None
    level: int | None
    sync: bool
    overwrite: bool
    resume: bool
    ordered: bool


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
    checked = checked_batch(source, variants, output, **options)
    return _only_results(checked)


def _only_results(checked: Batch) -> Generator[Result, None, None]:
    with closing(checked.results()) as results:
        for _, result, _ in results:
            yield result


def batch(
    source: Source,
    variants: Rows,
    output: str | PathLike[str] | None = None,
    *,
    sheet: str | PathLike[str] | None = None,
    table: str | PathLike[str] | None = None,
    progress: Callable[[Result], object] | None = None,
    **options: Unpack[Options],
) -> list[Result]:
    """Make a picture of each variant of a scene or a picture; the results are in the order of the variants.

        paints = autocolor.grid({"surfaces.body.object_color": ["red", "navy"], "ambient": [0.05, 0.2]})
        autocolor.batch("scenes/coupe", paints, "out/{number:03}-{name}.png", sheet="paints.png")

    `source` is a scene, a pair of a scene and its picture, what `read_picture` returns, or a path of either.
    A picture is only rendered again for variants that change the light or the view.

    `variants` are a list of `Variant`s, or of tables of values by key; see `grid` and `read_variants`.
    `output` is a name pattern that ends in .png or .webp (lossless); its fields are {number}, {name} and
    keys. Without it, each result has an `image`, whose `form` is "array" (the default), "png" or "webp".

    The options:

    - `executor`: any executor of concurrent.futures, also Dask's `Client.get_executor()`; by default this
      process does the work. Runs of at most `runs` variants travel to it, at least a run for each worker.
    - `size`, by default (640, 480), and `smooth`, by default 1, as in `render`; a picture has its own.
    - `level`: the compression of PNG files, 0 to 9; `sync=False` as in `save_image`.
    - `resume`: skip each variant whose file is whole and was made from the same scene or picture and the
      same settings, and replace the other files that a batch wrote. `overwrite` replaces any file.
    - `ordered`: make the variants in their own order, as frames of an animation.

    `sheet` is a PNG file for a labeled contact sheet, `table` a CSV file for the results; both are also
    written if the batch is stopped. `progress` is called with each result.

    A variant that cannot be made has a `problem` in its result, which is also logged as a warning, and loses
    no other. Raises UsageError for a wrong argument, and for arrays that exceed the memory budget;
    InputError for an invalid source; OutputError if a file exists; WriteError if a file cannot be written;
    UnavailableError if the executor fails.
    """
    rows = variants_of(variants)
    cells = None if sheet is None else ContactSheet(rows)
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
            if _same_file(path) in map(_same_file, checked.paths):
                raise UsageError(f"{what} must have a file of its own, not {path}, a picture's; rename it")
            _make_folder(path)
            refuse_output(path, overwrite=checked.overwrite or (checked.resume and _is_of_batch(path)))
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
    for result in in_order:
        for line in result.problem.splitlines():
            LOG.warning("%s: %s", result.name, line)
    return in_order


def _same_file(path: str | PathLike[str]) -> str:
    """A text that is equal for names of one file, also where capitals do not matter."""
    return os.path.normcase(os.path.abspath(path)).casefold()


def _is_of_batch(path: str | PathLike[str]) -> bool:
    """Whether a file is the sheet or the table of a batch."""
    if not fspath(path).lower().endswith(".csv"):
        return mark_in(fspath(path), "png") == SHEET_MARK
    with suppress(OSError), open(path, "rb") as file:
        return file.read(len(TABLE_BEGINS)) == TABLE_BEGINS
    return False
