from __future__ import annotations

import pytest

from autocolor import Flap, Light, Scene, Surface, View
from autocolor.files.scenes.scene_meshes import MeshEntry
from autocolor.scene.columns.column import WORLD_UNITS, Column, Row, Tier, bar_of, fields_of, keys_of, on_bar
from autocolor.scene.columns.problems import Problem
from autocolor.scene.columns.value_kinds import Number, Whole
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


NUMBERS = [
    pytest.param(column, id=f"{cls.__name__}.{key}")
    for cls in (Flap, Light, Surface, View, Scene, MeshEntry)
    for key, (column, _, _) in keys_of(cls).items()
    if isinstance(column.kind, (Number, Whole))
]


@pytest.mark.parametrize("column", NUMBERS)
def test_every_number_has_a_bar_within_its_limits_or_is_measured_by_the_object(column: Column) -> None:
    bar = bar_of(column)
    assert (bar is None) == (column.unit == WORLD_UNITS)
    if bar is None:
        return
    assert bar.low < bar.high
    assert 10 <= (bar.high - bar.low) / bar.step <= 1000
    problems: list[Problem] = []
    for value in (bar.low, bar.high, bar.low + bar.step, bar.low - 1, 1e9, column.start or bar.high):
        column.kind.held(on_bar(column, value), (), problems)
    assert problems == []


@pytest.mark.parametrize("cls", [Flap, Light, Surface, View, Scene])
def test_a_number_that_may_be_absent_tells_what_it_starts_with(cls: type[Row]) -> None:
    for column, is_optional, default in fields_of(cls).values():
        bar = bar_of(column)
        if bar is None:
            assert column.start is None
        elif is_optional:
            assert column.start is not None
            assert bar.rounded(column.start) == column.start
        else:
            assert column.start is None
            assert default is not None
            value = default()
            assert isinstance(value, float)
            assert bar.low <= value <= bar.high


def test_a_value_on_a_bar_is_of_the_type_that_its_column_holds() -> None:
    levels, cone = keys_of(Surface)["levels"].column, keys_of(Light)["cone_angle"].column
    assert (on_bar(levels, 63.6), type(on_bar(levels, 63.6))) == (64, int)
    assert (on_bar(cone, 29.6), type(on_bar(cone, 29.6))) == (30.0, float)
    assert on_bar(Column(Number(), Tier.FRAME, "The place.", WORLD_UNITS), 1.234) == 1.234
