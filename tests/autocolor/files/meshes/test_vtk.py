from __future__ import annotations

import tracemalloc
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.formats import format_of
from autocolor.files.meshes.repair import MeshReport, Placement
from autocolor.files.meshes.vtk import (
    BYTES_OF_NODE,
    TYPES,
    Attributes,
    VtkCursor,
    read_cell_lists,
    read_vtk,
)
from autocolor.files.meshes.vtk_cells import CellLists
from autocolor.scene.mesh import Mesh
from tests.autocolor.files.refusals import refusal, refused

WRITTEN_TYPES = {
    "int": ">i4", "float": ">f4", "double": ">f8", "vtktypeint64": ">i8", "unsigned_char": "u1",
    "short": ">i2", "unsigned_short": ">u2", "char": "i1", "unsigned_int": ">u4", "long": ">i8",
    "unsigned_long": ">u8", "vtkIdType": ">i4",
}  # fmt: skip

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]

WrittenNumbers = Sequence[object] | np.ndarray[tuple[int, ...], np.dtype[np.float64]]


class VtkWriter:
    """Builds the bytes of a file, in text unless `binary`; cells have OFFSETS from version 5.1 on."""

    def __init__(self, dataset: str, *, binary: bool = False, version: str = "3.0") -> None:
        self.binary = binary
        self.offsets = version >= "5.1"
        kind = "BINARY" if binary else "ASCII"
        self.data = f"# vtk DataFile Version {version}\ntitle\n{kind}\nDATASET {dataset}\n".encode()

    def line(self, text: str) -> VtkWriter:
        self.data += text.encode() + b"\n"
        return self

    def numbers(self, numbers: object, kind: str) -> VtkWriter:
        array = np.asarray(numbers).ravel()
        if self.binary:
            self.data += array.astype(WRITTEN_TYPES[kind]).tobytes() + b"\n"
        else:
            self.data += (" ".join(map(str, array.tolist())) + "\n").encode()
        return self

    def points(self, points: object = SQUARE, kind: str = "float") -> VtkWriter:
        return self.line(f"POINTS {len(np.asarray(points))} {kind}").numbers(points, kind)

    def cells(self, keyword: str, cells: Sequence[Sequence[int]]) -> VtkWriter:
        every = [node for cell in cells for node in cell]
        if self.offsets:
            self.line(f"{keyword} {len(cells) + 1} {len(every)}").line("OFFSETS vtktypeint64")
            self.numbers(np.cumsum([0, *map(len, cells)]), "vtktypeint64")
            return self.line("CONNECTIVITY vtktypeint64").numbers(every, "vtktypeint64")
        counted = [number for cell in cells for number in (len(cell), *cell)]
        return self.line(f"{keyword} {len(cells)} {len(counted)}").numbers(counted, "int")

    def grid(self, cells: Sequence[tuple[int, Sequence[int]]]) -> VtkWriter:
        self.cells("CELLS", [nodes for _, nodes in cells])
        return self.line(f"CELL_TYPES {len(cells)}").numbers([kind for kind, _ in cells], "int")


CUBE = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
AROUND = [0, 1, 3, 2, 4, 5, 7, 6]
CENTER = [0.5, 0.5, 0.5]

FORMS = [(False, "2.0"), (True, "3.0"), (False, "4.2"), (True, "4.2"), (False, "5.1"), (True, "5.1")]


def read(folder: Path, data: bytes, placement: Placement | None = None) -> MeshReport:
    path = folder / "thing.vtk"
    path.write_bytes(data)
    return read_vtk(path, placement or Placement())


@pytest.mark.parametrize(("binary", "version"), FORMS)
def test_polygons_and_strips_are_read_and_vertices_and_lines_counted(
    tmp_path: Path, binary: bool, version: str
) -> None:
    data = (
        VtkWriter("POLYDATA", binary=binary, version=version)
        .points([*SQUARE, [2, 0, 0], [2, 1, 0]], "double")
        .cells("VERTICES", [[0], [1, 2]])
        .cells("LINES", [[0, 1, 2]])
        .cells("POLYGONS", [[0, 1, 2, 3], [1, 4, 2], [1, 4, 5, 2]])
        .cells("TRIANGLE_STRIPS", [[0, 1, 3, 2, 4]])
        .line("CELL_DATA 7")
        .line("SCALARS number int 1")
        .line("LOOKUP_TABLE default")
        .numbers([10, 11, 12, 13, 14, 15, 16], "int")
        .data
    )
    report = read(tmp_path, data)
    mesh = report.mesh
    assert mesh.node_numbers.tolist() == [
        [0, 1, 2, 3], [1, 4, 2, 2], [1, 4, 5, 2], [0, 1, 3, 3], [3, 1, 2, 2], [3, 2, 4, 4],
    ]  # fmt: skip
    assert mesh.scalars[0].values.tolist() == [13, 14, 15, 16, 16, 16]
    assert (mesh.scalars[0].name, mesh.scalars[0].of, mesh.part_names) == ("number", "polygon", ("thing",))
    assert report.repairs == ("thing.vtk: skipped vertices: 2", "thing.vtk: skipped lines: 1")


