from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Floats, Singles
from autocolor.errors import InputError, MissingInputError
from autocolor.files.formats import format_of
from autocolor.files.meshes import stl
from autocolor.files.meshes.repair import MeshReport, Placement
from autocolor.files.meshes.stl import (
    FACET,
    FACTORS,
    TRIANGLE,
    has_binary_size,
    read_binary,
    read_stl,
    read_text,
    stl_bytes,
    welded,
)
from autocolor.scene.mesh import Mesh
from tests.autocolor.files.refusals import is_read_or_refused, refusal

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


def test_a_cube_reads_back_with_outward_normals(path: Path) -> None:
    data = stl_bytes(Mesh(NODES.astype(float), np.array(QUADS)))
    report = read(path, data)
    assert has_binary_size(data)
    assert (len(report.mesh.coordinates), report.mesh.triangle_count, report.repairs) == (8, 12, ())
    records = np.frombuffer(data, TRIANGLE, 12, 84)
    centers = records["corners"].mean(axis=1) - 0.5
    assert np.array_equal(records["normal"], np.sign(np.where(np.abs(centers) > 0.4, centers, 0)))


@pytest.mark.parametrize(
    ("nodes", "triangles"),
    [
        # The shorter diagonal; equal diagonals lead through the lowest number; an arrowhead has one inside.
        ([[0, 0, 0], [3, 0, 0], [4, 1, 0], [1, 1, 0]], [[1, 2, 3], [1, 3, 0]]),
        ([[0, 0, 0], [3, 0, 0], [2, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]]),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]),
        ([[0, 0, 0], [9, 0, 0], [1, 1, 0], [0, 9, 0]], [[0, 1, 2], [0, 2, 3]]),
    ],
)
def test_a_quad_is_cut_along_the_diagonal_of_the_mesh(
    nodes: list[list[float]], triangles: list[list[int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stl, "POLYGONS_AT_ONCE", 1)
    mesh = Mesh(np.array([*nodes, [0, 0, 5]]), np.array([[0, 1, 2, 3], [1, 2, 4, 4], [0, 0, 1, 4]]))
    records = np.frombuffer(stl_bytes(mesh), TRIANGLE, 4, 84)
    expected = [*triangles, [1, 2, 4], [0, 1, 4]]
    assert records["corners"].tolist() == mesh.coordinates[expected].tolist()
    assert records["normal"][0].tolist() == [0, 0, 1]


@pytest.mark.parametrize("size", [1e-30, 5e29])
def test_normals_are_unit_vectors_at_any_size_and_zero_without_area(size: float) -> None:
    nodes = np.array([[0, 0, 0], [0, 1, 0], [0, 0, 1], [0, 2, 0]]) * size
    with np.errstate(all="raise"):
        data = stl_bytes(Mesh(nodes, np.array([[0, 1, 2], [0, 1, 3]])))
    assert np.frombuffer(data, TRIANGLE, 2, 84)["normal"].tolist() == [[1, 0, 0], [0, 0, 0]]


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
        "cube.stl: 1 node that no polygon uses was dropped",
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
        assert refusal(read, path, data).endswith("must have a polygon with area, not none; add polygons")


def test_other_encodings_are_refused(path: Path) -> None:
    assert refusal(read, path, text().decode().encode("utf-16")) == (
        "cube.stl: an ascii STL file must be text in UTF-8, not UTF-16; save it as UTF-8"
    )
    assert refusal(read, path, text() + b"\0") == (
        "cube.stl: an ascii STL file must be text, not hold a NUL byte (line 87); save it as UTF-8 text"
    )
    assert refusal(read, path, b"") == (
        "cube.stl: a binary STL file must have at least 84 bytes, not 0; it is cut short, export it again"
    )


def test_a_missing_file_is_refused(path: Path) -> None:
    with pytest.raises(MissingInputError):
        read_stl(path)


def test_a_binary_file_cut_short_anywhere_is_refused(path: Path) -> None:
    data = binary(begin=b"solid cube")
    for length in range(len(data)):
        assert refusal(read, path, data[:length]).startswith("cube.stl: ")


def test_a_text_cut_short_anywhere_is_refused_or_told(path: Path) -> None:
    data = text(corners=CUBE[:2])
    for length in range(data.rindex(b"endsolid") + len("endsolid")):
        try:
            told: tuple[str, ...] = read(path, data[:length]).repairs
        except InputError as error:
            told = error.problems
        assert told[0].startswith("cube.stl")


@given(data=st.binary(max_size=150) | st.text("solidenfacrumvtxp 01.-\n", max_size=150).map(str.encode))
def test_any_bytes_are_read_or_refused(data: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.getbasetemp() / "any.stl"
    assert is_read_or_refused(path, data)
    assert is_read_or_refused(path, b"solid a\n" + data)


CORNERS = np.arange(18, dtype=np.float32).reshape(2, 3, 3)


def two_triangles(corners: object = CORNERS, count: int | None = None, begin: bytes = b"") -> bytes:
    table = np.zeros(len(np.asarray(corners)), TRIANGLE)
    table["normal"] = np.nan
    table["corners"] = corners
    table["attribute"] = 65535
    return begin.ljust(80) + (len(table) if count is None else count).to_bytes(4, "little") + table.tobytes()


def refusal_of_binary(data: bytes) -> str:
    return refusal(read_binary, data, "a.stl")


def test_corners_are_read_and_normals_and_attributes_are_not() -> None:
    corners, skipped = read_binary(two_triangles(), "a.stl")
    assert np.array_equal(corners, CORNERS.reshape(6, 3))
    assert corners.dtype == np.float32
    assert skipped == ()


def test_a_binary_file_is_told_by_its_size() -> None:
    assert has_binary_size(two_triangles(begin=b"solid"))
    assert has_binary_size(two_triangles(np.empty((0, 3, 3))))
    assert not has_binary_size(two_triangles() + b"x")
    assert not has_binary_size(two_triangles()[:-1])
    assert not has_binary_size(b"")


def test_bytes_after_the_last_triangle_are_counted() -> None:
    corners, skipped = read_binary(two_triangles(count=1), "a.stl")
    assert len(corners) == 3
    assert skipped == ("skipped bytes after the last triangle: 50",)


def test_a_file_cut_short_is_refused_before_anything_is_made() -> None:
    assert refusal_of_binary(two_triangles()[:80]) == (
        "a.stl: a binary STL file must have at least 84 bytes, not 80; it is cut short, export it again"
    )
    assert refusal_of_binary(two_triangles(count=2**32 - 1)) == (
        "a.stl: a binary STL file of 4,294,967,295 triangles must have 214,748,364,834 bytes, not 184; it is"
        " cut short or of another format, export it again"
    )


@pytest.mark.parametrize(("number", "shown"), [(np.nan, "nan"), (-np.inf, "-inf"), (2e30, "2e+30")])
def test_coordinates_that_are_no_numbers_are_refused(number: float, shown: str) -> None:
    corners = CORNERS.copy()
    corners[1, 2, 0] = number
    assert refusal_of_binary(two_triangles(corners)) == (
        f"a.stl, facet 2: a coordinate must be a finite number of at most 1e30 in size, not {shown};"
        " correct it"
    )


@pytest.mark.parametrize("sign", [-1, 1])
def test_a_coordinate_may_be_the_largest_and_no_larger(sign: int) -> None:
    # The largest coordinate is the float32 nearest to 1e30.
    most = np.float32(sign * 1e30)
    more = np.nextafter(most, np.float32(sign * np.inf))
    assert abs(most) == np.float32(1e30) < abs(more)
    for at in np.ndindex(2, 3, 3):
        corners = CORNERS.copy()
        corners[at] = most
        assert read_binary(two_triangles(corners), "a.stl")[0].reshape(2, 3, 3)[at] == most
        corners[at] = more
        assert f"facet {at[0] + 1}: a coordinate must be" in refusal_of_binary(two_triangles(corners))
    solid = "solid a\n{}endsolid\n".format
    largest = f"{sign * 1e30!r}"
    text = solid(A.replace("1e0", largest))
    assert read_text(text.encode(), "a.stl").corners[2, 1] == sign * 1e30
    larger = repr(sign * np.nextafter(1e30, np.inf))
    assert f"at most 1e30 in size, not '{larger}'" in refusal_of_text(solid(A.replace("1e0", larger)))


def test_a_file_is_cut_short_before_its_84_bytes_and_not_at_them() -> None:
    empty = two_triangles(count=0)[:84]
    assert len(read_binary(empty, "a.stl")[0]) == 0
    assert "must have at least 84 bytes, not 83;" in refusal_of_binary(empty[:83])
    assert "must have 184 bytes, not 183;" in refusal_of_binary(two_triangles()[:183])
    assert read_binary(two_triangles() + b"x", "a.stl")[1] == ("skipped bytes after the last triangle: 1",)


def test_not_more_than_twenty_are_told() -> None:
    assert refusal_of_binary(two_triangles(np.full((30, 3, 3), np.nan))).count("\n") == 19


A = "facet normal nan 0 x\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n"
B = A.replace("vertex 0 0 0", "vertex -5 .5 +5.")


def refusal_of_text(text: str) -> str:
    return refusal(read_text, text.encode(), "a.stl")


@pytest.mark.parametrize("block", [1, 1 << 21])
def test_solids_are_parts(block: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stl, "BLOCK", block)
    text = f"solid the hood\n{A}{B}endsolid the hood\n\nsolid\nendsolid\n  SOLID door\n{B.upper()}ENDSOLID\n"
    found = read_text(text.encode(), "a.stl")
    assert found.names == (b" the hood", b" door")
    assert found.part_numbers.tolist() == [0, 0, 1]
    assert found.corners.reshape(3, 9).tolist() == [
        [0, 0, 0, 1, 0, 0, 0, 1, 0],
        [-5, 0.5, 5, 1, 0, 0, 0, 1, 0],
        [-5, 0.5, 5, 1, 0, 0, 0, 1, 0],
    ]
    assert found.messages == ()


def test_lines_may_be_broken_anywhere() -> None:
    text = "solid a\n" + A.replace("\n", " ").replace(" ", "\n\n \t") + "endsolid"
    assert len(read_text(text.encode(), "a.stl").corners) == 3


def test_a_solid_without_an_end_is_told() -> None:
    found = read_text(f"solid a\n{A}".encode(), "a.stl")
    assert len(found.corners) == 3
    assert found.messages == ("the last solid has no 'endsolid': the file may be cut short",)


def test_a_text_without_solids_has_no_triangles() -> None:
    assert len(read_text(b"\n \n", "a.stl").corners) == 0


@pytest.mark.parametrize("block", [1, 1 << 21])
@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (f"{A}", "line 1: a facet must stand in a solid, not outside; add a line 'solid'"),
        (
            f"solid\n{A}endsolid\n\n{A}solid\n",
            "line 11: a facet must stand in a solid, not outside; add a line 'solid'",
        ),
        ("\nendsolid\n", "line 2: a solid must begin before it ends; remove the line"),
        (f"solid a\n{A}solid b\n", "line 9: a solid must end before the next; add a line 'endsolid'"),
        (
            f"solid a\n{A}{A.replace('outer loop', 'inner loop')}endsolid\n",
            f"line 10: a facet must be '{FACET}', with numbers for the points, and 'outer' must stand here,"
            " not 'inner'; correct it",
        ),
        (
            f"solid a\n{A}{A.replace('endloop', 'vertex 1 1 1 endloop')}endsolid\n",
            f"line 14: a facet must be '{FACET}', with numbers for the points, and 'endloop' must stand here,"
            " not 'vertex'; correct it",
        ),
        (
            f"solid a\n{A.partition('endloop')[0]}",
            f"line 6: a facet must be '{FACET}', and not end before its 'endloop'; correct it",
        ),
        (
            f"solid a\n{A}facet",
            f"line 9: a facet must be '{FACET}', and not end before its 'normal'; correct it",
        ),
        *(
            (
                f"solid a\n{A.replace('1e0', number)}endsolid\n",
                f"line 6: a coordinate must be a decimal number of at most 1e30 in size, not '{number}';"
                " correct it",
            )
            for number in ("nan", "1_0", "0x1", "1e31", "1,5", "inf", ".")
        ),
    ],
)
def test_a_wrong_text_is_refused(
    text: str, sentence: str, block: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stl, "BLOCK", block)
    assert refusal_of_text(text) == f"a.stl, {sentence}"


def test_an_endless_facet_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stl, "BLOCK", 1)
    monkeypatch.setattr(stl, "LONGEST_FACET", 200)
    assert refusal_of_text(f"solid a\n{A}" + "vertex " * 100) == (
        "a.stl, line 9: a facet must have at most 200 bytes, not more; correct it"
    )


