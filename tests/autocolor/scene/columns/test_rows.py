from __future__ import annotations

import dataclasses
from typing import Any

import pytest
from hypothesis import given

from autocolor import Scene, Surface, View
from autocolor.scene.columns.column import Row, Tier
from autocolor.scene.columns.problems import RowError
from autocolor.scene.columns.rows import changed, cost, difference, made, plain
from tests.autocolor.scene.columns.spans import Span, sentences
from tests.autocolor.strategies import lights, scenes, surfaces, views


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
        "span: it must be a table of at most 64 keys, not 1,000",
    )


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


@given(scenes(), scenes())
def test_a_difference_makes_of_one_row_the_other_and_of_equal_ones_is_empty(one: Scene, other: Scene) -> None:
    rows: list[tuple[Row, Row]] = [
        (one.view, other.view),
        *zip(one.surfaces, other.surfaces, strict=True),
        *zip(one.lights, other.lights, strict=False),
    ]
    for before, after in rows:
        told = difference(before, after)
        assert changed(before, told) == after
        assert bool(told) == (before != after)
        assert difference(after, changed(after, {})) == {}
        assert "name" not in told or vars(before)["name"] != vars(after)["name"]


def test_a_difference_tells_what_was_taken_away() -> None:
    assert difference(Span("a", 1, 2), Span("b", 1)) == {"name": "b", "end": None}