@pytest.mark.parametrize(
    ("kind", "cells", "counts"),
    [
        (10, [[0, 1, 2, 4], [1, 3, 2, 7], [1, 5, 4, 7], [2, 4, 6, 7], [1, 2, 4, 7]], (12, 0)),
        (11, [[0, 1, 2, 3, 4, 5, 6, 7]], (0, 6)),
        (12, [AROUND], (0, 6)),
        (13, [[0, 1, 3, 4, 5, 7], [0, 3, 2, 4, 7, 6]], (4, 4)),
        (14, [[0, 1, 3, 2, 8], [4, 6, 7, 5, 8], [0, 4, 5, 1, 8], [1, 5, 7, 3, 8], [3, 7, 6, 2, 8],
              [2, 6, 4, 0, 8]],
         (0, 6)),
        (25, [[*AROUND, *[8] * 12]], (0, 6)),
    ],
)  # fmt: skip
@pytest.mark.parametrize(("binary", "version"), FORMS)
def test_a_cube_of_each_volume_cell_has_its_outer_surface(
    tmp_path: Path,
    binary: bool,
    version: str,
    kind: int,
    cells: list[list[int]],
    counts: tuple[int, int],
) -> None:
    data = (
        VtkWriter("UNSTRUCTURED_GRID", binary=binary, version=version)
        .points([*CUBE, CENTER])
        .grid([(kind, cell) for cell in cells])
        .line("POINT_DATA 9")
        .line("SCALARS x double")
        .line("LOOKUP_TABLE default")
        .numbers([*(node[0] + 5.0 for node in CUBE), 99.0], "double")
        .line("CELL_DATA " + str(len(cells)))
        .line("FIELD data 1")
        .line(f"row 1 {len(cells)} int")
        .numbers(range(len(cells)), "int")
        .data
    )
    report = read(tmp_path, data)
    mesh = report.mesh
    quads = len(mesh.node_numbers) - mesh.triangle_count
    assert (mesh.triangle_count, quads, len(mesh.coordinates)) == (*counts, 8)
    corners = mesh.coordinates[mesh.node_numbers]
    outward = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    outward += (
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        * (mesh.node_numbers[:, 2] == mesh.node_numbers[:, 3])[:, None]
    )
    assert (((corners.mean(axis=1) - CENTER) * outward).sum(axis=1) > 0).all()
    nodes, rows = mesh.scalars
    assert nodes.values.tolist() == (mesh.coordinates[:, 0] + 5).tolist()
    assert set(rows.values.tolist()) == set(range(len(cells))) - ({4} if kind == 10 else set())


@pytest.mark.parametrize(
    ("kind", "cell", "expected"),
    [
        (5, [0, 1, 2], [[0, 1, 2, 2]]),
        (6, [0, 1, 3, 2], [[0, 1, 3, 3], [3, 1, 2, 2]]),
        (7, [0, 1, 2, 3], [[0, 1, 2, 3]]),
        (8, [0, 1, 3, 2], [[0, 1, 2, 3]]),
        (9, [0, 1, 2, 3], [[0, 1, 2, 3]]),
    ],
)
def test_each_kind_of_polygon_keeps_its_corners(
    tmp_path: Path, kind: int, cell: list[int], expected: list[list[int]]
) -> None:
    data = VtkWriter("UNSTRUCTURED_GRID").points().grid([(kind, cell)]).data
    assert read(tmp_path, data).mesh.node_numbers.tolist() == expected


@pytest.mark.parametrize(("kind", "corners", "nodes"), [(22, 3, 6), (23, 4, 8), (28, 4, 9)])
def test_cells_of_second_order_are_read_by_their_corners(
    tmp_path: Path, kind: int, corners: int, nodes: int
) -> None:
    points = [*SQUARE[:corners], *([7, 7, 7] for _ in range(nodes - corners))]
    data = VtkWriter("UNSTRUCTURED_GRID").points(points).grid([(kind, list(range(nodes)))]).data
    report = read(tmp_path, data)
    assert report.mesh.coordinates.tolist() == SQUARE[:corners]
    assert report.repairs == (
        "thing.vtk: took the corners alone of cells of higher order: 1",
        f"thing.vtk: {nodes - corners} nodes that no polygon uses were dropped",
    )


