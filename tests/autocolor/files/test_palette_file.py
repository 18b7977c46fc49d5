from __future__ import annotations

import copy
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import autocolor
from autocolor import (
    InputError,
    MissingInputError,
    OutputError,
    Palette,
    Studio,
    Surface,
    UsageError,
    read_palette,
    scene_of,
    write_palette,
)
from autocolor.files.palette_file import (
    LARGEST,
    LONGEST_NAME,
    MOST_COLORS,
    PALETTE_FORMATS,
    is_palette,
)
from ramtek_emu import Ramtek9300
from tests.small import cube

COLORS = st.tuples(*[st.integers(0, 255)] * 3)
NAMES = st.text(max_size=LONGEST_NAME).filter(str.isprintable).map(str.strip)
HEAD = b"GIMP Palette\n"
A_COLOR = 'must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255'


@st.composite
def palettes(draw: st.DrawFn, *, most: int = 40, named: bool = True) -> Palette:
    colors = draw(st.lists(COLORS, min_size=1, max_size=most))
    names = draw(st.lists(NAMES, min_size=len(colors), max_size=len(colors))) if named else ()
    return Palette(colors, names)


def read(folder: Path, name: str, data: bytes) -> Palette:
    (folder / name).write_bytes(data)
    return read_palette(folder / name)


@given(palette=palettes())
def test_a_palette_that_is_written_and_read_is_the_same(palette: Palette) -> None:
    for each in PALETTE_FORMATS[:2]:
        assert each.read(each.written(palette, Path("paints")), "paints") == palette


@given(palette=palettes(most=256, named=False))
def test_a_color_table_of_adobe_that_is_written_and_read_is_the_same(palette: Palette) -> None:
    act = PALETTE_FORMATS[2]
    data = act.written(palette, Path("paints"))
    assert len(data) == 772
    assert act.read(data, "paints") == palette


@pytest.mark.parametrize("name", ["a.gpl", "a.csv", "a.act", "a.GPL"])
def test_the_ending_of_a_file_chooses_its_format(tmp_path: Path, name: str) -> None:
    write_palette(tmp_path / name, ["red", (1, 2, 3)])
    assert read_palette(tmp_path / name).colors.tolist() == [[255, 0, 0], [1, 2, 3]]


def test_a_gimp_palette_is_written_as_gimp_writes_it(tmp_path: Path) -> None:
    write_palette(tmp_path / "car.gpl", ["#b01020", (1, 22, 3)], names=["Signal red", ""])
    assert (tmp_path / "car.gpl").read_bytes() == (
        b"GIMP Palette\nName: car\n#\n176  16  32\tSignal red\n  1  22   3\n"
    )


def test_a_gimp_palette_of_gimp_is_read(tmp_path: Path) -> None:
    data = (
        b"\xef\xbb\xbfGIMP Palette\r\nName: Mine\r\nColumns: 4\r\n# by hand\r\n\r\n"
        b"  0 128 255 \tSky, 2 \r\n1 2 3"
    )
    assert read(tmp_path, "mine.gpl", data) == Palette([(0, 128, 255), (1, 2, 3)], ["Sky, 2", ""])
    # GIMP palettes have other endings, too.
    assert read(tmp_path, "mine.txt", data) == read_palette(tmp_path / "mine.gpl")


def test_a_table_has_names_only_if_a_color_has_one(tmp_path: Path) -> None:
    write_palette(tmp_path / "one.csv", [(1, 2, 3)])
    assert (tmp_path / "one.csv").read_text() == "red,green,blue\n1,2,3\n"
    write_palette(tmp_path / "two.csv", [(1, 2, 3), (4, 5, 6)], names=["", 'a "b", c'])
    assert (tmp_path / "two.csv").read_text() == 'red,green,blue,name\n1,2,3,\n4,5,6,"a ""b"", c"\n'


@pytest.mark.parametrize(
    "data",
    [
        b"name,color\nRed one,#b01020\nNavy,navy\n",
        b"\xef\xbb\xbfColor, Name\r\n#B01020,Red one\r\n\r\nNAVY, Navy \r\n",
        b"blue,red,name,green\n32,176,Red one,16\n128,000,Navy,0",
    ],
)
def test_columns_of_a_table_may_be_in_any_order_and_colors_have_names(tmp_path: Path, data: bytes) -> None:
    assert read(tmp_path, "paints.csv", data) == Palette(["#b01020", "navy"], ["Red one", "Navy"])


def test_a_color_table_without_a_count_has_256_colors_and_a_transparent_color_is_a_color(
    tmp_path: Path,
) -> None:
    data = bytes(range(256)) * 3
    assert read(tmp_path, "full.act", data).colors.tobytes() == data
    some = read(tmp_path, "some.act", data + b"\x00\x02\x00\x01")
    assert some.colors.tolist() == [[0, 1, 2], [3, 4, 5]]


