from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import pytest

from autocolor.scene.columns.column import Column, Row, Tier, keys_of
from autocolor.scene.columns.reference_kinds import Reference
from autocolor.scene.columns.row_kinds import Nested, Rows, Variant
from autocolor.scene.columns.rows import changed, made, plain
from autocolor.scene.columns.value_kinds import (
    Number,
    Switch,
    Text,
)


@dataclass(frozen=True)
class Round(Row):
    """A model with one parameter."""

    radius: Annotated[float, Column(Number(at_least=0), Tier.LIGHT, "How large it is.")] = 1.0


@dataclass(frozen=True)
class Square(Row):
    """Another one, with a parameter of the same name."""

    side: Annotated[float, Column(Number(at_least=0), Tier.LIGHT, "How long a side is.")] = 2.0
    turn: Annotated[float, Column(Number(), Tier.MIX, "How it is turned.")] = 0.0


@dataclass(frozen=True)
class Shape(Row):
    """What is inline."""

    weight: Annotated[float, Column(Number(at_least=0), Tier.MIX, "How heavy it is.")] = 1.0
    model: Annotated[Row, Column(Variant({"round": Round, "square": Square}), Tier.LIGHT, "Its form.")] = (
        Round()
    )


@dataclass(frozen=True)
class Lid(Row):
    """What is a table of its own."""

    noun: ClassVar[str] = "lid"

    open: Annotated[bool, Column(Switch(), Tier.ENTRIES, "Whether it is open.")] = False


@dataclass(frozen=True)
class Box(Row):
    """A row with rows inside."""

    noun: ClassVar[str] = "box"

    name: Annotated[str, Column(Text(), Tier.NOTHING, "What it is called.")]
    shape: Annotated[Shape, Column(Nested(Shape, inline=True), Tier.LIGHT, "Its shape.")] = Shape()
    lid: Annotated[Lid | None, Column(Nested(Lid), Tier.ENTRIES, "Its lid.")] = None
    beside: Annotated[str | None, Column(Reference("boxes"), Tier.NOTHING, "Another box.")] = None


@dataclass(frozen=True)
class Stack(Row):
    """A row with a table."""

    boxes: Annotated[tuple[Box, ...], Column(Rows(Box, by_name=True), Tier.FRAME, "The boxes.")] = ()


def sentences(make: Any) -> tuple[str, ...]:
    """What a row error says."""
    with pytest.raises(ValueError) as caught:  # noqa: PT011
        make()
    return tuple(str(caught.value).splitlines())


def test_the_keys_of_inline_rows_stand_among_those_around_them() -> None:
    assert list(keys_of(Box)) == ["name", "weight", "model", "radius", "side", "turn", "lid", "beside"]
    box = made(Box, {"name": "a", "weight": 3, "model": "square", "turn": 5, "lid": {"open": True}})
    assert box == Box("a", Shape(3.0, Square(turn=5.0)), Lid(True))
    assert plain(box) == {
        "name": "a", "weight": 3.0, "model": "square", "side": 2.0, "turn": 5.0, "lid": {"open": True},
    }  # fmt: skip
    assert made(Box, plain(box)) == box


def test_another_variant_begins_with_its_own_defaults() -> None:
    box = Box("a", Shape(model=Round(4)))
    assert changed(box, {"radius": 5}).shape.model == Round(5.0)
    assert changed(box, {"model": "square"}).shape.model == Square()
    assert changed(box, {"model": "square", "side": 3}).shape.model == Square(3.0)
    assert changed(box, {"model": Square(7)}).shape.model == Square(7.0)
    assert changed(changed(box, {"model": "square"}), {"model": "round"}).shape.model == Round()


def test_a_key_of_another_variant_is_refused_by_name() -> None:
    assert sentences(lambda: changed(Box("a"), {"turn": 5})) == (
        "box 'a': turn must go with model = 'square', not with 'round'; leave it out, or change the other",
    )
    assert sentences(lambda: changed(Box("a"), {"model": "squar"})) == (
        "box 'a': model must be 'round' or 'square', not 'squar'; did you mean 'square'?",
    )


def test_problems_inside_are_told_with_the_keys_that_lead_there() -> None:
    assert sentences(
        lambda: made(Box, {"name": "a", "weight": -1, "radius": "x", "lid": {"open": 1, "opn": 2}})
    ) == (
        "box 'a': radius must be a finite number of at least 0, not 'x'",
        "box 'a': weight must be a finite number of at least 0, not -1",
        "box 'a': lid: there is no 'opn'; did you mean 'open'?",
        "box 'a': lid.open must be true or false, not 1",
    )


def test_a_table_for_a_row_that_is_there_changes_its_fields_and_else_makes_one() -> None:
    assert changed(Box("a"), {"lid": {"open": True}}).lid == Lid(True)
    assert changed(Box("a", lid=Lid(True)), {"lid": {}}).lid == Lid(True)
    assert changed(Box("a", lid=Lid(True)), {"lid": None}).lid is None
    assert sentences(lambda: changed(Box("a"), {"lid": 3})) == (
        "box 'a': lid must be a table of open, not 3",
    )


def test_a_table_holds_rows_whose_names_differ() -> None:
    stack = made(Stack, {"boxes": [{"name": "a"}, Box("b")]})
    assert stack.boxes == (Box("a"), Box("b"))
    assert plain(stack)["boxes"] == [plain(Box("a")), plain(Box("b"))]
    assert sentences(lambda: Stack((Box("a"), Box("b"), Box("a")))) == (
        "boxes[3].name must be unique, not the same as boxes[1]; rename it",
    )
    assert sentences(lambda: made(Stack, {"boxes": [{"name": "a", "weight": -1}, 3]})) == (
        "boxes[1].weight must be a finite number of at least 0, not -1",
        "boxes[2] must be a table of name, weight, model, radius, side, turn, lid and beside, not 3",
    )
    assert sentences(lambda: made(Stack, {"boxes": {}})) == ("boxes must be a list of Box rows, not {}",)
