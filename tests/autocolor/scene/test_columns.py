from __future__ import annotations

import dataclasses
import math
import pickle
from collections.abc import Iterator
from typing import Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Light, Scene, Surface, View
from autocolor.files.scene_toml.scene_meshes import MeshEntry
from autocolor.scene.columns import (
    WORLD_UNITS,
    Column,
    Problem,
    Row,
    RowError,
    Tier,
    cost,
    difference,
    fields_of,
    from_plain,
    keys_of,
    replaced,
)
from autocolor.scene.kinds import Number, Whole, number, text
from autocolor.scene.row_kinds import table_row
from autocolor.testing import scenes
from tests.autocolor.strategies import of_mesh
from tests.small import wall_scene
from tests.tables import call, refused

NUMBERS = [
    pytest.param(column, id=f"{cls.__name__}.{key}")
    for cls in (Flap, Light, Surface, View, Scene, MeshEntry)
    for key, (column, _) in keys_of(cls).items()
    if isinstance(column.kind, (Number, Whole))
]


@table_row
class Span(Row):
    """A row with a rule between its columns, and alternatives."""

    noun: ClassVar[str] = "span"
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (("end",), ("length",))

    name: str = text(tier=Tier.NOTHING, help="What it is called.")
    begin: float = number(default=0.0, tier=Tier.LIGHT, help="Where it begins.")
    end: float | None = number(default=None, tier=Tier.LIGHT, help="Where it ends.")
    length: float | None = number(default=None, at_least=0, tier=Tier.MIX, help="How long it is.")

    def rules(self) -> Iterator[Problem]:
        if self.end is not None and self.length is not None:
            yield Problem((), "it must have an end or a length, not both")
        if self.end is not None and self.begin > self.end:
            yield Problem(("begin",), f"must not be above the end, not {self.begin:g}")


@pytest.mark.parametrize("column", NUMBERS)
def test_every_number_has_a_bar_within_its_limits_or_is_measured_by_the_object(column: Column) -> None:
    bar = column.bar
    assert (bar is None) == (column.unit == WORLD_UNITS)
    if bar is None:
        return
    assert bar.low < bar.high
    assert 10 <= (bar.high - bar.low) / bar.step <= 1000
    problems: list[Problem] = []
    for value in (bar.low, bar.high, bar.low + bar.step, bar.low - 1, 1e9, column.start or bar.high):
        column.kind.validated(type(bar.low)(min(max(value, bar.low), bar.high)), (), problems)
    assert problems == []


@pytest.mark.parametrize("cls", [Flap, Light, Surface, View, Scene])
def test_a_number_that_may_be_absent_tells_what_it_starts_with(cls: type[Row]) -> None:
    for column in fields_of(cls).values():
        bar = column.bar
        if bar is None:
            assert column.start is None
        elif column.is_optional:
            assert column.start is not None
            assert bar.low <= column.start <= bar.high
            assert column.start / bar.step == pytest.approx(round(column.start / bar.step))
        else:
            assert column.start is None
            assert isinstance(column.default, float)
            assert bar.low <= column.default <= bar.high


def test_each_of_64_unknown_keys_is_a_problem() -> None:
    with pytest.raises(RowError) as caught:
        from_plain(Span, {"name": "a", **{f"key{number}": 0 for number in range(63)}})
    assert len(caught.value.row_problems) == 63


def test_problems_say_where_they_are() -> None:
    with pytest.raises(RowError) as caught:
        Light("key", (0, 0, 0), flaps={"z": {"on": 3}})  # type: ignore[arg-type]
    assert [problem.path for problem in caught.value.row_problems] == [("flaps", "z", "on")]
    assert caught.value.row == "light 'key'"


def test_an_error_can_be_sent_to_another_process() -> None:
    with pytest.raises(RowError) as caught:
        Light("key", (1, 2), intensity=-1)  # type: ignore[arg-type]
    error = caught.value
    copy = pickle.loads(pickle.dumps(error))
    assert (copy.problems, copy.row_problems, copy.row) == (error.problems, error.row_problems, error.row)


def test_giving_one_alternative_drops_the_others() -> None:
    span = Span("a", 1, 2)
    assert replaced(span, {"length": 4}) == Span("a", 1, None, 4)
    assert replaced(replaced(span, {"length": 4}), {"end": 9}) == Span("a", 1, 9)
    assert replaced(span, {"end": None}) == Span("a", 1)
    assert span == from_plain(Span, {"name": "a", "begin": 1, "end": 2.0})
    assert difference(span, Span("b", 1)) == {"name": "b", "end": None}
    # Without the key, a limit would stay.
    assert difference(Flap(1, 2), Flap(1)) == {"maximum": math.inf}


def test_a_change_keeps_nothing_that_was_computed_of_the_row() -> None:
    view = View((0, -5, 0), target=(0, 0, 0))
    forward = view.axes[2].tolist()
    turned = view.replace(target=(5, -5, 0))
    assert forward == [0, 1, 0]
    assert turned.axes[2].tolist() == [1, 0, 0]


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
        ({"base_reflectance": 0.04}, Tier.LIGHT),
        ({"refractive_index": 1.5}, Tier.LIGHT),
        ({"fresnel_curve": [[0, 0.04], [90, 1]]}, Tier.LIGHT),
        ({"diffuse": 0.1}, Tier.MIX),
        ({"blend": 0.1}, Tier.ENTRIES),
        ({"object_color": "#102030"}, Tier.ENTRIES),
        ({"two_sided": False}, Tier.FRAME),
        ({"levels": 7}, Tier.LEVELS),
        ({"blend": 0.1, "diffuse": 0.1}, Tier.MIX),
    ],
)
def test_a_change_of_a_surface_costs_the_tier_of_its_column(change: dict[str, Any], tier: Tier) -> None:
    assert cost(Surface("body"), replaced(Surface("body"), change)) == tier


