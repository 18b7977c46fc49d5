from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes import number_text, ply_elements
from autocolor.files.meshes.ply_elements import (
    CODES,
    TYPES,
    Element,
    ElementRows,
    Lists,
    PlyHeader,
    Property,
    parsed_header,
    read_binary,
    read_text,
)
from tests.autocolor.files.refusals import refusal, refused

LINES = (
    "ply",
    "format binary_little_endian 1.0",
    "comment a cube",
    "obj_info what else",
    "element vertex 8",
    "property float x",
    "property list uint8 int32 of_it",
    "element face 6",
    "end_header",
)


def text(*lines: str, feed: str = "\n") -> bytes:
    return "".join(line + feed for line in lines).encode()


@pytest.mark.parametrize("feed", ["\n", "\r\n", "\r"])
def test_a_header_says_elements_and_where_their_data_begin(feed: str) -> None:
    data = text(*LINES, feed=feed)
    # What follows may begin like the end of a line.
    header = parsed_header(data + b"\n\r\n", "a.ply")
    assert header.order == "<"
    assert header.elements == (
        Element("vertex", 8, (Property("x", "f4"), Property("of_it", "i4", "u1"))),
        Element("face", 6, ()),
    )
    assert header.comments == ("a cube",)
    assert (header.length, header.lines) == (len(data), 9)


def test_types_have_old_and_new_names() -> None:
    assert list(TYPES.values())[:8] == list(TYPES.values())[8:16]


def test_a_header_without_a_line_at_its_end_is_read_where_there_are_no_data() -> None:
    data = text(*LINES)[:-1]
    assert parsed_header(data, "a.ply").length == len(data)


NOT_A_LINE = (
    "line 2: a line of the header must be a format, a comment, an element, one of its properties or"
    " end_header, not {!r}; export it again"
)
NOT_A_FORMAT = (
    "line 2: a format must be 'ascii', 'binary_little_endian' or 'binary_big_endian' and 1.0, not {!r};"
    " export it again"
)
NOT_A_PROPERTY = (
    "line 3: a property must be a type and a name, or list, two types and a name, not {!r}; export it again"
)
NEEDED = "leave out what is not needed"
NOT_PLY = "a PLY file must begin with a line 'ply', not {!r}; export it again"

test_a_wrong_header_is_refused = refused(
    "a.ply",
    [
        (data, f"a.ply: {sentence}")
        for data, sentence in (
            *((data, NOT_PLY.format(data.decode().strip())) for data in (b"", b"solid a\n", b"plyx\n")),
            ("ply\n".encode("utf-16"), "a PLY file must be text in UTF-8, not UTF-16; save it as UTF-8"),
            (text("ply", "end_header"), "a header must have a line 'format', not none; export it again"),
            (
                text(*LINES[:-1]),
                "a header must have a line 'end_header' before the file ends; export it again",
            ),
            (
                text("ply", "comment ".ljust(65_537, "x")),
                "a line of the header must have at most 65,536 bytes, not more; export it again",
            ),
        )
    ]
    + [
        (text("ply", *lines), f"a.ply, {sentence}")
        for *lines, sentence in (
            ("format binary 1.0", NOT_A_FORMAT.format("binary 1.0")),
            ("format ascii 2.0", NOT_A_FORMAT.format("ascii 2.0")),
            ("elements vertex 8", NOT_A_LINE.format("elements vertex 8")),
            ("property float x", NOT_A_LINE.format("property float x")),
            *(
                (
                    f"element {words}",
                    "line 2: an element must have a name and a count of at most 18 digits, not"
                    f" {words!r}; export it again",
                )
                for words in ("vertex -1", "vertex", "vertex 1 2", "vertex " + "9" * 19)
            ),
            (
                "element vertex 1",
                "element vertex 2",
                "line 3: the name of an element must be unique, not repeated: 'vertex'; rename one",
            ),
            ("element vertex 1", "property float", NOT_A_PROPERTY.format("float")),
            ("element vertex 1", "property list int x", NOT_A_PROPERTY.format("list int x")),
            (
                "element vertex 1",
                "property flaot x",
                "line 3: a type must be one of PLY, not 'flaot'; did you mean 'float'?; export it again",
            ),
            (
                "element face 1",
                "property list float int x",
                "line 3: the count of a list must have a whole type, not 'float'; export it again",
            ),
            (
                "element vertex 1",
                "property float x",
                "property int x",
                "line 4: the name of a property must be unique, not repeated: 'x'; rename one",
            ),
            (
                *(f"element e{number} 1" for number in range(101)),
                f"line 102: a header must have at most 100 elements, not more; {NEEDED}",
            ),
            (
                *("element e 1", *(f"property int p{number}" for number in range(1001))),
                f"line 1003: a header must have at most 1,000 properties, not more; {NEEDED}",
            ),
        )
    ],
)


