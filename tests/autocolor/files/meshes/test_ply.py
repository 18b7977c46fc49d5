from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes import number_text, ply, ply_elements
from autocolor.files.meshes.ply import ply_bytes, read_ply
from autocolor.files.meshes.ply_elements import CUT_SHORT as CUT
from autocolor.files.meshes.repair import FILE, MeshReport, Placement
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MeshScalar
from tests.autocolor.files.meshes.written import COORDINATES, assert_equal, writable_meshes
from tests.autocolor.files.refusals import refusal, refused
from tests.small import cube

CODES = {
    "char": "b", "uint8": "B", "short": "h", "uint16": "H", "int": "i", "uint32": "I", "int64": "q",
    "uint64": "Q", "float": "f", "float64": "d", "int8": "b", "uchar": "B", "int16": "h", "ushort": "H",
    "int32": "i", "uint": "I", "float32": "f", "double": "d",
}  # fmt: skip
WHOLES = [name for name, code in CODES.items() if code not in "fd"]
FORMATS = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}

Columns = Mapping[str, Sequence[Any]]
"""The values of properties by their declarations, as "list uchar int vertex_indices"."""

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
CORNERS = "list uchar int vertex_indices"


def header(*lines: str, order: str = "<", feed: str = "\n") -> bytes:
    lines = ("ply", f"format {FORMATS[order]} 1.0", *lines, "end_header")
    return "".join(line + feed for line in lines).encode()


def ply_file(
    elements: Mapping[str, Columns], *comments: str, order: str = "<", feed: str = "\n", breaks: str = "\n"
) -> bytes:
    """A file of elements in text ("") or in binary; lines of text may be parted by several line breaks."""
    lines = [f"comment {comment}" for comment in comments]
    data = b""
    for name, columns in elements.items():
        rows = list(zip(*columns.values(), strict=True))
        lines += [f"element {name} {len(rows)}", *(f"property {each}" for each in columns)]
        for row in rows:
            words = []
            for declared, value in zip(columns, row, strict=True):
                *_, count, kind, _ = ("", *declared.split())
                if isinstance(value, (list, tuple)):
                    words += [(count, len(value)), *((kind, each) for each in value)]
                else:
                    words.append((kind, value))
            if order:
                data += b"".join(struct.pack(order + CODES[kind], value) for kind, value in words)
            else:
                data += " ".join(str(value) for _, value in words).encode() + breaks.encode()
    return header(*lines, order=order, feed=feed) + (data if order else data.replace(b"\n", feed.encode()))


def xyz(nodes: Sequence[Sequence[float]] = SQUARE, kind: str = "double") -> Columns:
    return {f"{kind} {axis}": [node[at] for node in nodes] for at, axis in enumerate("xyz")}


def plate(
    *comments: str,
    corners: Sequence[Sequence[float]] = ((0, 1, 2, 3),),
    vertex: Any = (),
    face: Any = (),
    **form: Any,
) -> bytes:
    """A square with polygons, and further columns of its nodes and of the polygons."""
    elements = {"vertex": {**xyz(), **dict(vertex)}, "face": {CORNERS: corners, **dict(face)}}
    return ply_file(elements, *comments, **form)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "a.ply"


def read(path: Path, data: bytes) -> MeshReport:
    path.write_bytes(data)
    return read_ply(path)


def scalars(mesh: Mesh) -> list[tuple[str, str, str]]:
    return [(each.name, each.of, str(each.values.tolist())) for each in mesh.scalars]


Kinds = list[tuple[str, bool, str]]


@st.composite
def columns(draw: st.DrawFn, count: int, prefix: str) -> Columns:
    """Properties of any types, with a value or a list in each row."""
    kinds = draw(
        st.lists(st.tuples(st.sampled_from([*CODES]), st.booleans(), st.sampled_from(WHOLES)), max_size=3)
    )
    found: dict[str, Sequence[Any]] = {}
    for at, (kind, is_list, counts) in enumerate(kinds):
        name = f"list {counts} {kind} {prefix}{at}" if is_list else f"{kind} {prefix}{at}"
        value = st.lists(st.integers(0, 100), max_size=3) if is_list else st.integers(0, 100)
        same = draw(st.booleans())
        found[name] = [draw(value)] * count if same else [draw(value) for _ in range(count)]
    return found


