from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, Surface
from autocolor.files.meshes import obj as module
from autocolor.files.meshes.mtl import mtl_text
from autocolor.files.meshes.obj import begins_as_obj, obj_text, read_obj
from autocolor.files.meshes.repair import FILE, MeshReport, Placement
from tests.autocolor.files.meshes.written import assert_equal, writable_meshes
from tests.autocolor.files.refusals import refusal, refused

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "car.obj"


def read(path: Path, text: str | bytes, normals: str = FILE) -> MeshReport:
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_obj(path, Placement(normals=normals))


@pytest.mark.parametrize(
    "corners",
    [
        "1/1 2//2 3/3/3 4",
        "1/9/9 2/9/9 3/9/9 4/9/9",
        "-4/-1/-1 2 3/ 4//",
        "+1 02 3 4",
        "\t1\t2  3 4 # a comment",
        "1 2 \\\n3 4",
        "1 2 3 4 \\\n \n",
    ],
)
def test_corners_are_written_in_many_ways(path: Path, corners: str) -> None:
    assert read(path, f"{SQUARE}f {corners}\n").mesh.node_numbers.tolist() == [[0, 1, 2, 3]]


@pytest.mark.parametrize("number", ["+.5", "5.", "-1e30", "-1d-3", "1" * 30])
def test_decimal_numbers_are_read(path: Path, number: str) -> None:
    mesh = read(path, f"v {number} 0 0\nv 0 1 0\n\tv {number} {number} 1\nf 1 2 3\n").mesh
    value = float(number.lower().replace("d", "e"))
    assert mesh.coordinates[:, 0].tolist() == [value, 0, value]


@pytest.mark.parametrize("weight", ["", " 1"])
def test_weights_are_ignored_and_colors_of_nodes_are_left_out(path: Path, weight: str) -> None:
    report = read(path, f"v 0 0 0{weight} nan 0.5 1e999\nv 1 0 0{weight}\nv 1 1 0\nf 1 2 3\n")
    assert report.mesh.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    assert report.repairs == ("car.obj: left out the colors of nodes",)
    assert read(path, f"v 0 0 0 1\nv 1 0 0{weight}\nv 1 1 0\nf 1 2 3\n").repairs == ()


COUNTS = st.integers(0, 2)
CORNERS = st.lists(
    st.tuples(st.integers(-9, 9), st.sampled_from(["", "/1", "//2", "/1/-1"])), min_size=3, max_size=5
)


@pytest.mark.parametrize("block", [1, 20])
@given(rows=st.lists(COUNTS | CORNERS, max_size=8), indent=st.sampled_from(["", " "]))
def test_every_corner_is_the_node_of_the_slow_twin(
    tmp_path_factory: pytest.TempPathFactory, block: int, indent: str, rows: list[int | list[tuple[int, str]]]
) -> None:
    # Nodes on a curve, no three of which lie on a line: whole numbers in `rows` are counts of nodes.
    count = sum(row for row in rows if isinstance(row, int))
    places = [[float(at), float(at**2), float(at**3)] for at in range(count)]
    text, expected, before, first_wrong = "vn 1 2 3\nvn nan -1.#IND x\n", [], 0, None
    for row in rows:
        if isinstance(row, int):
            text += "".join(f"v {x} {y} {z}\n" for x, y, z in places[before : before + row])
            before += row
            continue
        text += f"{indent}f {' '.join(f'{number}{rest}' for number, rest in row)}\n"
        numbers = [number for number, _ in row]
        if first_wrong is None and any(each == 0 or each > count or each < -before for each in numbers):
            first_wrong = text.count("\n", 0, text.rindex("f ")) + 1
        corners = [number - 1 if number > 0 else before + number for number in numbers]
        if first_wrong is None and len(row) == 3 and len({*corners}) == 3:
            expected.append([places[corner] for corner in corners])
    path = tmp_path_factory.getbasetemp() / "twin.obj"
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(module, "BLOCK", block)
        if first_wrong is not None:
            start = f"twin.obj, line {first_wrong}: a corner must be one of the file's {count} nodes, or"
            assert refusal(read, path, text).startswith(start)
        elif expected:
            mesh = read(path, text).mesh
            triangles = [row[:3] for row in mesh.node_numbers.tolist() if row[2] == row[3]]
            found = [mesh.coordinates[row].tolist() for row in triangles]
            assert all(each in found for each in expected)


