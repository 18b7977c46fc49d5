from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.ply import text as text_module
from autocolor.files.meshes.ply.columns import Lists, PlyTables
from autocolor.files.meshes.ply.header import parsed_header
from autocolor.files.meshes.ply.text import read_text

HEAD = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty list uchar int of_it\n"
BOTH = HEAD + "element face 1\nproperty list uchar int vertex_indices\nproperty int quality\nend_header\n"
HEAD += "end_header\n"


def tables(text: str | bytes) -> PlyTables:
    data = text if isinstance(text, bytes) else text.encode()
    return read_text(data, parsed_header(data, "a.ply"), "a.ply")


def refusal(text: str | bytes) -> str:
    with pytest.raises(InputError) as caught:
        tables(text)
    return str(caught.value)


def values(column: Any) -> Any:
    return [each.tolist() for each in column] if isinstance(column, Lists) else column.tolist()


@pytest.mark.parametrize("feed", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("block", [1, 1 << 21])
def test_a_line_is_a_row(feed: str, block: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_module, "BLOCK", block)
    found = tables((BOTH + "1.5 2 7 8\n\n \t-2e3 0\n3 0 1 2 9").replace("\n", feed))
    vertices, faces = found.elements["vertex"], found.elements["face"]
    assert values(vertices.columns["x"]) == [1.5, -2000]
    assert values(vertices.columns["of_it"]) == [[7, 8], [2, 0]]
    assert values(faces.columns["vertex_indices"]) == [[0, 1, 2], [3]]
    assert values(faces.columns["quality"]) == [9]
    # The header has ten lines, and one after the first row is empty.
    assert [vertices.place_of(row) for row in (0, 1)] == ["a.ply, line 10", "a.ply, line 12"]
    assert faces.place_of(0) == "a.ply, line 13"
    assert found.skipped == ()


def test_a_scalar_may_be_missing_or_infinite() -> None:
    found = values(tables(HEAD + "nan 0\n-inf 0\n").elements["vertex"].columns["x"])
    assert np.isnan(found[0])
    assert found[1] == -np.inf


def test_whole_numbers_are_read_whatever_their_size() -> None:
    found = values(tables(HEAD + "12345678901234567890123 0\n1 0\n").elements["vertex"].columns["x"])
    assert found == [12345678901234567890123.0, 1]


def test_lines_after_the_last_element_are_counted() -> None:
    assert tables(HEAD + "1 0\n2 0\n\n3 0\n4 0\n \n").skipped == ("skipped lines after the last element: 2",)


@pytest.mark.parametrize("block", [1, 1 << 21])
@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        ("1 0\n0x1 0\n", "line 8: a value must be a decimal number, not '0x1'; correct it"),
        ("1 0\n\n1_0 0\n", "line 9: a value must be a decimal number, not '1_0'; correct it"),
        ("1 0\n1,5 0\n", "line 8: a value must be a decimal number, not '1,5'; correct it"),
        ("1 0\n1-2 0\n", "line 8: a value must be a decimal number, not '1-2'; correct it"),
        (
            "1 0\n2 2 0\n",
            "line 8: a line of an element 'vertex' must have the values of x, of_it, and this has too few;"
            " correct it",
        ),
        (
            "1\n2 0 0 0 0\n",
            "line 7: a line of an element 'vertex' must have the values of x, of_it, and this has too few;"
            " correct it",
        ),
        (
            "1 0 5\n2 0\n",
            "line 7: a line of an element 'vertex' must have the values of x, of_it, and this has too many;"
            " correct it",
        ),
        (
            "1 -1 5\n2 0\n",
            "line 7: the count of a list must be a whole number from 0 on, not -1; correct it",
        ),
        (
            "1 0.5 5\n2 0\n",
            "line 7: the count of a list must be a whole number from 0 on, not 0.5; correct it",
        ),
        (
            "1 nan 5\n2 0\n",
            "line 7: the count of a list must be a whole number from 0 on, not nan; correct it",
        ),
    ],
)
def test_a_wrong_line_is_refused(
    rows: str, sentence: str, block: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(text_module, "BLOCK", block)
    assert refusal(HEAD + rows) == f"a.ply, {sentence}"


def test_a_file_cut_short_is_refused() -> None:
    ending = "the file is cut short or its header is wrong, export it again"
    assert refusal(HEAD + "1 0\n") == (
        f"a.ply: 2 elements 'vertex' must have at least 8 bytes, not 5; {ending}"
    )
    assert refusal(HEAD + "1.00000000 0\n") == f"a.ply: there must be 2 elements 'vertex', not 1; {ending}"


def test_a_count_that_the_file_has_no_room_for_is_refused_before_anything_is_made() -> None:
    assert refusal(HEAD.replace("vertex 2", "vertex 999999999999") + "1 0\n") == (
        "a.ply: 999,999,999,999 elements 'vertex' must have at least 3,999,999,999,996 bytes, not 5; the file"
        " is cut short or its header is wrong, export it again"
    )


def test_an_element_must_have_properties() -> None:
    assert refusal("ply\nformat ascii 1.0\nelement vertex 1\nend_header\n1\n") == (
        "a.ply: an element must have a property, not none: 'vertex'; export it again"
    )


def test_zeros_and_endless_lines_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    assert refusal(HEAD + "1 0\n\0 0\n") == (
        "a.ply: an ascii PLY file must be text, not hold a NUL byte (line 8); save it as UTF-8 text"
    )
    monkeypatch.setattr(text_module, "LONGEST_LINE", 20)
    assert refusal(HEAD + "1 0\n2 0" + " " * 30 + "\n") == (
        "a.ply: a line must have at most 20 bytes, not more; split it"
    )


@given(
    rows=st.lists(st.tuples(st.floats(width=32), st.lists(st.integers(-9, 9), max_size=5)), max_size=20),
    block=st.sampled_from([1, 30, 1 << 21]),
)
def test_what_is_written_in_text_is_read(rows: list[tuple[float, list[int]]], block: int) -> None:
    lines = "".join(f"{x!r} {len(of_it)} {' '.join(map(str, of_it))}\n" for x, of_it in rows)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(text_module, "BLOCK", block)
        found = tables(HEAD.replace("vertex 2", f"vertex {len(rows)}") + lines).elements["vertex"].columns
    np.testing.assert_array_equal(values(found["x"]), [x for x, _ in rows])
    assert values(found["of_it"]) == [
        [number for _, of_it in rows for number in of_it],
        [len(of_it) for _, of_it in rows],
    ]


def test_faces_without_corners_on_the_average_are_refused() -> None:
    header = "ply\nformat ascii 1.0\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    assert values(tables(header + "0\n0\n0\n4 0 1 2 3\n").elements["face"].columns["vertex_indices"])[1] == [
        0,
        0,
        0,
        4,
    ]
    assert refusal(header + "0\n0\n0\n2 0 1") == (
        "a.ply: 4 elements 'face' must have at least 16 bytes, not 12; the file is cut short or its header is"
        " wrong, export it again"
    )
