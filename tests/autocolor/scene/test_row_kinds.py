from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Part, Surface
from autocolor.errors import InputError
from autocolor.scene.columns import (
    Column,
    Row,
    Tier,
    cost,
    difference,
    from_plain,
    keys_of,
    replaced,
    to_plain,
)
from autocolor.scene.kinds import Boolean, Number, Text
from autocolor.scene.lights import HalfSpace, Links
from autocolor.scene.row_kinds import (
    MOST_NAMED_ROWS,
    Nested,
    OneRowOf,
    Reference,
    References,
    RowList,
    references_of,
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
    model: Annotated[Row, Column(OneRowOf({"round": Round, "square": Square}), Tier.LIGHT, "Its form.")] = (
        Round()
    )


@dataclass(frozen=True)
class Lid(Row):
    """What is a table of its own."""

    noun: ClassVar[str] = "lid"

    open: Annotated[bool, Column(Boolean(), Tier.ENTRIES, "Whether it is open.")] = False


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

    boxes: Annotated[tuple[Box, ...], Column(RowList(Box, by_name=True), Tier.FRAME, "The boxes.")] = ()


def sentences(make: Any) -> tuple[str, ...]:
    """What a row error says."""
    with pytest.raises(ValueError) as caught:  # noqa: PT011
        make()
    return tuple(str(caught.value).splitlines())


def test_the_keys_of_inline_rows_stand_among_those_around_them() -> None:
    assert list(keys_of(Box)) == ["name", "weight", "model", "radius", "side", "turn", "lid", "beside"]
    box = from_plain(Box, {"name": "a", "weight": 3, "model": "square", "turn": 5, "lid": {"open": True}})
    assert box == Box("a", Shape(3.0, Square(turn=5.0)), Lid(True))
    assert to_plain(box) == {
        "name": "a", "weight": 3.0, "model": "square", "side": 2.0, "turn": 5.0, "lid": {"open": True},
    }  # fmt: skip
    assert from_plain(Box, to_plain(box)) == box


def test_another_variant_begins_with_its_own_defaults() -> None:
    box = Box("a", Shape(model=Round(4)))
    assert replaced(box, {"radius": 5}).shape.model == Round(5.0)
    assert replaced(box, {"model": "square"}).shape.model == Square()
    assert replaced(box, {"model": "square", "side": 3}).shape.model == Square(3.0)
    assert replaced(box, {"model": Square(7)}).shape.model == Square(7.0)
    assert replaced(replaced(box, {"model": "square"}), {"model": "round"}).shape.model == Round()


def test_a_key_of_another_variant_is_refused_by_name() -> None:
    assert sentences(lambda: replaced(Box("a"), {"turn": 5})) == (
        "box 'a': turn must go with model = 'square', not with 'round'; leave it out, or change the other",
    )
    assert sentences(lambda: replaced(Box("a"), {"model": "squar"})) == (
        "box 'a': model must be 'round' or 'square', not 'squar'; did you mean 'square'?",
    )


def test_problems_inside_are_told_with_the_keys_that_lead_there() -> None:
    assert sentences(
        lambda: from_plain(Box, {"name": "a", "weight": -1, "radius": "x", "lid": {"open": 1, "opn": 2}})
    ) == (
        "box 'a': radius must be a finite number of at least 0, not 'x'",
        "box 'a': weight must be a finite number of at least 0, not -1",
        "box 'a': lid: there is no 'opn'; did you mean 'open'?",
        "box 'a': lid.open must be true or false, not 1",
    )


def test_a_table_for_a_row_that_is_there_changes_its_fields_and_else_makes_one() -> None:
    assert replaced(Box("a"), {"lid": {"open": True}}).lid == Lid(True)
    assert replaced(Box("a", lid=Lid(True)), {"lid": {}}).lid == Lid(True)
    assert replaced(Box("a", lid=Lid(True)), {"lid": None}).lid is None
    assert sentences(lambda: replaced(Box("a"), {"lid": 3})) == (
        "box 'a': lid must be a table of open, not 3",
    )


def test_a_table_holds_rows_whose_names_differ() -> None:
    stack = from_plain(Stack, {"boxes": [{"name": "a"}, Box("b")]})
    assert stack.boxes == (Box("a"), Box("b"))
    assert to_plain(stack)["boxes"] == [to_plain(Box("a")), to_plain(Box("b"))]
    assert sentences(lambda: Stack((Box("a"), Box("b"), Box("a")))) == (
        "boxes[3].name must be unique, not the same as boxes[1]; rename it",
    )
    assert sentences(lambda: from_plain(Stack, {"boxes": [{"name": "a", "weight": -1}, 3]})) == (
        "boxes[1].weight must be a finite number of at least 0, not -1",
        "boxes[2] must be a table of name, weight, model, radius, side, turn, lid and beside, not 3",
    )
    assert sentences(lambda: from_plain(Stack, {"boxes": {}})) == (
        "boxes must be a list of Box rows, not {}",
    )


def test_names_that_refer_to_other_rows_are_found() -> None:
    assert Reference("surfaces").names_in("body") == ("body",)
    assert References("lights").names_in(("key", "rim")) == ("key", "rim")


def test_a_word_is_no_name() -> None:
    assert Reference("lights", "eye").names_in("eye") == ()
    assert Reference("lights", "eye").names_in("key") == ("key",)


def test_columns_that_refer_to_other_tables_are_known_also_inside_others() -> None:
    assert {key: each.kind.table for key, each in references_of(Part).items()} == {"surface": "surfaces"}
    assert references_of(Surface) == {}
    found = references_of(Light)
    assert found["only_parts"].path == ("links", "only_parts")
    light = Light("key", (0, 0, 0), links=Links(only_parts=("hood",)))
    assert found["only_parts"].value_in(light) == ("hood",)


LEFT = HalfSpace("left", (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0))
RIGHT = HalfSpace("right", (1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), edge_width=0.5)
PLANE = {"point": (0, 0, 0), "direction": (0, 0, 1)}

vectors = st.tuples(*[st.integers(-3, 3).map(float)] * 3)
half_spaces = st.builds(
    HalfSpace,
    st.sampled_from(["a", "b", "left door", "ü.1", '"quoted"', "0"]) | st.text(min_size=1, max_size=3),
    vectors,
    vectors.filter(any),
    st.sampled_from([0.0, 0.25, 3.0]),
    st.booleans(),
    st.booleans(),
)
several = st.lists(half_spaces, max_size=5, unique_by=lambda row: row.name)
anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=3) | st.binary(max_size=2),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.tuples(inner, inner)
        | st.dictionaries(
            st.sampled_from(["a", "point", "direction", "edge_width", "on", "name"])
            | st.text(max_size=2)
            | st.integers(),
            inner,
            max_size=4,
        )
    ),
    max_leaves=12,
)