def test_normals_are_those_of_the_corners_and_missing_where_there_are_none(path: Path) -> None:
    square = f"{SQUARE}vn 0 0 5\nvn 1 0 1\nvn 0 x 0\nvn 1 2\n"
    mesh = read(path, f"{square}f 1//1 2//-3 3/9/3 4/9\nf 1//4 2//0 3//9\n").mesh
    assert mesh.own_normals is not None
    assert mesh.own_normals.numbers.tolist()[1] == [-1] * 4
    corners = mesh.own_normals.numbers[0].tolist()
    assert corners[2:] == [-1, -1]
    assert mesh.own_normals.vectors[corners[:2]] == pytest.approx(
        np.array([[0, 0, 1], [0.5**0.5, 0, 0.5**0.5]])
    )
    assert read(path, f"{square}f 1//1 2//1 3//1\n", "computed").mesh.own_normals is None
    assert read(path, f"{square}f 1 2/1 3\n").mesh.own_normals is None


COORDINATE = "a coordinate must be a decimal number of at most 1e30 in size"
CORNER = "a corner must be a node number, alone or with texture and normal numbers as in 7/1/3"
NODE = "a node must have three coordinates x y z, not 2; add what is missing"
FEW = "2 polygons with fewer than three different corners were dropped; 1 polygon without area was dropped"

test_what_is_refused = refused(
    "car.obj",
    [
        (f"{SQUARE}{text}\n".encode(), f"car.obj{sentence}")
        for text, sentence in (
            *(
                (f"v 0 {number} 0", f", line 5: {COORDINATE}, not {number!r}; correct it")
                for number in ("nan", "0x10", "1_0", "1,5", "1d", "-1.0000000000000002e30")
            ),
            *(
                (f"f 1 2/{word} 3", f", line 5: a corner must be a whole number, not {word!r}; correct it")
                for word in ("1.5", "x", "\u0663", "9" * 19, "-")
            ),
            *(
                (f"f 1 2 {corner}", f", line 5: {CORNER}, not {word!r}; correct it")
                for corner, word in (("/1", "/1"), ("1/2/3/4", "1/2/3/4"), ("1///2", "/2"))
            ),
            ("f 1 \\\n2 3\nf 1 2 x", ", line 7: a corner must be a whole number, not 'x'; correct it"),
            ("v 1 2\nf 1 2 3", f", line 5: {NODE}"),
            (
                "p 1\n f 1 2\nl 1 2\nl 2 3\nf 3 3 3\n\nf 1 2 1 2",
                ": a mesh must have a polygon with area, not none; skipped points: 1; skipped lines: 2;"
                f" {FEW}; add polygons",
            ),
        )
    ],
)


def test_groups_objects_and_materials_name_the_parts(path: Path) -> None:
    statements = "g hood\n{f}usemtl red\n{f}o h\u00e4ube\n{f}g \x1b[31m\n{f}o " + "x" * 10_000 + "\n{f}"
    text = SQUARE + statements.format(f="f 1 2 3 4\n")
    names = ("hood", "hood red", "h\u00e4ube", "?[31m", "x" * 200)
    assert read(path, "".join(f" {line}\n" for line in text.splitlines())).mesh.part_names == names
    assert read(path, text.encode("latin-1")).mesh.part_names == names


STATEMENT = st.tuples(
    st.sampled_from(["g", "o", "usemtl"]),
    st.sampled_from(["a", "b", "a b", "a b 2", "a 2", "car", "car 2", ""]) | st.text("ab 2", max_size=4),
    st.booleans(),
)


