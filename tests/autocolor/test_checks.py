from __future__ import annotations

import difflib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.checks import MOST_COMPARED, closest, listed, nearest, printable, shown


def test_the_nearest_right_name_is_told() -> None:
    assert nearest("boddy", ["body", "glass"]) == "; did you mean 'body'?"
    assert nearest("gl", ["body", "glass"]) == "; did you mean 'glass'?"
    assert nearest("xyz", ["body", "glass"]) == "; choose 'body' or 'glass'"
    assert nearest("xyz", []) == ""


def test_a_key_that_is_no_text_is_not_the_nearest_name() -> None:
    assert nearest("bodi", [0, None, "body"]) == "; did you mean 'body'?"
    assert nearest("xyz", [0, (1, 2)]) == ""


def test_a_name_of_a_million_letters_is_compared_by_its_first() -> None:
    assert nearest("b" * 1_000_000, ["body", "glass"]) == "; choose 'body' or 'glass'"


def test_the_spelling_of_few_names_is_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    compared: list[str] = []

    def compare(name: str, names: list[str], n: int) -> list[str]:
        compared.extend(names)
        return []

    monkeypatch.setattr(difflib, "get_close_matches", compare)
    nearest("grille", [f"part {number}" for number in range(100_000)])
    assert len(compared) == MOST_COMPARED


def test_a_name_is_compared_by_its_first_200_letters() -> None:
    # The rest of the candidate is too long for a similar spelling; only the beginning can be the same.
    rest = "y" * 1000
    assert closest("a" * 200 + "z", ["a" * 200 + rest])
    assert not closest("a" * 199 + "z", ["a" * 199 + rest])


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


def test_letters_that_cannot_be_printed_become_question_marks() -> None:
    assert printable("two\nlines, ü\x1b[1m\udcff") == "two?lines, ü?[1m?"


def test_names_are_listed_as_in_a_sentence() -> None:
    assert listed(["x"]) == "x"
    assert listed(["x", "y", "z"]) == "x, y and z"


@pytest.mark.parametrize(
    ("name", "known", "meant"),
    [
        ("color", ["blend", "object_color", "light_color"], "object_color"),
        ("angle", ["aim", "cone_angle"], "cone_angle"),
        ("N", ["name", "exponent"], "exponent"),
        ("C", ["cone_angle", "concentration"], "concentration"),
        ("fov", ["eye", "field_of_view"], "field_of_view"),
        ("colour", ["blend", "object_color"], "object_color"),
        ("N", ["Nose"], "Nose"),
        ("BODY", ["bodywork", "body"], "body"),
        ("conc", ["cone_angle", "concentration"], "concentration"),
    ],
)
def test_a_word_of_a_name_and_a_symbol_of_the_paper_mean_the_whole_name(
    name: str, known: list[str], meant: str
) -> None:
    assert nearest(name, known) == f"; did you mean {meant!r}?"
