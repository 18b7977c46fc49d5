from __future__ import annotations

import dataclasses
import math
import os
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, Surface
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError, MissingInputError
from autocolor.files.formats import read_mesh
from autocolor.files.meshes import obj as module
from autocolor.files.meshes.number_text import MOST_PROBLEMS
from autocolor.files.meshes.obj import (
    MOST_LIBRARIES,
    MOST_LIBRARY_PROBLEMS,
    SKIPPED,
    UNUSED,
    ObjTables,
    Statements,
    materials_of,
    mtl_text,
    obj_text,
    read_materials,
    read_obj,
    read_obj_lines,
    read_plain_obj,
)
from autocolor.files.meshes.repair import MeshReport, Placement
from autocolor.files.reading import read_bytes
from autocolor.scene.defaults import COLORED_PAINT, created_surface
from tests.autocolor.files.refusals import is_read_or_refused, refusal
from tests.small import cube, sphere

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "car.obj"


def read(path: Path, text: str | bytes, up: str = "z") -> MeshReport:
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_obj(path, Placement(up))


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
    report = read(path, SQUARE + "f -4 -3 -2 -1\n" + SQUARE + "f -4 -3 -2 -1\n")
    assert report.mesh.node_numbers.tolist() == [[0, 1, 2, 3], [4, 5, 6, 7]]


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
    mesh = read(path, f"v {number} 0 0\nv 0 1 0\nv {number} {number} 1\nf 1 2 3\n").mesh
    assert mesh.coordinates[0, 0] == float(number)


@pytest.mark.parametrize("number", ["40", "0", "-5", "999999999999999999"])
def test_a_node_that_is_not_there_is_refused(path: Path, number: str) -> None:
    assert refusal(read, path, f"{SQUARE}\nf 1 2 {number}\n") == (
        "car.obj, line 6: a corner must be a node number from 1 to 4 or from -4 to -1,"
        f" not {number}; correct it"
    )


def test_a_file_without_polygons_is_refused(path: Path) -> None:
    for text in ("", "\n", "# nothing\n", SQUARE):
        assert refusal(read, path, text).endswith("must have a polygon with area, not none; add polygons")


@pytest.mark.parametrize("indent", ["", " "])
def test_a_refusal_for_want_of_polygons_says_what_was_dropped_and_where(path: Path, indent: str) -> None:
    text = f"{SQUARE}\np 1\n{indent}f 1 2\nl 1 2\nl 2 3\n# a comment\nf 3 3 3\n\nf 1 2 1 2\n"
    lines = [text[: text.index(polygon)].count("\n") + 1 for polygon in ("f 1 2\n", "f 1 2 1 2")]
    assert refusal(read, path, text) == (
        "car.obj: a mesh must have a polygon with area, not none; skipped points: 1; skipped lines: 2;"
        " 2 polygons with fewer than three different corners were dropped"
        f" (the first: line {lines[0]}); 1 polygon without area was dropped (line {lines[1]}); add polygons"
    )