@given(st.lists(STATEMENT, max_size=20))
def test_each_pair_of_a_group_and_a_material_is_a_part_of_its_own(
    tmp_path_factory: pytest.TempPathFactory, statements: list[tuple[str, str, bool]]
) -> None:
    text = "".join(f"{keyword} {name}\n" + "f 1 2 3\n" * is_used for keyword, name, is_used in statements)
    report = read(tmp_path_factory.getbasetemp() / "car.obj", f"{SQUARE}f 1 2 3\n{text}")
    # The slow twin: the group and the material at each polygon.
    group: str | None = None
    material: str | None = None
    pairs: list[tuple[str | None, str | None]] = [(None, None)]
    for keyword, name, is_used in statements:
        words = name.split()
        if keyword == "usemtl":
            material = name.strip() or None
        elif keyword == "g":
            group = words[0] if words else None
        else:
            group = name.strip() or None
        pairs += [(group, material)] * is_used
    parts = list(dict.fromkeys(pairs))
    assert report.mesh.part_numbers.tolist() == [parts.index(pair) for pair in pairs]
    names = report.mesh.part_names
    assert len(set(names)) == len(parts)
    for name, (group, material) in zip(names, parts, strict=True):
        assert report.material_of_part.get(name) == material
        assert name.startswith(group or material or "car")


def test_what_is_skipped_is_counted_and_comes_before_the_repairs(path: Path) -> None:
    ignored = "   \n# g a\n#\nvt 1 2\ns 1\nmg 1\nusemap a"
    report = read(path, f"{SQUARE}p 1\nl 1 2\nsurf 3\nf 1 2 3 4\nf 1 1 2\n{ignored}\ncurv 4\n")
    assert (report.mesh.part_names, report.material_of_part) == (("car",), {})
    assert report.repairs == (
        "car.obj: skipped points: 1",
        "car.obj: skipped lines: 1",
        "car.obj: skipped unknown statements: 2",
        "car.obj: 1 polygon with fewer than three different corners was dropped",
    )


def test_a_file_is_known_by_a_line_of_a_node() -> None:
    assert begins_as_obj(b" \tv -1\t+2 .5 0 0 0\n")
    for head in (b"v 1 2\n3\n", b"v a b c\n", b"vn 0 0 1\nav 0 0 1\n", b"v 0 0 0\n\0"):
        assert not begins_as_obj(head)


# Writing.


def test_nodes_come_first_and_a_part_has_its_name_where_it_begins() -> None:
    mesh = Mesh(
        np.array([[0, 0, 0], [1, 0, 0], [1, 0.1, 0], [0, 1, 1e-9]]),
        np.array([[0, 1, 2, 3], [0, 1, 2, 2], [1, 2, 3, 3]]),
        np.array([0, 1, 1]),
        ("hood", "left door"),
    )
    nodes = "v 0.0 0.0 0.0\nv 1.0 0.0 0.0\nv 1.0 0.1 0.0\nv 0.0 1.0 1e-09\n"
    assert obj_text(mesh, ("red", "tin"), "car.mtl").decode() == (
        f"mtllib car.mtl\n{nodes}o hood\nusemtl red\nf 1 2 3 4\no left door\nusemtl tin\nf 1 2 3\nf 2 3 4\n"
    )


def test_surfaces_are_written_as_a_library_of_materials() -> None:
    paint = Surface("red").replace(object_color=(255, 51, 0), specular=0.25, exponent=30.0)
    matte = Surface("matte").replace(object_color=(0, 0, 102), specular=0.5, model="cook-torrance")
    ramp = Surface("hot").replace(ramp=["#200", "#f30", "#fff"])
    assert mtl_text([("paint 1", paint), ("b", matte)]).decode() == (
        "newmtl paint 1\nKd 1 0.2 0\nKs 0.25 0.25 0.25\nNs 30.0\nillum 2\n"
        "newmtl b\nKd 0 0 0.4\nKs 0.5 0.5 0.5\nillum 2\n"
    )
    assert mtl_text([]) == b""
    assert mtl_text([("a", ramp)]).startswith(b"newmtl a\nKd 1 0.2 0\n")


@given(mesh=writable_meshes())
def test_a_mesh_reads_back_equal(mesh: Mesh, tmp_path_factory: pytest.TempPathFactory) -> None:
    mesh = mesh.with_scalars()
    assert_equal(read(tmp_path_factory.getbasetemp() / "written.obj", obj_text(mesh)), mesh)
