"""What is not timed in turns: the first picture, memory, a million polygons, and the two algorithms compared.

Memory is measured in a process of its own: `python -m benchmarks.once coupe`.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import autocolor
from autocolor.rendering import rendering
from autocolor.scene.creation import scene_of
from benchmarks.cases import Case, Spread, ratios, spread, timed
from benchmarks.hills import hills, side_of
from benchmarks.memory import forget_peak, peak
from benchmarks.points import COUPE, LINES, Session
from benchmarks.start import FIRST_PICTURE, run

ROOT = Path(__file__).parents[1]
SMALL = ROOT / "scenes" / "pyramid"
FEW, MANY = 8_136, 1_000_000
"""Polygons: those of the paper's car, and many."""

OVER_HILLS = autocolor.View(eye=(1.2, -2.6, 2.4), target=(0, 0, 0), field_of_view=27.0)
"""A view in which the hills cover three fifths of the picture."""

MEGABYTE = 1e6
STARTS = 9
SCENES: dict[str, Callable[[], autocolor.Scene]] = {
    "coupe": lambda: autocolor.read_scene(COUPE),
    "hills": lambda: covered_hills(MANY),
}


def covered_hills(polygons: int) -> autocolor.Scene:
    """So many polygons of hills over as much of the picture as the car, so that only their number differs."""
    return scene_of(hills(side_of(polygons)), view=OVER_HILLS)


def first_picture() -> Spread:
    """Seconds of a process that imports the renderer, reads the coupe and renders it."""
    seconds = []
    for _ in range(STARTS):
        begin = time.perf_counter()
        run("-c", FIRST_PICTURE)
        seconds.append(time.perf_counter() - begin)
    return spread(seconds)


def memory(scene: str) -> Spread:
    """MB at the peak of making and rendering a scene in a fresh process, over that of its imports.

    Measured once: it is the same within a hundredth.
    """
    command = [sys.executable, "-m", "benchmarks.once", scene]
    told = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout
    return spread([float(told)])


def memory_of(scene: Callable[[], autocolor.Scene]) -> float:
    """MB at the peak of making and rendering a scene here, its mesh included, over what was held before."""
    # Some modules are imported on the way.
    autocolor.render(autocolor.read_scene(SMALL), (16, 12))
    forget_peak()
    imported = peak()
    autocolor.render(scene())
    return (peak() - imported) * (1 << 20) / MEGABYTE


def many_polygons(rounds: int) -> Spread:
    """The frame of a million polygons of hills, in frames of as many as the paper's car has."""
    sessions = [Session(covered_hills(polygons), LINES) for polygons in (FEW, MANY)]
    seconds = timed([Case(str(number), each.frame) for number, each in enumerate(sessions)], rounds)
    return ratios(seconds["1"], seconds["0"])


def differing_pixels() -> int:
    """How many pixels of the coupe there are at which the two algorithms see different polygons."""
    scene = autocolor.read_scene(COUPE)
    rasters = []
    for algorithm in ("batch", "watkins"):
        points = rendering(scene, algorithm=algorithm).points
        raster = np.full(points.lines * points.elements, -1)
        raster[points.pixels] = points.polygon_numbers
        rasters.append(raster)
    return int((rasters[0] != rasters[1]).sum())


if __name__ == "__main__":
    print(memory_of(SCENES[sys.argv[1]]))
