"""Lines of a journal as statements that are never run."""

from __future__ import annotations

import pytest

from autocolor import UsageError
from autocolor.journal.lines import called, dotted, expression_of, plain_value, value_of


def test_a_call_is_told_by_its_name_its_arguments_and_its_keywords() -> None:
    line = "studio.scene.with_light('key', position=[1, -2.5, 1e999], on=False)"
    call = called(expression_of(line), line)
    assert call.name == "studio.scene.with_light"
    assert [plain_value(each, line) for each in call.arguments] == ["key"]
    values = {key: plain_value(value, line) for key, value in call.keywords.items()}
    assert values == {"position": [1, -2.5, float("inf")], "on": False}


def test_the_value_of_an_assignment_is_that_of_one_name() -> None:
    assert plain_value(value_of("checksum = '9f'", "checksum"), "") == "9f"
    for line in ("other = 1", "checksum = other = 1", "checksum", "checksum += 1"):
        with pytest.raises(UsageError, match="it must be a call that autocolor writes"):
            value_of(line, "checksum")


@pytest.mark.parametrize("line", ["f()(1)", "[].append(1)", "f(*[1])", "f(**{})", "f", "1"])
def test_what_is_no_call_of_a_name_is_refused(line: str) -> None:
    with pytest.raises(UsageError):
        called(expression_of(line), line)


def test_a_name_with_dots_is_told_and_nothing_else_is() -> None:
    assert dotted(expression_of("scene.mesh"), "") == "scene.mesh"
    with pytest.raises(UsageError):
        dotted(expression_of("scene().mesh"), "")
