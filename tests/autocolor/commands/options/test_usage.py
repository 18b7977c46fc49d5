from __future__ import annotations

import pytest

from autocolor.commands.options.usage import as_usage
from autocolor.errors import InputError, MissingInputError, UsageError


def test_every_problem_of_a_value_from_the_command_line_is_told_as_wrong_usage() -> None:
    with pytest.raises(UsageError) as caught, as_usage("--set: "):
        raise InputError(["a must be 1, not 2", "b must be 3, not 4"])
    assert str(caught.value) == "--set: a must be 1, not 2\n--set: b must be 3, not 4"
    assert caught.value.exit_code == 2


def test_any_other_error_stays_as_it_is() -> None:
    with pytest.raises(ZeroDivisionError), as_usage():
        raise ZeroDivisionError
    with pytest.raises(UsageError), as_usage():
        raise MissingInputError("none of your business")
