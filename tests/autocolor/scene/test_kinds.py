from __future__ import annotations

import math
import re
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import ImageColor

from autocolor.checks import Vector
from autocolor.scene.columns import REFUSED, Kind, Problem
from autocolor.scene.curves import CURVES
from autocolor.scene.kinds import (
    MOST_POINTS,
    AngleCurve,
    AngleCurveKind,
    Boolean,
    ColorKind,
    ColorsKind,
    CurveKind,
    Instance,
    Number,
    OneOf,
    Text,
    VectorKind,
    Whole,
    in_digits,
)
from autocolor.scene.row_kinds import RangesByName, Reference, References
from autocolor.scene.scalar import EndColor, LimitsKind, PlaceKind, ScaleKind
from autocolor.testing import angle_curves, directions, numbers, vectors

HOLDS: Any = object()
"""The first of two values."""

CURVE: AngleCurve = ((0.0, 0.5), (90.0, 1.0))
RANGES = RangesByName("surfaces", "auto", "object")


def validated(kind: Kind, value: object) -> tuple[Any, list[str]]:
    """The value that a kind makes of a value, and the sentences of its problems."""
    problems: list[Problem] = []
    return kind.validated(value, ("it",), problems), [problem.sentence for problem in problems]


def refusal(kind: Kind, value: object) -> str:
    """The one sentence with which a kind refuses a value."""
    result, sentences = validated(kind, value)
    assert result is REFUSED
    (sentence,) = sentences
    return sentence


def accepted(kind: Kind, value: object) -> Any:
    """The value that a kind makes of a value that it accepts."""
    result, sentences = validated(kind, value)
    assert sentences == []
    return result


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_finite_number_is_held_unchanged(number: float) -> None:
    assert accepted(Number(), number) == number


@pytest.mark.parametrize("value", [math.nan, math.inf, True, np.True_, "3", b"3", None, [], {}, 1j, 10**400])
def test_what_is_no_finite_number_is_refused(value: object) -> None:
    shown = "true" if value is True else repr(value)[:60] + ("..." if len(repr(value)) > 60 else "")
    assert refusal(Number(), value) == f"it must be a finite number, not {shown}"


@pytest.mark.parametrize(
    ("kind", "value", "sentence"),
    [
        (Number(at_least=0), -1, "it must be a finite number of at least 0, not -1"),
        (Number(at_least=0, at_most=1), 1.1, "it must be a number from 0 to 1, not 1.1"),
        (Number(at_least=0, above=True), 0, "it must be a number above 0, not 0"),
        (Number(0, 180, above=True), 181, "it must be a number above 0 and at most 180, not 181"),
        (Number(endless=math.inf), -math.inf, "it must be a finite number, not -inf"),
        (Whole(2, 9), 1, "it must be a whole number from 2 to 9, not 1"),
        (Whole(2, 9), 2.0, "it must be a whole number from 2 to 9, not 2.0"),
        (Whole(0, 9), True, "it must be a whole number from 0 to 9, not true"),
        (Boolean(), 1, "it must be true or false, not 1"),
        (Boolean(), None, "it must be true or false, not None"),
        (Text(), "", "it must be a string of at least one character, not ''"),
        (Text(may_be_empty=True), 3, "it must be a string, not 3"),
        (OneOf(("on", "off")), "of", "it must be 'on' or 'off', not 'of'; did you mean 'off'?"),
        (OneOf(("surface", "object")), 3, "it must be 'surface' or 'object', not 3"),
        (VectorKind(has_length=True), (0, 0, 0), "it must have a length above 0, not (0, 0, 0); change it"),
        (Reference("surfaces"), 3, "it must be a string of at least one character, not 3"),
        (References("lights"), "key", "it must be a list of names, not 'key'"),
        (References("lights"), ["key", 3], "it must be a list of names, not ['key', 3]"),
        (Reference("lights", "eye"), 3, "it must be 'eye' or the name of a light, not 3"),
        (Instance(dict), [], "it must be a dict, not []"),
        (
            ColorsKind(3),
            ["red"],
            'it must be a list of 2 to 3 colors, not [\'red\']; write them as in ["#200", "#f60", "#fff"]',
        ),
        (
            ColorsKind(3),
            "red, blue, teal, gold",
            "it must be a list of 2 to 3 colors, not 'red, blue, teal, gold'; write them as in"
            ' ["#200", "#f60", "#fff"]',
        ),
        (
            ColorsKind(3),
            ("red", "bleu"),
            'it[2] must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255, not'
            " 'bleu'; did you mean 'blue'?",
        ),
        (
            CurveKind({"linear": 1, "gamma": 2}),
            "gama",
            "it must be 'linear', 'gamma', or rising points [x, y] from x = 0 to x = 1, not 'gama'; did you"
            " mean 'gamma'?",
        ),
    ],
)  # fmt: skip
def test_a_value_that_breaks_a_rule_is_refused_in_a_sentence(
    kind: Kind, value: object, sentence: str
) -> None:
    assert refusal(kind, value) == sentence