def test_a_header_may_be_as_long_as_it_may_be(monkeypatch: pytest.MonkeyPatch) -> None:
    properties = [f"property int p{number}" for number in range(1000)]
    elements = [f"element e{number} 1" for number in range(100)]
    comment = "comment ".ljust(65_535, "x")
    data = text("ply", "format ascii 1.0", comment, *elements, *properties, "end_header")
    header = parsed_header(data, "a.ply")
    assert (len(header.elements), len(header.elements[-1].properties)) == (100, 1000)
    assert [len(found) for found in header.comments] == [65_535 - len("comment ")]
    # A header without an end is not searched to the end of the file.
    monkeypatch.setattr(ply_elements, "LARGEST_HEADER", 100)
    assert refusal(parsed_header, text("ply", *["comment a"] * 100), "a.ply") == (
        "a.ply: a header must have a line 'end_header' within 100 bytes; export it again"
    )


ENDING = ply_elements.CUT_SHORT
INTEGERS = ("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8")

Row = list[float | list[float]]


def table(element: Element, data: bytes, order: str = "<") -> tuple[dict[str, ElementRows], tuple[str, ...]]:
    return read_binary(b"HEAD" * 4 + data, PlyHeader(order, (element,), (), 16, 1), "a.ply")


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
        patched.setattr(ply_elements, "ROWS_AT_ONCE", at_once)
        found = table(Element("vertex", len(rows), properties), data + b"end", order)
        for end in range(len(data)):
            with pytest.raises(InputError):
                table(Element("vertex", len(rows), properties), data[:end], order)
    assert found[1] == ("skipped bytes after the last element: 3",)
    for at, each in enumerate(properties):
        column = [row[at] for row in rows]
        if each.count_type:
            lists = [value if isinstance(value, list) else [] for value in column]
            expected: Any = [[number for one in lists for number in one], [len(one) for one in lists]]
        else:
            expected = column
        assert values(found[0]["vertex"].columns[each.name]) == expected


def test_rows_of_several_elements_follow_each_other() -> None:
    vertex = Element("vertex", 2, (Property("x", "f4"),))
    nothing = Element("nothing", 5, ())
    face = Element("face", 1, (Property("of_it", "i2", "u1"),))
    data = np.array([1, 2], "<f4").tobytes() + b"\2\7\0\10\0"
    found = read_binary(data, PlyHeader("<", (vertex, nothing, face), (), 0, 1), "a.ply")
    assert values(found[0]["vertex"].columns["x"]) == [1, 2]
    assert found[0]["nothing"].columns == {}
    assert values(found[0]["face"].columns["of_it"]) == [[7, 8], [2]]
    assert found[0]["face"].place_of(0) == "a.ply, face 0"
    assert found[1] == ()


def test_a_count_that_the_file_has_no_room_for_is_refused_before_anything_is_made() -> None:
    element = Element("vertex", 10**17, (Property("x", "f4"), Property("of_it", "i4", "u1")))
    assert refusal(table, element, bytes(20)) == (
        "a.ply: 100,000,000,000,000,000 elements 'vertex' must have at least 500,000,000,000,000,000 bytes,"
        f" not 20; {ENDING}"
    )


