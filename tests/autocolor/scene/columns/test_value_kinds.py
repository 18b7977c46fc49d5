from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.columns.column import Kind
from autocolor.scene.columns.problems import REFUSED, Problem
from autocolor.scene.columns.reference_kinds import Reference, References, WordOrName
from autocolor.scene.columns.value_kinds import (
    Choice,
    CurveKind,
    Instance,
    Number,
    Switch,
    Text,
    VectorKind,
    Whole,
)


def held(kind: Kind, value: object) -> tuple[Any, list[str]]:
    """What a kind holds of a value, and the sentences of its problems."""
    problems: list[Problem] = []
    return kind.held(value, ("it",), problems), [problem.sentence for problem in problems]


def refusal(kind: Kind, value: object) -> str:
    """The one sentence with which a kind refuses a value."""
    result, sentences = held(kind, value)
    assert result is REFUSED
    (sentence,) = sentences
    return sentence


def accepted(kind: Kind, value: object) -> Any:
    """What a kind holds of a value that it accepts."""
    result, sentences = held(kind, value)
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
        (Switch(), 1, "it must be true or false, not 1"),
        (Switch(), None, "it must be true or false, not None"),
        (Text(), "", "it must be a string of at least one character, not ''"),
        (Text(may_be_empty=True), 3, "it must be a string, not 3"),
        (Choice(("on", "off")), "of", "it must be 'on' or 'off', not 'of'; did you mean 'off'?"),
        (Choice(("surface", "object")), 3, "it must be 'surface' or 'object', not 3"),
        (VectorKind(has_length=True), (0, 0, 0), "it must not be zero, not (0, 0, 0); give it a length"),
        (Reference("surfaces"), 3, "it must be a string of at least one character, not 3"),
        (References("lights"), "key", "it must be a list of names, not 'key'"),
        (References("lights"), ["key", 3], "it must be a list of names, not ['key', 3]"),
        (WordOrName("lights", "eye"), 3, "it must be 'eye' or the name of one of the lights, not 3"),
        (Instance(dict), [], "it must be a dict, not []"),
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
        (Switch(), np.False_, False),
        (Text(may_be_empty=True), "", ""),
        (VectorKind(), np.array([1, 2, 3], np.float32), (1.0, 2.0, 3.0)),
        (VectorKind(), (0, 0, 0), (0.0, 0.0, 0.0)),
        (Reference("surfaces"), "body", "body"),
        (References("lights"), ["key", "rim"], ("key", "rim")),
        (References("lights"), [], ()),
        (WordOrName("lights", "eye"), "key", "key"),
        (WordOrName("lights", "eye"), "eye", "eye"),
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
