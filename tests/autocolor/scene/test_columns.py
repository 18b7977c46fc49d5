from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Light, Scene, Surface, View
from autocolor.scene.column_kinds import Number, Text
from autocolor.scene.columns import (
    REFUSED,
    Column,
    Problem,
    Row,
    RowError,
    Tier,
    changed,
    cost,
    fields_of,
    keys_of,
    made,
    plain,
)
from tests.autocolor.strategies import lights, scenes, surfaces, views


@dataclass(frozen=True)
class Span(Row):
    """A row with a rule between its columns, and alternatives."""

    noun: ClassVar[str] = "span"
    alternatives: ClassVar[tuple[str, ...]] = ("end", "length")

    name: Annotated[str, Column(Text(), Tier.NOTHING, "What it is called.")]
    begin: Annotated[float, Column(Number(), Tier.LIGHT, "Where it begins.")] = 0.0
    end: Annotated[float | None, Column(Number(), Tier.LIGHT, "Where it ends.")] = None
    length: Annotated[float | None, Column(Number(at_least=0), Tier.MIX, "How long it is.")] = None

    def rules(self) -> Iterator[Problem]:
        if self.end is not None and self.length is not None:
            yield Problem((), "it must have an end or a length, not both")
        if self.end is not None and self.begin > self.end:
            yield Problem(("begin",), f"must not be above the end, not {self.begin:g}")


def sentences(make: Any) -> tuple[str, ...]:
    with pytest.raises(RowError) as caught:
        make()
    return caught.value.problems


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


def test_a_refused_value_breaks_no_rule_again() -> None:
    assert REFUSED != REFUSED
    assert [REFUSED > 0, REFUSED < 0, REFUSED >= 0, REFUSED <= 0] == [False] * 4
    assert REFUSED is not None


def test_a_change_checks_what_it_changes_and_the_rules() -> None:
    span = Span("a", 1, 2)
    assert changed(span, {"begin": 1.5}) == Span("a", 1.5, 2)
    assert sentences(lambda: changed(span, {"begin": 3})) == (
        "span 'a': begin must not be above the end, not 3",
    )
    assert span == Span("a", 1, 2)


def test_giving_one_alternative_drops_the_others() -> None:
    span = Span("a", 1, 2)
    assert changed(span, {"length": 4}) == Span("a", 1, None, 4)
    assert changed(changed(span, {"length": 4}), {"end": 9}) == Span("a", 1, 9)
    assert changed(span, {"end": None}) == Span("a", 1)
    with pytest.raises(RowError, match="not both"):
        changed(span, {"end": 3, "length": 4})


def test_an_unknown_key_is_told_with_the_nearest_right_one() -> None:
    assert sentences(lambda: changed(Span("a"), {"beginn": 3, "x": 1})) == (
        "span 'a': there is no 'beginn'; did you mean 'begin'?",
        "span 'a': there is no 'x'; known are 'name', 'begin', 'end', 'length'",
    )


def test_a_change_keeps_nothing_that_was_computed_of_the_row() -> None:
    view = View((0, -5, 0), target=(0, 0, 0))
    forward = view.axes[2].tolist()
    turned = view.replace(target=(5, -5, 0))
    assert forward == [0, 1, 0]
    assert turned.axes[2].tolist() == [1, 0, 0]


def test_a_row_of_a_table_has_defaults_for_what_is_left_out() -> None:
    assert made(Span, {"name": "a", "end": 2}) == Span("a", end=2)


def test_what_is_missing_is_told_beside_what_is_wrong() -> None:
    assert sentences(lambda: made(Span, {"begin": "x", "z": 1})) == (
        "span: there is no 'z'; known are 'name', 'begin', 'end', 'length'",
        "span: name must be a string of at least one character, not missing; add it",
        "span: begin must be a finite number, not 'x'",
    )


@pytest.mark.parametrize("table", [None, 3, "x", [], [("name", "a")]])
def test_what_is_no_table_makes_no_row(table: object) -> None:
    assert sentences(lambda: made(Span, table)) == (
        f"must be a table of name, begin, end and length, not {table!r}",
    )


def test_a_table_of_very_many_keys_is_refused_at_once() -> None:
    assert sentences(lambda: made(Span, {f"key{number}": 0 for number in range(1000)})) == (
        "it must be a table of at most 64 keys, not 1,000",
    )


def test_problems_say_where_they_are() -> None:
    with pytest.raises(RowError) as caught:
        Light("key", (0, 0, 0), flaps={"z": {"on": 3}})  # type: ignore[arg-type]
    assert [problem.path for problem in caught.value.found] == [("flaps", "z", "on")]
    assert caught.value.row == "light 'key'"


@given(lights() | surfaces("body") | views())
def test_a_row_comes_back_from_its_plain_values(row: Row) -> None:
    assert made(type(row), plain(row)) == row


@given(scenes())
def test_plain_values_are_texts_numbers_switches_lists_and_tables(scene: Scene) -> None:
    def check(value: object) -> None:
        if isinstance(value, dict):
            assert all(isinstance(key, str) for key in value)
            for inner in value.values():
                check(inner)
        elif isinstance(value, (list, tuple)):
            for inner in value:
                check(inner)
        else:
            assert type(value) in (str, float, int, bool)
            assert value == value, "not a number"

    check(plain(scene))


def test_an_edit_costs_the_most_of_what_it_changes() -> None:
    span = Span("a", 1)
    assert cost(span, Span("a", 1)) is None
    assert cost(span, Span("b", 1)) == Tier.NOTHING
    assert cost(span, Span("a", 1, length=3)) == Tier.MIX
    assert cost(span, Span("b", 2, length=3)) == Tier.LIGHT
    assert cost(span, Surface("a"), Tier.LEVELS) == Tier.LEVELS


@pytest.mark.parametrize(
    ("change", "tier"),
    [
        ({"name": "hood"}, Tier.MIX),
        ({"exponent": 3}, Tier.LIGHT),
        ({"diffuse": 0.1}, Tier.MIX),
        ({"blend": 0.1}, Tier.ENTRIES),
        ({"object_color": "#102030"}, Tier.ENTRIES),
        ({"two_sided": False}, Tier.FRAME),
        ({"levels": 7}, Tier.LEVELS),
        ({"blend": 0.1, "diffuse": 0.1}, Tier.MIX),
    ],
)
def test_a_change_of_a_surface_costs_the_tier_of_its_column(change: dict[str, Any], tier: Tier) -> None:
    assert cost(Surface("body"), changed(Surface("body"), change)) == tier


@given(surfaces("body"), surfaces("body"))
def test_an_edit_costs_nothing_at_all_where_rows_are_equal(one: Surface, other: Surface) -> None:
    assert (cost(one, other) is None) == (one == other)
    assert cost(one, dataclasses.replace(one)) is None


@pytest.mark.parametrize("cls", [Flap, Light, Surface, View, Scene])
def test_every_column_has_a_line_of_help_that_is_a_sentence(cls: type[Row]) -> None:
    columns = [field.column for field in fields_of(cls).values()]
    for column in [*columns, *(key.column for key in keys_of(cls).values())]:
        assert column.help[0].isupper()
        assert column.help.endswith(".")
        assert "\n" not in column.help


@given(st.lists(st.sampled_from(["begin", "end", 0, 7]), max_size=4))
def test_a_problem_under_another_place_has_the_path_from_there(path: list[Any]) -> None:
    problem = Problem(("z",), "must be so").under(tuple(path))
    assert problem.path == (*path, "z")
    assert problem.sentence.endswith("z must be so")
