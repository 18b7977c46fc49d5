"""Batches: what recolorings cost beside the encoder, in two processes, and light moves beside relighting.

`python -m benchmarks batches` has the milliseconds of the processor for a picture at each level of PNG:
of the encoder alone, of writing the file, and of everything else.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing, contextmanager
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple
from unittest.mock import patch

import autocolor
from autocolor.batches import making
from autocolor.batches.table import Variant
from autocolor.images import display_image, smoothed
from autocolor.rendering import rendering
from benchmarks.cases import Spread, ratios, spread
from benchmarks.points import COUPE
from ramtek_emu import png

RECOLORINGS, MOVES = 1000, 500
LEVELS = range(10)
AT_EACH_LEVEL = 100
"""Recolorings at each level."""

TURNS = 5
JOBS = 2


class Costs(NamedTuple):
    """Milliseconds of the processor for a picture."""

    encoder: float
    writing: float
    others: float


def paints(count: int) -> tuple[Variant, ...]:
    """So many colors of the body."""
    colors = (f"#{7919 * number % (1 << 24):06x}" for number in range(count))
    return autocolor.grid({"surfaces.body.object_color": colors})


def moves(count: int) -> tuple[Variant, ...]:
    """So many places of a light."""
    return autocolor.grid({"lights.key.position": [[4 + 0.01 * n, -6.0, 5.0] for n in range(count)]})


def picture() -> tuple[autocolor.Scene, autocolor.Picture]:
    """The coupe and its picture."""
    scene = autocolor.read_scene(COUPE)
    return scene, autocolor.render(scene)


@contextmanager
def clocked(owner: Any, name: str) -> Iterator[list[float]]:
    """The seconds of the processor that each call of a function takes while it is patched."""
    function: Callable[..., Any] = getattr(owner, name)
    seconds: list[float] = []

    def timed(*arguments: Any, **options: Any) -> Any:
        begun = time.process_time()
        try:
            return function(*arguments, **options)
        finally:
            seconds.append(time.process_time() - begun)

    with patch.object(owner, name, timed):
        yield seconds


def costs_at(level: int, count: int = AT_EACH_LEVEL) -> Costs:
    """What a recoloring of the coupe costs at a level of PNG."""
    source = picture()
    with TemporaryDirectory() as folder:
        output = Path(folder) / "{number}.png"
        with clocked(png, "png_bytes") as encoder, clocked(making, "write_atomically") as writing:
            begun = time.process_time()
            results = autocolor.batch(source, paints(count), output, level=level)
            whole = time.process_time() - begun
        assert all(result.path for result in results)
    parts = sum(encoder), sum(writing)
    return Costs(*(1e3 * seconds / count for seconds in (*parts, whole - sum(parts))))


def beside_the_encoder() -> Spread:
    """Milliseconds of the processor beside the encoder and writing, of the dearest level."""
    count = RECOLORINGS // len(LEVELS)
    return spread([max(costs_at(level, count).others for level in LEVELS)])


def two_processes(count: int = RECOLORINGS // 4, turns: int = TURNS) -> Spread:
    """How many times as many recolorings two processes write in a time as this process alone."""
    source = picture()
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(JOBS, context) as executor, TemporaryDirectory() as folder:
        seconds: Mapping[str, list[float]] = {"one": [], "two": []}
        for turn in range(turns + 1):
            for name, given in (("one", None), ("two", executor)):
                begun = time.perf_counter()
                autocolor.batch(
                    source, paints(count), f"{folder}/{turn}-{name}-{{number}}.png", executor=given
                )
                seconds[name].append(time.perf_counter() - begun)
    # The first turn starts the processes.
    return ratios(seconds["one"][1:], seconds["two"][1:])


def light_moves(count: int = MOVES) -> Spread:
    """How many times as long a light move of a batch takes as to relight the picture and look up its colors.

    Both are timed by the processor, move by move in turns.
    """
    scene = autocolor.read_scene(COUPE)
    places = moves(count)
    batch, alone = [], []
    before = rendering(scene)
    image = display_image(scene, before.picture)
    with closing(autocolor.batch_results(scene, places, smooth=1, ordered=True)) as results:
        next(results)
        for place in islice(places, 1, None):
            begun = time.process_time()
            result = next(results)
            between = time.process_time()
            moved = scene.with_light("key", position=place.settings["lights.key.position"])  # type: ignore[arg-type]
            before = rendering(moved, before=before)
            image = display_image(moved, before.picture, image)
            smoothed(image, 1)
            ended = time.process_time()
            assert result.image is not None
            batch.append(between - begun)
            alone.append(ended - between)
    return ratios(batch, alone)


def measure(quick: bool = False) -> dict[str, Any]:
    """The costs of a recoloring at each level of PNG."""
    levels = (1, 4) if quick else LEVELS
    return {"levels": {level: costs_at(level, 10 if quick else AT_EACH_LEVEL)._asdict() for level in levels}}


def text(measured: dict[str, Any]) -> str:
    """The costs as a table."""
    lines = [f"{'level':>5}{'encoder':>10}{'writing':>10}{'others':>10}  ms of the processor for a picture"]
    for level, costs in measured["levels"].items():
        lines.append(f"{level:5}{costs['encoder']:10.2f}{costs['writing']:10.2f}{costs['others']:10.2f}")
    return "\n".join(lines)
