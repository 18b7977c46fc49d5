from __future__ import annotations

import re
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import ImageColor

from autocolor.scene.columns.color_kinds import ColorKind, in_digits
from autocolor.scene.columns.problems import REFUSED, Problem

RULE = 'it must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255'

PARTS = st.integers(0, 255)


def held(value: object) -> tuple[Any, list[str]]:
    """What a color column holds of a value, and the sentences of its problems."""
    problems: list[Problem] = []
    return ColorKind().held(value, ("it",), problems), [problem.sentence for problem in problems]


@pytest.mark.parametrize(
    ("value", "color"),
    [
        ("#0a10ff", (10, 16, 255)),
        ("#0A10FF", (10, 16, 255)),
        ((10, 16, 255), (10, 16, 255)),
        ([10, 16, 255], (10, 16, 255)),
        (np.array([10, 16, 255]), (10, 16, 255)),
        (np.array([10, 16, 255], np.uint8), (10, 16, 255)),
        ("red", (255, 0, 0)),
        ("DarkSlateGray", (47, 79, 79)),
        ("#b12", (187, 17, 34)),
        ("rgb(10%, 20%, 30%)", (26, 51, 77)),
        ("rgb(1,2,3)", (1, 2, 3)),
        ("hsl(120, 100%, 50%)", (0, 255, 0)),
    ],
)
def test_a_color_is_a_name_or_a_text_or_three_whole_numbers(
    value: object, color: tuple[int, int, int]
) -> None:
    found, sentences = held(value)
    assert sentences == []
    assert found == color
    assert [type(part) for part in found] == [int, int, int]


@given(st.tuples(PARTS, PARTS, PARTS))
def test_a_color_in_digits_is_what_pillow_takes_it_for(color: tuple[int, int, int]) -> None:
    for text in (in_digits(color), in_digits(color).upper()):
        assert held(text) == (ImageColor.getrgb(text), [])


@pytest.mark.parametrize("name", ImageColor.colormap)
def test_every_name_that_pillow_knows_is_a_color(name: str) -> None:
    assert held(name) == (ImageColor.getrgb(name), [])


@given(
    st.one_of(st.text(), st.from_regex(r"#[0-9a-f]{0,9}|(rgb|hsl|hsv|rgba)\([0-9%., ]*\)", fullmatch=True))
)
def test_any_text_is_a_color_in_range_or_refused_in_a_sentence(text: str) -> None:
    color, sentences = held(text)
    if color is REFUSED:
        assert len(sentences) == 1
        assert sentences[0].startswith(f"{RULE}, not ")
    else:
        assert len(color) == 3
        assert all(0 <= part <= 255 for part in color)


@pytest.mark.parametrize(
    ("value", "end"),
    [
        ("rde", "'rde'; did you mean 'red'?"),
        ("Grean", "'Grean'; did you mean 'green'?"),
        ("xyzzy", "'xyzzy'; write it as in \"#b01020\""),
        ("0a10ff", "'0a10ff'; write it as in \"#b01020\""),
        ("", "''; write it as in \"#b01020\""),
        ("#12", "'#12'; write three or six hexadecimal digits after the #"),
        ("#12345", "'#12345'; write three or six hexadecimal digits after the #"),
        ("#11223380", "'#11223380', which has transparency; write '#112233'"),
        ("#1238", "'#1238', which has transparency; write '#112233'"),
        ("rgba(1, 2, 3, 4)", "'rgba(1, 2, 3, 4)', which has transparency; write '#010203'"),
        ("rgb(300, 0, 0)", "'rgb(300, 0, 0)'; keep its parts from 0 to 255, or from 0% to 100%"),
        ("hsl(0, 200%, 50%)", "'hsl(0, 200%, 50%)'; keep its parts from 0 to 255, or from 0% to 100%"),
        ("k", "'k'; write it as in \"#b01020\""),
        ((1.0, 0, 0), "(1.0, 0, 0); write [255, 0, 0] or '#ff0000'"),
        ((0.5, 0.25, 0), "(0.5, 0.25, 0); write [128, 64, 0] or '#804000'"),
        ([10.0, 16.0, 255.0], "[10.0, 16.0, 255.0]; write [10, 16, 255] or '#0a10ff'"),
        (np.array([1.0, 0.0, 0.0]), "array([1., 0., 0.]); write [255, 0, 0] or '#ff0000'"),
        (np.zeros(3, np.float32), "array([0., 0., 0.], dtype=float32); write [0, 0, 0] or '#000000'"),
        ((1.0, float("nan"), 0.0), "(1.0, nan, 0.0)"),
        ((1.0, -3.0, 0.0), "(1.0, -3.0, 0.0)"),
    ],
)
def test_a_refusal_says_what_to_write_instead(value: object, end: str) -> None:
    color, sentences = held(value)
    assert color is REFUSED
    assert sentences == [f"{RULE}, not {end}"]


@pytest.mark.parametrize(
    "value",
    [
        "#0a10ff\n", "red\n", " red", "#0a 10f", "#0a10 f", "#0a10fg", "#\uff10a10ff", "rgb(\uff11,2,3)",
        b"#0a10ff", (1, 2), (1, 2, 3, 4), (1, 2, 256), (-1, 2, 3), (True, False, True), 7, None, {1, 2, 3},
        {1: 0, 2: 0, 3: 0}, "rgb(" + "9" * 200 + ",0,0)", ("1", "2", "3"), np.array(3), np.eye(3, dtype=int),
    ],
)  # fmt: skip
def test_what_is_no_color_is_refused(value: object) -> None:
    color, sentences = held(value)
    assert color is REFUSED
    assert re.match(re.escape(f"{RULE}, not "), sentences[0])


def test_colors_in_digits_are_read_without_pillow() -> None:
    code = (
        "import sys; from autocolor.scene.surfaces import Paint; Paint('#102030', (1, 2, 3));"
        "print('PIL' in sys.modules); print(Paint('red').object_color, 'PIL' in sys.modules)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert ran.stdout == "False\n(255, 0, 0) True\n"
