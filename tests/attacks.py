"""Attacks on the program: things that are tried at random, again and again, for as long as you let them.

    python -m tests.attacks                                    # the names of all attacks
    python -m tests.attacks reads/obj --minutes 5 --seed 7     # one of them
    python -m tests.attacks reads kills --jobs 2               # all whose names begin so
    python -m tests.attacks reads/obj --seed 7 --number 1234   # one attempt again

`reads` are damaged inputs, in `tests.attack_targets`. `kills` are saves that are killed. `signals` end
commands at any moment. `uses` are random use of screens, servers and the window, in `tests.random_use`.
Each attempt has a number, from which everything follows that is random in it. A process of its own, which
may die or hang, makes the attempts of an attack. These are faults: what the attempt says, an exception, a
warning, too much memory or time, the end of the process, temporary files, descriptors, threads and
processes that are left, and memory that grows. The first of each kind of fault is kept in the folder
--keep, with its input if it has any. The exit code is 1 if there is a fault.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import json
import math
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from itertools import count
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

ROOT: Final = Path(__file__).parents[1]
MOST_MEMORY: Final = 6 << 30
"""Bytes of address space of a process that makes attempts."""
HANGS_AFTER: Final = 120.0
"""Seconds without an end of an attempt after which its process is killed."""
FREE_GROWTH: Final = 16.0
GROWTH_OF_AN_ATTEMPT: Final = 0.006
"""Megabytes by which a process may grow in the last half of the time, and for each attempt beside that.
Before, the process fills the memory that it keeps for the next picture."""
MORE: Final = 4
"""How many more descriptors, threads and children a process may have in the end than early on."""
LEAST_SECONDS: Final = 60.0
"""The seconds after which growth is judged."""


class Trial:
    """What is tried. `most_seconds` of the processor and `most_bytes` of memory bound an attempt."""

    most_seconds = math.inf
    most_bytes = math.inf

    @property
    def watched(self) -> int:
        """The process that may not grow."""
        return os.getpid()

    @contextlib.contextmanager
    def begun(self, folder: Path) -> Iterator[None]:
        """Start what is used, with its files in a folder, and end it."""
        yield

    def attempt(self, chance: random.Random) -> str:
        """Try something in the current folder, which is empty; returns the story of a fault, "" for none.

        A story begins with its kind and a colon.
        """
        raise NotImplementedError

    def input(self, chance: random.Random) -> bytes:
        """The input of the attempt, if it has any that can be kept."""
        return b""


class Fault(NamedTuple):
    """What is wrong: its kind, by which faults with one cause are one, and the whole story."""

    kind: str
    story: str


# What is judged of every attempt.


class Holdings(NamedTuple):
    """What a process holds on to."""

    megabytes: float
    descriptors: int
    threads: int
    children: int

    @classmethod
    def of(cls, process: int) -> Holdings:
        """Those of a process now."""
        own = Path(f"/proc/{process}")
        pages = int((own / "statm").read_text().split()[1])
        tasks = list((own / "task").iterdir())
        children = sum(len((task / "children").read_text().split()) for task in tasks)
        return cls(pages * resource.getpagesize() / 1e6, len(os.listdir(own / "fd")), len(tasks), children)

    def more_than(self, other: Holdings, most: int = 0) -> str:
        """The things of which there are more than before, by more than `most`."""
        things = zip(self._fields[1:], other[1:], self[1:], strict=True)
        return ", ".join(f"{thing} {old} to {new}" for thing, old, new in things if new > old + most)


class Arena:
    """The current folder, the folder for temporary files and the state folder of attempts."""

    def __init__(self, root: Path) -> None:
        self.here, self.temporary, self.state = root / "here", root / "temporary", root / "state"
        for folder in (self.here, self.temporary, self.state):
            folder.mkdir()
        self._surroundings = os.environ.get("XDG_STATE_HOME"), tempfile.tempdir, os.getcwd()
        os.chdir(self.here)
        os.environ["XDG_STATE_HOME"], tempfile.tempdir = str(self.state), str(self.temporary)

    def close(self) -> None:
        """Let the program have its own folders again."""
        home, tempfile.tempdir, folder = self._surroundings
        os.chdir(folder)
        os.environ.pop("XDG_STATE_HOME", None) if home is None else os.environ.update(XDG_STATE_HOME=home)

    def fault_of(self, trial: Trial, chance: random.Random) -> Fault | None:
        """Make an attempt; what goes wrong, None if nothing does."""
        for folder in (self.here, self.temporary, self.state):
            empty(folder)
        before = Holdings.of(os.getpid())
        Path("/proc/self/clear_refs").write_text("5")
        memory, began = peak_of_memory(), time.process_time()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                story = trial.attempt(chance)
            kind = story.partition(":")[0]
        except Exception as error:
            kind, story = f"{type(error).__name__} {innermost(error)}", traceback.format_exc(limit=-12)
        seconds, taken = time.process_time() - began, peak_of_memory() - memory
        if story:
            return Fault(kind, story)
        if seconds > trial.most_seconds:
            return Fault("too slow", f"it took {seconds:.1f} s of the processor")
        if taken > trial.most_bytes:
            return Fault("too much memory", f"it took {taken >> 20:,} MiB")
        if names := os.listdir(self.temporary):
            return Fault("temporary files", f"the temporary files {names} were left")
        if Holdings.of(os.getpid()).more_than(before):
            # What a circle of objects keeps open is closed when it is collected.
            gc.collect()
        more = Holdings.of(os.getpid()).more_than(before)
        return Fault("left behind", more) if more else None


def empty(folder: Path) -> None:
    """Remove all that a folder has; it is made if it does not exist."""
    folder.mkdir(exist_ok=True)
    for entry in os.scandir(folder):
        shutil.rmtree(entry.path) if entry.is_dir(follow_symlinks=False) else os.unlink(entry.path)


def peak_of_memory() -> int:
    """The most bytes of memory that this process has taken since its peak was cleared."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def innermost(error: BaseException) -> str:
    """The innermost function of ours that an exception passed."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [each for each in frames if "/autocolor/" in each.filename or "/ramtek_emu/" in each.filename]
    last = (ours or frames)[-1]
    return f"in {Path(last.filename).name}, {last.name}"


def growth_of(seconds: list[float], holdings: list[Holdings]) -> str:
    """What a process holds on to more and more, if it was watched for long enough."""
    if len(seconds) < 3 or seconds[-1] - seconds[0] < LEAST_SECONDS:
        return ""
    half = len(seconds) // 2
    slope = np.polyfit(seconds[half:], [each.megabytes for each in holdings[half:]], 1)[0]
    growth = slope * (seconds[-1] - seconds[half])
    more = holdings[-1].more_than(holdings[len(holdings) // 10], MORE)
    if growth > FREE_GROWTH + GROWTH_OF_AN_ATTEMPT * half:
        return f"memory grows: by {growth:.0f} MB in the last half"
    return f"more is left: {more}" if more else ""


# The process that makes attempts.


def chance_of(name: str, seed: int, number: int) -> random.Random:
    """All that is random in an attempt."""
    return random.Random(f"{name} {seed} {number}")


def work(name: str, seed: int, first: int, last: int, seconds: float, folder: Path) -> None:
    """Make attempts from number `first` on, in a folder. Their progress and faults are noted there."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    trial = trials()[name]()
    began, times, holdings = time.monotonic(), list[float](), list[Holdings]()
    with tempfile.TemporaryDirectory(dir=folder) as place, trial.begun(Path(place)):
        (Path(place) / "arena").mkdir()
        arena = Arena(Path(place) / "arena")
        for number in range(first, last) if last else count(first):
            note_number(folder, number)
            fault = arena.fault_of(trial, chance_of(name, seed, number))
            if fault is not None:
                note(folder, number, fault)
            times.append(time.monotonic() - began)
            holdings.append(Holdings.of(trial.watched))
            if times[-1] > seconds:
                break
        arena.close()
    if story := growth_of(times, holdings):
        note(folder, number, Fault(story.partition(":")[0], story))
    note_number(folder, number + 1)


