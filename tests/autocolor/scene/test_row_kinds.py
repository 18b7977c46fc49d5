from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import FrozenInstanceError
from typing import Any, ClassVar, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Light, Paint, Part, Scene, Surface, View
from autocolor.errors import InputError
from autocolor.scene.columns import (
    Row,
    Tier,
    column_of,
    cost,
    difference,
    fields_of,
    from_plain,
    keys_of,
    replaced,
    to_plain,
)
from autocolor.scene.kinds import boolean, number, text
from autocolor.scene.lights import HalfSpace
from autocolor.scene.row_kinds import (
    MOST_NAMED_ROWS,
    OneRowOf,
    RangesByName,
    Reference,
    References,
    RowList,
    TableRows,
    nested,
    references_of,
    table_row,
)
from tests.tables import call, refused


@table_row
class Round(Row):
    """A model with one parameter."""

    radius: float = number(default=1.0, at_least=0, tier=Tier.LIGHT, help="How large it is.")


class Rounder(Round):
    """A class that derives from a model is none of the models."""


@table_row
class Square(Row):
    """Another one, with a parameter of the same name."""

    side: float = number(default=2.0, at_least=0, tier=Tier.LIGHT, help="How long a side is.")
    turn: float = number(default=0.0, tier=Tier.MIX, help="How it is turned.")


@table_row
class Shape(Row):
    """What is inline."""

    weight: float = number(default=1.0, at_least=0, tier=Tier.MIX, help="How heavy it is.")
    model: Row = column_of(
        OneRowOf({"round": Round, "square": Square}), default=Round(), tier=Tier.LIGHT, help="Its form."
    )


@table_row
class Lid(Row):
    """What is a table of its own."""

    noun: ClassVar[str] = "lid"

    open: bool = boolean(default=False, tier=Tier.ENTRIES, help="Whether it is open.")


@table_row
class Box(Row):
    """A row with rows inside."""

    noun: ClassVar[str] = "box"

    name: str = text(tier=Tier.NOTHING, help="What it is called.")
    shape: Shape = nested(Shape, default=Shape(), inline=True, tier=Tier.LIGHT, help="Its shape.")
    lid: Lid | None = nested(Lid, default=None, tier=Tier.ENTRIES, help="Its lid.")
    beside: str | None = column_of(Reference("boxes"), default=None, tier=Tier.NOTHING, help="Another box.")


@table_row
class Stack(Row):
    """A row with a table."""

    boxes: TableRows[Box] = column_of(
        RowList(Box, by_name=True), default=TableRows(), tier=Tier.FRAME, help="The boxes."
    )


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


def test_a_table_for_a_row_that_is_there_changes_its_fields_and_else_makes_one() -> None:
    assert replaced(Box("a"), {"lid": {"open": True}}).lid == Lid(True)
    assert replaced(Box("a", lid=Lid(True)), {"lid": {}}).lid == Lid(True)
    assert replaced(Box("a", lid=Lid(True)), {"lid": None}).lid is None


test_a_row_inside_a_row_is_refused_with_the_keys_that_lead_there = refused(
    call,
    [
        (
            lambda: replaced(Box("a"), {"turn": 5}),
            "box 'a': turn must go with model = 'square', not with 'round'; leave it out, or change the"
            " model",
        ),
        (
            lambda: replaced(Box("a"), {"model": "squar"}),
            "box 'a': model must be 'round' or 'square', not 'squar'; did you mean 'square'?",
        ),
        (
            lambda: replaced(Box("a"), {"model": Rounder()}),
            "box 'a': model must be 'round' or 'square', not Rounder()",
        ),
        (
            lambda: replaced(Box("a"), {"model": {"radus": 3}}),
            "box 'a': there is no field 'radus'; did you mean 'radius'?",
        ),
        (lambda: replaced(Box("a"), {"shape": 3}), "box 'a': shape must be a Shape, not 3"),
        (
            lambda: replaced(Box("a"), {"shape": None, "weight": 1}),
            "box 'a': shape must be a Shape, not None",
        ),
        (lambda: replaced(Box("a"), {"lid": 3}), "box 'a': lid must be a table of open, not 3"),
        (
            lambda: from_plain(Box, {"name": "a", "weight": -1, "radius": "x", "lid": {"open": 1, "opn": 2}}),
            "box 'a': radius must be a finite number of at least 0, not 'x'\n"
            "box 'a': weight must be a finite number of at least 0, not -1\n"
            "box 'a': lid: there is no field 'opn'; did you mean 'open'?\n"
            "box 'a': lid.open must be true or false, not 1",
        ),
        (
            lambda: from_plain(Stack, {"boxes": [{"name": "a", "weight": -1}, 3]}),
            "boxes[1].weight must be a finite number of at least 0, not -1\n"
            "boxes[2] must be a table of name, weight, model, radius, side, turn, lid and beside, not 3",
        ),
        (lambda: from_plain(Stack, {"boxes": {}}), "boxes must be a list of Box rows, not {}"),
    ],
)


