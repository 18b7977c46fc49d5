"""Making batches: in this process or by any executor, in bounded memory, and resuming a stopped batch.

Each variant reuses whatever its edit leaves of the variant before it. So variants that see the same points
are made one after the other, among them those with the same light, and so on down to recolorings: a grid of
views, lights and paints renders each view once and lights each view once for all paints.

An executor gets runs of variants one by one, each with the scene and its picture, and returns the bytes of
finished files; only this process writes files. Each worker keeps its last rendering until it works at another
batch.
"""

from __future__ import annotations

import dataclasses
import os
import pickle
import time
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import closing, suppress
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain, groupby, islice
from os import PathLike, fspath
from pathlib import Path
from typing import Final, NamedTuple, TypedDict, Unpack

from autocolor.arrays import Bytes
from autocolor.batches.outputs import (
    ARRAY,
    SHEET_MARK,
    Box,
    base_mark,
    box_of,
    form_of,
    mark_in,
    mark_of,
    marked,
    paths_of,
    read_thumbnail,
    same_file,
    sheet_png,
    thumbnail,
)
from autocolor.batches.table import TABLE_BEGINS, Result, Rows, Variant, results_bytes, variants_of
from autocolor.budget import allowed_memory, allowing, validated_limit
from autocolor.checks import brief, nearest, shown
from autocolor.errors import AutocolorError, InputError, OutputError, UnavailableError, UsageError
from autocolor.files.opening import is_picture, read_scene
from autocolor.files.picture_file import read_picture
from autocolor.files.settings import field_of, place_of, scene_with
from autocolor.files.writing import check_suffix, refuse_output, write_atomically
from autocolor.images import check_png_level, default_smooth, display_image, smoothed
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.mapping.display_image import DisplayImage
from autocolor.rendering import SIZE, Rendering, checked_size, rendering
from autocolor.scene.columns import Tier
from autocolor.scene.scene import Scene, check_scene, cost_of_edit, costs_at_least

Source = Scene | tuple[Scene, Picture] | str | PathLike[str]
"""What variants are made from: a scene, a scene with its picture, or the path of either."""

VARIANTS_OF_RUN: Final = 16
"""The most variants of a run.

Measured: handing out the coupe's picture takes this process 1.6 ms for a run of one variant, and 0.2 ms a
variant for runs of 16. With runs of 1, 4, 16 and 64, two processes take the same time within a tenth.
"""

BYTES_UNDER_WAY: Final = 1 << 29
"""Limit: bytes of the pictures that an executor computes or has finished. It always gets two runs."""

WORKERS: Final = 62
"""Assumed: the workers of an executor that does not say how many it has."""

PROBLEMS_SHOWN: Final = 10
"""The problems in the message about a batch of which no variant could be made."""


class VariantWarning(UserWarning):
    """A variant of a batch could not be made; the others are."""


# Pictures of variants, each drawn after the variant before it.


class Drawing(NamedTuple):
    """How the pictures of a batch are drawn: `smooth` times the lines and elements are rendered.

    All fields but `thumbnail`, the size of thumbnails for a sheet, and `limit`, that of memory, determine a
    file.
    """

    lines: int
    elements: int
    smooth: int
    form: str
    level: int | None
    thumbnail: Box | None
    limit: float


Numbered = tuple[int, Variant]
"""A variant with its number, from 0."""


class Made(NamedTuple):
    """The number of a variant, its result, and its thumbnail for a sheet."""

    number: int
    result: Result
    thumbnail: Bytes | None


class Drawn(NamedTuple):
    """A variant as it was drawn, for the variant after it: its image, its rendering if any, and its cost."""

    image: DisplayImage
    rendering: Rendering | None
    tier: Tier | None


@dataclass
class Start:
    """What all variants have: the scene, perhaps its picture, the drawing, and the variant drawn last."""

    scene: Scene
    picture: Picture | None
    drawing: Drawing
    base: str
    """The checksum of the scene, its picture and the drawing; empty for arrays."""
    latest: Drawn | None = None

    def drawn(self, settings: Mapping[str, object], before: Drawn | None) -> Drawn:
        """A variant, drawn after the variant `before`. Raises the errors of `scene_with` and `rendering`."""
        scene = scene_with(self.scene, settings)
        rendered = None if before is None else before.rendering
        tier = cost_of_edit(self.scene if before is None else before.image.scene, scene)
        picture = self.picture
        if picture is None or self.scene.words != scene.words or costs_at_least(self.scene, scene, Tier.MIX):
            # Other light, or other points, are rendered.
            tier = Tier.FRAME if rendered is None else tier
            smooth = self.drawing.smooth
            rendered = rendering(scene, smooth * self.drawing.lines, smooth * self.drawing.elements, rendered)
            picture = rendered.picture
        image = display_image(scene, picture, None if before is None else before.image)
        return Drawn(image, rendered, tier)


