from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError, MissingInputError
from autocolor.files.meshes.formats import format_of
from autocolor.files.meshes.stl import stl_file as stl_file_module
from autocolor.files.meshes.stl.binary import TRIANGLE
from autocolor.files.meshes.stl.stl_file import read_stl
from autocolor.files.repair.placement import Placement
from autocolor.files.repair.polygons import MeshReport
from tests.autocolor.files.meshes.mutations import changes

NODES = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CUBE = NODES[[corners for a, b, c, d in QUADS for corners in ((a, b, c), (a, c, d))]]


def binary(corners: object = CUBE, begin: bytes = b"") -> bytes:
    table = np.zeros(len(np.asarray(corners)), TRIANGLE)
    table["corners"] = corners
    return begin.ljust(80, b"\0") + len(table).to_bytes(4, "little") + table.tobytes()


def text(name: str = "cube", corners: object = CUBE, feed: str = "\n") -> bytes:
    lines = [f"solid {name}"]
    for triangle in np.asarray(corners).tolist():
        points = [f"   vertex {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines += [" facet normal 0 0 1", "  outer loop", *points, "  endloop", " endfacet"]
    return "".join(line + feed for line in [*lines, f"endsolid {name}"]).encode()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "cube.stl"


def read(path: Path, data: bytes, up: str = "z") -> MeshReport:
    path.write_bytes(data)
    return read_stl(path, Placement(up))


def refusal(path: Path, data: bytes) -> str:
    with pytest.raises(InputError) as caught:
        read(path, data)
    return str(caught.value)


def is_read_or_refused(path: Path, data: bytes) -> bool:
    begin = time.perf_counter()
    try:
        mesh = read(path, data).mesh
        sound = np.isfinite(mesh.coordinates).all() and mesh.node_numbers.max() < len(mesh.coordinates)
    except InputError as error:
        sound = all(problem.startswith(path.name) for problem in error.problems)
    return bool(sound) and time.perf_counter() - begin < 2


@pytest.mark.parametrize(
    "data",
    [
        binary(),
        binary(begin=b"solid cube"),
        text(),
        text(feed="\r\n"),
        text(feed="\r"),
        b"\xef\xbb\xbf" + text(),
    ],
)
def test_a_cube_has_eight_nodes_however_it_is_written(path: Path, data: bytes) -> None:
    report = read(path, data)
    mesh = report.mesh
    assert sorted(map(tuple, mesh.coordinates.tolist())) == sorted(map(tuple, NODES.tolist()))
    assert np.array_equal(mesh.coordinates[mesh.node_numbers[:, :3]], CUBE)
    assert (mesh.triangle_count, mesh.edge_count) == (12, 18)
    assert mesh.part_names == ("cube",)
    assert report.repairs == ()


def test_solids_are_parts_with_different_names(path: Path) -> None:
    data = b"".join(
        text(name, CUBE[at : at + 3]) for at, name in ((0, "hood"), (3, ""), (6, "hood"), (9, ""))
    )
    mesh = read(path, data).mesh
    assert mesh.part_names == ("hood", "cube", "hood 2", "cube 2")
    assert mesh.part_numbers.tolist() == [0] * 3 + [1] * 3 + [2] * 3 + [3] * 3
    assert len(mesh.coordinates) == 8


def test_triangles_without_area_are_dropped_and_counted(path: Path) -> None:
    flat = [NODES[[0, 0, 1]], [[0, 0, 0], [1, 0, 0], [2, -0.0, 0]]]
    assert read(path, binary([*CUBE, *flat])).repairs == (
        "cube.stl: 1 polygon with fewer than three different corners was dropped",
        "cube.stl: 1 polygon without area was dropped",
    )


def test_what_is_skipped_stands_in_the_report(path: Path) -> None:
    assert read(path, binary() + b"123").repairs == ("cube.stl: skipped bytes after the last triangle: 3",)
    assert read(path, text().replace(b"endsolid cube", b"")).repairs == (
        "cube.stl: the last solid has no 'endsolid': the file may be cut short",
    )


def test_the_files_up_axis_becomes_z(path: Path) -> None:
    assert read(path, binary([[[0, 0, 0], [1, 2, 3], [0, 1, 0]]]), up="y").mesh.coordinates[1].tolist() == [
        1,
        -3,
        2,
    ]


def test_a_text_of_another_name_is_known_by_how_it_begins(tmp_path: Path) -> None:
    path = tmp_path / "cube.model"
    path.write_bytes(text())
    found = format_of(path)
    assert found is not None
    assert found.name == "STL"
    path.write_bytes(b"solid ground\n")
    assert format_of(path) is None


def test_a_file_without_triangles_is_refused(path: Path) -> None:
    for data in (binary(np.empty((0, 3, 3))), text(corners=[])):
        assert refusal(path, data) == "cube.stl: a mesh must have a polygon with area, not none; add polygons"


def test_other_encodings_are_refused(path: Path) -> None:
    assert refusal(path, text().decode().encode("utf-16")) == (
        "cube.stl: an ascii STL file must be text in UTF-8, not UTF-16; save it as UTF-8"
    )
    assert refusal(path, text() + b"\0") == (
        "cube.stl: an ascii STL file must be text, not hold a NUL byte (line 87); save it as UTF-8 text"
    )
    assert refusal(path, b"") == (
        "cube.stl: a binary STL file must have at least 84 bytes, not 0; it is cut short, export it again"
    )


def test_a_file_that_is_missing_or_too_large_is_refused(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(MissingInputError):
        read_stl(path)
    monkeypatch.setattr(stl_file_module, "LARGEST_MESH_FILE", 600)
    assert refusal(path, text()) == (
        "cube.stl: an ascii STL file must have at most 600 bytes, not more; export it as binary"
    )
    assert len(read(path, binary()).mesh.node_numbers) == 12
    monkeypatch.setattr(stl_file_module, "LARGEST_BINARY_MESH_FILE", 600)
    assert refusal(path, binary()) == (
        "cube.stl: a file must have at most 600 bytes, not more; split or simplify it"
    )


def test_a_binary_file_cut_short_anywhere_is_refused(path: Path) -> None:
    data = binary(begin=b"solid cube")
    for length in range(len(data)):
        assert refusal(path, data[:length]).startswith("cube.stl: ")


def test_a_text_cut_short_anywhere_is_refused_or_told(path: Path) -> None:
    data = text(corners=CUBE[:2])
    for length in range(data.rindex(b"endsolid") + len("endsolid")):
        try:
            told: tuple[str, ...] = read(path, data[:length]).repairs
        except InputError as error:
            told = error.problems
        assert told[0].startswith("cube.stl")


@pytest.mark.parametrize("data", [binary(), binary(begin=b"solid"), text()])
def test_two_hundred_mutations_are_read_or_refused(path: Path, data: bytes) -> None:
    for changed in changes(data):
        assert is_read_or_refused(path, changed)


@given(data=st.binary(max_size=150) | st.text("solidenfacrumvtxp 01.-\n", max_size=150).map(str.encode))
def test_any_bytes_are_read_or_refused(data: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.getbasetemp() / "any.stl"
    assert is_read_or_refused(path, data)
    assert is_read_or_refused(path, b"solid a\n" + data)
