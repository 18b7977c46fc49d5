from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.column_kinds import (
    Choice,
    ColorKind,
    CurveKind,
    Instance,
    Nested,
    Number,
    PointOrName,
    Reference,
    References,
    Rows,
    Switch,
    Text,
    Variant,
    VectorKind,
    Whole,
    references_of,
)
from autocolor.scene.columns import REFUSED, Column, Kind, Problem, Row, Tier, changed, keys_of, made, plain


def held(kind: Kind, value: object) -> tuple[Any, list[str]]:
    """What a kind holds of a value, and the sentences of its problems."""
    problems: list[Problem] = []
    return kind.held(value, ("it",), problems), [problem.sentence for problem in problems]


def refusal(kind: Kind, value: object) -> str:
    """The one sentence with which a kind refuses a value."""
    result, sentences = held(kind, value)
    assert result is REFUSED
    (sentence,) = sentences
    return sentence


def accepted(kind: Kind, value: object) -> Any:
    """What a kind holds of a value that it accepts."""
    result, sentences = held(kind, value)
    assert sentences == []
    return result


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_finite_number_is_held_unchanged(number: float) -> None:
    assert accepted(Number(), number) == number


@pytest.mark.parametrize("value", [math.nan, math.inf, True, np.True_, "3", b"3", None, [], {}, 1j, 10**400])
def test_what_is_no_finite_number_is_refused(value: object) -> None:
    shown = "true" if value is True else repr(value)[:60] + ("..." if len(repr(value)) > 60 else "")
    assert refusal(Number(), value) == f"it must be a finite number, not {shown}"


@pytest.mark.parametrize(
    ("kind", "value", "sentence"),
    [
        (Number(at_least=0), -1, "it must be a finite number of at least 0, not -1"),
        (Number(at_least=0, at_most=1), 1.1, "it must be a number from 0 to 1, not 1.1"),
        (Number(at_least=0, above=True), 0, "it must be a number above 0, not 0"),
        (Number(0, 180, above=True), 181, "it must be a number above 0 and at most 180, not 181"),
        (Number(endless=math.inf), -math.inf, "it must be a finite number, not -inf"),
        (Whole(2), 1, "it must be a whole number of at least 2, not 1"),
        (Whole(2), 2.0, "it must be a whole number of at least 2, not 2.0"),
        (Whole(0), True, "it must be a whole number of at least 0, not true"),
        (Switch(), 1, "it must be true or false, not 1"),
        (Switch(), None, "it must be true or false, not None"),
        (Text(), "", "it must be a string of at least one character, not ''"),
        (Text(may_be_empty=True), 3, "it must be a string, not 3"),
        (Choice(("on", "off")), "of", "it must be 'on' or 'off', not 'of'; did you mean 'off'?"),
        (Choice(("surface", "object")), 3, "it must be 'surface' or 'object', not 3"),
        (VectorKind(has_length=True), (0, 0, 0), "it must not be zero, not (0, 0, 0); give it a length"),
        (Reference("surfaces"), 3, "it must be a string of at least one character, not 3"),
        (References("lights"), "key", "it must be a list of names, not 'key'"),
        (References("lights"), ["key", 3], "it must be a list of names, not ['key', 3]"),
        (PointOrName("lights"), 3, "it must be three finite numbers of at most 1e36, or a name, not 3"),
        (Instance(dict), [], "it must be a dict, not []"),
        (
            CurveKind({"linear": 1, "gamma": 2}),
            "gama",
            "it must be 'linear', 'gamma', or rising points [x, y] from x = 0 to x = 1, not 'gama'; did you"
            " mean 'gamma'?",
        ),
    ],
)  # fmt: skip
def test_a_value_that_breaks_a_rule_is_refused_in_a_sentence(
    kind: Kind, value: object, sentence: str
) -> None:
    assert refusal(kind, value) == sentence


