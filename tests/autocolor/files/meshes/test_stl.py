from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Floats, Singles
from autocolor.files.meshes import stl
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.meshes.stl import (
    TRIANGLE,
    begins_as_stl,
    read_binary,
    read_stl,
    read_text,
    stl_bytes,
)
from autocolor.files.meshes.welding import welded
from autocolor.scene.mesh import Mesh
from tests.autocolor.files.refusals import refusal, refused

NODES = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
OF_QUADS = Mesh(NODES.astype(float), np.array(QUADS))
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


def read(path: Path, data: bytes) -> MeshReport:
    path.write_bytes(data)
    return read_stl(path)


@pytest.mark.parametrize("data", [binary(), binary(begin=b"solid cube"), text(), stl_bytes(OF_QUADS)])
def test_a_cube_has_eight_nodes_however_it_is_written(path: Path, data: bytes) -> None:
    report = read(path, data)
    mesh = report.mesh
    assert sorted(map(tuple, mesh.coordinates.tolist())) == sorted(map(tuple, NODES.tolist()))
    assert np.array_equal(mesh.coordinates[mesh.node_numbers[:, :3]], CUBE)
    assert (mesh.triangle_count, mesh.edge_count) == (12, 18)
    assert mesh.part_names == ("cube",)
    assert report.repairs == ()


@pytest.mark.parametrize("size", [1e-30, 1.0, 1e29])
def test_a_quad_is_cut_along_its_diagonal_and_normals_are_unit_vectors_or_zero(
    size: float,
) -> None:
    nodes = np.array([[0, 0, 0], [3, 0, 0], [4, 1, 0], [1, 1, 0], [0, 0, 5]]) * size
    mesh = Mesh(nodes, np.array([[0, 1, 2, 3], [1, 2, 4, 4], [0, 0, 1, 4]]))
    with np.errstate(all="raise"):
        records = np.frombuffer(stl_bytes(mesh), TRIANGLE, 4, 84)
    expected = nodes[[[1, 2, 3], [1, 3, 0], [1, 2, 4], [0, 1, 4]]].astype(np.float32)
    assert records["corners"].tolist() == expected.tolist()
    assert records["normal"][[0, 3]].tolist() == [[0, 0, 1], [0, -1, 0]]
    flat = stl_bytes(Mesh(nodes[[0, 1, 1]] * [[1], [1], [2]], np.array([[0, 1, 2]])))
    assert np.frombuffer(flat, TRIANGLE, 1, 84)["normal"].tolist() == [[0, 0, 0]]


def test_triangles_without_area_are_dropped_and_counted(path: Path) -> None:
    flat = [NODES[[0, 0, 1]], [[0, 0, 0], [1, 0, 0], [2, -0.0, 0]]]
    assert read(path, binary([*CUBE, *flat])).repairs == (
        "cube.stl: 1 polygon with fewer than three different corners was dropped",
        "cube.stl: 1 polygon without area was dropped",
        "cube.stl: 1 node that no polygon uses was dropped",
    )


def test_what_is_skipped_stands_in_the_report(path: Path) -> None:
    assert read(path, binary() + b"x" * 50).repairs == (
        "cube.stl: skipped bytes after the last triangle: 50",
    )


def test_other_texts_may_begin_with_solid() -> None:
    assert begins_as_stl(text())
    assert begins_as_stl(b"\n# made by hand\r\n; for a mill\nsolid a\ncolor 1 0 0\nfacet\n outer loop\n")
    assert not begins_as_stl(b"solid ground\n")
    assert not begins_as_stl(b"# a\n" * 1000)


SIZE = ": a binary STL file of {:,} triangles must have {:,} bytes, not {}"
LARGE = "a coordinate must be a finite number of at most 1e30 in size"

test_a_wrong_binary_file_is_refused = refused(
    "cube.stl",
    [
        (data, f"cube.stl{sentence}")
        for data, sentence in (
            (binary()[:83], f"{SIZE.format(12, 684, 83)}; export it again"),
            (
                bytes(80) + b"\xff" * 4,
                f"{SIZE.format(2**32 - 1, 84 + 50 * (2**32 - 1), 84)}; export it again",
            ),
            (binary(np.empty((0, 3, 3))), ": a mesh must have a polygon with area, not none; add polygons"),
            (binary([*CUBE[:1], np.full((3, 3), np.nan)]), f", facet 2: {LARGE}, not nan; correct it"),
        )
    ],
)


@pytest.mark.parametrize("sign", [-1, 1])
def test_a_coordinate_may_be_the_largest_and_no_larger(path: Path, sign: int) -> None:
    # The largest coordinate of a binary file is the float32 nearest to 1e30.
    most = np.float32(sign * 1e30)
    corners = CUBE[:2].copy()
    corners[1, 2, 0] = most
    assert read_binary(binary(corners), "a.stl")[0][5, 0] == most
    corners[1, 2, 0] = np.nextafter(most, np.float32(sign * np.inf))
    assert f"facet 2: {LARGE}" in refusal(read, path, binary(corners))
    solid = f"solid a\n{A}endsolid\n"
    assert read_text(solid.replace("1e0", f"{sign}e30").encode(), "a.stl", "a")[0][2, 1] == sign * 1e30
    larger = f"{sign}.0000000000000002e30"
    assert f"not '{larger}'" in refusal(read, path, solid.replace("1e0", larger).encode())