@given(
    before=columns(4, "a"),
    after=columns(4, "b"),
    other=columns(3, "o"),
    faces=columns(4, "f"),
    corners=st.lists(st.sampled_from([(0, 1, 2), (3, 1, 0), (3, 2, 1, 0)]), min_size=3, max_size=3),
    order=st.sampled_from([*FORMATS]),
    at_once=st.sampled_from([1, 2, 1 << 16]),
    share=st.floats(0, 1, exclude_max=True),
    kind=st.sampled_from([*CODES]),
)
def test_elements_with_any_properties_are_read_and_refused_if_they_are_cut(
    before: Columns, after: Columns, other: Columns, faces: Columns, corners: list[tuple[int, ...]],
    order: str, at_once: int, share: float, kind: str, tmp_path_factory: pytest.TempPathFactory,
) -> None:  # fmt: skip
    path = tmp_path_factory.getbasetemp() / "any.ply"
    table = {**faces, CORNERS: [(0, 1, 2, 3), *corners]}
    elements = {
        "vertex": {**before, **xyz(kind=kind), **after},
        **({"other": other} if other else {}),
        "face": table,
    }
    data = ply_file(elements, order=order)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(ply_elements, "ROWS_AT_ONCE", at_once)
        patched.setattr(number_text, "BLOCK", at_once)
        report = read(path, data + (b"end" if order else b"1\n"))
        # In text, the last number may lose a digit.
        with pytest.raises(InputError):
            read(path, data[: int(share * (len(data) - (0 if order else 5)))])
    mesh = report.mesh
    assert mesh.coordinates.tolist() == [list(node) for node in SQUARE]
    assert mesh.node_numbers.tolist() == [[0, 1, 2, 3], *([*each, each[-1]][:4] for each in corners)]
    assert [(each.name, each.values.tolist()) for each in mesh.scalars] == [
        (declared.split()[-1], values)
        for declared, values in {**before, **after, **faces}.items()
        if not declared.startswith("list")
    ]
    assert report.repairs == (
        *(("any.ply: skipped elements 'other': 3",) if other else ()),
        f"any.ply: skipped {'bytes' if order else 'lines'} after the last element: {3 if order else 1}",
    )


@pytest.mark.parametrize("order", FORMATS)
@pytest.mark.parametrize("feed", ["\n", "\r\n", "\r"])
def test_lines_end_in_any_way(path: Path, order: str, feed: str) -> None:
    # The numbers of a binary file may begin like the end of a line.
    elements: dict[str, Columns] = {
        "vertex": {"uchar heat": [10, 13, 10, 13], **xyz()},
        "face": {CORNERS: [(0, 1, 2, 3)]},
    }
    report = read(path, ply_file(elements, order=order, feed=feed, breaks="\n \t\n"))
    assert scalars(report.mesh) == [("heat", "node", "[10.0, 13.0, 10.0, 13.0]")]
    assert report.mesh.coordinates.tolist() == [list(node) for node in SQUARE]
    assert report.repairs == ()


LINE = "a line of the header must be a format, a comment, an element with its count, one of its properties or"
FACE = "element face 1"

test_a_wrong_header_is_refused = refused(
    "a.ply",
    [
        *(
            (data, f"a.ply: {sentence}; export it again")
            for data, sentence in (
                *(
                    (data, f"a PLY file must begin with a line 'ply', not {data.decode().strip()!r}")
                    for data in (b"", b"solid a\n", b"plyx\n")
                ),
                (b"ply\nend_header\n", "a header must have a line 'format', not none"),
                (header(FACE)[:-11], "a header must have a line 'end_header' before the file ends"),
                (header(FACE, order=""), "an element must have a property, not none: 'face'"),
            )
        ),
        *(
            (
                header(*lines),
                f"a.ply, line {2 + len(lines)}: {LINE} end_header, not {lines[-1]!r}; export it again",
            )
            for lines in (
                *(
                    [line]
                    for line in (
                        "format binary 1.0",
                        "format ascii 2.0",
                        "elements vertex 8",
                        "property int x",
                    )
                ),
                *([f"element {words}"] for words in ("a -1", "a", "a 1 2", f"a {10**18}")),
                *([FACE, f"property {words}"] for words in ("float", "list int x", "list int int x y")),
            )
        ),
        *(
            (header(FACE, *lines), f"a.ply, line {sentence}")
            for *lines, sentence in (
                (
                    "property flaot x",
                    "4: a type must be one of PLY, not 'flaot'; did you mean 'float'?; export it again",
                ),
                (
                    "property list float int x",
                    "4: the count of a list must have a whole type, not 'float'; export it again",
                ),
                (FACE, "4: the name of an element must be unique, not repeated: 'face'; rename one"),
                (
                    *("property float x", "property int x"),
                    "5: the name of a property must be unique, not repeated: 'x'; rename one",
                ),
                (
                    *(f"property int p{at}" for at in range(500)),
                    *(f"element a{at} 0" for at in range(500)),
                    "1003: a header must have at most 1,000 elements and properties, not more; leave out what"
                    " is not needed",
                ),
            )
        ),
    ],
)


