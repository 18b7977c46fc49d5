"""Files of Abaqus, Nastran, Gmsh, Medit, SU2 and UGRID: written by meshio, and by hand."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import MeshReport
from tests.autocolor.files.refusals import refusal
from tests.tables import first

pytestmark = [pytest.mark.needs("meshio"), pytest.mark.usefixtures("shared")]


def area_and_volume(report: MeshReport) -> tuple[float, float]:
    a, b, c, d = report.mesh.coordinates[report.mesh.node_numbers.T]
    pairs = ((b - a, c - a), (c - a, d - a))
    area = sum(np.linalg.norm(np.cross(one, other), axis=1).sum() for one, other in pairs) / 2
    volume = sum(np.einsum("ij,ij->", a, np.cross(one, other)) for one, other in ((b, c), (c, d))) / 6
    return round(float(area), 9), round(float(volume), 9)


def read_text(folder: Path, name: str, text: str, **others: str) -> MeshReport:
    for other, content in others.items():
        (folder / f"{other}.txt").write_text(content)
    (folder / name).write_text(text)
    return read_mesh({"file": folder / name})


def told(report: MeshReport) -> list[str]:
    """The messages about a file, without its name and without unused nodes."""
    return [each.partition(": ")[2] for each in report.repairs if "no polygon uses" not in each]


SURFACE = ("took the outer surface of 1 volume cell",)

# A cube that meshio writes.

CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1.0)])
CELLS = {
    "hexahedron": [[0, 1, 3, 2, 4, 5, 7, 6]],
    "wedge": [[0, 1, 3, 4, 5, 7], [0, 3, 2, 4, 7, 6]],
    "tetra": [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]],
    "pyramid": [[0, 1, 5, 4, 8], [1, 3, 7, 5, 8], [3, 2, 6, 7, 8], [2, 0, 4, 6, 8], [0, 2, 3, 1, 8],
                [4, 5, 7, 6, 8]],
    "quad": [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]],
}  # fmt: skip
WRITTEN = [
    (name, kind, options)
    for name, kinds, options in [
        ("a.msh", CELLS, {"fmt_version": "4.1", "binary": True}),
        ("a.bdf", CELLS, {}),
        ("a.inp", ["hexahedron", "wedge", "tetra", "quad"], {}),
        ("a.mesh", CELLS, {}),
        ("a.meshb", CELLS, {}),
        ("a.su2", ["hexahedron", "wedge", "tetra", "pyramid"], {}),
        ("a.b8.ugrid", CELLS, {}),
        ("a.msh", CELLS, {"fmt_version": "2.2", "binary": True}),
        ("a.msh", CELLS, {"fmt_version": "2.2", "binary": False}),
        ("a.msh", CELLS, {"fmt_version": "4.0", "binary": True}),
        ("a.msh", CELLS, {"fmt_version": "4.0", "binary": False}),
        ("a.msh", CELLS, {"fmt_version": "4.1", "binary": False}),
        ("a.lr8.ugrid", CELLS, {}),
        ("a.lb4.ugrid", CELLS, {}),
    ]
    for kind in kinds
]
FORMATS = {"inp": "abaqus", "msh": "gmsh", "bdf": "nastran", "mesh": "medit", "meshb": "medit"}


@pytest.mark.parametrize("case", first(40, WRITTEN))
def test_a_cube_of_each_kind_of_cell_is_read(tmp_path: Path, case: tuple[str, str, dict[str, Any]]) -> None:
    import meshio

    name, kind, options = case
    mesh = meshio.Mesh(np.vstack([CUBE, [0.5, 0.5, 0.5]]), [(kind, np.array(CELLS[kind]))])
    suffix = name.split(".")[-1]
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        getattr(meshio, FORMATS.get(suffix, suffix)).write(tmp_path / name, mesh, **options)
    report = read_mesh({"file": tmp_path / name})
    assert area_and_volume(report) == (6, 1)
    assert len(report.mesh.node_numbers) == {"tetra": 12, "wedge": 8}.get(kind, 6)


# Abaqus.

SQUARE = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n"
SHELL = "*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n"
TOP = "5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1\n"
INSTANCE = "*INSTANCE, NAME=P-1, PART=P\n"
PART = f"*PART, NAME=p\n{SQUARE}{SHELL}*END PART\n"


@pytest.mark.parametrize(
    ("text", "area", "parts", "sentences"),
    [
        (SQUARE.replace("3,", "** others\n\n3,") + SHELL, 1, ("a",), ()),
        ("*node, nset=all\n1,0.,\n2,1.D0,0\n3,1d+0,1.,,0,0,1\n4,0.,1.\n"
         "*Element, type=s4r5,\n elset=Hood\n1,1,2,3,4\n", 1, ("Hood",), ()),
        (SQUARE + SHELL + "*NODE\n20, 2, 0\n21, 2, 1\n*ELEMENT, TYPE=M3D4\n2, 2, 20, 21, 3\n", 2, ("a",), ()),
        (SQUARE + TOP + "*ELEMENT, TYPE=C3D8R\n1, 1, 2, 3, 4,\n5, 6, 7, 8\n", 6, ("a",), SURFACE),
        (SQUARE + SHELL + "*ELEMENT, TYPE=SPRINGA\n2, 1, 2\n3, 2, 3\n*ELEMENT, TYPE=MASS\n4, 4\n"
         "*ELEMENT, TYPE=B31\n5, 1, 2\n*STEP\n*NODE PRINT\nU\n", 1, ("a",),
         ("skipped: springs (2)", "skipped: masses (1)", "skipped: beams (1)")),
        (SQUARE + TOP + "*ELEMENT, TYPE=S3\n1, 1, 2, 3\n*ELEMENT, TYPE=S3, ELSET=b\n2, 1, 3, 4\n"
         "*ELEMENT, TYPE=S4, ELSET=b\n3, 5, 6, 7, 8\n*ELSET, ELSET=c\nB, 1\n*ELSET, ELSET=_d, INTERNAL\n1\n",
         2, ("b", "c"), ()),
        (SQUARE + "*ELEMENT, TYPE=S3\n1, 1, 2, 3\n2, 1, 3, 4\n*ELSET, ELSET=e, GENERATE\n2, 2\n",
         1, ("a", "e"), ()),
        (PART + "*PART, NAME=Q\n*NODE\n1, 9\n*END PART\n*ASSEMBLY, NAME=A\n" + INSTANCE
         + "*END INSTANCE\n*NODE\n1, 5, 5, 5\n*ELSET, ELSET=x, INSTANCE=P-1\n1\n", 1, ("x",), ()),
        (INSTANCE + SQUARE + SHELL + "*END INSTANCE\n", 1, ("a",), ()),
        ("*SYSTEM\n*INCLUDE, INPUT=one.txt\n*element, type=S4\n*include, input = two.txt\n", 1, ("a",), ()),
    ],
)  # fmt: skip
def test_abaqus_texts_are_read(
    tmp_path: Path, text: str, area: float, parts: tuple[str, ...], sentences: tuple[str, ...]
) -> None:
    report = read_text(tmp_path, "a.inp", text, one=SQUARE, two="1,1,2,3,4\n")
    assert area_and_volume(report)[0] == area
    assert report.mesh.part_names == parts
    assert told(report) == list(sentences)


MADE = "nodes and elements must be written out, not made by"
CANNOT = "meshio must be able to read it, and cannot"
INCLUDED = "an included file must be the name of a file"

ABAQUS_REFUSED = [
    *((f"{SQUARE}*{keyword}\n1, 2\n{SHELL}", f"{MADE} *{keyword} (line 6)")
      for keyword in ("NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY", "SYSTEM", "PARAMETER")),
    (SQUARE.replace("*NODE", "*NODE, SYSTEM=C") + SHELL, "*NODE must have no SYSTEM= (line 1)"),
    *((PART + INSTANCE + placement, "an assembly must be one part that is not moved, not *INSTANCE (line 10)")
      for placement in ("1., 0., 0.\n*END INSTANCE\n", INSTANCE)),
    (PART + PART.replace("=p", "=q"), "several *PART must be placed by an *INSTANCE (line 11)"),
    (SQUARE + "*ELEMENT, TYPE=S7\n1, 1, 2, 3, 4\n", "element type 'S7' is not known (line 6)"),
    (SQUARE + "*ELEMENT, TYPE=S4\n1, 1, 2, 3\n", "elements of type S4 must have 4 nodes (line 6)"),
    (SQUARE + SHELL.replace(" 4\n", " 9\n"), f"{CANNOT} (there is no node 9)"),
    (SQUARE.replace("1.", "x") + SHELL, f"{CANNOT} (could not convert string to float: 'X')"),
    (SQUARE, "the file must have nodes of two or three coordinates, and elements"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "reason"), ABAQUS_REFUSED)
def test_abaqus_texts_that_meshio_would_misread_are_refused(tmp_path: Path, text: str, reason: str) -> None:
    (tmp_path / "a.inp").write_text(text)
    sentence = refusal(read_mesh, {"file": tmp_path / "a.inp"})
    assert sentence == f"a.inp: {reason}; correct the file, or write it as OBJ or PLY"


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("../a.txt", f"a.inp, line 1: {INCLUDED} in the scene's folder, not '../a.txt'; copy the file there"),
        (
            "http://b/c",
            f"a.inp, line 1: {INCLUDED}, not the address 'http://b/c'; fetch it and name the file",
        ),
        ("a.inp", "a.inp: it must include at most 100 files, not more; join them"),
    ],
)
def test_included_files_are_in_the_folder_and_few(tmp_path: Path, name: str, sentence: str) -> None:
    (tmp_path / "a.inp").write_text(f"*INCLUDE, INPUT={name}\n{SQUARE}{SHELL}")
    assert refusal(read_mesh, {"file": tmp_path / "a.inp"}) == sentence


# Nastran.

GRIDS = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n"
UPPER = "".join(
    f"GRID    {row + 5:<16d}{x:<8}{y:<8}1.\n"
    for row, (x, y) in enumerate([("0.", "0."), ("1.", "0."), ("1.", "1."), ("0.", "1.")])
)
QUAD = "CQUAD4,1,7,1,2,3,4,45.,0.1\n"
HEXA = "".join(f"{each:<8}" for each in ("CHEXA", 1, 7, 1, 2, 3, 4, 5, 6))


@pytest.mark.parametrize(
    ("bulk", "area", "sentences"),
    [
        (f"{GRIDS}$ text\n{QUAD}CELAS1,2,1,1,1\nCONM2,3,1\nRBE2,4,1,123,2\n", 1,
         ("skipped: CELAS1 (1)", "skipped: CONM2 (1)", "skipped: RBE2 (1)")),
        (f"{GRIDS}{UPPER}{HEXA}+A\n+A      7       8\n", 6, SURFACE),
        (f"{GRIDS}{UPPER}{HEXA}\n        7       8\n".lower(), 6, SURFACE),
        (f"GRID*   1{'':31}0.              0.              *A\n*A      0.\nGRID*   2{'':31}.1+1\n{GRIDS[34:]}"
         f"CTRIAR  1       7       1       2       3\nCTRIA3  2       8       1       3       4\n", 1, ()),
        ("INCLUDE 'one.txt'\n" + QUAD, 1, ()),
        (f"CORD2R,5,0,1.,0.,0.,1.,0.,1.,+\n+,2.,0.,0.\nGRDSET,,5\n{GRIDS.replace(',,', ',0,')}{QUAD}", 1, ()),
        (f"{GRIDS}GRID,5,,.5\nGRID,6,,1.,.5\nGRID,7,,.5,.5\nCTRIAX6,1,7,1,5,2,6,3,7\n", 0.5, ()),
    ],
)  # fmt: skip
def test_nastran_texts_are_read(tmp_path: Path, bulk: str, area: float, sentences: tuple[str, ...]) -> None:
    report = read_text(tmp_path, "a.bdf", f"SOL 101\nBEGIN BULK\n{bulk}ENDDATA\n", one=GRIDS)
    assert area_and_volume(report)[0] == area
    assert report.mesh.part_names == (("part 7", "part 8") if "CTRIAR" in bulk else ("part 7",))
    assert told(report) == list(sentences)


BASIC = "node 4 must be in the basic coordinate system, not in"


@pytest.mark.parametrize(
    ("bulk", "reason"),
    [
        (f"CORD2R,5,0,1.\n{GRIDS.replace('4,,', '4,5,')}{QUAD}", f"{BASIC} CORD2R 5 (line 6)"),
        (f"CORD1C,5,1,2,3\nGRDSET,,5\n{GRIDS[:51].replace(',,', ',0,')}GRID*   4{'':31}1.\n{QUAD}",
         f"{BASIC} CORD1C 5 (line 7)"),
        (f"{GRIDS}{HEXA}+A\n+B      7       8\n", "a line that continues a card must follow it (line 7)"),
        *((f"{GRIDS}{line}\n", f"bulk data must be one list of whole cards, not '{line}' (line 6)")
          for line in ("=,*1,=", "BEGIN SUPER=1")),
        (f"{GRIDS}CQUAD9,1,7,1,2,3,4\n", "element type 'CQUAD9' is not known (line 6)"),
        (f"{GRIDS}CQUAD4,1,7,1,2,3\n", "CQUAD4 1 must have 4 corners (line 6)"),
        (f"{GRIDS}{QUAD.replace(',4,', ',9,')}", f"{CANNOT} (there is no node 9)"),
    ],
)  # fmt: skip
def test_nastran_texts_that_meshio_would_misread_are_refused(tmp_path: Path, bulk: str, reason: str) -> None:
    (tmp_path / "a.nas").write_text(f"BEGIN BULK\n{bulk}ENDDATA\n")
    sentence = refusal(read_mesh, {"file": tmp_path / "a.nas"})
    assert sentence == f"a.nas: {reason}; correct the file, or write it as OBJ or PLY"


def test_a_nastran_text_that_is_cut_short_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.fem").write_text(f"BEGIN BULK\n{GRIDS}{QUAD}")
    assert "bulk data must end with ENDDATA" in refusal(read_mesh, {"file": tmp_path / "a.fem"})


# Gmsh.

MSH2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
NODES2 = "$Nodes\n4\n10 0 0 0\n20 1 0 0\n40 0 1 0\n30 1 1 0\n$EndNodes\n"
CELLS2 = "$Elements\n3\n1 15 2 0 1 10\n2 2 2 3 1 10 20 30\n5 2 2 0 1 10 30 40\n$EndElements\n"
NAMES = '$PhysicalNames\n2\n2 3 "hood"\n3 4 "air"\n$EndPhysicalNames\n'
MSH4 = MSH2.replace("2.2", "4.1")
ENTITIES = "$Entities\n0 0 2 0\n1 0 0 0 1 1 0 1 3 0\n2 0 0 0 1 1 0 0 0\n$EndEntities\n"
NODES4 = "$Nodes\n1 4 10 40\n2 1 0 4\n10\n20\n40\n30\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n$EndNodes\n"
CELLS4 = "$Elements\n2 2 5 9\n2 1 2 1\n2 10 20 30\n2 2 2 1\n5 10 30 40\n$EndElements\n"
OLD = (
    "$MeshFormat\n4 0 8\n$EndMeshFormat\n"
    "$Nodes\n1 4\n1 2 0 4\n10 0 0 0\n20 1 0 0\n40 0 1 0\n30 1 1 0\n$EndNodes\n"
    "$Elements\n1 2\n1 2 2 2\n2 10 20 30\n5 10 30 40\n$EndElements\n"
)


def data(name: str, values: dict[int, float]) -> str:
    rows = "".join(f"{number} {value}\n" for number, value in values.items())
    return f'${name}\n1\n"t"\n1\n0.0\n3\n0\n1\n{len(values)}\n{rows}$End{name}\n'


@pytest.mark.parametrize("text", [MSH2 + NAMES + NODES2 + CELLS2, MSH4 + NAMES + ENTITIES + NODES4 + CELLS4])
def test_physical_groups_are_parts_and_other_cells_are_the_file(tmp_path: Path, text: str) -> None:
    report = read_text(tmp_path, "a.msh", text)
    assert area_and_volume(report)[0] == 1
    assert sorted(report.mesh.part_names) == ["a", "hood"]


@pytest.mark.parametrize("text", [MSH2 + NODES2 + CELLS2, MSH4 + NODES4 + CELLS4, OLD])
def test_data_are_scalars_if_their_numbers_are_those_of_the_mesh(tmp_path: Path, text: str) -> None:
    of_cells = {1: 9, 2: 5, 5: 6} if "\n1 15 " in text else {2: 5, 5: 6}
    of_nodes = {10: 0, 20: 1, 40: 2, 30: 3}
    report = read_text(tmp_path, "a.msh", text + data("NodeData", of_nodes) + data("ElementData", of_cells))
    assert area_and_volume(report)[0] == 1
    assert [each.values.tolist() for each in report.mesh.scalars] == [[0, 1, 2, 3], [5, 6]]
    others = data("NodeData", dict(sorted(of_nodes.items()))) + data("ElementData", {5: 6})
    report = read_text(tmp_path, "a.msh", text + others)
    assert not report.mesh.scalars
    left = "whose numbers are not all numbers of the mesh in order"
    assert told(report)[:2] == [f"left out ${name}, {left}" for name in ("NodeData", "ElementData")]


MEDIT = "MeshVersionFormatted 2\nDimension 3\n"
SHORT = "its numbers are cut short, or name nodes that it does not have"


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("a.msh", "$NOD\n1\n1 0 0 0\n", "a Gmsh file must begin with $MeshFormat, as it does from MSH 2 on"),
        ("a.msh", MSH2.replace("2.2", "3") + NODES2,
         f"{CANNOT} (Need mesh format in ['2', '2.2', '4', '4.0', '4.1'] (got 3))"),
        ("a.msh", MSH4 + NODES4.replace("1 0 4", "1 1 4"), f"{CANNOT} (parametric nodes not implemented)"),
        ("a.msh", MSH2 + NODES2 + CELLS2.replace("1 15", "1 77"), f"{CANNOT} (there is no element type 77)"),
        ("a.msh", MSH2 + NODES2 + CELLS2.replace("10 20", "10 77"), f"{CANNOT} ({SHORT})"),
        ("a.msh", MSH2 + NODES2 + CELLS2[:-14], f"{CANNOT} ($Elements not closed by $EndElements.)"),
        ("a.su2", "NZONE= 2\nIZONE= 1\nNDIME= 3\n", "the file must have one zone, not NZONE= 2"),
        ("a.su2", "h\nNDIME= 2\nNPOIN= 1\n0 0\n", f"{CANNOT} (meshio could not parse line h skipping.....)"),
        ("a.su2", "NDIME= 2\nNPOIN= 9\n0 0\n", f"{CANNOT} ({SHORT})"),
        ("a.mesh", f"{MEDIT}EdgesP2 1\n1 2 3 1\n", "cells must be of the first order, not EdgesP2"),
        ("a.mesh", f"{MEDIT}Vertices 1\n0 0 0 1\nTriangles 1\n1 1 2 1\n",
         "a cell must have nodes of the file, which has 1"),
    ],
)  # fmt: skip
def test_what_meshio_cannot_read_is_refused_with_its_reason(
    tmp_path: Path, name: str, text: str, reason: str
) -> None:
    (tmp_path / name).write_text(text)
    sentence = refusal(read_mesh, {"file": tmp_path / name})
    assert sentence == f"{name}: {reason}; correct the file, or write it as OBJ or PLY"


def test_a_medit_text_is_read_as_other_programs_write_it(tmp_path: Path) -> None:
    text = (
        "MeshVersionFormatted\n3\nDimension 3\n# nodes\nVertices 4\n0 0 0 1\n1 0 0 1 # x\n1 1 0 1\n0 1 0 1\n"
        "Corners 2 1 2\nRequiredTriangles\n1\n1\nNormals 1\n0 0 1e0\nTriangles\n2\n1 2 3 5\n1 3 4 6\nEnd\n"
    )
    report = read_text(tmp_path, "a.mesh", text)
    assert area_and_volume(report)[0] == 1
    assert report.mesh.part_names == ("part 5", "part 6")
