"""All measurements: `python -m benchmarks [PART] [--rounds N] [--into FOLDER] [--quick]`.

Without a part every one of them is run. Each prints its table and writes it to the folder, with its numbers
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

from benchmarks import plots
from benchmarks.machine import heading, machine

RESULTS = Path(__file__).parent / "results"
PARTS = (
    "targets", "scaling", "start", "steps", "scalars", "movement", "events", "reading", "mapped_tables",
    "form", "normals", "batches", "page", "inspection",
)  # fmt: skip
"""Modules with `measure` and `text`."""
PROGRAMS = {"display": "benchmarks.display", "ports": "benchmarks.host_ports"}
"""Measurements that are programs of their own."""


def main() -> None:
    """Run what is asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("part", nargs="?", choices=[*PARTS, *PROGRAMS], help="one of them (all)")
    parser.add_argument("--rounds", type=positive, help="how often each case is taken (each part's own)")
    parser.add_argument("--into", type=Path, default=RESULTS, help="the folder of the results")
    parser.add_argument("--quick", action="store_true", help="leave out what takes long")
    options = parser.parse_args()
    options.into.mkdir(parents=True, exist_ok=True)
    missed = False
    for part in [options.part] if options.part else [*PARTS, *PROGRAMS]:
        if part in PROGRAMS:
            missed |= run_program(part, options)
        else:
            missed |= run_part(part, options)
    sys.exit(1 if missed else 0)


def positive(text: str) -> int:
    """A whole number of at least 1."""
    number = int(text) if text.isdecimal() else 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"it must be a whole number of at least 1, not {text!r}")
    return number


def run_part(part: str, options: argparse.Namespace) -> bool:
    """Measure, print and write; whether a target was missed."""
    module = import_module(f"benchmarks.{part}")
    accepted = inspect.signature(module.measure).parameters
    given = {"rounds": options.rounds, "quick": options.quick}
    chosen = {name: value for name, value in given.items() if name in accepted and value is not None}
    measured = module.measure(**chosen)
    table = module.text(measured)
    write(part, table, options)
    content = json.dumps({"machine": machine(), **measured}, indent=2)
    (options.into / f"{part}.json").write_text(content + "\n", encoding="utf-8")
    draw = getattr(plots, part, None)
    if draw is not None and not draw(measured, options.into / f"{part}.png"):
        print(f"{part}.png: skipped: matplotlib is not installed; pip install '.[peers]'\n")
    return any(row["verdict"] == "MISSED" for row in measured.get("targets", ()))


def run_program(part: str, options: argparse.Namespace) -> bool:
    """Run a program that prints a table of its own; whether it left with an error."""
    rounds = [] if options.rounds is None else ["--rounds", str(options.rounds)]
    ended = subprocess.run(
        [sys.executable, "-m", PROGRAMS[part], *rounds], stdout=subprocess.PIPE, text=True, check=False
    )
    write(part, ended.stdout.rstrip(), options)
    return bool(ended.returncode)


def write(part: str, table: str, options: argparse.Namespace) -> None:
    """Print a table under the machine's name, and write it."""
    whole = f"{part}: {heading()}\n\n{table}\n"
    print(whole)
    (options.into / f"{part}.txt").write_text(whole, encoding="utf-8")


if __name__ == "__main__":
    main()
