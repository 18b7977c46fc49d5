from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from autocolor.files.state.file_lock import lock_file

ROOT = Path(__file__).parents[4]


def test_one_has_the_lock_until_it_is_closed(tmp_path: Path) -> None:
    first = lock_file(tmp_path / "lock")
    assert first is not None
    assert lock_file(tmp_path / "lock") is None
    os.close(first)
    second = lock_file(tmp_path / "lock")
    assert second is not None
    os.close(second)


def test_a_program_that_is_killed_has_no_lock(tmp_path: Path) -> None:
    code = (
        "import sys; from pathlib import Path; from autocolor.files.state.file_lock import lock_file;"
        "lock_file(Path(sys.argv[1])); print('locked', flush=True); sys.stdin.read()"
    )
    path = tmp_path / "lock"
    with subprocess.Popen(
        [sys.executable, "-c", code, str(path)], cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline().strip() == b"locked"
        assert lock_file(path) is None
        process.kill()
        process.wait()
        descriptor = lock_file(path)
        assert descriptor is not None
        os.close(descriptor)


def test_a_lock_in_no_folder_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        lock_file(tmp_path / "none" / "lock")
