from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import MissingInputError, OutputError, Paint, Palette, Scalar, read_palette, write_palette
from autocolor.files.palette_file import LONGEST_NAME, is_palette
from autocolor.scene.columns import replaced
from tests.tables import refused

COLORS = st.tuples(*[st.integers(0, 255)] * 3)
PRINTABLE = st.characters(categories=["L", "M", "N", "P", "S"]) | st.just(" ")
NAMES = st.text(PRINTABLE, max_size=LONGEST_NAME).map(str.strip)
HEAD = b"GIMP Palette\n"


COLORS_AND_NAMES = st.lists(st.tuples(COLORS, NAMES), min_size=1, max_size=10)


def read(name: str, data: bytes) -> Palette:
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / name).write_bytes(data)
        return read_palette(Path(folder) / name)


@given(COLORS_AND_NAMES, st.sampled_from([".gpl", ".csv"]))
def test_a_palette_that_is_written_and_read_is_the_same(rows: list[tuple[Any, str]], suffix: str) -> None:
    palette = Palette(*zip(*rows, strict=True))
    with tempfile.TemporaryDirectory() as folder:
        write_palette(Path(folder, f"paints{suffix}"), palette)
        assert read_palette(Path(folder, f"paints{suffix}")) == palette


def test_a_gimp_palette_of_gimp_is_read() -> None:
    data = (
        b"\xef\xbb\xbfGIMP Palette\r\nName: Mine\r\nColumns: 4\r\n# by hand\r\n\r\n"
        b"  0 128 255 \tSky, 2 \r\n1 2 3"
    )
    assert read("mine.gpl", data) == Palette([(0, 128, 255), (1, 2, 3)], ["Sky, 2", ""])
    # GIMP palettes have other endings, too.
    assert read("mine.txt", data) == read("mine.gpl", data)


@pytest.mark.parametrize(
    "data",
    [
        b"name,color\nRed one,#b01020\nNavy,navy\n",
        b"\xef\xbb\xbfColor, Name\r\n#B01020,Red one\r\n\r\nNAVY, Navy \r\n",
        b"name\tred\tgreen\tblue\nRed one\t176.0\t16.0\t32.0\nNavy\t0.0\t0.0\t128.0\n",
    ],
)
def test_columns_of_a_table_may_be_in_any_order_and_colors_have_names(data: bytes) -> None:
    assert read("paints.csv", data) == Palette(["#b01020", "navy"], ["Red one", "Navy"])


def test_the_transparency_of_aseprite_is_left_out() -> None:
    data = (
        b"GIMP Palette\nChannels: RGBA\n#\n  0   0   0   0 Clear\n254  91  89 255\n106 205  91 255 \t7 up\n"
    )
    assert read("a.gpl", data) == Palette([(0, 0, 0), (254, 91, 89), (106, 205, 91)], ["Clear", "", "7 up"])
    # Without the header line the number is a name.
    assert read("a.gpl", HEAD + b"1 2 3 255\n") == Palette([(1, 2, 3)], ["255"])


COUNT = "a palette must have 1 to 4,096 colors, not"
COLUMNS = "the columns must be red, green, blue, or color, and perhaps name, not"
NAME = "must be at most 100 printable characters in UTF-8, without spaces around them, not"
A_COLOR = 'must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255, not'

