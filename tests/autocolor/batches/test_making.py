from __future__ import annotations

import csv
import importlib
import itertools
import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from autocolor import (
    InputError,
    OutputError,
    Scene,
    UnavailableError,
    UsageError,
    WriteError,
    batch,
    batch_results,
    grid,
    image,
    read_picture,
    render,
    write_picture,
)
from autocolor.batches import making
from autocolor.batches.making import MORE_THAN_WORKERS, VariantWarning
from autocolor.batches.outputs import SHEET_MARK, mark_in
from autocolor.batches.table import Result, Variant, variants_of
from autocolor.files.settings import scene_with
from autocolor.scene.columns import Tier
from tests.small import wall_scene

SIZE = (16, 12)
GRID = grid(
    {
        "surfaces.wall.object_color": ["red", "navy", "#10a050"],
        "lights.key.intensity": [0.5, 1.5],
        "view.angle": [0, 20],
    }
)
PAINTS = grid({"surfaces.wall.object_color": [[n, 255 - n, 128] for n in range(0, 250, 10)]})


@pytest.fixture
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs of one variant."""
    monkeypatch.setattr(making, "VARIANTS_OF_RUN", 1)


class Reversed(Executor):
    """Runs tasks when their results are asked for, the last first; counts those that are not yet done."""

    _max_workers = 3

    def __init__(self) -> None:
        self.pending: list[Future[Any]] = []
        self.most = 0

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **_: Any) -> Future[Any]:
        future: Future[Any] = Late(self)
        future.task = function, arguments  # type: ignore[attr-defined]
        self.pending.append(future)
        self.most = max(self.most, len(self.pending))
        return future


class Late(Future[Any]):
    def __init__(self, executor: Reversed) -> None:
        super().__init__()
        self._executor = executor

    def result(self, timeout: float | None = None) -> Any:
        if not self.done():
            function, arguments = self.task  # type: ignore[attr-defined]
            self.set_result(function(*arguments))
            self._executor.pending.remove(self)
        return super().result(timeout)


def rows_of(table: Path) -> list[dict[str, str]]:
    with open(table, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def images(results: list[Result]) -> list[bytes]:
    assert all(isinstance(result.image, bytes) for result in results)
    return [result.image for result in results if isinstance(result.image, bytes)]


def files(results: list[Result]) -> list[bytes]:
    return [Path(str(result.path)).read_bytes() for result in results]


def test_the_pictures_are_those_of_each_scene_rendered_alone_in_the_order_of_the_variants() -> None:
    scene = wall_scene()
    results = batch(scene, GRID, size=SIZE)
    assert [result.name for result in results] == [variant.name for variant in GRID]
    for result, variant in zip(results, GRID, strict=True):
        edited = scene_with(scene, variant.settings)
        assert np.array_equal(result.image, image(edited, size=SIZE))  # type: ignore[arg-type]
    # Each of two frames is rendered once and relit once, for three paints.
    tiers = [result.tier for result in results]
    assert sorted(tiers) == [Tier.ENTRIES] * 8 + [Tier.MIX] * 2 + [Tier.FRAME] * 2  # type: ignore[type-var]


def test_any_executor_gives_the_same_bytes() -> None:
    scene = wall_scene()
    expected = images(batch(scene, GRID, size=SIZE, form="png"))
    with ThreadPoolExecutor(3) as threads:
        assert images(batch(scene, GRID, size=SIZE, form="png", executor=threads)) == expected
    assert images(batch(scene, GRID, size=SIZE, form="png", executor=Reversed())) == expected


@pytest.mark.filterwarnings("ignore::autocolor.batches.making.VariantWarning")
def test_processes_give_the_same_bytes_from_a_scene_and_from_a_picture() -> None:
    scene = wall_scene()
    source = scene, render(scene, (16, 12))
    variants = [*GRID, Variant("bad", {"ambient": -1})]
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as processes:
        for given, rows in ((scene, variants), (scene, PAINTS), (source, PAINTS)):
            size = SIZE if given is scene else None
            here = batch(given, rows, size=size, form="webp")
            there = batch(given, rows, size=size, form="webp", executor=processes)
            assert [result.image for result in there] == [result.image for result in here]
            assert [result.problem for result in there] == [result.problem for result in here]


@pytest.mark.needs("distributed")
def test_a_cluster_of_dask_gives_the_same_bytes() -> None:
    distributed: Any = importlib.import_module("distributed")
    scene = wall_scene()
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
        client.get_executor() as executor,
    ):
        for rows in (GRID, PAINTS):
            there = batch(scene, rows, size=SIZE, form="png", executor=executor)
            assert images(there) == images(batch(scene, rows, size=SIZE, form="png"))


@pytest.mark.parametrize("executor", [None, Reversed()])
def test_ordered_results_come_in_the_order_of_the_variants(executor: Executor | None) -> None:
    results = list(batch_results(wall_scene(), GRID, size=SIZE, ordered=True, executor=executor))
    assert [result.name for result in results] == [variant.name for variant in GRID]
    if executor is None:
        # The last key of the grid, the view, changes each time.
        assert [result.tier for result in results] == [Tier.FRAME] * 12


@pytest.mark.parametrize("ordered", [False, True])
@pytest.mark.usefixtures("alone")
def test_an_executor_has_a_few_more_runs_than_workers_however_many_variants_there_are(ordered: bool) -> None:
    executor = Reversed()
    count = 0
    rows = unnamed(PAINTS * 4)
    for _ in batch_results(wall_scene(), rows, size=SIZE, executor=executor, ordered=ordered):
        count += 1
        assert len(executor.pending) <= executor._max_workers + MORE_THAN_WORKERS
    assert count == 100
    assert executor.most == executor._max_workers + MORE_THAN_WORKERS


@pytest.mark.parametrize("ordered", [False, True])
def test_each_worker_gets_a_run_of_a_small_batch(ordered: bool) -> None:
    executor = Reversed()
    results = batch(wall_scene(), PAINTS[:7], size=SIZE, executor=executor, ordered=ordered)
    assert (len(results), executor.most) == (7, executor._max_workers)


def unnamed(variants: tuple[Variant, ...]) -> list[dict[str, object]]:
    return [dict(variant.settings) for variant in variants]


@pytest.mark.usefixtures("alone")
def test_a_batch_that_is_closed_cancels_what_waits_and_leaves_whole_files(tmp_path: Path) -> None:
    executor = Reversed()
    results = batch_results(
        wall_scene(), PAINTS, tmp_path / "{number}.png", size=SIZE, executor=executor, ordered=True
    )
    first = list(itertools.islice(results, 3))
    results.close()
    assert all(future.cancelled() for future in executor.pending)
    assert sorted(os.listdir(tmp_path)) == ["1.png", "2.png", "3.png"]
    for result in first:
        with Image.open(str(result.path)) as written:
            written.load()


def stopped(scene: Scene, output: Path, after: int, **options: Any) -> None:
    """Make a batch of PAINTS, and stop it by Ctrl+C after some pictures."""
    left = iter(range(after))

    def progress(_: Result) -> None:
        if next(left, None) is None:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        batch(scene, PAINTS, output, size=SIZE, progress=progress, **options)


def test_a_stopped_batch_is_resumed_and_loses_nothing(tmp_path: Path) -> None:
    scene, output = wall_scene(), tmp_path / "new" / "{number:03}-{name}.png"
    table, sheet = tmp_path / "more" / "made.csv", tmp_path / "sheet.png"
    stopped(scene, output, 9, table=table, sheet=sheet)
    # The table and the sheet of what was made are there, too.
    assert len(rows_of(table)) == 10
    half = sheet.read_bytes()
    before = {path: path.stat().st_mtime_ns for path in output.parent.iterdir()}
    assert len(before) == 10
    results = batch(scene, PAINTS, output, size=SIZE, resume=True, table=table, sheet=sheet)
    assert [result.was_made for result in results] == [False] * 10 + [True] * 15
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert files(results) == images(batch(scene, PAINTS, size=SIZE, form="png"))
    whole = tmp_path / "whole.png"
    batch(scene, PAINTS, tmp_path / "whole" / "{number}.png", size=SIZE, sheet=whole)
    with ThreadPoolExecutor(1) as threads:
        for ordered in (False, True):
            again = batch(scene, PAINTS, output, size=SIZE, resume=True, executor=threads, ordered=ordered)
            assert not any(result.was_made for result in again)
    assert sheet.read_bytes() == whole.read_bytes() != half
    assert [row["path"] for row in rows_of(table)] == [result.path for result in results]


@pytest.mark.filterwarnings("ignore::autocolor.batches.making.VariantWarning")
def test_what_differs_is_made_again_and_nothing_else(tmp_path: Path) -> None:
    scene, output = wall_scene(), tmp_path / "{number}.png"

    def made(source: Any, rows: Any = PAINTS, **options: Any) -> list[int]:
        results = batch(source, rows, output, resume=True, **{"size": SIZE, **options})
        assert files(results) == images(batch(source, rows, form="png", **{"size": SIZE, **options}))
        return [number for number, result in enumerate(results, 1) if result.was_made]

    everything = list(range(1, 26))
    assert made(scene) == everything
    assert made(scene) == []
    rows = unnamed(PAINTS)
    rows[3] = {"surfaces.wall.object_color": "red"}
    assert made(scene, rows) == [4]
    # A file that is damaged in its middle, a missing file, and an empty file, as after a power failure.
    data = bytearray((tmp_path / "7.png").read_bytes())
    data[len(data) // 2] ^= 1
    (tmp_path / "7.png").write_bytes(data)
    (tmp_path / "9.png").unlink()
    (tmp_path / "11.png").write_bytes(b"")
    assert made(scene, rows) == [7, 9, 11]
    # A file without its end is not known as a picture of a batch.
    (tmp_path / "7.png").write_bytes((tmp_path / "7.png").read_bytes()[:-1])
    cut, *_ = (each for each in batch(scene, rows, output, size=SIZE, resume=True) if each.problem)
    assert cut.name == PAINTS[6].name
    results = batch(scene, rows, output, size=SIZE, resume=True, overwrite=True)
    assert [number for number, result in enumerate(results, 1) if result.was_made] == [7]
    assert made(scene.replace(ambient=0.3), rows) == everything
    assert made(scene.replace(ambient=0.3), rows, level=9) == everything
    assert made(scene.replace(ambient=0.3), rows, smooth=1, level=9) == everything


@pytest.mark.filterwarnings("ignore::autocolor.batches.making.VariantWarning")
def test_the_file_of_a_stranger_is_never_overwritten_unless_that_is_asked(tmp_path: Path) -> None:
    scene, output = wall_scene(), tmp_path / "{name}.png"
    rows = variants_of([{"name": "a", "ambient": 0.1}, {"name": "b", "ambient": 0.2}])
    (tmp_path / "a.png").write_bytes(b"mine")
    with pytest.raises(OutputError, match=r"must be new files, not .*a\.png, which exists; resume the batch"):
        batch(scene, rows, output, size=SIZE)
    assert os.listdir(tmp_path) == ["a.png"]
    one, other = batch(scene, rows, output, size=SIZE, resume=True)
    assert (one.path, one.image, "which exists" in one.problem) == (None, None, True)
    assert (other.problem, (tmp_path / "a.png").read_bytes()) == ("", b"mine")
    for own in ({"sheet": tmp_path / "s.png"}, {"table": tmp_path / "t.csv"}):
        (path,) = own.values()
        path.write_bytes(b"mine")
        with pytest.raises(OutputError, match="which exists"):
            batch(scene, rows[1:], output, size=SIZE, resume=True, **own)  # type: ignore[arg-type]
        assert path.read_bytes() == b"mine"
    batch(scene, rows, output, size=SIZE, overwrite=True)
    assert mark_in(str(tmp_path / "a.png"), "png") != ""


@pytest.mark.filterwarnings("ignore::autocolor.batches.making.VariantWarning")
def test_one_bad_variant_is_in_the_table_and_loses_no_other(tmp_path: Path) -> None:
    rows: list[dict[str, object]] = [
        {"name": "good", "ambient": 0.1},
        {"name": "bad", "ambient": "x"},
        {"name": "also", "ambient": 1},
    ]
    table = tmp_path / "made.csv"
    results = batch(wall_scene(), rows, tmp_path / "{name}.webp", size=SIZE, table=table)
    assert [bool(result.problem) for result in results] == [False, True, False]
    read = rows_of(table)
    assert [(row["name"], row["ambient"], bool(row["path"])) for row in read] == [
        ("good", "0.1", True),
        ("bad", "x", False),
        ("also", "1", True),
    ]
    assert (
        read[1]["problem"] == results[1].problem == "ambient must be a finite number of at least 0, not 'x'"
    )


def test_a_batch_starts_from_a_path_of_a_picture_or_a_scene(tmp_path: Path) -> None:
    scene = wall_scene()
    path = tmp_path / "wall.npz"
    write_picture(path, scene, render(scene, (16, 12), smooth=2))
    saved = read_picture(path)
    expected = images(batch((saved.scene, saved.picture), PAINTS, form="png"))
    assert images(batch(str(path), PAINTS, form="png")) == expected
    assert images(batch(saved, PAINTS, form="png")) == expected
    # The size and smooth that the picture has may be given, in pixels of its image, and no others.
    assert images(batch(saved, PAINTS, size=SIZE, smooth=2, form="png")) == expected
    for size, smooth in (((32, 24), 2), (SIZE, 1), ((32, 24), 1)):
        with pytest.raises(UsageError, match="must be those of its picture, 16 x 12 and 2"):
            batch(saved, PAINTS, size=size, smooth=smooth)
    colors = batch(path, PAINTS[:1])[0].image
    edited = scene_with(scene, PAINTS[0].settings)
    assert np.array_equal(colors, image(edited, size=SIZE))  # type: ignore[arg-type]


class Broken(Executor):
    """Breaks at a task, as when the system ends a process."""

    def __init__(self, error: Exception, at_once: bool) -> None:
        self.error, self.at_once = error, at_once

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **_: Any) -> Future[Any]:
        if self.at_once:
            raise self.error
        future: Future[Any] = Future()
        future.set_exception(self.error)
        return future


class KilledWorker(Exception):  # noqa: N818
    """The error of Dask for a task whose workers ended."""


ERRORS = [BrokenExecutor("a process died"), CancelledError(), KilledWorker("w"), RuntimeError("shut down")]


@pytest.mark.parametrize("at_once", [False, True])
@pytest.mark.parametrize("error", ERRORS)
def test_an_executor_that_breaks_is_told_in_a_sentence(error: Exception, at_once: bool) -> None:
    is_told = at_once or type(error) is not RuntimeError
    with pytest.raises(UnavailableError if is_told else type(error)) as raised:
        batch(wall_scene(), PAINTS, size=SIZE, executor=Broken(error, at_once))
    if is_told:
        assert str(raised.value).startswith("the workers of a batch must run until it ends, and they stopped")


class Less(Executor):
    """Runs each task at once, and returns something else than its result."""

    def __init__(self, changed: Callable[[list[Any]], object]) -> None:
        self.changed = changed

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **_: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(self.changed(function(*arguments)))
        return future


@pytest.mark.parametrize(
    "changed", [lambda made: made[:-1], lambda made: None, lambda made: [None, *made[1:]]]
)
def test_an_executor_that_returns_something_else_is_refused(changed: Callable[[list[Any]], object]) -> None:
    with pytest.raises(UnavailableError, match="an executor must return what its function returns"):
        batch(wall_scene(), PAINTS, size=SIZE, executor=Less(changed))


def test_a_full_disk_ends_the_batch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise WriteError("no space")

    monkeypatch.setattr(making, "write_atomically", full)
    with pytest.raises(WriteError, match="no space"):
        list(batch_results(wall_scene(), PAINTS, tmp_path / "{number}.png", size=SIZE))


def test_a_folder_that_cannot_be_made_is_a_problem_of_its_variants(tmp_path: Path) -> None:
    (tmp_path / "red").write_bytes(b"")
    rows = variants_of([{"name": "red", "background": "red"}, {"name": "navy", "background": "navy"}])
    with pytest.warns(VariantWarning, match="red: an output must have a folder"):
        one, other = batch(wall_scene(), rows, tmp_path / "{name}" / "a.png", size=SIZE)
    assert "an output must have a folder" in one.problem
    assert (other.problem, other.path) == ("", str(tmp_path / "navy" / "a.png"))


def test_each_problem_is_a_warning_and_all_problems_are_an_error(tmp_path: Path) -> None:
    names = ("red", "no", "nay")
    rows = [{"name": name, "background": name} for name in names]
    with pytest.warns(VariantWarning) as warned:
        results = batch(wall_scene(), rows, size=SIZE)
    assert [str(each.message) for each in warned] == [f"{each.name}: {each.problem}" for each in results[1:]]
    assert {each.filename for each in warned} == {__file__}
    table = tmp_path / "made.csv"
    with pytest.raises(InputError) as refused:
        batch(wall_scene(), grid({"background": [f"no{n}" for n in range(12)]}), size=SIZE, table=table)
    assert len(refused.value.problems) == 11
    assert refused.value.problems[0].startswith('no0: background must be "#rrggbb"')
    assert refused.value.problems[-1] == "and 2 problems more"
    assert len(rows_of(table)) == 12


def test_a_sheet_is_never_written_over_a_picture_of_another_batch(tmp_path: Path) -> None:
    (other,) = batch(wall_scene(), [{}], tmp_path / "a.png", size=SIZE)
    again: dict[str, Any] = {"size": SIZE, "sheet": tmp_path / "a.png", "resume": True}
    with pytest.raises(OutputError, match="must be a new file"):
        batch(wall_scene(), PAINTS[:2], tmp_path / "{number}.png", **again)
    again["sheet"] = tmp_path / "sheet.png"
    for _ in range(2):
        batch(wall_scene(), PAINTS[:2], tmp_path / "{number}.png", **again)
    assert mark_in(str(other.path), "png") != SHEET_MARK


def refused() -> Iterator[tuple[dict[str, Any], type[Exception], str]]:
    scene = wall_scene()
    yield {"output": "same.png"}, UsageError, "a name pattern must give each variant a file of its own"
    yield {"output": "a.jpg"}, UsageError, "the pictures of a batch must be written to files that end in"
    yield {"executor": 2}, UsageError, "an executor must be one of concurrent.futures or the like, not 2"
    yield {"size": (16,)}, UsageError, "a size must be (width, height), each from 1 to 16384"
    yield {"size": (16, 9999)}, UsageError, "a size must be (width, height), each from 1 to 8192 where smooth"
    yield {"smooth": 0}, UsageError, "smooth must be a whole number from 1 to 64, not 0"
    yield {"level": 10}, UsageError, "level must be a whole number from 0 to 9, not 10"
    yield {"resume": True}, UsageError, "only a batch with an output can be resumed"
    yield {"sheet": "a.jpg"}, UsageError, "a contact sheet must be written to a file that ends in .png"
    yield {"table": "a.txt"}, UsageError, "a table of results must be written to a file that ends in .csv"
    same = {"output": "{number}.png", "sheet": "25.PNG"}
    yield same, UsageError, "a contact sheet must have a file of its own, not 25.PNG, a picture's; rename it"
    yield {"source": 3}, UsageError, "a scene must be a Scene, not 3"
    yield {"source": (render(scene, (4, 3)), scene)}, UsageError, "the scene must come before the picture"
    yield {"source": "no.npz"}, InputError, "no.npz"
    other = {"source": (scene, render(scene, (4, 3))), "size": (8, 6)}
    yield other, UsageError, "the size and smooth of a batch"
    yield {"size": 640}, UsageError, "a size must be (width, height)"
    yield {"source": (scene, render(scene, (4, 3))), "size": 4}, UsageError, "a size must be (width, height)"
    yield {"executor": ThreadPoolExecutor}, UsageError, "an executor must be one of concurrent.futures"
    deep = {"output": "d/" * 1500 + "{name}.png"}
    yield deep, UsageError, "the path of a picture must have at most 1,024 characters, not 3,0"
    yield {"size": (9000, 9000)}, UsageError, "the arrays of a batch must have at most 4,000,000,000 bytes"
    yield {"variants": []}, UsageError, "a batch must have at least one variant, not none; add a row"
    unknown = "surfaces.wal.blend: there is no surface 'wal'; did you mean 'wall'?"
    yield {"variants": [{}, {"surfaces.wal.blend": 1}]}, UsageError, unknown
    unknown = "surfaces.wall.blnd: surface 'wall': there is no field 'blnd'; did you mean 'blend'?"
    yield {"variants": [{}, {"surfaces.wall.blnd": 1}]}, UsageError, unknown
    yield (
        {"overwite": True},
        UsageError,
        "there is no option 'overwite' of a batch; did you mean 'overwrite'?",
    )
    yield {"columns": 3}, UsageError, "columns are for a contact sheet; give a sheet, or leave them out"
    yield {"variants": "red"}, UsageError, "variants must be a list of tables or of Variants, not 'red'"


@pytest.mark.parametrize(("changes", "error", "sentence"), list(refused()))
def test_a_wrong_call_is_refused_before_anything_is_made(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    changes: dict[str, Any],
    error: type[Exception],
    sentence: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    arguments = {"source": wall_scene(), "variants": PAINTS, **changes}
    with pytest.raises(error) as caught:
        batch(**arguments)
    assert str(caught.value).startswith(sentence)
    assert os.listdir() == []