def made_of(start: Start, variants: Iterable[Numbered]) -> Generator[Made, None, None]:
    """The pictures of variants, one by one. A variant that cannot be made has a problem instead."""
    # Other threads may draw other variants meanwhile.
    latest, drawing = start.latest, start.drawing
    for number, variant in variants:
        begun = time.thread_time()
        result, small = Result(variant.name, variant.settings), None
        try:
            with allowing(drawing.limit):
                latest = start.latest = start.drawn(variant.settings, latest)
                colors = smoothed(latest.image, drawing.smooth)
            small = None if drawing.thumbnail is None else thumbnail(colors, drawing.thumbnail)
            is_array, mark = drawing.form == ARRAY, mark_of(start.base, variant)
            image = colors if is_array else marked(drawing.form, colors, drawing.level, mark)
            result = result._replace(image=image, tier=latest.tier)
        except AutocolorError as error:
            result = result._replace(problem=str(error))
        except MemoryError:
            problem = "a picture must fit in memory, and this one does not; make it smaller"
            result = result._replace(problem=problem)
        yield Made(number, result._replace(seconds=time.thread_time() - begun), small)


def make_run(pickled: bytes, variants: Sequence[Numbered]) -> list[Made]:
    """The pictures of a run for an executor. Runs of a batch share one start in a process."""
    return list(made_of(_unpickled(pickled), variants))


@lru_cache(maxsize=1)
def _unpickled(pickled: bytes) -> Start:
    start: Start = pickle.loads(pickled)
    return start


# The order of variants: each costs only the edit from the variant before it.


def runs_of(scene: Scene, variants: Sequence[Numbered], most: int) -> list[list[Numbered]]:
    """All variants in runs of at most `most`, in the order to make them.

    Variants of one frame share as few runs as possible, and several small frames share a run.
    """
    keys = dict.fromkeys(key for _, variant in variants for key in variant.settings)
    tiers = {key: tier_of(scene, key) for key in keys}
    dear = sorted((key for key in tiers if tiers[key] > Tier.ENTRIES), key=tiers.__getitem__, reverse=True)
    frames = [key for key in dear if tiers[key] is Tier.FRAME]

    def values(variant: Variant, some: Sequence[str]) -> list[str]:
        return [repr(variant.settings.get(key)) for key in some]

    # Sorting is stable: recolorings stay in the order of their table.
    in_order = sorted(variants, key=lambda numbered: values(numbered[1], dear))
    runs: list[list[Numbered]] = []
    for _, frame in groupby(in_order, key=lambda numbered: values(numbered[1], frames)):
        first, *others = cut(list(frame), most)
        if runs and len(runs[-1]) + len(first) <= most:
            runs[-1] += first
        else:
            runs.append(first)
        runs += others
    return runs


def cut(variants: Sequence[Numbered], most: int) -> list[list[Numbered]]:
    """Consecutive runs of at most `most` variants."""
    return [list(variants[first : first + most]) for first in range(0, len(variants), most)]


def tier_of(scene: Scene, key: str) -> Tier:
    """What an edit of a key's field costs at most; NOTHING for a whole row. Raises UsageError for no key."""
    field = field_of(place_of(scene, key))
    return Tier.NOTHING if field is None else field.tier