test_what_is_refused = refused(
    lambda file: read(*file),
    [
        (
            ("a.gpk", b"x"),
            "a.gpk: a palette must end in .csv or .gpl, not in '.gpk'; did you mean '.gpl'?; save it as one"
            " of these",
        ),
        (("a.gpl", b""), "a.gpl, line 1: it must be 'GIMP Palette', not ''; save it by GIMP"),
        (("a.gpl", HEAD), f"a.gpl: {COUNT} 0; add a color"),
        (("a.gpl", HEAD + b"1 2 3\n" * 4097), f"a.gpl: {COUNT} 4,097; choose some of them"),
        (
            ("a.gpl", HEAD + b"1 2 256 a\n-1 0 0\n" + "٣ 2 1\n".encode()),
            f"a.gpl, line 2: a color {A_COLOR} [1, 2, 256]; correct it\n"
            f"a.gpl, line 3: a color {A_COLOR} ['-1', 0, 0]; correct it\n"
            f"a.gpl, line 4: a color {A_COLOR} ['٣', 2, 1]; correct it",
        ),
        (
            ("a.gpl", HEAD + b"Channels: RGBA\n1 2 3 sea\n"),
            f"a.gpl, line 3: a color {A_COLOR} [1, 2, 3, 'sea']; correct it",
        ),
        (("a.gpl", HEAD + b"1 2 3 caf\xe9"), f"a.gpl, line 2: a name {NAME} 'caf\\udce9'; correct it"),
        (
            ("a.csv", b"red;green;blu\n"),
            f"a.csv (separated by semicolons), row 1: {COLUMNS} 'red, green, blu' (separated by semicolons);"
            " name them so",
        ),
        (
            ("a.csv", b"name,color\na,rde\n" + b"x" * 101 + b",red\n"),
            f"a.csv, row 2: a color {A_COLOR} 'rde'; did you mean 'red'?\n"
            f"a.csv, row 3: a name {NAME} '{'x' * 40}'...; correct it",
        ),
    ],
)


def test_a_palette_file_is_not_overwritten_unasked(tmp_path: Path) -> None:
    with pytest.raises(MissingInputError, match=r"a\.gpl: there is no such file"):
        read_palette(tmp_path / "a.gpl")
    write_palette(tmp_path / "a.gpl", ["red"])
    with pytest.raises(OutputError, match="exists"):
        write_palette(tmp_path / "a.gpl", ["blue"])


test_what_cannot_be_written_is_refused = refused(
    lambda given: write_palette(*given[:2], names=given[2] if given[2:] else None),
    [
        (("a.gpl", np.zeros(3, np.uint8)), f"color 1 of a palette: a color {A_COLOR} 0; correct it"),
        (("a.gpl", 3), "the colors of a palette must be a sequence, not 3; give a list"),
        (("a.gpl", ["red", "rde"]), f"color 2 of a palette: a color {A_COLOR} 'rde'; did you mean 'red'?"),
        (
            ("a.gpl", ["red"], ["a", "b"]),
            "a palette must have a name for each of its 1 colors, or no names, not 2; write '' for a color"
            " without a name",
        ),
        *(
            (("a.gpl", ["red"], [name]), f"color 1 of a palette: a name {NAME} {name!r}; correct it")
            for name in (" a", "a\n", 1)
        ),
        (("a.png", "red"), "a.png: a palette must end in .csv or .gpl, not in '.png'; rename it"),
    ],
)


def test_a_color_is_found_by_its_name_whatever_the_capitals() -> None:
    palette = Palette(["red", "lime", "blue", "navy"], ["Signal red", "Grass", "Sea", "sea"])
    assert palette.color_named("SIGNAL RED") == (255, 0, 0)
    # Of several colors with one name, it is the first.
    assert palette.color_named("sea") == (0, 0, 255)
    assert palette.color_named("Gras") is None
    assert Palette(["red"]).color_named("") is None


def test_a_palette_is_a_sequence_of_its_colors_and_so_a_ramp_and_a_scale() -> None:
    palette = Palette(["red", "lime", "navy"], ["Signal red", "", "Sea"])
    assert [*palette] == [palette[0], *palette[1:]] == [(255, 0, 0), (0, 255, 0), (0, 0, 128)]
    assert Paint().replace(ramp=palette).ramp == palette.colors
    assert replaced(Scalar("z"), {"scale": palette}).scale == palette.colors


def test_files_of_paints_are_told_from_other_files(tmp_path: Path) -> None:
    files = {"a.gpl": b"", "a.csv": b'\xef\xbb\xbf"name",Color\r\n', "n.csv": b"node,x,y,z\n", "a.txt": HEAD}
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    assert [name for name in files if is_palette(tmp_path / name)] == ["a.gpl", "a.csv"]
