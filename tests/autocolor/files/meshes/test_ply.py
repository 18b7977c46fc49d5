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
from autocolor.files.meshes import number_text, ply
from autocolor.files.meshes.ply import ply_bytes, read_ply
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
        **({"tristrips": other} if other else {}),
        "face": table,
    }
    data = ply_file(elements, order=order)
    with pytest.MonkeyPatch.context() as patched:
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
        *(("any.ply: skipped elements 'tristrips': 3",) if other else ()),
        f"any.ply: skipped {'bytes' if order else 'lines'} after the last element: {3 if order else 1}",
    )


def test_faces_may_be_empty_and_numbers_begin_like_the_end_of_a_line(path: Path) -> None:
    elements: dict[str, Columns] = {
        "vertex": {"uchar heat": [10, 13, 10, 13], **xyz()},
        "face": {CORNERS: [(), (), (0, 1, 2, 3)]},
    }
    for order in FORMATS:
        for feed in ("\n", "\r\n", "\r"):
            mesh = read(path, ply_file(elements, order=order, feed=feed, breaks="\n \t\n")).mesh
            assert mesh.scalars[0].values.tolist() == [10, 13, 10, 13]
            assert mesh.node_numbers.tolist() == [[0, 1, 2, 3]]


LINE = "a line of the header must be a format, comment, element or property of PLY, named once"
FACE = "element face 1"

test_a_wrong_header_is_refused = refused(
    "a.ply",
    [
        (b"plyx\n", "a.ply: a PLY file must begin with a line 'ply', not 'plyx'; export it again"),
        (b"ply\nend_header\n", "a.ply: a header must have a line 'format', not none; export it again"),
        (
            header(FACE)[:-11],
            "a.ply: a header must have a line 'end_header', not none; export it again",
        ),
        *(
            (
                header(*lines),
                f"a.ply, line {2 + len(lines)}: {LINE}, not {lines[-1]!r}; export it again",
            )
            for lines in (
                ["format binary 1.0"],
                ["format ascii 2.0"],
                ["elements vertex 8"],
                ["property int x"],
                *([f"element {words}"] for words in ("a -1", "a 1 2", f"a {10**18}")),
                *([FACE, f"property {words}"] for words in ("list int x", "flaot x", "list float int x")),
                [FACE, FACE],
                [FACE, "property float x", "property int x"],
            )
        ),
    ],
)


def test_an_element_may_have_no_properties_and_a_header_no_last_line_feed(path: Path) -> None:
    report = read(path, plate().replace(b"end_header", b"element none 0\nend_header"))
    assert report.repairs == ()
    assert "must have the numbers x, y and z, not only none" in refusal(read, path, header()[:-1])


FACES = [(0, 1, 2), (0, 2, 3), (0, 1, 2, 3)]
PARTS = {name: {f"char {name}": [7, -1, 7]} for name in ("part", "material_index", "group")}


@pytest.mark.parametrize(
    ("comments", "face", "names", "numbers"),
    [
        *(((), face, (f"{name} -1", f"{name} 7"), [1, 0, 1]) for name, face in PARTS.items()),
        (("part 0 hood", "part 12 left door", "part x", "part 0 b"), {}, ("hood", "left door"), [0, 0, 0]),
        (
            ("part 0 hood", "part 2 roof", "part 3 roof"),
            {"int part": [2, 5, 2]},
            ("hood", "roof", "roof 2", "part 5"),
            [1, 3, 1],
        ),
        (("part 3 hood",), {"int group": [3, 3, 3]}, ("group 3",), [0, 0, 0]),
        ((), {"int group": [3, 4, 3], "double part": [4, 4, 4]}, ("part 4",), [0, 0, 0]),
        (("scalar part thickness",), PARTS["part"], ("a",), [0, 0, 0]),
    ],
)
def test_numbers_of_faces_and_comments_make_the_parts(
    path: Path, comments: tuple[str, ...], face: Columns, names: tuple[str, ...], numbers: list[int]
) -> None:
    mesh = read(path, plate(*comments, corners=FACES, face=face)).mesh
    assert (mesh.part_names, mesh.part_numbers.tolist()) == (names, numbers)
    assert len(mesh.scalars) == max(len(face) - 1, 0) + (names == ("a",))


