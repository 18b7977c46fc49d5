from __future__ import annotations

import pytest

from autocolor import Flap, Light, Scene, Surface, View
from autocolor.scene.columns.column import Row, fields_of, keys_of
from tests.autocolor.scene.columns.spans import Span, sentences


def test_a_row_holds_its_values_as_its_kinds_do() -> None:
    span = Span("a", 1, 2)
    assert (span.begin, type(span.begin)) == (1.0, float)
    assert span.length is None


def test_every_problem_of_a_row_is_told_with_its_noun_and_name() -> None:
    assert sentences(lambda: Span("a", "x", "y")) == (  # type: ignore[arg-type]
        "span 'a': begin must be a finite number, not 'x'",
        "span 'a': end must be a finite number, not 'y'",
    )
    assert sentences(lambda: Span("", 0)) == (
        "span: name must be a string of at least one character, not ''",
    )


def test_a_rule_between_columns_is_checked_beside_a_value_that_is_refused() -> None:
    assert sentences(lambda: Span("a", "x", 3, 4)) == (  # type: ignore[arg-type]
        "span 'a': begin must be a finite number, not 'x'",
        "span 'a': it must have an end or a length, not both",
    )
    assert sentences(lambda: Span("a", 5, 3)) == ("span 'a': begin must not be above the end, not 5",)


@pytest.mark.parametrize("cls", [Flap, Light, Surface, View, Scene])
def test_every_column_has_a_line_of_help_that_is_a_sentence(cls: type[Row]) -> None:
    columns = [field.column for field in fields_of(cls).values()]
    for column in [*columns, *(key.column for key in keys_of(cls).values())]:
        assert column.help[0].isupper()
        assert column.help.endswith(".")
        assert "\n" not in column.help
