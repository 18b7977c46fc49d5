from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.obj import plain as plain_reader
from autocolor.files.meshes.obj.lines import read_obj_lines
from autocolor.files.meshes.obj.plain import read_plain_obj
from autocolor.files.meshes.obj.statements import Statements
from autocolor.files.meshes.obj.tables import ObjTables

numbers = st.sampled_from(
    ["0", "1", "-1.5", "+.5", "5.", "1e3", "1E-3", "nan", "1e31", "1_0", "e", "1-2", "x"]
)
nodes = st.lists(numbers, min_size=0, max_size=7).map(lambda words: " ".join(["v", *words]))
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
        patched.setattr(plain_reader, "BLOCK", block)
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
