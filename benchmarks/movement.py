"""How the picture follows a user: `python -m benchmarks movement`.

A key is held down and the mouse is dragged, for some seconds each, in the real window on a virtual screen,
with a mesh of 88,000 polygons. Both go through the X server, as from a keyboard. What counts is how quickly
fields follow each other, that nothing goes on after the release, and when the picture is fine again.
"""

from __future__ import annotations

import math
import os
import shutil
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from threading import Thread
from typing import Any, NamedTuple

import numpy as np

import autocolor
from autocolor.commands.window import connected
from autocolor.screens.viewer import Viewer
from benchmarks.cases import Spread, spread
from benchmarks.hills import hills, side_of
from ramtek_emu import Ramtek9300
from ramtek_emu.monitor.window import Monitor

POLYGONS = 88_000
DRAGGED_POLYGONS = 100_000
SECONDS = 5.0
REST = 1.0
"""Seconds between two movements."""
SETTLED = 0.5
"""Seconds from the press of a key until it repeats: before, there is nothing to show."""
SIZE = (1400, 1100)


class Span(NamedTuple):
    """From when to when something was held."""

    begin: float
    end: float


class Log:
    """When fields were shown, when the scene was edited, and when the picture was refined."""

    def __init__(self) -> None:
        self.fields: list[float] = []
        self.edits: list[float] = []
        self.refined: list[float] = []
        self.held: dict[str, Span] = {}


def drag_seconds(rounds: int = 25) -> Spread:
    """Seconds from one field to the next while the mouse drags 100,000 polygons; there is no window."""
    display = Ramtek9300()
    viewer = Viewer(autocolor.scene_of(hills(side_of(DRAGGED_POLYGONS))), display)
    field = np.zeros((480, 640), np.uint32)
    viewer.on_pointer(300, 200, "press", 1)
    seconds = []
    for step in range(2 * rounds):
        begin = time.perf_counter()
        viewer.on_pointer(301 + step, 200, "move")
        viewer.on_tick(is_at_rest=False)
        display.scan_out.scan_out_into(field)
        seconds.append(time.perf_counter() - begin)
    # The pace is found in the first half.
    return spread(seconds[rounds:])


def measure() -> dict[str, Any]:
    """What `figures` tells of each movement; nothing where a program is missing."""
    missing = [program for program in ("Xvfb", "xdotool") if shutil.which(program) is None]
    if missing:
        return {"absent": missing, "movements": {}}
    with screen():
        log = session()
    return {"absent": [], "movements": {name: figures(log, span) for name, span in log.held.items()}}


def figures(log: Log, span: Span) -> dict[str, float]:
    """What is told of one movement."""
    settled = span.begin + SETTLED
    fields = [at for at in log.fields if settled <= at <= span.end]
    gaps = [later - earlier for earlier, later in pairwise(fields)]
    edits = [at for at in log.edits if span.begin <= at < span.end + REST]
    refined = [at for at in log.refined if span.end <= at < span.end + REST]
    return {
        "fields a second": len(gaps) / (fields[-1] - fields[0]) if len(fields) > 1 else 0.0,
        "longest ms between fields": 1e3 * max(gaps, default=math.inf),
        "last edit, ms after release": 1e3 * max(0.0, edits[-1] - span.end) if edits else math.inf,
        "fine picture, ms after release": 1e3 * (refined[0] - span.end) if refined else 0.0,
    }


def text(measured: dict[str, Any]) -> str:
    """One row for each figure."""
    if measured["absent"]:
        return f"skipped: not installed: {', '.join(measured['absent'])}"
    movements = measured["movements"]
    head = f"{POLYGONS:,} polygons in the window"
    rows = [f"{head:40}" + "".join(f"{name:>16}" for name in movements)]
    for figure in next(iter(movements.values())):
        rows.append(f"{figure:40}" + "".join(f"{each[figure]:16.0f}" for each in movements.values()))
    return "\n".join(rows)


@contextmanager
def screen() -> Iterator[None]:
    """A virtual screen that DISPLAY names."""
    read_end, write_end = os.pipe()
    size = f"{SIZE[0]}x{SIZE[1]}x24"
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write_end), "-screen", "0", size, "-nolisten", "tcp", "-noreset"],
        pass_fds=[write_end],
        stderr=subprocess.DEVNULL,
    )
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        os.environ["DISPLAY"] = f":{pipe.readline().strip()}"
    os.environ.pop("SDL_VIDEODRIVER", None)
    try:
        yield
    finally:
        server.terminate()
        server.wait()


def session() -> Log:
    """A window with a mesh, and a user who holds a key and drags the mouse."""
    display, log = Ramtek9300(), Log()
    viewer = Viewer(autocolor.scene_of(hills(side_of(POLYGONS))), display)
    monitor = connected(Monitor(display), viewer)
    user = Thread(target=move, args=(log,))
    scene, was_coarse = viewer.studio.scene, False
    monitor.open()
    user.start()
    while user.is_alive():
        shown = monitor.refreshed
        monitor.step(15)
        now = time.monotonic()
        if monitor.refreshed != shown:
            log.fields.append(now)
        if viewer.studio.scene is not scene:
            scene = viewer.studio.scene
            log.edits.append(now)
        if was_coarse and not viewer.studio.is_coarse:
            log.refined.append(now)
        was_coarse = viewer.studio.is_coarse
    monitor.close()
    return log


def move(log: Log) -> None:
    """Hold a key, then drag the mouse in a figure of eight."""
    time.sleep(REST)
    tool("mousemove", "700", "550")
    log.held["a key held"] = held(["keydown", "Left", "sleep", str(SECONDS)], ["keyup", "Left"])
    time.sleep(REST)
    steps: list[str] = []
    for step in range(int(SECONDS / 0.01)):
        turn = 2 * math.pi * step * 0.01
        place = 700 + 300 * math.sin(turn / 2), 550 + 150 * math.sin(turn)
        steps += ["mousemove", *(str(round(each)) for each in place), "sleep", "0.01"]
    log.held["a drag"] = held(["mousedown", "1", *steps], ["mouseup", "1"])
    time.sleep(REST)


def held(begin: Sequence[str], end: Sequence[str]) -> Span:
    """Something held down, from when to when: until just before the release is asked for."""
    begun = time.monotonic()
    tool(*begin)
    ended = time.monotonic()
    tool(*end)
    return Span(begun, ended)


def tool(*arguments: str) -> None:
    """Run xdotool."""
    subprocess.run(["xdotool", *arguments], check=True)
