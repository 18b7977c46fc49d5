from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.formats import format_of, read_mesh
from autocolor.files.meshes import ply
from autocolor.files.meshes.ply import (
    Comments,
    is_scalar,
    named_in,
    ply_bytes,
    ply_polygons,
    property_of,
    read_ply,
    triangles_of_strips,
)
from autocolor.files.meshes.ply_elements import Column, ElementRows, Lists
from autocolor.files.meshes.repair import MeshReport, Placement, RawPolygons
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MeshScalar
from tests.autocolor.files.meshes.written import COORDINATES, assert_equal, writable_meshes
from tests.autocolor.files.refusals import is_read_or_refused
from tests.tables import refused

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


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("number", TYPES)
def test_a_cube_is_read_in_any_types(path: Path, order: str, number: str) -> None:
    for corner in (name for name in TYPES if name != "double"):
        mesh = read(path, cube(order, number, corner)).mesh
        assert [tuple(node) for node in mesh.coordinates.tolist()] == NODES, corner
        assert [tuple(quad) for quad in mesh.node_numbers.tolist()] == QUADS
        assert mesh.part_names == ("cube",)
        assert [(scalar.name, scalar.of, scalar.values.tolist()) for scalar in mesh.scalars] == [
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
    data = CUBES[0].replace(b"4 1 5 7 3", b"4 1 1 1 3")
    assert read(path, data + b"1 2 3\n").repairs == (
        "cube.ply: skipped lines after the last element: 1",
        "cube.ply: 1 polygon with fewer than three different corners was dropped",
    )


@pytest.mark.parametrize("data", CUBES)
def test_a_file_cut_short_anywhere_is_refused(path: Path, data: bytes) -> None:
    text = data.startswith(b"ply\nformat ascii")
    for length in range(0, len(data) - text, 7):
        # In text, the last number may lose a digit.
        with pytest.raises(InputError):
            read(path, data[:length])


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


NONE = Comments({}, {})
SQUARE = {"x": [0, 1, 1, 0], "y": [0, 0, 1, 1], "z": [0, 0, 0, 0]}


def lists(*rows: list[float], dtype: str = "i4") -> Lists:
    flat = np.array([number for row in rows for number in row], dtype)
    return Lists(flat, np.array([len(row) for row in rows], np.intp))


def rows(name: str, columns: dict[str, Any]) -> ElementRows:
    found: dict[str, Column] = {
        key: each if isinstance(each, Lists) else np.array(each) for key, each in columns.items()
    }
    first = next(iter(found.values()), np.empty(0))
    count = len(first.counts) if isinstance(first, Lists) else len(first)
    return ElementRows(count, found, lambda row: f"a.ply, {name} {row}")


def polygons_of(
    comments: Comments = NONE, vertex: dict[str, Any] = SQUARE, **elements: dict[str, Any]
) -> tuple[RawPolygons, list[str]]:
    tables = {name: rows(name, columns) for name, columns in {"vertex": vertex, **elements}.items()}
    return ply_polygons(tables, comments, "a.ply", "a")


def scalars(polygons: RawPolygons) -> list[tuple[str, str, list[float]]]:
    def shown(scalar: MeshScalar) -> list[float]:
        values: list[float] = np.where(np.isnan(scalar.values), -9, scalar.values).tolist()
        return values

    return [(each.name, each.of, shown(each)) for each in polygons.scalars]


@pytest.mark.parametrize("name", ["vertex_indices", "vertex_index"])
@pytest.mark.parametrize("dtype", ["u1", ">u4", "i8", "f8"])
def test_faces_are_polygons(name: str, dtype: str) -> None:
    edges: dict[str, Any] = {"edge": {"vertex1": [0, 1]}, "none": {}}
    polygons, messages = polygons_of(face={name: lists([0, 1, 2, 3], [2, 1, 0], dtype=dtype)}, **edges)
    assert polygons.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert polygons.corners.tolist() == [0, 1, 2, 3, 2, 1, 0]
    assert polygons.corner_counts.tolist() == [4, 3]
    assert (polygons.part_names, polygons.part_numbers.tolist()) == (("a",), [0, 0])
    assert messages == ["skipped elements 'edge': 2"]


def test_strips_are_polygons_where_there_are_no_faces() -> None:
    strips = {"vertex_indices": lists([0, 1, 3, 2, -1])}
    polygons, messages = polygons_of(tristrips=strips)
    assert polygons.corners.tolist() == [0, 1, 3, 3, 1, 2]
    assert messages == []
    polygons, messages = polygons_of(tristrips=strips, face={"vertex_indices": lists([0, 1, 2])})
    assert polygons.corners.tolist() == [0, 1, 2]
    assert messages == ["skipped elements 'tristrips': 1"]


def test_other_numbers_are_scalars_and_those_too_large_are_missing() -> None:
    vertex = {
        **SQUARE,
        "nx": [1, 1, 1, 1],
        "red": [9, 9, 9, 9],
        "stress": [1.5, np.inf, np.nan, 1e31],
        "of": lists([], [], [], []),
    }
    face = {"vertex_indices": lists([0, 1, 2]), "quality": np.array([7], "u1"), "stress": [5]}
    polygons, messages = polygons_of(vertex=vertex, face=face)
    assert scalars(polygons) == [
        ("stress", "node", [1.5, -9, -9, -9]),
        ("quality", "polygon", [7]),
        ("stress of polygons", "polygon", [5]),
    ]
    assert messages == ["scalar 'stress': 2 values above 1e30 in size were made missing"]


def test_comments_name_scalars() -> None:
    face = {"vertex_indices": lists([0, 1, 2]), "value_0": [1.0], "red": [2.0]}
    polygons, _ = polygons_of(Comments({}, {"value_0": "von Mises", "red": "red"}), face=face)
    assert [name for name, _, _ in scalars(polygons)] == ["von Mises", "red"]


@pytest.mark.parametrize("name", ["part", "material_index", "group"])
def test_a_number_of_faces_divides_them_into_parts(name: str) -> None:
    face = {"vertex_indices": lists([0, 1, 2], [0, 2, 3], [1, 2, 3]), name: np.array([7, -1, 7], "i1")}
    polygons, _ = polygons_of(face=face)
    assert polygons.part_names == (f"{name} -1", f"{name} 7")
    assert polygons.part_numbers.tolist() == [1, 0, 1]
    assert polygons.scalars == ()


@pytest.mark.parametrize(
    ("names", "numbers", "part_names", "part_numbers"),
    [
        ({0: "hood"}, {}, ("hood",), [0, 0]),
        ({0: "hood", 2: "roof", 3: "roof"}, {"part": [2, 5]}, ("hood", "roof", "roof 2", "part 5"), [1, 3]),
        ({}, {"group": [3, 4], "part": [4, 4]}, ("part 4",), [0, 0]),
        ({3: "hood"}, {"group": [3, 3]}, ("group 3",), [0, 0]),
    ],
)
def test_the_first_number_of_faces_and_comments_make_the_parts(
    names: dict[int, str], numbers: dict[str, Any], part_names: tuple[str, ...], part_numbers: list[int]
) -> None:
    face = {"vertex_indices": lists([0, 1, 2], [0, 2, 3]), **numbers}
    polygons, _ = polygons_of(Comments(names, {}), face=face)
    assert polygons.part_names == part_names
    assert polygons.part_numbers.tolist() == part_numbers
    assert len(polygons.scalars) == max(len(numbers) - 1, 0)


def test_numbers_that_are_no_parts_are_scalars(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ply, "MOST_UNNAMED_PARTS", 1)
    corners = lists([0, 1, 2], [0, 2, 3])
    for values in ([1, 2], [0.5, 0.5], [np.nan, 1], [1e300, 1e300]):
        polygons, _ = polygons_of(face={"vertex_indices": corners, "part": values})
        assert polygons.part_names == ("a",)
        assert len(polygons.scalars) == 1
    polygons, _ = polygons_of(
        Comments({1: "one", 2: "two"}, {}), face={"vertex_indices": corners, "part": [1, 2]}
    )
    assert polygons.part_names == ("one", "two")


LACKS = "a.ply: an element {!r} must have {}, not {}; export it with {}"
AXES = "the properties x, y and z"
LIST = "a list 'vertex_indices'"
LARGE = "a coordinate must be a finite number of at most 1e30 in size"
CORNER = "a corner must be a node number"

test_what_is_refused = refused(
    lambda elements: polygons_of(NONE, **elements),
    [
        ({"vertex": {"x": [1], "y": [2]}}, LACKS.format("vertex", AXES, "only x and y", "coordinates")),
        ({"vertex": {}}, LACKS.format("vertex", AXES, "none", "coordinates")),
        (
            {"vertex": {"x": lists([1]), "y": [2], "z": [3]}},
            LACKS.format("vertex", AXES, "only x, y and z", "coordinates"),
        ),
        (
            {"vertex": {**SQUARE, "y": [0, np.nan, -np.inf, 1e31]}},
            f"a.ply, vertex 1: {LARGE}, not nan; correct it\n"
            f"a.ply, vertex 2: {LARGE}, not -inf; correct it\n"
            f"a.ply, vertex 3: {LARGE}, not 1e+31; correct it",
        ),
        ({"face": {"quality": [1]}}, LACKS.format("face", LIST, "only quality", "polygons")),
        ({"face": {"vertex_indices": [1]}}, LACKS.format("face", LIST, "only vertex_indices", "polygons")),
        (
            {"face": {"vertex_indices": lists([0, 1, 2], [0, 4, -1, 3], [2, 1, -3])}},
            f"a.ply, face 1: {CORNER} from 0 to 3, not 4; correct it\n"
            f"a.ply, face 2: {CORNER} from 0 to 3, not -3; correct it",
        ),
        (
            {"face": {"vertex_indices": lists([0, 1, 2**64 - 1], dtype="u8")}},
            f"a.ply, face 0: {CORNER} from 0 to 3, not 1.84467440737096e+19; correct it",
        ),
        (
            {"face": {"vertex_indices": lists([0, 1.5, np.nan], dtype="f4")}},
            f"a.ply, face 0: {CORNER} from 0 to 3, not 1.5; correct it",
        ),
        (
            {"vertex": {"x": [], "y": [], "z": []}, "face": {"vertex_indices": lists([0, 1, 2])}},
            f"a.ply, face 0: {CORNER} of the file, which has no nodes, not 0; correct it",
        ),
        (
            {"face": {"vertex_indices": lists([0] * 1000, [0] * 1001)}},
            "a.ply, face 1: a polygon must have at most 1,000 corners, not 1,001; split it",
        ),
        (
            {"tristrips": {"vertex_indices": lists([0, 1, 2, -2])}},
            f"a.ply, tristrips 0: {CORNER} from -1 to 3, not -2; correct it",
        ),
    ],
)


def triangles(lists: list[list[int]]) -> list[list[int]]:
    numbers = np.array([number for each in lists for number in each], np.intp)
    counts = np.array([len(each) for each in lists], np.intp)
    corners, sides = triangles_of_strips(numbers, counts)
    assert (sides == 3).all()
    return corners.reshape(len(sides), 3).tolist()


@given(lists=st.lists(st.lists(st.integers(-1, 5), max_size=12), max_size=4))
def test_triangles_are_those_of_one_strip_after_the_other(lists: list[list[int]]) -> None:
    expected = []
    for each in lists:
        strip: list[int] = []
        for number in [*each, -1]:
            if number >= 0:
                strip.append(number)
                continue
            for at in range(len(strip) - 2):
                a, b, c = strip[at : at + 3]
                if len({a, b, c}) == 3:
                    expected.append([b, a, c] if at % 2 else [a, b, c])
            strip = []
    assert triangles(lists) == expected


def test_comments_name_parts_and_scalars() -> None:
    comments = (
        "part 0 hood",
        "part 12 left door",
        "scalar value_0 von Mises",
        "part x",
        "scalar a",
        "part 0 b",
    )
    assert named_in(comments) == Comments({0: "hood", 12: "left door"}, {"value_0": "von Mises"})


@pytest.mark.parametrize("name", ["x", "nx", "red", "diffuse_green", "alpha", "s", "texture_u", "texnumber"])
def test_coordinates_normals_colors_and_texture_coordinates_are_no_scalars(name: str) -> None:
    assert not is_scalar(name, NONE)
    assert is_scalar(name, Comments({}, {name: "of it"}))
    assert is_scalar(f"{name}_of_it", NONE)


@pytest.mark.parametrize(
    ("scalar", "name"),
    [
        ("stress", "stress"), ("von Mises", "value_3"), ("x", "value_3"), ("red", "value_3"),
        ("part", "value_3"), ("value_0", "value_3"), ("größe", "value_3"), ("vertex_index", "value_3"),
    ],
)  # fmt: skip
def test_a_scalar_is_written_under_its_name_where_that_is_free(scalar: str, name: str) -> None:
    assert property_of(scalar, 3) == name


@given(mesh=writable_meshes(), at_once=st.sampled_from([1, 3, 1 << 16]))
def test_what_is_written_reads_back_equal(
    mesh: Mesh, at_once: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(ply, "ROWS_AT_ONCE", at_once)
        data = ply_bytes(mesh)
    assert_equal(read(tmp_path_factory.getbasetemp() / "written.ply", data), mesh)


def test_a_mesh_of_one_part_is_written_as_other_programs_do(tmp_path: Path) -> None:
    mesh = Mesh(COORDINATES[:3], np.array([[0, 1, 2]]), part_names=("hood\n",))
    header, _, data = ply_bytes(mesh).partition(b"end_header\n")
    assert header.decode().splitlines() == [
        "ply",
        "format binary_little_endian 1.0",
        "comment written by autocolor",
        "comment part 0 hood?",
        "element vertex 3",
        "property double x",
        "property double y",
        "property double z",
        "element face 1",
        "property list uchar int vertex_indices",
    ]
    assert data == COORDINATES[:3].astype("<f8").tobytes() + b"\3" + np.array([0, 1, 2], "<i4").tobytes()
