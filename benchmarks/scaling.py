"""How time and memory grow with the polygons, the lights and the picture: `python -m benchmarks scaling`.

The points of a quantity are timed in turns in this process. How long it takes to open a scene and how much
memory it needs is measured once, in a process of its own: `python -m benchmarks.scaling polygons 1000`.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import autocolor
from benchmarks.cases import spread, timed
from benchmarks.memory import forget_peak, peak
from benchmarks.points import EDITS, QUANTITIES, Quantity, Session, session

ROOT = Path(__file__).parents[1]
SMALL = ROOT / "scenes" / "pyramid"
ROUNDS = 9


def measure(rounds: int = ROUNDS, quick: bool = False) -> dict[str, Any]:
    """Milliseconds of each edit and MiB of each point; with `quick` of a few of the smaller points."""
    return {
        "rounds": rounds,
        "points": [
            point for quantity in QUANTITIES.values() for point in measured_points(quantity, rounds, quick)
        ],
    }


def measured_points(quantity: Quantity, rounds: int, quick: bool) -> list[dict[str, Any]]:
    """The points of one quantity, in turns."""
    sizes = quantity.chosen(quick)
    alone = {size: measured_alone(quantity, size) for size in sizes}
    sessions = {size: session(quantity, size) for size in sizes}
    seconds = timed(
        [case for size, each in sessions.items() for case in each.cases(f"{size}: ")],
        rounds,
    )
    return [
        {
            "quantity": quantity.name,
            "size": size,
            "label": quantity.label(size),
            **facts(each),
            "edits ms": {edit: spread(seconds[f"{size}: {edit}"]).times(1e3)._asdict() for edit in EDITS},
            **alone[size],
        }
        for size, each in sessions.items()
    ]


def facts(each: Session) -> dict[str, int]:
    """What a point is, as numbers."""
    scene, picture = each.studio.scene, each.studio.picture
    return {
        "polygons": len(scene.mesh.node_numbers),
        "lights": len(scene.lights),
        "pixels": picture.lines * picture.elements,
        "pixels seen": len(picture.pixels),
    }


def measured_alone(quantity: Quantity, size: int) -> dict[str, float]:
    """What `alone` measures, in a fresh process."""
    command = [sys.executable, "-m", "benchmarks.scaling", quantity.name, str(size)]
    process = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True)
    measured: dict[str, float] = json.loads(process.stdout)
    return measured


def alone(quantity: Quantity, size: int) -> dict[str, float]:
    """Milliseconds to open a point up to its words, and MiB over what the imports hold.

    "open MiB" is the peak until the first picture is shown, "edit MiB" the peak of the edits after it.
    """
    # Open a small scene first, for some modules are imported on the way.
    Session(autocolor.read_scene(SMALL), 12)
    forget_peak()
    imported, begin = peak(), time.perf_counter()
    each = session(quantity, size)
    opened, milliseconds = peak() - imported, (time.perf_counter() - begin) * 1e3
    forget_peak()
    for case in (*each.cases(), *each.cases()):
        case.run()
    return {
        "open ms": milliseconds,
        "open MiB": opened,
        "edit MiB": peak() - imported,
    }


def text(measured: dict[str, Any]) -> str:
    """One table a quantity: medians in milliseconds with their quartiles, and MiB."""
    tables = []
    for quantity in QUANTITIES.values():
        heading = "".join(f"{f'{edit}, ms':>22}" for edit in EDITS)
        rows = [f"{quantity.name:12}{heading}{'open ms':>10}{'MiB':>7}{'edit MiB':>10}"]
        for point in measured["points"]:
            if point["quantity"] == quantity.name:
                edits = "".join(_cell(point["edits ms"][edit]) for edit in EDITS)
                rows.append(
                    f"{point['label']:12}{edits}{point['open ms']:10.0f}"
                    f"{point['open MiB']:7.0f}{point['edit MiB']:10.0f}"
                )
        tables.append("\n".join(rows))
    return "\n\n".join(tables)


def _cell(edit: dict[str, Any]) -> str:
    quartiles = f"{edit['low']:.2f}-{edit['high']:.2f}"
    return f"{edit['median']:9.2f} {quartiles:>12}"


if __name__ == "__main__":
    print(json.dumps(alone(QUANTITIES[sys.argv[1]], int(sys.argv[2]))))
