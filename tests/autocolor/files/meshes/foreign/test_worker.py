from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from autocolor.files.meshes.foreign.worker import guard, sentence_of


def run(code: str) -> subprocess.CompletedProcess[str]:
    text = f"from autocolor.files.meshes.foreign import worker\n{code}"
    return subprocess.run(
        [sys.executable, "-c", text], capture_output=True, text=True, timeout=60, check=False
    )


def test_what_a_reader_has_no_need_of_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "meshes"
    folder.mkdir()
    (folder / "a.obj").write_text("v 0 0 0")
    (tmp_path / "secret").write_text("secret")
    (folder / "link").symlink_to(tmp_path / "secret")
    refuse = guard(folder, tmp_path / "result")
    refuse("open", (str(folder / "a.obj"), "r", os.O_RDONLY))
    refuse("open", (os.fsencode(os.__file__), "r", os.O_RDONLY))
    refuse("open", (str(tmp_path / "result"), "w", os.O_WRONLY | os.O_CREAT))
    refuse("open", (3, "r", os.O_RDONLY))
    refuse("import", ("trimesh", None, None, None, None))
    for name in ("../secret", "link"):
        with pytest.raises(PermissionError, match=f"the file names '.*{name}', which is not in its folder"):
            refuse("open", (str(folder / name), "r", os.O_RDONLY))
    with pytest.raises(PermissionError):
        refuse("open", (str(folder / "a.obj"), "w", os.O_WRONLY | os.O_CREAT))
    for event in ("socket.connect", "subprocess.Popen", "os.system", "urllib.Request", "os.remove"):
        with pytest.raises(PermissionError, match=f"{event} is not allowed"):
            refuse(event, ())


def test_a_process_with_the_guard_has_no_network_and_starts_no_program(tmp_path: Path) -> None:
    done = run(
        f"""
import pathlib, socket, subprocess, sys
sys.addaudithook(worker.guard(pathlib.Path({str(tmp_path)!r}), pathlib.Path({str(tmp_path / "result")!r})))
for act in (
    lambda: socket.create_connection(("127.0.0.1", 9)),
    lambda: subprocess.run(["true"]),
    lambda: open("/etc/passwd"),
    lambda: open({str(tmp_path / "other")!r}, "w"),
):
    try:
        act()
        print("done")
    except PermissionError:
        print("refused")
"""
    )
    assert done.stdout.split() == ["refused"] * 4


def test_memory_is_limited_by_the_system() -> None:
    done = run("worker.limit_memory(1 << 30, 1 << 20)\nimport numpy\nnumpy.ones(1 << 28)")
    assert "MemoryError" in done.stderr


def test_the_size_of_a_result_is_limited_by_the_system(tmp_path: Path) -> None:
    path = tmp_path / "result"
    done = run(f"worker.limit_memory(1 << 30, 1000)\nopen({str(path)!r}, 'wb', 0).write(bytes(5000))")
    assert done.returncode in (0, 1, -25)
    assert path.stat().st_size <= 1000


@pytest.mark.parametrize("code", ["while True: pass", "import time; time.sleep(60)"])
def test_time_is_limited_by_the_system(code: str) -> None:
    assert run(f"worker.limit_time(0.2)\n{code}").returncode < 0


def test_a_failure_is_one_line_of_limited_length() -> None:
    assert sentence_of(ValueError("a\n b")) == "ValueError: a b"
    assert sentence_of(KeyError()) == "KeyError"
    assert sentence_of(SystemExit(1)) == "it gave up"
    assert len(sentence_of(ValueError("x" * 1000))) == 300