def test_other_encodings_are_refused(path: Path) -> None:
    text = SQUARE + "f 1 2 3\n"
    assert refusal(read, path, text.encode("utf-16")) == (
        "car.obj: an OBJ file must be text in UTF-8, not UTF-16; save it as UTF-8"
    )
    assert refusal(read, path, text.encode() + b"\0") == (
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


def lines_read(text: str | bytes) -> ObjTables:
    data = text if isinstance(text, bytes) else text.encode()
    return read_obj_lines(data, "car.obj", Statements("car"))


coordinates = st.floats(-1e30, 1e30).map(lambda number: number + 0.0)


@given(
    st.lists(st.tuples(coordinates, coordinates, coordinates), min_size=1, max_size=6),
    st.lists(st.lists(st.integers(1, 6), min_size=1, max_size=6), max_size=6),
)
def test_what_is_written_is_read_to_the_last_bit(
    nodes: list[tuple[float, float, float]], polygons: list[list[int]]
) -> None:
    polygons = [[1 + (number - 1) % len(nodes) for number in polygon] for polygon in polygons]
    tables = lines_read(
        "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in nodes)
        + "".join(f"f {' '.join(map(str, polygon))}\n" for polygon in polygons)
    )
    assert tables.coordinates.tolist() == [list(node) for node in nodes]
    assert tables.corner_counts.tolist() == list(map(len, polygons))
    assert tables.numbers.tolist() == [number for polygon in polygons for number in polygon]
    assert tables.part_numbers.tolist() == [0] * len(polygons)
    assert tables.nodes_before.tolist() == [len(nodes)] * len(polygons)


@pytest.mark.parametrize(
    "number",
    [
        "nan",
        "inf",
        "-Infinity",
        "0x10",
        "1_0",
        "1,5",
        "1e31",
        "1e999",
        "\u0661",
        "1d5",
        ".",
        "1e",
        "--1",
        "1-2",
        "e5",
    ],
)
def test_numbers_are_strict(number: str) -> None:
    assert refusal(lines_read, f"{SQUARE}v 0 {number} 0\nf 1 2 3\n") == (
        "car.obj, line 5: a coordinate must be a decimal number of at most 1e30 in size,"
        f" not {number!r}; correct it"
    )


@pytest.mark.parametrize(
    "corner",
    ["1.5", "1.0", "x", "/1", "1/x", "1/2/3/4", "1e2", "\u0663", "9" * 19, "9" * 100_000, "1_0", "--1"],
)
def test_a_corner_that_is_no_node_number_is_refused(corner: str) -> None:
    sentence = refusal(lines_read, f"{SQUARE}f 1 2 {corner}\n")
    assert sentence.startswith(
        "car.obj, line 5: a corner must be a node number, alone or with texture and normal numbers as in"
        " 7/1/3, not "
    )
    assert len(sentence) < 200


def test_a_node_with_too_few_coordinates_is_refused() -> None:
    assert refusal(lines_read, SQUARE + "v 1 2\nf 1 2 3\n") == (
        "car.obj, line 5: a node must have three coordinates x y z, not 2; add what is missing"
    )


def test_every_problem_is_named_with_the_first_line_of_its_statement() -> None:
    with pytest.raises(InputError) as caught:
        lines_read("v a b 0\n" + SQUARE + "f 1 2 \\\n x\nf 1 2 3\nf 1 2 9\n")
    assert [problem.split(":")[0] for problem in caught.value.problems] == [
        "car.obj, line 1",
        "car.obj, line 1",
        "car.obj, line 6",
        "car.obj, line 9",
    ]


def test_a_file_of_faults_has_a_short_report() -> None:
    assert len(refusal(lines_read, "v x\n" * 100_000)) < 5000


@pytest.mark.parametrize("letter", [b"a", b"v 1 ", b"# ", b"f 1 2 3 "])
def test_an_endless_line_is_refused(letter: bytes) -> None:
    sentence = refusal(lines_read, SQUARE.encode() + letter * (2_000_000 // len(letter)))
    assert sentence == "car.obj, line 5: a line must have at most 1,048,576 bytes, not 2,000,000; split it"


def test_surfaces_are_written_as_a_library_of_materials() -> None:
    paint = Surface("red").replace(object_color=(255, 51, 0), specular=0.25, exponent=30.0)
    matte = Surface("matte").replace(object_color=(0, 0, 102), specular=0.5, model="cook-torrance")
    assert mtl_text([("paint 1", paint), ("b", matte)]).decode() == (
        "newmtl paint 1\nKd 1 0.2 0\nKs 0.25 0.25 0.25\nNs 30.0\nillum 2\n"
        "newmtl b\nKd 0 0 0.4\nKs 0.5 0.5 0.5\nillum 2\n"
    )
    assert mtl_text([]) == b""
    ramp = Surface("hot").replace(ramp=["#200", "#f30", "#fff"])
    assert mtl_text([("a", ramp)]).startswith(b"newmtl a\nKd 1 0.2 0\n")


def test_the_last_line_may_end_with_a_continuation(path: Path) -> None:
    for end in ("\\\n", "\\\n\\\n", "\\\n \n"):
        assert read(path, f"{SQUARE}f 1 2 3 4 {end}").mesh.node_numbers.tolist() == [[0, 1, 2, 3]]


def test_an_endless_continuation_is_refused() -> None:
    sentence = refusal(lines_read, SQUARE + "f 1 2 3 " + "\\\n1 " * 1_000_000)
    assert sentence.startswith("car.obj, line 5: a line must have at most 1,048,576 bytes, not ")


@pytest.mark.parametrize("corner", ["{}", "{}/1"])
def test_a_polygon_may_have_1000_corners(path: Path, corner: str) -> None:
    def text(corners: int) -> str:
        around = np.linspace(0, 2 * np.pi, corners, endpoint=False)
        nodes = "".join(f"v {x:.6f} {y:.6f} 0\n" for x, y in zip(np.cos(around), np.sin(around), strict=True))
        return nodes + "f " + " ".join(corner.format(number + 1) for number in range(corners)) + "\n"

    for corners in (999, 1000):
        assert len(read(path, text(corners)).mesh.node_numbers) >= corners // 2 - 1
    with pytest.raises(InputError, match=r"must have at most 1,000 corners, not 1,001; split it"):
        read(path, text(1001))


def test_a_polygon_of_too_many_corners_is_refused() -> None:
    assert refusal(lines_read, SQUARE + "f" + " 1 2 3" * 400) == (
        "car.obj, line 5: a polygon must have at most 1,000 corners, not 1,200; split it"
    )


@pytest.mark.parametrize("word", ["nan", "x", "1_0", "0x1"])
def test_the_weight_of_a_node_must_be_a_number(word: str) -> None:
    assert refusal(lines_read, f"v 0 0 0 {word}\n") == (
        f"car.obj, line 1: the weight of a node must be a decimal number, not {word!r}; correct it"
    )


@pytest.mark.parametrize("word", ["nan", "-nan", "inf", "1e999", "-nan(ind)", "1.#QNAN", "x"])
@pytest.mark.parametrize("weight", ["", " 1"])
def test_colors_of_nodes_may_be_anything(path: Path, word: str, weight: str) -> None:
    colored = "".join(f"v {place}{weight} {word} 0.5 {word}\n" for place in ("0 0 0", "1 0 0", "1 1 0"))
    assert read(path, colored + "f 1 2 3\n").mesh.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]


def test_a_corner_in_a_file_without_nodes_is_refused() -> None:
    assert refusal(lines_read, "f 1\n") == (
        "car.obj, line 1: a corner must be a node number of the file, which has no nodes, not 1; correct it"
    )


def test_a_polygon_names_its_first_corner_without_a_node_alone() -> None:
    assert refusal(lines_read, "f 7 8\n" + SQUARE + "f 1 9 10\n").splitlines() == [
        "car.obj, line 1: a corner must be a node number from 1 to 4, not 7; correct it",
        "car.obj, line 6: a corner must be a node number from 1 to 4 or from -4 to -1, not 9; correct it",
    ]


@given(st.lists(st.booleans(), min_size=1, max_size=3 * MOST_PROBLEMS))
def test_faults_stand_in_the_order_of_their_lines_up_to_a_number(faults: list[bool]) -> None:
    text = "".join("v x 0 0\n" if fault else "v 0 0 0\n" for fault in faults)
    wrong = [line for line, fault in enumerate(faults, start=1) if fault][:MOST_PROBLEMS]
    if not wrong:
        assert len(lines_read(text).coordinates) == len(faults)
        return
    lines = refusal(lines_read, text).splitlines()
    assert [line.split(":")[0] for line in lines] == [f"car.obj, line {line}" for line in wrong]


@given(st.binary(max_size=200) | st.text("vfgo 0123-./e\\\n\t#", max_size=200).map(str.encode))
def test_any_bytes_are_tables_of_finite_numbers_and_of_nodes_that_are_there(data: bytes) -> None:
    problems: tuple[str, ...] = ()
    try:
        tables = lines_read(data)
    except InputError as error:
        problems = error.problems
    else:
        assert np.isfinite(tables.coordinates).all()
        assert ((tables.rows >= 0) & (tables.rows < len(tables.coordinates))).all()
        assert tables.corner_counts.sum() == len(tables.numbers)
    assert all(problem.startswith("car.obj, line ") for problem in problems)


@pytest.mark.parametrize("cut", [1, 2, 3])
def test_a_statement_may_be_continued_between_any_two_words(cut: int) -> None:
    words = ["v", "1", "2", "3"]
    text = " ".join(words[:cut]) + " \\\n" + " ".join(words[cut:])
    assert lines_read(text).coordinates.tolist() == [[1, 2, 3]]


def test_the_size_of_a_coordinate_has_a_bound_on_both_sides() -> None:
    assert lines_read("v 1e30 -1e30 0\n").coordinates.tolist() == [[1e30, -1e30, 0]]
    for number in (math.nextafter(1e30, math.inf), -math.nextafter(1e30, math.inf)):
        assert "number of at most 1e30 in size" in refusal(lines_read, f"v {number!r} 0 0\n")


RED = b"newmtl red\nKd 1 0 0\n"
BLUE = b"newmtl blue\nKd 0 0 1\n"


def described(statements: str | bytes, *wanted: str) -> tuple[dict[str, Surface], list[str]]:
    """The surfaces of the materials `wanted`, red unless named, by a library, and its sentences."""
    data = statements if isinstance(statements, bytes) else statements.encode()
    surfaces, sentences = materials_of(data, "car.mtl", set(wanted or ("red",)))
    return dict(surfaces), sentences


def red(statements: str) -> Surface:
    """The surface of a material of those statements, of which nothing is to be told."""
    surfaces, sentences = described("newmtl red\n" + statements)
    assert sentences == []
    return surfaces["red"]


def of_nothing() -> Surface:
    """The surface of a material that is defined by its name alone."""
    return red("")


@pytest.mark.parametrize(
    ("statement", "color"),
    [
        ("Kd 1 0.5 0", (255, 128, 0)),
        ("Kd 0 0 0", (0, 0, 0)),
        ("Kd 0.2", (51, 51, 51)),
        ("Kd 2 1.0001 1e300", (255, 255, 255)),
        ("Kd .5 1. +0.25", (128, 255, 64)),
        ("Kd 5e-1 5E-1 0.5 # gray", (128, 128, 128)),
        ("\tKd  1\t0 0 ", (255, 0, 0)),
        ("Kd 0 1 0\nKd 1 0 0", (255, 0, 0)),
        ("Kd 1 0 0 0.5", (255, 0, 0)),
    ],
)
def test_kd_is_the_object_color_and_nothing_else(statement: str, color: tuple[int, int, int]) -> None:
    surface = red(statement)
    assert surface.paint.object_color == color
    assert surface == of_nothing().replace(object_color=color)


@pytest.mark.parametrize(
    ("statement", "specular"), [("Ks 0.2 0.5 0.1", 0.5), ("Ks 0.25", 0.25), ("Ks 1.5 0 0", 1.5)]
)
def test_the_largest_component_of_ks_is_s_and_nothing_else(statement: str, specular: float) -> None:
    surface = red(statement)
    assert surface.reflectance.specular == specular
    assert surface == created_surface("red", COLORED_PAINT.object_color).replace(specular=specular)


@pytest.mark.parametrize("statements", ["Kd 1 0 0\nKs 0 0 0", "Kd 1 0 0"])
def test_a_material_without_specular_reflectance_keeps_its_object_color_at_every_level(
    statements: str,
) -> None:
    surface = red(statements)
    assert (surface.reflectance.specular, surface.paint.blend) == (0, 1)


@pytest.mark.parametrize(("ns", "exponent"), [(0, 1), (0.75, 1), (32, 32), (1000, 1000)])
def test_ns_is_n_but_at_least_1_and_nothing_else(ns: float, exponent: float) -> None:
    surface = red(f"Ns {ns}")
    assert surface.reflectance.exponent == exponent
    assert surface == of_nothing().replace(exponent=exponent)


@pytest.mark.parametrize(("illum", "specular"), [(0, 0), (1, 0), (2, 0.5), (3, 0.5)])
def test_an_illumination_model_without_highlight_reflects_nothing_specularly(
    illum: int, specular: float
) -> None:
    surface = red(f"Ks 0.5 0.5 0.5\nillum {illum}")
    assert surface.reflectance.specular == specular
    assert surface.paint.blend == (1 if specular == 0 else COLORED_PAINT.blend)


def test_the_color_does_not_change_d() -> None:
    dark, light = red("Kd 0.1 0.1 0.1"), red("Kd 1 1 1")
    assert dark.reflectance == light.reflectance == of_nothing().reflectance


@pytest.mark.parametrize(
    "statement",
    ["Ka 1 1 1", "illum 2", "Ni 1.5", "Tf 1 1 1", "Ke 0 0 0", "sharpness 60", "", "# Kd 1 1 1", "odd"],
)
def test_other_statements_are_ignored(statement: str) -> None:
    assert red(statement) == of_nothing()


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_lines_of_a_library_end_in_any_way(path: Path, ending: str) -> None:
    path.with_suffix(".mtl").write_bytes(f"newmtl red{ending}Kd 1 0 0{ending}Ks x{ending}".encode())
    surfaces, sentences = read_materials(path, (), ("red",))
    assert surfaces[0].paint.object_color == (255, 0, 0)
    assert sentences == (
        "car.mtl, line 3: Ks must have one number or three, from 0 to 1e+06, not 'x'; the default is used",
    )


@pytest.mark.parametrize(
    "statement",
    [
        "map_Kd a.png", "map_Ks -s 1 1 1 a.png", "bump a.png", "map_Bump a.png", "MAP_KD a.png", "disp a.png",
        "decal a.png", "refl -type sphere a.png", "norm a.png",
    ],
)  # fmt: skip
def test_textures_are_told_as_left_out(statement: str) -> None:
    surfaces, sentences = described(f"newmtl red\n{statement}\n")
    assert sentences == ["car.mtl: left out the textures of 1 material"]
    assert surfaces["red"] == of_nothing()


@pytest.mark.parametrize("statement", ["d 0.5", "Tr 0.5", "d 0", "Tr 1"])
def test_transparency_is_told_as_left_out(statement: str) -> None:
    surfaces, sentences = described(f"newmtl red\n{statement}\n")
    assert sentences == ["car.mtl: left out the transparency of 1 material"]
    assert surfaces["red"] == of_nothing()


@pytest.mark.parametrize("statement", ["d 1", "d 1.0", "Tr 0", "Tr 0.000"])
def test_what_is_not_transparent_is_not_told(statement: str) -> None:
    assert red(statement) == of_nothing()


def test_what_is_left_out_is_counted_by_materials_that_are_wanted() -> None:
    text = "".join(
        f"newmtl {name}\nmap_Kd a.png\nmap_Ks a.png\nd 0.5\n" for name in ("red", "blue", "unused")
    )
    assert described(text, "red", "blue")[1] == [
        "car.mtl: left out the textures of 2 materials",
        "car.mtl: left out the transparency of 2 materials",
    ]


@pytest.mark.parametrize("keyword", ["Kd", "Ks", "Ns"])
@pytest.mark.parametrize(
    "words",
    ["", "x", "1 2", "-1 0 0", "nan", "inf", "1e999", "1e99999", "0x10", "1_0", "1,0,0", "1 1 x", "٣"],
)
def test_a_bad_number_is_told_with_its_line_and_the_default_is_used(keyword: str, words: str) -> None:
    surfaces, (sentence,) = described(f"# a library\nnewmtl red\n{keyword} {words}\n")
    rule = f"car.mtl, line 3: {keyword} must have one number or three, from 0 to 1e+06, not "
    assert sentence.startswith(rule)
    assert sentence.endswith("; the default is used")
    assert sentence.isprintable()
    assert surfaces["red"] == of_nothing()


def test_a_transparency_that_is_no_number_is_told() -> None:
    assert described("newmtl red\nd -halo 0.5\n")[1] == [
        "car.mtl, line 2: d must have one number or three, from 0 to 1e+06, not '-halo 0.5';"
        " the default is used"
    ]


def test_a_library_of_rubbish_is_a_few_short_sentences() -> None:
    _, sentences = described("newmtl red\n" + f"Kd {'x' * 10_000}\n" * 1000)
    assert len(sentences) == MOST_LIBRARY_PROBLEMS + 1
    assert sentences[-1] == f"car.mtl: {1000 - MOST_LIBRARY_PROBLEMS} more such lines"
    assert all(len(sentence) < 200 for sentence in sentences)


def test_the_first_definition_of_a_material_counts() -> None:
    surfaces, sentences = described(RED + BLUE + b"newmtl red\nKd 0 1 0\nNs 3\n", "red", "blue")
    assert sentences == []
    assert surfaces["red"] == red("Kd 1 0 0")
    assert surfaces["blue"].paint.object_color == (0, 0, 255)


def test_statements_before_the_first_material_belong_to_none() -> None:
    assert described(b"Kd 0 1 0\n" + RED)[0] == {"red": red("Kd 1 0 0")}


def test_materials_that_are_not_wanted_have_no_surface() -> None:
    assert described(RED + BLUE, "blue")[0].keys() == {"blue"}
    assert described(RED, "Red")[0] == {}


@pytest.mark.parametrize(
    ("written", "name"),
    [
        (b"newmtl my red", "my red"),
        (b"newmtl \t red \t", "red"),
        (b"newmtl h\xc3\xa4ube", "h\u00e4ube"),
        (b"newmtl h\xe4ube", "h\u00e4ube"),
        (b"newmtl \x1b[31m", "?[31m"),
        (b"newmtl " + b"x" * 1000, "x" * 200),
    ],
)
def test_a_material_has_the_name_that_an_obj_file_gives_it(written: bytes, name: str) -> None:
    surfaces, _ = described(written + b"\nKd 1 0 0\n", name)
    assert surfaces[name].paint.object_color == (255, 0, 0)


WORDS = st.sampled_from(
    [b"newmtl", b"red", b"Kd", b"Ks", b"Ns", b"d", b"Tr", b"map_Kd", b"1", b"0.5", b"-1", b"1e308", b"1e-308",
     b"9" * 400, b"nan", b"#", b"\xff"]
)  # fmt: skip
LINES = st.lists(WORDS, max_size=5).map(b" ".join)


@given(st.binary(max_size=100) | st.lists(LINES, max_size=20).map(b"\n".join))
def test_any_bytes_give_surfaces_that_there_can_be_and_sentences_that_can_be_shown(data: bytes) -> None:
    surfaces, sentences = materials_of(data, "car.mtl", {"red", "Kd"})
    assert surfaces.keys() <= {"red", "Kd"}
    for name, surface in surfaces.items():
        assert surface.name == name
        assert all(0 <= part <= 255 for part in surface.paint.object_color)
        assert surface.reflectance.specular >= 0
        assert surface.replace() == surface
    assert len(sentences) <= MOST_LIBRARY_PROBLEMS + 3
    assert all(sentence.isprintable() and len(sentence) < 250 for sentence in sentences)


@pytest.fixture
def obj(tmp_path: Path) -> Path:
    """The path of an OBJ file in a folder with two libraries and a folder with one."""
    folder = tmp_path / "car"
    (folder / "more").mkdir(parents=True)
    (folder / "red.mtl").write_bytes(RED)
    (folder / "my blue.mtl").write_bytes(BLUE)
    (folder / "more" / "green.mtl").write_bytes(b"newmtl green\nKd 0 1 0\n")
    (tmp_path / "outside.mtl").write_bytes(b"newmtl red\nKd 1 1 1\n")
    return folder / "car.obj"


def surfaces_of(obj: Path, *libraries: bytes) -> tuple[tuple[Surface, ...], tuple[str, ...]]:
    """What is read of three materials; that some of them are not defined is left out."""
    surfaces, sentences = read_materials(obj, libraries, ("red", "blue", "green"))
    return surfaces, tuple(each for each in sentences if "no library defines" not in each)


def test_materials_that_no_library_defines_are_told(obj: Path) -> None:
    assert read_materials(obj, [b"red.mtl"], ("red", "blue", "green"))[1] == (
        "no library defines material 'blue', 'green'; default colors are used",
    )
    many = ("red", *(f"paint {number}" for number in range(9)))
    assert read_materials(obj, [b"red.mtl"], many)[1] == (
        "no library defines material 'paint 0', 'paint 1', 'paint 2' and 6 more; default colors are used",
    )
    assert read_materials(obj, [], ("red", "blue")) == ((), ())


def names_read(obj: Path, *libraries: bytes) -> list[str]:
    """The names of the materials, where nothing is to be told."""
    surfaces, sentences = surfaces_of(obj, *libraries)
    assert sentences == ()
    return [surface.name for surface in surfaces]


@pytest.mark.parametrize(
    ("library", "names"),
    [
        (b"red.mtl", ["red"]),
        (b" red.mtl ", ["red"]),
        (b'"red.mtl"', ["red"]),
        (b"./red.mtl", ["red"]),
        (b"my blue.mtl", ["blue"]),
        (b'"my blue.mtl"', ["blue"]),
        (b"more/green.mtl", ["green"]),
        (b"more\\green.mtl", ["green"]),
        (b"red.mtl more/green.mtl", ["red", "green"]),
        (b"none.mtl red.mtl", ["red"]),
        (b"C:\\Users\\anna\\cars\\red.mtl", ["red"]),
        (b"C:\\Users\\anna\\my blue.mtl", ["blue"]),
        (b"/home/anna/cars/red.mtl", ["red"]),
        (b"../red.mtl", ["red"]),
        (b"\\\\server\\share\\red.mtl", ["red"]),
    ],
)
def test_a_library_is_found_in_the_folder_of_the_obj_file_or_below_it(
    obj: Path, library: bytes, names: list[str]
) -> None:
    assert names_read(obj, library) == names


def test_surfaces_come_in_the_order_in_which_they_are_wanted(obj: Path) -> None:
    assert names_read(obj, b"more/green.mtl", b"my blue.mtl", b"red.mtl") == ["red", "blue", "green"]


def test_of_a_material_in_several_libraries_the_first_counts(obj: Path) -> None:
    (obj.parent / "other.mtl").write_bytes(b"newmtl red\nKd 0 1 0\n")
    for libraries, color in (
        ((b"red.mtl", b"other.mtl"), (255, 0, 0)),
        ((b"other.mtl", b"red.mtl"), (0, 255, 0)),
        ((b"other.mtl red.mtl",), (0, 255, 0)),
    ):
        (surface,) = surfaces_of(obj, *libraries)[0]
        assert surface.paint.object_color == color


def test_without_a_library_that_of_the_same_name_beside_it_is_read(obj: Path) -> None:
    assert names_read(obj) == []
    obj.with_suffix(".mtl").write_bytes(BLUE)
    assert names_read(obj) == ["blue"]
    assert names_read(obj, b"red.mtl") == ["red"]


def test_without_materials_no_library_is_read(obj: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "read_bytes", None)
    assert read_materials(obj, [b"red.mtl", b"none.mtl"], ()) == ((), ())


@pytest.mark.parametrize(
    "library",
    [b"none.mtl", b"../outside.mtl", b"more", b".", b"", b"\0", b"a\0b.mtl", b"x" * 5000, b"\xff", b"*"],
)
def test_a_library_that_is_not_there_is_told(obj: Path, library: bytes) -> None:
    surfaces, (sentence,) = surfaces_of(obj, library)
    assert surfaces == ()
    assert sentence.startswith("the materials have default colors: there is no library ")
    assert sentence.endswith(" in the folder of car.obj; copy it there")
    assert sentence.isprintable()


def test_a_path_that_leads_outside_by_its_dots_finds_nothing_outside(obj: Path) -> None:
    for library in (
        b"../outside.mtl",
        b"more/../../outside.mtl",
        str(obj.parent.parent / "outside.mtl").encode(),
    ):
        assert surfaces_of(obj, library)[0] == ()


@pytest.mark.skipif(os.name != "posix", reason="needs symbolic links")
def test_a_link_that_leads_outside_is_not_followed(obj: Path) -> None:
    (obj.parent / "link.mtl").symlink_to(obj.parent.parent / "outside.mtl")
    (obj.parent / "folder").symlink_to(obj.parent.parent)
    for library in (b"link.mtl", b"folder/outside.mtl"):
        surfaces, (sentence,) = surfaces_of(obj, library)
        assert surfaces == ()
        assert "there is no library" in sentence


@pytest.mark.skipif(os.name != "posix", reason="needs symbolic links")
def test_a_link_beside_the_obj_file_that_leads_outside_is_not_followed(obj: Path) -> None:
    obj.with_suffix(".mtl").symlink_to(obj.parent.parent / "outside.mtl")
    assert surfaces_of(obj)[0] == ()


@pytest.mark.skipif(os.name != "posix", reason="needs symbolic links")
def test_a_link_within_the_folder_is_followed(obj: Path) -> None:
    (obj.parent / "link.mtl").symlink_to(obj.parent / "red.mtl")
    assert names_read(obj, b"link.mtl") == ["red"]


@pytest.mark.parametrize(
    "library", [b"http://example.org/none.mtl", b"https://example.org/a/none.mtl", b"file:///none.mtl"]
)
def test_an_address_is_never_fetched(obj: Path, library: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("socket.socket", None)
    surfaces, (sentence,) = surfaces_of(obj, library)
    assert surfaces == ()
    assert "there is no library" in sentence


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a named pipe")
def test_a_pipe_is_not_waited_for(obj: Path) -> None:
    os.mkfifo(obj.parent / "pipe.mtl")
    os.mkfifo(obj.with_suffix(".mtl"))
    assert "there is no library" in surfaces_of(obj, b"pipe.mtl")[1][0]
    assert surfaces_of(obj) == ((), ())


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (RED.decode().encode("utf-16"), "red.mtl: a material library must be text in UTF-8, not UTF-16"),
        (RED + b"\0", "red.mtl: a material library must be text, not hold a NUL byte (line 3)"),
    ],
)
def test_a_library_that_is_no_text_is_told_and_the_others_are_read(
    obj: Path, data: bytes, sentence: str
) -> None:
    (obj.parent / "red.mtl").write_bytes(data)
    surfaces, (told,) = surfaces_of(obj, b"red.mtl", b"my blue.mtl")
    assert told.startswith(f"the materials have default colors: {sentence}")
    assert [surface.name for surface in surfaces] == ["blue"]


def test_an_endless_library_is_told_and_not_read(obj: Path) -> None:
    with open(obj.parent / "red.mtl", "r+b") as file:
        file.truncate(1 << 40)
    surfaces, (told,) = surfaces_of(obj, b"red.mtl")
    assert surfaces == ()
    assert re.fullmatch(
        r"the materials have default colors: red.mtl: a file must have at most [\d,]+ bytes, not more; .*",
        told,
    )


def test_a_library_with_a_byte_order_mark_is_read(obj: Path) -> None:
    (obj.parent / "red.mtl").write_bytes(b"\xef\xbb\xbf" + RED)
    assert names_read(obj, b"red.mtl") == ["red"]


def test_what_is_wrong_in_a_library_is_told_with_its_name(obj: Path) -> None:
    (obj.parent / "red.mtl").write_bytes(RED + b"Kd x\nmap_Kd a.png\n")
    surfaces, sentences = surfaces_of(obj, b"red.mtl")
    assert surfaces == (red("Kd 1 0 0"),)
    assert sentences == (
        "red.mtl: left out the textures of 1 material",
        "red.mtl, line 3: Kd must have one number or three, from 0 to 1e+06, not 'x'; the default is used",
    )


def test_a_library_that_is_named_twice_is_read_once(obj: Path) -> None:
    (obj.parent / "red.mtl").write_bytes(RED + b"d 0.5\n")
    assert len(surfaces_of(obj, b"red.mtl", b"red.mtl")[1]) == 1


def count_of_looks(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The paths of the files that are looked for from now on."""
    looked: list[Path] = []
    is_file = Path.is_file

    def counted(path: Path) -> bool:
        looked.append(path)
        return is_file(path)

    monkeypatch.setattr(Path, "is_file", counted)
    return looked


def test_of_many_libraries_a_limited_number_is_looked_for(obj: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    looked = count_of_looks(monkeypatch)
    surfaces, sentences = surfaces_of(obj, *(b"none%d.mtl" % number for number in range(5000)), b"red.mtl")
    assert surfaces == ()
    assert len(sentences) == MOST_LIBRARY_PROBLEMS
    assert len(looked) <= 10 * MOST_LIBRARIES


def test_of_many_libraries_in_one_statement_a_limited_number_is_looked_for(
    obj: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked = count_of_looks(monkeypatch)
    surfaces_of(obj, b" ".join(b"none%d.mtl" % number for number in range(5000)))
    assert len(looked) <= 10 * MOST_LIBRARIES


@pytest.mark.parametrize("separator", [b" ", b""])
def test_a_library_is_looked_for_among_the_first_alone(obj: Path, separator: bytes) -> None:
    def found(before: int) -> bool:
        names = [*(b"none%d.mtl" % number for number in range(before)), b"red.mtl"]
        return bool(surfaces_of(obj, *([separator.join(names)] if separator else names))[0])

    assert [found(before) for before in (MOST_LIBRARIES - 2, MOST_LIBRARIES - 1, MOST_LIBRARIES)] == [
        True, True, False
    ]  # fmt: skip


@pytest.mark.parametrize("less", [-1, 0, 1])
def test_libraries_have_a_limited_size_together(
    obj: Path, less: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LARGEST_LIBRARIES", len(RED) + len(BLUE) - less)
    surfaces, sentences = surfaces_of(obj, b"red.mtl", b"my blue.mtl")
    assert len(surfaces) == (2 if less <= 0 else 1)
    assert len(sentences) == (0 if less <= 0 else 1)


def test_one_statement_reads_no_library_more_than_once(obj: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []

    def counted(path: Path, largest: int) -> bytes:
        opened.append(path.name)
        return read_bytes(path, largest)

    monkeypatch.setattr(module, "read_bytes", counted)
    surfaces_of(obj, b"red.mtl ./red.mtl red.mtl", b"red.mtl")
    assert opened == ["red.mtl"]


def test_a_file_name_that_is_as_long_as_can_be_has_no_library_beside_it(obj: Path) -> None:
    assert read_materials(obj.with_name("x" * 255), (), ("red",)) == ((), ())


@given(st.lists(st.binary(max_size=30) | LINES | st.text("./\\:ab", max_size=9).map(str.encode), max_size=3))
def test_any_names_of_libraries_are_found_or_told(
    tmp_path_factory: pytest.TempPathFactory, libraries: list[bytes]
) -> None:
    folder = tmp_path_factory.getbasetemp() / "any"
    folder.mkdir(exist_ok=True)
    surfaces, sentences = read_materials(folder / "car.obj", libraries, ("red",))
    assert surfaces == ()
    assert len(sentences) == len(set(libraries))
    assert all(sentence.isprintable() for sentence in sentences)


numbers = st.floats(-LARGEST_COORDINATE, LARGEST_COORDINATE, allow_subnormal=True)


def test_nodes_come_first_and_a_part_has_its_name_where_it_begins() -> None:
    mesh = Mesh(
        np.array([[0, 0, 0], [1, 0, 0], [1, 0.1, 0], [0, 1, 1e-9]]),
        np.array([[0, 1, 2, 3], [0, 1, 2, 2], [1, 2, 3, 3]]),
        np.array([0, 1, 1]),
        ("hood", "left door"),
    )
    assert obj_text(mesh).decode() == (
        "v 0.0 0.0 0.0\nv 1.0 0.0 0.0\nv 1.0 0.1 0.0\nv 0.0 1.0 1e-09\n"
        "o hood\nf 1 2 3 4\no left door\nf 1 2 3\nf 2 3 4\n"
    )


@given(st.lists(st.tuples(numbers, numbers, numbers), min_size=1, max_size=8))
def test_every_coordinate_reads_back_equal(
    tmp_path_factory: pytest.TempPathFactory, places: list[tuple[float, float, float]]
) -> None:
    # A triangle at each place, with sides as long as the place is far, so that it has area.
    coordinates = np.repeat(np.array(places), 3, axis=0)
    for axis in (0, 1):
        sides = np.maximum(np.abs(coordinates[axis + 1 :: 3]).max(axis=1), 1)
        coordinates[axis + 1 :: 3, axis] -= np.copysign(sides, coordinates[axis + 1 :: 3, axis])
    mesh = Mesh(coordinates, np.arange(len(coordinates)).reshape(-1, 3), np.zeros(len(places), int), ("a",))
    path = tmp_path_factory.mktemp("mesh") / "mesh.obj"
    path.write_bytes(obj_text(mesh))
    again = read_mesh({"file": path}).mesh.coordinates
    assert (again == coordinates).all()
    assert (np.signbit(again) == np.signbit(coordinates)).all()


@pytest.mark.parametrize("rows", [1, 7, 1 << 16])
def test_a_mesh_reads_back_equal_however_it_is_cut(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rows: int
) -> None:
    monkeypatch.setattr(module, "ROWS_AT_ONCE", rows)
    mesh = Mesh.joined([cube(), sphere(8, 6)])
    (tmp_path / "mesh.obj").write_bytes(obj_text(mesh))
    report = read_mesh({"file": tmp_path / "mesh.obj"})
    assert report.repairs == ()
    for name in ("coordinates", "node_numbers", "part_numbers"):
        assert np.array_equal(getattr(report.mesh, name), getattr(mesh, name))
    assert report.mesh.part_names == ("cube", "sphere")
    assert (report.mesh.normals.vectors == mesh.normals.vectors).all()


written_numbers = st.sampled_from(
    ["0", "1", "-1.5", "+.5", "5.", "1e3", "1E-3", "nan", "inf", "1e31", "1e999", "1_0", "e", "1-2", "x"]
)
nodes = st.lists(written_numbers, min_size=0, max_size=7).map(lambda words: " ".join(["v", *words]))
plain_nodes = st.lists(st.sampled_from(["0", "1", "-2.25", "3e-2"]), min_size=3, max_size=3).map(
    lambda words: " ".join(["v", *words])
)
corners = st.sampled_from(
    ["1", "2", "3", "-1", "-2", "0", "7", "1/1", "2//3", "3/1/1", "-1/-1", "1/", "1 /2", "+1", "x", "9" * 20]
)
polygons = st.lists(corners, max_size=6).map(lambda words: " ".join(["f", *words]))
plain_polygons = st.lists(
    st.sampled_from(["1", "2", "-1", "1/1", "2//3", "3/1/1"]), min_size=1, max_size=5
).map(lambda words: " ".join(["f", *words]))
others = st.sampled_from(
    [
        "",
        " ",
        "g",
        "g a",
        "g b c",
        "o d",
        "usemtl e",
        "usemtl",
        "vt 0 0",
        "vn 0 0 1",
        "vp 1",
        "vtx",
        "# f 1 2 3",
        "s 1",
        "l 1 2",
        "p 1",
        "what",
        " v 0 0 0",
        "\tf 1 2 3",
        "v",
        "f",
        "f ",
        "f 1 2 \\",
        "vn",
        "v\t1 2 3",
        "f 1 2 3#",
    ]
)
plain_others = st.sampled_from(["", "g a", "o d", "usemtl e", "vt 0 0", "# comment", "s 1", "l 1 2", "vn"])


def texts(*lines: st.SearchStrategy[str]) -> st.SearchStrategy[bytes]:
    return st.tuples(st.lists(st.one_of(*lines), max_size=30), st.sampled_from(["", "\n"])).map(
        lambda drawn: ("\n".join(drawn[0]) + drawn[1]).encode()
    )


def same(plain: ObjTables, lines: ObjTables) -> bool:
    return all(
        np.array_equal(getattr(plain, field.name), getattr(lines, field.name))
        for field in dataclasses.fields(ObjTables)
    )


@pytest.mark.parametrize("block", [1, 20, 1 << 21])
@given(text=texts(plain_nodes, plain_polygons, plain_others) | texts(nodes, polygons, others))
def test_the_fast_reader_gives_what_the_patient_one_gives_or_nothing(block: int, text: bytes) -> None:
    fast, patient = Statements("car"), Statements("car")
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(module, "BLOCK", block)
        plain = read_plain_obj(text, fast)
    if plain is None or (plain.rows < 0).any():
        return
    lines = read_obj_lines(text, "car.obj", patient)
    assert same(plain, lines)
    assert (fast.numbers, fast.sentences) == (patient.numbers, patient.sentences)


@given(text=texts(plain_nodes, plain_polygons, plain_others).filter(bool))
def test_plain_files_are_read_fast(text: bytes) -> None:
    assert read_plain_obj(text, Statements("car")) is not None


@given(text=texts(nodes, polygons, others))
def test_what_the_patient_reader_refuses_the_fast_one_leaves_alone(text: bytes) -> None:
    try:
        read_obj_lines(text, "car.obj", Statements("car"))
    except InputError:
        plain = read_plain_obj(text, Statements("car"))
        assert plain is None or (plain.rows < 0).any()


TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"


@pytest.mark.parametrize("line", [b"f \n", b"f \t\n", b"f 1 2 3\nf \n"])
def test_a_polygon_without_corners_has_none(line: bytes) -> None:
    plain = read_plain_obj(TRIANGLE + line, Statements("car"))
    assert plain is not None
    assert same(plain, read_obj_lines(TRIANGLE + line, "car.obj", Statements("car")))


@pytest.mark.parametrize("number", [b"18446744073709551617", b"9223372036854775808", b"9" * 30])
def test_a_node_number_of_more_than_64_bits_is_that_of_no_node(number: bytes) -> None:
    plain = read_plain_obj(TRIANGLE + b"f 1 2 " + number + b"\n", Statements("car"))
    assert plain is not None
    assert plain.rows.tolist() == [0, 1, -1]


def statements_of(text: str | bytes) -> tuple[Statements, list[int]]:
    """What the statements of a file leave behind, and the part number of each `f` in it."""
    statements = Statements("car")
    part_numbers = []
    for line in (text if isinstance(text, bytes) else text.encode()).split(b"\n"):
        if not statements.read(line):
            part_numbers.append(statements.part_number)
    return statements, part_numbers


def names_of(text: str | bytes) -> tuple[str, ...]:
    return tuple(statements_of(text)[0].parts())


@pytest.mark.parametrize(
    ("statements", "names"),
    [
        ("{f}", ("car",)),
        ("g hood\n{f}g roof\n{f}g hood\n{f}", ("hood", "roof")),
        ("o body\n{f}g roof\n{f}", ("body", "roof")),
        ("g hood left\n{f}", ("hood",)),
        ("o my car\n{f}", ("my car",)),
        ("usemtl red\n{f}usemtl blue paint\n{f}", ("red", "blue paint")),
        ("g hood\nusemtl red\n{f}usemtl blue\n{f}", ("hood", "hood blue")),
        ("g hood\n{f}usemtl red\n{f}g roof\n{f}g hood\n{f}", ("hood", "hood red", "roof")),
        ("usemtl red\n{f}g hood\n{f}g\n{f}usemtl\n{f}", ("red", "hood", "car")),
        ("g empty\ng hood\n{f}", ("hood",)),
        ("g\n{f}", ("car",)),
        ("g h\u00e4ube\n{f}", ("h\u00e4ube",)),
    ],
)
def test_groups_objects_and_materials_name_the_parts(statements: str, names: tuple[str, ...]) -> None:
    assert names_of(statements.format(f="f 1 2 3 4\n")) == names


def test_names_that_are_not_utf_8_are_latin_1_and_can_be_shown() -> None:
    assert names_of(b"g h\xe4ube\nf 1 2 3\ng \x1b[31m\nf 1 2 3\n") == ("h\u00e4ube", "?[31m")


def test_points_lines_and_unknown_statements_are_skipped_and_counted() -> None:
    statements, _ = statements_of("p 1\nl 1 2\nl 2 3\nwhat 3\nelse 4\ncurv 1 2\nf 1 2 3 4\n")
    assert statements.sentences == (
        "skipped points: 1",
        "skipped lines: 2",
        "skipped unknown statements (the first is 'what'): 2",
        "skipped statements of curves and curved surfaces: 1",
    )


def test_a_file_of_rubbish_is_one_short_sentence() -> None:
    statements, part_numbers = statements_of(
        "".join(f"rubbish{line}{'x' * 1000} 1\n" for line in range(1000))
    )
    (sentence,) = statements.sentences
    assert sentence.startswith("skipped unknown statements (the first is 'rubbish0xxx")
    assert sentence.endswith("...): 1,000")
    assert len(sentence) < 120
    assert part_numbers == []


def test_a_part_that_is_named_again_keeps_its_number() -> None:
    _, part_numbers = statements_of("f\ng a\nf\ng b\nf\nf\ng a\nf\ng\nf\n")
    assert part_numbers == [0, 1, 2, 2, 1, 0]


def test_a_name_without_polygons_has_no_number() -> None:
    assert names_of("g a\ng b\nf 1\ng c\n") == ("b",)


@pytest.mark.parametrize("keyword", ["g", "o", "usemtl"])
def test_an_endless_name_is_cut(keyword: str) -> None:
    assert names_of(f"{keyword} {'x' * 100_000}\nf\n") == ("x" * 200,)


@pytest.mark.parametrize("line", [b"", b"   ", b"# g a", b"#", *(word + b" 1 2" for word in sorted(UNUSED))])
def test_comments_and_unused_statements_leave_nothing_behind(line: bytes) -> None:
    statements = Statements("car")
    assert statements.read(line)
    assert statements.part_number == 0
    assert statements.parts() == {"car": None}
    assert statements.sentences == ()


@pytest.mark.parametrize("line", [b"v 1 2 3", b"f 1 2 3", b" v", b"\tf"])
def test_nodes_and_polygons_are_left_to_the_reader(line: bytes) -> None:
    assert not Statements("car").read(line)


statements_lines = st.sampled_from(
    [
        b"g",
        b"g a b",
        b"o c d",
        b"o",
        b"usemtl e",
        b"usemtl",
        b"mtllib h",
        b"p 1",
        b"l 1",
        b"odd",
        b"v 1",
        b"f 1",
        b"s off",
    ]
)


@given(
    st.lists(statements_lines | st.binary(max_size=12).filter(lambda line: b"\n" not in line), max_size=30)
)
def test_every_line_is_one_of_four_things(lines: list[bytes]) -> None:
    statements = Statements("car")
    left = sum(not statements.read(line) for line in lines)
    keywords = [words[0] for line in lines if (words := line.split()) and not words[0].startswith(b"#")]
    names = {b"g", b"o", b"usemtl", b"mtllib"}
    assert left == sum(keyword in (b"v", b"f") for keyword in keywords)
    skipped = [word for word in keywords if word not in {b"v", b"f", *names, *UNUSED}]
    assert sum(statements.skipped.values()) == len(skipped)
    known = {SKIPPED[word] for word in skipped if word in SKIPPED}
    assert len(statements.sentences) == len(known) + any(word not in SKIPPED for word in skipped)
    assert all(sentence.isprintable() for sentence in statements.sentences)


def test_a_group_of_several_materials_is_a_part_for_each_of_them() -> None:
    statements, part_numbers = statements_of(
        "usemtl red\ng hood\nf\nusemtl chrome\nf\ng door\nf\nusemtl red\nf\ng hood\nf\nusemtl\nf\n"
    )
    assert part_numbers == [0, 1, 2, 3, 0, 4]
    assert list(statements.parts().items()) == [
        ("hood", "red"),
        ("hood chrome", "chrome"),
        ("door", "chrome"),
        ("door red", "red"),
        ("hood 2", None),
    ]


def test_a_name_that_was_added_gives_way_to_those_that_stand_in_the_file() -> None:
    assert names_of("g hood\nusemtl red\nf\nusemtl chrome\nf\ng hood chrome\no hood chrome\nf\n") == (
        "hood",
        "hood chrome 2",
        "hood chrome",
    )


def test_the_libraries_are_the_arguments_of_their_statements_in_order() -> None:
    statements, _ = statements_of("mtllib car.mtl\nmtllib\n mtllib  my car.mtl more.mtl \nmtllib car.mtl\n")
    assert [library.strip() for library in statements.libraries] == [
        b"car.mtl",
        b"my car.mtl more.mtl",
        b"car.mtl",
    ]


SOME_NAMES = ["a", "b", "a b", "a b 2", "a 2", "car", "car 2", ""]


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["g", "o", "usemtl"]),
            st.sampled_from(SOME_NAMES) | st.text("ab 2", max_size=4),
            st.booleans(),
        ),
        max_size=20,
    )
)
def test_the_names_of_parts_always_differ_and_each_part_has_one_material(
    statements: list[tuple[str, str, bool]],
) -> None:
    text = "".join(f"{keyword} {name}\n" + "f\n" * is_used for keyword, name, is_used in statements)
    left, part_numbers = statements_of(text)
    parts = list(left.parts().items())
    assert len(parts) == len({*part_numbers})
    assert all(name for name, _ in parts)
    # The slow twin: the group and the material at each polygon.
    group: str | None = None
    material: str | None = None
    expected = []
    for keyword, name, is_used in statements:
        words = name.split()
        if keyword == "usemtl":
            material = name.strip() or None
        elif keyword == "g":
            group = words[0] if words else None
        else:
            group = name.strip() or None
        expected += [(group, material)] * is_used
    by_pair = dict(zip(expected, part_numbers, strict=True))
    assert [by_pair[pair] for pair in expected] == part_numbers
    assert len(by_pair) == len(parts)
    for (group, material), number in by_pair.items():
        assert parts[number][1] == material
        assert parts[number][0].startswith(group or material or "car")


def tables_of(nodes: int, *polygons: tuple[int, list[int]]) -> ObjTables:
    """Tables of a number of nodes and of polygons: how many nodes stood before each, and its numbers."""
    return ObjTables(
        np.zeros((nodes, 3)),
        np.array([number for _, numbers in polygons for number in numbers], np.int64),
        np.array([len(numbers) for _, numbers in polygons], np.int64),
        np.zeros(len(polygons), np.int64),
        np.array([before for before, _ in polygons], np.int64),
        np.arange(len(polygons)),
    )


def row_of(nodes: int, before: int, number: int) -> int:
    """The slow twin: the row of the node table that a number in a file means, or -1."""
    if 1 <= number <= nodes:
        return number - 1
    if -before <= number <= -1:
        return before + number
    return -1


file_numbers = st.integers(-8, 8) | st.integers(-(1 << 63), (1 << 63) - 1)


@given(st.integers(0, 6), st.data())
def test_every_corner_has_the_row_of_the_slow_twin(nodes: int, data: st.DataObject) -> None:
    polygon = st.tuples(st.integers(0, nodes), st.lists(file_numbers, max_size=5))
    polygons = data.draw(st.lists(polygon, max_size=5))
    tables = tables_of(nodes, *polygons)
    assert tables.rows.tolist() == [
        row_of(nodes, before, number) for before, numbers in polygons for number in numbers
    ]
    assert tables.rows.dtype == np.intp


def test_a_negative_number_counts_back_from_its_polygon_and_not_from_the_end() -> None:
    assert tables_of(4, (2, [-1, -2]), (4, [-1, -4])).rows.tolist() == [1, 0, 3, 0]


@pytest.mark.parametrize("number", [0, 4, -3, 1 << 62, -(1 << 63)])
def test_a_number_of_no_node_has_no_row(number: int) -> None:
    assert tables_of(3, (2, [1, number])).rows.tolist() == [0, -1]


def test_the_numbers_of_the_file_stay_as_they_are() -> None:
    tables = tables_of(3, (3, [-1, 9, 1]))
    assert tables.rows.tolist() == [2, -1, 0]
    assert tables.numbers.tolist() == [-1, 9, 1]