points = st.lists(st.tuples(*[st.sampled_from([0.0, -0.0, 1.0, 1e-45, -2.5, 1e30])] * 3), max_size=40)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("factors", [FACTORS, FACTORS[:1], ((0, 0, 0),), ()])
@given(corners=points)
def test_equal_points_become_one_in_the_order_of_their_first_corners(
    dtype: type, factors: tuple[tuple[int, int, int], ...], corners: list[tuple[float, float, float]]
) -> None:
    given_corners: Floats | Singles = np.array(corners, dtype).reshape(-1, 3)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(stl, "FACTORS", factors)
        found, rows = welded(given_corners)
    # The patient way: -0 equals 0 as a key of a dictionary, too.
    numbers: dict[tuple[float, ...], int] = {}
    expected = [numbers.setdefault(tuple(corner), len(numbers)) for corner in given_corners.tolist()]
    assert rows.tolist() == expected
    assert [tuple(point) for point in found.tolist()] == list(numbers)
    assert found.dtype == dtype
    assert not np.signbit(found[found == 0]).any()


def test_neighbors_in_the_last_digit_stay_apart() -> None:
    one = np.float32(1)
    corners = np.array([[one, 0, 0], [np.nextafter(one, np.float32(2)), 0, 0]], np.float32)
    assert len(welded(corners)[0]) == 2
