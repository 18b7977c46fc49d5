"""How long it takes to start: `python -m benchmarks start`.

Each case is a process of its own, the cases in turns; Python with nothing to do is the floor. The files are
in the system's memory and the modules compiled, as they are from the second start on. The imports of two of
the cases are listed as `-X importtime` has them, which itself takes some of the time.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from benchmarks.cases import Case, spread, timed

ROOT = Path(__file__).parents[1]
COUPE = str(ROOT / "benchmarks" / "coupe")
ROUNDS = 11
FLOOR = "python with nothing to do"
RENDERER = "import autocolor; autocolor.render"
FIRST_PICTURE = f"import autocolor; autocolor.render(autocolor.read_scene({COUPE!r}))"
IMPORTS = {"import autocolor with its renderer": RENDERER, "first picture": FIRST_PICTURE}
LEAST_SHARE = 1 / 20
"""Of the time of all imports: what takes less is not listed."""


class Imported(NamedTuple):
    """A module, the milliseconds of its own and with what it imports, and how deep it stands in the tree."""

    module: str
    own: float
    cumulative: float
    depth: int


def measure(rounds: int = ROUNDS) -> dict[str, Any]:
    """Milliseconds of each start, and of the modules and packages imported on the way."""
    with TemporaryDirectory() as folder:
        cases = [
            Case(name, lambda arguments=arguments: run(*arguments))  # type: ignore[misc]
            for name, arguments in starts(Path(folder)).items()
        ]
        seconds = timed(cases, rounds)
    return {
        "rounds": rounds,
        "starts ms": {name: spread(row).times(1e3)._asdict() for name, row in seconds.items()},
        "imports": {name: imports(code, rounds) for name, code in IMPORTS.items()},
    }


def starts(folder: Path) -> dict[str, tuple[str, ...]]:
    """What Python is started with; pictures go to the folder."""
    return {
        FLOOR: ("-c", "pass"),
        "import numpy": ("-c", "import numpy"),
        "import ramtek_emu": ("-c", "import ramtek_emu"),
        "import autocolor": ("-c", "import autocolor"),
        **{name: ("-c", code) for name, code in IMPORTS.items()},
        "ramtek --help": ("-m", "ramtek_emu", "--help"),
        "autocolor --help": ("-m", "autocolor", "--help"),
        "autocolor --version": ("-m", "autocolor", "--version"),
        "autocolor render benchmarks/coupe": (
            "-m", "autocolor", "render", COUPE, "-o", str(folder / "coupe.png"), "--force", "--smooth", "1",
        ),
    }  # fmt: skip


def run(*arguments: str) -> str:
    """Start Python with the arguments; what it said on stderr."""
    # Compiled modules are kept, whatever this process was told.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    command = [sys.executable, *arguments]
    process = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    return process.stderr


def imports(code: str, rounds: int) -> dict[str, Any]:
    """The modules with the largest shares of what some code imports, as a tree, and the sums by package."""
    trees = [import_tree(run("-X", "importtime", "-c", code)) for _ in range(rounds)]
    medians = [
        Imported(
            row.module,
            statistics.median(tree[number].own for tree in trees),
            statistics.median(tree[number].cumulative for tree in trees),
            row.depth,
        )
        for number, row in enumerate(trees[0])
    ]
    whole = sum(row.own for row in medians)
    packages: dict[str, float] = {}
    for row in medians:
        package = row.module.partition(".")[0]
        package = "the standard library" if package in sys.stdlib_module_names else package
        packages[package] = packages.get(package, 0.0) + row.own
    return {
        "own ms": whole,
        "packages ms": dict(sorted(packages.items(), key=lambda item: -item[1])),
        "modules": [row._asdict() for row in medians if row.cumulative >= LEAST_SHARE * whole],
    }


def import_tree(report: str) -> list[Imported]:
    """The rows of `-X importtime`, each module above what it imports."""
    rows = []
    for line in report.splitlines():
        figures, _, rest = line.removeprefix("import time:").rpartition(" | ")
        own, _, cumulative = figures.partition("|")
        if line.startswith("import time:") and own.strip().isdigit():
            module = rest.lstrip()
            rows.append(
                Imported(module, int(own) / 1e3, int(cumulative) / 1e3, (len(rest) - len(module)) // 2)
            )
    return list(_parents_first(rows))


def _parents_first(rows: Sequence[Imported]) -> list[Imported]:
    """A tree whose children stand above their parents, the other way around but in the same order."""
    waiting: list[list[Imported]] = []
    for row in rows:
        children: list[Imported] = []
        while waiting and waiting[-1][0].depth > row.depth:
            children = waiting.pop() + children
        waiting.append([row, *children])
    return [row for tree in waiting for row in tree]


def text(measured: dict[str, Any]) -> str:
    """The starts over their floor, and the imports that take the most."""
    floor = measured["starts ms"][FLOOR]["median"]
    rows = [f"{'start':40}{'ms':>8}{'quartiles':>16}{'over python':>13}"]
    for name, start in measured["starts ms"].items():
        quartiles = f"{start['low']:.0f}-{start['high']:.0f}"
        rows.append(f"{name:40}{start['median']:8.0f}{quartiles:>16}{start['median'] - floor:13.0f}")
    for name, imported in measured["imports"].items():
        rows += ["", f"{f'{name}: its imports':54}{'own ms':>8}{'with its own':>14}"]
        rows += [
            f"{'  ' * row['depth'] + row['module']:54}{row['own']:8.1f}{row['cumulative']:14.1f}"
            for row in imported["modules"]
        ]
        sums = ", ".join(
            f"{package} {own:.0f}" for package, own in imported["packages ms"].items() if own >= 1
        )
        rows.append(f"own ms by package: {sums}; all {imported['own ms']:.0f}")
    return "\n".join(rows)