def test_cells_of_other_types_are_skipped_and_counted(tmp_path: Path) -> None:
    cells = [(1, [0]), (3, [0, 1]), (42, [0, 1, 2]), (7, []), (9, [0, 1, 2, 3])]
    data = VtkWriter("UNSTRUCTURED_GRID").points().grid(cells).line("CELL_DATA 5").line("SCALARS a int")
    report = read(tmp_path, data.numbers([1, 2, 3, 4, 5], "int").data)
    assert report.mesh.scalars[0].values.tolist() == [5]
    assert report.repairs == (
        "thing.vtk: skipped vertices: 1",
        "thing.vtk: skipped lines: 1",
        "thing.vtk: skipped empty cells: 1",
        "thing.vtk: skipped cells of type 42: 1",
    )


@pytest.mark.parametrize("ending", [b"\n", b"\r\n"])
def test_up_scale_metadata_fields_and_line_ends_are_understood(tmp_path: Path, ending: bytes) -> None:
    data = (
        VtkWriter("POLYDATA")
        .line("FIELD FieldData 1")
        .line("TIME 1 1 double")
        .line("0.5")
        .points(SQUARE)
        .line("METADATA\nINFORMATION 1\nNAME a LOCATION b\nDATA 2 0 1\n")
        .cells("POLYGONS", [[0, 1, 2, 3]])
        .data
    )
    report = read(tmp_path, data.replace(b"\n", ending), Placement("y", 2.0))
    assert report.mesh.coordinates[2].tolist() == [2, 0, 2]
    assert report.repairs == ("thing.vtk: skipped arrays that are of no node or cell: 1",)


GOOD = VtkWriter("POLYDATA").points().cells("POLYGONS", [[0, 1, 2, 3]]).data


test_a_wrong_file_is_refused_with_its_place = refused(
    "thing.vtk",
    [
        (
            b"",
            "thing.vtk, line 1: a legacy VTK file must begin '# vtk DataFile Version 1.0' to 5.1, not '';"
            " write it as legacy VTK",
        ),
        (
            GOOD.replace(b"ASCII", b"UTF-8"),
            "thing.vtk, line 3: it must be ASCII or BINARY, not 'UTF-8'; correct it",
        ),
        (
            GOOD.replace(b"DATASET POLYDATA", b""),
            "thing.vtk, line 4: it must be DATASET and its type, not 'POINTS 4 float'; correct it",
        ),
        (
            GOOD.replace(b"POLYDATA", b"GRAPH"),
            "thing.vtk, line 4: the DATASET must be one of POLYDATA, UNSTRUCTURED_GRID, STRUCTURED_GRID,"
            " RECTILINEAR_GRID, STRUCTURED_POINTS, not 'GRAPH'; take its surface",
        ),
        (
            GOOD.replace(b"POINTS 4", b"POINT 4"),
            "thing.vtk, line 5: there must be POINTS before 'POINT'; correct the file",
        ),
        (GOOD.split(b"POINTS")[0], "thing.vtk: a data set must have POINTS, not none; add them"),
        (
            GOOD.replace(b"POINTS 4", b"POINTS 400000000000"),
            "thing.vtk, line 5: the POINTS must have 1,200,000,000,000 numbers, not 20; the file is cut"
            " short or its counts are wrong",
        ),
        (
            GOOD.replace(b"POLYGONS", b"CELLS"),
            "thing.vtk: there must be CELL_TYPES after CELLS; add them",
        ),
        (
            GOOD.replace(b"POLYGONS", b"SQUARES"),
            "thing.vtk, line 7: there must be no 'SQUARES' in POLYDATA; correct the file",
        ),
        (
            VtkWriter("UNSTRUCTURED_GRID").points().grid([(10, [0, 1, 2])]).data,
            "thing.vtk, CELLS: a cell of type 10 must have 4 nodes, not 3 (cell 0, counted from 0);"
            " correct it",
        ),
        (
            VtkWriter("UNSTRUCTURED_GRID").points().cells("CELLS", []).line("CELL_TYPES 1\n5").data,
            "thing.vtk: there must be as many CELL_TYPES as CELLS, 0, not 1; correct the file",
        ),
        (
            VtkWriter("UNSTRUCTURED_GRID").points().grid([(3, [0, 1])]).data,
            "thing.vtk: a mesh must have a polygon with area, not none; skipped lines: 1; add polygons",
        ),
    ],
)


def test_it_is_known_by_its_suffix_and_its_first_line(tmp_path: Path) -> None:
    for name in ("a.vtk", "a.dat"):
        path = tmp_path / name
        path.write_bytes(GOOD)
        found = format_of(path)
        assert found is not None
        assert found.name == "VTK"


def text(data: bytes) -> VtkCursor:
    cursor = VtkCursor(data, "a.vtk")
    cursor.as_text()
    return cursor


