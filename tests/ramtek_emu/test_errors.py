from __future__ import annotations

import inspect

import pytest

import ramtek_emu
from ramtek_emu import errors

TREE = [
    error for _, error in inspect.getmembers(errors, inspect.isclass) if issubclass(error, errors.RamtekError)
]
CODES = {
    "RamtekError": 70,
    "ConfigurationError": 2,
    "WordsError": 65,
    "ColorsError": 65,
    "InstructionError": 65,
    "ReplyError": 65,
    "ListingError": 65,
    "SnapshotError": 65,
    "MissingInputError": 66,
    "NoScreenError": 69,
    "PortError": 69,
    "OutputError": 73,
    "OutputExistsError": 73,
    "WriteError": 74,
}


def test_each_refusal_leaves_with_its_exit_code() -> None:
    assert {error.__name__: error.exit_code for error in TREE} == CODES


@pytest.mark.parametrize("error", TREE)
def test_every_error_is_public_and_a_ramtek_error(error: type[errors.RamtekError]) -> None:
    assert issubclass(error, errors.RamtekError)
    assert getattr(ramtek_emu, error.__name__) is error


@pytest.mark.parametrize(
    ("error", "built_in"),
    [
        ("WordsError", ValueError),
        ("ReplyError", LookupError),
        ("PortError", ConnectionError),
        ("NoScreenError", RuntimeError),
        ("OutputExistsError", FileExistsError),
        ("WriteError", OSError),
    ],
)
def test_a_refusal_is_caught_by_the_error_of_python_that_it_is_like(
    error: str, built_in: type[Exception]
) -> None:
    with pytest.raises(built_in, match="sentence"):
        raise getattr(errors, error)("sentence")
