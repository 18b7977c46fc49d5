from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Light, View
from autocolor.checks import color, finite, known_fields, nearest, switch, vector, with_checked


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_finite_number_passes_unchanged(number: float) -> None:
    problems: list[str] = []
    assert finite(problems, "it", number) == number
    assert not problems


@pytest.mark.parametrize("value", [math.nan, math.inf, True, "3", b"3", None, [], 1j, 10**400])
def test_what_is_no_finite_number_is_named(value: object) -> None:
    problems: list[str] = []
    finite(problems, "ambient", value)
    assert problems == [f"ambient must be a finite number, not {value!r}"]


@pytest.mark.parametrize(("value", "fine"), [(0, True), (1.0, True), (-0.1, False), (1.1, False)])
def test_a_number_beyond_a_bound_is_named_with_both_bounds(value: float, fine: bool) -> None:
    problems: list[str] = []
    finite(problems, "blend", value, at_least=0, at_most=1)
    assert problems == ([] if fine else [f"blend must be a number from 0 to 1, not {value!r}"])


@pytest.mark.parametrize(
    "value", [(1, 2, 3), [1.0, 2.0, 3.0], np.array([1, 2, 3]), np.array([1, 2, 3], np.float32)]
)
def test_three_numbers_of_any_kind_are_a_vector(value: object) -> None:
    problems: list[str] = []
    assert vector(problems, "eye", value) == (1.0, 2.0, 3.0)
    assert not problems


@pytest.mark.parametrize(
    "value",
    [
        (1, 2),
        (1, 2, 3, 4),
        3,
        "123",
        ("1", "2", "3"),
        (1, 2, math.nan),
        (1, 2, 1e37),
        (True, 0, 0),
        None,
        (1, 2, []),
    ],
)
def test_what_is_no_vector_is_named(value: object) -> None:
    problems: list[str] = []
    vector(problems, "eye", value)
    assert problems == [f"eye must be three finite numbers of at most 1e36, not {value!r}"]


def test_a_direction_without_length_is_refused() -> None:
    problems: list[str] = []
    vector(problems, "direction", (0, 0, 0), not_zero=True)
    assert problems == ["direction must not be zero, not (0, 0, 0); give it a length"]


@pytest.mark.parametrize(
    "value", ["#0a10ff", "#0A10FF", (10, 16, 255), [10.0, 16.0, 255.0], np.array([10, 16, 255])]
)
def test_a_color_is_a_text_or_three_whole_numbers(value: object) -> None:
    problems: list[str] = []
    assert color(problems, "object_color", value) == (10, 16, 255)
    assert not problems


@pytest.mark.parametrize(
    "value",
    [
        "red",
        "#fff",
        "0a10ff",
        "#0a10ff\n",
        "#0a 10f",
        "#0a10 f",
        "#0a10fg",
        "#\uff10a10ff",
        "",
        b"#0a10ff",
        (1, 2),
        (1, 2, 256),
        (-1, 2, 3),
        (0.5, 1, 2),
        (True, False, True),
        7,
        None,
    ],
)
def test_what_is_no_color_is_named(value: object) -> None:
    problems: list[str] = []
    color(problems, "object_color", value)
    assert problems == [f'object_color must be "#rrggbb" or three whole numbers from 0 to 255, not {value!r}']


def test_a_switch_is_true_or_false_and_nothing_else() -> None:
    problems: list[str] = []
    for value in (True, False, 0, 1, "on", None):
        switch(problems, "on", value)
    assert problems == [f"on must be true or false, not {value!r}" for value in (0, 1, "on", None)]


def test_the_nearest_right_name_is_told() -> None:
    assert nearest("boddy", ["body", "glass"]) == "; did you mean 'body'?"
    assert nearest("gl", ["body", "glass"]) == "; did you mean 'glass'?"
    assert nearest("xyz", ["body", "glass"]) == "; known are 'body', 'glass'"
    assert nearest("xyz", []) == ""


@given(st.text(), st.lists(st.text()))
def test_any_name_gets_a_clause_or_none(name: str, names: list[str]) -> None:
    clause = nearest(name, names)
    assert clause == "" or clause.startswith("; ")


@pytest.mark.parametrize(
    ("cls", "changes", "sentence"),
    [
        (View, {"eyes": 1}, "place: there is no 'eyes'; did you mean 'eye'?"),
        (Light, {"intensty": 1}, "place: there is no 'intensty'; did you mean 'intensity'?"),
    ],
)
def test_an_unknown_field_is_refused_by_name(cls: type, changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputError) as refusal:
        known_fields(cls, changes, "place")
    assert str(refusal.value) == sentence


def test_a_row_with_checked_values_shares_all_others() -> None:
    view = View((1, 2, 3), target=(0, 0, 0), field_of_view=40)
    turned = with_checked(view, {"angle": 5.0})
    assert turned == view.replace(angle=5)
    assert turned.eye is view.eye
    assert view.angle == 0