@pytest.mark.parametrize(
    ("code", "data"),
    [("u1", b"\1\0\xff\0"), ("i4", b"\1\0\0\0\0\xff\xff\xff\x7f"), ("u8", b"\0" * 8 + b"\xff" * 8)],
)
def test_lists_that_the_file_has_no_room_for_are_refused(code: str, data: bytes) -> None:
    element = Element("vertex", 2, (Property("of_it", "u1", code),))
    assert refusal(table, element, data) == (
        f"a.ply: 2 elements 'vertex' must have all their lists before the end, not after it; {ENDING}"
    )


@pytest.mark.parametrize(("code", "count"), [("i1", b"\xff"), ("i4", b"\xfe\xff\xff\xff")])
@pytest.mark.parametrize("first", [True, False])
def test_a_negative_count_is_refused(code: str, count: bytes, first: bool) -> None:
    data = count + bytes(20) if first else bytes(len(count)) + count + bytes(20)
    assert refusal(table, Element("face", 2, (Property("of_it", "u1", code),)), data) == (
        f"a.ply, face {0 if first else 1}: the count of a list must be 0 or more, not less; export it again"
    )


def test_a_row_longer_than_a_type_of_numpy_is_walked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ply_elements, "LONGEST_ROW", 2)
    element = Element("face", 2, (Property("of_it", "u1", "u1"),))
    assert values(table(element, b"\2\1\2\2\3\4")[0]["face"].columns["of_it"]) == [[1, 2, 3, 4], [2, 2]]


def test_lists_of_an_element_that_is_not_used_are_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ply_elements, "ROWS_AT_ONCE", 2)
    other = Element("other", 5, (Property("of_it", "u1", "u1"),))
    vertex = Element("vertex", 1, (Property("x", "u1"),))
    data = b"\1\0\2\0\0\0\0\1\0\7"
    found = read_binary(data, PlyHeader("<", (other, vertex), (), 0, 1), "a.ply")
    assert found[0]["other"].columns == {}
    assert values(found[0]["vertex"].columns["x"]) == [7]
    assert found[1] == ()


def test_faces_without_corners_on_the_average_are_refused() -> None:
    face = Element("face", 5, (Property("vertex_indices", "u1", "u1"),))
    assert len(values(table(face, b"\0\0\0\0\5\0\1\2\3\4")[0]["face"].columns["vertex_indices"])[1]) == 5
    sentence = refusal(table, face, b"\0\0\0\0\4\0\1\2\3")
    assert sentence == f"a.ply: 5 elements 'face' must have at least 10 bytes, not 9; {ENDING}"


HEAD = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty list uchar int of_it\n"
BOTH = HEAD + "element face 1\nproperty list uchar int vertex_indices\nproperty int quality\nend_header\n"
HEAD += "end_header\n"


def tables(text: str | bytes) -> tuple[dict[str, ElementRows], tuple[str, ...]]:
    data = text if isinstance(text, bytes) else text.encode()
    return read_text(data, parsed_header(data, "a.ply"), "a.ply")


