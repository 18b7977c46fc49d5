"""Small changes of the program that tests must notice.

    python -m tests.mutants autocolor/lighting ramtek_emu/memory --count 10 --seed 7

cosmic-ray makes the changes (`<` to `<=`, `+` to `-`, a number by 1, `not`, a loop that is left out), in a
copy of the tree. In each folder of the program, lines are drawn, and a change of each. Then the tests of the
folder run, without those of folders in it, and the doctests of its modules, until one fails. The changes that
no test noticed are printed. Those that no test can notice are in equivalent_mutants.toml with their reasons.
The exit code is 1 if another change was not noticed.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import resource
import shlex
import shutil
import sys
import tempfile
import time
import tomllib
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

ROOT: Final = Path(__file__).parents[1]
EQUIVALENT: Final = Path(__file__).with_name("equivalent_mutants.toml")
LEFT_OUT: Final = (".*", "__pycache__", "build", "*.egg-info")
MOST_MEMORY: Final = 8 << 30
"""Bytes of address space of the tests. A mutant may ask for all memory there is."""
OPPOSITE: Final = (
    *("Add_Sub", "Sub_Add", "Mul_Div", "Div_Mul", "FloorDiv_Mul", "Mod_Mul", "Pow_Mul"),
    *("BitAnd_BitOr", "BitOr_BitAnd", "LShift_RShift", "RShift_LShift"),
)
"""The changes of arithmetic. Others, such as `+` to `>>`, fail at once."""
OF_INSTRUCTIONS: Final = tuple(
    f"ramtek_emu/{wing}" for wing in ("instruction_set", "memory", "drawing", "processor")
)
"""Folders that the conformance suite tests, beside the tests of the folder."""
SUITE: Final = ("tests/ramtek_emu/test_conformance.py", "tests/ramtek_emu/test_twin.py")
SAYS_NOTHING: Final = re.compile(r"^(raise|assert|@|if TYPE_CHECKING|LOG\.|logger\.)|strict=True")
"""Lines whose changes say nothing: messages, logs, and checks that hold in correct code."""
TYPE: Final = re.compile(r"\| None|None \||(->|: |\[)[\w.\[\]]+ \|")
"""Lines with a type that is one or another."""


class Mutant(NamedTuple):
    """A change of a line by an operator of cosmic-ray, at one of the places where it can work."""

    file: str
    number: int
    line: str
    operator: str
    place: int

    def source(self, source: str) -> str:
        """The changed file."""
        from cosmic_ray.mutating import mutate_code
        from cosmic_ray.plugins import get_operator

        return str(mutate_code(source, get_operator(self.operator)(), self.place))


def mutants_of(file: str) -> Iterator[Mutant]:
    """All mutants of a file of the program."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.plugins import get_operator, operator_names

    source = (ROOT / file).read_text()
    lines = source.splitlines()
    nodes = list(ast_nodes(get_ast(source)))
    for name in operator_names():
        operator = get_operator(name)
        _, _, pair = name.partition("ReplaceBinaryOperator_")
        if operator.arguments() or (pair and pair not in OPPOSITE):
            continue
        places = [start for node in nodes for start, _ in operator().mutation_positions(node)]
        for place, (number, _) in enumerate(places):
            line = lines[number - 1].strip()
            if not SAYS_NOTHING.search(line) and not (pair == "BitOr_BitAnd" and TYPE.search(line)):
                yield Mutant(file, number, line, name, place)


def chosen(folder: str, count: int, seed: int) -> list[Mutant]:
    """Mutants of so many lines. Each kind of change of a line is as likely as the others."""
    kinds: defaultdict[tuple[str, int], defaultdict[str, list[Mutant]]] = defaultdict(
        lambda: defaultdict(list)
    )
    for path in sorted((ROOT / folder).glob("*.py")):
        for mutant in mutants_of(path.relative_to(ROOT).as_posix()):
            kinds[mutant.file, mutant.number][mutant.operator.partition("_")[0]].append(mutant)
    chance = random.Random(f"{seed} {folder}")
    lines = chance.sample(list(kinds.values()), min(count, len(kinds)))
    return [chance.choice(chance.choice(list(line.values()))) for line in lines]


def is_killed(tests: list[str], options: str, seconds: float) -> bool:
    """Whether a test in the current folder fails, or does not end in time."""
    from cosmic_ray.testing import TestOutcome, run_tests

    command = [sys.executable, *f"-m pytest -xq --tb=no -p no:cacheprovider {options}".split(), *tests]
    return run_tests(shlex.join(command), seconds)[0] is not TestOutcome.SURVIVED


def survivors(folder: str, mutants: list[Mutant], copy: Path) -> Iterator[tuple[Mutant, str]]:
    """The mutants that no test of the folder kills, each with its changed line."""
    suite = SUITE if folder in OF_INSTRUCTIONS else ()
    tests = [*suite, *map(str, (Path("tests") / folder).glob("test_*.py")), folder]
    options = f"--basetemp={copy}-tmp --ignore-glob={folder}/*/*"
    start = time.monotonic()
    if is_killed(tests, options, 3600):
        raise SystemExit(f"the tests of {folder} must pass before the program is changed")
    seconds = 5 * (time.monotonic() - start) + 10
    for mutant in mutants:
        path = copy / mutant.file
        source = path.read_text()
        changed = mutant.source(source)
        path.write_text(changed)
        if not is_killed(tests, options, seconds):
            yield mutant, changed.splitlines()[mutant.number - 1].strip()
        path.write_text(source)


def main() -> int:
    """Run what the command line asks for; returns its exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--count", type=int, default=10, help="changed lines of each folder")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rows = tomllib.loads(EQUIVALENT.read_text())["mutant"]
    reasons = {(row["file"], row["line"], row["change"]): row["reason"] for row in rows}
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    alive = 0
    with tempfile.TemporaryDirectory(prefix="mutants-") as name:
        copy = Path(name) / "copy"
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(*LEFT_OUT))
        os.chdir(copy)
        os.environ |= {"PYTHONPATH": str(copy), "HYPOTHESIS_PROFILE": "mutants", "HOME": name}
        for folder in options.folders:
            mutants = chosen(folder, options.count, options.seed)
            counts = {"alive": 0, "equivalent": 0}
            for mutant, change in survivors(folder, mutants, copy):
                keys = ((mutant.file, mutant.line, each) for each in (change, "any"))
                reason = next((reasons[key] for key in keys if key in reasons), "")
                counts["equivalent" if reason else "alive"] += 1
                print(f"{mutant.file}:{mutant.number}: {mutant.line}\n    {change}", reason, flush=True)
            alive += counts["alive"]
            killed = len(mutants) - sum(counts.values())
            print(
                f"{folder}: {killed} of {len(mutants)} killed, {counts['equivalent']} equivalent", flush=True
            )
    return alive > 0


if __name__ == "__main__":
    sys.exit(main())