@pytest.mark.thorough
def test_a_table_of_more_than_a_million_rows_is_refused_at_once() -> None:
    with pytest.raises(InputError, match=r"^boxes must be a list of Box rows, not \("):
        Stack((Box("a"),) * 1_000_001)


def test_names_that_refer_to_other_rows_are_found_and_words_are_none() -> None:
    assert Reference("surfaces").names_in("body") == ["body"]
    assert References("lights").names_in(("key", "rim")) == ["key", "rim"]
    assert Reference("lights", "eye").names_in("eye") == []
    assert Reference("lights", "eye").names_in("key") == ["key"]
    ranges = RangesByName("surfaces", "object", "auto")
    assert list(ranges.names_in("auto")) == []
    assert list(ranges.names_in((("body", (0, 1)), ("object", (0, 1))))) == ["body"]


def test_columns_that_refer_to_other_tables_are_known_also_inside_others() -> None:
    assert [*references_of(Part)] == ["surface"]
    assert references_of(Surface) == {}
    assert references_of(Light)["only_parts"].field == "links"


def test_a_missing_misspelt_or_wrong_argument_is_found_by_type_checkers_and_at_run_time() -> None:
    # mypy reports a comment that ignores nothing, so each of these is an error for it.
    with pytest.raises(TypeError, match="missing 2 required positional arguments: 'name' and 'position'"):
        Light()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="unexpected keyword argument 'concentrtion'"):
        Light("key", (0, 0, 0), concentrtion=1)  # type: ignore[call-arg]
    with pytest.raises(InputError, match="concentration must be a finite number of at least 0, not 'x'"):
        Light("key", (0, 0, 0), concentration="x")  # type: ignore[arg-type]
    changing = r"a Light cannot be changed; use replace\(intensity=...\), which returns another Light"
    with pytest.raises(FrozenInstanceError, match=changing):
        Light("key", (0, 0, 0)).intensity = 2  # type: ignore[misc]
    with pytest.raises(TypeError, match="'help'"):
        number(default=1.0, tier=Tier.LIGHT)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="'at_leest'"):
        number(default=1.0, at_leest=0, tier=Tier.LIGHT, help="")  # type: ignore[call-arg]
    length: float = number(default=None, tier=Tier.LIGHT, help="")  # type: ignore[arg-type]
    name: str = number(tier=Tier.LIGHT, help="")  # type: ignore[assignment]
    del length, name


def test_the_signature_of_a_row_class_has_plain_types_and_defaults() -> None:
    assert str(inspect.signature(Box)).replace(f"{__name__}.", "") == (
        "(name: str, shape: Shape = Shape(), lid: Lid | None = None, beside: str | None = None) -> None"
    )
    for cls in (Flap, Light, Paint, Part, Scene, Surface, View):
        types = inspect.get_annotations(cls.__init__)
        for key, column in fields_of(cls).items():
            assert (type(None) in get_args(types[key])) == column.is_optional, key


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


def light(*rows: HalfSpace, **fields: Any) -> Light:
    return Light("key", (0, 0, 1), half_spaces=rows, **fields)


OTHER = LEFT.replace(direction=(0, 1, 0))


@pytest.mark.parametrize(
    ("changes", "rows"),
    [
        ({"right": {"on": False}}, (LEFT, RIGHT.replace(on=False))),
        ({"back": PLANE, "right": None}, (HalfSpace("back", (0, 0, 0), (0, 0, 1)), LEFT)),
        ({"left": OTHER}, (OTHER, RIGHT)),
        # A list of rows takes the place of all.
        ([OTHER], (OTHER,)),
        ({"left": {"name": "top", "carried": True}}, (RIGHT, LEFT.replace(name="top", carried=True))),
        # A row is renamed to the name of one that goes, too.
        ({"left": {"name": "right"}, "right": None}, (LEFT.replace(name="right"),)),
    ],
)
def test_a_change_goes_into_rows_adds_removes_and_renames_them(changes: Any, rows: Any) -> None:
    assert replaced(light(LEFT, RIGHT), {"half_spaces": changes}).half_spaces == rows


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
    # Their names are written once, as the names of tables.
    assert "'name': " not in repr(keys.get("half_spaces"))
    assert from_plain(Light, keys) == light(*rows)


