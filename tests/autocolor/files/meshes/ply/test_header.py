from __future__ import annotations

import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.ply import header as header_module
from autocolor.files.meshes.ply.header import TYPES, Element, Property, parsed_header

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


def refusal(data: bytes) -> str:
    with pytest.raises(InputError) as caught:
        parsed_header(data, "a.ply")
    return str(caught.value)


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


@pytest.mark.parametrize(
    ("name", "order"), [("ascii", ""), ("binary_little_endian", "<"), ("binary_big_endian", ">")]
)
def test_a_format_is_a_byte_order(name: str, order: str) -> None:
    assert parsed_header(text("ply", f"format {name} 1.0", "end_header"), "a.ply").order == order


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("char", "int8"), ("uchar", "uint8"), ("short", "int16"), ("ushort", "uint16"),
        ("int", "int32"), ("uint", "uint32"), ("float", "float32"), ("double", "float64"),
    ],
)  # fmt: skip
def test_types_have_old_and_new_names(old: str, new: str) -> None:
    assert TYPES[old] == TYPES[new]


def test_a_header_without_a_line_at_its_end_is_read_where_there_are_no_data() -> None:
    data = text(*LINES)[:-1]
    assert parsed_header(data, "a.ply").length == len(data)


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "a.ply: a PLY file must begin with a line 'ply', not ''; export it again"),
        (b"solid a\n", "a.ply: a PLY file must begin with a line 'ply', not 'solid a'; export it again"),
        (b"plyx\n", "a.ply: a PLY file must begin with a line 'ply', not 'plyx'; export it again"),
        ("ply\n".encode("utf-16"), "a.ply: a PLY file must be text in UTF-8, not UTF-16; save it as UTF-8"),
        (
            text("ply", "end_header"),
            "a.ply: a header must have a line 'format', not none; export it again",
        ),
        (
            text(*LINES[:-1]),
            "a.ply: a header must have a line 'end_header' before the file ends; export it again",
        ),
        (
            text("ply", "format binary 1.0"),
            "a.ply, line 2: a format must be 'ascii', 'binary_little_endian' or 'binary_big_endian' and 1.0,"
            " not 'binary 1.0'; export it again",
        ),
        (
            text("ply", "format ascii 2.0"),
            "a.ply, line 2: a format must be 'ascii', 'binary_little_endian' or 'binary_big_endian' and 1.0,"
            " not 'ascii 2.0'; export it again",
        ),
        (
            text("ply", "elements vertex 8"),
            "a.ply, line 2: a line of the header must be a format, a comment, an element, one of its"
            " properties or end_header, not 'elements vertex 8'; export it again",
        ),
        (
            text("ply", "property float x"),
            "a.ply, line 2: a line of the header must be a format, a comment, an element, one of its"
            " properties or end_header, not 'property float x'; export it again",
        ),
        (
            text("ply", "element vertex -1"),
            "a.ply, line 2: an element must have a name and a count of at most 18 digits, not 'vertex -1';"
            " export it again",
        ),
        (
            text("ply", "element vertex 1", "element vertex 2"),
            "a.ply, line 3: the name of an element must be unique, not repeated: 'vertex'; rename one",
        ),
        (
            text("ply", "element vertex 1", "property float"),
            "a.ply, line 3: a property must be a type and a name, or list, two types and a name, not"
            " 'float'; export it again",
        ),
        (
            text("ply", "element vertex 1", "property list int x"),
            "a.ply, line 3: a property must be a type and a name, or list, two types and a name, not"
            " 'list int x'; export it again",
        ),
        (
            text("ply", "element vertex 1", "property flaot x"),
            "a.ply, line 3: a type must be one of PLY, not 'flaot'; did you mean 'float'?; export it again",
        ),
        (
            text("ply", "element face 1", "property list float int x"),
            "a.ply, line 3: the count of a list must have a whole type, not 'float'; export it again",
        ),
        (
            text("ply", "element vertex 1", "property float x", "property int x"),
            "a.ply, line 4: the name of a property must be unique, not repeated: 'x'; rename one",
        ),
        (
            text("ply", "comment " + "x" * 70_000),
            "a.ply: a line of the header must have at most 65,536 bytes, not more; export it again",
        ),
        (
            text("ply", *(f"element e{number} 1" for number in range(101))),
            "a.ply, line 102: a header must have at most 100 elements, not more; leave out what is not"
            " needed",
        ),
        (
            text("ply", "element e 1", *(f"property int p{number}" for number in range(1001))),
            "a.ply, line 1003: a header must have at most 1,000 properties, not more; leave out what is not"
            " needed",
        ),
    ],
)  # fmt: skip
def test_a_wrong_header_is_refused(data: bytes, sentence: str) -> None:
    assert refusal(data) == sentence


def test_a_header_without_an_end_is_not_searched_to_the_end_of_the_file(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(header_module, "LARGEST_HEADER", 100)
    assert refusal(text("ply", *["comment a"] * 100)) == (
        "a.ply: a header must have a line 'end_header' within 100 bytes; export it again"
    )
