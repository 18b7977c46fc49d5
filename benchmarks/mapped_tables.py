"""Meshes as .npy tables that are mapped into memory: `python -m benchmarks mapped_tables`.

Hills of a million and of ten million quads are written as tables in chunks, converted to tables with normals,
and rendered, each in a process of its own: `python -m benchmarks.mapped_tables render FOLDER ROUNDS`. Memory
is anonymous resident memory (RssAnon), for mapped pages are the system's to drop; it is looked at every
few milliseconds, and told beyond what the process held after a small scene.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import autocolor
from autocolor.files.meshes.npy_tables import NODES, POLYGONS, read_npy_tables, write_npy_tables
from autocolor.scene.creation import scene_of
from benchmarks.cases import Spread, spread
from benchmarks.hills import side_of
from benchmarks.memory import STATUS
from benchmarks.once import OVER_HILLS

ROOT = Path(__file__).parents[1]
SMALL = ROOT / "scenes" / "pyramid"
SIZES = (1_000_000, 10_000_000)
FEW = (100_000, 1_000_000)
"""The sizes of a quick measurement."""

ROUNDS = 5
ROWS_AT_ONCE = 64
LOOK_EVERY = 0.002
"""Seconds between two looks at the memory."""


def measure(rounds: int = ROUNDS, quick: bool = False) -> dict[str, Any]:
    """Seconds and MB of each step for a mesh and for one of ten times as many polygons."""
    steps: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        for polygons in FEW if quick else SIZES:
            plain, full = Path(folder, f"plain-{polygons}"), Path(folder, f"full-{polygons}")
            make(plain, side_of(polygons))
            full.mkdir()
            steps.append(
                {
                    "polygons": side_of(polygons) ** 2,
                    "convert": in_a_process("convert", str(plain), str(full)),
                    "render": in_a_process("render", str(full), str(rounds)),
                    "without normals": in_a_process("render", str(plain), "1"),
                }
            )
    return {"rounds": rounds, "steps": steps}


@cache
def measured_once() -> dict[str, Any]:
    """What is measured of both meshes, for two targets."""
    return measure()


def mapped_times() -> Spread:
    """A frame of ten million quads, in frames of a million: the medians of two processes."""
    few, many = (each["render"]["frame s"]["median"] for each in measured_once()["steps"])
    return spread([many / few])


def mapped_memory() -> Spread:
    """MB that opening and rendering ten million quads takes beyond the tables."""
    return spread([measured_once()["steps"][-1]["render"]["MB"]])


def make(folder: Path, side: int) -> None:
    """Write the tables of side x side quads of hills, some rows of them at a time."""
    folder.mkdir()
    count = side + 1
    nodes = np.lib.format.open_memmap(folder / NODES, "w+", np.float64, (count**2, 3), fortran_order=True)
    quads = np.lib.format.open_memmap(folder / POLYGONS, "w+", np.intp, (side**2, 4), fortran_order=True)
    at = np.linspace(-1, 1, count)
    for first in range(0, count, ROWS_AT_ONCE):
        across, along = np.meshgrid(at, at[first : first + ROWS_AT_ONCE])
        height = 0.1 * np.sin(7 * across) * np.cos(5 * along)
        rows = slice(first * count, first * count + across.size)
        for column, values in enumerate((across, along, height)):
            nodes[rows, column] = values.ravel()
        last = min(first + ROWS_AT_ONCE, side)
        corner = (np.arange(first, last)[:, None] * count + np.arange(side)).ravel()
        for column, off in enumerate((0, 1, count + 1, count)):
            quads[first * side : last * side, column] = corner + off
    nodes.flush()
    quads.flush()


def in_a_process(*arguments: str) -> dict[str, Any]:
    """What a step measures, in a fresh process."""
    command = [sys.executable, "-m", "benchmarks.mapped_tables", *arguments]
    told = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout
    measured: dict[str, Any] = json.loads(told)
    return measured


def anonymous() -> float:
    """The anonymous resident memory of this process in MB."""
    lines = STATUS.read_text(encoding="ascii", errors="replace").splitlines()
    return next(int(line.split()[1]) * 1024 / 1e6 for line in lines if line.startswith("RssAnon:"))


@contextmanager
def watched() -> Iterator[Callable[[], float]]:
    """Look at the memory in a thread; what is yielded tells the peak over the beginning, in MB."""
    begin = anonymous()
    peak, done = [begin], threading.Event()

    def look() -> None:
        while not done.wait(LOOK_EVERY):
            peak[0] = max(peak[0], anonymous())

    thread = threading.Thread(target=look)
    thread.start()
    try:
        yield lambda: max(peak[0], anonymous()) - begin
    finally:
        done.set()
        thread.join()


def convert(source: str, folder: str) -> dict[str, Any]:
    """Seconds and MB of writing tables with normals from tables without."""
    with watched() as peak:
        begin = time.perf_counter()
        mesh = read_npy_tables(Path(source, NODES), Path(source, POLYGONS)).mesh
        write_npy_tables(Path(folder), mesh)
        return {"s": time.perf_counter() - begin, "MB": peak()}


def render(folder: str, rounds: str) -> dict[str, Any]:
    """Seconds of opening tables with the first picture, and of a frame, and MB at the peak of both."""
    # Some modules are imported on the way.
    autocolor.render(autocolor.read_scene(SMALL), (16, 12))
    with watched() as peak:
        begin = time.perf_counter()
        scene = scene_of(read_npy_tables(Path(folder, NODES), Path(folder, POLYGONS)).mesh, view=OVER_HILLS)
        autocolor.render(scene)
        opened, seconds = time.perf_counter() - begin, []
        for _ in range(int(rounds)):
            begin = time.perf_counter()
            autocolor.render(scene)
            seconds.append(time.perf_counter() - begin)
        return {"open s": opened, "frame s": spread(seconds)._asdict(), "MB": peak()}


def text(measured: dict[str, Any]) -> str:
    """One row a mesh: seconds and MB of each step."""
    lines = [
        f"{'quads':>11}{'convert s':>11}{'MB':>6}{'open s':>9}{'frame s':>9}{'MB':>6}"
        f"{'open without normals s':>25}{'MB':>6}"
    ]
    for each in measured["steps"]:
        converted, shown, alone = each["convert"], each["render"], each["without normals"]
        lines.append(
            f"{each['polygons']:11,}{converted['s']:11.1f}{converted['MB']:6.0f}{shown['open s']:9.2f}"
            f"{shown['frame s']['median']:9.3f}{shown['MB']:6.0f}{alone['open s']:25.2f}{alone['MB']:6.0f}"
        )
    return "\n".join(lines)


STEPS = {"convert": convert, "render": render}

if __name__ == "__main__":
    print(json.dumps(STEPS[sys.argv[1]](*sys.argv[2:])))