def refusal_at(cursor: VtkCursor, kind: bytes = b"int", count: int = 2) -> str:
    with pytest.raises(InputError) as caught:
        cursor.array(count, kind, "POINTS")
    return str(caught.value)


def test_lines_and_arrays_follow_each_other_in_text() -> None:
    cursor = text(b"POINTS 2\n1 2\n\n 3 NEXT word\nmore")
    assert cursor.peek() == b"POINTS"
    assert cursor.words() == [b"POINTS", b"2"]
    assert cursor.array(3, b"int", "x").tolist() == [1, 2, 3]
    assert cursor.words() == [b"NEXT", b"word"]
    assert cursor.array(0, b"float", "x").tolist() == []
    assert cursor.words() == [b"more"]
    assert (cursor.words(), cursor.peek()) == ([], b"")


@pytest.mark.parametrize("kind", TYPES)
def test_each_type_is_read_from_binary_with_the_high_byte_first(kind: bytes) -> None:
    numbers = np.array([1, 2, 100], TYPES[kind])
    cursor = VtkCursor(b"X\r\n" + numbers.tobytes() + b"\nNEXT\n", "a.vtk")
    cursor.words()
    assert cursor.array(3, kind.upper(), "x").tolist() == [1, 2, 100]
    assert cursor.words() == [b"NEXT"]


def test_an_array_that_is_longer_than_the_file_is_refused_before_it_is_made() -> None:
    assert refusal_at(VtkCursor(b"abc", "a.vtk"), count=10**15) == (
        "a.vtk, byte 0: the POINTS must have 4,000,000,000,000,000 bytes, not 3; the file is cut short or its"
        " counts are wrong"
    )
    assert refusal_at(text(b"\n1 x"), count=3) == (
        "a.vtk, line 1: the POINTS must have 3 numbers, not 2; the file is cut short or its counts are wrong"
    )


def test_what_is_no_number_is_refused_with_its_line() -> None:
    assert refusal_at(text(b"\n1 x")) == (
        "a.vtk, line 2: a number of the POINTS must be a whole number, not 'x'; correct it"
    )
    assert refusal_at(text(b"1 2"), b"complex") == (
        "a.vtk, line 1: the type of the POINTS must be int, float, double or another of numbers, not"
        " 'complex'; write it as double"
    )


def test_coordinates_are_finite_and_whole_numbers_whole() -> None:
    cursor = VtkCursor(np.array([1, np.inf], ">f4").tobytes(), "a.vtk")
    assert refusal(cursor.coordinates, 2, b"float", "POINTS") == (
        "a.vtk, byte 0: a coordinate must be finite and at most 1e30 in size, not inf (number 2 of the"
        " POINTS); correct it"
    )
    with pytest.raises(InputError, match="the type of the CELLS must be one of whole numbers, not 'float'"):
        text(b"1 2").wholes(2, b"float", "CELLS")


@pytest.mark.parametrize("word", [b"-1", b"1.0", b"x", b"", b"9" * 19, "\u0661".encode()])
def test_a_count_is_a_whole_number(word: bytes) -> None:
    with pytest.raises(InputError, match="a count must be a whole number from 0 on, not "):
        text(b"").count(word, "a count")


def test_metadata_ends_with_an_empty_line() -> None:
    cursor = VtkCursor(b"INFORMATION 1\nNAME a\nDATA 2 0 1\n\nNEXT", "a.vtk")
    cursor.skip_metadata()
    assert cursor.words() == [b"NEXT"]
    with pytest.raises(InputError, match="METADATA must end with an empty line; remove it"):
        VtkCursor(b"x\n" * 20_000, "a.vtk").skip_metadata()


def test_an_endless_line_is_refused() -> None:
    assert refusal(VtkCursor(b"x" * 10_000, "a.vtk").words) == (
        "a.vtk, byte 0: a line of keywords must have less than 4,096 bytes; correct it"
    )


GRID = [[x, y, 0] for y in range(2) for x in range(3)]


def read_written(folder: Path, writer: VtkWriter) -> MeshReport:
    path = folder / "layer.vtk"
    path.write_bytes(writer.data)
    return read_vtk(path)


@pytest.mark.parametrize("binary", [False, True])
def test_the_three_kinds_of_one_layer_are_the_same_quads(tmp_path: Path, binary: bool) -> None:
    curved = VtkWriter("STRUCTURED_GRID", binary=binary).line("DIMENSIONS 3 2 1").points(GRID)
    straight = VtkWriter("RECTILINEAR_GRID", binary=binary).line("DIMENSIONS 3 2 1")
    for axis, places in (("X", [0, 1, 2]), ("Y", [0, 1]), ("Z", [0])):
        straight.line(f"{axis}_COORDINATES {len(places)} float").numbers(places, "float")
    even = VtkWriter("STRUCTURED_POINTS", binary=binary).line("DIMENSIONS 3 2 1\nORIGIN 0 0 0\nSPACING 1 1 1")
    for writer in (curved, straight, even):
        writer.line("CELL_DATA 2\nSCALARS c int\nLOOKUP_TABLE default").numbers([5, 6], "int")
        mesh = read_written(tmp_path, writer).mesh
        assert mesh.coordinates.tolist() == GRID
        assert mesh.node_numbers.tolist() == [[0, 1, 4, 3], [1, 2, 5, 4]]
        assert mesh.scalars[0].values.tolist() == [5, 6]