def test_numbers_that_are_no_parts_are_scalars(path: Path) -> None:
    for values in ([0.5, 0.5, 1], [np.nan, 1, 1], [2.0**53] * 3):
        mesh = read(path, plate(corners=FACES, face={"double part": values})).mesh
        assert (mesh.part_names, len(mesh.scalars)) == (("a",), 1)
    largest = plate(corners=FACES, face={"double part": [2.0**53 - 1] * 3})
    assert read(path, largest).mesh.part_names == ("part 9007199254740991",)
    many = range(ply.MOST_PARTS + 1)
    for comments, parts in (((), 1), ([f"part {number} p{number}" for number in many], len(many))):
        data = plate(*comments, corners=[(0, 1, 2)] * len(many), face={"int part": many})
        assert len(read(path, data).mesh.part_names) == parts


def test_other_numbers_are_scalars_which_comments_may_name(path: Path) -> None:
    vertex = {
        "float nx": [1] * 4,
        "double stress": [1.5, np.inf, np.nan, 1e31],
        "list uchar int of": [(), (1,), (), ()],
    }
    face = {"uchar quality": [7], "double stress": [5], "double value_0": [1], "double red": [2]}
    comments = ("scalar value_0 von Mises", "scalar red red", "scalar a", "made by hand")
    report = read(path, plate(*comments, vertex=vertex, face={**face, "uchar green": [3]}))
    assert [(each.name, each.of, str(each.values.tolist())) for each in report.mesh.scalars] == [
        ("stress", "node", "[1.5, nan, nan, nan]"),
        ("quality", "polygon", "[7.0]"),
        ("stress of polygons", "polygon", "[5.0]"),
        ("von Mises", "polygon", "[1.0]"),
        ("red", "polygon", "[2.0]"),
    ]
    assert report.repairs == (
        "a.ply: left out the colors of polygons",
        "a.ply: scalar 'stress': values above 1e30 in size were made missing: 2",
    )


def test_normals_colors_and_texture_coordinates_are_scalars_only_if_a_comment_says_so(path: Path) -> None:
    names = ["nx", "red", "diffuse_green", "alpha", "s", "texture_u", "texnumber", "specular_power"]
    vertex = {f"float {name}": range(4) for name in names}
    report = read(path, plate(vertex={**vertex, "float red_of_it": range(4)}))
    assert [each.name for each in report.mesh.scalars] == ["red_of_it"]
    assert report.repairs == ("a.ply: left out the colors of nodes",)
    named = read(path, plate(*(f"scalar {name} of {name}" for name in names), vertex=vertex)).mesh.scalars
    assert [each.name for each in named] == [f"of {name}" for name in names]


