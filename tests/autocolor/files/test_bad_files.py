"""The rules for bad input, one by one, for the reader of every mesh and scene format."""

from __future__ import annotations

import os
import time
from functools import partial
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files.formats import file_formats, suffixes_of
from autocolor.files.scene_sources import SCENE_FORMATS, read_scene, read_scene_with_report
from tests.mutations import BY_HAND, OBJ_TEXT, PLY_BITS, PLY_TEXT, STL_BITS, VTK_GRID, VTK_TEXT

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
def test_a_file_of_nothing_is_refused(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"car{suffix}"
    empty = (b"", b"\0" * 5000, b"\n" * 5000, b"\r", b" ", b"\xff\xfe\0v\0 ", b"\xef\xbb\xbf")
    for data in (*empty, b"0", b"-1 " * 3000):
        path.write_bytes(data)
        assert "car" in refusal(path), data[:8]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_is_no_regular_file_is_refused_without_waiting(tmp_path: Path, suffix: str) -> None:
    os.mkfifo(tmp_path / f"pipe{suffix}")
    (tmp_path / f"folder{suffix}").mkdir()
    assert "not a pipe" in refusal(tmp_path / f"pipe{suffix}")
    assert "folder" in refusal(tmp_path / f"folder{suffix}")
    (tmp_path / f"zero{suffix}").symlink_to("/dev/zero")
    assert "not a device" in refusal(tmp_path / f"zero{suffix}")


@pytest.mark.parametrize(
    "suffix", [suffix for suffix in SUFFIXES if suffix not in (".npz", ".db", ".sqlite")]
)
def test_an_endless_line_is_refused(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"car{suffix}"
    starts = {".ply": PLY_TEXT[:24], ".vtk": VTK_TEXT[:60], ".stl": b"solid ", ".obj": b"v 0 0 0\nf "}
    path.write_bytes(starts.get(suffix, b"") + b"1 " * 5_000_000)
    assert "car" in refusal(path)


@pytest.mark.parametrize("seed", TEXTS, ids=lambda seed: seed.name)
@pytest.mark.parametrize("ends", [b"\r\n", b"\r"], ids=["CR LF", "CR"])
def test_lines_may_end_as_on_other_systems(tmp_path: Path, seed: object, ends: bytes) -> None:
    files, read = vars(seed)["files"], vars(seed)["read"]
    shapes = []
    for folder, end in (("as it is", b"\n"), ("other", ends)):
        (tmp_path / folder).mkdir()
        for name, data in files.items():
            (tmp_path / folder / name).write_bytes(data.replace(b"\n", end))
        mesh = read_scene(tmp_path / folder / read).mesh
        shapes.append((mesh.coordinates.tolist(), mesh.node_numbers.tolist(), mesh.part_names))
    assert shapes[0] == shapes[1]


@pytest.mark.parametrize(
    "number", ["0x10", "1_0", "1,5", "\N{ARABIC-INDIC DIGIT THREE}", "nan", "inf", "1e31", "1e999"]
)
@pytest.mark.parametrize(
    ("name", "text", "word"),
    [
        ("car.obj", OBJ_TEXT, b"1.5e0"),
        ("car.ply", PLY_TEXT, b"0 1 0.5"),
        ("car.vtk", VTK_TEXT, b"0 1 0.5"),
    ],
)
def test_a_coordinate_is_a_plain_finite_number(
    tmp_path: Path, name: str, text: bytes, word: bytes, number: str
) -> None:
    assert text.count(word) == 1
    path = tmp_path / name
    path.write_bytes(text.replace(word, word.rpartition(b" ")[0] + b" " + number.encode()))
    assert name in refusal(path)


@pytest.mark.parametrize("count", [2**31 - 1, 2**31, 2**32 - 1, 2**63, -1])
@pytest.mark.parametrize(
    ("name", "text", "old"),
    [
        ("car.ply", PLY_TEXT, b"vertex 4"),
        ("car.ply", PLY_TEXT, b"face 2"),
        ("car.ply", PLY_BITS, b"vertex 4"),
        ("car.ply", PLY_BITS, b"face 2"),
        ("car.vtk", VTK_TEXT, b"POINTS 5"),
        ("car.vtk", VTK_TEXT, b"POLYGONS 2"),
        ("car.vtk", VTK_GRID, b"POINTS 4"),
        ("car.vtk", VTK_GRID, b"CELLS 2"),
    ],
)
def test_a_count_is_compared_with_the_file_before_anything_is_made_for_it(
    tmp_path: Path, name: str, text: bytes, old: bytes, count: int
) -> None:
    path = tmp_path / name
    assert old in text
    path.write_bytes(text.replace(old, old.split()[0] + b" %d" % count))
    assert name in refusal(path)


def test_the_count_of_a_binary_stl_is_compared_too(tmp_path: Path) -> None:
    path = tmp_path / "car.stl"
    path.write_bytes(STL_BITS[:80] + b"\xff\xff\xff\xff" + STL_BITS[84:])
    assert "car.stl" in refusal(path)


@pytest.mark.parametrize("corner", [b"0", b"-9", b"99", b"4294967297", b"1.5", b"9" * 25])
@pytest.mark.parametrize(
    ("name", "text", "old"),
    [
        ("car.obj", OBJ_TEXT, b"f -1 -3 2"),
        ("car.ply", PLY_TEXT, b"3 0 1 2\n"),
        ("car.vtk", VTK_TEXT, b"3 1 4 2\n"),
    ],
)
def test_a_corner_is_the_number_of_a_node(
    tmp_path: Path, name: str, text: bytes, old: bytes, corner: bytes
) -> None:
    if corner == b"0" and name != "car.obj":
        pytest.skip("these count from 0")
    path = tmp_path / name
    assert text.count(old) == 1
    path.write_bytes(text.replace(old, old.rstrip()[:-1] + corner + old[len(old.rstrip()) :]))
    assert name in refusal(path)