A = "facet normal nan 0 x\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n"
B = A.replace("vertex 0 0 0", "vertex -5 .5 +5.")


@pytest.fixture(params=[1, 1 << 21])
def _blocks(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Texts are read facet by facet, and at once."""
    monkeypatch.setattr(stl, "BLOCK", request.param)


@pytest.mark.usefixtures("_blocks")
def test_solids_of_a_text_are_parts(path: Path) -> None:
    text = (
        f"solid the hood\n{A}{B}endsolid the hood\n\nsolid\nendsolid\n  SOLID the hood\n{B.upper()}ENDSOLID\n"
    )
    report = read(
        path,
        (text + "solid\n" + A.replace("\n", " ").replace(" ", "\n\n \t") + f"endsolid\n{A}endsolid").encode(),
    )
    mesh = report.mesh
    assert mesh.part_names == ("the hood", "the hood 2", "cube", "cube 2")
    assert mesh.part_numbers.tolist() == [0, 0, 1, 2, 3]
    first, other = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[-5, 0.5, 5], [1, 0, 0], [0, 1, 0]]
    assert mesh.coordinates[mesh.node_numbers[:, :3]].tolist() == [first, other, other, first, first]
    assert report.repairs == ()


HABITS = {
    "spaced ends": A.replace("endloop", "end loop").replace("endfacet", " end \tfacet"),
    "spaced ends on one line": A.replace("endloop\nendfacet", "end loop end facet"),
    "in capitals": A.upper().replace("ENDLOOP", "End Loop"),
    "no normal": A.replace(" normal nan 0 x", ""),
    "no normal and no line": A.replace(" normal nan 0 x\n", " "),
    "an empty normal": A.replace(" nan 0 x", ""),
    "exponents of Fortran": A.replace("1e0", "1.0D+00").replace("1 0 0", "0.1d1 0 0.D0"),
    "colors": "color 0.5 0.5 0.5\n" + A.replace("endfacet", "  COLOUR 1 2 3 \nendfacet"),
    "comments": "# facet\n; a\n! b\n// c\n" + A.replace("outer", "# solid \nouter"),
}


@pytest.mark.usefixtures("_blocks")
@pytest.mark.parametrize("habit", HABITS.values(), ids=HABITS)
def test_the_habits_of_other_programs_are_read(path: Path, habit: str) -> None:
    text = f"# 1\n\nsolid end loop\n{B}{habit}{B}end solid end loop\nSOLID a\tb\n{B}solid c\n{B}"
    report = read(path, text.encode())
    assert report.mesh.part_names == ("end loop", "a?b", "c")
    assert report.mesh.part_numbers.tolist() == [0, 0, 0, 1, 2]
    corners = report.mesh.coordinates[report.mesh.node_numbers[1, :3]]
    assert corners.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert report.repairs == ("cube.stl: the last solid has no 'endsolid': the file may be cut short",)
    wrong = f"solid\n{habit}{B.replace('-5', 'x')}"
    line = wrong.count("\n", 0, wrong.index("vertex x")) + 1
    assert refusal(read, path, wrong.encode()).startswith(f"cube.stl, line {line}: a facet must have ")


@pytest.mark.usefixtures("_blocks")
@pytest.mark.parametrize(
    ("text", "line", "wanted", "wrong"),
    [
        (f"solid\n{A}{A.replace('endloop', 'vertex 1 1 1 endloop')}endsolid\n", 14, "'endloop'", "'vertex'"),
        (f"solid a\n{A.partition('endloop')[0]}", 6, "'endloop'", "its end"),
        ("solid a\nfacet normal 0\n", 2, "'.'", "its end"),
        *(
            (
                f"solid a\n{A.replace('1e0', number)}endsolid\n",
                6,
                "a number of at most 1e30 in size",
                repr(number),
            )
            for number in ("nan", "1_0", "1e31")
        ),
    ],
)
def test_a_wrong_text_is_refused(text: str, line: int, wanted: str, wrong: str) -> None:
    assert refusal(read_text, text.encode(), "a.stl", "a") == (
        f"a.stl, line {line}: a facet must have {wanted} here, not {wrong}; correct it"
    )


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@given(corners=st.lists(st.tuples(*[st.sampled_from([0.0, -0.0, 1.0, 1 + 2**-23, 1e-45, -2.5, 1e30])] * 3)))
def test_equal_points_become_one_in_the_order_of_their_first_corners(
    dtype: type, corners: list[tuple[float, float, float]]
) -> None:
    given_corners: Floats | Singles = np.array(corners, dtype).reshape(-1, 3)
    found, rows = welded(given_corners)
    # The patient way: -0 equals 0 as a key of a dictionary, too.
    numbers: dict[tuple[float, ...], int] = {}
    expected = [numbers.setdefault(tuple(corner), len(numbers)) for corner in given_corners.tolist()]
    assert rows.tolist() == expected
    assert [tuple(point) for point in found.tolist()] == list(numbers)
    assert found.dtype == dtype
    assert not np.signbit(found[found == 0]).any()
