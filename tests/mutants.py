"""Mutation testing: `python -m tests.mutants --count 100 --seed 1` breaks the program; the tests should fail.

A mutant is a copy of the program with one simple change: `<` to `<=`, `+` to `-`, a constant by 1,
`return None`, a statement deleted. It is killed when a test fails, does not end, or cannot be collected. The
tests of the mutant's subject run first: the mirrored test file and the doctests of the module. Then those of
its wing run, and with `--whole` all others.

Results go to LOG/seed-SEED.jsonl; the same command continues an interrupted run. `--again LOG` runs the
mutants anew that were alive. Mutants that no test can kill are in equivalent_mutants.toml with their reasons;
they are counted, not run. Mutants are made in copies of the tree in a temporary folder, so you may edit
meanwhile.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import json
import os
import random
import re
import resource
import shutil
import signal
import sys
import tempfile
import time
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parents[1]
PACKAGES: Final = ("autocolor", "ramtek_emu")
EQUIVALENT: Final = Path(__file__).with_name("equivalent_mutants.toml")
COPIED: Final = (*PACKAGES, "tests", "scenes", "benchmarks", "docs")
OPERATORS: Final[dict[type[ast.AST], type[ast.AST]]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd, ast.LShift: ast.RShift,
    ast.RShift: ast.LShift, ast.And: ast.Or, ast.Or: ast.And,
}  # fmt: skip
# References in docs are made from the wings, and compared with them.
REFERENCES: Final = {
    "autocolor/scene": "tests/test_column_reference.py",
    "autocolor/commands": "tests/test_command_reference.py",
    "ramtek_emu/commands": "tests/test_command_reference.py",
    "autocolor/files": "tests/test_store_reference.py",
}
LOGS: Final = ("logger.", "LOG.")
EXTREMES: Final = {"min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum"}
# Keys of tables are mutated sparingly: most are checked by whatever reads the table.
KEY_SHARE: Final = 0.2
# A mutant may ask for all memory there is.
MOST_MEMORY: Final = 8 << 30


@dataclass(frozen=True)
class Mutant:
    """One change: the bytes from start to end of a file are replaced."""

    file: str
    number: int
    line: str
    change: str
    start: int
    end: int
    replacement: str

    @property
    def key(self) -> tuple[str, str, str]:
        """What identifies the mutant while other lines of the file change."""
        return self.file, self.line, self.change

    def source(self, data: bytes) -> bytes:
        """The mutated file."""
        return data[: self.start] + self.replacement.encode() + data[self.end :]


@dataclass(frozen=True)
class Result:
    """Whether the tests of an extent killed a mutant; `by` is the failing test."""

    mutant: Mutant
    extent: str
    killed: bool
    by: str
    seconds: float


class _Mutations(ast.NodeVisitor):
    """Collects the mutants of a file.

    Left out: annotations except the columns in them, decorators, docstrings and formatted text, messages of
    exceptions, logs, `__repr__`, and checks that hold in correct code such as `zip(strict=True)`.
    """

    def __init__(self, file: str, data: bytes) -> None:
        self.file = file
        self.data = data
        self.lines = data.splitlines(keepends=True)
        self.starts = [0]
        for line in self.lines:
            self.starts.append(self.starts[-1] + len(line))
        self.mutants: list[Mutant] = []

    def _add(self, node: ast.expr | ast.stmt, replacement: str, change: str = "") -> None:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        start = self.starts[node.lineno - 1] + node.col_offset
        end = self.starts[node.end_lineno - 1] + node.end_col_offset
        before = " ".join(self.data[start:end].decode().split())
        self.mutants.append(
            Mutant(
                self.file,
                node.lineno,
                self.lines[node.lineno - 1].decode().strip(),
                change or f"{before} -> {replacement}",
                start,
                end,
                replacement,
            )
        )

    def _mutate(self, node: ast.expr | ast.stmt, **fields: object) -> None:
        """Add the node with some fields replaced."""
        values = {name: getattr(node, name) for name in node._fields}
        text = ast.unparse(ast.fix_missing_locations(type(node)(**{**values, **fields})))
        self._add(node, text if isinstance(node, ast.stmt) else f"({text})")

    def visit_Compare(self, node: ast.Compare) -> None:
        for number, operator in enumerate(node.ops):
            operators = list(node.ops)
            operators[number] = OPERATORS[type(operator)]()  # type: ignore[call-overload]
            self._mutate(node, ops=operators)
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        sides = (node.left, node.right)
        if type(node.op) in OPERATORS and not any(_is_text(side) or _is_none(side) for side in sides):
            self._mutate(node, op=OPERATORS[type(node.op)]())
        self.generic_visit(node)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        if type(node.op) in OPERATORS and not _is_text(node.value):
            self._mutate(node, op=OPERATORS[type(node.op)]())
        self._delete_assignment(node, [node.target])
        self.visit(node.value)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        self._mutate(node, op=OPERATORS[type(node.op)]())
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.Not):
            self._add(node, f"({ast.unparse(node.operand)})")
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        if isinstance(node.value, bool):
            self._add(node, str(not node.value))
        elif isinstance(node.value, int | float):
            self._add(node, f"({node.value + 1!r})")
            self._add(node, f"({node.value - 1!r})")

    def visit_Return(self, node: ast.Return) -> None:
        if node.value is not None and not _is_none(node.value):
            self._add(node, "return None")
            self.visit(node.value)

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call) and not ast.unparse(node.value.func).startswith(LOGS):
            self._add(node, "pass", f"{ast.unparse(node)} deleted")
            self.visit(node.value)
        elif not isinstance(node.value, ast.Constant | ast.Call):
            self.visit(node.value)

    def visit_Assign(self, node: ast.Assign) -> None:
        self._delete_assignment(node, node.targets)
        self.generic_visit(node)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        self._visit_columns(node.annotation)
        if node.value is not None:
            self.visit(node.value)

    def visit_arg(self, node: ast.arg) -> None:
        if node.annotation is not None:
            self._visit_columns(node.annotation)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        if node.name != "__repr__":
            self.visit(node.args)
            for statement in node.body:
                self.visit(statement)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        for statement in node.body:
            self.visit(statement)

    def visit_If(self, node: ast.If) -> None:
        if ast.unparse(node.test) == "TYPE_CHECKING":
            return
        self._add_condition(node.test)
        self.generic_visit(node)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self._add_condition(node.test)
        self.generic_visit(node)

    def visit_Slice(self, node: ast.Slice) -> None:
        for bound in (node.lower, node.upper):
            if bound is not None and not isinstance(bound, ast.Constant):
                self._add(bound, f"({ast.unparse(bound)} + 1)")
        self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> None:
        if isinstance(node.ctx, ast.Load) and node.id in EXTREMES:
            self._add(node, EXTREMES[node.id])

    def visit_Attribute(self, node: ast.Attribute) -> None:
        if isinstance(node.ctx, ast.Load) and node.attr in EXTREMES:
            self._add(node, f"({ast.unparse(node.value)}).{EXTREMES[node.attr]}")
        self.generic_visit(node)

    def visit_Dict(self, node: ast.Dict) -> None:
        for key in node.keys:
            if isinstance(key, ast.Constant) and isinstance(key.value, str):
                self._add(key, repr(key.value + "_"))
        self.generic_visit(node)

    def visit_keyword(self, node: ast.keyword) -> None:
        if node.arg not in ("strict", "stacklevel"):
            self.generic_visit(node)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        """Leave text alone; Python 3.11 gives no places in it."""

    def visit_Raise(self, node: ast.Raise) -> None:
        """Leave messages alone; whether something is refused is the `if` above."""

    def visit_Assert(self, node: ast.Assert) -> None:
        """Leave assertions alone; they tell types to mypy."""

    def _add_condition(self, test: ast.expr) -> None:
        text = " ".join(ast.unparse(test).split())
        self._add(test, "True", f"if {text} always")
        self._add(test, "False", f"if {text} never")

    def _delete_assignment(self, node: ast.stmt, targets: list[ast.expr]) -> None:
        if all(isinstance(target, ast.Attribute | ast.Subscript) for target in targets):
            self._add(node, "pass", f"{ast.unparse(node)} deleted")

    def _visit_columns(self, annotation: ast.expr) -> None:
        for node in ast.walk(annotation):
            if isinstance(node, ast.Call):
                self.visit(node)


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def mutants_of(path: Path) -> list[Mutant]:
    """All mutants of a file of the program."""
    data = path.read_bytes()
    visitor = _Mutations(path.relative_to(ROOT).as_posix(), data)
    visitor.visit(ast.parse(data))
    return visitor.mutants


def chosen_mutants(count: int, seed: int, only: Iterable[str], pattern: str = "") -> list[Mutant]:
    """As many mutants of different lines, the same for the same seed and program.

    They are of files that begin as `only` says, if it says anything, and of lines that the pattern matches.
    """
    generator = random.Random(seed)
    by_line: defaultdict[tuple[str, int], list[Mutant]] = defaultdict(list)
    paths = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
    for path in paths:
        if only and not path.relative_to(ROOT).as_posix().startswith(tuple(only)):
            continue
        for mutant in mutants_of(path):
            is_key = mutant.replacement.endswith("_'")
            if re.search(pattern, mutant.line) and (not is_key or generator.random() < KEY_SHARE):
                by_line[mutant.file, mutant.number].append(mutant)
    lines = list(by_line)
    return [generator.choice(by_line[line]) for line in generator.sample(lines, min(count, len(lines)))]


def suite_of(file: str, extent: str, root: Path) -> tuple[str, ...]:
    """The tests of a file's subject, of its wing, or the whole suite, as pytest takes them.

    The tests of a wing that name the file's module come first: they are the likeliest to fail.
    """
    path = Path(file)
    package, *rooms = path.parts
    folder = root / "tests" / path.parent
    if extent == "subject":
        stem = "package" if path.stem == "__init__" else path.stem.strip("_")
        files = [folder / f"test_{stem}.py", *sorted(folder.glob(f"test_{stem}_*.py"))]
        return (*(each.relative_to(root).as_posix() for each in files if each.exists()), file)
    if extent == "whole":
        return ("tests", *PACKAGES)
    if len(rooms) > 1:
        files = sorted((root / "tests" / package / rooms[0]).rglob("test_*.py"))
        wing = f"{package}/{rooms[0]}"
        others = [wing, *([REFERENCES[wing]] if wing in REFERENCES else [])]
    else:
        files = sorted((root / "tests" / package).glob("test_*.py"))
        others = []
    module = ".".join(path.with_suffix("").parts)
    files.sort(key=lambda each: (each.parent != folder, module not in each.read_text()))
    return (*(each.relative_to(root).as_posix() for each in files), *others)


def failed_tests(
    copy: Path, tests: tuple[str, ...], most_seconds: float, left_out: Sequence[str] | None = None
) -> list[str]:
    """The tests that fail in a copy of the tree, or another reason why they do not pass.

    With `left_out`, they run without these, until one fails. They run in a fork of this process, which has
    imported what takes long.
    """
    output = copy / "output"
    process = os.fork()
    if not process:
        status = 3
        try:
            os.setsid()
            status = _run_tests(copy, tests, output, left_out)
        except BaseException as problem:
            output.write_text(f"ERROR {problem!r}")
        os._exit(status)
    deadline = time.monotonic() + most_seconds
    ended = False
    status = 0
    while not ended and time.monotonic() < deadline:
        time.sleep(0.01)
        identity, status = os.waitpid(process, os.WNOHANG)
        ended = identity == process
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process, signal.SIGKILL)
    if not ended:
        os.waitpid(process, 0)
        return [f"more than {most_seconds:.0f} s"]
    # 5: no tests were collected.
    if os.waitstatus_to_exitcode(status) in (0, 5):
        return []
    lines = output.read_text(errors="replace").splitlines()
    failed = [
        line.split(" - ")[0].split(" ", 1)[1] for line in lines if line.startswith(("FAILED ", "ERROR "))
    ]
    return failed or [f"ended with {os.waitstatus_to_exitcode(status)}"]


def _run_tests(copy: Path, tests: tuple[str, ...], output: Path, left_out: Sequence[str] | None) -> int:
    descriptor = os.open(output, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    for stream in (1, 2):
        os.dup2(descriptor, stream)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    os.chdir(copy)
    os.environ |= {"PYTHONPATH": str(copy), "HYPOTHESIS_PROFILE": "mutants", "HOME": str(copy)}
    sys.path[:] = [str(copy), *(path for path in sys.path if path and Path(path) != ROOT)]
    for name in [name for name in sys.modules if name.split(".")[0] == "tests"]:
        del sys.modules[name]
    import pytest

    options = ["-q", "--tb=no", "-p", "no:cacheprovider", f"--basetemp={copy}-tmp"]
    if left_out is not None:
        options += ["-x", *(f"--deselect={test}" for test in left_out)]
    # hypothesis is imported already: pytest cannot rewrite its assertions, and has no need to.
    options += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]
    return int(pytest.main([*options, *tests]))


def _copy_tree(copy: Path) -> None:
    shutil.rmtree(copy, ignore_errors=True)
    copy.mkdir(parents=True)
    for name in COPIED:
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
    for path in ROOT.iterdir():
        if path.is_file():
            shutil.copy2(path, copy)


class _Runner:
    """Runs mutants in a copy of the tree of its own."""

    def __init__(self, copy: Path, log: Path) -> None:
        self.copy = copy
        self.log = log
        _copy_tree(copy)

    def run(self, mutant: Mutant, extent: str) -> Result:
        """Run the tests of the subject, of the wing or all, until one fails."""
        tests = suite_of(mutant.file, extent, self.copy)
        most_seconds, broken = self._without_mutant(tests)
        start = time.monotonic()
        path = self.copy / mutant.file
        original = path.read_bytes()
        times = path.stat()
        path.write_bytes(mutant.source(original))
        # Python compiles a file anew only if its time in seconds or its size changed.
        moment = random.randrange(1 << 30)
        os.utime(path, (moment, moment))
        try:
            failed = failed_tests(self.copy, tests, most_seconds, broken)
        finally:
            path.write_bytes(original)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
        return Result(mutant, extent, bool(failed), " ".join(failed), time.monotonic() - start)

    def _without_mutant(self, tests: tuple[str, ...]) -> tuple[float, list[str]]:
        """How long the tests may take, and those that fail without a mutant, which are left out.

        The time is five times the time without a mutant, and 10 s.
        """
        name = " ".join(sorted(tests))
        runs = json.loads(self.log.read_text()) if self.log.exists() else {}
        if name not in runs:
            start = time.monotonic()
            broken = failed_tests(self.copy, tests, 1800)
            for test in broken:
                print(f"left out, since it fails without a mutant: {test}", flush=True)
            runs[name] = time.monotonic() - start, broken
            self.log.write_text(json.dumps(runs))
        seconds, broken = runs[name]
        return 5 * seconds + 10, broken


_runners: list[_Runner] = []


def _start(folder: Path, log: Path) -> None:
    # A test that starts processes of its own counts on being interrupted.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    _runners.append(_Runner(folder / f"copy-{os.getpid()}", log))


def _run(extent: str, mutant: Mutant) -> Result:
    return _runners[0].run(mutant, extent)


def results(mutants: list[Mutant], jobs: int, extents: tuple[str, ...], log: Path) -> Iterator[Result]:
    """Run mutants, as many at once as there are jobs. The file `log` keeps how tests run without one.

    The subjects of all mutants come first, then the wings of those that are alive.
    """
    import hypothesis.strategies  # noqa: F401  # What all tests import is imported once, before the forks.
    import numpy as np  # noqa: F401
    import pygame  # noqa: F401
    import pytest  # noqa: F401

    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        start = partial(_start, Path(folder), log)
        with get_context("fork").Pool(jobs, start) as pool:
            for extent in extents:
                alive = []
                for result in pool.imap_unordered(partial(_run, extent), mutants):
                    yield result
                    if not result.killed:
                        alive.append(result.mutant)
                mutants = alive


def equivalent_mutants() -> dict[tuple[str, str, str], str]:
    """The reasons of mutants that no test can kill."""
    tables = tomllib.loads(EQUIVALENT.read_text())["mutant"]
    return {(table["file"], table["line"], table["change"]): table["reason"] for table in tables}


def reason_of(mutant: Mutant, reasons: dict[tuple[str, str, str], str]) -> str:
    """Why a mutant is equivalent, or an empty text. The change "any" stands for all changes of a line."""
    return reasons.get(mutant.key) or reasons.get((mutant.file, mutant.line, "any"), "")


def _print_summary(outcomes: list[tuple[Mutant, str]]) -> None:
    """Print how many mutants of each wing were killed by what, and the share of all."""
    wings: defaultdict[str, Counter[str]] = defaultdict(Counter)
    for mutant, outcome in outcomes:
        wings["/".join(Path(mutant.file).parts[:2])][outcome] += 1
        wings["in all"][outcome] += 1
    columns = ("subject", "wing", "whole", "alive", "equivalent")
    print(f"{'':34}", *(f"{column:>10}" for column in columns))
    for wing, counts in sorted(wings.items(), key=lambda item: (item[0] == "in all", item[0])):
        print(f"{wing:34}", *(f"{counts[column]:>10}" for column in columns))
    total = wings["in all"]
    rated = total.total() - total["equivalent"]
    if rated:
        print(f"{rated - total['alive']} of {rated} killed, {(rated - total['alive']) / rated:.1%}")


def main() -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", action="append", default=[], help="a file or folder of the program")
    parser.add_argument("--lines", default="", help="a pattern of lines, such as 'MOST_|LARGEST_'")
    parser.add_argument(
        "--whole", action="store_true", help="run the whole suite on what a wing leaves alive"
    )
    parser.add_argument("--log", type=Path, default=Path(tempfile.gettempdir()) / "mutants" / "log")
    parser.add_argument("--again", type=Path, metavar="LOG", help="run the mutants that were alive")
    options = parser.parse_args()
    extents = ("subject", "wing", "whole") if options.whole else ("subject", "wing")
    reasons = equivalent_mutants()
    options.log.mkdir(parents=True, exist_ok=True)
    outcomes: dict[Mutant, str] = {}
    killed: dict[tuple[str, ...], str] = {}
    passed: defaultdict[str, set[tuple[str, ...]]] = defaultdict(set)
    logs = (
        sorted(options.again.glob("*.jsonl"))
        if options.again
        else [options.log / f"seed-{options.seed}.jsonl"]
    )
    for row in (json.loads(line) for log in logs if log.exists() for line in log.read_text().splitlines()):
        if row["killed"]:
            killed[tuple(row["key"])] = row["extent"]
        else:
            passed[row["extent"]].add(tuple(row["key"]))
    if options.again:
        alive = passed["subject"] - killed.keys()
        files = sorted(file for file in {key[0] for key in alive} if (ROOT / file).exists())
        mutants = list(
            {m.key: m for file in files for m in mutants_of(ROOT / file) if m.key in alive}.values()
        )
        passed.clear()
    else:
        mutants = chosen_mutants(options.count, options.seed, options.only, options.lines)
    waiting = []
    for mutant in mutants:
        if reason_of(mutant, reasons):
            outcomes[mutant] = "equivalent"
        elif mutant.key in killed:
            outcomes[mutant] = killed[mutant.key]
        elif mutant.key in passed[extents[-1]]:
            outcomes[mutant] = "alive"
        else:
            waiting.append(mutant)
    for result in results(waiting, options.jobs, extents, options.log / "without-mutant.json"):
        mutant = result.mutant
        outcomes[mutant] = result.extent if result.killed else "alive"
        end = f"killed by {result.by}" if result.killed else "ALIVE"
        place = f"{mutant.file}:{mutant.number}"
        print(f"{result.extent}: {place}: {mutant.change}: {end} ({result.seconds:.1f} s)", flush=True)
        with logs[-1].open("a") as log:
            log.write(json.dumps({**asdict(result), "key": mutant.key}) + "\n")
    _print_summary(list(outcomes.items()))


if __name__ == "__main__":
    main()
