"""VTK files, as VTK's own writers write them and by hand."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import Placement
from tests.autocolor.files.foreign.conftest import CUBE, SIDES, area_and_volume
from tests.autocolor.files.refusals import refusal
from tests.tables import first

pytestmark = [pytest.mark.needs("vtkmodules"), pytest.mark.usefixtures("shared")]


def numbers(values: Any) -> str:
    return " ".join(map(str, np.ravel(values).tolist()))


def scalars(name: str, values: Any, type_: str = "int") -> str:
    return f"SCALARS {name} {type_} 1\nLOOKUP_TABLE default\n{numbers(values)}\n"


def lists(what: str, cells: Iterable[list[int]]) -> str:
    rows = [[len(cell), *cell] for cell in cells]
    return f"{what} {len(rows)} {sum(map(len, rows))}\n{numbers(np.concatenate(rows))}\n"


def grid(*cells: tuple[int, list[int]], places: Any = CUBE) -> str:
    """Cells by their types and nodes."""
    return (
        f"UNSTRUCTURED_GRID\nPOINTS {len(places)} double\n{numbers(places)}\n"
        f"{lists('CELLS', [cell for _, cell in cells])}CELL_TYPES {len(cells)}\n"
        f"{numbers([type_ for type_, _ in cells])}\n"
        f"CELL_DATA {len(cells)}\n{scalars('row', range(len(cells)))}"
    )


def block(what: str, *sides: int, hidden: bool = False) -> str:
    """A grid of cells of volume 1 along the axes, of which the last may be hidden."""
    z, y, x = np.meshgrid(*map(np.arange, sides[::-1]), indexing="ij")
    along = [
        f"{axis}_COORDINATES {side} int\n{numbers(range(side))}\n"
        for axis, side in zip("XYZ", sides, strict=True)
    ]
    # The structured grid is left-handed.
    geometry = {
        "STRUCTURED_POINTS": "ORIGIN 0 0 0\nSPACING 1 1 1\n",
        "STRUCTURED_GRID": f"POINTS {x.size} int\n{numbers(np.stack([-x, y, z], axis=-1))}\n",
        "RECTILINEAR_GRID": "".join(along),
    }
    cells = int(np.prod([max(side - 1, 1) for side in sides]))
    ghosts = scalars("vtkGhostType", [0] * (cells - 1) + [32 * hidden], "unsigned_char")
    return (
        f"{what}\nDIMENSIONS {numbers(sides)}\n{geometry[what]}CELL_DATA {cells}\n{ghosts}"
        f"{scalars('row', range(cells))}POINT_DATA {x.size}\n{scalars('node', range(x.size))}"
    )


FLAT = (
    f"POLYDATA\nPOINTS 9 float\n{numbers([[x, y, 0] for y in range(3) for x in range(3)])}\n"
    f"{lists('VERTICES', [[0]])}{lists('LINES', [[0, 1]])}"
    f"{lists('POLYGONS', [[0, 1, 4, 3], [1, 2, 5, 8, 4]])}{lists('TRIANGLE_STRIPS', [[3, 4, 6, 7]])}"
    f"CELL_DATA 5\n{scalars('row', range(5))}POINT_DATA 9\n{scalars('heat', range(9))}"
    f"VECTORS v float\n{'3 4 0 ' * 9}\nNORMALS N float\n{'0 0 2 ' * 9}\n"
    f"COLOR_SCALARS color 3\n{'0 0 1 ' * 9}\nFIELD f 1\ntext 1 9 string\n" + "a\n" * 9
)
"""Polygons and a strip with a vertex, a line, normals, scalars, a vector, a color and a text."""

HEXAHEDRON = (12, [0, 1, 3, 2, 4, 5, 7, 6])
POLYHEDRON = (42, [6, *(number for side in SIDES for number in (4, *side))])

SETS = {
    "image": (block("STRUCTURED_POINTS", 3, 4, 5), "vti", (0, 52, 52, 24)),
    "layer": (block("STRUCTURED_POINTS", 3, 1, 4), "vti", (0, 6, 6, 0)),
    "hidden": (block("STRUCTURED_POINTS", 3, 2, 2, hidden=True), "vti", (0, 6, 6, 1)),
    "left-handed": (block("STRUCTURED_GRID", 3, 4, 5), "vts", (0, 52, 52, 24)),
    "rectilinear": (block("RECTILINEAR_GRID", 3, 4, 5), "vtr", (0, 52, 52, 24)),
    "flat": (FLAT, "vtp", (3, 2, 3.5, 0)),
    "tetra": (grid((10, [0, 2, 1, 4])), "vtu", (4, 0, 1.5 + np.sqrt(0.75), 1 / 6)),
    "voxel": (grid((11, [*range(8)])), "vtu", (0, 6, 6, 1)),
    "two wedges": (grid((13, [0, 1, 3, 4, 5, 7]), (13, [0, 2, 3, 4, 6, 7])), "vtu", (4, 4, 6, 1)),
    "pyramid on a cube": (
        grid(HEXAHEDRON, (14, [4, 5, 7, 6, 8]), places=[*CUBE, (0.5, 0.5, 2)]),
        "vtu", (4, 5, 5 + np.sqrt(5), 4 / 3),
    ),
    "polyhedron": (grid(POLYHEDRON), "vtu", (0, 6, 6, 1)),
    "with its faces": (
        grid(HEXAHEDRON, *[(9, side) for side in SIDES[:2]], (5, [0, 1, 2])), "vtu", (1, 6, 6.5, 1)
    ),
    "higher order": (
        grid((22, [0, 1, 2, 8, 8, 8]), (25, [*HEXAHEDRON[1], *[8] * 12]), places=[*CUBE, [9, 9, 9]]),
        "vtu", (1, 6, 6.5, 1),
    ),
    "pixel, strip and polygon": (
        grid((8, [0, 1, 2, 3]), (6, [4, 5, 6, 7]), (7, [0, 1, 5, 4]), (1, [0])), "vtu", (2, 2, 3, 1 / 3)
    ),
}  # fmt: skip
"""Data sets with their triangles, quads, area and volume."""


def data_set(name: str) -> Any:
    from vtkmodules.vtkIOLegacy import vtkDataSetReader

    reader = vtkDataSetReader()
    reader.ReadFromInputStringOn()
    for what in ("Scalars", "Vectors", "Normals", "Fields", "ColorScalars"):
        getattr(reader, f"ReadAll{what}On")()
    reader.SetInputString(f"# vtk DataFile Version 3.0\n\nASCII\nDATASET {SETS[name][0]}")
    reader.Update()
    return reader.GetOutputDataObject(0)


def by_vtk(folder: Path, data: Any, suffix: str, mode: str = "Ascii", packed: str = "None") -> Path:
    """A file of XML, or a legacy file, as VTK writes it."""
    from vtkmodules import vtkIOLegacy, vtkIOXML

    path = folder / f"set.{suffix}"
    if suffix == "vtk":
        writer = vtkIOLegacy.vtkDataSetWriter()
        writer.SetFileType(1 if mode == "Ascii" else 2)
        writer.SetFileVersion(42 if packed == "None" else 51)
    else:
        kind = data.GetClassName()[3:].replace("StructuredPoints", "ImageData")
        writer = getattr(vtkIOXML, f"vtkXML{kind}Writer")()
        getattr(writer, f"SetDataModeTo{mode.removesuffix('64')}")()
        getattr(writer, f"SetCompressorTypeTo{packed}")()
        writer.SetEncodeAppendedData(mode == "Appended64")
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    writer.Write()
    return path


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
    _, suffix, expected = SETS[name]
    data = data_set(name)
    report = read_mesh({"file": by_vtk(tmp_path, data, encoding[0] or suffix, *encoding[1:])})
    mesh = report.mesh
    triangles = mesh.triangle_count
    found = (triangles, len(mesh.node_numbers) - triangles, *area_and_volume(report))
    assert found == pytest.approx(expected, abs=1e-6)
    # The values of a cell come with the polygons that it became.
    values = {each.name: each.values for each in mesh.scalars}
    for row, corners in zip(values["row"].tolist(), mesh.node_numbers, strict=True):
        low, high = np.reshape(data.GetCell(int(row)).GetBounds(), (3, 2)).T
        places = mesh.coordinates[corners]
        assert ((places >= low) & (places <= high)).all()
    for node, place in zip(values.get("node", ()), mesh.coordinates, strict=False):
        assert np.allclose(place, data.GetPoint(int(node)))


def test_what_is_left_out_is_told(tmp_path: Path) -> None:
    report = read_mesh({"file": by_vtk(tmp_path, data_set("flat"), "vtp")})
    assert report.repairs == (
        "set.vtp: skipped vertices: 1",
        "set.vtp: skipped lines: 1",
        "set.vtp: left out arrays that are no scalars: 'color' and 'text'",
        "set.vtp: 1 polygon with more than four corners was split",
    )
    assert {each.name: each.values.tolist()[:2] for each in report.mesh.scalars} == {
        "heat": [0, 1], "v magnitude": [5, 5], "row": [2, 3],
    }  # fmt: skip
    mesh = read_mesh({"file": tmp_path / "set.vtp"}, Placement(normals="file")).mesh
    assert mesh.own_normals is not None
    assert mesh.own_normals.vectors[mesh.own_normals.numbers].tolist() == [[[0, 0, 1]] * 4] * 5
    assert read_mesh({"file": by_vtk(tmp_path, data_set("higher order"), "vtu")}).repairs == (
        "set.vtu: took the corners alone of cells of the type 22: 1",
        "set.vtu: took the corners alone of cells of the type 25: 1",
        "set.vtu: took the outer surface of 1 volume cell",
        "set.vtu: left out 1 node that the surface does not use",
    )
    repairs = read_mesh({"file": by_vtk(tmp_path, data_set("with its faces"), "vtu")}).repairs
    assert repairs[1] == "set.vtu: left out polygons that are faces of volume cells: 2"


def test_all_pieces_and_scalars_of_a_file_are_read(tmp_path: Path) -> None:
    path = by_vtk(tmp_path, data_set("flat"), "vtp")
    text = path.read_text()
    first, end = text.index("<Piece"), text.index("</PolyData>")
    path.write_text(text[:end] + text[first:end] + text[end:])
    assert len(read_mesh({"file": path}).mesh.node_numbers) == 2 * 5
    legacy = tmp_path / "a.vtk"
    legacy.write_bytes(
        TEXT + b"POINT_DATA 4\nSCALARS a float\nLOOKUP_TABLE default\n1 2 3 4\nSCALARS b%20c int 1\n"
         b"LOOKUP_TABLE default\n5 6 7 8\nTENSORS s float\n" + b"3 0 0 0 0 0 0 0 0 " * 4

    )  # fmt: skip
    mesh = read_mesh({"file": legacy}).mesh
    assert {each.name: each.values[0] for each in mesh.scalars} == {"a": 1, "b c": 5, "s von Mises": 3}


TEXT = (
    b"# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n"
    b"POLYGONS 1 5\n4 0 1 2 3\n"
)
CELLS = TEXT[: TEXT.index(b"POLYGONS")].replace(b"POLYDATA", b"UNSTRUCTURED_GRID")
END = "; correct the file, or write it as OBJ or PLY"
CANNOT = "a.vtk: VTK must be able to read it, and cannot ({})" + END
XML = (
    "a.vtp: the type of a VTK XML file must be one of PolyData, UnstructuredGrid, StructuredGrid,"
    " RectilinearGrid, ImageData; write its surface as .vtp"
)
DATA = "Error reading ascii data. Possible mismatch of datasize with declaration"


@pytest.mark.parametrize(
    ("name", "data", "sentence"),
    [
        ("a.vtk", TEXT.replace(b" 2 3\n", b" 2 99\n"),
         f"a.vtk: cells must have nodes of the file, from 0 to 3, not 99{END}"),
        ("a.vtk", TEXT + b"POINT_DATA 4\nSCALARS a float\nLOOKUP_TABLE default\n1 2\n", CANNOT.format(DATA)),
        ("a.vtk", TEXT + b"WORDS 3\n", CANNOT.format("Unrecognized keyword: words")),
        ("a.vtk", CELLS + b"CELLS 1 7\n6 0 1 2 3 0 1\nCELL_TYPES 1\n12\n",
         f"a.vtk: all cells of the type 12 must have 8 nodes{END}"),
        ("a.vtk", CELLS + b"CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n41\n",
         f"a.vtk: a cell must be of a type with faces, not of the type 41{END}"),
        ("a.vtk", CELLS + b"CELLS 1 3\n2 0 1\nCELL_TYPES 1\n3\n",
         f"a.vtk: it must have polygons or volume cells; skipped lines: 1{END}"),
        ("a.vtk", TEXT[: TEXT.index(b"POLYGONS")],
         f"a.vtk: it must have nodes and cells, and has none{END}"),
        ("a.vtp", b'<VTKFile type="vtkMultiBlockDataSet"/>', XML),
    ],
)  # fmt: skip
def test_what_is_refused(tmp_path: Path, name: str, data: bytes, sentence: str) -> None:
    (tmp_path / name).write_bytes(data)
    assert refusal(read_mesh, {"file": tmp_path / name}) == sentence