FULL = light(*(LEFT.replace(name=f"{number:03}") for number in range(MOST_NAMED_ROWS)))


def test_rows_are_held_by_name() -> None:
    assert light(RIGHT, LEFT).half_spaces == (LEFT, RIGHT)
    assert cost(light(LEFT, RIGHT), light(RIGHT, LEFT)) is None
    assert cost(light(LEFT, RIGHT), light(LEFT)) is Tier.LIGHT


def test_all_rows_are_changed_or_replaced_at_once() -> None:
    off = replaced(FULL, {"half_spaces": {row.name: {"on": False} for row in FULL.half_spaces}})
    assert not any(row.on for row in off.half_spaces)
    others = light(*(row.replace(name=f"other {row.name}") for row in FULL.half_spaces))
    assert replaced(FULL, difference(FULL, others)) == others


BY_NAME = " must be a table of half-spaces by name, not "
A_TABLE = " must be a table of point, direction, edge_width, carried and on, not "
NO_DIRECTION = "must be three finite numbers of at most 1e36, not (0, 0, 0); one of them must not be 0"
ITS_NAME = ".top.name must be the name of its table, 'top', not "
INVALID: list[tuple[Any, str]] = [
    ({"left": {"edge_widt": 1}}, ".left: there is no field 'edge_widt'; did you mean 'edge_width'?"),
    ({"left": {"name": "right"}}, ".right must be unique, not repeated; rename one of them"),
    ([LEFT, LEFT], ".left must be unique, not repeated; rename one of them"),
    (
        {"top": {"point": (0, 0, 0)}},
        ".top: direction must be three finite numbers of at most 1e36, not missing; add it",
    ),
    ({"top": {**PLANE, "name": "roof"}}, f"{ITS_NAME}'roof'; leave it out"),
    ({"top": LEFT}, f"{ITS_NAME}'left'; leave it out"),
    ({"top": 3}, f".top{A_TABLE}3"),
    ({"lift": None}, ".lift: there is no half-space of this name; did you mean 'left'?"),
    ({"": None}, f"{BY_NAME}by ''; name it by at least one character"),
    (
        {"left\ndoor": {**PLANE, "direction": (0, 0, 0)}},
        f".'left\\ndoor'.direction {NO_DIRECTION}",
    ),
    (
        {0: None, "a": None},
        f"{BY_NAME}by 0; name it by at least one character\n"
        "light 'key': half_spaces.a: there is no half-space of this name; choose 'left' or 'right'",
    ),
    (None, f"{BY_NAME}None"),
    ("left", f"{BY_NAME}'left'"),
    ([PLANE], f"{BY_NAME}[{{'point': (0, 0, 0), 'direction': (0, 0, 1)}}]"),
    (
        {"left": {"on": 3}, "top": {"point": 1, "direction": (0, 0, 0)}},
        ".left.on must be true or false, not 3\n"
        "light 'key': half_spaces.top.point must be three finite numbers of at most 1e36, not 1\n"
        f"light 'key': half_spaces.top.direction {NO_DIRECTION}",
    ),
]
FEW = " must be at most 64, not {}; leave some out"
TOO_MANY: list[tuple[Any, str]] = [
    ({"one more": PLANE}, FEW.format(65)),
    ([*FULL.half_spaces, RIGHT], FEW.format(65)),
    ({str(number): {} for number in range(129)}, FEW.format(129)),
    ({str(number): {} for number in range(100_000)}, FEW.format("100,000")),
]

test_what_is_invalid_is_told_with_its_place = refused(
    lambda given: replaced(given[0], {"half_spaces": given[1]}),
    [
        ((row, changes), f"light 'key': half_spaces{told}")
        for row, cases in ((light(LEFT, RIGHT), INVALID), (FULL, TOO_MANY))
        for changes, told in cases
    ],
)
