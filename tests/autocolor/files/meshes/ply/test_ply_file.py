from __future__ import annotations

import struct
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError, MissingInputError
from autocolor.files.meshes.formats import format_of, read_mesh
from autocolor.files.meshes.ply import ply_file as ply_file_module
from autocolor.files.meshes.ply.ply_file import read_ply
from autocolor.files.repair.placement import Placement
from autocolor.files.repair.polygons import MeshReport
from tests.autocolor.files.meshes.mutations import changes

NODES = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
TYPES = {"char": "b", "uint8": "B", "short": "h", "uint16": "H", "int": "i", "uint": "I", "double": "d"}


def cube(order: str = "", number: str = "double", corner: str = "int", feed: str = "\n") -> bytes:
    """A cube with the stress x + y at its nodes, and the quality of its quads before their corners."""
    name = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    lines = [
        "ply", f"format {name} 1.0", "element vertex 8",
        *(f"property {number} {axis}" for axis in "zyx"), "property short stress",
        "element face 6", "property uchar quality",
        f"property list uchar {corner} vertex_indices", "end_header",
    ]  # fmt: skip
    rows: list[tuple[str, tuple[int, ...]]] = [
        (TYPES[number] * 3 + "h", (z, y, x, x + y)) for x, y, z in NODES
    ]
    rows += [("BB" + TYPES[corner] * 4, (at, 4, *quad)) for at, quad in enumerate(QUADS)]
    header = "".join(line + feed for line in lines).encode()
    if order:
        return header + b"".join(struct.pack(order + code, *values) for code, values in rows)
    return header + "".join(" ".join(map(str, values)) + feed for _, values in rows).encode()


CUBES = [cube(order) for order in ("", "<", ">")]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "cube.ply"


def read(path: Path, data: bytes, up: str = "z") -> MeshReport:
    path.write_bytes(data)
    return read_ply(path, Placement(up))


def is_read_or_refused(path: Path, data: bytes) -> bool:
    begin = time.perf_counter()
    try:
        mesh = read(path, data).mesh
        sound = np.isfinite(mesh.coordinates).all() and mesh.node_numbers.max() < len(mesh.coordinates)
    except InputError as error:
        sound = all(problem.startswith(path.name) for problem in error.problems)
    return bool(sound) and time.perf_counter() - begin < 2


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("number", TYPES)
@pytest.mark.parametrize("corner", [name for name in TYPES if name != "double"])
def test_a_cube_is_read_in_any_types(path: Path, order: str, number: str, corner: str) -> None:
    mesh = read(path, cube(order, number, corner)).mesh
    assert [tuple(node) for node in mesh.coordinates.tolist()] == NODES
    assert [tuple(quad) for quad in mesh.node_numbers.tolist()] == QUADS
    assert mesh.part_names == ("cube",)
    assert [(each.name, each.of, each.values.tolist()) for each in mesh.scalars] == [
        ("stress", "node", [x + y for x, y, _ in NODES]),
        ("quality", "polygon", [0, 1, 2, 3, 4, 5]),
    ]


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("feed", ["\n", "\r\n", "\r"])
def test_lines_end_in_any_way(path: Path, order: str, feed: str) -> None:
    assert len(read(path, cube(order, feed=feed)).mesh.node_numbers) == 6


def test_the_files_up_axis_becomes_z(path: Path) -> None:
    assert read(path, CUBES[1], up="y").mesh.coordinates[1].tolist() == [0, -1, 0]


def test_a_file_of_another_name_is_known_by_how_it_begins(tmp_path: Path) -> None:
    path = tmp_path / "cube.model"
    path.write_bytes(CUBES[0])
    found = format_of(path)
    assert found is not None
    assert found.name == "PLY"
    assert len(read_mesh({"file": path}).mesh.node_numbers) == 6


def test_what_is_skipped_and_repaired_stands_in_the_report(path: Path) -> None:
    data = CUBES[0].replace(b"4 1 5 7 3", b"4 1 1 1 3") + b"what is this\n"
    assert b"what" in data
    with pytest.raises(InputError):
        read(path, data)
    assert read(path, data.replace(b"what is this", b"1 2 3")).repairs == (
        "cube.ply: skipped lines after the last element: 1",
        "cube.ply: 1 polygon with fewer than three different corners was dropped",
    )


def test_a_file_without_polygons_is_refused(path: Path) -> None:
    header = b"ply\nformat ascii 1.0\nelement vertex 1\n"
    header += b"property int x\nproperty int y\nproperty int z\nend_header\n1 2 3\n"
    with pytest.raises(InputError) as refusal:
        read(path, header)
    assert str(refusal.value) == "cube.ply: a mesh must have a polygon with area, not none; add polygons"


def test_a_file_that_is_missing_or_too_large_is_refused(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(MissingInputError):
        read_ply(path)
    monkeypatch.setattr(ply_file_module, "LARGEST_MESH_FILE", 100)
    for data in (CUBES[0], CUBES[0].replace(b"format ascii", b"format  ascii")):
        with pytest.raises(InputError, match="at most 100 bytes, not more"):
            read(path, data)
    assert len(read(path, CUBES[1]).mesh.node_numbers) == 6
    monkeypatch.setattr(ply_file_module, "LARGEST_BINARY_MESH_FILE", 200)
    with pytest.raises(InputError, match="at most 200 bytes, not more"):
        read(path, CUBES[1])


@pytest.mark.parametrize("data", CUBES)
def test_a_file_cut_short_anywhere_is_refused(path: Path, data: bytes) -> None:
    text = data.startswith(b"ply\nformat ascii")
    for length in range(len(data) - text):
        # In text, the last number may lose a digit.
        with pytest.raises(InputError):
            read(path, data[:length])


@pytest.mark.parametrize("data", CUBES)
def test_two_hundred_mutations_are_read_or_refused(path: Path, data: bytes) -> None:
    for changed in changes(data):
        assert is_read_or_refused(path, changed)


@given(data=st.binary(max_size=60), order=st.sampled_from(["", "<", ">"]))
def test_any_bytes_after_a_header_are_read_or_refused(
    data: bytes, order: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.ply"
    header = (
        cube(order)
        .partition(b"end_header\n")[0]
        .replace(b"vertex 8", b"vertex 3")
        .replace(b"face 6", b"face 1")
    )
    assert is_read_or_refused(path, header + b"end_header\n" + data)