def note_number(folder: Path, number: int) -> None:
    """Note the attempt that begins."""
    (folder / "number").write_text(str(number))


def note(folder: Path, number: int, fault: Fault) -> None:
    """Note a fault."""
    with open(folder / "faults", "a") as file:
        file.write(json.dumps([number, *fault]) + "\n")


# The parent of such processes.


class Result(NamedTuple):
    """What came of an attack."""

    name: str
    attempts: int
    seconds: float
    faults: int
    kinds: dict[str, str]

    def __str__(self) -> str:
        head = f"{self.name:<40} {self.attempts:>9,} attempts {self.seconds:>6.0f} s {self.faults:>6,} faults"
        return "\n".join((head, *(f"    {kind}: see {path}" for kind, path in self.kinds.items())))


def attack(name: str, seed: int, seconds: float, keep: Path, first: int = 0, last: int = 0) -> Result:
    """Make attempts for some seconds. A process that dies or hangs is replaced."""
    began, number, ending = time.monotonic(), first, "it begins"
    with tempfile.TemporaryDirectory(prefix="attack-") as temporary:
        folder = Path(temporary)
        while ending and (left := seconds - (time.monotonic() - began)) > 0:
            ending = run_child(name, seed, number, last, left, folder)
            number = int((folder / "number").read_text())
            if ending:
                note(folder, number, Fault(ending, (folder / "output").read_text(errors="replace")[-4000:]))
                number += 1
        path = folder / "faults"
        rows = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
        kinds: dict[str, str] = {}
        for at, kind, story in rows:
            if kind not in kinds:
                kinds[kind] = str(kept(name, seed, at, f"{kind}\n\n{story}\n", keep))
        return Result(name, number - first, time.monotonic() - began, len(rows), kinds)


