"""Forks of one process read the files that libraries read, so that a library is loaded once for all tests."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from autocolor.files.meshes import foreign

FAKE = """
import sys, types
import numpy as np
from autocolor.files.meshes import foreign_worker as worker
from autocolor.files.meshes.foreign_mesh import ForeignMesh, ForeignRefusal
from autocolor.files.meshes.repair import RawPolygons

def read(path, kind):
    polygons = RawPolygons(np.eye(3), np.arange(3), np.array([3]), np.array([0]), ("p",))
    names = {"mesh": ForeignMesh(polygons)}
    exec(path.read_text(), globals() | names, names)
    return names["mesh"]

fake = types.ModuleType("autocolor.files.meshes.foreign_fake")
fake.read = read
sys.modules[fake.__name__] = fake
"""
"""A library that runs the file that it is asked to read; the file may give `mesh`."""

OWN = [sys.executable, "-c", FAKE + "sys.exit(worker.main(sys.argv[1:]))"]
"""A worker of its own that has this library, too."""

SHARED = [
    sys.executable,
    "-c",
    FAKE
    + """
import importlib, json, os
for line in sys.stdin:
    *arguments, printed = json.loads(line)
    importlib.import_module("autocolor.files.meshes.foreign_" + arguments[1])
    child = os.fork()
    if child == 0:
        os.dup2(os.open(os.devnull, os.O_RDWR), 1)
        os.dup2(os.open(printed, os.O_WRONLY | os.O_CREAT), 2)
        os._exit(worker.main(arguments))
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
""",
]
"""Reads each file in a fork that has the library already, and prints its exit code."""


@pytest.fixture(scope="session")
def worker() -> Iterator[subprocess.Popen[str]]:
    threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "VTK_SMP_MAX_THREADS"), "1")
    pipe = subprocess.PIPE
    with subprocess.Popen(
        SHARED, stdin=pipe, stdout=pipe, text=True, env={**os.environ, **threads}
    ) as process:
        yield process
        process.communicate(timeout=60)
    assert process.returncode == 0


@pytest.fixture
def shared(worker: subprocess.Popen[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Files are read by forks of one process."""

    def exit_code(command: list[str], seconds: float, printed: Path) -> int:
        assert worker.stdin is not None
        assert worker.stdout is not None
        print(json.dumps([*command[-7:], str(printed)]), file=worker.stdin, flush=True)
        return int(worker.stdout.readline())

    monkeypatch.setattr(foreign, "_exit_code", exit_code)
