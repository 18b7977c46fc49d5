"""The rules for bad input, one by one, for the reader of every mesh and scene format."""

from __future__ import annotations

import os
import time
from functools import partial
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files.formats import file_formats, suffixes_of
from autocolor.files.scene_sources import SCENE_FORMATS, read_scene_with_report
from tests.mutations import BY_HAND, OBJ_TEXT, PLY_BITS, PLY_TEXT, STL_BITS

OURS = [each for each in file_formats() if not isinstance(each.read, partial)]
"""The mesh formats that no library reads in a process of its own; that has tests of its own."""

SUFFIXES = sorted({*suffixes_of(SCENE_FORMATS), *suffixes_of(OURS)})
TEXTS = [seed for seed in BY_HAND if seed.read and seed.files[seed.read].isascii()]


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


NUMBERS = ["0x10", "1_0", "1,5", "\N{ARABIC-INDIC DIGIT THREE}", "nan", "inf", "1e31", "1e999"]
COUNTS = [2**31 - 1, -1, 2**31, 2**32 - 1, 2**63]
CORNERS = [b"0", b"-9", b"99", b"4294967297", b"1.5", b"9" * 25]
PLACES = [
    ("car.obj", OBJ_TEXT, b"1.5e0", [each.encode() for each in NUMBERS]),
    ("car.ply", PLY_TEXT, b"0 1 0.5", [f"0 1 {each}".encode() for each in NUMBERS]),
    *(
        (name, text, count, [count.split()[0] + b" %d" % each for each in COUNTS])
        for name, text, counts in (
            ("car.ply", PLY_TEXT, (b"vertex 4", b"face 2")),
            ("car.ply", PLY_BITS, (b"vertex 4", b"face 2")),
        )
        for count in counts
    ),
    ("car.stl", STL_BITS, STL_BITS[80:84], [b"\xff\xff\xff\xff"]),
    ("car.obj", OBJ_TEXT, b"f -1 -3 2", [b"f -1 -3 " + each for each in CORNERS]),
    ("car.ply", PLY_TEXT, b"3 0 1 2\n", [b"3 0 1 " + each + b"\n" for each in CORNERS[1:]]),
]


@pytest.mark.parametrize(("name", "text", "old", "news"), PLACES)
def test_a_number_a_count_or_a_corner_that_cannot_be_is_refused(
    tmp_path: Path, name: str, text: bytes, old: bytes, news: list[bytes]
) -> None:
    path = tmp_path / name
    assert old in text
    for new in news:
        path.write_bytes(text.replace(old, new, 1))
        assert name in refusal(path), new
