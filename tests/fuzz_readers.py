"""Read thousands of damaged files with every reader, in processes that may die, and tell whatever goes wrong.

    python -m tests.fuzz_readers --count 10000
    python -m tests.fuzz_readers --count 500 --format PLY
    python -m tests.fuzz_readers --count 20 ~/meshes ~/bad-files

Without files, the samples of `mutations` are damaged; with them, each file that is named, and each in the
folders that are named, whatever it is. What is told: an exception that is no refusal, a refusal that names no
file, a process that dies or hangs, reading for over 2 seconds, a table that is not what a mesh promises, and
memory of more than a small multiple of the file. The file that did it is kept where --keep says. The exit
code is 1 if anything is told.
"""

from __future__ import annotations

import argparse
import multiprocessing
import resource
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from typing import NamedTuple

from tests.mutations import Outcome, Seed, mutated, outcome_of, seeds

MOST_MEMORY = 3 << 30
"""Bytes of address space of a process that reads."""

FREE_MEMORY = 48 << 20
"""Bytes that a reader may take for any file."""

TIMES_THE_FILE = 40
"""How many times the size of the file it may take beside that. An OBJ polygon in text takes 20 bytes, and its
mesh, its normals and what is computed on the way some hundred."""

HANGS_AFTER = 20.0
"""Seconds after which a process is ended: 2 s of its own time, on a busy machine."""

LARGEST_SEED = 8 << 20
"""Larger files are read as they are, and not damaged."""


class Case(NamedTuple):
    """One mutation of a seed."""

    seed: Seed
    number: int


def file_seeds(paths: list[Path]) -> Iterator[Seed]:
    """A seed for each file that is named or is in a folder that is named."""
    for path in paths:
        found = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in found:
            if file.is_file():
                files = {file.name: file.read_bytes()}
                beside = file.with_suffix(".mtl")
                if beside != file and beside.is_file():
                    files[beside.name] = beside.read_bytes()
                yield Seed(str(file), files, file.name)


def cases_of(given: list[Seed], count: int) -> Iterator[Case]:
    """Each seed as it is, and `count` mutations of all of them together, or of each named file."""
    for number in range(count + 1):
        for seed in given:
            if number == 0 or sum(map(len, seed.files.values())) <= LARGEST_SEED:
                yield Case(seed, number)


def reads(connection: Connection, folder: Path) -> None:
    """Read the seeds that come through a connection, until None comes, and send back what became of each."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    while (seed := connection.recv()) is not None:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        forget_peak()
        before = memory("VmRSS")
        outcome = outcome_of(seed, folder)
        taken = memory("VmHWM") - before
        most = FREE_MEMORY + TIMES_THE_FILE * sum(map(len, seed.files.values()))
        if taken > most and not outcome.fault:
            outcome = Outcome(outcome.kind, f"it took {taken >> 20:,} MiB, more than {most >> 20:,} MiB")
        connection.send(outcome)


def forget_peak() -> None:
    """Let the peak of this process's memory begin anew."""
    Path("/proc/self/clear_refs").write_text("5")


def memory(key: str) -> int:
    """The bytes that a line of /proc/self/status tells."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(f"{key}:"):
            return int(line.split()[1]) * 1024
    raise ValueError(f"no {key}")


class Reader:
    """A process that reads; another one takes its place when it dies or hangs."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._begin()

    def _begin(self) -> None:
        self._folder.mkdir(exist_ok=True)
        self._connection, other = multiprocessing.Pipe()
        self._process = multiprocessing.get_context("fork").Process(target=reads, args=(other, self._folder))
        self._process.start()
        other.close()

    def outcome(self, seed: Seed) -> Outcome:
        """What becomes of a seed."""
        self._connection.send(seed)
        try:
            if self._connection.poll(HANGS_AFTER):
                found: Outcome = self._connection.recv()
                return found
            fault = f"it hung for {HANGS_AFTER:g} s"
        except EOFError:
            self._process.join()
            fault = f"the process died ({self._process.exitcode})"
        self._process.kill()
        self._process.join()
        self._begin()
        return Outcome("died", fault)

    def end(self) -> None:
        """End the process."""
        self._connection.send(None)
        self._process.join()


def main() -> int:
    """Run the command line; returns its exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz_readers")
    parser.add_argument("--count", type=int, default=10_000, help="mutations of each sample or file")
    parser.add_argument("--first", type=int, default=0, help="the number of the first mutation")
    parser.add_argument("--format", default="", help="only samples whose name begins so")
    parser.add_argument("--keep", type=Path, default=Path("fuzz-kept"), help="where files at fault are kept")
    parser.add_argument("paths", nargs="*", type=Path, help="files and folders to damage instead")
    options = parser.parse_args()
    given = list(file_seeds(options.paths) if options.paths else seeds())
    given = [seed for seed in given if seed.name.casefold().startswith(options.format.casefold())]
    kinds: Counter[str] = Counter()
    told: Counter[str] = Counter()
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        reader = Reader(Path(name, "read"))
        for seed, number in cases_of(given, options.count):
            case = mutated(seed, options.first + number if number else 0)
            outcome = reader.outcome(case)
            kinds[outcome.kind] += 1
            if not outcome.fault:
                continue
            told[f"{seed.name}: {outcome.fault[:60]}"] += 1
            if told[f"{seed.name}: {outcome.fault[:60]}"] <= 3:
                at = f"{seed.name}, mutation {options.first + number}"
                print(f"{at}: {outcome.kind}: {outcome.fault}", flush=True)
                keep(case, options.keep / f"{Path(seed.name).name} {options.first + number}")
        reader.end()
    listed = ", ".join(f"{count:,} {kind}" for kind, count in sorted(kinds.items()))
    seconds = time.monotonic() - began
    print(f"{sum(kinds.values()):,} files in {seconds:.0f} s: {listed}; {sum(told.values()):,} faults")
    return bool(told)


def keep(seed: Seed, folder: Path) -> None:
    """Keep the files of a seed."""
    for name, data in seed.files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)


if __name__ == "__main__":
    sys.exit(main())