def test_a_layer_may_lie_across_any_axis(tmp_path: Path) -> None:
    writer = VtkWriter("STRUCTURED_POINTS").line("DIMENSIONS 1 2 3\nASPECT_RATIO 1 2 3\nORIGIN 7 0 0")
    writer.line("POINT_DATA 6\nSCALARS s float\nLOOKUP_TABLE default\n0 1 2 3 4 5")
    mesh = read_written(tmp_path, writer).mesh
    assert mesh.coordinates.tolist() == [[7, 2 * y, 3 * z] for z in range(3) for y in range(2)]
    assert mesh.node_numbers.tolist() == [[0, 1, 3, 2], [2, 3, 5, 4]]


def grid(dataset: str, sizes: Sequence[int], places: Sequence[Sequence[float]], binary: bool) -> VtkWriter:
    """A grid of nodes at these places along the axes, which STRUCTURED_POINTS only begin and step by."""
    writer = VtkWriter(dataset, binary=binary).line("DIMENSIONS " + " ".join(map(str, sizes)))
    if dataset == "RECTILINEAR_GRID":
        for axis, along in zip("XYZ", places, strict=True):
            writer.line(f"{axis}_COORDINATES {len(along)} double").numbers(along, "double")
    elif dataset == "STRUCTURED_GRID":
        writer.points([[x, y, z] for z in places[2] for y in places[1] for x in places[0]], "double")
    else:
        writer.line("ORIGIN " + " ".join(str(along[0]) for along in places))
        writer.line("SPACING " + " ".join(str(along[1] - along[0]) for along in places))
    return writer


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("steps", [(1, 2, 3), (-1, 2, 3), (1, -2, -3)])
@pytest.mark.parametrize("sizes", [(2, 2, 2), (2, 3, 4), (5, 4, 3)])
@pytest.mark.parametrize("dataset", ["STRUCTURED_GRID", "RECTILINEAR_GRID", "STRUCTURED_POINTS"])
def test_a_volume_is_the_outer_surface_of_its_cells(
    tmp_path: Path, dataset: str, sizes: tuple[int, ...], steps: tuple[int, ...], binary: bool
) -> None:
    places = [[0.5 + step * at for at in range(size)] for size, step in zip(sizes, steps, strict=True)]
    nodes = np.prod(sizes)
    first = np.arange(nodes).reshape(sizes[::-1])[:-1, :-1, :-1].ravel()
    wide, layer = sizes[0], sizes[0] * sizes[1]
    hexahedra = first[:, None] + [0, 1, 1 + wide, wide, *(layer + at for at in (0, 1, 1 + wide, wide))]
    points = [[x, y, z] for z in places[2] for y in places[1] for x in places[0]]
    cells = VtkWriter("UNSTRUCTURED_GRID", binary=binary).points(points, "double")
    cells.grid([(12, cell) for cell in hexahedra.tolist()])
    reports = []
    for writer in (grid(dataset, sizes, places, binary), cells):
        writer.line(f"POINT_DATA {nodes}\nSCALARS n int\nLOOKUP_TABLE default").numbers(range(nodes), "int")
        writer.line(f"CELL_DATA {len(first)}\nSCALARS c int\nLOOKUP_TABLE default")
        reports.append(read_written(tmp_path, writer.numbers(range(len(first)), "int")))
    (mesh, twin), (repairs, others) = zip(*((each.mesh, each.repairs) for each in reports), strict=True)
    assert repairs == others
    assert mesh.coordinates.tolist() == twin.coordinates.tolist()
    assert mesh.scalars[0].values.tolist() == twin.scalars[0].values.tolist()

    def quads(of: Mesh) -> list[tuple[float, ...]]:
        """The scalar of the cell, and the corners from the lowest on."""
        turned = [np.roll(quad, -quad.argmin()).tolist() for quad in of.node_numbers]
        return sorted((cell, *quad) for cell, quad in zip(of.scalars[1].values.tolist(), turned, strict=True))

    assert quads(mesh) == quads(twin)


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("dataset", ["STRUCTURED_GRID", "RECTILINEAR_GRID", "STRUCTURED_POINTS"])
def test_data_of_the_whole_file_are_skipped_before_a_grid(tmp_path: Path, dataset: str, binary: bool) -> None:
    data = grid(dataset, (2, 3, 4), ([0, 1], [0, 1, 2], [0, 1, 2, 3]), binary).data
    field = VtkWriter(dataset, binary=binary).line("FIELD FieldData 1\nTimeValue 1 1 double")
    start = field.numbers([1.5], "double").line("METADATA").line("INFORMATION 0\n").data
    at = data.index(b"DIMENSIONS")
    for name, contents in (("a.vtk", data), ("b.vtk", start + data[at:])):
        (tmp_path / name).write_bytes(contents)
    plain, whole = (read_vtk(tmp_path / name) for name in ("a.vtk", "b.vtk"))
    assert (plain.mesh.coordinates == whole.mesh.coordinates).all()
    assert (plain.mesh.node_numbers == whole.mesh.node_numbers).all()
    told = [repair.replace("b.vtk", "a.vtk") for repair in whole.repairs]
    assert told == [*plain.repairs, "a.vtk: skipped arrays that are of no node or cell: 1"]


