from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError, MissingInputError
from autocolor.files.meshes.obj.obj_file import read_obj
from autocolor.files.repair.placement import Placement
from autocolor.files.repair.polygons import MeshReport

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "car.obj"


def read(path: Path, text: str | bytes, up: str = "z") -> MeshReport:
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_obj(path, Placement(up))


def refusal(path: Path, text: str | bytes) -> str:
    with pytest.raises(InputError) as caught:
        read(path, text)
    return str(caught.value)


def is_read_or_refused(path: Path, data: bytes) -> bool:
    try:
        return len(read(path, data).mesh.node_numbers) > 0
    except InputError as error:
        return all(problem.startswith(path.name) for problem in error.problems)


def test_quads_stay_quads_and_triangles_repeat_their_last_node(path: Path) -> None:
    report = read(path, SQUARE + "f 1 2 3 4\nf 1 2 3\n")
    assert report.mesh.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert report.mesh.node_numbers.tolist() == [[0, 1, 2, 3], [0, 1, 2, 2]]
    assert report.mesh.part_names == ("car",)
    assert report.repairs == ()


@pytest.mark.parametrize(
    "corners",
    [
        "1 2 3 4",
        "1/1 2/2 3/3 4/4",
        "1/9/9 2/9/9 3/9/9 4/9/9",
        "1//5 2//5 3//5 4//5",
        "-4 -3 -2 -1",
        "-4/-1/-1 2 3/ 4//",
        "+1 2 3 4",
        "01 2 3 4",
        "\t1\t2  3 4 ",
        "1 2 3 4 # a comment",
        "1 2 \\\n3 4",
    ],
)
def test_corners_are_written_in_many_ways(path: Path, corners: str) -> None:
    assert read(path, f"{SQUARE}f {corners}\n").mesh.node_numbers.tolist() == [[0, 1, 2, 3]]


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("last", [True, False])
def test_lines_end_in_any_way(path: Path, ending: str, mark: str, last: bool) -> None:
    text = mark + (SQUARE + "f 1 2 3 4" + "\n" * last).replace("\n", ending)
    assert len(read(path, text).mesh.node_numbers) == 1


def test_leading_spaces_and_tabs_are_no_matter(path: Path) -> None:
    text = "\n".join(" \t" + line for line in (SQUARE + "g a\nf 1 2 3 4").split("\n"))
    assert read(path, text).mesh.part_names == ("a",)


def test_polygons_may_name_nodes_that_come_later(path: Path) -> None:
    assert len(read(path, "f 1 2 3 4\n" + SQUARE).mesh.node_numbers) == 1


def test_negative_node_numbers_count_back_from_where_they_stand(path: Path) -> None:
    report = read(path, SQUARE + "f -4 -3 -2\n" + SQUARE + "f -4 -3 -2\n")
    assert report.mesh.node_numbers.tolist() == [[0, 1, 2, 2], [4, 5, 6, 6]]


def test_weights_and_colors_of_nodes_are_not_used(path: Path) -> None:
    text = "v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nf 1 2 3\n"
    assert read(path, text).mesh.coordinates.shape == (3, 3)


def test_what_is_not_used_is_ignored(path: Path) -> None:
    text = SQUARE + "vt 0 0\nvn 0 0 1\nmtllib none.mtl\ns off\ns 1\n# comment\n\n   \nf 1 2 3 4\n"
    assert read(path, text).repairs == ()


def test_a_material_file_that_is_a_pipe_is_never_opened(path: Path) -> None:
    os.mkfifo(path.with_name("a.mtl"))
    report = read(path, "mtllib a.mtl\n" + SQUARE + "usemtl red\nf 1 2 3 4\n")
    assert report.material_of_part == {"red": "red"}
    assert report.materials == ()
    assert len(report.repairs) == 1


