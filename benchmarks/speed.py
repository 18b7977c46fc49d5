"""How long each edit takes, as ratios in one run: `python -m benchmarks.speed [--json FILE] [--rounds N]`.

The cases are taken in turns, with the caches emptied before each; a figure is the median of its rounds and
stands beside its ratio to a copy of one field (640 x 480 x 4 bytes) and to a whole frame. Only ratios of one
run are worth anything.
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
import time
from collections.abc import Iterator
from itertools import count, cycle
from pathlib import Path
from typing import Any

import numpy as np

import autocolor
from autocolor.projection import projection
from autocolor.scene import scene_of
from autocolor.studio import Studio
from benchmarks.cases import Case, timed
from ramtek_emu import Ramtek9300, instructions

COUPE = Path(__file__).parents[1] / "scenes" / "coupe"
ROUNDS = 25


def cases() -> Iterator[Case]:
    """The cases on the coupe."""
    scene = autocolor.read_scene(COUPE)
    display = Ramtek9300()
    studio = Studio(scene, display)
    field, copy = np.zeros((480, 640), np.uint32), np.zeros((480, 640), np.uint32)
    colors = cycle(["#b01020", "#1f3f8f"])
    curves = cycle(["gamma", "linear"])
    # Never the same value twice, for an edit that changes nothing costs nothing.
    steps = count(1e-3, 1e-3)
    eye = scene.view.eye
    lamp = scene.lights[0]

    def scan_out() -> None:
        display.scan_out.scan_out_into(field)

    def recolor() -> None:
        studio.recolor("body", object_color=next(colors))
        scan_out()

    def entries() -> None:
        display.send(instructions.load_entries(1, studio.entries[1:168]))

    def one_light() -> None:
        studio.light(lamp.name, position=(lamp.position[0] + next(steps), *lamp.position[1:]))

    def all_lights() -> None:
        step = next(steps)
        lights = [
            light.replace(position=(light.position[0] + step, *light.position[1:]))
            for light in studio.scene.lights
        ]
        studio.edit(studio.scene.replace(lights=tuple(lights)))

    def intensity() -> None:
        studio.light(lamp.name, intensity=1 + next(steps))

    def mapping() -> None:
        studio.edit(studio.scene.replace(mapping=next(curves)))

    def frame() -> None:
        studio.view(eye=(eye[0] + next(steps), eye[1], eye[2]))

    yield Case("copy of one field", lambda: np.copyto(copy, field))
    # What a scan-out owes to words that were written before it is not its own.
    yield Case("scan-out", scan_out, ("copy of one field", 1.5), scan_out)
    yield Case("recolor, entries alone", entries)
    yield Case("recolor and scan-out", recolor, ("copy of one field", 2.5), scan_out)
    yield Case(
        "a whole picture through the stream", lambda: display.send(instructions.write_image(studio.words))
    )
    yield Case("mapping curve", mapping)
    yield Case("a light's intensity", intensity)
    yield Case("one light of four moved", one_light, ("whole frame", 1 / 8))
    yield Case("four lights moved", all_lights, ("whole frame", 0.36))
    yield Case("projection", lambda: projection(scene.mesh, scene.view, 480, 640))
    yield Case("whole frame", frame)


def hills(side: int) -> autocolor.Mesh:
    """A square of side x side quads, waved so that all of it is seen."""
    across, along = np.meshgrid(np.linspace(-1, 1, side + 1), np.linspace(-1, 1, side + 1))
    height = 0.1 * np.sin(7 * across) * np.cos(5 * along)
    row = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    quads = np.stack([row[:-1, :-1], row[:-1, 1:], row[1:, 1:], row[1:, :-1]], axis=-1).reshape(-1, 4)
    places = np.stack([across, along, height], axis=-1).reshape(-1, 3)
    return autocolor.Mesh(places, quads, np.zeros(len(quads), np.intp), ("hills",))


def large_mesh(rounds: int) -> list[tuple[str, float]]:
    """The time of a frame of a million quads, as a ratio to one of 8,136 of the same hills."""
    studios = [Studio(scene_of(hills(side)), Ramtek9300()) for side in (90, 1000)]
    seconds: list[list[float]] = [[], []]
    for number in range(rounds):
        for row, studio in enumerate(studios):
            begin = time.perf_counter()
            studio.view(angle=0.05 * (number + 1))
            seconds[row].append(time.perf_counter() - begin)
    medians = [statistics.median(row) for row in seconds]
    return [("8,100 quads", medians[0]), ("1,000,000 quads", medians[1])]


def main() -> None:
    """Time everything, print the table, and write it as JSON where that is asked."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=ROUNDS)
    options.add_argument("--json", type=Path)
    options.add_argument("--large", action="store_true", help="a million quads as well")
    chosen = options.parse_args()
    every = list(cases())
    seconds = timed(every, chosen.rounds)
    medians = {name: statistics.median(row) for name, row in seconds.items()}
    rows: list[dict[str, Any]] = []
    for case in every:
        median = medians[case.name]
        spread = statistics.quantiles(seconds[case.name], n=4)
        rows.append(
            {
                "case": case.name,
                "milliseconds": median * 1e3,
                "quartiles": [spread[0] * 1e3, spread[2] * 1e3],
                "to a copy": median / medians["copy of one field"],
                "to a frame": median / medians["whole frame"],
                "target": None if case.most is None else f"{case.most[1]:.3g} x {case.most[0]}",
                "met": None if case.most is None else median <= case.most[1] * medians[case.most[0]],
            }
        )
    print(f"{'case':38} {'ms':>8} {'quartiles':>15} {'/ copy':>8} {'/ frame':>8}  target")
    for row in rows:
        low, high = row["quartiles"]
        target = "" if row["target"] is None else f"{row['target']}: {'met' if row['met'] else 'MISSED'}"
        print(
            f"{row['case']:38} {row['milliseconds']:8.3f} {low:7.3f}-{high:7.3f}"
            f" {row['to a copy']:8.2f} {row['to a frame']:8.3f}  {target}"
        )
    if chosen.large:
        (few, short), (many, long) = large_mesh(7)
        frame = medians["whole frame"]
        verdict = "met" if long <= 7 * frame else "MISSED"
        print(
            f"{many}: {long * 1e3:.1f} ms, {long / frame:.1f} frames of the coupe (target 7: {verdict}),"
            f" {long / short:.1f} of {few} of the same hills"
        )
        rows.append({"case": many, "milliseconds": long * 1e3, "to a frame": long / frame})
    print(f"most memory used: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")
    if chosen.json is not None:
        chosen.json.write_text(json.dumps(rows, indent=2), encoding="utf-8")


if __name__ == "__main__":
    main()
