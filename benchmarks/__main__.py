"""All measurements: `python -m benchmarks [ROOM] [--rounds N] [--into FOLDER] [--quick]`.

Without a room every one of them is run. Each prints its table and writes it to the folder, with its numbers
as JSON and, where matplotlib is installed, as a plot. Leaves with 1 when a target is missed.
"""

from __future__ import annotations

import argparse
import inspect
import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

from benchmarks import plots
from benchmarks.machine import heading, machine

RESULTS = Path(__file__).parent / "results"
ROOMS = ("targets", "scaling", "start", "steps")
"""Modules with `measure` and `text`."""
PROGRAMS = {"display": "benchmarks.display", "ports": "benchmarks.host_ports"}
"""Measurements that are programs of their own."""


def main() -> None:
    """Run what is asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("room", nargs="?", choices=[*ROOMS, *PROGRAMS], help="one of them (all)")
    parser.add_argument("--rounds", type=positive, help="how often each case is taken (each room's own)")
    parser.add_argument("--into", type=Path, default=RESULTS, help="the folder of the results")
    parser.add_argument("--quick", action="store_true", help="leave out what takes long")
    options = parser.parse_args()
    options.into.mkdir(parents=True, exist_ok=True)
    missed = False
    for room in [options.room] if options.room else [*ROOMS, *PROGRAMS]:
        if room in PROGRAMS:
            missed |= run_program(room, options)
        else:
            missed |= run_room(room, options)
    sys.exit(1 if missed else 0)


def positive(text: str) -> int:
    """A whole number of at least 1."""
    number = int(text) if text.isdecimal() else 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"it must be a whole number of at least 1, not {text!r}")
    return number


def run_room(room: str, options: argparse.Namespace) -> bool:
    """Measure, print and write; whether a target was missed."""
    module = import_module(f"benchmarks.{room}")
    chosen: dict[str, Any] = {} if options.rounds is None else {"rounds": options.rounds}
    if "quick" in inspect.signature(module.measure).parameters:
        chosen["quick"] = options.quick
    measured = module.measure(**chosen)
    table = module.text(measured)
    write(room, table, options)
    content = json.dumps({"machine": machine(), **measured}, indent=2)
    (options.into / f"{room}.json").write_text(content + "\n", encoding="utf-8")
    draw = getattr(plots, room, None)
    if draw is not None and not draw(measured, options.into / f"{room}.png"):
        print(f"{room}.png: skipped: matplotlib is not installed; pip install '.[peers]'\n")
    return any(row["verdict"] == "MISSED" for row in measured.get("targets", ()))


def run_program(room: str, options: argparse.Namespace) -> bool:
    """Run a program that prints a table of its own; whether it left with an error."""
    rounds = [] if options.rounds is None else ["--rounds", str(options.rounds)]
    ended = subprocess.run(
        [sys.executable, "-m", PROGRAMS[room], *rounds], stdout=subprocess.PIPE, text=True, check=False
    )
    write(room, ended.stdout.rstrip(), options)
    return bool(ended.returncode)


def write(room: str, table: str, options: argparse.Namespace) -> None:
    """Print a table under the machine's name, and write it."""
    whole = f"{room}: {heading()}\n\n{table}\n"
    print(whole)
    (options.into / f"{room}.txt").write_text(whole, encoding="utf-8")


if __name__ == "__main__":
    main()
