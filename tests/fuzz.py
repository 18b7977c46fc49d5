"""Attack the readers of the project with damaged input, guided by the code that it reaches.

    python -m tests.fuzz obj --minutes 5
    python -m tests.fuzz --all --minutes 5 --jobs 2 --log fuzz.log
    python -m tests.fuzz obj --case found/obj-1a2b3c4d.bin

The targets are in `fuzz_targets`, which also says what a fault is. A process of its own, which may die or
hang, tries the inputs. With atheris, inputs that reach new code are damaged further. Without atheris, or with
--plain, the samples of the target are damaged. The first input of each kind of fault is shortened and kept in
the folder --keep, with the story of the fault beside it. A line for each target says how many inputs were
tried. The exit code is 1 if there is a fault.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.util
import mmap
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]

MOST_MEMORY = 6 << 30
"""Bytes of address space of a process that tries inputs."""

HANGS_AFTER = 60.0
"""Seconds without an end of an input after which its process is killed."""

PROGRESS = struct.Struct("<QQQI")
"""The numbers of tried inputs and faults, whether all work is done, and the length of the present input."""

MOST_INPUT = 1 << 18

SHORTENING = 10.0
"""The most seconds to shorten an input."""


class Attack(NamedTuple):
    """What came of attacking a target."""

    target: str
    engine: str
    tried: int
    seconds: float
    faults: int
    kinds: tuple[str, ...]

    def __str__(self) -> str:
        kinds = f" of {len(self.kinds)} kinds: {'; '.join(self.kinds)}" if self.kinds else ""
        return (
            f"{self.target:<10} {self.engine:<8} {self.tried:>10,} inputs {self.seconds:>7.0f} s"
            f" {self.faults:>6,} faults{kinds}"
        )


class Progress:
    """The progress of a process that tries inputs, in a file that its parent can read after it died."""

    def __init__(self, path: Path) -> None:
        if not path.exists():
            path.write_bytes(bytes(PROGRESS.size + MOST_INPUT))
        with open(path, "r+b") as file:
            self._memory = mmap.mmap(file.fileno(), 0)
        self.tried, self.faults, self.done, _ = PROGRESS.unpack_from(self._memory)

    def begin(self, data: bytes) -> None:
        """Note the input that is about to be tried."""
        self._memory[PROGRESS.size : PROGRESS.size + len(data)] = data
        self._note(len(data))

    def end(self, has_fault: bool) -> None:
        """Note that the input was tried."""
        self.tried += 1
        self.faults += has_fault
        self._note(0)

    def finish(self) -> None:
        """Note that all work is done."""
        self.done = 1
        self._note(0)

    def _note(self, length: int) -> None:
        PROGRESS.pack_into(self._memory, 0, self.tried, self.faults, self.done, length)

    def present_input(self) -> bytes:
        """The input that is being tried, or that the process died of."""
        length = PROGRESS.unpack_from(self._memory)[3]
        return self._memory[PROGRESS.size : PROGRESS.size + length]

    def close(self) -> None:
        """Let the file go."""
        self._memory.close()


# The process that tries inputs.


def attack_here(name: str, folder: Path, keep: Path, seconds: float, seed: int, plain: bool) -> None:
    """Try inputs for some seconds. The progress and the faults are noted in the folder."""
    if plain or importlib.util.find_spec("atheris") is None:
        with trying(name, folder, keep) as (try_input, samples):
            attack_plainly(try_input, samples, seconds, seed)
        return
    import atheris

    # All modules of ours that are imported from here on report the code that they run.
    with (
        atheris.instrument_imports(include=["autocolor", "ramtek_emu"]),
        trying(name, folder, keep) as (try_input, samples),
    ):
        from tests.mutations import damaged

        corpus = folder / "corpus"
        corpus.mkdir(exist_ok=True)
        for sample in samples:
            (corpus / digest(sample)).write_bytes(sample)

        def mutate(data: bytes, most: int, chance: int) -> bytes:
            if chance % 2:
                return bytes(atheris.Mutate(data, most))
            return damaged(data, random.Random(chance), samples)[:most]

        largest = max(map(len, samples))
        atheris.Setup(
            [
                *("fuzz", f"-max_total_time={max(1, round(seconds))}", f"-seed={seed % (1 << 31) or 1}"),
                *(f"-max_len={largest * 4}", "-timeout=1000", "-rss_limit_mb=0", "-len_control=0"),
                *("-print_final_stats=1", "-verbosity=0", f"-artifact_prefix={folder}/", str(corpus)),
            ],
            try_input,
            custom_mutator=mutate,
        )
        atheris.Fuzz()


def attack_plainly(
    try_input: Callable[[bytes], None], samples: list[bytes], seconds: float, seed: int
) -> None:
    """Try the samples and damaged copies of them."""
    from tests.mutations import damaged

    end = time.monotonic() + seconds
    chance = random.Random(seed)
    for sample in samples:
        try_input(sample)
    while time.monotonic() < end:
        data = chance.choice(samples)
        for _ in range(chance.choice((1, 1, 1, 2, 4))):
            data = damaged(data, chance, samples)
        try_input(data)


@contextmanager
def trying(name: str, folder: Path, keep: Path) -> Iterator[tuple[Callable[[bytes], None], list[bytes]]]:
    """A function that tries an input and keeps it if its fault is of a new kind, and the target's samples."""
    from tests.fuzz_targets import TARGETS, Arena

    target = TARGETS[name]
    samples = list(target.samples())
    progress = Progress(folder / "progress")
    arena_folder = Path(tempfile.mkdtemp(dir=folder))
    arena = Arena(arena_folder)

    def kind_of(data: bytes) -> str:
        fault = arena.fault_of(target, data)
        return "" if fault is None else fault.kind

    def try_input(data: bytes) -> None:
        data = data[: target.largest]
        progress.begin(data)
        fault = arena.fault_of(target, data)
        if fault is not None and fault.kind not in kinds_in(folder):
            is_slow = fault.kind.startswith("too ")
            data = data if is_slow else shortened(data, lambda shorter: kind_of(shorter) == fault.kind)
            keep_case(name, folder, keep, data, fault.kind, fault.story)
        progress.end(fault is not None)

    try:
        yield try_input, samples
        progress.finish()
    finally:
        arena.close()


