from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.csv_tables import (
    ROWS_AT_ONCE,
    read_csv_tables,
    write_csv_tables,
)
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.opening import format_of_folder
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MeshScalar
from tests.autocolor.files.meshes.written import assert_equal, writable_meshes

NODES = "node,x,y,z\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n"
POLYGONS = "polygon,part,node1,node2,node3,node4\n1,hood,1,2,3,4\n2,roof,1,2,3,\n"


def read(folder: Path, nodes: str | bytes = NODES, polygons: str | bytes = POLYGONS) -> MeshReport:
    paths = folder / "nodes.csv", folder / "polygons.csv"
    for path, text in zip(paths, (nodes, polygons), strict=True):
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_csv_tables(*paths)


def refusal(folder: Path, nodes: str | bytes = NODES, polygons: str | bytes = POLYGONS) -> str:
    with pytest.raises(InputError) as caught:
        read(folder, nodes, polygons)
    return str(caught.value)


def test_columns_may_stand_in_any_order_and_optional_ones_be_missing(tmp_path: Path) -> None:
    nodes = "z, x ,y\n0,0,0\n\n0,1,0\n0,1,1\n,,\n"
    mesh = read(tmp_path, nodes, "node4,node1,node2,node3\n,1,2,3\n").mesh
    assert mesh.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    assert mesh.part_names == ("polygons",)


def test_node_numbers_are_any_whole_numbers(tmp_path: Path) -> None:
    nodes = "node,x,y,z\n700,0,0,0\n-3,1,0,0\n0,1,1,0\n9007199254740991,0,1,0\n"
    polygons = "polygon,part,node1,node2,node3,node4\n8,roof,0,700,-3\n7,hood,9007199254740991,700,-3,0\n"
    mesh = read(tmp_path, nodes, polygons).mesh
    assert mesh.node_numbers.tolist() == [[2, 0, 1, 1], [3, 0, 1, 2]]
    assert (mesh.part_names, mesh.part_numbers.tolist()) == (("roof", "hood"), [0, 1])


@pytest.mark.parametrize(
    ("nodes", "polygons"),
    [
        ("node;x;y;z;\n1;0,0;,0;0;\n2;1,0;0;0;\n3;1;1;0;\n4;0;1,000E0;0\n;;;;\n", "sep=,\n" + POLYGONS),
        (
            "\ufeff,node,x,y,z\n0,1.0,0,0,0\n1,2.0,1.,0,0\n2,3.0,1,1,0\n3,4.0,0,1,0\n",
            ",part,node1,node2,node3,node4\n0,hood,1,2,3,4.0\n1,roof,1,2,3,\n",
        ),
        (NODES.replace(",", "\t"), POLYGONS.replace(",", "\t").replace("3,\n", "3\n")),
    ],
    ids=["Excel", "pandas", "tabs"],
)
def test_tables_of_other_programs_are_the_same_mesh(tmp_path: Path, nodes: str, polygons: str) -> None:
    assert_equal(read(tmp_path, nodes, polygons), read(tmp_path).mesh)


def test_a_problem_is_named_with_its_row(tmp_path: Path) -> None:
    # Rows are read in blocks, and a table may have empty lines.
    rows = "\n" * 2 + "".join(f"{row + 5},{row}.5,0,0\n" for row in range(ROWS_AT_ONCE))
    mesh = read(tmp_path, NODES + rows).mesh
    assert mesh.coordinates[4:, 0].tolist() == [row + 0.5 for row in range(ROWS_AT_ONCE)]
    place = f"nodes.csv, row {ROWS_AT_ONCE + 8}"
    for cell in ("nan", "1e31", "", "1_0", "\u0661", "inf", '"1,5"'):
        sentence = f"{COORDINATE}, not {cell.strip(chr(34))!r}; correct it"
        assert refusal(tmp_path, f"{NODES}{rows}9999,0,{cell},0\n") == f"{place}: {sentence}"