REFUSALS: list[tuple[str, bytes, str]] = [
    ("a.gpl", b"", "a.gpl, line 1: it must be 'GIMP Palette', not ''; save it by GIMP"),
    ("a.gpl", HEAD, "a.gpl: a palette must have 1 to 4,096 colors, not 0; add a color"),
    (
        "a.gpl",
        HEAD + b"1 2 256 a\n0 0\n-1 0 0\n",
        "a.gpl, line 2: blue must be a whole number from 0 to 255, not '256'; correct it\n"
        "a.gpl, line 3: a color must be red, green, blue and perhaps a name, not '0 0'; correct it\n"
        "a.gpl, line 4: a color must be red, green, blue and perhaps a name, not '-1 0 0'; correct it",
    ),
    (
        "a.gpl",
        HEAD + b"Name: mine\n1 2 3\nName: late\n",
        "a.gpl, line 4: a color must be red, green, blue and perhaps a name, not 'Name: late'; correct it",
    ),
    (
        "a.gpl",
        HEAD + "٣ 2 1\n".encode(),
        "a.gpl, line 2: a color must be red, green, blue and perhaps a name, not '٣ 2 1'; correct it",
    ),
    (
        "a.gpl",
        HEAD + b"1 2 3 a\x1bb",
        "a.gpl, line 2: a name must be at most 100 printable characters, without spaces around them, not"
        " 'a\\x1bb'; correct it",
    ),
    (
        "a.gpl",
        HEAD + b"1 2 3 " + b"x" * 101,
        "a.gpl, line 2: a name must be at most 100 printable characters, without spaces around them, not"
        f" '{'x' * 40}'...; correct it",
    ),
    (
        "a.gpl",
        HEAD + b"1 2 3\n" * 4097,
        "a.gpl: a palette must have 1 to 4,096 colors, not 4,097; choose some of them",
    ),
    (
        "a.gpl",
        HEAD + b"\0",
        "a.gpl: a palette must be text, not hold a NUL byte (line 2); save it as UTF-8 text",
    ),
    ("a.gpl", HEAD + b"1 2 3 \xff", "a.gpl, line 2: a palette must be text in UTF-8; save it as UTF-8"),
    ("a.gpl", b"\xff\xfeG\0", "a.gpl: a palette must be text in UTF-8, not UTF-16; save it as UTF-8"),
    (
        "a.gpl",
        HEAD + b"#" * LARGEST,
        "a.gpl: a file must have at most 1,048,576 bytes, not more; split or simplify it",
    ),
    ("a.csv", b"", "a.csv: a palette must have 1 to 4,096 colors, not 0; add a color"),
    (
        "a.csv",
        b"1,2,3\n",
        "a.csv, row 1: the columns must be red, green, blue, or color, and perhaps name, not '1,2,3';"
        " name them so",
    ),
    (
        "a.csv",
        b"red,green,blue,red\n",
        "a.csv, row 1: the columns must be red, green, blue, or color, and perhaps name, not"
        " 'red,green,blue,red'; name them so",
    ),
    (
        "a.csv",
        b"name,color\na,rde\nb\nc,#12\n",
        f"a.csv, row 2: a color {A_COLOR}, not 'rde'; did you mean 'red'?\n"
        "a.csv, row 3: a row must have 2 cells, not 1; correct it\n"
        f"a.csv, row 4: a color {A_COLOR}, not '#12'; write three or six hexadecimal digits after the #",
    ),
    (
        "a.csv",
        b"red,green,blue\n1,+2,1e1\n",
        "a.csv, row 2: green must be a whole number from 0 to 255, not '+2'; correct it\n"
        "a.csv, row 2: blue must be a whole number from 0 to 255, not '1e1'; correct it",
    ),
    (
        "a.csv",
        b'color\n"red',
        "a.csv, row 2: it must be CSV (unexpected end of data); correct the row",
    ),
    ("a.act", b"", "a.act: an .act file must have 768 or 772 bytes, not 0; save it again"),
    (
        "a.act",
        bytes(771),
        "a.act: an .act file must have 768 or 772 bytes, not 771; save it again",
    ),
    *(
        (
            "a.act",
            bytes(768) + count.to_bytes(2, "big") + bytes(2),
            f"a.act: the number of colors, bytes 768 and 769, must be 1 to 256, not {count:,}; save it again",
        )
        for count in (0, 257, 65535)
    ),
    (
        "a.gpk",
        b"x",
        "a.gpk: a palette must end in .act, .csv or .gpl, not in '.gpk'; did you mean '.gpl'?; save it as"
        " one of these",
    ),
]


@pytest.mark.parametrize(("name", "data", "sentence"), REFUSALS)
def test_a_bad_palette_is_refused_in_a_sentence(
    tmp_path: Path, name: str, data: bytes, sentence: str
) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, name, data)
    assert "\n".join(caught.value.problems) == sentence


def test_a_palette_that_is_not_there_is_missing(tmp_path: Path) -> None:
    with pytest.raises(MissingInputError, match=r"no\.gpl: there is no such file"):
        read_palette(tmp_path / "no.gpl")
    with pytest.raises(InputError, match=r"^\.: a palette must end in \.act, \.csv or \.gpl"):
        read_palette(".")


