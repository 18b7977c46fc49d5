from __future__ import annotations

import difflib
from operator import attrgetter

import pytest

import autocolor
from autocolor import Light, Surface
from autocolor.checks import FUNCTIONS, MOST_COMPARED, closest, nearest, printable, shown
from tests.small import cube


@pytest.mark.parametrize(
    ("name", "known", "clause"),
    [
        ("boddy", ["body", "glass"], "; did you mean 'body'?"),
        ("gl", ["body", "glass"], "; did you mean 'glass'?"),
        ("xyz", ["body", "glass"], "; choose 'body' or 'glass'"),
        ("xyz", [], ""),
        ("xyz", ["a"] * 20, f"; choose {', '.join(19 * [repr('a')])} or 'a'"),
        ("xyz", ["a"] * 21, ""),
        # A key that is no text is not the nearest name.
        ("bodi", [0, None, "body"], "; did you mean 'body'?"),
        ("xyz", [0, (1, 2)], ""),
        # A long name is compared by its first letters.
        ("b" * 1_000_000, ["body", "glass"], "; choose 'body' or 'glass'"),
        # A word of a name, and a symbol of the paper, mean the whole name.
        ("color", ["blend", "object_color", "light_color"], "; did you mean 'object_color'?"),
        ("angle", ["aim", "cone_angle"], "; did you mean 'cone_angle'?"),
        ("N", ["name", "exponent"], "; did you mean 'exponent'?"),
        ("C", ["cone_angle", "concentration"], "; did you mean 'concentration'?"),
        ("fov", ["eye", "field_of_view"], "; did you mean 'field_of_view'?"),
        ("colour", ["blend", "object_color"], "; did you mean 'object_color'?"),
        ("N", ["Nose"], "; did you mean 'Nose'?"),
        ("brightness", ["intensity", "on"], "; did you mean 'intensity'?"),
        ("blend", ["name", "paint.blend"], "; did you mean 'paint.blend'?"),
        ("BODY", ["bodywork", "body"], "; did you mean 'body'?"),
        ("conc", ["cone_angle", "concentration"], "; did you mean 'concentration'?"),
    ],
)
def test_the_nearest_right_name_is_told(name: str, known: list[object], clause: str) -> None:
    assert nearest(name, known) == clause


ELSEWHERE = "a light has no color here: set the surface's light_color"


@pytest.mark.parametrize(
    ("owner", "name", "answer"),
    [
        (
            autocolor,
            "load",
            "module 'autocolor' has no attribute 'load'; did you mean 'autocolor.read_scene'?",
        ),
        (
            autocolor,
            "read_scen",
            "module 'autocolor' has no attribute 'read_scen'; did you mean 'read_scene'?",
        ),
        (
            Light("key", (0, 0, 0)),
            "save",
            "'Light' object has no attribute 'save'; did you mean 'autocolor.save_image',"
            " 'autocolor.write_scene' or 'autocolor.write_picture'?",
        ),
        (Light("key", (0, 0, 0)), "color", f"'Light' object has no attribute 'color'; {ELSEWHERE}"),
        (Light("key", (0, 0, 0)), "_name", "'Light' object has no attribute '_name'"),
        (Light("key", (0, 0, 0)), "__array__", "'Light' object has no attribute '__array__'"),
        (
            Surface("body"),
            "object_color",
            "'Surface' object has no attribute 'object_color'; did you mean 'paint.object_color'?",
        ),
        (cube(), "vertices", "'Mesh' object has no attribute 'vertices'; did you mean 'coordinates'?"),
    ],
)
def test_an_unknown_attribute_is_answered_by_the_name_that_was_meant(
    owner: object, name: str, answer: str
) -> None:
    with pytest.raises(AttributeError) as caught:
        getattr(owner, name)
    assert str(caught.value) == answer
    # Python adds a suggestion of its own to an error with an object.
    assert caught.value.name == name
    assert not hasattr(owner, name)


def test_the_functions_that_are_suggested_exist() -> None:
    for name in {name for names in FUNCTIONS.values() for name in names}:
        assert callable(attrgetter(name)(autocolor))


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
