"""Forks of one process read the files that libraries read, so that a library is loaded once for all tests."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator

import numpy as np
import pytest

from autocolor.files.meshes.repair import MeshReport

PROGRAM = """
import dataclasses, importlib, json, os, sys, types
import numpy as np
from autocolor.errors import InputError
from autocolor.files.foreign import worker
from autocolor.files.foreign.mesh import ForeignMesh, ForeignRefusal
from autocolor.files.meshes.repair import RawPolygons
from autocolor.scene.scalar import MeshScalar

def read(path, kind):
    polygons = RawPolygons(np.eye(3), np.arange(3), np.array([3]), np.array([0]), ("p",))
    names = {"mesh": ForeignMesh(polygons)}
    exec(path.read_text(), globals() | names, names)
    return names["mesh"]

fake = types.ModuleType("autocolor.files.foreign.fake")
fake.read = read
sys.modules[fake.__name__] = fake
if sys.argv[1:]:
    sys.exit(worker.main(sys.argv[1:]))
for line in sys.stdin:
    arguments = json.loads(line)
    importlib.import_module("autocolor.files.foreign." + arguments[1])
    child = os.fork()
    if child == 0:
        os.dup2(os.open(os.devnull, os.O_RDWR), 1)
        os.dup2(1, 2)
        os._exit(worker.main(arguments))
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""
"""A worker with a library that runs the file that it is asked to read; the file may give `mesh`.

Without arguments it reads files whose arguments come in lines, each in a fork, and prints the exit codes.
"""

OWN = (sys.executable, "-c", PROGRAM)


@pytest.fixture(scope="session")
def worker() -> Iterator[subprocess.Popen[str]]:
    threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "VTK_SMP_MAX_THREADS"), "1")
    pipe = subprocess.PIPE
    with subprocess.Popen(OWN, stdin=pipe, stdout=pipe, text=True, env={**os.environ, **threads}) as process:
        yield process
        process.communicate(timeout=60)
    assert process.returncode == 0


@pytest.fixture
def shared(worker: subprocess.Popen[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Files are read by forks of one process."""

    def exit_code(command: tuple[str, ...], **options: object) -> int:
        assert worker.stdin is not None
        assert worker.stdout is not None
        print(json.dumps(command[-8:]), file=worker.stdin, flush=True)
        return int(worker.stdout.readline())

    monkeypatch.setattr(subprocess, "call", exit_code)


CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1.0)])
SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
"""The nodes of a cube, and its sides, turned outward."""


def area_and_volume(report: MeshReport) -> tuple[float, float]:
    """The area of a mesh, and the volume within it, positive if it is turned outward."""
    a, b, c, d = report.mesh.coordinates[report.mesh.node_numbers.T]
    area = sum(np.linalg.norm(np.cross(q - p, r - p), axis=1).sum() for p, q, r in ((a, b, c), (a, c, d))) / 2
    volume = sum((a * np.cross(q, r)).sum() for q, r in ((b, c), (c, d))) / 6
    return round(float(area), 6), round(float(volume), 6)
