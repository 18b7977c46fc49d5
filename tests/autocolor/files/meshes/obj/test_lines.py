from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.obj.lines import MOST_PROBLEMS, ObjLines, read_obj_lines
from autocolor.files.meshes.obj.statements import Statements
from autocolor.files.meshes.obj.tables import ObjTables

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def read(text: str | bytes) -> ObjTables:
    data = text if isinstance(text, bytes) else text.encode()
    return read_obj_lines(data, "car.obj", Statements("car"))


def refusal(text: str | bytes) -> str:
    with pytest.raises(InputError) as caught:
        read(text)
    return str(caught.value)


coordinates = st.floats(-1e30, 1e30).map(lambda number: number + 0.0)


@given(
    st.lists(st.tuples(coordinates, coordinates, coordinates), min_size=1, max_size=6),
    st.lists(st.lists(st.integers(1, 6), min_size=1, max_size=6), max_size=6),
)
def test_what_is_written_is_read_to_the_last_bit(
    nodes: list[tuple[float, float, float]], polygons: list[list[int]]
) -> None:
    polygons = [[1 + (number - 1) % len(nodes) for number in polygon] for polygon in polygons]
    tables = read(
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
    assert refusal(f"{SQUARE}v 0 {number} 0\nf 1 2 3\n") == (
        "car.obj, line 5: a coordinate must be a decimal number of at most 1e30 in size,"
        f" not {number!r}; correct it"
    )


@pytest.mark.parametrize(
    "corner",
    ["1.5", "1.0", "x", "/1", "1/x", "1/2/3/4", "1e2", "\u0663", "9" * 19, "9" * 100_000, "1_0", "--1"],
)
def test_a_corner_that_is_no_node_number_is_refused(corner: str) -> None:
    sentence = refusal(f"{SQUARE}f 1 2 {corner}\n")
    assert sentence.startswith(
        "car.obj, line 5: a corner must be a node number, alone or with texture and normal numbers as in"
        " 7/1/3, not "
    )
    assert len(sentence) < 200


def test_a_node_with_too_few_coordinates_is_refused() -> None:
    assert refusal(SQUARE + "v 1 2\nf 1 2 3\n") == (
        "car.obj, line 5: a node must have three coordinates x y z, not 2; add what is missing"
    )


def test_every_problem_is_named_with_the_first_line_of_its_statement() -> None:
    with pytest.raises(InputError) as caught:
        read("v a b 0\n" + SQUARE + "f 1 2 \\\n x\nf 1 2 3\nf 1 2 9\n")
    assert [problem.split(":")[0] for problem in caught.value.problems] == [
        "car.obj, line 1",
        "car.obj, line 1",
        "car.obj, line 6",
        "car.obj, line 9",
    ]


def test_a_file_of_faults_has_a_short_report() -> None:
    assert len(refusal("v x\n" * 100_000)) < 5000


@pytest.mark.parametrize("letter", [b"a", b"v 1 ", b"# ", b"f 1 2 3 "])
def test_an_endless_line_is_refused(letter: bytes) -> None:
    sentence = refusal(SQUARE.encode() + letter * (2_000_000 // len(letter)))
    assert sentence == "car.obj, line 5: a line must have at most 1,048,576 bytes, not 2,000,000; split it"


def test_an_endless_continuation_is_refused() -> None:
    sentence = refusal(SQUARE + "f 1 2 3 " + "\\\n1 " * 1_000_000)
    assert sentence.startswith("car.obj, line 5: a line must have at most 1,048,576 bytes, not ")


def test_a_polygon_of_too_many_corners_is_refused() -> None:
    assert refusal(SQUARE + "f" + " 1 2 3" * 400) == (
        "car.obj, line 5: a polygon must have at most 1,000 corners, not 1,200; split it"
    )


@pytest.mark.parametrize("word", ["nan", "x", "1_0", "0x1"])
def test_what_follows_the_coordinates_must_be_numbers_too(word: str) -> None:
    assert refusal(f"v 0 0 0 1 {word}\n") == (
        f"car.obj, line 1: what follows x y z must be decimal numbers, not {word!r}; correct it"
    )


def test_a_corner_in_a_file_without_nodes_is_refused() -> None:
    assert refusal("f 1\n") == (
        "car.obj, line 1: a corner must be a node number of a node in the file, which has none, not 1;"
        " correct it"
    )


def test_a_polygon_names_its_first_corner_without_a_node_alone() -> None:
    assert refusal("f 7 8\n" + SQUARE + "f 1 9 10\n").splitlines() == [
        "car.obj, line 1: a corner must be a node number from 1 to 4, not 7; correct it",
        "car.obj, line 6: a corner must be a node number from 1 to 4 or from -4 to -1, not 9; correct it",
    ]


@given(st.lists(st.booleans(), min_size=1, max_size=3 * MOST_PROBLEMS))
def test_faults_stand_in_the_order_of_their_lines_up_to_a_number(faults: list[bool]) -> None:
    text = "".join("v x 0 0\n" if fault else "v 0 0 0\n" for fault in faults)
    wrong = [line for line, fault in enumerate(faults, start=1) if fault][:MOST_PROBLEMS]
    if not wrong:
        assert len(read(text).coordinates) == len(faults)
        return
    lines = refusal(text).splitlines()
    assert [line.split(":")[0] for line in lines] == [f"car.obj, line {line}" for line in wrong]


def test_nothing_is_raised_before_there_is_a_problem() -> None:
    reader = ObjLines("car.obj", Statements("car"))
    reader.raise_any()
    reader.line = 7
    reader.node([b"1", b"2"])
    with pytest.raises(
        InputError, match=r"car\.obj, line 7: a node must have three coordinates x y z, not 2"
    ):
        reader.raise_any()


@given(st.binary(max_size=200) | st.text("vfgo 0123-./e\\\n\t#", max_size=200).map(str.encode))
def test_any_bytes_are_tables_of_finite_numbers_and_of_nodes_that_are_there(data: bytes) -> None:
    problems: tuple[str, ...] = ()
    try:
        tables = read(data)
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
    assert read(text).coordinates.tolist() == [[1, 2, 3]]


def test_the_size_of_a_coordinate_has_a_bound_on_both_sides() -> None:
    assert read("v 1e30 -1e30 0\n").coordinates.tolist() == [[1e30, -1e30, 0]]
    for number in (math.nextafter(1e30, math.inf), -math.nextafter(1e30, math.inf)):
        assert "must be a decimal number of at most 1e30 in size" in refusal(f"v {number!r} 0 0\n")
