from __future__ import annotations

import inspect

import pytest

import autocolor
from autocolor import errors
from autocolor.errors import AutocolorError, InputError, MissingInputError

TREE = [each for _, each in inspect.getmembers(errors, inspect.isclass) if issubclass(each, AutocolorError)]
CODES = {
    "AutocolorError": 70,
    "UsageError": 2,
    "InputError": 65,
    "MissingInputError": 66,
    "UnavailableError": 69,
    "OutputError": 73,
    "WriteError": 74,
}


def test_each_error_is_public_and_has_its_exit_code() -> None:
    assert {each.__name__: each.exit_code for each in TREE} == CODES
    assert [getattr(autocolor, each.__name__) for each in TREE] == TREE
    values = [each.__name__ for each in TREE if issubclass(each, ValueError)]
    assert values == ["InputError", "MissingInputError", "UsageError"]


@pytest.mark.parametrize("error", TREE)
def test_an_error_reads_as_its_sentence_and_not_as_its_letters(error: type[AutocolorError]) -> None:
    assert str(error("ambient must be a number, not \t'x'")) == "ambient must be a number, not \\t'x'"
    assert InputError("one, two").problems == ("one, two",)


def test_several_problems_are_kept_in_order_and_stand_on_lines_of_their_own() -> None:
    error = MissingInputError(f"{name}: there is no such file" for name in ("b.obj", "a.obj"))
    assert error.problems == ("b.obj: there is no such file", "a.obj: there is no such file")
    assert str(error).splitlines() == list(error.problems)
