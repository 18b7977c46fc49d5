"""Where the time of a whole frame goes, step by step: `python -m benchmarks steps`.

What runs is the shipped code, with each function of the table below wrapped while it is timed. A step's line
stands below that of the step that calls it, and what a step does between those it calls is its rest. So the
lines of one depth, rests among them, add up to the line above them, but for each being a median.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial, wraps
from importlib import import_module
from typing import Any, NamedTuple

from benchmarks.cases import Case, spread, timed
from benchmarks.points import QUANTITIES, session


class Step(NamedTuple):
    """A function of a module, and the step that calls it."""

    module: str
    function: str
    parent: str


FRAME = "whole frame"
STEPS = (
    Step("autocolor.rendering", "rendering", FRAME),
    Step("autocolor.visibility.visible_surfaces", "visible_surfaces", "rendering"),
    Step("autocolor.visibility.projection", "projection", "visible_surfaces"),
    Step("autocolor.visibility.camera", "camera_space", "projection"),
    Step("autocolor.visibility.visible_surfaces", "depth_test", "visible_surfaces"),
    Step("autocolor.visibility.visible_surfaces", "segments_of_polygons", "depth_test"),
    Step("autocolor.visibility.depth", "extents_of_polygons", "segments_of_polygons"),
    Step("autocolor.visibility.scan_lines", "edges_of_sides", "extents_of_polygons"),
    Step("autocolor.visibility.visible_surfaces", "not_occluded", "visible_surfaces"),
    Step("autocolor.visibility.visible_surfaces", "interpolated_points", "visible_surfaces"),
    Step("autocolor.visibility.visible_surfaces", "visible_spans", "interpolated_points"),
    Step("autocolor.visibility.visible_surfaces", "along_spans", "interpolated_points"),
    Step("autocolor.visibility.visible_surfaces", "_fill", "interpolated_points"),
    Step("autocolor.lighting.illumination", "illuminate", "rendering"),
    Step("autocolor.lighting.shading", "shade", "illuminate"),
    Step("autocolor.lighting.shading", "mix", "illuminate"),
    Step("autocolor.studio", "display_image", FRAME),
    Step("autocolor.mapping.intensity", "words_of", "display_image"),
    Step("autocolor.studio", "send_image", FRAME),
)
"""The steps of a frame in their order."""

ROUNDS = 15
SCENES = {"the coupe": ("lines", 480), "hills of a million polygons": ("polygons", 1_000_000)}
"""What is rendered: points of the scaling curves."""

Frame = dict[str, float]
"""Seconds of each line of one frame."""


def functions() -> dict[Step, Callable[..., Any]]:
    """The functions of the table; leaves with a sentence where one is not there."""
    found = {}
    for step in STEPS:
        try:
            found[step] = getattr(import_module(step.module), step.function)
        except (ImportError, AttributeError):
            raise SystemExit(
                f"benchmarks/steps.py: {step.module} must have the step {step.function}, and has not; name in"
                " STEPS the function that does its work now"
            ) from None
    return found


@dataclass
class Watch:
    """The lines of the current frame, the step of each line, and the steps that are being done."""

    frame: Frame = field(default_factory=dict)
    step_of_line: dict[str, Step] = field(default_factory=dict)
    doing: list[str] = field(default_factory=lambda: [FRAME])

    def around(self, step: Step, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, whose time is noted."""

        @wraps(function)
        def timed_step(*arguments: Any, **named: Any) -> Any:
            if self.doing[-1] != step.parent:
                raise SystemExit(
                    f"benchmarks/steps.py: {step.parent} must call {step.function}, and {self.doing[-1]}"
                    " does; correct its parent in STEPS, or leave out a step of several parents"
                )
            self.doing.append(step.function)
            begin = time.perf_counter()
            try:
                return function(*arguments, **named)
            finally:
                seconds = time.perf_counter() - begin
                self.doing.pop()
                self.step_of_line[step.function] = step
                self.frame[step.function] = self.frame.get(step.function, 0.0) + seconds

        return timed_step

    def timed_frame(self, run: Callable[[], object]) -> Frame:
        """Run a frame; its lines."""
        self.frame = {}
        begin = time.perf_counter()
        run()
        self.frame[FRAME] = time.perf_counter() - begin
        return self.frame


