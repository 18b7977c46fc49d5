"""The process in which libraries read files, and the check of the mesh that comes back."""

from __future__ import annotations

import importlib.util
import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.budget import MEMORY, allowing
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError, UnavailableError
from autocolor.files.array_file import array_file_bytes
from autocolor.files.formats import format_of, read_mesh
from autocolor.files.meshes import foreign
from autocolor.files.meshes.foreign import (
    FOREIGN,
    RESULT,
    foreign_mesh_bytes,
    largest_result,
    most_memory,
    most_seconds,
    read_foreign_mesh,
    read_in_own_process,
    size_of_3mf,
)
from autocolor.files.meshes.foreign_mesh import ForeignMesh
from autocolor.files.meshes.repair import RawPolygons
from tests.autocolor.files.meshes.conftest import OWN
from tests.autocolor.files.refusals import refusal

SIZE = 10_000
"""The size of a file that limits are for."""

CANNOT = "a.glb: fake must be able to read it, and cannot ({}); correct the file, or write it as OBJ or PLY"
MUST = "a.glb: fake must read it, and {}; correct the file, or write it as OBJ or PLY"


def write(folder: Path, name: str, data: bytes) -> Path:
    (folder / name).write_bytes(data)
    return folder / name


def read(folder: Path, body: str, starting: float = 30, command: list[str] = OWN) -> tuple[str, ...]:
    """The names of the parts of the mesh that a library gives, which runs some lines."""
    path = write(folder, "a.glb", body.encode())
    return read_in_own_process("fake", "fake", "glb", path, SIZE, command, starting).polygons.part_names


def test_a_mesh_comes_back_and_what_a_library_prints_goes_nowhere(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    body = "import os; print('noise' * 100000); os.write(2, b'noise'); os.write(1, b'noise')"
    assert read(tmp_path, body) == ("p",)
    assert capfd.readouterr() == ("", "")


@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("raise ValueError('no\\nnodes')", CANNOT.format("ValueError: no nodes")),
        ("raise ForeignRefusal('a cell must be flat', 'bend it')", "a.glb: a cell must be flat; bend it"),
        ("import sys; sys.exit(2)", CANNOT.format("SystemExit: 2")),
        ("mesh = None", CANNOT.format("AttributeError: 'NoneType' object has no attribute 'polygons'")),
        ("def f(f): f(f)\nf(f)", CANNOT.format("RecursionError: maximum recursion depth exceeded")),
        ("import os; os._exit(0)", MUST.format("ended without a mesh")),
        ("import os; os._exit(7)", MUST.format("ended with code 7")),
        ("import os; os.write(2, b'one\\n\\x1b[31m2 s f.cxx:7 ERR| vtkFoo (0x1f): two\\n'); os.abort()",
         MUST.format("was ended by SIGABRT (two)")),
        ("import signal; signal.raise_signal(40)", MUST.format("was ended by signal 40")),
        ("import socket; socket.socket()", CANNOT.format("PermissionError: socket.__new__ is not allowed")),
        ("mesh = ForeignMesh(RawPolygons(np.zeros((6000000, 3)), *[np.arange(0)] * 3, ()))",
         CANNOT.format("its mesh is larger than its size and --limit allow")),
    ],
    ids=lambda text: text[:30],
)  # fmt: skip
def test_a_library_may_fail_in_any_way(tmp_path: Path, body: str, sentence: str) -> None:
    assert refusal(read, tmp_path, body) == sentence


@pytest.mark.parametrize(
    ("body", "starting"),
    [("while True: pass", 30), ("import time; time.sleep(100)", -11)],
    ids=["busy", "idle"],
)
def test_a_library_that_hangs_is_ended(tmp_path: Path, body: str, starting: float) -> None:
    assert refusal(read, tmp_path, body, starting) == (
        "a.glb: fake must read it within 6 seconds, for its size, and did not; write it as OBJ or PLY,"
        " or allow more with --limit (limit= in Python)"
    )


def test_a_library_that_eats_memory_is_refused_it(tmp_path: Path) -> None:
    assert refusal(read, tmp_path, "mesh = [bytes(1 << 20) for _ in range(5000)]") == CANNOT.format(
        "it needs more memory than its size and --limit allow"
    )