@pytest.mark.parametrize(
    ("kind", "value", "holds"),
    [
        (Number(), np.float32(0.5), 0.5),
        (Number(at_least=0, at_most=1), 1, 1.0),
        (Number(endless=math.inf), math.inf, math.inf),
        (Whole(2, 9), np.int64(5), 5),
        (Boolean(), np.False_, False),
        (Text(may_be_empty=True), "", ""),
        (VectorKind(), np.array([1, 2, 3], np.float32), (1.0, 2.0, 3.0)),
        (VectorKind(), (0, 0, 0), (0.0, 0.0, 0.0)),
        (Reference("surfaces"), "body", "body"),
        (References("lights"), ["key", "rim"], ("key", "rim")),
        (References("lights"), [], ()),
        (Reference("lights", "eye"), "key", "key"),
        (Reference("lights", "eye"), "eye", "eye"),
        (ColorsKind(9), np.array([[0, 0, 0], [1, 2, 3]], np.uint8), ((0, 0, 0), (1, 2, 3))),
        (ColorsKind(9), "#200,rgb(1, 2, 3) , teal", ((34, 0, 0), (1, 2, 3), (0, 128, 128))),
        (ColorsKind(9), "['#200', \"#f60\"]", ((34, 0, 0), (255, 102, 0))),
        (CurveKind({"linear": 1}), "linear", "linear"),
        (CurveKind({"linear": 1}), [[0, 0], [1, 0.5]], ((0.0, 0.0), (1.0, 0.5))),
    ],
)
def test_a_value_is_held_in_one_type_whatever_it_came_in(kind: Kind, value: object, holds: object) -> None:
    found = accepted(kind, value)
    assert found == holds
    assert type(found) is type(holds)


@pytest.mark.parametrize(
    "value",
    [
        (1, 2), (1, 2, 3, 4), 3, "123", ("1", "2", "3"), (1, 2, math.nan), (1, 2, 1e37), (True, 0, 0), None,
        (1, 2, []), {"x": 1}, {1: 0, 2: 0, 3: 0}, {1, 2, 3}, b"abc",
    ],
)  # fmt: skip
def test_what_is_no_vector_is_refused(value: object) -> None:
    assert refusal(VectorKind(), value).startswith(
        f"it must be three finite numbers of at most 1e36, not {value!r}"
    )


def test_a_vector_without_its_brackets_is_told_how_to_be_written() -> None:
    advice = "it must be three finite numbers of at most 1e36, not '1,2,3'; write them as in [1, 2, 3]"
    assert refusal(VectorKind(), "1,2,3") == advice
    assert refusal(VectorKind(), (1, 2)).endswith("not (1, 2)")


@pytest.mark.parametrize(
    "points",
    [
        (), ((0, 0),), ((0, 0), (0.5, 1)), ((0, 0), (0.5, 0.2), (0.5, 0.3), (1, 1)), ((0, 1), (1, 0)),
        ((0, -1), (1, 1)), ((0, 0), (1, 2)), ((0, 0), (float("nan"), 0.5), (1, 1)), 3, ((0, 0, 0), (1, 1, 1)),
        (b"\0\0", b"\1\1"), ({0: 1, 0.5: 2}, {1: 1, 0.7: 2}),
    ],
)  # fmt: skip
def test_points_that_fall_or_do_not_span_the_range_are_no_curve(points: object) -> None:
    assert "or rising points [x, y] from x = 0 to x = 1, not" in refusal(CurveKind({"linear": 1}), points)


def test_a_number_of_thousands_of_digits_is_refused_without_writing_it() -> None:
    huge = 10**5000
    assert refusal(Whole(0, 9), huge) == "it must be a whole number from 0 to 9, not a very large int"
    assert refusal(Number(), huge) == "it must be a finite number, not a very large int"
    assert "a very large tuple" in refusal(VectorKind(), (huge, huge, huge))