def shortened(data: bytes, has_fault: Callable[[bytes], bool]) -> bytes:
    """The data without pieces that the fault does not need."""
    end = time.monotonic() + SHORTENING
    size = len(data) // 2
    while size:
        place = 0
        while place < len(data):
            shorter = data[:place] + data[place + size :]
            if time.monotonic() > end:
                return data
            if has_fault(shorter):
                data = shorter
            else:
                place += size
        size //= 2
    return data


def keep_case(name: str, folder: Path, keep: Path, data: bytes, kind: str, story: str) -> None:
    """Keep an input with the story of its fault."""
    keep.mkdir(parents=True, exist_ok=True)
    path = keep / f"{name}-{digest(data)[:8]}.bin"
    path.write_bytes(data)
    path.with_suffix(".txt").write_text(f"{kind}\n\n{story}\n", errors="backslashreplace")
    with open(folder / "kinds", "a", errors="backslashreplace") as file:
        file.write(f"{kind}\n")


def kinds_in(folder: Path) -> tuple[str, ...]:
    """The kinds of faults that were noted in a folder."""
    path = folder / "kinds"
    return tuple(path.read_text().splitlines()) if path.exists() else ()


def digest(data: bytes) -> str:
    """A name for the data."""
    return hashlib.sha256(data).hexdigest()


# The parent of such processes.


def attack(name: str, keep: Path, seconds: float, seed: int, plain: bool = False) -> Attack:
    """Attack a target for some seconds. A process that dies or hangs is replaced."""
    has_atheris = not plain and importlib.util.find_spec("atheris") is not None
    began, left, tried_before_start = time.monotonic(), seconds, -1
    with tempfile.TemporaryDirectory(prefix="fuzz-") as temporary:
        folder = Path(temporary)
        progress = Progress(folder / "progress")
        while left > 0 and not progress.done and progress.tried != tried_before_start:
            tried_before_start = progress.tried
            ending = run_child(name, folder, keep, left, seed + progress.tried, plain)
            progress.close()
            progress = Progress(folder / "progress")
            data = progress.present_input()
            if ending and (data or not progress.done):
                story = f"{ending}\n{(folder / 'output').read_text(errors='replace')[-4000:]}"
                if ending not in kinds_in(folder):
                    keep_case(name, folder, keep, data, ending, story)
                progress.end(True)
            left = seconds - (time.monotonic() - began)
        progress.close()
        return Attack(
            name, "atheris" if has_atheris else "plain", progress.tried, time.monotonic() - began,
            progress.faults, kinds_in(folder),
        )  # fmt: skip