@pytest.mark.parametrize(
    ("kind", "value", "holds"),
    [
        (Number(), np.float32(0.5), 0.5),
        (Number(at_least=0, at_most=1), 1, 1.0),
        (Number(endless=math.inf), math.inf, math.inf),
        (Whole(2), np.int64(5), 5),
        (Switch(), np.False_, False),
        (Text(may_be_empty=True), "", ""),
        (VectorKind(), np.array([1, 2, 3], np.float32), (1.0, 2.0, 3.0)),
        (VectorKind(), (0, 0, 0), (0.0, 0.0, 0.0)),
        (Reference("surfaces"), "body", "body"),
        (References("lights"), ["key", "rim"], ("key", "rim")),
        (References("lights"), [], ()),
        (PointOrName("lights"), "key", "key"),
        (PointOrName("lights"), [1, 2, 3], (1.0, 2.0, 3.0)),
        (CurveKind({"linear": 1}), "linear", "linear"),
        (CurveKind({"linear": 1}), [[0, 0], [1, 0.5]], ((0.0, 0.0), (1.0, 0.5))),
    ],
)
def test_a_value_is_held_in_one_type_whatever_it_came_in(kind: Kind, value: object, holds: object) -> None:
    found = accepted(kind, value)
    assert found == holds
    assert type(found) is type(holds)


@pytest.mark.parametrize(
    "value",
    [
        (1, 2), (1, 2, 3, 4), 3, "123", ("1", "2", "3"), (1, 2, math.nan), (1, 2, 1e37), (True, 0, 0), None,
        (1, 2, []), {"x": 1},
    ],
)  # fmt: skip
def test_what_is_no_vector_is_refused(value: object) -> None:
    assert refusal(VectorKind(), value) == f"it must be three finite numbers of at most 1e36, not {value!r}"


@pytest.mark.parametrize(
    "value", ["#0a10ff", "#0A10FF", (10, 16, 255), [10.0, 16.0, 255.0], np.array([10, 16, 255])]
)
def test_a_color_is_a_text_or_three_whole_numbers(value: object) -> None:
    assert accepted(ColorKind(), value) == (10, 16, 255)


@pytest.mark.parametrize(
    "value",
    [
        "red", "#fff", "0a10ff", "#0a10ff\n", "#0a 10f", "#0a10 f", "#0a10fg", "#\uff10a10ff", "", b"#0a10ff",
        (1, 2), (1, 2, 256), (-1, 2, 3), (0.5, 1, 2), (True, False, True), 7, None,
    ],
)  # fmt: skip
def test_what_is_no_color_is_refused(value: object) -> None:
    rule = 'it must be "#rrggbb" or three whole numbers from 0 to 255'
    assert refusal(ColorKind(), value) == f"{rule}, not {value!r}"


@pytest.mark.parametrize(
    "points",
    [
        (), ((0, 0),), ((0, 0), (0.5, 1)), ((0, 0), (0.5, 0.2), (0.5, 0.3), (1, 1)), ((0, 1), (1, 0)),
        ((0, -1), (1, 1)), ((0, 0), (1, 2)), ((0, 0), (float("nan"), 0.5), (1, 1)), 3, ((0, 0, 0), (1, 1, 1)),
    ],
)  # fmt: skip
def test_points_that_fall_or_do_not_span_the_range_are_no_curve(points: object) -> None:
    assert "or rising points [x, y] from x = 0 to x = 1, not" in refusal(CurveKind({"linear": 1}), points)


def test_names_that_refer_to_other_rows_are_found() -> None:
    assert Reference("surfaces").names_in("body") == ("body",)
    assert References("lights").names_in(("key", "rim")) == ("key", "rim")
    assert PointOrName("lights").names_in("key") == ("key",)
    assert PointOrName("lights").names_in((1.0, 2.0, 3.0)) == ()


# Rows inside rows.


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
        "box 'a': model must be 'round', 'square', not 'squar'; did you mean 'square'?",
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


def test_columns_that_refer_to_other_tables_are_known() -> None:
    assert {name: kind.table for name, kind in references_of(Box).items()} == {"beside": "boxes"}