def test_a_grid_may_have_more_nodes_than_its_file_has_bytes(tmp_path: Path) -> None:
    report = read_written(tmp_path, VtkWriter("STRUCTURED_POINTS").line("DIMENSIONS 30 30 30"))
    assert len(report.mesh.coordinates) == 30**3 - 28**3


def test_a_large_volume_takes_the_memory_of_its_surface(tmp_path: Path) -> None:
    size = 100
    writer = VtkWriter("STRUCTURED_POINTS", binary=True).line("DIMENSIONS" + f" {size}" * 3)
    writer.line(f"POINT_DATA {size**3}\nSCALARS s unsigned_char\nLOOKUP_TABLE default")
    writer.numbers(np.zeros(size**3), "unsigned_char")
    tracemalloc.start()
    mesh = read_written(tmp_path, writer).mesh
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(mesh.coordinates) == size**3 - (size - 2) ** 3
    assert len(mesh.node_numbers) == 6 * (size - 1) ** 2
    # The coordinates of all nodes alone would take more.
    assert most < BYTES_OF_NODE * len(mesh.coordinates) + 2 * size**3


OTHER_GRIDS = [
    (
        "STRUCTURED_GRID",
        "DIMENSIONS 3 0 3",
        "layer.vtk, line 5: a STRUCTURED_GRID must have three numbers of nodes, as in DIMENSIONS 5 4 1, not"
        " 'DIMENSIONS 3 0 3'; correct them",
    ),
    ("STRUCTURED_GRID", "", "layer.vtk: a STRUCTURED_GRID must have DIMENSIONS, not none; add them"),
    ("STRUCTURED_GRID", "DIMENSIONS 3 3 1", "layer.vtk: a STRUCTURED_GRID must have POINTS; add them"),
    (
        "STRUCTURED_GRID",
        "DIMENSIONS 3 3 1\nPOINTS 1 int\n0 0 0",
        "layer.vtk: a STRUCTURED_GRID must have the 9 nodes of its DIMENSIONS, not 1; correct them",
    ),
    (
        "RECTILINEAR_GRID",
        "DIMENSIONS 2 2 1\nX_COORDINATES 2 int\n0 1",
        "layer.vtk: a RECTILINEAR_GRID must have coordinates of each of its DIMENSIONS; add them",
    ),
    (
        "STRUCTURED_POINTS",
        "DIMENSIONS 100000 100000 1",
        "layer.vtk: the surface of a STRUCTURED_POINTS must have at most 250,000 nodes, for the size of the"
        " file, not 10,000,000,000; take fewer",
    ),
    (
        "STRUCTURED_POINTS",
        "DIMENSIONS 9 9 1\nSPACING 1 nan 1",
        "layer.vtk, line 6: a coordinate must be a decimal number of at most 1e30 in size, not 'nan'; correct"
        " it",
    ),
    (
        "STRUCTURED_POINTS",
        "DIMENSIONS 9 9 1\nSPACING 1e30 1 1",
        "layer.vtk: coordinates must be at most 1e30 in size; correct ORIGIN and SPACING",
    ),
    (
        "STRUCTURED_POINTS",
        "DIMENSIONS 2 2 1\nSPACE 1 1 1",
        "layer.vtk, line 6: there must be no 'SPACE 1 1 1' in STRUCTURED_POINTS; correct the file",
    ),
]

test_other_grids_are_refused_by_name = refused(
    "layer.vtk", [(VtkWriter(dataset).line(lines).data, sentence) for dataset, lines, sentence in OTHER_GRIDS]
)


def cursor_of(text: str) -> VtkCursor:
    cursor = VtkCursor(text.encode(), "a.vtk")
    cursor.as_text()
    return cursor


