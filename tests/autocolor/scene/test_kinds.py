from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import ImageColor

from autocolor.checks import Vector, shown
from autocolor.scene.columns import REFUSED, Kind, Problem, RowError
from autocolor.scene.curves import CURVES
from autocolor.scene.kinds import (
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
)
from autocolor.scene.row_kinds import (
    RangesByName,
    Reference,
    References,
)
from autocolor.scene.scalar import EndColor, LimitsKind, PlaceKind, ScaleKind
from autocolor.testing import directions, numbers, vectors
from tests.tables import refused

NAN, INF = math.nan, math.inf
CURVE: AngleCurve = ((0.0, 0.5), (90.0, 1.0))
ANGLES = AngleCurveKind(0.001, ((0.0, 0.04), (60.0, 0.1), (90.0, 1.0)))
CURVED = CurveKind({"linear": 1, "gamma": 2})
RANGES = RangesByName("surfaces", "object", "auto")
HUGE = 10**5000
"""A number that Python does not write in digits."""


def accepted(given: tuple[Kind[Any], Any]) -> Any:
    """The value that a kind makes of a value. Raises RowError with all of its problems."""
    kind, value = given
    problems: list[Problem] = []
    result = kind.validated(value, ("it",), problems)
    assert (result is REFUSED) == bool(problems)
    if problems:
        raise RowError(problems)
    return result