# Batches.


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
    """A checked batch: what to make, where, and how."""

    start: Start
    variants: tuple[Variant, ...]
    paths: tuple[str, ...]
    options: Options

    def results(self) -> Generator[Made, None, None]:
        """The result of each variant: whole files first, then new pictures."""
        start, drawing = self.start, self.start.drawing
        missing: list[Numbered] = []
        for number, variant in enumerate(self.variants):
            is_resumed, path = self.options.get("resume"), self.paths[number] if self.paths else ""
            if is_resumed and mark_in(path, drawing.form) == mark_of(start.base, variant):
                small = None if drawing.thumbnail is None else read_thumbnail(path, drawing.thumbnail)
                yield Made(number, Result(variant.name, variant.settings, path, was_made=False), small)
            else:
                missing.append((number, variant))
        executor = self.options.get("executor")
        workers = 1 if executor is None else getattr(executor, "_max_workers", None) or WORKERS
        most = max(2, BYTES_UNDER_WAY // (3 * drawing.lines * drawing.elements))
        # A small batch has at least a run for each worker.
        of_run = max(1, min(VARIANTS_OF_RUN, -(-len(missing) // workers), most // 2))
        is_ordered = self.options.get("ordered")
        runs = cut(missing, of_run) if is_ordered else runs_of(start.scene, missing, of_run)
        if executor is None:
            made = made_of(start, chain.from_iterable(runs))
        else:
            # A run waits for each worker, so that no worker waits for a run.
            made = _made_by(executor, start, runs, min(2 * workers, most // of_run))
        with closing(made):
            for each in made:
                yield self._written(each) if self.paths else each

    def _written(self, made: Made) -> Made:
        """A result whose picture is written to its file. Raises WriteError."""
        number, result, small = made
        path, image = self.paths[number], result.image
        if isinstance(image, bytes):
            # Replace an earlier picture of a batch, and never any other file.
            is_ours = self.options.get("resume", False) and mark_in(path, self.start.drawing.form) != ""
            overwrite = self.options.get("overwrite", False) or is_ours
            _make_folder(path)
            try:
                write_atomically(path, image, overwrite=overwrite, sync=self.options.get("sync", True))
                result = result._replace(path=path)
            except OutputError as error:
                result, small = result._replace(problem=str(error)), None
        return Made(number, result._replace(image=None), small)


def _made_by(
    executor: Executor, start: Start, runs: Iterable[list[Numbered]], most: int
) -> Generator[Made, None, None]:
    """The pictures of runs in their order, made by an executor, which has at most `most` of them at a time.

    Raises UnavailableError if its workers end, or if it returns something else.
    """
    # No variant needs the planes of the lights: a variant with other light is rendered.
    picture = None if start.picture is None else dataclasses.replace(start.picture, light_planes={})
    runs, pickled = iter(runs), pickle.dumps(dataclasses.replace(start, picture=picture), protocol=5)
    under_way: deque[tuple[list[Numbered], Future[list[Made]]]] = deque()
    try:
        while True:
            for run in islice(runs, most - len(under_way)):
                under_way.append((run, executor.submit(make_run, pickled, run)))
            if not under_way:
                return
            run, future = under_way.popleft()
            made = future.result()
            are_made = isinstance(made, list) and all(isinstance(each, Made) for each in made)
            if not are_made or [each.number for each in made] != [number for number, _ in run]:
                raise BrokenExecutor("they returned something else")
            yield from made
    except Exception as error:
        # An executor that was shut down raises RuntimeError itself. Dask's error is known by its name.
        is_broken = isinstance(error, (BrokenExecutor, CancelledError)) or type(error) is RuntimeError
        if not is_broken and type(error).__name__ != "KilledWorker":
            raise
        reason = f" ({brief(str(error))})" if str(error) else ""
        raise UnavailableError(
            f"the workers of a batch must return its pictures until it ends, and they did not{reason};"
            " finished files are whole: go on with resume, perhaps with fewer workers if memory was short"
        ) from error
    finally:
        for _, future in under_way:
            future.cancel()
        # An executor of threads leaves its start in this process.
        _unpickled.cache_clear()


def _make_folder(path: str | PathLike[str]) -> None:
    """Make the folder of a file if it is missing; if it cannot be made, writing the file says why."""
    with suppress(OSError, ValueError):
        Path(path).parent.mkdir(parents=True, exist_ok=True)


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
    values = {key: value for variant in variants for key, value in variant.settings.items()}
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
    if executor is not None and (isinstance(executor, type) or not hasattr(executor, "submit")):
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
        existing = next(filter(os.path.lexists, paths), None)
        if existing is not None:
            raise OutputError(
                f"the pictures of a batch must be new files, not {brief(existing)}, which exists; resume the"
                " batch with --resume (resume=True in Python), or overwrite with --force (overwrite=True)"
            )
    base = "" if form == ARRAY else base_mark(scene, picture, drawing[:5])
    return Batch(Start(scene, picture, drawing, base), rows, paths, options)


def batch_results(
    source: Source,
    variants: Rows,
    output: str | PathLike[str] | None = None,
    **options: Unpack[Options],
) -> Generator[Result, None, None]:
    """The results of variants as their pictures are made.

    `source`, `variants`, `output` and the other `options` are those of `batch`.

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

    A variant that cannot be made has a `problem` in its result and issues a VariantWarning; all others are
    made. Raises UsageError for wrong arguments, InputError if no variant can be made, OutputError or
    WriteError if a file cannot be written, and UnavailableError if the executor fails.
    """
    rows = variants_of(variants)
    if columns is not None and sheet is None:
        raise UsageError("columns are for a contact sheet; give a sheet, or leave them out")
    box = None if sheet is None else box_of(rows, columns)
    checked = checked_batch(source, rows, output, thumbnail=box, **options)
    drawing = checked.start.drawing
    if output is None and drawing.form == ARRAY:
        needed = len(rows) * 3 * drawing.lines * drawing.elements
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
    made: dict[int, Made] = {}
    try:
        with closing(checked.results()) as results:
            for each in results:
                made[each.number] = each
                if progress is not None:
                    progress(each.result)
    finally:
        # A stopped batch has these files, too.
        in_order = [made[number].result for number in sorted(made)]
        if table is not None:
            write_atomically(table, results_bytes(in_order), overwrite=True)
        if sheet is not None:
            thumbnails = {number: each.thumbnail for number, each in made.items()}
            write_atomically(sheet, sheet_png(rows, thumbnails, columns), overwrite=True)
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
    with suppress(OSError), open(path, "rb") as file:
        is_table = file.read(len(TABLE_BEGINS)) == TABLE_BEGINS
        return is_table or mark_in(fspath(path), "png") == SHEET_MARK
    return False