KIND = AngleCurveKind(0.001, ((0.0, 0.04), (60.0, 0.1), (90.0, 1.0)))


@given(angle_curves())
def test_a_curve_is_held_as_it_is_whatever_lists_it_came_in(curve: AngleCurve) -> None:
    assert validated(KIND, [list(point) for point in curve]) == (curve, [])
    assert validated(KIND, np.array(curve)) == (curve, [])


def test_whole_numbers_become_floats() -> None:
    assert repr(validated(KIND, [[0, 1], [90, 0]])[0]) == "((0.0, 1.0), (90.0, 0.0))"


@pytest.mark.parametrize(
    "value",
    [
        "[[0, 1], [90, 1]]", 0.04, None, [], [[0, 1]], [[0, 1], [45, 1]], [[10, 1], [90, 1]],
        [[0, 0.0], [90, 1]], [[0, 0.0009], [90, 1]], [[0, 1], [90, 1.1]], [[0, 1], [40, -0.1], [90, 1]],
        [[0, 1], [40, 1], [40, 1], [90, 1]], [[0, 1], [50, 1], [40, 1], [90, 1]], [[0, 1, 2], [90, 1, 2]],
        [[0, 1], [float("nan"), 1], [90, 1]], [[0, True], [90, 1]], [[0, "1"], [90, 1]], {0: 1, 90: 1},
        ["ab", "cd"], [0, 90],
    ],
)  # fmt: skip
def test_what_is_no_curve_from_0_to_90_degrees_is_refused_with_an_example(value: object) -> None:
    found, (sentence,) = validated(KIND, value)
    assert found is REFUSED
    assert sentence.startswith(
        "it must be 2 to 91 points [angle, share], with angles that rise from 0 to 90 and shares from 0 to"
        " 1, the first at least 0.001, not "
    )
    assert sentence.endswith("; write them as in [[0.0, 0.04], [60.0, 0.1], [90.0, 1.0]]")


@given(st.integers(2, 200))
def test_a_curve_has_at_most_a_point_a_degree(count: int) -> None:
    points = [[angle, 0.5] for angle in np.linspace(0, 90, count)]
    assert (validated(KIND, points)[0] is REFUSED) == (count > MOST_POINTS)


RULE = 'it must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255'

PARTS = st.integers(0, 255)


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
    found, sentences = validated(ColorKind(), value)
    assert sentences == []
    assert found == color
    assert [type(part) for part in found] == [int, int, int]


@given(st.tuples(PARTS, PARTS, PARTS))
def test_a_color_in_digits_is_what_pillow_takes_it_for(color: tuple[int, int, int]) -> None:
    for text in (in_digits(color), in_digits(color).upper()):
        assert validated(ColorKind(), text) == (ImageColor.getrgb(text), [])


def test_every_name_that_pillow_knows_is_a_color() -> None:
    for name in ImageColor.colormap:
        assert validated(ColorKind(), name) == (ImageColor.getrgb(name), [])


@given(
    st.one_of(st.text(), st.from_regex(r"#[0-9a-f]{0,9}|(rgb|hsl|hsv|rgba)\([0-9%., ]*\)", fullmatch=True))
)
def test_any_text_is_a_color_in_range_or_refused_in_a_sentence(text: str) -> None:
    color, sentences = validated(ColorKind(), text)
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
        ("#ff1122ff", "'#ff1122ff', which has transparency; write '#ff1122'"),
        ("rgba(1, 2, 3, 256)", "'rgba(1, 2, 3, 256)'; keep its parts from 0 to 255, or from 0% to 100%"),
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
    color, sentences = validated(ColorKind(), value)
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
    color, sentences = validated(ColorKind(), value)
    assert color is REFUSED
    assert re.match(re.escape(f"{RULE}, not "), sentences[0])


