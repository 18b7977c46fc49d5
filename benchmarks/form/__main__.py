"""Whether bare meshes show their form: `python -m benchmarks.form [PATH ...] [--sheet PNG] [--lines N]`.

Our own shapes, and the mesh files that are given alone or in folders (`car.obj:y` for one whose up axis is
y), are seen from three sides under the lights that are created for each. `--sheet` writes their
pictures beside those of PyVista. `--check` leaves with 1 if a bound is broken.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from benchmarks import form
from benchmarks.form.sheet import write_sheet


def main() -> None:
    """Measure and print, and draw what is asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.form", description=__doc__)
    parser.add_argument("paths", nargs="*", type=Path, metavar="PATH", help="more meshes: files or folders")
    parser.add_argument("--sheet", type=Path, metavar="PNG", help="write a sheet of pictures")
    parser.add_argument("--lines", type=int, default=480, help="the lines of the measured pictures (480)")
    parser.add_argument("--views", action="store_true", help="a row for every view, not the worst alone")
    parser.add_argument("--check", action="store_true", help="leave with 1 if a bound is broken")
    options = parser.parse_args()
    measured = form.measure(paths=options.paths, lines=options.lines)
    print(form.text(measured, every_view=options.views))
    if options.sheet is not None:
        note = write_sheet(options.sheet, options.paths)
        print(f"\n{options.sheet}: written{note}")
    broken = sum(bool(row["broken"]) for row in measured["rows"] if row["view"] == form.WORST)
    if broken:
        print(f"\n{broken} meshes break a bound")
    sys.exit(1 if broken and options.check else 0)


if __name__ == "__main__":
    main()
