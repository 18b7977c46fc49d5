from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.ply import binary as binary_module
from autocolor.files.meshes.ply.binary import CODES, read_binary
from autocolor.files.meshes.ply.columns import Lists, PlyTables
from autocolor.files.meshes.ply.header import Element, Header, Property

ENDING = "the file is cut short or its header is wrong, export it again"
INTEGERS = ("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8")

Row = list[float | list[float]]


def table(element: Element, data: bytes, order: str = "<") -> PlyTables:
    return read_binary(b"HEAD" * 4 + data, Header(order, (element,), (), 16, 1), "a.ply")


def values(column: Any) -> Any:
    return [each.tolist() for each in column] if isinstance(column, Lists) else column.tolist()


def packed(order: str, properties: tuple[Property, ...], rows: list[Row]) -> bytes:
    codes = {**CODES, "f4": "f", "f8": "d"}
    data = b""
    for row in rows:
        for each, value in zip(properties, row, strict=True):
            if isinstance(value, list):
                assert each.count_type is not None
                data += struct.pack(order + codes[each.count_type], len(value))
            for number in value if isinstance(value, list) else [value]:
                data += struct.pack(order + codes[each.type], number)
    return data


def properties_and_rows() -> st.SearchStrategy[tuple[tuple[Property, ...], list[Row]]]:
    types = st.sampled_from(["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"])
    kinds = st.lists(st.tuples(types, st.none() | st.sampled_from(INTEGERS)), min_size=1, max_size=4)

    def with_rows(kinds: list[tuple[str, str | None]]) -> Any:
        properties = tuple(Property(f"p{at}", *kind) for at, kind in enumerate(kinds))
        number = st.integers(0, 100)
        row = st.tuples(
            *(st.lists(number, max_size=3) if each.count_type else number for each in properties)
        ).map(list)
        same = st.tuples(row, st.integers(0, 5)).map(lambda drawn: [drawn[0]] * drawn[1])
        return st.tuples(st.just(properties), st.lists(row, max_size=6) | same)

    return kinds.flatmap(with_rows)


@given(drawn=properties_and_rows(), order=st.sampled_from("<>"), at_once=st.sampled_from([1, 2, 1 << 16]))
def test_elements_of_any_types_are_read(
    drawn: tuple[tuple[Property, ...], list[Row]], order: str, at_once: int
) -> None:
    properties, rows = drawn
    data = packed(order, properties, rows)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(binary_module, "ROWS_AT_ONCE", at_once)
        found = table(Element("vertex", len(rows), properties), data + b"end", order)
        for end in range(len(data)):
            with pytest.raises(InputError):
                table(Element("vertex", len(rows), properties), data[:end], order)
    assert found.skipped == ("skipped bytes after the last element: 3",)
    for at, each in enumerate(properties):
        column = [row[at] for row in rows]
        if each.count_type:
            lists = [value if isinstance(value, list) else [] for value in column]
            expected: Any = [[number for one in lists for number in one], [len(one) for one in lists]]
        else:
            expected = column
        assert values(found.elements["vertex"].columns[each.name]) == expected


def test_rows_of_several_elements_follow_each_other() -> None:
    vertex = Element("vertex", 2, (Property("x", "f4"),))
    nothing = Element("nothing", 5, ())
    face = Element("face", 1, (Property("of_it", "i2", "u1"),))
    data = np.array([1, 2], "<f4").tobytes() + b"\2\7\0\10\0"
    found = read_binary(data, Header("<", (vertex, nothing, face), (), 0, 1), "a.ply")
    assert values(found.elements["vertex"].columns["x"]) == [1, 2]
    assert found.elements["nothing"].columns == {}
    assert values(found.elements["face"].columns["of_it"]) == [[7, 8], [2]]
    assert found.elements["face"].place_of(0) == "a.ply, face 0"
    assert found.skipped == ()


def test_a_count_that_the_file_has_no_room_for_is_refused_before_anything_is_made() -> None:
    element = Element("vertex", 10**17, (Property("x", "f4"), Property("of_it", "i4", "u1")))
    with pytest.raises(InputError) as refusal:
        table(element, bytes(20))
    assert str(refusal.value) == (
        "a.ply: 100,000,000,000,000,000 elements 'vertex' must have at least 500,000,000,000,000,000 bytes,"
        f" not 20; {ENDING}"
    )


@pytest.mark.parametrize(
    ("code", "data"),
    [("u1", b"\1\0\xff\0"), ("i4", b"\1\0\0\0\0\xff\xff\xff\x7f"), ("u8", b"\0" * 8 + b"\xff" * 8)],
)
def test_lists_that_the_file_has_no_room_for_are_refused(code: str, data: bytes) -> None:
    element = Element("vertex", 2, (Property("of_it", "u1", code),))
    with pytest.raises(InputError) as refusal:
        table(element, data)
    assert str(refusal.value) == (
        f"a.ply: 2 elements 'vertex' must have all their lists before the end, not after it; {ENDING}"
    )


@pytest.mark.parametrize(("code", "count"), [("i1", b"\xff"), ("i4", b"\xfe\xff\xff\xff")])
@pytest.mark.parametrize("first", [True, False])
def test_a_negative_count_is_refused(code: str, count: bytes, first: bool) -> None:
    data = count + bytes(20) if first else bytes(len(count)) + count + bytes(20)
    with pytest.raises(InputError) as refusal:
        table(Element("face", 2, (Property("of_it", "u1", code),)), data)
    assert str(refusal.value) == (
        f"a.ply, face {0 if first else 1}: the count of a list must be 0 or more, not less; export it again"
    )


def test_a_row_longer_than_a_type_of_numpy_is_walked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(binary_module, "LONGEST_ROW", 2)
    element = Element("face", 2, (Property("of_it", "u1", "u1"),))
    assert values(table(element, b"\2\1\2\2\3\4").elements["face"].columns["of_it"]) == [[1, 2, 3, 4], [2, 2]]


def test_lists_of_an_element_that_is_not_used_are_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(binary_module, "ROWS_AT_ONCE", 2)
    other = Element("other", 5, (Property("of_it", "u1", "u1"),))
    vertex = Element("vertex", 1, (Property("x", "u1"),))
    data = b"\1\0\2\0\0\0\0\1\0\7"
    found = read_binary(data, Header("<", (other, vertex), (), 0, 1), "a.ply")
    assert found.elements["other"].columns == {}
    assert values(found.elements["vertex"].columns["x"]) == [7]
    assert found.skipped == ()


def test_faces_without_corners_on_the_average_are_refused() -> None:
    face = Element("face", 5, (Property("vertex_indices", "u1", "u1"),))
    assert (
        len(values(table(face, b"\0\0\0\0\5\0\1\2\3\4").elements["face"].columns["vertex_indices"])[1]) == 5
    )
    with pytest.raises(InputError) as refusal:
        table(face, b"\0\0\0\0\4\0\1\2\3")
    assert str(refusal.value) == f"a.ply: 5 elements 'face' must have at least 10 bytes, not 9; {ENDING}"