def light(*rows: HalfSpace, **fields: Any) -> Light:
    return Light("key", (0, 0, 1), half_spaces=rows, **fields)


def sentence(changes: Any, *rows: HalfSpace) -> str:
    """What is said of changes that are refused."""
    with pytest.raises(InputError) as caught:
        replaced(light(*rows), {"half_spaces": changes})
    return str(caught.value)


def test_they_are_given_as_rows_or_as_tables_by_name_and_held_by_name() -> None:
    expected = light(LEFT, RIGHT)
    assert expected.half_spaces == (LEFT, RIGHT)
    assert light(RIGHT, LEFT) == expected
    tables = {"right": {"point": [1, 0, 0], "direction": [-1, 0, 0], "edge_width": 0.5}, "left": LEFT}
    assert from_plain(Light, {"name": "key", "position": [0, 0, 1], "half_spaces": tables}) == expected
    assert light().half_spaces == ()


def test_a_change_goes_into_the_rows_that_are_there() -> None:
    row = replaced(light(LEFT, RIGHT), {"half_spaces": {"right": {"on": False}}})
    assert row.half_spaces == (LEFT, RIGHT.replace(on=False))


def test_a_change_adds_and_removes_rows() -> None:
    row = replaced(light(LEFT, RIGHT), {"half_spaces": {"back": PLANE, "right": None}})
    assert row.half_spaces == (HalfSpace("back", (0, 0, 0), (0, 0, 1)), LEFT)


def test_a_row_takes_the_place_of_that_of_its_name() -> None:
    other = LEFT.replace(direction=(0, 1, 0))
    assert replaced(light(LEFT, RIGHT), {"half_spaces": {"left": other}}).half_spaces == (other, RIGHT)
    # A list of rows takes the place of all.
    assert replaced(light(LEFT, RIGHT), {"half_spaces": [other]}).half_spaces == (other,)


def test_a_row_that_is_there_can_be_renamed() -> None:
    row = replaced(light(LEFT, RIGHT), {"half_spaces": {"left": {"name": "top", "carried": True}}})
    assert row.half_spaces == (RIGHT, LEFT.replace(name="top", carried=True))
    # Also to the name of one that goes.
    row = replaced(light(LEFT, RIGHT), {"half_spaces": {"left": {"name": "right"}, "right": None}})
    assert row.half_spaces == (LEFT.replace(name="right"),)


@given(several, several)
def test_a_difference_makes_one_row_equal_to_the_other(one: list[HalfSpace], other: list[HalfSpace]) -> None:
    before, after = light(*one), light(*other)
    told = difference(before, after)
    assert replaced(before, told) == after
    assert (told == {}) == (before == after) == (cost(before, after) is None)
    # What is not told is equal already.
    inner = told.get("half_spaces", {})
    assert isinstance(inner, Mapping)
    assert {row.name for row in before.half_spaces if row in after.half_spaces}.isdisjoint(inner)


@given(several)
def test_what_is_written_gives_the_same_rows(rows: list[HalfSpace]) -> None:
    keys = to_plain(light(*rows))
    assert ("half_spaces" in keys) == bool(rows)
    assert from_plain(Light, keys) == light(*rows)


