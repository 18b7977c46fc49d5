"""The rules for bad input, one by one, for the reader of every mesh and scene format."""

from __future__ import annotations

import os
import time
from functools import partial
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files.formats import FILE_FORMATS, suffixes_of
from autocolor.files.opening import PICTURE, SCENE, STORE, read_scene_with_report
from tests.mutations import PLY_TEXT

OURS = [each for each in FILE_FORMATS if not isinstance(each.read, partial)]
"""The mesh formats that no library reads in a process of its own; that has tests of its own."""

SUFFIXES = suffixes_of((PICTURE, SCENE, STORE, *OURS))


def refusal(path: Path) -> str:
    """What is said of a file, which is refused within 2 seconds of the processor."""
    before = time.process_time()
    with pytest.raises(InputError) as caught:
        read_scene_with_report(path)
    assert time.process_time() - before < 2
    assert all(0 < len(problem) < 2000 and problem.isprintable() for problem in caught.value.problems)
    return str(caught.value)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_is_no_file_or_a_file_of_nothing_is_refused(tmp_path: Path, suffix: str) -> None:
    os.mkfifo(tmp_path / f"pipe{suffix}")
    assert "not a pipe" in refusal(tmp_path / f"pipe{suffix}")
    path = tmp_path / f"car{suffix}"
    empty = (b"", b"\0" * 5000, b"\n" * 5000, b"\r", b" ", b"\xff\xfe\0v\0 ", b"\xef\xbb\xbf")
    for data in (*empty, b"0", b"-1 " * 3000):
        path.write_bytes(data)
        assert "car" in refusal(path), data[:8]


@pytest.mark.parametrize(
    "suffix", [suffix for suffix in SUFFIXES if suffix not in (".npz", ".db", ".sqlite")]
)
def test_an_endless_line_is_refused(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"car{suffix}"
    starts = {".ply": PLY_TEXT[:24], ".stl": b"solid ", ".obj": b"v 0 0 0\nf "}
    path.write_bytes(starts.get(suffix, b"") + b"1 " * 2_000_000)
    assert "car" in refusal(path)
