"""Running a library in a process of its own, which may hang, end or eat memory without harm to this one.

Its limits are in proportion to the bytes that it has to read. They are set by the process itself, before it
reads anything (see `worker`); a clock here is for what goes wrong before.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import autocolor.files
from autocolor.checks import printable
from autocolor.errors import InputError
from autocolor.files.meshes.foreign.foreign_mesh import (
    FAILED,
    LONGEST_SENTENCE,
    ForeignMesh,
    read_foreign_mesh,
)
from autocolor.files.reading import shown

MEGABYTE: Final = 1 << 20

LEAST_SECONDS: Final = 2.0
SECONDS_A_MEGABYTE: Final = 1.0
"""Assumed: of computing, once the library is loaded. Measured: text takes 0.1 to 0.5 seconds a megabyte."""

LEAST_MEMORY: Final = 1 << 30
MEMORY_A_BYTE: Final = 60
"""Assumed: of addresses. The libraries alone take half of the least; text takes up to 40 times its size."""

LEAST_RESULT: Final = 16 << 20
RESULT_A_BYTE: Final = 30

STARTING_SECONDS: Final = 30.0
"""Assumed: to load a library on a busy machine, in addition to twice the time of computing."""

WORKER: Final = (sys.executable, "-P", "-m", "autocolor.files.meshes.foreign.worker")
"""The command; -P keeps modules in the current folder, which may be a stranger's, from being imported."""


@dataclass(frozen=True)
class Limits:
    """Of a process: seconds of computing, bytes of memory, bytes of its result."""

    seconds: float
    memory: int
    result: int


def limits_for(size: int) -> Limits:
    """The limits for reading so many bytes."""
    return Limits(
        LEAST_SECONDS + SECONDS_A_MEGABYTE * size / MEGABYTE,
        LEAST_MEMORY + MEMORY_A_BYTE * size,
        LEAST_RESULT + RESULT_A_BYTE * size,
    )


def read_in_own_process(
    library: str,
    kind: str,
    path: Path,
    limits: Limits,
    command: Sequence[str] = WORKER,
    starting: float = STARTING_SECONDS,
) -> ForeignMesh:
    """The mesh of a file that a library reads as a format, `kind`. Raises InputError."""
    with tempfile.TemporaryDirectory(prefix="autocolor-") as folder:
        result = Path(folder) / "mesh.npz"
        arguments = [library, kind, os.fspath(path.absolute()), os.fspath(result)]
        arguments += [str(limits.seconds), str(limits.memory), str(limits.result)]
        code = _run([*command, *arguments], starting + 2 * limits.seconds)
        if code in _OUT_OF_TIME:
            raise InputError(
                f"{path.name}: {library} must read it within {limits.seconds:.0f} seconds, for its size, and"
                " did not; write it as OBJ or PLY"
            )
        if code != 0 or not result.is_file():
            raise InputError(
                f"{path.name}: {library} must read it, and {_end_of(code)}; correct the file, or write it as"
                " OBJ or PLY"
            )
        with open(result, "rb") as file:
            head = file.read(4 * LONGEST_SENTENCE)
        if head.startswith(FAILED):
            sentence = head[len(FAILED) :].decode("utf-8", "replace")[:LONGEST_SENTENCE]
            found = printable(sentence)
            raise InputError(
                f"{path.name}: {library} must be able to read it, and cannot ({found}); correct the file, or"
                " write it as OBJ or PLY"
            )
        return read_foreign_mesh(result, limits.result, path.name, library)


_KILLED_BY_CLOCK: Final = 1 << 16
"""The code of a process that was ended here; no system gives it."""

_OUT_OF_TIME: Final = (
    _KILLED_BY_CLOCK,
    *(-getattr(signal, name) for name in ("SIGXCPU", "SIGALRM") if hasattr(signal, name)),
)


def _run(command: Sequence[str], seconds: float) -> int:
    """The exit code of a process, which is ended after so many seconds; what it prints goes nowhere."""
    root = str(Path(autocolor.files.__path__[0]).parents[1])
    inherited = os.environ.get("PYTHONPATH")
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([root, inherited] if inherited else [root]),
        # Threads reserve memory each, of which there is a limit.
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
    }
    try:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=environment,
            close_fds=True,
        )
    except OSError as error:
        raise InputError(
            f"the process of a reader cannot be started ({shown(str(error))}); free memory"
        ) from None
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        return _KILLED_BY_CLOCK
    finally:
        # Also if the user interrupts.
        if process.poll() is None:
            process.kill()
            process.wait()


def _end_of(code: int) -> str:
    """How a process ended, in words."""
    if code < 0:
        try:
            return f"was ended by {signal.Signals(-code).name}"
        except ValueError:
            return f"was ended by signal {-code}"
    return "ended without a mesh" if code == 0 else f"ended with code {code}"