COLOR = 'it must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255, not '
NO_COLORS = '; write them as in ["#200", "#fff"]'
SENTENCES: list[tuple[tuple[Kind[Any], Any], str]] = [
    ((Number(), 10**400), f"it must be a finite number, not {shown(10**400)}"),
    ((Number(), HUGE), "it must be a finite number, not a very large int"),
    ((Number(at_least=0), -1), "it must be a finite number of at least 0, not -1"),
    ((Number(at_least=0, at_most=1), 1.1), "it must be a number from 0 to 1, not 1.1"),
    ((Number(at_least=0, above=True), 0), "it must be a number above 0, not 0"),
    ((Number(0, 180, above=True), 181), "it must be a number above 0 and at most 180, not 181"),
    ((Number(endless=INF), -INF), "it must be a finite number, not -inf"),
    ((Whole(2, 9), 1), "it must be a whole number from 2 to 9, not 1"),
    ((Whole(2, 9), HUGE), "it must be a whole number from 2 to 9, not a very large int"),
    ((Boolean(), 1), "it must be true or false, not 1"),
    ((Text(), ""), "it must be a string of at least one character, not ''"),
    ((Text(may_be_empty=True), 3), "it must be a string, not 3"),
    ((OneOf(("on", "off")), "of"), "it must be 'on' or 'off', not 'of'; did you mean 'off'?"),
    ((OneOf(("on", "off")), ["on"]), "it must be 'on' or 'off', not ['on']"),
    ((VectorKind(), (1, 2)), "it must be three finite numbers of at most 1e36, not (1, 2)"),
    (
        (VectorKind(), "1,2,3"),
        "it must be three finite numbers of at most 1e36, not '1,2,3'; write them as in [1, 2, 3]",
    ),
    (
        (VectorKind(has_length=True), (0, 0, 0)),
        "it must be three finite numbers of at most 1e36, not (0, 0, 0); one of them must not be 0",
    ),
    ((Reference("surfaces"), 3), "it must be a string of at least one character, not 3"),
    ((Reference("lights", "eye"), 3), "it must be 'eye' or the name of a light, not 3"),
    ((References("lights"), "key"), "it must be a list of names, not 'key'"),
    ((Instance(dict), []), "it must be a dict, not []"),
    ((LimitsKind(), (1, 1)), "it must be two finite numbers, the second above the first, not (1, 1)"),
    ((PlaceKind(), (0, 2)), "it must be two numbers from 0 to 1, not (0, 2)"),
    (
        (RANGES, "49 %"),
        "it must be 'auto', a percentage such as '99.5 %' from 50 to 100, or a table of ranges [minimum,"
        " maximum] from 0 to 3.4e38 by the names of surfaces and 'object', not '49 %'",
    ),
    (
        (CURVED, "gama"),
        "it must be 'linear', 'gamma', or rising points [x, y] from x = 0 to x = 1, not 'gama'; did you mean"
        " 'gamma'?",
    ),
    (
        (ANGLES, 0.04),
        "it must be 2 to 91 points [angle, share], with angles that rise from 0 to 90 and shares from 0 to 1,"
        " the first at least 0.001, not 0.04; write them as in [[0.0, 0.04], [60.0, 0.1], [90.0, 1.0]]",
    ),
    (
        (ScaleKind(), "virids"),
        "it must be the name of a color scale, or a list of 2 to 256 colors, not 'virids'; did you mean"
        " 'viridis'?",
    ),
    ((ScaleKind(), "red, grean"), COLOR.replace("it", "it[2]") + "'grean'; did you mean 'green'?"),
    ((ColorsKind(3), ["red"]), f"it must be a list of 2 to 3 colors, not ['red']{NO_COLORS}"),
    (
        (ColorsKind(3), "red, blue, teal, gold"),
        f"it must be a list of 2 to 3 colors, not 'red, blue, teal, gold'{NO_COLORS}",
    ),
    ((ColorsKind(3), ("red", "bleu")), COLOR.replace("it", "it[2]") + "'bleu'; did you mean 'blue'?"),
    *(
        ((ColorKind(), value), f"{COLOR}{shown(value)}{advice}")
        for value, advice in (
            ("rde", "; did you mean 'red'?"),
            ("Grean", "; did you mean 'green'?"),
            ("xyzzy", '; write it as in "#b01020"'),
            ("0a10ff", '; write it as in "#b01020"'),
            ("k", '; write it as in "#b01020"'),
            ("", '; write it as in "#b01020"'),
            ("#12", "; write three or six hexadecimal digits after the #"),
            ("#12345", "; write three or six hexadecimal digits after the #"),
            ("#ff1122ff", ", which has transparency; write '#ff1122'"),
            ("#1238", ", which has transparency; write '#112233'"),
            ("rgba(1, 2, 3, 4)", ", which has transparency; write '#010203'"),
            ("rgba(1, 2, 3, 256)", "; keep its parts from 0 to 255, or from 0% to 100%"),
            ("rgb(300, 0, 0)", "; keep its parts from 0 to 255, or from 0% to 100%"),
            ("hsl(0, 200%, 50%)", "; keep its parts from 0 to 255, or from 0% to 100%"),
            ((1.0, 0, 0), "; write [255, 0, 0]"),
            ((0.5, 0.25, 0), "; write [128, 64, 0]"),
            ((10.0, 16.0, 255.0), ""),
        )
    ),
]
"""Kinds, values that they refuse, and the sentences."""

test_a_value_that_breaks_the_rule_of_its_kind_is_refused = refused(accepted, SENTENCES)

