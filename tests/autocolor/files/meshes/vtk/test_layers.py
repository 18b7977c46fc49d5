from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.vtk.vtk_file import read_vtk
from autocolor.files.repair.polygons import MeshReport
from tests.autocolor.files.meshes.vtk.files import VtkWriter

GRID = [[x, y, 0] for y in range(2) for x in range(3)]


def read(folder: Path, writer: VtkWriter) -> MeshReport:
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
        mesh = read(tmp_path, writer).mesh
        assert mesh.coordinates.tolist() == GRID
        assert mesh.node_numbers.tolist() == [[0, 1, 4, 3], [1, 2, 5, 4]]
        assert mesh.scalars[0].values.tolist() == [5, 6]


def test_a_layer_may_lie_across_any_axis(tmp_path: Path) -> None:
    writer = VtkWriter("STRUCTURED_POINTS").line("DIMENSIONS 1 2 3\nASPECT_RATIO 1 2 3\nORIGIN 7 0 0")
    writer.line("POINT_DATA 6\nSCALARS s float\nLOOKUP_TABLE default\n0 1 2 3 4 5")
    mesh = read(tmp_path, writer).mesh
    assert mesh.coordinates.tolist() == [[7, 2 * y, 3 * z] for z in range(3) for y in range(2)]
    assert mesh.node_numbers.tolist() == [[0, 1, 3, 2], [2, 3, 5, 4]]


@pytest.mark.parametrize(
    ("dataset", "lines", "sentence"),
    [
        (
            "STRUCTURED_GRID",
            "DIMENSIONS 3 3 3",
            "layer.vtk, line 5: a STRUCTURED_GRID must be one layer of nodes, as in DIMENSIONS 5 4 1, not"
            " 'DIMENSIONS 3 3 3'; take its surface",
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
            "layer.vtk: a STRUCTURED_POINTS must have at most as many nodes as the file has bytes, and"
            " 4,000,000,"
            " not 10,000,000,000; take fewer",
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
    ],
)  # fmt: skip
def test_other_grids_are_refused_by_name(tmp_path: Path, dataset: str, lines: str, sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, VtkWriter(dataset).line(lines))
    assert str(caught.value) == sentence