def test_a_command_that_is_not_there_is_told(tmp_path: Path) -> None:
    sentence = refusal(read, tmp_path, "", 30, [str(tmp_path / "none")])
    assert sentence.startswith("the process of a reader cannot be started ")


def test_limits_grow_with_the_size_of_the_file() -> None:
    assert (most_seconds(0), most_memory(0), largest_result(0)) == (6, 1 << 30, 128 << 20)
    assert most_seconds(10 << 20) == 26
    assert most_memory(10 << 20) == (1 << 30) + (600 << 20)
    assert largest_result(1 << 20) == 158 << 20
    assert most_memory(1 << 40) == (1 << 30) + MEMORY
    with allowing(3):
        assert (most_seconds(0), most_memory(1 << 40)) == (18, (1 << 30) + 3 * MEMORY)
    with allowing(0.5):
        assert (most_seconds(0), most_memory(1 << 40)) == (6, (1 << 30) + MEMORY // 2)


# The mesh that comes back is checked like a file.

NODES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])

HEADER = {"part_names": ["p"], "mesh_scalars": [], "sentences": [], "material_of_part": {}, "colors": {}}
ARRAYS: dict[str, Any] = {
    "coordinates": NODES,
    "corners": [0, 1, 2],
    "corner_counts": [3],
    "part_numbers": [0],
    "normals": np.zeros((0, 3)),
    "corner_normals": [],
}


def result(folder: Path, data: bytes) -> ForeignMesh:
    return read_foreign_mesh(write(folder, "result.npz", data), "a.glb", "VTK")


FAR = "a node whose coordinates are not finite and at most 1e30 in size, "
TOO_FAR = [[0, 0, 0], [0, np.nextafter(1e30, np.inf), 0]]
ABSENT = "normals of corners that are not there"


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"coordinates": np.full((4, 3), np.nan)}, f"{FAR}[nan, nan, nan] (node 1)"),
        ({"coordinates": TOO_FAR}, f"{FAR}[0.0, 1.0000000000000002e+30, 0.0] (node 2)"),
        ({"coordinates": np.zeros((4, 2))}, "nodes of 2 coordinates, not three"),
        ({"corners": [0, 1, 4]}, "a polygon with the node 5, which must be from 1 to 4"),
        ({"corners": [0, 1, -1]}, "a polygon with the node 0, which must be from 1 to 4"),
        ({"corner_counts": [4]}, "polygons without all of their corners"),
        ({"corner_counts": [-1, 4], "part_numbers": [0, 0]}, "polygons without all of their corners"),
        ({"part_numbers": [1]}, "polygons of parts that are not there"),
        ({"part_numbers": [-1]}, "polygons of parts that are not there"),
        ({"part_numbers": [0, 0]}, "polygons of parts that are not there"),
        ({"corner_normals": [0, 0, 0]}, ABSENT),
        ({"corner_normals": [-2, 0, 0], "normals": NODES}, ABSENT),
        ({"corner_normals": [-1, 0, 0], "normals": NODES[:, :2]}, ABSENT),
        ({"corner_normals": [-1, 0], "normals": NODES}, "normals for some corners only"),
        ({"mesh_scalars": [{"name": "s", "of": "node"}], "mesh_scalar_0": [1.0]},
         "a scalar without a value for each node"),
        ({"mesh_scalars": [{"name": "s", "of": "polygon"}], "mesh_scalar_0": [np.inf]}, "no mesh ("
         "scalar 's': a value must be at most 1e30 in size, or NaN if it is missing, not inf (row 0))"),
    ],
)  # fmt: skip
def test_nothing_is_believed(tmp_path: Path, changes: dict[str, Any], rule: str) -> None:
    header = {key: changes.get(key, value) for key, value in HEADER.items()}
    arrays = {key: np.asarray(value) for key, value in {**ARRAYS, **changes}.items() if key not in HEADER}
    assert refusal(result, tmp_path, array_file_bytes(RESULT, header, arrays)) == (
        f"a.glb: VTK gave {rule}; correct the file, or write it as OBJ or PLY"
    )


def test_a_coordinate_may_be_the_largest(tmp_path: Path) -> None:
    for value in (LARGEST_COORDINATE, -LARGEST_COORDINATE):
        data = array_file_bytes(RESULT, HEADER, {**ARRAYS, "coordinates": np.full((4, 3), value)})
        assert np.all(result(tmp_path, data).polygons.coordinates == value)