REFUSED_VALUES: list[tuple[Kind[Any], list[Any]]] = [
    (Number(), [NAN, INF, True, np.True_, "3", b"3", None, [], {}, 1j]),
    (Number(at_least=0, at_most=1), [-0.1, NAN, INF]),
    (Whole(2, 9), [10, 2.0, True, dict, {"x": 1}]),
    (Boolean(), [None, "true", 0]),
    (References("lights"), [["key", 3], ["", "key"], {"key"}]),
    (
        VectorKind(),
        [
            (1, 2), (1, 2, 3, 4), 3, "123", ("1", "2", "3"), (1, 2, NAN), (True, 0, 0), None, (1, 2, []),
            (0, 0, math.nextafter(1e36, INF)), (0, -math.nextafter(1e36, INF), 0), {"x": 1},
            {1: 0, 2: 0, 3: 0}, {1, 2, 3}, b"abc", (HUGE, HUGE, HUGE),
        ],
    ),
    (LimitsKind(), [(2, 1), (0, NAN), (0, INF), (1,), "12", 5, (1, 2, 3), {0, 1}, {0: 1, 1: 2}, b"\0\1"]),
    (PlaceKind(), [(-0.1, 0), (0,), "01", (0, 0, 0), {0, 1}, {0: 1, 1: 2}, b"\0\1"]),
    (
        RANGES,
        [
            "100.5 %", "99.555 %", "99.5", "99,5 %", "-60 %", "5e1 %", "99  %", "none", {}, 3,
            {"body": [1, 1]}, {"body": [2, 1]}, {"body": [-1, 1]}, {"body": [0, 1e39]}, {"": [0, 1]},
            [("body", (0, 1)), ("body", (0, 1))],
        ],
    ),
    (
        CURVED,
        [
            (), ((0, 0),), ((0, 0), (0.5, 1)), ((0.1, 0), (1, 1)), ((0, 0), (0.5, 0.2), (0.5, 0.3), (1, 1)),
            ((0, 1), (1, 0)), ((0, -1), (1, 1)), ((0, 0), (1, 2)), ((0, 0), (NAN, 0.5), (1, 1)), 3,
            ((0, 0, 0), (1, 1, 1)), (b"\0\0", b"\1\1"), ({0: 1, 0.5: 2}, {1: 1, 0.7: 2}),
        ],
    ),
    (
        ANGLES,
        [
            "[[0, 1], [90, 1]]", None, [], [[0, 1]], [[0, 1], [45, 1]], [[10, 1], [90, 1]],
            [[0, 0.0], [90, 1]], [[0, 0.0009], [90, 1]], [[0, 1], [90, 1.1]], [[0, 1], [40, -0.1], [90, 1]],
            [[0, 1], [40, 1], [40, 1], [90, 1]], [[0, 1], [50, 1], [40, 1], [90, 1]],
            [[0, 1, 2], [90, 1, 2]], [[0, 1], [NAN, 1], [90, 1]], [[0, True], [90, 1]], [[0, "1"], [90, 1]],
            {0: 1, 90: 1}, ["ab", "cd"], [0, 90], [[angle, 0.5] for angle in np.linspace(0, 90, 92)],
        ],
    ),
    (
        ColorKind(),
        [
            "#0a10ff\n", "red\n", " red", "#0a 10f", "#0a10 f", "#0a10fg", "#\uff10a10ff", "rgb(\uff11,2,3)",
            b"#0a10ff", (1, 2), (1, 2, 3, 4), (1, 2, 256), (-1, 2, 3), (True, False, True), 7, None,
            {1, 2, 3}, {1: 0, 2: 0, 3: 0}, f"rgb({'0' * 91}1,2,3)", ("1", "2", "3"), np.array(3),
            np.eye(3, dtype=int),
        ],
    ),
    (ColorsKind(3), [{"red", "blue"}, {"red": 1, "blue": 2}, 5]),
    (ScaleKind(), ["jet", [(1, 2, 3)], [(1, 2, 3)] * 257, 5, None]),
]  # fmt: skip
"""Kinds, and further values that they refuse by their rules."""


@pytest.mark.parametrize(
    ("kind", "value"), [(kind, value) for kind, values in REFUSED_VALUES for value in values]
)
def test_what_is_no_value_of_a_kind_is_refused_by_its_rule(kind: Kind[Any], value: object) -> None:
    with pytest.raises(RowError) as caught:
        accepted((kind, value))
    (problem,) = caught.value.row_problems
    assert problem.sentence.startswith(f"it {kind.rule()}, not {shown(value)}")


def test_all_color_scales_but_the_reversed_ones_are_named_where_none_is_near() -> None:
    advice = ScaleKind().advice("jet")
    assert advice.startswith("; choose 'viridis', ")
    assert "'coolwarm'" in advice
    assert "_r'" not in advice