@given(scenes(), scenes())
def test_a_difference_makes_of_one_row_the_other_and_of_equal_ones_is_empty(one: Scene, other: Scene) -> None:
    rows: list[tuple[Row, Row]] = [
        (one.view, other.view),
        *zip(one.surfaces, other.surfaces, strict=True),
        *zip(one.lights, other.lights, strict=False),
    ]
    for before, after in rows:
        told = difference(before, after)
        assert replaced(before, told) == after
        assert bool(told) == (before != after)
        assert difference(after, replaced(after, {})) == {}
        assert "name" not in told or vars(before)["name"] != vars(after)["name"]


def values_in(row: Row) -> Iterator[tuple[Column, object]]:
    """All values of a row and of the rows inside it, with their columns."""
    for name, field in fields_of(type(row)).items():
        value = vars(row)[name]
        yield field, value
        for inner in value if isinstance(value, tuple) else (value,):
            if isinstance(inner, Row):
                yield from values_in(inner)


@given(scenes(), scenes(), st.floats(0.01, 0.99))
def test_between_two_rows_every_value_is_valid(one: Scene, other: Scene, share: float) -> None:
    other = of_mesh(other, one.mesh)
    between = one.between(other, share)
    for column, value in values_in(between):
        if value is not None:
            problems: list[Problem] = []
            assert column.kind.validated(value, (), problems) == value
            assert problems == []
    assert one.between(dataclasses.replace(one), share).equals(one)


def test_a_column_that_is_absent_in_one_of_two_rows_holds() -> None:
    one, other = Surface("body", levels=10), Surface("body")
    assert (one.between(other, 0.9).levels, other.between(one, 0.9).levels) == (10, None)
    assert one.between(Surface("body", levels=20), 0.5).levels == 15


def test_alternatives_hold_until_the_next_row_uses_another_group() -> None:
    red, ramp = Surface("body").replace(object_color="red"), Surface("body").replace(ramp=["red", "blue"])
    assert red.between(ramp, 0.9).paint == red.paint
    assert ramp.between(red, 0.9).paint == ramp.paint
    assert ramp.between(ramp.replace(ramp=["blue", "red"]), 0.5).paint.ramp == ((128, 0, 128),) * 2
    light = Light("key", (0, 0, 0), direction=(1, 0, 0))
    aimed = light.replace(aim=(0, 9, 0), position=(2, 0, 0))
    between = light.between(aimed, 0.5)
    assert (between.direction, between.aim, between.position) == ((1, 0, 0), None, (1, 0, 0))


def test_a_row_of_another_class_and_tables_of_other_rows_hold() -> None:
    phong, cook = Surface("body"), Surface("body").replace(model="cook-torrance")
    assert phong.between(cook, 0.9).reflectance == phong.reflectance
    lights = [Light("key", (0, 0, 0)), Light("rim", (2, 0, 0))]
    scene = wall_scene(lights=lights)
    moved = scene.with_light("rim", position=(4, 0, 0))
    assert scene.between(moved, 0.5).lights["rim"].position == (3, 0, 0)
    assert scene.between(moved.without_light("key"), 0.5).lights is scene.lights


NO_FIELD = "there is no field"
MISSING = "must be a string of at least one character, not"

test_rows_that_break_a_rule_are_refused_with_every_problem_and_their_noun_and_name = refused(
    call,
    [
        (
            lambda: Span("a", "x", "y"),  # type: ignore[arg-type]
            "span 'a': begin must be a finite number, not 'x'\n"
            "span 'a': end must be a finite number, not 'y'",
        ),
        (lambda: Span("", 0), f"span: name {MISSING} ''"),
        # A rule between columns is checked beside a value that is refused.
        (
            lambda: Span("a", "x", 3, 4),  # type: ignore[arg-type]
            "span 'a': begin must be a finite number, not 'x'\n"
            "span 'a': it must have an end or a length, not both",
        ),
        (lambda: Span("a", 5, 3), "span 'a': begin must not be above the end, not 5"),
        (
            lambda: replaced(Span("a", 1, 2), {"begin": 3}),
            "span 'a': begin must not be above the end, not 3",
        ),
        (
            lambda: replaced(Span("a"), {"beginn": 3, "x": 1}),
            f"span 'a': {NO_FIELD} 'beginn'; did you mean 'begin'?\n"
            f"span 'a': {NO_FIELD} 'x'; choose 'name', 'begin', 'end' or 'length'",
        ),
        (
            lambda: from_plain(Span, {"begin": "x", "z": 1}),
            f"span: {NO_FIELD} 'z'; choose 'name', 'begin', 'end' or 'length'\n"
            f"span: name {MISSING} missing; add it\n"
            "span: begin must be a finite number, not 'x'",
        ),
        (
            lambda: from_plain(Span, [("name", "a")]),
            "must be a table of name, begin, end and length, not [('name', 'a')]",
        ),
        (
            lambda: from_plain(Span, {f"key{number}": 0 for number in range(65)}),
            "span: it must be a table of at most 64 keys, not 65",
        ),
    ],
)