@pytest.mark.parametrize(
    ("colors", "names", "sentence"),
    [
        ([], (), "a palette must have 1 to 4,096 colors, not 0; add a color"),
        (np.zeros((MOST_COLORS + 1, 3), np.uint8), (), "a palette must have 1 to 4,096 colors, not 4,097;"),
        (np.zeros(3, np.uint8), (), r"the colors of a palette must be an array (n, 3), not (3,);"),
        ([(0, 0, 256)], (), "color 1 of a palette must be"),
        (["red", "rde"], (), "color 2 of a palette must be"),
        ("red", ["a", "b"], "a palette must have a name for each of its 1 colors, or no names, not 2;"),
        (5, (), "the colors of a palette must be a sequence of colors, not 5; give a list"),
        (["red"], [" a"], "name 1 of a palette must be at most 100 printable characters"),
        (["red"], ["a\n"], "name 1 of a palette must be"),
        (["red"], [1], "name 1 of a palette must be"),
    ],
)
def test_bad_colors_and_names_are_refused_before_anything_is_written(
    tmp_path: Path, colors: Any, names: Any, sentence: str
) -> None:
    with pytest.raises(InputError) as caught:
        write_palette(tmp_path / "a.gpl", colors, names=names)
    assert sentence in str(caught.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "count", "names", "sentence"),
    [
        ("a.png", 1, None, "a.png: a palette must end in .act, .csv or .gpl, not in '.png'; rename it"),
        ("a.act", 257, None, "an .act file must hold at most 256 colors, not 257; write a .gpl or .csv file"),
        ("a.act", 1, ["red"], "an .act file must hold colors without names; write a .gpl or .csv file,"),
    ],
)
def test_what_a_format_cannot_hold_is_refused(
    tmp_path: Path, name: str, count: int, names: Any, sentence: str
) -> None:
    with pytest.raises(UsageError) as caught:
        write_palette(tmp_path / name, np.zeros((count, 3), np.uint8), names=names)
    assert sentence in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_there_is_overwritten_only_if_asked(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("mine")
    with pytest.raises(OutputError, match="exist"):
        write_palette(path, ["red"])
    assert path.read_text() == "mine"
    write_palette(path, ["red"], overwrite=True)
    assert read_palette(path).color(0) == (255, 0, 0)


def test_a_palette_is_a_value_that_nobody_changes() -> None:
    given = np.array([[1, 2, 3]], np.uint8)
    palette = Palette(given, ("a",))
    given[:] = 0
    assert palette.color(0) == (1, 2, 3)
    assert palette.colors.dtype == np.uint8
    for same in (palette, copy.deepcopy(palette), pickle.loads(pickle.dumps(palette))):
        assert same == palette
        assert hash(same) == hash(palette)
        assert not same.colors.flags.writeable
    assert palette != Palette(palette.colors, ("b",))
    assert palette != Palette(["#010204"], ("a",))
    assert palette != "a"


def test_a_color_is_found_by_its_name_whatever_the_capitals() -> None:
    palette = Palette(["red", "lime", "blue", "navy"], ["Signal red", "Grass", "Sea", "sea"])
    assert palette.color_named("SIGNAL RED") == (255, 0, 0)
    # Of several colors with one name, it is the first.
    assert palette.color_named("sea") == (0, 0, 255)
    assert palette.color_named("Gras") is None
    assert Palette(["red"]).color_named("") is None


@pytest.mark.parametrize(
    ("name", "data", "is_one"),
    [
        ("a.gpl", b"", True),
        ("a.act", b"", True),
        ("a.csv", b"\xef\xbb\xbfname,Color\r\n", True),
        ("a.csv", b'"red","green","blue"\n', True),
        ("nodes.csv", b"node,x,y,z\n", False),
        ("a.txt", HEAD, False),
    ],
)
def test_files_of_paints_are_told_from_other_files(
    tmp_path: Path, name: str, data: bytes, is_one: bool
) -> None:
    (tmp_path / name).write_bytes(data)
    assert is_palette(tmp_path / name) is is_one


def test_the_example_of_the_document_brings_the_same_entries_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = Path(__file__).parents[3]
    (tmp_path / "examples").symlink_to(root / "examples")
    monkeypatch.chdir(tmp_path)
    body = dict.fromkeys(cube().part_names, "body")
    studio = Studio(scene_of(cube(), surfaces=[Surface("body")], surface_of_part=body), Ramtek9300())
    document = (root / "docs" / "guides" / "studio.md").read_text("utf-8")
    (example,) = re.findall("^(paints = .*?)```", document, re.DOTALL | re.MULTILINE)
    names = {"autocolor": autocolor, "studio": studio}
    entries, paints = [], []
    for line in example.splitlines():
        exec(line, names)
        entries.append(studio.entries)
        paints.append(studio.scene.surface("body").paint)
    assert paints[1].object_color == (200, 16, 32)
    assert len(paints[3].ramp or ()) == studio.level_ranges["body"].levels
    assert np.array_equal(entries[1], entries[3])
    assert read_palette("hot.csv").names == ("low", "middle", "high")