RED_AND_BLUE = ((255, 0, 0), (0, 0, 255))
ACCEPTED: list[tuple[Kind[Any], Any, Any]] = [
    (Number(), np.float32(0.5), 0.5),
    (Number(at_least=0, at_most=1), 1, 1.0),
    (Number(at_least=0, at_most=1), 0, 0.0),
    (Number(endless=INF), INF, INF),
    (Whole(2, 9), np.int64(2), 2),
    (Whole(2, 9), 9, 9),
    (Boolean(), np.False_, False),
    (Text(may_be_empty=True), "", ""),
    (VectorKind(), np.array([1, 2, 3], np.float32), (1.0, 2.0, 3.0)),
    (VectorKind(), (0, 1e36, -1e36), (0.0, 1e36, -1e36)),
    (VectorKind(), (0, 0, 0), (0.0, 0.0, 0.0)),
    (Reference("surfaces"), "body", "body"),
    (Reference("lights", "eye"), "key", "key"),
    (References("lights"), ["key", "rim"], ("key", "rim")),
    (References("lights"), [], ()),
    (LimitsKind(), [0, np.int64(1)], (0.0, 1.0)),
    (PlaceKind(), [0, 1], (0.0, 1.0)),
    (RANGES, "auto", "auto"),
    (RANGES, "99.50%", "99.5 %"),
    (RANGES, "50 %", "50 %"),
    (RANGES, "100.00 %", "100 %"),
    (RANGES, {"body": [0, 2], "object": [1, 3]}, (("body", (0.0, 2.0)), ("object", (1.0, 3.0)))),
    (CURVED, "linear", "linear"),
    (CURVED, [[0, 0], [1, 0.5]], ((0.0, 0.0), (1.0, 0.5))),
    (ANGLES, [[0, 1], [90, 0]], ((0.0, 1.0), (90.0, 0.0))),
    (ColorKind(), "#0a10ff", (10, 16, 255)),
    (ColorKind(), "#0A10FF", (10, 16, 255)),
    (ColorKind(), [10, 16, 255], (10, 16, 255)),
    (ColorKind(), np.array([10, 16, 255], np.uint8), (10, 16, 255)),
    (ColorKind(), "DarkSlateGray", (47, 79, 79)),
    (ColorKind(), "#b12", (187, 17, 34)),
    (ColorKind(), "rgb(10%, 20%, 30%)", (26, 51, 77)),
    (ColorKind(), f"rgb({'0' * 90}1,2,3)", (1, 2, 3)),
    (ColorKind(), "hsl(120, 100%, 50%)", (0, 255, 0)),
    (ColorsKind(9), np.array([[0, 0, 0], [1, 2, 3]], np.uint8), ((0, 0, 0), (1, 2, 3))),
    (ColorsKind(9), "#200,rgb(1, 2, 3) , teal", ((34, 0, 0), (1, 2, 3), (0, 128, 128))),
    (ColorsKind(9), "['#200', \"#f60\"]", ((34, 0, 0), (255, 102, 0))),
    (ScaleKind(), "viridis_r", "viridis_r"),
    (ScaleKind(), ["red", "#00f"], RED_AND_BLUE),
    (ScaleKind(), "[red, '#00f']", RED_AND_BLUE),
    (ScaleKind(), [(1, 2, 3)] * 256, ((1, 2, 3),) * 256),
    (EndColor(), "red", (255, 0, 0)),
]  # fmt: skip
"""Kinds, values, and what they are converted to."""


@pytest.mark.parametrize(("kind", "value", "converted"), ACCEPTED)
def test_a_value_is_held_in_one_type_whatever_it_came_in(
    kind: Kind[Any], value: object, converted: Any
) -> None:
    result = accepted((kind, value))
    assert result == converted
    # The types of components are seen in how they are written.
    assert repr(result) == repr(converted)


def test_every_name_that_pillow_knows_is_a_color() -> None:
    for name in ImageColor.colormap:
        assert accepted((ColorKind(), name)) == ImageColor.getrgb(name)


