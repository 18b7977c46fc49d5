from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.checks import finite, listed, nearest, shown


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
    ("value", "text"),
    [
        (True, "true"),
        (False, "false"),
        (None, "None"),
        (1.5, "1.5"),
        ("body", "'body'"),
        ([1, 2], "[1, 2]"),
        ("x" * 100, repr("x" * 60) + "..."),
        (list(range(100)), repr(list(range(100)))[:60] + "..."),
    ],
)
def test_a_value_is_shown_as_it_is_written_and_cut_where_it_is_long(value: object, text: str) -> None:
    assert shown(value) == text


def test_names_are_listed_as_in_a_sentence() -> None:
    assert listed(["x"]) == "x"
    assert listed(["x", "y", "z"]) == "x, y and z"