def test_colors_in_digits_are_read_without_pillow() -> None:
    code = (
        "import sys; from autocolor.scene.surfaces import Paint; Paint('#102030', (1, 2, 3));"
        "print('PIL' in sys.modules); print(Paint('red').object_color, 'PIL' in sys.modules)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert ran.stdout == "False\n(255, 0, 0) True\n"


HALFWAY: list[tuple[Kind, object, object, object]] = [
    (Number(), 1.0, 4.0, 2.5),
    (Number(), -1e308, 1e308, 0.0),
    (Number(endless=math.inf), 1.0, math.inf, 1.0),
    (Number(endless=-math.inf), -math.inf, 1.0, -math.inf),
    (Whole(0, 9), 1, 2, 2),
    (Whole(-9, 9), -1, -2, -1),
    (Boolean(), False, True, False),
    (Text(), "a", "b", "a"),
    (OneOf(("off", "ordered")), "off", "ordered", "off"),
    (ColorKind(), (0, 0, 255), (255, 1, 0), (128, 1, 128)),
    (EndColor(), (0, 0, 0), (2, 4, 6), (1, 2, 3)),
    (VectorKind(), (0.0, 2.0, -4.0), (1.0, 2.0, 4.0), (0.5, 2.0, 0.0)),
    (LimitsKind(), (0.0, 1.0), (2.0, 5.0), (1.0, 3.0)),
    (PlaceKind(), (0.0, 1.0), (1.0, 0.5), (0.5, 0.75)),
    (CurveKind(CURVES), "linear", "gamma", "linear"),
    (CurveKind(CURVES), "linear", ((0.0, 0.0), (1.0, 1.0)), "linear"),
    (CurveKind(CURVES), ((0.0, 0.0), (1.0, 1.0)), ((0.0, 0.5), (1.0, 1.0)), ((0.0, 0.25), (1.0, 1.0))),
    (CurveKind(CURVES), ((0.0, 0.0), (1.0, 1.0)), ((0.0, 0.5), (0.5, 0.5), (1.0, 1.0)), HOLDS),
    (AngleCurveKind(0, CURVE), CURVE, ((0.0, 0.0), (90.0, 0.5)), ((0.0, 0.25), (90.0, 0.75))),
    (ScaleKind(), "viridis", "turbo", "viridis"),
    (ScaleKind(), ((0, 0, 0), (9, 9, 9)), ((4, 4, 4), (255, 9, 0)), ((2, 2, 2), (132, 9, 5))),
    (ScaleKind(), ((0, 0, 0), (9, 9, 9)), ((4, 4, 4), (9, 9, 9), (1, 1, 1)), HOLDS),
    (References("parts"), ("hood", "door"), ("roof", "door"), HOLDS),
    (Reference("parts"), "hood", "roof", "hood"),
    (RANGES, "auto", (("body", (0.0, 1.0)),), "auto"),
    (RANGES, (("body", (0.0, 1.0)),), (("body", (1.0, 2.0)),), (("body", (0.5, 1.5)),)),
    (RANGES, (("body", (0.0, 1.0)),), (("glass", (1.0, 2.0)),), HOLDS),
]  # fmt: skip
"""Kinds, two values, and the value halfway between them."""


@pytest.mark.parametrize(("kind", "one", "other", "halfway"), HALFWAY)
def test_the_kind_says_what_is_halfway_between_two_values(
    kind: Kind, one: object, other: object, halfway: object
) -> None:
    assert (accepted(kind, one), accepted(kind, other)) == (one, other)
    assert kind.between(one, other, 0.5) == (one if halfway is HOLDS else halfway)
    assert kind.between(one, one, 0.3) == one


@given(vectors(numbers(-9, 9)), directions(), st.floats(0.01, 0.99))
def test_a_direction_turns_evenly_by_the_shortest_way_and_its_length_is_linear(
    one: Vector, other: Vector, share: float
) -> None:
    if one == (0, 0, 0):
        return
    between = np.array(VectorKind(has_length=True).between(one, other, share))
    lengths = [float(np.linalg.norm(vector)) for vector in (one, other, between)]
    start, end, middle = (np.array(v) / size for v, size in zip((one, other, between), lengths, strict=True))
    assert lengths[2] == pytest.approx((1 - share) * lengths[0] + share * lengths[1])
    whole = math.atan2(float(np.linalg.norm(np.cross(start, end))), float(start @ end))
    # The turned angles add up to the whole angle only on the shortest way.
    for vector, angle in ((start, share * whole), (end, (1 - share) * whole)):
        turned = math.atan2(float(np.linalg.norm(np.cross(vector, middle))), float(vector @ middle))
        assert turned == pytest.approx(angle, abs=1e-7)


@pytest.mark.parametrize(
    ("one", "halfway"), [((2.0, 0.0, 0.0), (0.0, 0.0, 2.0)), ((0.0, 0.0, 2.0), (2.0, 0.0, 0.0))]
)
def test_opposite_directions_turn_through_the_vertical_or_x(one: Vector, halfway: Vector) -> None:
    x, y, z = one
    between = VectorKind(has_length=True).between(one, (-x, -y, -z), 0.5)
    assert between == pytest.approx(halfway)