COLOR_TEXTS = st.one_of(
    st.text(),
    st.text("0123456789abcdef", max_size=9).map("#{}".format),
    st.builds(
        "{}({})".format, st.sampled_from(["rgb", "hsl", "hsv", "rgba"]), st.text("0159%., ", max_size=14)
    ),
)


@given(COLOR_TEXTS)
def test_any_text_is_a_color_in_range_or_refused_in_a_sentence(text: str) -> None:
    problems: list[Problem] = []
    color: Any = ColorKind().validated(text, ("it",), problems)
    if color is REFUSED:
        assert [problem.sentence.startswith(COLOR) for problem in problems] == [True]
    else:
        assert len(color) == 3
        assert all(0 <= part <= 255 for part in color)


HOLDS: Any = object()
"""The first of two values."""

HALFWAY: list[tuple[Kind[Any], object, object, object]] = [
    (Number(), 1.0, 4.0, 2.5),
    (Number(), -1e308, 1e308, 0.0),
    (Number(endless=INF), 1.0, INF, HOLDS),
    (Number(endless=-INF), -INF, 1.0, HOLDS),
    (Whole(0, 9), 1, 2, 2),
    (Whole(-9, 9), -1, -2, -1),
    (Boolean(), False, True, HOLDS),
    (Text(), "a", "b", HOLDS),
    (OneOf(("off", "ordered")), "off", "ordered", HOLDS),
    (ColorKind(), (0, 0, 255), (255, 1, 0), (128, 1, 128)),
    (EndColor(), (0, 0, 0), (2, 4, 6), (1, 2, 3)),
    (VectorKind(), (0.0, 2.0, -4.0), (1.0, 2.0, 4.0), (0.5, 2.0, 0.0)),
    (LimitsKind(), (0.0, 1.0), (2.0, 5.0), (1.0, 3.0)),
    (PlaceKind(), (0.0, 1.0), (1.0, 0.5), (0.5, 0.75)),
    (CurveKind(CURVES), "linear", "gamma", HOLDS),
    (CurveKind(CURVES), "linear", ((0.0, 0.0), (1.0, 1.0)), HOLDS),
    (CurveKind(CURVES), ((0.0, 0.0), (1.0, 1.0)), ((0.0, 0.5), (1.0, 1.0)), ((0.0, 0.25), (1.0, 1.0))),
    (CurveKind(CURVES), ((0.0, 0.0), (1.0, 1.0)), ((0.0, 0.5), (0.5, 0.5), (1.0, 1.0)), HOLDS),
    (AngleCurveKind(0, CURVE), CURVE, ((0.0, 0.0), (90.0, 0.5)), ((0.0, 0.25), (90.0, 0.75))),
    (ScaleKind(), "viridis", "turbo", HOLDS),
    (ScaleKind(), "viridis", ((0, 0, 0), (9, 9, 9)), HOLDS),
    (ScaleKind(), ((0, 0, 0), (9, 9, 9)), ((4, 4, 4), (255, 9, 0)), ((2, 2, 2), (132, 9, 5))),
    (ScaleKind(), ((0, 0, 0), (9, 9, 9)), ((4, 4, 4), (9, 9, 9), (1, 1, 1)), HOLDS),
    (References("parts"), ("hood", "door"), ("roof", "door"), HOLDS),
    (Reference("parts"), "hood", "roof", HOLDS),
    (RANGES, "auto", (("body", (0.0, 1.0)),), HOLDS),
    (RANGES, (("body", (0.0, 1.0)),), (("body", (1.0, 2.0)),), (("body", (0.5, 1.5)),)),
    (RANGES, (("body", (0.0, 1.0)),), (("glass", (1.0, 2.0)),), HOLDS),
]  # fmt: skip
"""Kinds, two values, and the value halfway between them."""


@pytest.mark.parametrize(("kind", "one", "other", "halfway"), HALFWAY)
def test_the_kind_says_what_is_halfway_between_two_values(
    kind: Kind[Any], one: object, other: object, halfway: object
) -> None:
    assert (accepted((kind, one)), accepted((kind, other))) == (one, other)
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
