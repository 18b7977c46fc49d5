from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Surface
from autocolor.files.meshes.obj import materials
from autocolor.files.meshes.obj.materials import (
    MOST_LIBRARIES,
    MOST_PROBLEMS,
    Materials,
    materials_of,
    read_materials,
)
from autocolor.files.reading import read_bytes
from autocolor.scene.defaults import COLORED_PAINT, created_surface

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
def test_lines_of_a_library_end_in_any_way(ending: str) -> None:
    surfaces, sentences = described(f"newmtl red{ending}Kd 1 0 0{ending}Ks x{ending}")
    assert surfaces["red"].paint.object_color == (255, 0, 0)
    assert sentences == [
        "car.mtl, line 3: Ks must have one number or three, from 0 to 1e+06, not 'x'; the default is used"
    ]


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
    assert len(sentences) == MOST_PROBLEMS + 1
    assert sentences[-1] == f"car.mtl: {1000 - MOST_PROBLEMS} more such lines"
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
    assert len(sentences) <= MOST_PROBLEMS + 3
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


def read(obj: Path, *libraries: bytes) -> Materials:
    """What is read of three materials; that some of them are not defined is left out."""
    surfaces, sentences = read_materials(obj, libraries, ("red", "blue", "green"))
    return Materials(surfaces, tuple(each for each in sentences if "no library defines" not in each))


def test_materials_that_no_library_defines_are_told(obj: Path) -> None:
    assert read_materials(obj, [b"red.mtl"], ("red", "blue", "green")).sentences == (
        "no library defines material 'blue', 'green'; default colors are used",
    )
    many = ("red", *(f"paint {number}" for number in range(9)))
    assert read_materials(obj, [b"red.mtl"], many).sentences == (
        "no library defines material 'paint 0', 'paint 1', 'paint 2' and 6 more; default colors are used",
    )
    assert read_materials(obj, [], ("red", "blue")) == ((), ())


def names_read(obj: Path, *libraries: bytes) -> list[str]:
    """The names of the materials, where nothing is to be told."""
    surfaces, sentences = read(obj, *libraries)
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
        (surface,) = read(obj, *libraries).surfaces
        assert surface.paint.object_color == color


def test_without_a_library_that_of_the_same_name_beside_it_is_read(obj: Path) -> None:
    assert names_read(obj) == []
    obj.with_suffix(".mtl").write_bytes(BLUE)
    assert names_read(obj) == ["blue"]
    assert names_read(obj, b"red.mtl") == ["red"]


def test_without_materials_no_library_is_read(obj: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(materials, "read_bytes", None)
    assert read_materials(obj, [b"red.mtl", b"none.mtl"], ()) == ((), ())


@pytest.mark.parametrize(
    "library",
    [b"none.mtl", b"../outside.mtl", b"more", b".", b"", b"\0", b"a\0b.mtl", b"x" * 5000, b"\xff", b"*"],
)
def test_a_library_that_is_not_there_is_told(obj: Path, library: bytes) -> None:
    surfaces, (sentence,) = read(obj, library)
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
        assert read(obj, library).surfaces == ()


@pytest.mark.skipif(os.name != "posix", reason="needs symbolic links")
def test_a_link_that_leads_outside_is_not_followed(obj: Path) -> None:
    (obj.parent / "link.mtl").symlink_to(obj.parent.parent / "outside.mtl")
    (obj.parent / "folder").symlink_to(obj.parent.parent)
    for library in (b"link.mtl", b"folder/outside.mtl"):
        surfaces, (sentence,) = read(obj, library)
        assert surfaces == ()
        assert "there is no library" in sentence


@pytest.mark.skipif(os.name != "posix", reason="needs symbolic links")
def test_a_link_beside_the_obj_file_that_leads_outside_is_not_followed(obj: Path) -> None:
    obj.with_suffix(".mtl").symlink_to(obj.parent.parent / "outside.mtl")
    assert read(obj).surfaces == ()


@pytest.mark.skipif(os.name != "posix", reason="needs symbolic links")
def test_a_link_within_the_folder_is_followed(obj: Path) -> None:
    (obj.parent / "link.mtl").symlink_to(obj.parent / "red.mtl")
    assert names_read(obj, b"link.mtl") == ["red"]


@pytest.mark.parametrize(
    "library", [b"http://example.org/none.mtl", b"https://example.org/a/none.mtl", b"file:///none.mtl"]
)
def test_an_address_is_never_fetched(obj: Path, library: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("socket.socket", None)
    surfaces, (sentence,) = read(obj, library)
    assert surfaces == ()
    assert "there is no library" in sentence


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a named pipe")
def test_a_pipe_is_not_waited_for(obj: Path) -> None:
    os.mkfifo(obj.parent / "pipe.mtl")
    os.mkfifo(obj.with_suffix(".mtl"))
    assert "there is no library" in read(obj, b"pipe.mtl").sentences[0]
    assert read(obj) == ((), ())


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
    surfaces, (told,) = read(obj, b"red.mtl", b"my blue.mtl")
    assert told.startswith(f"the materials have default colors: {sentence}")
    assert [surface.name for surface in surfaces] == ["blue"]


def test_an_endless_library_is_told_and_not_read(obj: Path) -> None:
    with open(obj.parent / "red.mtl", "r+b") as file:
        file.truncate(1 << 40)
    surfaces, (told,) = read(obj, b"red.mtl")
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
    surfaces, sentences = read(obj, b"red.mtl")
    assert surfaces == (red("Kd 1 0 0"),)
    assert sentences == (
        "red.mtl: left out the textures of 1 material",
        "red.mtl, line 3: Kd must have one number or three, from 0 to 1e+06, not 'x'; the default is used",
    )


def test_a_library_that_is_named_twice_is_read_once(obj: Path) -> None:
    (obj.parent / "red.mtl").write_bytes(RED + b"d 0.5\n")
    assert len(read(obj, b"red.mtl", b"red.mtl").sentences) == 1


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
    surfaces, sentences = read(obj, *(b"none%d.mtl" % number for number in range(5000)), b"red.mtl")
    assert surfaces == ()
    assert len(sentences) == MOST_PROBLEMS
    assert len(looked) <= 10 * MOST_LIBRARIES


def test_of_many_libraries_in_one_statement_a_limited_number_is_looked_for(
    obj: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked = count_of_looks(monkeypatch)
    read(obj, b" ".join(b"none%d.mtl" % number for number in range(5000)))
    assert len(looked) <= 10 * MOST_LIBRARIES


def test_one_statement_reads_no_library_more_than_once(obj: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []

    def counted(path: Path, largest: int) -> bytes:
        opened.append(path.name)
        return read_bytes(path, largest)

    monkeypatch.setattr(materials, "read_bytes", counted)
    read(obj, b"red.mtl ./red.mtl red.mtl", b"red.mtl")
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