def lists_of(text: str, nodes: int = 9) -> CellLists:
    cursor = cursor_of(text)
    return read_cell_lists(cursor, cursor.words(), nodes)


@given(st.lists(st.lists(st.integers(0, 8), max_size=5), max_size=8))
def test_cells_are_the_same_in_both_forms(cells: list[list[int]]) -> None:
    numbers = [node for cell in cells for node in cell]
    counted = " ".join(str(number) for cell in cells for number in (len(cell), *cell))
    offsets = np.cumsum([0, *map(len, cells)]).tolist()
    old = lists_of(f"POLYGONS {len(cells)} {len(numbers) + len(cells)}\n{counted}")
    new = lists_of(
        f"POLYGONS {len(offsets)} {len(numbers)}\nOFFSETS vtktypeint64\n{' '.join(map(str, offsets))}\n"
        f"CONNECTIVITY vtktypeint64\n{' '.join(map(str, numbers))}"
    )
    for lists in (old, new):
        assert lists.numbers.tolist() == numbers
        assert lists.offsets.tolist() == offsets


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("CELLS 1", "a.vtk, line 1: CELLS must have two counts, not 1; correct it"),
        (
            "CELLS 5 4\n1 2 3 4",
            "a.vtk, line 1: CELLS must have at least as many numbers as cells, 5, not 4; correct it",
        ),
        (
            "CELLS 2 7\n3 0 1 2 3 1 2",
            "a.vtk, CELLS: a cell must have as many nodes as its count says, not 2 after 3 (cell 1, counted"
            " from 0); correct it",
        ),
        (
            "CELLS 1 4\n-3 0 1 2",
            "a.vtk, CELLS: a cell must have as many nodes as its count says, not 3 after -3 (cell 0,"
            " counted from 0); correct it",
        ),
        (
            "CELLS 1 5\n3 0 1 2 3",
            "a.vtk, CELLS: its 1 cells must fill 5 numbers, not 4; correct its counts",
        ),
        (
            "CELLS 2 8\n3 0 1 2 3 0 1 9",
            "a.vtk, CELLS: a node number must be from 0 to 8, not 9 (cell 1, counted from 0); correct it",
        ),
        (
            "CELLS 2 3\nOFFSETS int\n0 2\nCONNECTIVITY int\n0 1 2",
            "a.vtk, CELLS: OFFSETS must rise from 0 to the size of CONNECTIVITY, 3; correct them",
        ),
        (
            "CELLS 2 3\nOFFSETS int\n0 3\nNODES int\n0 1 2",
            "a.vtk, line 2: after OFFSETS there must be CONNECTIVITY; correct the file",
        ),
        ("CELLS 2 3\nOFFSETS\n0 3", "a.vtk, line 2: CELLS must have types of its arrays; correct it"),
    ],
)  # fmt: skip
def test_wrong_lists_are_refused(text: str, sentence: str) -> None:
    assert refusal(lists_of, text) == sentence


def read_data(writer: VtkWriter) -> Attributes:
    """What is read of two nodes, in turned order, and three cells, of which the last is a polygon."""
    cursor = VtkCursor(writer.data, "a.vtk")
    if not writer.binary:
        cursor.as_text()
    for _ in range(4):
        cursor.words()
    attributes = Attributes(
        cursor, {"node": 2, "polygon": 3}, {"node": np.array([1, 0]), "polygon": np.array([2])}
    )
    attributes.read()
    return attributes


def shown(attributes: Attributes) -> dict[str, str]:
    return {each.name: f"{each.of} {each.values.tolist()}" for each in attributes.scalars.scalars}


