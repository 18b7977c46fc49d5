"""Files of Abaqus, Nastran, Gmsh, Medit and UGRID: written by meshio, and by hand."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.files.formats import read_mesh
from tests.autocolor.files.foreign.conftest import CUBE, SIDES, area_and_volume
from tests.autocolor.files.refusals import refusal
from tests.tables import first

pytestmark = [pytest.mark.needs("meshio"), pytest.mark.usefixtures("shared")]

SURFACE = ("took the outer surface of 1 volume cell",)

CELLS = {
    "hexahedron": [[0, 1, 3, 2, 4, 5, 7, 6]],
    "wedge": [[0, 1, 3, 4, 5, 7], [0, 3, 2, 4, 7, 6]],
    "tetra": [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]],
    "pyramid": [[*side, 8] for side in SIDES],
    "quad": SIDES,
}  # fmt: skip
WRITTEN = [
    ("a.bdf", "nastran", {}),
    ("a.bdf", "nastran", {"point_format": "fixed-small", "cell_format": "fixed-large"}),
    ("a.inp", "abaqus", {}),
    ("a.mesh", "medit", {}),
    ("a.meshb", "medit", {}),
    ("a.b8.ugrid", "ugrid", {}),
    *(("a.msh", "gmsh", {"fmt_version": version, "binary": binary})
      for version in ("4.1", "2.2", "4.0") for binary in (True, False)),
]  # fmt: skip


@pytest.mark.parametrize("kind", CELLS)
@pytest.mark.parametrize("case", first(8, WRITTEN))
def test_a_cube_of_each_kind_of_cell_is_read(
    tmp_path: Path, case: tuple[str, str, dict[str, Any]], kind: str
) -> None:
    import meshio

    name, library, options = case
    if (library, kind) == ("abaqus", "pyramid"):
        # meshio knows no pyramid of Abaqus.
        return
    mesh = meshio.Mesh(np.vstack([CUBE, [0.5, 0.5, 0.5]]), [(kind, np.array(CELLS[kind]))])
    with contextlib.redirect_stderr(io.StringIO()):
        getattr(meshio, library).write(tmp_path / name, mesh, **options)
    report = read_mesh({"file": tmp_path / name})
    assert area_and_volume(report) == (6, 1)
    assert len(report.mesh.node_numbers) == {"tetra": 12, "wedge": 8}.get(kind, 6)


SQUARE = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n"
SHELL = "*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n"
TOP = "5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1\n"
INSTANCE = "*INSTANCE, NAME=P-1, PART=P\n"
PART = f"*PART, NAME=p\n{SQUARE}{SHELL}*END PART\n"
GRIDS = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n"
UPPER = "".join(
    f"GRID    {row + 5:<16d}{x:<8}{y:<8}1.\n"
    for row, (x, y) in enumerate([("0.", "0."), ("1.", "0."), ("1.", "1."), ("0.", "1.")])
)
QUAD = "CQUAD4,1,7,1,2,3,4,45.,0.1\n"
HEXA = "".join(f"{each:<8}" for each in ("CHEXA", 1, 7, 1, 2, 3, 4, 5, 6))
BULK = "SOL 101\nBEGIN BULK\n{}ENDDATA\n"
MSH2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
NODES2 = "$Nodes\n4\n10 0 0 0\n20 1 0 0\n40 0 1 0\n30 1 1 0\n$EndNodes\n"
CELLS2 = "$Elements\n3\n1 15 2 0 1 10\n2 2 2 3 1 10 20 30\n5 2 2 0 1 10 30 40\n$EndElements\n"
NAMES = '$PhysicalNames\n2\n2 3 "hood"\n3 4 "air"\n$EndPhysicalNames\n'
MSH4 = MSH2.replace("2.2", "4.1")
ENTITIES = "$Entities\n0 0 2 0\n1 0 0 0 1 1 0 1 3 0\n2 0 0 0 1 1 0 1 9 0\n$EndEntities\n"
NODES4 = "$Nodes\n1 4 10 40\n2 1 0 4\n10\n20\n40\n30\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n$EndNodes\n"
CELLS4 = "$Elements\n2 2 5 9\n2 1 2 1\n2 10 20 30\n2 2 2 1\n5 10 30 40\n$EndElements\n"
OLD = (
    "$MeshFormat\n4 0 8\n$EndMeshFormat\n"
    "$Nodes\n1 4\n1 2 0 4\n10 0 0 0\n20 1 0 0\n40 0 1 0\n30 1 1 0\n$EndNodes\n"
    "$Elements\n1 2\n1 2 2 2\n2 10 20 30\n5 10 30 40\n$EndElements\n"
)
DATA = '$NodeData\n1\n"t"\n1\n0.0\n3\n0\n1\n1\n30 7\n$EndNodeData\n'
MEDIT = "MeshVersionFormatted 2\n# nodes\nDimension\n3\nVertices\n4\n0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n"
REQUIRED = "RequiredVertices\n1\n1\nTriangles\n2\n1 2 3 5\n1 3 4 6\nEnd\n"

READ: dict[str, list[tuple[str, float, tuple[str, ...], tuple[str, ...]]]] = {
    "a.inp": [
        (SQUARE.replace("3,", "** others\n\n3,") + SHELL, 1, ("a",), ()),
        ("*node, nset=all\n1,0.,\n2,1.D0,0\n3,.1+1,10.-1,,0,0,1\n4,0.,1.\n"
         "*Element, type=s4r5,\n elset=Hood\n1,1,2,3,4\n", 1, ("Hood",), ()),
        (SQUARE + TOP + "*ELEMENT, TYPE=C3D8R\n1, 1, 2, 3, 4,\n5, 6, 7, 8\n", 6, ("a",), SURFACE),
        (SQUARE + "5, .5, .5\n*ELEMENT, TYPE=STRI65, ELSET=b\n1, 1, 2, 3, 5, 5, 5\n", 0.5, ("b",),
         ("skipped nodes between corners of cells: 3",)),
        (SQUARE + SHELL + "*ELEMENT, TYPE=SPRINGA\n2, 1, 2\n3, 2, 3\n*ELEMENT, TYPE=MASS\n4, 4\n"
         "*STEP\n*NODE PRINT\nU\n", 1, ("a",),
         ("skipped elements of type SPRINGA: 2", "skipped elements of type MASS: 1")),
        (PART + "*ASSEMBLY, NAME=A\n" + INSTANCE + "*END INSTANCE\n*NODE\n1, 5, 5, 5\n", 1, ("a",), ()),
        ("*SYSTEM\n*INCLUDE, INPUT=one.txt\n*element, type=S4\n*include, input = two.txt\n",
         1, ("a",), ()),
    ],
    "a.bdf": [
        (f"{GRIDS}$ text\n{QUAD}CELAS1,2,1,1,1\nCONM2,3,1\nENDDATA", 1, ("part 7",),
         ("skipped elements of type CELAS1: 1", "skipped elements of type CONM2: 1")),
        (BULK.format(f"{GRIDS}{UPPER}{HEXA}+A\n+A      7       8\n"), 6, ("part 7",), SURFACE),
        (f"GRID*   1{'':31}0.              0.              *A\n*A      0.\nGRID*   2{'':31}.1+1\n{GRIDS[34:]}"
         "CTRIAR  1       7       1       2       3\nCTRIA3  2       8       1       3       4\n",
         1, ("part 7", "part 8"), ()),
        ("CORD2R,5,0,1.,0.,0.,1.,0.,1.,+\n+,2.,0.,0.\nINCLUDE 'three.txt'\n" + QUAD, 1, ("part 7",), ()),
    ],
    "a.msh": [
        (MSH2 + NAMES + NODES2 + CELLS2, 1, ("hood", "a"), ("skipped cells of type vertex: 1",)),
        (MSH4 + NAMES + ENTITIES + NODES4 + CELLS4, 1, ("hood", "part 9"), ()),
        (MSH4 + NAMES + ENTITIES.replace(" 1 9 ", " 0 ") + NODES4 + CELLS4, 1, ("a",),
         ("skipped tables of physical groups, which some elements are not in: 1",)),
        (OLD + DATA, 1, ("a",), ("skipped sections of data: 1",)),
    ],
    "a.mesh": [(MEDIT + REQUIRED, 1, ("part 5", "part 6"), ())],
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "text", "area", "parts", "sentences"),
    [(name, *case) for name, cases in READ.items() for case in cases],
)
def test_texts_are_read(
    tmp_path: Path, name: str, text: str, area: float, parts: tuple[str, ...], sentences: tuple[str, ...]
) -> None:
    for other, content in [("one", SQUARE), ("two", "1,1,2,3,4\n"), ("three", GRIDS)]:
        (tmp_path / f"{other}.txt").write_text(content)
    (tmp_path / name).write_text(text)
    report = read_mesh({"file": tmp_path / name})
    assert area_and_volume(report)[0] == area
    assert report.mesh.part_names == parts
    told = [each.partition(": ")[2] for each in report.repairs if "no polygon uses" not in each]
    assert told == list(sentences)


MADE = "nodes and elements must be written out, not made by"
KNOWN = "elements must be in a part and of a known type, not as"
ONE = "there must be one part, which no *INSTANCE moves, not"
BASIC = "must be in the basic system, not in the coordinate system 5"
NUMBERS = "nodes and elements must be given by numbers"
CANNOT = "meshio must be able to read it, and cannot"

REFUSED = {
    "a.inp": [
        *((f"{SQUARE}*{keyword}\n1, 2\n{SHELL}", f"{MADE} '*{keyword}' (line 6)")
          for keyword in ("NGEN", "SYSTEM", "NODE, SYSTEM=C")),
        (PART + INSTANCE + "1., 0., 0.\n*END INSTANCE\n", f"{ONE} *INSTANCE (line 10)"),
        (PART + PART, f"{ONE} *PART (line 10)"),
        (f"{PART}*ASSEMBLY\n{SHELL}", f"{KNOWN} 'S4' (line 11)"),
        (SQUARE + SHELL.replace("S4", "S7"), f"{KNOWN} 'S7' (line 6)"),
        (SQUARE + "*ELEMENT, TYPE=S4\n1, 1, 2, 3\n", "elements of type S4 must have 4 nodes (line 6)"),
        (SQUARE + SHELL.replace(" 4\n", " 9\n"),
         "elements must have nodes of the file, and there is no node 9"),
        (SQUARE.replace("1.", "x") + SHELL, f"{NUMBERS} (line 1: could not convert string to float: 'X')"),
        (SQUARE, "the file must have elements with faces"),
    ],
    "a.nas": [
        (BULK.format(f"{GRIDS.replace('4,,', '4,5,')}{QUAD}"), f"GRID 4 {BASIC} (line 6)"),
        (BULK.format(f"GRDSET,,5\n{GRIDS}{QUAD}"), f"GRDSET {BASIC} (line 3)"),
        (BULK.format(f"{GRIDS}{HEXA}+A\n+B      7       8\n"),
         "a line that continues a card must follow it (line 8)"),
        *((BULK.format(f"{GRIDS}{line}\n"),
           f"bulk data must be one list of whole cards, not '{line}' (line 7)")
          for line in ("=,*1,=", "BEGIN SUPER=1")),
        (BULK.format(f"{GRIDS}CQUAD9,1,7,1,2,3,4\n"), "element type 'CQUAD9' is not known (line 7)"),
        (BULK.format(f"{GRIDS}{HEXA}\n"), f"{NUMBERS} (line 7: invalid literal for int() with base 10: '')"),
        (f"BEGIN BULK\n{GRIDS}{QUAD}", "bulk data must end with ENDDATA; the file is cut short"),
    ],
    "a.msh": [
        ("$NOD\n1\n1 0 0 0\n", "a Gmsh file must begin with $MeshFormat, as it does from MSH 2 on"),
        (MSH4 + NODES4.replace("1 0 4", "1 1 4"), f"{CANNOT} (parametric nodes not implemented)"),
    ],
    "a.mesh": [
        (f"{MEDIT}EdgesP2\n1\n1 2 3 1\n",
         f"{CANNOT} (it is cut short or damaged, or has what meshio does not know)"),
    ],
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "text", "reason"), [(name, *case) for name, cases in REFUSED.items() for case in cases]
)
def test_what_would_be_misread_is_refused_by_name(tmp_path: Path, name: str, text: str, reason: str) -> None:
    (tmp_path / name).write_text(text)
    sentence = refusal(read_mesh, {"file": tmp_path / name})
    assert sentence == f"{name}: {reason}; correct the file, or write it as OBJ or PLY"


def test_included_files_are_in_the_folder_and_few(tmp_path: Path) -> None:
    for name, reason in (
        ("../a.txt", ", line 1: an included file must be the name of a file in the scene's folder, not"),
        ("a.inp", ": it must include at most 100 files, not more; join them"),
    ):
        (tmp_path / "a.inp").write_text(f"*INCLUDE, INPUT={name}\n{SQUARE}{SHELL}")
        assert refusal(read_mesh, {"file": tmp_path / "a.inp"}).startswith(f"a.inp{reason}")