def test_a_header_may_be_long_but_not_endless(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The rows of an element without properties take no bytes.
    others = "".join(f"element e{number} {1 - number % 2}\n" for number in range(98))
    others += "".join(f"property int p{number}\n" for number in range(896))
    data = plate("x" * 100_000).replace(b"end_header", f"{others}end_header".encode())
    report = read(path, data)
    assert len(report.mesh.node_numbers) == 1
    assert report.repairs == tuple(f"a.ply: skipped elements 'e{at}': 1" for at in range(96, -1, -2))
    # Without its line feed, a header ends where the file ends.
    assert "must have the properties x, y and z, not none" in refusal(read, path, header()[:-1])
    monkeypatch.setattr(ply_elements, "LARGEST_HEADER", 100)
    for comments in (["comment a"] * 100, ["comment a" + "a" * 1000]):
        assert refusal(read, path, header(*comments)) == (
            "a.ply: a header must have a line 'end_header' within 100 bytes; export it again"
        )


FACES = [(0, 1, 2), (0, 2, 3), (0, 1, 2, 3)]
PARTS = {name: {f"char {name}": [7, -1, 7]} for name in ("part", "material_index", "group")}


@pytest.mark.parametrize(
    ("comments", "face", "names", "numbers"),
    [
        *(((), face, (f"{name} -1", f"{name} 7"), [1, 0, 1]) for name, face in PARTS.items()),
        (("part 0 hood",), {}, ("hood",), [0, 0, 0]),
        (("part 0 hood", "part 12 left door", "part x", "part 0 b"), {}, ("hood", "left door"), [0, 0, 0]),
        (
            ("part 0 hood", "part 2 roof", "part 3 roof"),
            {"int part": [2, 5, 2]},
            ("hood", "roof", "roof 2", "part 5"),
            [1, 3, 1],
        ),
        ((), {"int group": [3, 4, 3], "double part": [4, 4, 4]}, ("part 4",), [0, 0, 0]),
        (("part 3 hood",), {"int group": [3, 3, 3]}, ("group 3",), [0, 0, 0]),
        (("scalar part thickness",), PARTS["part"], ("a",), [0, 0, 0]),
    ],
)
def test_numbers_of_faces_and_comments_make_the_parts(
    path: Path, comments: tuple[str, ...], face: Columns, names: tuple[str, ...], numbers: list[int]
) -> None:
    mesh = read(path, plate(*comments, corners=FACES, face=face)).mesh
    assert (mesh.part_names, mesh.part_numbers.tolist()) == (names, numbers)
    assert len(mesh.scalars) == max(len(face) - 1, 0) + (names == ("a",))


def test_numbers_that_are_no_parts_are_scalars(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ply, "MOST_UNNAMED_PARTS", 2)
    for values in ([1, 2, 3], [0.5, 0.5, 1], [np.nan, 1, 1], [2.0**53] * 3):
        mesh = read(path, plate(corners=FACES, face={"double part": values})).mesh
        assert (mesh.part_names, len(mesh.scalars)) == (("a",), 1)
    largest = plate(corners=FACES, face={"double part": [2.0**53 - 1] * 3})
    assert read(path, largest).mesh.part_names == ("part 9007199254740991",)
    named = plate("part 1 a", "part 2 b", "part 3 c", corners=FACES, face={"int part": [1, 2, 3]})
    assert read(path, named).mesh.part_names == ("a", "b", "c")


def test_other_numbers_are_scalars_which_comments_may_name(path: Path) -> None:
    vertex = {
        "float nx": [1] * 4,
        "double stress": [1.5, np.inf, np.nan, 1e31],
        "list uchar int of": [(), (1,), (), ()],
    }
    face = {"uchar quality": [7], "double stress": [5], "double value_0": [1], "double red": [2]}
    comments = ("scalar value_0 von Mises", "scalar red red", "scalar a", "made by hand")
    report = read(path, plate(*comments, vertex=vertex, face={**face, "uchar green": [3]}))
    assert scalars(report.mesh) == [
        ("stress", "node", "[1.5, nan, nan, nan]"),
        ("quality", "polygon", "[7.0]"),
        ("stress of polygons", "polygon", "[5.0]"),
        ("von Mises", "polygon", "[1.0]"),
        ("red", "polygon", "[2.0]"),
    ]
    assert report.repairs == (
        "a.ply: left out the colors of polygons",
        "a.ply: scalar 'stress': 2 values above 1e30 in size were made missing",
    )


def test_normals_colors_and_texture_coordinates_are_scalars_only_if_a_comment_says_so(path: Path) -> None:
    names = ["nx", "red", "diffuse_green", "alpha", "s", "texture_u", "texnumber", "specular_power"]
    vertex = {f"float {name}": range(4) for name in names}
    report = read(path, plate(vertex=vertex))
    assert report.mesh.scalars == ()
    assert report.repairs == ("a.ply: left out the colors of nodes",)
    comments = [f"scalar {name} of {name}" for name in names]
    named = read(path, plate(*comments, vertex=vertex)).mesh.scalars
    assert [each.name for each in named] == [f"of {name}" for name in names]
    others = read(
        path, plate(vertex={f"{name}_of_it": values for name, values in vertex.items()})
    ).mesh.scalars
    assert [each.name for each in others] == [f"{name}_of_it" for name in names]


@pytest.mark.parametrize("names", [("nx", "ny", "nz"), ("normal_x", "normal_y", "normal_z")])
@pytest.mark.parametrize("order", FORMATS)
def test_the_normals_of_vertices_are_used(path: Path, names: tuple[str, ...], order: str) -> None:
    columns = {
        f"float {name}": row
        for name, row in zip(names, ([0, 2, 0, 0], [0, 0, 3, 0], [4, 0, 0, 0]), strict=True)
    }
    path.write_bytes(plate(vertex=columns, order=order))
    report = read_ply(path, Placement(normals=FILE))
    own = report.mesh.own_normals
    assert own is not None
    assert own.vectors[own.numbers[0, :3]].tolist() == [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    assert own.numbers[0, 3] == -1
    assert report.repairs == ("a.ply: 1 corner has no normal of its own; it was computed",)
    assert read_ply(path).mesh.own_normals is None
    path.write_bytes(plate(f"scalar {names[0]} slope", vertex=columns, order=order))
    assert read_ply(path, Placement(normals=FILE)).mesh.own_normals is None


LACKS = "a.ply: an element {!r} must have {}, not {}; export it with {}"
AXES = "the properties x, y and z"
LIST = "a list 'vertex_indices'"
LARGE = "a coordinate must be a finite number of at most 1e30 in size"
CORNER = "a corner must be a node number"
NO_NODES = {"vertex": xyz([]), "face": {CORNERS: [(0, 1, 2)]}}
FAR = (-np.inf, np.nextafter(1e30, np.inf))

test_what_is_refused = refused(
    "a.ply",
    [
        (
            ply_file({"vertex": {"int x": [1], "int y": [2]}}),
            LACKS.format("vertex", AXES, "only x and y", "coordinates"),
        ),
        (ply_file({"face": {CORNERS: [(0, 1, 2)]}}), LACKS.format("vertex", AXES, "none", "coordinates")),
        (
            ply_file({"vertex": {"list uchar int x": [(1,)], "int y": [2], "int z": [3]}}),
            LACKS.format("vertex", AXES, "only x, y and z", "coordinates"),
        ),
        (
            ply_file({"vertex": xyz([(0, 0, 0), (1, np.nan, 1)])}),
            f"a.ply, vertex 1: {LARGE}, not nan; correct it",
        ),
        *(
            (
                ply_file({"vertex": xyz([(0, value, 0)])}),
                f"a.ply, vertex 0: {LARGE}, not {value:g}; correct it",
            )
            for value in FAR
        ),
        *(
            (
                ply_file({"vertex": xyz(), "face": {declared: [1]}}),
                LACKS.format("face", LIST, f"only {declared.split()[1]}", "polygons"),
            )
            for declared in ("int quality", "int vertex_indices")
        ),
        (
            plate(corners=[(0, 1, 2), (0, 4, -1, 3), (2, 1, -3)]),
            f"a.ply, face 1: {CORNER} from 0 to 3, not 4; correct it",
        ),
        *(
            (
                ply_file({"vertex": xyz(), "face": {f"list uchar {kind} vertex_indices": [corners]}}),
                f"a.ply, face 0: {CORNER} from 0 to 3, not {told}; correct it",
            )
            for kind, corners, told in (
                ("uint64", (0, 1, 2**64 - 1), "1.84467440737096e+19"),
                ("float", (0, 1.5, np.nan), "1.5"),
            )
        ),
        (
            ply_file(NO_NODES),
            f"a.ply, face 0: {CORNER} of the file, which has no nodes, not 0; correct it",
        ),
        (
            ply_file(
                {"vertex": xyz(), "face": {"list short int vertex_index": [[0, 1] * 500, [0, 1, 2] * 400]}}
            ),
            "a.ply, face 1: a polygon must have at most 1,000 corners, not 1,200; split it",
        ),
        (
            ply_file({"vertex": xyz(), "tristrips": {CORNERS: [(0, 1, 2, -2)]}}),
            f"a.ply, tristrips 0: {CORNER} from -1 to 3, not -2; correct it",
        ),
        *(
            (
                plate(order="", breaks="\n\n", corners=[(0, 1, 9)], vertex={"double z2": [0, 0, value, 0]}),
                f"a.ply, line {sentence}",
            )
            for value, sentence in (
                (0, f"19: {CORNER} from 0 to 3, not 9; correct it"),
                *(
                    (word, f"15: a value must be a decimal number, nan or inf, not {word!r}; correct it")
                    for word in ("0x1", "1_0", "1,5", "1-2", "--1")
                ),
            )
        ),
    ],
)


def sized(count: int | str, *properties: str, data: bytes, name: str = "vertex", order: str = "<") -> bytes:
    """An element of a count of rows, whatever data follow."""
    return header(f"element {name} {count}", *(f"property {each}" for each in properties), order=order) + data


WIDTH = "a line of an element 'vertex' must have the values of x and of_it, and this has too {}; correct it"
WIDE = ("float x", "list uchar int of_it")

test_what_does_not_fit_its_counts_is_refused = refused(
    "a.ply",
    [
        (
            sized(10**17, *WIDE, data=bytes(20)),
            "a.ply: 100,000,000,000,000,000 elements 'vertex' must have at least 500,000,000,000,000,000"
            f" bytes, not 20; {CUT}",
        ),
        *(
            (
                sized(2, f"list {kind} uchar of_it", data=data),
                f"a.ply: 2 elements 'vertex' must have all their lists before the end, not after it; {CUT}",
            )
            for kind, data in (
                ("uchar", b"\1\0\xff\0"),
                ("int", b"\1\0\0\0\0\xff\xff\xff\x7f"),
                ("uint64", b"\0" * 8 + b"\xff" * 8),
            )
        ),
        *(
            (
                sized(2, f"list {kind} uchar of_it", name="face", data=bytes(before) + count + bytes(20)),
                f"a.ply, face {row}: the count of a list must be 0 or more, not less; export it again",
            )
            for kind, count in (("char", b"\xff"), ("int", b"\xfe\xff\xff\xff"))
            for row, before in ((0, 0), (1, len(count)))
        ),
        (
            sized(
                3, "list char uchar a", "list char uchar of_it", name="face", data=b"\0\0\0\xff" + bytes(9)
            ),
            "a.ply, face 1: the count of a list must be 0 or more, not less; export it again",
        ),
        *(
            (
                sized(count, *WIDE, order="", data=b"1 0\n"),
                f"a.ply: there must be {count:,} elements 'vertex', not 1; {CUT}",
            )
            for count in (2, 999_999_999_999)
        ),
        *(
            (sized(2, *WIDE, order="", data=data.encode()), f"a.ply, {sentence}")
            for data, sentence in (
                *(
                    (
                        f"1 {word} 5\n2 0\n",
                        f"line 7: the count of a list must be a whole number from 0 on, not"
                        f" {word!r}; correct it",
                    )
                    for word in ("-1", "0.5", "nan")
                ),
                ("1 0\n2 2 0\n", f"line 8: {WIDTH.format('few')}"),
                ("1\n2 0 0 0 0\n", f"line 7: {WIDTH.format('few')}"),
                ("1 0 5\n2 0\n", f"line 7: {WIDTH.format('many')}"),
            )
        ),
    ],
)


def test_faces_may_be_empty_and_rows_long(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for order in FORMATS:
        mesh = read(path, plate(corners=[(), (), (), (), (), (0, 1, 2, 3)], order=order)).mesh
        assert mesh.node_numbers.tolist() == [[0, 1, 2, 3]]
    monkeypatch.setattr(ply_elements, "LONGEST_ROW", 2)
    assert read(path, plate(corners=FACES)).mesh.node_numbers[0].tolist() == [0, 1, 2, 2]


@given(
    strips=st.lists(st.lists(st.integers(-1, 5), max_size=12), max_size=4), order=st.sampled_from([*FORMATS])
)
def test_triangles_are_those_of_one_strip_after_the_other(
    strips: list[list[int]], order: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    # No three of these nodes lie on a line.
    nodes = [(at, at * at, at**3) for at in range(6)]
    expected = [[nodes[0], nodes[1], nodes[2]]]
    for each in strips:
        strip: list[int] = []
        for number in [*each, -1]:
            if number >= 0:
                strip.append(number)
                continue
            for at in range(len(strip) - 2):
                a, b, c = strip[at : at + 3]
                if len({a, b, c}) == 3:
                    expected.append([nodes[row] for row in ((b, a, c) if at % 2 else (a, b, c))])
            strip = []
    elements = {"vertex": xyz(nodes), "tristrips": {CORNERS: [(0, 1, 2), *strips]}}
    path = tmp_path_factory.getbasetemp() / "strips.ply"
    mesh = read(path, ply_file(elements, order=order)).mesh
    found = mesh.coordinates[mesh.node_numbers[:, :3]]
    assert [[tuple(node) for node in triangle] for triangle in found.tolist()] == expected


def test_strips_are_left_out_where_there_are_faces(path: Path) -> None:
    elements = {"vertex": xyz(), "tristrips": {CORNERS: [(0, 1, 3)]}, "face": {CORNERS: [(0, 1, 2, 3)]}}
    report = read(path, ply_file(elements))
    assert report.mesh.node_numbers.tolist() == [[0, 1, 2, 3]]
    assert report.repairs == ("a.ply: skipped elements 'tristrips': 1",)


def test_a_scalar_is_written_under_its_name_where_that_is_free() -> None:
    names = ["stress", "von Mises", "x", "red", "part", "value_0", "größe", "vertex_index", "a.b-c_1"]
    mesh = cube().with_scalars(*(MeshScalar(name, np.arange(8.0)) for name in names))
    head = ply_bytes(mesh).partition(b"end_header")[0].decode()
    written = [line.split()[-1] for line in head.splitlines() if line.startswith("property double")]
    assert written[3:] == ["stress", *(f"value_{number}" for number in range(1, 8)), "a.b-c_1"]


@given(mesh=writable_meshes(), at_once=st.sampled_from([1, 3, 1 << 16]))
def test_what_is_written_reads_back_equal(
    mesh: Mesh, at_once: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(ply, "ROWS_AT_ONCE", at_once)
        data = ply_bytes(mesh)
    assert_equal(read(tmp_path_factory.getbasetemp() / "written.ply", data), mesh)


def test_a_mesh_of_one_part_is_written_as_other_programs_do() -> None:
    mesh = Mesh(COORDINATES[:3], np.array([[0, 1, 2]]), part_names=("hood\n",))
    head, _, data = ply_bytes(mesh).partition(b"end_header\n")
    assert head.decode().splitlines() == [
        "ply",
        "format binary_little_endian 1.0",
        "comment written by autocolor",
        "comment part 0 hood?",
        "element vertex 3",
        "property double x",
        "property double y",
        "property double z",
        "element face 1",
        "property list uchar int vertex_indices",
    ]
    assert data == COORDINATES[:3].astype("<f8").tobytes() + b"\3" + np.array([0, 1, 2], "<i4").tobytes()