def test_the_normals_of_vertices_are_used(path: Path) -> None:
    columns = {"float nx": [0, 2, 0, 0], "float ny": [0, 0, 3, 0], "float nz": [4, 0, 0, 0]}
    path.write_bytes(plate(vertex=columns))
    own = read_ply(path, Placement(normals=FILE)).mesh.own_normals
    assert own is not None
    assert own.vectors[own.numbers[0, :3]].tolist() == [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    assert own.numbers[0, 3] == -1
    assert read_ply(path).mesh.own_normals is None
    path.write_bytes(plate("scalar nx slope", vertex=columns))
    assert read_ply(path, Placement(normals=FILE)).mesh.own_normals is None


AXES = ": an element 'vertex' must have the numbers x, y and z, not only"
LARGE = ", vertex 1: a coordinate must be a finite number of at most 1e30 in size, not"
CORNER = "a corner must be the number of one of 4 nodes, from 0 on, not"


def corners(kind: str, *faces: Sequence[float]) -> Columns:
    return {f"list short {kind} vertex_indices": faces}


WRONG: list[tuple[Mapping[str, Columns], str]] = [
    ({"vertex": {"int x": [1], "int y": [2]}}, f"{AXES} x and y; export it with coordinates"),
    (
        {"vertex": {"list uchar int x": [(1,)], "int y": [2], "int z": [3]}},
        f"{AXES} x, y and z; export it with coordinates",
    ),
    *(
        ({"vertex": xyz([(0, 0, 0), (0, value, 0)])}, f"{LARGE} {value:g}; correct it")
        for value in (np.nan, np.nextafter(1e30, np.inf))
    ),
    (
        {"vertex": xyz(), "face": {"int vertex_indices": [1]}},
        ": an element 'face' must have a list 'vertex_indices', not only vertex_indices; export it with"
        " polygons",
    ),
    *(
        (
            {"vertex": xyz(), "face": corners(kind, (0, 1, 2), wrong)},
            f", face 1: {CORNER} {told}; correct it",
        )
        for kind, wrong, told in (
            ("int", (0, 4, -1, 3), "4"),
            ("int", (0, -1, 2, 3), "-1"),
            ("uint64", (0, 1, 2**64 - 1), "1.84467440737096e+19"),
            ("float", (0, 1.5, np.nan), "1.5"),
        )
    ),
    (
        {"vertex": xyz(), "face": corners("int", [0, 1] * 500, [0, 1, 2] * 400)},
        ", polygon 2: a polygon must have at most 1,000 corners, not 1,200; split it",
    ),
    (
        {"vertex": xyz(), "tristrips": corners("int", (0, 1, 2))},
        ": elements 'tristrips' are not read; export it with faces",
    ),
]

test_what_is_refused = refused(
    "a.ply",
    [(ply_file(elements), f"a.ply{sentence}") for elements, sentence in WRONG]
    + [
        (
            plate(order="", breaks="\n\n", vertex={"double z2": [0, 0, "0x1", 0]}),
            "a.ply, line 15: a value must be a decimal number, nan or inf, not '0x1'; correct it",
        )
    ],
)


def sized(count: int, *properties: str, data: bytes, order: str = "<") -> bytes:
    """An element of a count of rows, whatever data follow."""
    return header(f"element face {count}", *(f"property {each}" for each in properties), order=order) + data


CUT = "export it again"
OUTSIDE = "elements 'face' must end within the file, with lists of 0 or more values"
WIDTH = (
    "an element 'face' must have the values of x and of_it, the count before each list, and no others;"
    " correct it"
)
WIDE = ("float x", "list uchar int of_it")


test_what_does_not_fit_its_counts_is_refused = refused(
    "a.ply",
    [
        *(
            (sized(count, *properties, data=data), f"a.ply: {count:,} {OUTSIDE}; {CUT}")
            for count, properties, data in (
                (10**17, WIDE, bytes(20)),
                (2, ("list uchar uchar a",), b"\1\0\xff\0"),
                (1, ("list uint64 uchar a",), b"\xff" * 8 + bytes(9)),
                (2, ("list char uchar a",), b"\xff" + bytes(20)),
                (2, ("list int uchar a",), b"\0\0\0\0\xfe\xff\xff\xff" + bytes(20)),
                (3, ("list char uchar a", "list char uchar b"), b"\0\0\0\xff" + bytes(9)),
            )
        ),
        (
            sized(999_999_999_999, *WIDE, order="", data=b"1 0\n"),
            f"a.ply: 999,999,999,999 {OUTSIDE}; {CUT}",
        ),
        *(
            (sized(2, *WIDE, order="", data=data), f"a.ply, line {line}: {WIDTH}")
            for line, data in (
                *((7, f"1 {word} 5\n2 0\n".encode()) for word in ("-1", "0.5", "nan", "2")),
                (8, b"1 0\n2 2 0\n"),
                (7, b"1\n2 0 0 0 0\n"),
            )
        ),
    ],
)


def test_a_scalar_is_written_under_its_name_where_that_is_free() -> None:
    scalars = (MeshScalar(name, np.arange(8.0)) for name in ("stress", "von Mises", "red", "part", "value_0"))
    head = ply_bytes(cube().with_scalars(*scalars)).partition(b"end_header")[0].decode()
    written = [line.split()[-1] for line in head.splitlines() if line.startswith("property double")]
    assert written[3:] == ["stress", *(f"value_{number}" for number in range(1, 5))]


@given(mesh=writable_meshes())
def test_what_is_written_reads_back_equal(mesh: Mesh, tmp_path_factory: pytest.TempPathFactory) -> None:
    data = ply_bytes(mesh)
    assert_equal(read(tmp_path_factory.getbasetemp() / "written.ply", data), mesh)


def test_a_mesh_of_one_part_is_written_as_other_programs_do() -> None:
    mesh = Mesh(COORDINATES[:3], np.array([[0, 1, 2]]), part_names=("hood\n",))
    lines = ["comment written by autocolor", "comment part 0 hood?", "element vertex 3"]
    lines += [f"property double {axis}" for axis in "xyz"]
    assert ply_bytes(mesh) == (
        header(*lines, "element face 1", f"property {CORNERS}")
        + COORDINATES[:3].astype("<f8").tobytes()
        + b"\3"
        + np.array([0, 1, 2], "<i4").tobytes()
    )