@pytest.mark.parametrize("quads", ["f 1 2 3 4\n", "f -4 -3 -2 -1\n"])
def test_parts_have_materials_and_these_their_surfaces(path: Path, quads: str) -> None:
    path.with_name("a.mtl").write_text("newmtl red\nKd 1 0 0\nnewmtl unused\nKd 0 0 1\nmap_Kd a.png\n")
    report = read(
        path,
        f"{SQUARE}{quads}mtllib a.mtl\ng hood\n{quads}usemtl red\n{quads}g door\n{quads}usemtl blue\n{quads}",
    )
    assert report.mesh.part_names == ("car", "hood", "hood red", "door", "door blue")
    assert report.mesh.part_numbers.tolist() == [0, 1, 2, 3, 4]
    assert report.material_of_part == {"hood red": "red", "door": "red", "door blue": "blue"}
    (red,) = report.materials
    assert (red.name, red.paint.object_color) == ("red", (255, 0, 0))
    assert report.repairs == ("no library defines material 'blue'; default colors are used",)


def test_problems_of_materials_come_after_those_of_the_mesh_and_do_not_refuse_it(path: Path) -> None:
    path.with_name("a.mtl").write_text("newmtl red\nKd x\n")
    report = read(path, f"mtllib a.mtl\nmtllib b.mtl\n{SQUARE}usemtl red\np 1\nf 1 2 3 4\n")
    assert [repair.split(":")[0] for repair in report.repairs] == [
        "car.obj",
        "a.mtl, line 2",
        "the materials have default colors",
    ]


def test_what_is_skipped_stands_in_the_report_with_the_name_of_the_file(path: Path) -> None:
    report = read(path, SQUARE + "p 1\nf 1 2 3 4\nf 1 1 2\n")
    assert report.repairs == (
        "car.obj: skipped points: 1",
        "car.obj: 1 polygon with fewer than three different corners was dropped",
    )


def test_the_files_up_axis_becomes_z(path: Path) -> None:
    mesh = read(path, "v 1 2 3\nv 0 0 0\nv 4 5 7\nf 1 2 3\n", up="y").mesh
    assert mesh.coordinates[0].tolist() == [1, -3, 2]


@pytest.mark.parametrize("number", ["1", "-1.5", "+.5", "5.", "1e3", "1E-3", "1e30", "00", "-0", "1" * 30])
def test_decimal_numbers_are_taken(path: Path, number: str) -> None:
    mesh = read(path, f"v {number} 0 0\n{SQUARE}f 2 3 4\n").mesh
    assert mesh.coordinates[0, 0] == float(number)


@pytest.mark.parametrize("number", ["40", "0", "-5", "999999999999999999"])
def test_a_node_that_is_not_there_is_refused(path: Path, number: str) -> None:
    assert refusal(path, f"{SQUARE}\nf 1 2 {number}\n") == (
        "car.obj, line 6: a corner must be a node number from 1 to 4 or from -4 to -1,"
        f" not {number}; correct it"
    )


def test_a_file_without_polygons_is_refused(path: Path) -> None:
    for text in ("", "\n", "# nothing\n", SQUARE, "solid cube\n  facet normal 0 0 1\n", SQUARE + "f 1 2\n"):
        assert refusal(path, text) == "car.obj: a mesh must have a polygon with area, not none; add polygons"


def test_other_encodings_are_refused(path: Path) -> None:
    text = SQUARE + "f 1 2 3\n"
    assert refusal(path, text.encode("utf-16")) == (
        "car.obj: an OBJ file must be text in UTF-8, not UTF-16; save it as UTF-8"
    )
    assert refusal(path, text.encode() + b"\0") == (
        "car.obj: an OBJ file must be text, not hold a NUL byte (line 6); save it as UTF-8 text"
    )


def test_a_file_cut_short_anywhere_is_read_or_refused(path: Path) -> None:
    text = (SQUARE + "g hood\nusemtl red\nf 1/1/1 2/2/2 3/3/3 4/4/4\nf -4//1 -3//1 -2//1\n").encode()
    for length in range(len(text)):
        assert is_read_or_refused(path, text[:length])


def test_a_folder_or_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not a folder"):
        read_obj(tmp_path)
    with pytest.raises(MissingInputError):
        read_obj(tmp_path / "none.obj")


@given(data=st.binary(max_size=200) | st.text("vfgo 0123-./e\\\n\r\t#", max_size=200).map(str.encode))
def test_any_bytes_are_read_or_refused(data: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.getbasetemp() / "any.obj"
    assert is_read_or_refused(path, data)