def run_child(name: str, seed: int, first: int, last: int, seconds: float, folder: Path) -> str:
    """Run a process that makes attempts; returns how it ended, "" if it did all that it should."""
    options = [*("--seed", seed), *("--number", first), *("--last", last), *("--minutes", seconds / 60)]
    command = [sys.executable, "-m", "tests.attacks", name, *map(str, options), "--child", str(folder)]
    threads = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    note_number(folder, first)
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
        try:
            return watched(process, folder / "number")
        finally:
            # The processes that it left are ended, too.
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def watched(process: subprocess.Popen[bytes], progress: Path) -> str:
    """How a process ended, "" if in order, or that it does not go on."""
    last, since = "", time.monotonic()
    while time.monotonic() - since < HANGS_AFTER:
        try:
            code = process.wait(0.2)
            return "" if code == 0 else f"the process ended with {code}"
        except subprocess.TimeoutExpired:
            if (now := progress.read_text()) != last:
                last, since = now, time.monotonic()
    return f"an attempt did not end within {HANGS_AFTER:g} s"


def kept(name: str, seed: int, number: int, story: str, keep: Path) -> Path:
    """The file with the story of a fault; its input, if it has any, is kept beside it."""
    keep.mkdir(parents=True, exist_ok=True)
    path = keep / f"{name.replace('/', '-').replace(' ', '-')}-{seed}-{number}.txt"
    path.write_text(f"python -m tests.attacks '{name}' --seed {seed} --number {number}\n\n{story}")
    if data := trials()[name]().input(chance_of(name, seed, number)):
        path.with_suffix(".bin").write_bytes(data)
    return path


def trials() -> Mapping[str, Callable[[], Trial]]:
    """All attacks by their names."""
    from tests import attack_targets, kills, random_use, signals

    return {
        f"{kind}/{name}": trial
        for kind, module in (
            ("reads", attack_targets),
            ("kills", kills),
            ("signals", signals),
            ("uses", random_use),
        )
        for name, trial in module.trials().items()
    }


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns its exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.attacks", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="without any, the attacks are listed")
    parser.add_argument("--minutes", type=float, default=1.0, help="for each attack")
    parser.add_argument("--seed", type=int, help="another number tries other things")
    parser.add_argument("--jobs", type=int, default=1, help="attacks at the same time")
    parser.add_argument("--keep", type=Path, default=Path("faults"), help="folder for what had faults")
    parser.add_argument("--number", type=int, help="make this attempt alone")
    parser.add_argument("--last", type=int, default=0, help=argparse.SUPPRESS)
    parser.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    seed = random.randrange(1 << 31) if options.seed is None else options.seed
    seconds = 60 * options.minutes
    if options.child is not None:
        work(options.names[0], seed, options.number, options.last, seconds, options.child)
        return 0
    names = [name for name in trials() if name.startswith(tuple(options.names))] if options.names else []
    if not names:
        print(*trials(), sep="\n")
        return 2
    # A shell's jobs in the background ignore interrupts; the commands that are attacked would respect that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    print(f"seed {seed}", flush=True)
    first, last = (0, 0) if options.number is None else (options.number, options.number + 1)
    faults = 0
    with ThreadPoolExecutor(options.jobs) as jobs:
        for result in jobs.map(lambda name: attack(name, seed, seconds, options.keep, first, last), names):
            faults += result.faults
            print(result, flush=True)
    return faults > 0


if __name__ == "__main__":
    sys.exit(main())