def test_the_names_are_written_once() -> None:
    assert to_plain(light(LEFT))["half_spaces"] == {
        "left": {
            "point": (-1.0, 0.0, 0.0),
            "direction": (1.0, 0.0, 0.0),
            "edge_width": 0.0,
            "carried": False,
            "on": True,
        }
    }


def test_an_edit_costs_the_planes_of_its_light() -> None:
    both = light(LEFT, RIGHT)
    assert cost(both, light(LEFT)) is Tier.LIGHT
    assert cost(both, light(LEFT, RIGHT.replace(on=False))) is Tier.LIGHT
    assert cost(both, light(RIGHT, LEFT)) is None


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"left": {"edge_width": -1}}, ".left.edge_width must be a finite number of at least 0, not -1"),
        ({"left": {"on": 1}}, ".left.on must be true or false, not 1"),
        ({"left": {"edge_widt": 1}}, ".left: there is no 'edge_widt'; did you mean 'edge_width'?"),
        ({"left": {"name": ""}}, ".left.name must be a string of at least one character, not ''"),
        (
            {"left": {"name": "right"}},
            ".right must have a name of its own, not that of another; rename one of them",
        ),
        (
            {"top": {"point": (0, 0, 0)}},
            ".top: direction must be three finite numbers of at most 1e36, not missing; add it",
        ),
        (
            {"top": {**PLANE, "name": "roof"}},
            ".top.name must be that of the table, 'top', not 'roof'; leave it out",
        ),
        ({"top": LEFT}, ".top.name must be that of the table, 'top', not 'left'; leave it out"),
        ({"top": 3}, ".top must be a table of point, direction, edge_width, carried and on, not 3"),
        ({"left": "off"}, ".left must be a table of point, direction, edge_width, carried and on, not 'off'"),
        ({"lift": None}, ".lift: there is no half-space of this name; did you mean 'left'?"),
        ({3: PLANE}, " must be a table of half-spaces by name, not by 3; name it by at least one character"),
        ({"": None}, " must be a table of half-spaces by name, not by ''; name it by at least one character"),
        (
            {"left\ndoor": {**PLANE, "direction": (0, 0, 0)}},
            ".'left\\ndoor'.direction must not be zero, not (0, 0, 0); give it a length",
        ),
        (
            {0: None, "a": None},
            " must be a table of half-spaces by name, not by 0; name it by at least one character\n"
            "light 'key': half_spaces.a: there is no half-space of this name; known are 'left', 'right'",
        ),
        (None, " must be a table of half-spaces by name, not None"),
        ("left", " must be a table of half-spaces by name, not 'left'"),
        (
            [PLANE],
            " must be a table of half-spaces by name, not [{'point': (0, 0, 0), 'direction': (0, 0, 1)}]",
        ),
        ([LEFT, LEFT], ".left must have a name of its own, not that of another; rename one of them"),
        (
            {"left": dict.fromkeys(map(str, range(65)))},
            ".left: it must be a table of at most 64 keys, not 65",
        ),
    ],
)
def test_what_is_invalid_is_told_with_its_place(changes: Any, told: str) -> None:
    assert sentence(changes, LEFT, RIGHT) == f"light 'key': half_spaces{told}"


def test_every_problem_is_told() -> None:
    told = sentence({"left": {"on": 3}, "top": {"point": 1, "direction": 2}}, LEFT).splitlines()
    assert [each.split(" must ")[0] for each in told] == [
        "light 'key': half_spaces.left.on",
        "light 'key': half_spaces.top.point",
        "light 'key': half_spaces.top.direction",
    ]


def test_there_are_as_many_as_can_be_told_apart() -> None:
    most = [LEFT.replace(name=f"{number:03}") for number in range(MOST_NAMED_ROWS)]
    full = light(*most)
    # All can be changed at once, and others take the place of all.
    off = replaced(full, {"half_spaces": {row.name: {"on": False} for row in most}})
    assert not any(row.on for row in off.half_spaces)
    others = light(*(row.replace(name=f"other {row.name}") for row in most))
    assert replaced(full, difference(full, others)) == others
    rule = "light 'key': half_spaces must be at most 64, not {}; leave some out"
    assert sentence({"one more": PLANE}, *most) == rule.format(65)
    assert sentence([*most, RIGHT]) == rule.format(65)
    assert sentence({str(number): {} for number in range(100_000)}) == rule.format("100,000")


@given(anything)
def test_whatever_is_given_makes_a_row_or_is_refused_in_sentences(value: Any) -> None:
    for rows in ((), (LEFT, HalfSpace("a", (0, 0, 0), (0, 0, 1)))):
        told = ""
        try:
            row = replaced(light(*rows), {"half_spaces": value})
        except InputError as error:
            told = str(error)
        else:
            assert [each.name for each in row.half_spaces] == sorted({each.name for each in row.half_spaces})
        assert all(each.startswith("light 'key': half_spaces") for each in told.splitlines())