COORDINATE = "a coordinate must be a decimal number of at most 1e30 in size"
VALUE = (
    ", row 3: a value must be a decimal number of at most 1e30 in size, or empty if it is missing, not {!r};"
    " correct it"
)
WHOLE = "a node number must be a whole number, not {!r}; correct it"
MISSING = "a corner must be in the node table, 1 to 4, not {}; correct it"
UNKNOWN = ", row 1: there is no column {!r} (separated by commas)"


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        *(
            ("nodes", f"{NODES}{number},0,0,0\n", f", row 6: {WHOLE.format(number)}")
            for number in ("x", "1.5", "", "9007199254740992")
        ),
        *(
            ("polygons", f"{POLYGONS}3,a,{corners}\n4,a,9,2,3,\n", f", row 4: {MISSING.format(number)}")
            for corners, number in (("1,2,5,0", 5), ("1,2,3,0", 0))
        ),
        *(
            ("nodes", f"x,y,z,s\n1,0,0,\n2,1,0,{number}\n", VALUE.format(number))
            for number in ("nan", "-1.0000000000000002e30", "x")
        ),
        (
            "nodes",
            NODES + "1,0,0,0\n",
            ", row 6: a node number must be unique, not repeated: 1; renumber it",
        ),
        ("nodes", "x,y,z\n", ": a node table must have a node, not none; add rows"),
        ("nodes", "nod,x,y,z\n", f"{UNKNOWN.format('nod')}; did you mean 'node'?"),
        (
            "nodes",
            "x,y\n",
            ", row 1: there must be a column 'z', not only x, y (separated by commas); add it",
        ),
        *(
            ("polygons", f"{known}node1,node2,node3,node4,{name}\n", UNKNOWN.format(name))
            for known, name in (("", "polygn"), ("polygon,", "Part"), ("part,", "node5"))
        ),
        (
            "polygons",
            POLYGONS + "3,a,1,,3,4\n",
            ", row 4: a corner must be a whole number, not ''; correct it",
        ),
    ],
)
def test_what_is_refused(tmp_path: Path, name: str, text: str, sentence: str) -> None:
    assert refusal(tmp_path, **{name: text}).startswith(f"{name}.csv{sentence}")


def test_an_endless_row_is_refused_shortly(tmp_path: Path) -> None:
    for data in (b"x,y,z\n" + b"1" * 2_000_000, b"," * 500_000, b"x,y,z\n" + b"," * 2_000_000):
        assert len(refusal(tmp_path, data)) < 3000


@given(data=st.binary(max_size=100) | st.text('node1234xyz,"\n\r. -', max_size=100).map(str.encode))
def test_any_bytes_are_read_or_refused(data: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.getbasetemp()
    with pytest.raises(InputError):
        read(folder, NODES, data)
    with pytest.raises(InputError):
        read(folder, data, POLYGONS)


def test_further_columns_are_scalars_and_empty_cells_missing_values(tmp_path: Path) -> None:
    nodes = "x,stress,y,z,scalar x\n0,1.5,0,0,1\n1,,0,0,2\n1,-2e3,1,0,\n0,0,1,0,4\n"
    polygons = "node1,node2,node3,node4,heat,stress\n1,2,3,4,,7\n1,2,3,,5,8\n"
    mesh = read(tmp_path, nodes, polygons).mesh
    assert [(each.name, each.of, str(each.values.tolist())) for each in mesh.scalars] == [
        ("stress", "node", "[1.5, nan, -2000.0, 0.0]"),
        ("x", "node", "[1.0, 2.0, nan, 4.0]"),
        ("heat", "polygon", "[nan, 5.0]"),
        ("stress of polygons", "polygon", "[7.0, 8.0]"),
    ]
    many = NODES.replace("z\n", f"z,{','.join(f's{number}' for number in range(1001))}\n", 1)
    assert read(tmp_path, many).repairs == (
        "polygons.csv: skipped 1 arrays: a mesh has at most 1,000 scalars",
    )


def test_a_mesh_is_two_tables_with_its_scalars(tmp_path: Path) -> None:
    mesh = Mesh(
        np.array([[0, 0, 0], [1, 0, 0], [1, 1 / 3, 0]]),
        np.array([[0, 1, 2, 2]]),
        part_names=('a, "b"',),
        scalars=(
            MeshScalar("stress", np.array([0.1, math.nan, 1e-300])),
            MeshScalar("part", np.array([1.0]), "polygon"),
        ),
    )
    nodes, polygons = write_csv_tables(tmp_path, mesh)
    assert nodes.read_text() == (
        "node,x,y,z,stress\n1,0.0,0.0,0.0,0.1\n2,1.0,0.0,0.0,\n3,1.0,0.3333333333333333,0.0,1e-300\n"
    )
    assert polygons.read_text() == (
        'polygon,part,node1,node2,node3,node4,scalar part\n1,"a, ""b""",1,2,3,,1.0\n'
    )


@given(mesh=writable_meshes())
def test_a_mesh_reads_back_equal(mesh: Mesh, tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.getbasetemp() / "written"
    write_csv_tables(folder, mesh, overwrite=folder.exists())
    found = format_of_folder(folder)
    assert found is not None
    assert found.name == "CSV"
    assert_equal(read_csv_tables(folder / "nodes.csv", folder / "polygons.csv"), mesh)
