"""VTK files, as VTK's own writers write them and by hand."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import MeshReport
from tests.autocolor.files.refusals import is_read_or_refused, refusal
from tests.tables import first

pytestmark = [pytest.mark.needs("vtkmodules"), pytest.mark.usefixtures("shared")]

CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1.0)])
HEXAHEDRON = (12, [0, 1, 3, 2, 4, 5, 7, 6])
FACES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]


def area_of(report: MeshReport) -> float:
    a, b, c, d = report.mesh.coordinates[report.mesh.node_numbers.T]
    pairs = ((b - a, c - a), (c - a, d - a))
    return float(sum(np.linalg.norm(np.cross(one, other), axis=1).sum() for one, other in pairs) / 2)


def volume_of(report: MeshReport) -> float:
    """The volume within the mesh, positive if it is turned outward."""
    a, b, c, d = report.mesh.coordinates[report.mesh.node_numbers.T]
    return float(sum(np.einsum("ij,ij->", a, np.cross(one, other)) for one, other in ((b, c), (c, d))) / 6)


# Data sets in memory.


def array(name: str, values: Any) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk

    made = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    made.SetName(name)
    return made


def points(places: Any) -> Any:
    from vtkmodules.vtkCommonCore import vtkPoints

    made = vtkPoints()
    made.SetData(array("points", np.asarray(places, np.float64)))
    return made


def grid(*cells: tuple[int, Any], places: Any = CUBE) -> Any:
    """An unstructured grid of cells by their types and nodes; those of a polyhedron are lists of faces."""
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid

    made = vtkUnstructuredGrid()
    made.SetPoints(points(places))
    for kind, nodes in cells:
        if kind == 42:
            faces = vtkCellArray()
            for face in nodes:
                faces.InsertNextCell(len(face), face)
            every = sorted({node for face in nodes for node in face})
            made.InsertNextCell(kind, len(every), every, faces)
        else:
            made.InsertNextCell(kind, len(nodes), nodes)
    made.GetCellData().AddArray(array("row", np.arange(len(cells), dtype=np.int32)))
    return made


def flat() -> Any:
    """Polygons and a strip with a vertex, a line, normals, scalars, a vector and a text."""
    from vtkmodules.vtkCommonCore import vtkStringArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    made = vtkPolyData()
    made.SetPoints(points([[x, y, 0] for y in range(3) for x in range(3)]))
    for what, cells in (
        ("Verts", [[0]]), ("Lines", [[0, 1]]), ("Polys", [[0, 1, 4, 3], [1, 2, 5, 8, 4]]),
        ("Strips", [[3, 4, 6, 7]]),
    ):  # fmt: skip
        lists = vtkCellArray()
        for cell in cells:
            lists.InsertNextCell(len(cell), cell)
        getattr(made, f"Set{what}")(lists)
    data = made.GetPointData()
    data.SetNormals(array("N", np.tile([0, 0, 2.0], (9, 1))))
    data.AddArray(array("heat", np.arange(9.0)))
    data.AddArray(array("v", np.tile([3, 4, 0], (9, 1))))
    data.AddArray(array("color", np.zeros((9, 3), np.uint8)))
    texts = vtkStringArray()
    texts.SetName("text")
    texts.SetNumberOfValues(9)
    data.AddArray(texts)
    made.GetCellData().AddArray(array("row", np.arange(5)))
    return made


def block(kind: str, *, sides: tuple[int, int, int] = (3, 4, 5), hidden: tuple[int, ...] = ()) -> Any:
    """A grid of cells of volume 1 along the axes, of which some cells may be hidden."""
    from vtkmodules import vtkCommonDataModel

    made = getattr(vtkCommonDataModel, kind)()
    made.SetDimensions(*sides)
    ranges = [np.arange(float(side)) for side in sides]
    if kind == "vtkStructuredGrid":
        z, y, x = np.meshgrid(*reversed(ranges), indexing="ij")
        # The grid is left-handed.
        made.SetPoints(points(np.stack([-x, y, z], axis=-1).reshape(-1, 3)))
    if kind == "vtkRectilinearGrid":
        for axis, values in zip("XYZ", ranges, strict=True):
            getattr(made, f"Set{axis}Coordinates")(array(axis, values))
    made.GetPointData().AddArray(array("node", np.arange(np.prod(sides), dtype=np.float32)))
    cells = int(np.prod([max(side - 1, 1) for side in sides]))
    made.GetCellData().AddArray(array("row", np.arange(cells)))
    if hidden:
        bits = np.zeros(cells, np.uint8)
        bits[list(hidden)] = 32
        made.GetCellData().AddArray(array("vtkGhostType", bits))
    return made


PYRAMID = [0, 1, 3, 2, 4]
MIDDLES = [8] * 12

SETS: dict[str, tuple[Any, str, tuple[int, int, float, float]]] = {
    "image": (lambda: block("vtkImageData"), "vti", (0, 52, 52, 24)),
    "layer": (lambda: block("vtkImageData", sides=(3, 1, 4)), "vti", (0, 6, 6, 0)),
    "hidden": (lambda: block("vtkImageData", sides=(3, 2, 2), hidden=(1,)), "vti", (0, 6, 6, 1)),
    "left-handed": (lambda: block("vtkStructuredGrid"), "vts", (0, 52, 52, 24)),
    "rectilinear": (lambda: block("vtkRectilinearGrid"), "vtr", (0, 52, 52, 24)),
    "flat": (flat, "vtp", (3, 2, 3.5, 0)),
    "hexahedron": (lambda: grid(HEXAHEDRON), "vtu", (0, 6, 6, 1)),
    "voxel": (lambda: grid((11, list(range(8)))), "vtu", (0, 6, 6, 1)),
    "two wedges": (lambda: grid((13, [0, 1, 3, 4, 5, 7]), (13, [0, 2, 3, 4, 6, 7])), "vtu", (4, 4, 6, 1)),
    "pyramid": (lambda: grid((14, PYRAMID)), "vtu", (4, 1, 2 + np.sqrt(2), 1 / 3)),
    "polyhedron": (lambda: grid((42, FACES)), "vtu", (0, 6, 6, 1)),
    "with its faces": (
        lambda: grid(HEXAHEDRON, *[(9, face) for face in FACES[:2]], (5, [0, 1, 2])), "vtu", (1, 6, 6.5, 1)
    ),
    "higher order": (
        lambda: grid((22, [0, 1, 2, 8, 8, 8]), (25, [*HEXAHEDRON[1], *MIDDLES]), places=[*CUBE, [9, 9, 9]]),
        "vtu", (1, 6, 6.5, 1),
    ),
    "pixel, strip and polygon": (
        lambda: grid((8, [0, 1, 2, 3]), (6, [4, 5, 6, 7]), (7, [0, 1, 5, 4]), (1, [0])),
        "vtu", (2, 2, 3, 1 / 3),
    ),
}  # fmt: skip
"""Data sets with their triangles, quads, area and volume."""

WRITERS = {"vti": "ImageData", "vts": "StructuredGrid", "vtr": "RectilinearGrid", "vtp": "PolyData",
           "vtu": "UnstructuredGrid"}  # fmt: skip


def by_vtk(folder: Path, data: Any, suffix: str, mode: str = "Ascii", packed: str = "None") -> Path:
    """A file of XML, or a legacy file, as VTK writes it."""
    from vtkmodules import vtkIOLegacy, vtkIOXML

    path = folder / f"set.{suffix}"
    if suffix == "vtk":
        writer = vtkIOLegacy.vtkDataSetWriter()
        writer.SetFileType(1 if mode == "Ascii" else 2)
        writer.SetFileVersion(42 if packed == "None" else 51)
    else:
        writer = getattr(vtkIOXML, f"vtkXML{WRITERS[suffix]}Writer")()
        getattr(writer, f"SetDataModeTo{mode.removesuffix('64')}")()
        getattr(writer, f"SetCompressorTypeTo{packed}")()
        writer.SetEncodeAppendedData(mode == "Appended64")
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    writer.Write()
    return path


def counts(report: MeshReport) -> list[float]:
    """The triangles, quads, area and volume of a mesh."""
    triangles = report.mesh.triangle_count
    quads = len(report.mesh.node_numbers) - triangles
    return [triangles, quads, area_of(report), volume_of(report)]


ENCODINGS = [
    ("vtk", "Ascii", "None"), ("", "Appended", "LZ4"), ("vtk", "Binary", "None"), ("vtk", "Ascii", "51"),
    ("vtk", "Binary", "51"),
    *(("", *each) for each in product(("Ascii", "Binary", "Appended64"), ("None", "ZLib", "LZMA"))),
]  # fmt: skip


@pytest.mark.parametrize("encoding", first(2, ENCODINGS), ids=" ".join)
@pytest.mark.parametrize("name", SETS)
def test_a_data_set_has_its_surface_in_every_encoding(
    tmp_path: Path, name: str, encoding: tuple[str, str, str]
) -> None:
    make, suffix, expected = SETS[name]
    data = make()
    report = read_mesh({"file": by_vtk(tmp_path, data, encoding[0] or suffix, *encoding[1:])})
    assert counts(report) == pytest.approx(list(expected))
    # Scalars of cells come with the polygons that the cells became.
    mesh = report.mesh
    values = {each.name: each.values for each in mesh.scalars}
    cells = np.arange(data.GetNumberOfCells())
    assert set(values["row"].tolist()) <= set(cells.tolist())
    for node, place in zip(values.get("node", ()), mesh.coordinates, strict=False):
        assert np.allclose(place, data.GetPoint(int(node)))


def test_what_is_left_out_is_told(tmp_path: Path) -> None:
    report = read_mesh({"file": by_vtk(tmp_path, flat(), "vtp")})
    assert report.repairs == (
        "set.vtp: skipped vertices: 1",
        "set.vtp: skipped lines: 1",
        "set.vtp: skipped arrays of colors: 1",
        "set.vtp: skipped arrays of texts: 1",
        "set.vtp: 1 polygon with more than four corners was split",
    )
    assert {each.name: each.values.tolist()[:2] for each in report.mesh.scalars} == {
        "heat": [0, 1], "v magnitude": [5, 5], "row": [2, 3],
    }  # fmt: skip
    make, suffix, _ = SETS["higher order"]
    assert read_mesh({"file": by_vtk(tmp_path, make(), suffix)}).repairs == (
        "set.vtu: took the corners alone of cells of higher order: 2",
        "set.vtu: took the outer surface of 1 volume cell",
        "set.vtu: left out 1 node that the surface does not use",
    )
    make, suffix, _ = SETS["with its faces"]
    assert (
        "set.vtu: left out polygons that are faces of volume cells: 2"
        in read_mesh({"file": by_vtk(tmp_path, make(), suffix)}).repairs
    )


def test_all_pieces_and_scalars_of_a_file_are_read(tmp_path: Path) -> None:
    piece = (
        '<Piece NumberOfPoints="3" NumberOfPolys="1"><Points><DataArray type="Float32"'
        ' NumberOfComponents="3" format="ascii">{0} 0 0 {1} 0 0 {1} 1 0</DataArray></Points><Polys><DataArray'
        ' type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray><DataArray type="Int32"'
        ' Name="offsets" format="ascii">3</DataArray></Polys></Piece>'
    )
    path = tmp_path / "a.vtp"
    path.write_text(
        f'<VTKFile type="PolyData"><PolyData>{piece.format(0, 1)}{piece.format(5, 7)}</PolyData></VTKFile>'
    )
    assert read_mesh({"file": path}).mesh.bounds[1].tolist() == [7, 1, 0]
    legacy = tmp_path / "a.vtk"
    legacy.write_bytes(
        (TEXT + b"POINT_DATA 4\nSCALARS a float\nLOOKUP_TABLE default\n1 2 3 4\nSCALARS b%20c int 1\n"
         b"LOOKUP_TABLE default\n5 6 7 8\nTENSORS s float\n" + b"3 0 0 0 0 0 0 0 0 " * 4
         ).replace(b"\n", b"\r")
    )  # fmt: skip
    mesh = read_mesh({"file": legacy}).mesh
    assert {each.name: each.values[0] for each in mesh.scalars} == {"a": 1, "b c": 5, "s von Mises": 3}


# What is refused.

TEXT = (
    b"# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n"
    b"POLYGONS 1 5\n4 0 1 2 3\n"
)
CELLS = TEXT[: TEXT.index(b"POLYGONS")].replace(b"POLYDATA", b"UNSTRUCTURED_GRID")
END = "; correct the file, or write it as OBJ or PLY"
CANNOT = "a.vtk: VTK must be able to read it, and cannot ({})" + END
XML = (
    "a.vtp: the type of a VTK XML file must be PolyData, UnstructuredGrid, StructuredGrid, RectilinearGrid or"
    " ImageData, not {}; write its surface as .vtp"
)
DATA = "Error reading ascii data. Possible mismatch of datasize with declaration"


@pytest.mark.parametrize(
    ("name", "data", "sentence"),
    [
        ("a.vtk", TEXT.replace(b" 2 3\n", b" 2 99\n"),
         f"a.vtk: a cell must have nodes of the file, from 0 to 3, not 99 (cell 1){END}"),
        ("a.vtk", TEXT.replace(b"0 1 0\n", b"0 nan 0\n"),
         "a.vtk: VTK gave a node whose coordinates are not finite and at most 1e30 in size, [0.0, nan, 0.0]"
         f" (node 4){END}"),
        ("a.vtk", TEXT.replace(b"0 1 0\n", b"0 1\n"), CANNOT.format(DATA)),
        ("a.vtk", TEXT[: TEXT.index(b" 0 1 0\n")], CANNOT.format(DATA)),
        ("a.vtk", TEXT[:-3], CANNOT.format("Error reading ascii cell data! for file:")),
        ("a.vtk", TEXT + b"POINT_DATA 4\nSCALARS a float\nLOOKUP_TABLE default\n1 2\n", CANNOT.format(DATA)),
        ("a.vtk", TEXT + b"WORDS 3\n", CANNOT.format("Unrecognized keyword: words")),
        ("a.vtk", CELLS + b"CELLS 1 7\n6 0 1 2 3 0 1\nCELL_TYPES 1\n12\n",
         f"a.vtk: a cell of the type 12 must have 8 nodes, not 6{END}"),
        ("a.vtk", CELLS + b"CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n41\n",
         f"a.vtk: a cell must be of a type with faces, not of the type 41{END}"),
        ("a.vtk", CELLS + b"CELLS 1 3\n2 0 1\nCELL_TYPES 1\n3\n",
         f"a.vtk: it must have polygons or volume cells; skipped lines: 1{END}"),
        ("a.vtk", TEXT[: TEXT.index(b"POLYGONS")],
         f"a.vtk: it must have nodes and cells, not 4 nodes and 0 cells{END}"),
        ("a.vtp", b'<VTKFile type="vtkMultiBlockDataSet"/>', XML.format("'vtkMultiBlockDataSet'")),
        ("a.vtp", b'<VTKFile type="PPolyData"/>', XML.format("'PPolyData'")),
        ("a.vtp", b"<x/>", XML.format("'none'")),
        ("a.vtp", b'<VTKFile type="PolyData">', CANNOT.replace(".vtk", ".vtp").format(
            "Error parsing XML in stream at line 1, column 25, byte index 25: no element found")),
    ],
)  # fmt: skip
def test_what_is_refused(tmp_path: Path, name: str, data: bytes, sentence: str) -> None:
    (tmp_path / name).write_bytes(data)
    assert refusal(read_mesh, {"file": tmp_path / name}) == sentence


@pytest.mark.parametrize("suffix", ["vtk", "vtp", "vtu"])
def test_a_file_cut_anywhere_is_refused_or_loses_whole_sections(tmp_path: Path, suffix: str) -> None:
    path = by_vtk(tmp_path, grid(HEXAHEDRON) if suffix == "vtu" else flat(), suffix)
    data = path.read_bytes()
    whole = read_mesh({"file": path}).mesh
    for length in range(0, len(data) - 9, len(data) // 40):
        path.write_bytes(data[:length])
        try:
            mesh = read_mesh({"file": path}).mesh
        except InputError:
            continue
        # A legacy file may end after any section.
        assert suffix == "vtk"
        assert set(map(tuple, mesh.coordinates)) <= set(map(tuple, whole.coordinates))


@given(share=st.floats(0, 1), data=st.binary(max_size=40) | st.text("POINTSDATA 019.-\n").map(str.encode))
def test_any_bytes_at_any_place_are_read_or_refused(
    share: float, data: bytes, tmp_path_factory: pytest.TempPathFactory
) -> None:
    assert is_read_or_refused(tmp_path_factory.getbasetemp() / "a.vtk", TEXT[: int(share * len(TEXT))] + data)