@pytest.mark.parametrize(
    "data", [b"", b"PK", b"\x80\x04N.", array_file_bytes(RESULT, HEADER, {**ARRAYS})[:-30]]
)
def test_what_is_no_result_is_refused(tmp_path: Path, data: bytes) -> None:
    assert refusal(result, tmp_path, data).startswith("a.glb: VTK gave no mesh ")


def test_normals_come_back_and_broken_ones_are_missing(tmp_path: Path) -> None:
    normals = np.array([[0, 0, 2.0], [np.nan, 0, 1], [0, 0, 0], [np.inf, 0, 0]])
    for rows, back in (([0, 1, 2], [0, -1, -1]), ([-1, 3, 0], [-1, -1, 0]), ([1, 2, 3], None)):
        mesh = RawPolygons(
            NODES, np.arange(3), np.array([3]), np.array([0]), ("p",), (), str, normals, np.array(rows)
        )
        polygons = result(tmp_path, foreign_mesh_bytes(ForeignMesh(mesh))).polygons
        found = polygons.corner_normals
        assert (None if found is None else found.tolist()) == back
        assert (polygons.normals is None) == (back is None)


# The formats.


@pytest.mark.parametrize(
    ("name", "head", "told", "extra"),
    [
        ("a.vtu", b"<VTKFile>", "VTK XML files, the library VTK", "vtk"),
        ("a.glb", b"glTF\2\0\0\0\x16\0\0\0\2\0\0\0JSON{}", "glTF files, the library VTK", "vtk"),
        ("a.3mf", b"PK\5\6" + bytes(18), "3MF files, the library lib3mf", "meshes"),
        ("a.inp", b"*NODE", "Abaqus files, the library meshio", "meshes"),
    ],
)
def test_a_missing_package_is_told_with_what_installs_it(
    tmp_path: Path, name: str, head: bytes, told: str, extra: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match="there is no such file or folder"):
        read_mesh({"file": tmp_path / name})
    write(tmp_path, name, head)
    with pytest.raises(UnavailableError) as caught:
        read_mesh({"file": tmp_path / name})
    assert caught.value.exit_code == 69
    assert str(caught.value) == (
        f'{name}: to read {told} must be installed; run: pip install "autocolor[{extra}]"'
    )


def test_files_of_vtk_and_gltf_are_known_by_how_they_begin(tmp_path: Path) -> None:
    for head, name in (
        (b"# vtk DataFile Version 3.0\n", "VTK"),
        (b'<?xml version="1.0"?>\n<!-- by hand -->\n<VTKFile type="PolyData">', "VTK XML"),
        (b"glTF\2\0\0\0", "glTF"),
    ):
        found = format_of(write(tmp_path, "a.model", head))
        assert found is not None
        assert found.name == name
    assert {each.module for each in FOREIGN} == {"vtk", "gltf", "3mf", "meshio"}


def archive(*members: bytes) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as opened:
        for number, data in enumerate(members):
            opened.writestr(f"{number}.model", data)
    return packed.getvalue()


@pytest.mark.parametrize("more", [-1, 0, 1])
def test_archives_have_limited_sizes(tmp_path: Path, more: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foreign, "MOST_MEMBERS", 3)
    members = write(tmp_path, "members.3mf", archive(*[b"<model/>"] * (3 + more)))
    data = archive(b"<model/>")
    size = 200 * len(data) + more
    # The size of the unpacked file stands in the directory, behind the size of the packed file.
    at = data.index(b"PK\1\2") + 24
    growing = write(tmp_path, "a.3mf", data[:at] + size.to_bytes(4, "little") + data[at + 4 :])
    if more <= 0:
        assert size_of_3mf(members) == members.stat().st_size
        assert size_of_3mf(growing) == size
        return
    assert f"at most 3 files and {200 * members.stat().st_size:,} bytes, not 4 and 32;" in refusal(
        size_of_3mf, members
    )
    assert f" files and {size - 1:,} bytes, not 1 and {size:,};" in refusal(size_of_3mf, growing)


def test_what_is_no_archive_is_refused(tmp_path: Path) -> None:
    assert refusal(size_of_3mf, write(tmp_path, "a.3mf", b"PK")) == (
        "a.3mf: a 3MF file must be a whole ZIP archive, not damaged (File is not a zip file); write it again"
    )
