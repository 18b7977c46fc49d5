from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.foreign.own_process import Limits, limits_for, read_in_own_process

LIMITS = Limits(2.0, 1 << 30, 1 << 20)

GOOD = """
import numpy as np
from autocolor.files.meshes.foreign.foreign_mesh import ForeignMesh
from autocolor.files.repair.polygons import Polygons
polygons = Polygons(np.eye(3), np.arange(3), np.array([3]), np.array([0]), ("p",))
mesh = ForeignMesh(polygons)
"""


def command(body: str) -> list[str]:
    """A worker whose library runs some lines, which give `mesh`, when it is asked to read a file."""
    code = f"""
import sys
from autocolor.files.meshes.foreign import worker
def reader(kind):
    def read(path):
        {"        ".join(line + chr(10) for line in (GOOD + body).splitlines())}
        return mesh
    return read
worker.LIBRARIES["fake"] = reader
sys.exit(worker.main(sys.argv[1:]))
"""
    return [sys.executable, "-c", code]


def read(folder: Path, body: str, limits: Limits = LIMITS) -> tuple[str, ...]:
    path = folder / "a.glb"
    path.write_bytes(b"mesh")
    return read_in_own_process("fake", "glb", path, limits, command(body)).polygons.part_names


def refusal(folder: Path, body: str, limits: Limits = LIMITS) -> str:
    with pytest.raises(InputError) as caught:
        read(folder, body, limits)
    return str(caught.value)


def test_a_mesh_comes_back(tmp_path: Path) -> None:
    assert read(tmp_path, "") == ("p",)


def test_what_a_library_prints_goes_nowhere(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert read(tmp_path, "import os; print('noise' * 100000); os.write(2, b'noise'); os.write(1, b'noise')")
    assert capfd.readouterr() == ("", "")


def test_a_library_may_raise_or_exit(tmp_path: Path) -> None:
    said = "a.glb: fake must be able to read it, and cannot ({}); correct the file, or write it as OBJ or PLY"
    assert refusal(tmp_path, "raise ValueError('no\\nnodes')") == said.format("ValueError: no nodes")
    assert refusal(tmp_path, "sys.exit(0)") == said.format("it gave up")
    assert refusal(tmp_path, "mesh = None").startswith(
        "a.glb: fake must be able to read it, and cannot (Attr"
    )
    assert refusal(tmp_path, "def f(): f()\nf()").startswith(
        "a.glb: fake must be able to read it, and cannot (RecursionError: "
    )


def test_a_library_may_end_the_process(tmp_path: Path) -> None:
    said = "a.glb: fake must read it, and {}; correct the file, or write it as OBJ or PLY"
    assert refusal(tmp_path, "import os; os._exit(0)") == said.format("ended without a mesh")
    assert refusal(tmp_path, "import os; os._exit(7)") == said.format("ended with code 7")
    assert refusal(tmp_path, "import os; os.abort()") == said.format("was ended by SIGABRT")
    segfault = "import signal; signal.raise_signal(signal.SIGSEGV)"
    assert refusal(tmp_path, segfault) == said.format("was ended by SIGSEGV")


@pytest.mark.parametrize("body", ["while True: pass", "import time; time.sleep(100)"])
def test_a_library_that_hangs_is_ended(tmp_path: Path, body: str) -> None:
    started = time.monotonic()
    assert refusal(tmp_path, body, Limits(1.0, 1 << 30, 1 << 20)) == (
        "a.glb: fake must read it within 1 seconds, for its size, and did not; write it as OBJ or PLY"
    )
    assert time.monotonic() - started < 30


def test_a_process_that_never_starts_reading_is_ended(tmp_path: Path) -> None:
    hanging = [sys.executable, "-c", "import time; time.sleep(100)"]
    with pytest.raises(InputError, match=r"fake must read it within 0 seconds, for its size, and did not"):
        read_in_own_process("fake", "glb", tmp_path / "a.glb", Limits(0.1, 1, 1), hanging, starting=0.5)


def test_a_library_that_eats_memory_is_refused_it(tmp_path: Path) -> None:
    assert refusal(tmp_path, "mesh = [bytes(1 << 20) for _ in range(5000)]") == (
        "a.glb: fake must be able to read it, and cannot (it needs more memory than its size allows); correct"
        " the file, or write it as OBJ or PLY"
    )


def test_a_result_that_is_too_large_is_no_result(tmp_path: Path) -> None:
    body = "polygons = Polygons(np.zeros((100000, 3)), np.arange(3), np.array([3]), np.array([0]), ('p',))\n"
    assert "a.glb: fake " in refusal(tmp_path, body + "mesh = ForeignMesh(polygons)")


def test_a_command_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the process of a reader cannot be started "):
        read_in_own_process("fake", "glb", tmp_path / "a.glb", LIMITS, [str(tmp_path / "none")])


def test_limits_grow_with_the_size_of_the_file() -> None:
    assert limits_for(0) == Limits(2.0, 1 << 30, 16 << 20)
    assert limits_for(10 << 20).seconds == 12
    assert limits_for(10 << 20).memory == (1 << 30) + (600 << 20)
