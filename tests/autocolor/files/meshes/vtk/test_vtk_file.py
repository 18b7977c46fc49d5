from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.formats import format_of
from autocolor.files.meshes.vtk.vtk_file import read_vtk
from autocolor.files.repair.placement import Placement
from autocolor.files.repair.polygons import MeshReport
from tests.autocolor.files.meshes.mutations import survives
from tests.autocolor.files.meshes.vtk.files import SQUARE, VtkWriter

CUBE = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
AROUND = [0, 1, 3, 2, 4, 5, 7, 6]
CENTER = [0.5, 0.5, 0.5]

FORMS = [(False, "2.0"), (True, "3.0"), (False, "4.2"), (True, "4.2"), (False, "5.1"), (True, "5.1")]


def read(folder: Path, data: bytes, placement: Placement | None = None) -> MeshReport:
    path = folder / "thing.vtk"
    path.write_bytes(data)
    return read_vtk(path, placement or Placement())


def refusal(folder: Path, data: bytes) -> str:
    with pytest.raises(InputError) as caught:
        read(folder, data)
    return str(caught.value)


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
        f"thing.vtk: left out {nodes - corners} nodes that the surface does not use",
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
    assert report.repairs == ()


GOOD = VtkWriter("POLYDATA").points().cells("POLYGONS", [[0, 1, 2, 3]]).data


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (
            b"",
            "thing.vtk, line 1: a legacy VTK file must begin '# vtk DataFile Version 1.0' to 5.1, not '';"
            " write it"
            " as legacy VTK",
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
            " short or its"
            " counts are wrong",
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
            VtkWriter("UNSTRUCTURED_GRID").points().grid([(3, [0, 1])]).data,
            "thing.vtk: a mesh must have a polygon with area, not none; add polygons",
        ),
    ],
)  # fmt: skip
def test_a_wrong_file_is_refused_with_its_place(tmp_path: Path, data: bytes, sentence: str) -> None:
    assert refusal(tmp_path, data) == sentence


def test_it_is_known_by_its_suffix_and_its_first_line(tmp_path: Path) -> None:
    for name in ("a.vtk", "a.dat"):
        path = tmp_path / name
        path.write_bytes(GOOD)
        found = format_of(path)
        assert found is not None
        assert found.name == "VTK"


def damaged_sources() -> Sequence[bytes]:
    return [
        VtkWriter("UNSTRUCTURED_GRID", binary=binary, version=version)
        .points([*CUBE, CENTER], "double")
        .grid([(12, AROUND), (5, [0, 1, 8]), (6, [0, 1, 2, 3]), (7, [0, 1, 2, 3, 8])])
        .line("POINT_DATA 9")
        .line("VECTORS v float")
        .numbers([*CUBE, CENTER], "float")
        .line("CELL_DATA 4\nFIELD f 1\nrow 1 4 int")
        .numbers(range(4), "int")
        .data
        for binary, version in FORMS
    ]


@pytest.mark.parametrize("data", damaged_sources(), ids=[f"{form}" for form in FORMS])
def test_damaged_files_are_read_or_refused(tmp_path: Path, data: bytes) -> None:
    assert len(read(tmp_path, data).mesh.scalars) == 2
    survives(read_vtk, tmp_path / "thing.vtk", data)