@pytest.mark.parametrize("binary", [False, True])
def test_every_kind_of_data_is_read_or_skipped_and_told(binary: bool) -> None:
    colors = ([[1, 2, 3]] * 2, "unsigned_char") if binary else ([[0.1, 0.2, 0.3]] * 2, "float")
    table = ([[1, 2, 3, 4]], "unsigned_char") if binary else ([[0.1, 0.2, 0.3, 1]], "float")
    writer = (
        VtkWriter("POLYDATA", binary=binary)
        .line("POINT_DATA 2")
        .line("SCALARS Nodal%20Stress double")
        .line("LOOKUP_TABLE default")
        .numbers([1.5, 2.5], "double")
        .line("LOOKUP_TABLE reds 1")
        .numbers(*table)
        .line("SCALARS pair float 2")
        .line("LOOKUP_TABLE default")
        .numbers([3, 4, 6, 8], "float")
        .line("COLOR_SCALARS c 3")
        .numbers(*colors)
        .line("VECTORS v float")
        .numbers([1, 2, 2, 0, 0, 1], "float")
        .line("NORMALS n float")
        .numbers([0, 0, 1, 0, 0, 1], "float")
        .line("TEXTURE_COORDINATES uv 2 float")
        .numbers([0, 0, 1, 1], "float")
        .line("TENSORS t double")
        .numbers([[4, 0, 0, 0, 0, 0, 0, 0, 0]] * 2, "double")
        .line("METADATA\nINFORMATION 0\n")
        .line("CELL_DATA 3")
        .line("FIELD more 3")
        .line("heat 1 3 short")
        .numbers([7, 8, 9], "short")
        .line("METADATA\nINFORMATION 0\n")
        .line("six 6 3 float")
        .numbers(np.arange(18) * 0 + 5.0, "float")
        .line("other 1 2 int")
        .numbers([1, 2], "int")
        .line("GLOBAL_IDS ids vtkIdType")
        .numbers([1, 2, 3], "vtkIdType")
    )
    attributes = read_data(writer)
    assert shown(attributes) == {
        "Nodal Stress": "node [2.5, 1.5]",
        "pair magnitude": "node [10.0, 5.0]",
        "v magnitude": "node [1.0, 3.0]",
        "t von Mises": "node [4.0, 4.0]",
        "heat": "polygon [9.0]",
        "six von Mises": "polygon [15.0]",
    }
    assert attributes.messages == (
        "skipped color tables: 1",
        "skipped arrays of colors: 1",
        "skipped normals: 1",
        "skipped texture coordinates: 1",
        "skipped arrays that are of no node or cell: 1",
        "skipped arrays of numbers for identification: 1",
    )


@pytest.mark.parametrize("kind", WRITTEN_TYPES)
@pytest.mark.parametrize("binary", [False, True])
def test_scalars_may_have_any_type(binary: bool, kind: str) -> None:
    writer = VtkWriter("POLYDATA", binary=binary).line("POINT_DATA 2").line(f"SCALARS s {kind}")
    assert shown(read_data(writer.numbers([7, 9], kind))) == {"s": "node [9.0, 7.0]"}


def test_missing_values_are_nan() -> None:
    writer = VtkWriter("POLYDATA").line("POINT_DATA 2\nSCALARS s float\nLOOKUP_TABLE default\nnan 1")
    assert shown(read_data(writer)) == {"s": "node [1.0, nan]"}


def test_texts_and_bits_are_skipped() -> None:
    text = VtkWriter("POLYDATA").line(
        "POINT_DATA 2\nFIELD f 2\nnames 1 2 string\nfirst one\nsecond\nb 1 2 bit\n0 1"
    )
    binary = VtkWriter("POLYDATA", binary=True).line("POINT_DATA 2\nFIELD f 2\nnames 1 2 string")
    binary.data += bytes([0xC3]) + b"one" + bytes([0x80, 0x46]) + b"x" * 70 + b"\nb 1 2 bit\n\x40\n"
    for writer in (text, binary):
        attributes = read_data(writer.line("SCALARS s int\nLOOKUP_TABLE default").numbers([1, 2], "int"))
        assert shown(attributes) == {"s": "node [2.0, 1.0]"}
        assert attributes.messages == ("skipped arrays of texts: 1", "skipped arrays of bits: 1")


def test_what_follows_an_unknown_keyword_is_skipped_and_told() -> None:
    attributes = read_data(VtkWriter("POLYDATA").line("POINT_DATA 2\nSPLINES s 2\n1 2"))
    assert attributes.messages == ("skipped all from the unknown keyword 'SPLINES' on",)


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        ("POINT_DATA 3", "a.vtk, line 5: POINT_DATA must be for all 2 of the file, not 3; correct the count"),
        (
            "POINT_DATA 2\nSCALARS s",
            "a.vtk, line 6: SCALARS must be followed by 2 words, not 1; correct it",
        ),
        (
            "POINT_DATA 2\nSCALARS s float\nLOOKUP_TABLE default\n1",
            "a.vtk, line 7: the array 's' must have 2 numbers, not 1; the file is cut short or its counts are"
            " wrong",
        ),
        (
            "CELL_DATA 3\nFIELD f 1\nname 1 3",
            "a.vtk, line 7: an array of a FIELD must have a name, two counts and a type, not 'name 1 3';"
            " correct it",
        ),
        (
            "CELL_DATA 3\nFIELD f 900000",
            "a.vtk, line 6: a FIELD must have at most 100,000 arrays, not 900,000; leave some out",
        ),
        (
            "CELL_DATA 3\nFIELD f 1\nname 1 99999999999 string\n",
            "a.vtk, line 7: there must be 99,999,999,999 texts, not fewer; correct the count",
        ),
    ],
)  # fmt: skip
def test_wrong_data_are_refused_with_their_place(lines: str, sentence: str) -> None:
    assert refusal(read_data, VtkWriter("POLYDATA").line(lines)) == sentence