@pytest.mark.parametrize("feed", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("block", [1, 1 << 21])
def test_a_line_is_a_row(feed: str, block: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(number_text, "BLOCK", block)
    found = tables((BOTH + "1.5 2 7 8\n\n \t-2e3 0\n3 0 1 2 9").replace("\n", feed))
    vertices, faces = found[0]["vertex"], found[0]["face"]
    assert values(vertices.columns["x"]) == [1.5, -2000]
    assert values(vertices.columns["of_it"]) == [[7, 8], [2, 0]]
    assert values(faces.columns["vertex_indices"]) == [[0, 1, 2], [3]]
    assert values(faces.columns["quality"]) == [9]
    # The header has ten lines, and one after the first row is empty.
    assert [vertices.place_of(row) for row in (0, 1)] == ["a.ply, line 10", "a.ply, line 12"]
    assert faces.place_of(0) == "a.ply, line 13"
    assert found[1] == ()


def test_a_value_may_be_missing_or_infinite_and_a_whole_number_of_any_size() -> None:
    found = values(
        tables(HEAD.replace("vertex 2", "vertex 3") + "nan 0\n-inf 0\n12345678901234567890123 0\n")[0][
            "vertex"
        ].columns["x"]
    )
    assert str(found) == "[nan, -inf, 1.2345678901234568e+22]"


WIDTH = "a line of an element 'vertex' must have the values of x, of_it, and this has too {}; correct it"


@pytest.mark.parametrize("block", [1, 1 << 21])
@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        *(
            (
                f"1 0\n\n{word} 0\n",
                f"line 9: a value must be a decimal number, nan or inf, not {word!r}; correct it",
            )
            for word in ("0x1", "1_0", "1,5", "1-2")
        ),
        *(
            (
                f"1 {word} 5\n2 0\n",
                f"line 7: the count of a list must be a whole number from 0 on, not {word!r}; correct it",
            )
            for word in ("-1", "0.5", "nan")
        ),
        ("1 0\n2 2 0\n", f"line 8: {WIDTH.format('few')}"),
        ("1\n2 0 0 0 0\n", f"line 7: {WIDTH.format('few')}"),
        ("1 0 5\n2 0\n", f"line 7: {WIDTH.format('many')}"),
    ],
)
def test_a_wrong_line_is_refused(
    rows: str, sentence: str, block: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(number_text, "BLOCK", block)
    assert refusal(tables, HEAD + rows) == f"a.ply, {sentence}"


@pytest.mark.parametrize(("count", "shown"), [("2", "2"), ("999999999999", "999,999,999,999")])
def test_a_count_that_the_file_has_no_lines_for_is_refused(count: str, shown: str) -> None:
    assert refusal(tables, HEAD.replace("vertex 2", f"vertex {count}") + "1 0\n") == (
        f"a.ply: there must be {shown} elements 'vertex', not 1; {ENDING}"
    )


def test_an_element_must_have_properties() -> None:
    assert refusal(tables, "ply\nformat ascii 1.0\nelement vertex 1\nend_header\n1\n") == (
        "a.ply: an element must have a property, not none: 'vertex'; export it again"
    )


def test_zeros_and_endless_lines_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    assert refusal(tables, HEAD + "1 0\n\0 0\n") == (
        "a.ply: an ascii PLY file must be text, not hold a NUL byte (line 8); save it as UTF-8 text"
    )
    monkeypatch.setattr(ply_elements, "LONGEST_TEXT_LINE", 20)
    assert refusal(tables, HEAD + "1 0\n2 0" + " " * 30 + "\n") == (
        "a.ply: a line must have at most 20 bytes, not more; split it"
    )


@given(
    rows=st.lists(st.tuples(st.floats(width=32), st.lists(st.integers(-9, 9), max_size=5)), max_size=20),
    block=st.sampled_from([1, 30, 1 << 21]),
)
def test_what_is_written_in_text_is_read(rows: list[tuple[float, list[int]]], block: int) -> None:
    lines = "".join(f"{x!r} {len(of_it)} {' '.join(map(str, of_it))}\n" for x, of_it in rows)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(number_text, "BLOCK", block)
        found = tables(HEAD.replace("vertex 2", f"vertex {len(rows)}") + lines)[0]["vertex"].columns
    np.testing.assert_array_equal(values(found["x"]), [x for x, _ in rows])
    assert values(found["of_it"]) == [
        [number for _, of_it in rows for number in of_it],
        [len(of_it) for _, of_it in rows],
    ]


def test_faces_in_text_without_corners_on_the_average_are_refused() -> None:
    header = "ply\nformat ascii 1.0\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    column = tables(header + "0\n0\n0\n4 0 1 2 3\n")[0]["face"].columns["vertex_indices"]
    assert values(column)[1] == [0, 0, 0, 4]
    assert refusal(tables, header + "0\n0\n0\n2 0 1") == (
        f"a.ply: 4 elements 'face' must have at least as many corners, not 2; {ENDING}"
    )