def run_child(name: str, folder: Path, keep: Path, seconds: float, seed: int, plain: bool) -> str:
    """Run a process that tries inputs; returns how it ended, "" if it did all that it should."""
    command = [sys.executable, "-m", "tests.fuzz", name, "--minutes", str(seconds / 60), "--seed", str(seed)]
    command += ["--keep", str(keep.absolute()), "--child", str(folder), *(["--plain"] if plain else [])]
    threads = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    with open(folder / "output", "wb") as output:
        process = subprocess.Popen(
            command,
            cwd=ROOT,
            env={**os.environ, **threads, "PYTHONPATH": str(ROOT)},
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
            start_new_session=True,
        )
        last, since = -1, time.monotonic()
        while True:
            try:
                code = process.wait(0.5)
                return "" if code == 0 else f"the process ended with {code}"
            except subprocess.TimeoutExpired:
                progress = Progress(folder / "progress")
                tried = progress.tried
                progress.close()
                if tried != last:
                    last, since = tried, time.monotonic()
                # The first seconds go into importing with instruments.
                elif time.monotonic() - since > HANGS_AFTER + 60 * (tried == 0):
                    os.killpg(process.pid, signal.SIGKILL)
                    process.wait()
                    return f"an input did not end within {HANGS_AFTER:g} s"


def judge_case(name: str, path: Path) -> int:
    """Print what becomes of one input; returns the exit code."""
    from tests.fuzz_targets import TARGETS, Arena

    data = path.read_bytes()
    folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
    arena = Arena(folder)
    fault = arena.fault_of(TARGETS[name], data)
    arena.close()
    shutil.rmtree(folder)
    print(f"{path.name}: {'no fault' if fault is None else fault.story}")
    return fault is not None


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns its exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.fuzz", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("targets", nargs="*", metavar="TARGET", help="without any, the targets are listed")
    parser.add_argument("--all", action="store_true", help="attack all targets, one after the other")
    parser.add_argument("--minutes", type=float, default=1.0, help="for each target")
    parser.add_argument("--seed", type=int, default=None, help="another number tries other inputs")
    parser.add_argument("--jobs", type=int, default=1, help="targets at the same time")
    parser.add_argument("--plain", action="store_true", help="without atheris")
    parser.add_argument("--keep", type=Path, default=Path("fuzz-found"), help="folder for inputs with faults")
    parser.add_argument("--log", type=Path, help="append the line of each target to this file")
    parser.add_argument("--case", type=Path, help="judge this input alone")
    parser.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    seed = random.randrange(1 << 31) if options.seed is None else options.seed
    seconds = 60 * options.minutes
    if options.child is not None:
        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, hard))
        attack_here(options.targets[0], options.child, options.keep, seconds, seed, options.plain)
        return 0

    from tests.fuzz_targets import TARGETS

    names = list(TARGETS) if options.all else options.targets
    if not names or not set(names) <= set(TARGETS):
        print(f"the targets are {', '.join(TARGETS)}")
        return 2
    if options.case is not None:
        return judge_case(names[0], options.case)
    print(f"seed {seed}", flush=True)
    has_faults = False
    with ThreadPoolExecutor(options.jobs) as jobs:
        attacks = [jobs.submit(attack, name, options.keep, seconds, seed, options.plain) for name in names]
        for future in attacks:
            line = str(future.result())
            has_faults |= bool(future.result().faults)
            print(line, flush=True)
            if options.log is not None:
                with open(options.log, "a") as log:
                    log.write(f"{line}\n")
    return has_faults


if __name__ == "__main__":
    sys.exit(main())