@contextmanager
def wrapped(watch: Watch) -> Iterator[None]:
    """Let the watch stand around every step, under each name and in each table of the package."""
    places: list[tuple[dict[Any, Any], Any, Callable[..., Any]]] = []
    found = functions()
    modules = [vars(module) for name, module in sys.modules.items() if name.partition(".")[0] == "autocolor"]
    tables = [value for names in modules for value in names.values() if isinstance(value, dict)]
    for step, function in found.items():
        around = watch.around(step, function)
        for names in (*modules, *tables):
            for name in [name for name, value in names.items() if value is function]:
                places.append((names, name, function))
                names[name] = around
    try:
        yield
    finally:
        for names, name, function in places:
            names[name] = function


def measure(rounds: int = ROUNDS, quick: bool = False) -> dict[str, Any]:
    """Milliseconds of each step of a frame of each scene, and its share; with `quick` of the coupe alone."""
    chosen = list(SCENES.items())[: 1 if quick else None]
    sessions = {name: session(QUANTITIES[quantity], size) for name, (quantity, size) in chosen}
    watch, frames = Watch(), dict[str, list[Frame]]()

    def frame(name: str) -> None:
        frames.setdefault(name, []).append(watch.timed_frame(sessions[name].frame))

    with wrapped(watch):
        timed([Case(name, partial(frame, name)) for name in sessions], rounds)
    # Those of the rounds that are not counted came first.
    scenes = {name: list(lines(watch, every[-rounds:])) for name, every in frames.items()}
    return {"rounds": rounds, "scenes": scenes}


def lines(watch: Watch, frames: list[Frame]) -> Iterator[dict[str, Any]]:
    """The lines of a scene's frames, each step above those it calls, with depth, milliseconds and share."""
    for step in STEPS:
        if step not in watch.step_of_line.values():
            raise SystemExit(
                f"benchmarks/steps.py: a frame must call {step.module}.{step.function}, and does not; name in"
                " STEPS the function that does its work now"
            )
    whole = spread([frame[FRAME] for frame in frames]).median

    def line(name: str, depth: int, seconds: list[float]) -> dict[str, Any]:
        spent = spread(seconds)
        return {
            "step": name,
            "depth": depth,
            "ms": spent.times(1e3)._asdict(),
            "percent": 100 * spent.median / whole,
        }

    def below(name: str, depth: int) -> Iterator[dict[str, Any]]:
        seconds = [frame[name] for frame in frames]
        yield line(name, depth, seconds)
        children = [
            child for child in frames[0] if child != FRAME and watch.step_of_line[child].parent == name
        ]
        for child in children:
            yield from below(child, depth + 1)
        if children:
            rest = [
                spent - sum(frame[child] for child in children)
                for spent, frame in zip(seconds, frames, strict=True)
            ]
            yield line(f"rest of {name}", depth + 1, rest)

    yield from below(FRAME, 0)


def text(measured: dict[str, Any]) -> str:
    """A line a step for each scene."""
    rows = []
    for scene, lines in measured["scenes"].items():
        rows += [f"{scene:48}{'ms':>9}{'quartiles':>16}{'% of frame':>12}"]
        for line in lines:
            name, spent = "  " * line["depth"] + line["step"], line["ms"]
            quartiles = f"{spent['low']:.2f}-{spent['high']:.2f}"
            rows.append(f"{name:48}{spent['median']:9.2f}{quartiles:>16}{line['percent']:12.1f}")
        rows.append("")
    return "\n".join(rows[:-1])
