from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Surface
from autocolor.files.meshes.mtl import MOST_LIBRARIES
from autocolor.files.meshes.obj import read_obj
from autocolor.files.meshes.repair import MeshReport
from autocolor.scene.defaults import COLORED_PAINT, created_surface

RED = b"newmtl red\nKd 1 0 0\n"
BLUE = b"newmtl blue\nKd 0 0 1\n"
DEFAULT = {"specular": 0.0, "blend": 1.0}
"""The properties of a material that is defined by its name alone: it has no highlight."""

SHINY = {"specular": 0.5, "blend": COLORED_PAINT.blend}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with two libraries, a folder with one, a pipe and a link, and a library outside."""
    folder = tmp_path / "car"
    (folder / "more").mkdir(parents=True)
    (folder / "red.mtl").write_bytes(RED)
    (folder / "my blue.mtl").write_bytes(BLUE)
    (folder / "more" / "green.mtl").write_bytes(b"newmtl green\nKd 0 1 0\n")
    (tmp_path / "outside.mtl").write_bytes(b"newmtl red\nKd 1 1 1\n")
    os.mkfifo(folder / "pipe.mtl")
    (folder / "inside.mtl").symlink_to(folder / "red.mtl")
    (folder / "linked").symlink_to(tmp_path)
    return folder


def read(
    folder: Path, *libraries: bytes, wanted: tuple[bytes, ...] = (b"red", b"blue", b"green")
) -> MeshReport:
    """A square for each material that is wanted, with lines that name libraries, read from car.obj."""
    text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + b"".join(b"mtllib %s\n" % name for name in libraries)
    text += b"".join(b"usemtl %s\nf 1 2 3 4\n" % name for name in wanted)
    (folder / "car.obj").write_bytes(text)
    return read_obj(folder / "car.obj")


def described(folder: Path, statements: str | bytes, *wanted: bytes) -> MeshReport:
    """A mesh with a library of some statements; it wants a red material unless others are named."""
    data = statements if isinstance(statements, bytes) else statements.encode()
    (folder / "car.mtl").write_bytes(data)
    return read(folder, b"car.mtl", wanted=wanted or (b"red",))


def surface(name: str = "red", **changes: Any) -> Surface:
    return created_surface(name, COLORED_PAINT.object_color).replace(**{**DEFAULT, **changes})


def names_of(report: MeshReport) -> list[str]:
    return [each.name for each in report.materials]


@pytest.mark.parametrize(
    ("statements", "changes"),
    [
        ("Kd 1 0.5 0", {"object_color": (255, 128, 0)}),
        ("Kd 0.2", {"object_color": (51, 51, 51)}),
        ("\tKd .5\t1. +25e-2 # a", {"object_color": (128, 255, 64)}),
        ("Kd 0 1 0\nKd 1 0 0 0.5", {"object_color": (255, 0, 0)}),
        ("Ks 0.2 0.5 0.1", SHINY),
        ("Ks 0.5\nillum 2", SHINY),
        ("Ks 0.5 0.5 0.5\nillum 0", {}),
        ("illum 1\nKs 0.5", {}),
        ("Ns 0", {"exponent": 1}),
        ("newmtl red\nKd 0 1 0", {}),
        ("# Kd 1 1 1\nKa 1 1 1\nodd\nd 1.0\nTr 0.000", {}),
        ("newmtl none\nKd 1 0 0\nd 0.5\nbump a", {}),
    ],
)
def test_a_material_has_the_properties_of_its_statements(
    folder: Path, statements: str, changes: dict[str, Any]
) -> None:
    report = described(folder, f"Kd 0 1 0\nnewmtl red\n{statements}\n")
    assert report.materials == (surface(**changes),)
    assert report.repairs == ()


@pytest.mark.parametrize("transparency", ["d 0.5", "Tr 0.5"])
@pytest.mark.parametrize("texture", ["map_Kd -s 1 1 1", "MAP_KD", "bump", "disp", "norm"])
def test_what_is_left_out_is_counted_by_materials_that_are_wanted(
    folder: Path, transparency: str, texture: str
) -> None:
    textures = {"red": f"{texture} a.png\nmap_Ks a.png", "blue": "bump a.png", "unused": "bump a.png"}
    text = "".join(f"newmtl {name}\n{lines}\n" for name, lines in textures.items())
    report = described(folder, f"{text}newmtl red\n{transparency}\n", b"red", b"blue")
    assert report.materials == (surface(), surface("blue"))
    assert report.repairs == (
        "car.mtl: left out the textures of 2 materials",
        "car.mtl: left out the transparency of 1 material",
    )


@pytest.mark.parametrize(
    "statement",
    ["Kd ", "Kd x", "Kd nan", "Kd 1 2", "Ks 0 0 1e6", "Ns -0.5"],
)
def test_a_bad_number_is_told_with_its_line_and_the_default_is_used(folder: Path, statement: str) -> None:
    report = described(folder, f"# a library\nnewmtl red\n{statement}\nKs x\nKs y\n")
    keyword, _, words = statement.partition(" ")
    assert report.repairs == (
        f"car.mtl, line 3: {keyword} must have one number or three, from 0 to 1e+06, not {words!r};"
        " the default is used",
        "car.mtl: 2 more such lines",
    )
    assert report.materials == (surface(),)


def test_materials_that_no_library_defines_are_told(folder: Path) -> None:
    for count, more in ((3, ""), (4, " and 1 more"), (9, " and 6 more")):
        wanted = (b"red", *(b"tin%d" % number for number in range(count)))
        assert read(folder, b"red.mtl", wanted=wanted).repairs == (
            f"no library defines material 'tin0', 'tin1', 'tin2'{more}; default colors are used",
        )
    assert read(folder).repairs == ()


@pytest.mark.parametrize(
    ("libraries", "names"),
    [
        ([b"inside.mtl"], ["red"]),
        ([b'"my blue.mtl"'], ["blue"]),
        ([b"more\\green.mtl"], ["green"]),
        ([b"red.mtl more/green.mtl"], ["red", "green"]),
        ([b"C:\\Users\\anna\\my blue.mtl"], ["blue"]),
        ([b"\\\\server\\share\\red.mtl"], ["red"]),
        ([b"more/green.mtl", b"my blue.mtl", b"red.mtl"], ["red", "blue", "green"]),
    ],
)
def test_a_library_is_found_in_the_folder_of_the_obj_file_or_below_it(
    folder: Path, libraries: list[bytes], names: list[str]
) -> None:
    report = read(folder, *libraries)
    assert names_of(report) == names
    assert all("no library defines" in sentence for sentence in report.repairs)


@pytest.mark.parametrize(
    "library",
    [
        *(b"none.mtl", b"../outside.mtl", b"linked/outside.mtl", b"more", b"pipe.mtl", b"a\xffb.mtl"),
        *(b"x" * 5000, b"http://example.org/none.mtl", b"file:///none.mtl"),
    ],
)
def test_a_library_outside_or_that_is_no_file_or_an_address_is_not_read(
    folder: Path, library: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("socket.socket", None)
    report = read(folder, library)
    assert report.materials == ()
    (sentence,) = report.repairs
    assert sentence.startswith(
        "no library defines material 'red', 'blue', 'green'; default colors are used; c"
    )
    assert sentence.endswith(" to the folder of car.obj")


def test_of_a_material_in_several_libraries_the_first_counts(folder: Path) -> None:
    (folder / "other.mtl").write_bytes(b"newmtl red\nKd 0 1 0\nnewmtl red\nKd 1 1 1\n")
    for line, color in ((b"red.mtl other.mtl", (255, 0, 0)), (b"other.mtl red.mtl", (0, 255, 0))):
        assert [each.paint.object_color for each in read(folder, line).materials] == [color]


def test_without_a_library_that_of_the_same_name_beside_it_is_read(folder: Path) -> None:
    beside = folder / "car.mtl"
    beside.symlink_to(folder.parent / "outside.mtl")
    assert read(folder).materials == ()
    beside.unlink()
    beside.write_bytes(BLUE)
    for libraries, names in (((), ["blue"]), ((b"none.mtl",), ["blue"]), ((b"red.mtl",), ["red"])):
        assert names_of(read(folder, *libraries)) == names


def test_a_library_has_a_limited_size_and_is_looked_for_among_the_first_alone(folder: Path) -> None:
    (folder / "red.mtl").write_bytes(RED.ljust((4 << 20) + 1))
    report = read(folder, b"red.mtl", b"my blue.mtl", wanted=(b"red", b"blue"))
    assert names_of(report) == ["blue"]
    assert report.repairs[0].startswith(
        "the materials have default colors: red.mtl: a file must have at most"
    )
    for separator in (b" ", b"\nmtllib "):
        none = [b"none%d.mtl" % number for number in range(MOST_LIBRARIES - 1)]
        assert names_of(read(folder, separator.join([*none, b"more/green.mtl"]))) == ["green"]
        assert names_of(read(folder, separator.join([*none, b"none.mtl", b"more/green.mtl"]))) == []


WORDS = st.sampled_from(
    [b"newmtl", b"red", b"Kd", b"Ks", b"Ns", b"d", b"Tr", b"map_Kd", b"1", b"0.5", b"-1", b"1e308", b"1e-308",
     b"9" * 400, b"nan", b"#", b"\xff", b"./", b"\\", b"a:"]
)  # fmt: skip
LINES = st.lists(WORDS, max_size=5).map(b" ".join)


@given(
    st.binary(max_size=100) | st.lists(LINES, max_size=20).map(b"\n".join),
    st.lists(LINES | st.text("./\\:ab", min_size=1, max_size=9).map(str.encode), max_size=3),
)
def test_any_library_gives_surfaces_that_there_can_be_and_sentences_that_can_be_shown(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, libraries: list[bytes]
) -> None:
    folder = tmp_path_factory.getbasetemp() / "any"
    folder.mkdir(exist_ok=True)
    (folder / "car.mtl").write_bytes(data)
    report = read(folder, *libraries, wanted=(b"red", b"Kd"))
    for material in report.materials:
        assert material.name in ("red", "Kd")
        assert all(0 <= part <= 255 for part in material.paint.object_color)
        assert material.reflectance.specular >= 0
    assert all(sentence.isprintable() and len(sentence) < 250 for sentence in report.repairs)
