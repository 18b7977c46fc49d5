"""A row of a made-up table, with a column of each kind: whatever is added to a table appears by itself."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.checks import Color, Vector
from autocolor.scene.columns import WORLD_UNITS, BarRange, Column, Row, Tier, replaced
from autocolor.scene.kinds import (
    AngleCurve,
    AngleCurveKind,
    Boolean,
    ColorKind,
    CurveKind,
    Number,
    OneOf,
    Text,
    VectorKind,
    Whole,
)
from autocolor.scene.row_kinds import NamedRows, Nested, OneRowOf, Reference, References
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import Area
from autocolor.widgets.rows import NAMES_A_PAGE, TableNames, World, rows_of
from autocolor.widgets.widget import Choice, Entry, Heading, Place, Switch, Widget

MIX = Tier.MIX
WORLD = World((-1.0, -2.0, 0.0), (1.0, 2.0, 1.0))
SIZE = math.sqrt(4 + 16 + 1)
AREA = Area(505, 0, 639, 15)


@dataclass(frozen=True)
class Shutter(Row):
    low: Annotated[float, Column(Number(endless=-math.inf), MIX, "Low.", WORLD_UNITS)] = -math.inf
    high: Annotated[float, Column(Number(endless=math.inf), MIX, "High.", WORLD_UNITS)] = math.inf
    on: Annotated[bool, Column(Boolean(), MIX, "Whether it is used.")] = True


@dataclass(frozen=True)
class Shutters(Row):
    x: Annotated[Shutter | None, Column(Nested(Shutter), MIX, "Across.")] = None
    z: Annotated[Shutter | None, Column(Nested(Shutter), MIX, "Upward.")] = None


@dataclass(frozen=True)
class Haze(Row):
    density: Annotated[float, Column(Number(0, 1), MIX, "How dense.")] = 0.25


@dataclass(frozen=True)
class Smooth(Row):
    grain: Annotated[float, Column(Number(0, 1), MIX, "How fine.")] = 0.5


@dataclass(frozen=True)
class Coarse(Row):
    size: Annotated[int, Column(Whole(1, 9), MIX, "How coarse.")] = 3


@dataclass(frozen=True)
class Hood(Row):
    """One of any number, by name."""

    noun: ClassVar[str] = "hood"

    name: Annotated[str, Column(Text(), MIX, "Its name.")]
    point: Annotated[Vector, Column(VectorKind(), MIX, "Where it is.", WORLD_UNITS)] = (0.0, 0.0, 0.0)
    width: Annotated[float, Column(Number(at_least=0), MIX, "How wide.", WORLD_UNITS)] = 0.0
    length: Annotated[float | None, Column(Number(at_least=0, above=True), MIX, "How long.", WORLD_UNITS)] = (
        None
    )
    on: Annotated[bool, Column(Boolean(), MIX, "Whether it is used.")] = True


@dataclass(frozen=True)
class Lamp(Row):
    """One column of each kind."""

    name: Annotated[str, Column(Text(), MIX, "Its name.")] = "lamp"
    share: Annotated[float, Column(Number(0, 1), MIX, "A share.")] = 0.5
    tilt_angle: Annotated[
        float | None, Column(Number(0, 180), MIX, "A tilt.", "degrees", bar=BarRange(0, 90, 1), start=30.0)
    ] = None
    blades: Annotated[int, Column(Whole(2, 12), MIX, "Blades.")] = 6
    count: Annotated[int | None, Column(Whole(1, 100), MIX, "A count.")] = None
    reach: Annotated[float, Column(Number(), MIX, "How far.", WORLD_UNITS)] = 1.0
    on: Annotated[bool, Column(Boolean(), MIX, "Whether it is on.")] = True
    mode: Annotated[str, Column(OneOf(("wide", "narrow")), MIX, "Its mode.")] = "wide"
    tint: Annotated[Color, Column(ColorKind(), MIX, "Its tint.")] = (255, 0, 0)
    place: Annotated[Vector, Column(VectorKind(), MIX, "Where it is.", WORLD_UNITS)] = (0.0, 0.0, 0.0)
    facing: Annotated[Vector | None, Column(VectorKind(has_length=True), MIX, "Where it faces.")] = None
    finish: Annotated[Row, Column(OneRowOf({"smooth": Smooth, "coarse": Coarse}), MIX, "Its finish.")] = (
        field(default_factory=Smooth)
    )
    haze: Annotated[Haze, Column(Nested(Haze, inline=True), MIX, "Its haze.")] = field(default_factory=Haze)
    shutters: Annotated[Shutters, Column(Nested(Shutters), MIX, "Its shutters.")] = field(
        default_factory=Shutters
    )
    sheen: Annotated[
        AngleCurve | None,
        Column(AngleCurveKind(0.1, ((0.0, 0.2), (40.0, 0.4), (90.0, 1.0))), MIX, "Its sheen."),
    ] = None
    curve: Annotated[str, Column(CurveKind({"linear": 1}), MIX, "Its curve.")] = "linear"
    hoods: Annotated[tuple[Hood, ...], Column(NamedRows(Hood), MIX, "Its hoods.")] = ()
    follows: Annotated[str | None, Column(Reference("lamps", "sun"), MIX, "What it follows.")] = None
    post: Annotated[str, Column(Reference("posts"), MIX, "Its post.")] = "a"
    walls: Annotated[tuple[str, ...] | None, Column(References("walls"), MIX, "Its walls.")] = None


class Table:
    """A lamp whose rows change it."""

    def __init__(self, lamp: Lamp | None = None) -> None:
        self.lamp = Lamp() if lamp is None else lamp

    def put(self, changes: Mapping[str, Any]) -> None:
        self.lamp = replaced(self.lamp, changes)

    def rows(self, **options: Any) -> dict[str, Widget]:
        return {row.label: row.at(AREA) for row in rows_of(self.lamp, self.put, WORLD, **options)}

    def bar(self, label: str) -> Bar:
        row = self.rows()[label]
        assert isinstance(row, Bar)
        return row


@pytest.fixture
def table() -> Table:
    return Table()


def test_each_kind_of_column_has_its_rows_in_their_order(table: Table) -> None:
    kinds = {
        "name": Entry, "share": Bar, "tilt angle": Bar, "blades": Bar, "count": Bar, "reach": Bar,
        "on": Switch, "mode": Choice, "tint": Entry, "place x": Bar, "place y": Bar, "place z": Bar,
        "finish": Choice, "grain": Bar, "density": Bar, "shutters x": Switch, "shutters z": Switch,
        "sheen": Switch, "follows": Choice, "post": Choice, "walls": Switch,
    }  # fmt: skip
    assert {label: type(row) for label, row in table.rows().items()} == kinds
    assert list(table.rows()) == list(kinds)
    assert not {"name", "place x"} & set(table.rows(leave_out=("name", "place")))
    rows = table.rows()
    assert rows["tilt angle"].help == "A tilt. In degrees."
    assert rows["place y"].help == "Where it is. In world units."
    assert rows["share"].help == "A share."
    assert table.bar("tilt angle").unit == "degrees"
    given = Table(Lamp(facing=(0.0, 0.0, -1.0)))
    given.bar("facing x").put(0.5)
    assert given.lamp.facing == (0.5, 0, -1)


@pytest.mark.parametrize(
    "label", ["share", "blades", "reach", "place x", "place y", "place z", "grain", "density"]
)
def test_pointing_along_a_bar_puts_the_number_at_that_place(table: Table, label: str) -> None:
    before = table.bar(label).value
    table.bar(label).drag(Place(520, 8), Place(520, 8), Place(620, 8))
    after = table.bar(label)
    assert after.value is not None
    assert after.value != before
    assert after.low < after.value < after.high
    changed = {key: value for key, value in vars(table.lamp).items() if value != vars(Lamp())[key]}
    assert len(changed) == 1
    assert type(table.lamp.blades) is int


def test_bars_reach_the_whole_size_around_the_object_or_to_their_limits(table: Table) -> None:
    given = Table(Lamp(facing=(0.0, 0.0, -1.0), hoods=(Hood("left"),)))
    for label, low, high in (
        ("place x", -1 - SIZE, 1 + SIZE),
        ("place y", -2 - SIZE, 2 + SIZE),
        ("reach", -2 - SIZE, 2 + SIZE),
        ("facing x", -1, 1),
        ("tilt angle", 0, 90),
        ("  width", 0, SIZE),
    ):
        assert (given.bar(label).low, given.bar(label).high) == pytest.approx((low, high))
    # A number that must be above 0 begins with a step.
    given.bar("  length").pick(Place(632, 8))
    assert given.lamp.hoods[0].length == given.bar("  length").step == given.bar("  length").low
    nowhere = World((3.0, 3.0, 3.0), (3.0, 3.0, 3.0)).range_of("x")
    assert (nowhere.low, nowhere.high) == (2, 4)


def test_an_absent_number_begins_at_its_start_or_the_lowest_of_its_range(table: Table) -> None:
    for label, start in (("tilt angle", 30.0), ("count", 1)):
        assert table.bar(label).value is None
        table.bar(label).pick(Place(632, 8))
        assert table.bar(label).value == start
        table.bar(label).pick(Place(632, 8))
        assert table.bar(label).value is None


def test_switches_choices_and_texts_put_their_values(table: Table) -> None:
    table.rows()["on"].pick(Place(632, 8))
    table.rows()["mode"].pick(Place(600, 8))
    for label, typed in (("name", "sun"), ("tint", "#00f")):
        entry = table.rows()[label]
        assert isinstance(entry, Entry)
        assert entry.typed.text == {"name": "lamp", "tint": "#ff0000"}[label]
        assert not entry.typed.is_proposed
        entry.typed.take(typed)
    lamp = table.lamp
    assert (lamp.on, lamp.mode, lamp.name, lamp.tint) == (False, "narrow", "sun", (0, 0, 255))


def test_a_row_of_one_of_several_classes_has_the_parameters_of_that_class(table: Table) -> None:
    table.bar("grain").put(0.75)
    assert table.lamp.finish == Smooth(0.75)
    table.rows()["finish"].pick(Place(600, 8))
    assert repr(table.lamp.finish) == repr(Coarse())
    assert "grain" not in table.rows()
    table.bar("size").put(5.0)
    assert repr(table.lamp.finish) == repr(Coarse(5))


def test_a_curve_over_angles_is_switched_and_has_a_bar_for_each_of_its_points(table: Table) -> None:
    table.rows()["sheen"].pick(Place(632, 8))
    assert table.lamp.sheen == ((0, 0.2), (40, 0.4), (90, 1))
    bars = [table.bar(f"at {angle} degrees") for angle in (0, 40, 90)]
    assert [(bar.value, bar.low, bar.high) for bar in bars] == [(0.2, 0.1, 1), (0.4, 0, 1), (1, 0, 1)]
    bars[1].put(0.75)
    assert table.lamp.sheen == ((0, 0.2), (40, 0.75), (90, 1))
    table.bar("at 0 degrees").put(0.125)
    assert table.lamp.sheen == ((0, 0.125), (40, 0.75), (90, 1))
    table.rows()["sheen"].pick(Place(632, 8))
    assert table.lamp.sheen is None
    assert "at 40 degrees" not in table.rows()


def test_an_absent_row_is_made_by_its_switch_and_then_switched(table: Table) -> None:
    table.rows()["shutters x"].pick(Place(632, 8))
    assert table.lamp.shutters == Shutters(x=Shutter())
    assert {"x low", "x high"} <= set(table.rows())
    assert "x on" not in table.rows()
    table.rows()["shutters x"].pick(Place(632, 8))
    assert table.lamp.shutters.x == Shutter(on=False)


def test_a_number_without_limit_begins_beyond_everything_on_that_side() -> None:
    lamp = Lamp(shutters=Shutters(z=Shutter()))
    table = Table(lamp)
    for label, bound in (("z low", -0.1), ("z high", 1.1)):
        assert table.bar(label).value is None
        table.bar(label).pick(Place(632, 8))
        assert table.bar(label).value == bound
    assert table.lamp.shutters.z == Shutter(-0.1, 1.1)
    table.bar("z low").pick(Place(632, 8))
    assert table.lamp.shutters.z == Shutter(-math.inf, 1.1)


@given(st.floats(-1e3, 1e3), st.floats(0.01, 1e3), st.floats(0, 5))
def test_the_end_beyond_everything_is_less_than_two_steps_away(
    low: float, size: float, margin: float
) -> None:
    bottom, top = low - 1, low + size + 1
    world = World((low,) * 3, (low + size,) * 3, everything=((bottom,) * 3, (top,) * 3))
    for axis in "xyz":
        step = world.range_of(axis).step
        below, above = bottom - world.end_beyond(axis, -1, margin), world.end_beyond(axis, 1, margin) - top
        for distance in (below, above):
            assert margin - 1e-6 <= distance <= margin + 2 * step + 1e-6


def test_each_row_by_name_has_a_box_and_below_it_its_rows() -> None:
    table = Table(Lamp(hoods=(Hood("left"), Hood("x", on=False))))
    rows = rows_of(
        table.lamp, table.put, WORLD, leave_out=[name for name in vars(table.lamp) if name != "hoods"]
    )
    inside = ["  point x", "  point y", "  point z", "  width", "  length"]
    assert [row.label for row in rows] == ["hoods", "left", *inside, "x", *inside]
    assert isinstance(rows[0], Heading)
    assert len({row.key for row in rows}) == len(rows)
    assert rows[8].help == "x: Where it is. In world units."
    first, second = rows[1].at(AREA), rows[7].at(AREA)
    assert isinstance(first, Switch)
    assert isinstance(second, Switch)
    assert (first.is_on, second.is_on) == (True, False)
    second.pick(Place(632, 8))
    assert table.lamp.hoods == (Hood("left"), Hood("x"))
    point = rows[2]
    assert isinstance(point, Bar)
    point.put(0.5)
    assert table.lamp.hoods == (Hood("left", point=(0.5, 0.0, 0.0)), Hood("x"))
    # Its name is that of an axis, but its coordinates are of all three.
    width = rows[11]
    assert isinstance(width, Bar)
    assert width.high == pytest.approx(SIZE)


# Names of rows of other tables are chosen by pointing: one of them, or a list.

NEXT = Place(600, 8)


class Posts(Table):
    """A lamp in a world that knows some names."""

    def __init__(self, lamp: Lamp | None = None, names: Sequence[str] = ("a", "b", "c")) -> None:
        super().__init__(lamp)
        self.pages: dict[str, int] = {}
        self.names = names

    def rows(self, **options: Any) -> dict[str, Widget]:
        world = World(WORLD.low, WORLD.high, TableNames(lambda table: self.names, self.pages))
        left_out = [name for name in vars(self.lamp) if name not in ("post", "follows", "walls")]
        return {row.label: row.at(AREA) for row in rows_of(self.lamp, self.put, world, leave_out=left_out)}

    @property
    def ticked(self) -> dict[str, bool]:
        return {label: row.is_on for label, row in self.rows().items() if isinstance(row, Switch)}


@pytest.mark.parametrize(
    ("label", "names", "shown", "taken"),
    [
        ("post", ("a", "b", "c"), ["a", "b", "c"], ["b", "c", "a"]),
        ("follows", ("a", "sun", "none"), ["none", "sun", "a"], ["sun", "a", None]),
    ],
)
def test_a_name_is_chosen_among_those_of_its_table_or_none_if_it_may_be_absent(
    label: str, names: Sequence[str], shown: list[str], taken: list[str | None]
) -> None:
    menu, found = Posts(names=names), []
    for _ in names:
        row = menu.rows()[label]
        assert isinstance(row, Choice)
        assert list(row.names) == shown
        row.pick(NEXT)
        found.append(getattr(menu.lamp, label))
    assert found == taken


def test_a_list_is_made_by_its_box_and_names_go_in_and_out_in_the_order_of_their_table() -> None:
    menu = Posts()
    assert menu.ticked == {"walls": False}
    menu.rows()["walls"].pick(NEXT)
    assert vars(menu.lamp)["walls"] == ()
    assert menu.ticked == {"walls": True, "  a": False, "  b": False, "  c": False}
    for label in ("  b", "  c", "  a", "  b"):
        menu.rows()[label].pick(NEXT)
    assert menu.lamp.walls == ("a", "c")
    assert menu.rows()["  a"].help == "Remove a from the list: walls."
    assert menu.rows()["  b"].help == "Add b to the list: walls."
    assert menu.rows()["  c"].key == "walls.  c"
    menu.rows()["walls"].pick(NEXT)
    assert menu.lamp.walls is None


def test_many_names_come_in_pages() -> None:
    names = [f"n{number}" for number in range(2 * NAMES_A_PAGE + 1)]
    menu, seen = Posts(Lamp(walls=("n24",)), names), list[str]()
    for title in ("1 to 12", "13 to 24", "25 to 25"):
        page = menu.rows()["walls"]
        assert isinstance(page, Choice)
        assert page.present == title
        assert page.help == "The page of the 25 walls that is shown below; 1 are in the list."
        seen += [label.strip() for label in menu.ticked if label != "walls"]
        page.pick(NEXT)
    assert seen == names
    assert menu.lamp.walls == ("n24",)
    assert "  n0" in menu.ticked


@pytest.mark.parametrize("count", [0, 1, 12, 13])
def test_a_page_that_is_no_more_there_gives_way_to_the_last(count: int) -> None:
    menu = Posts(Lamp(walls=()), [f"n{number}" for number in range(count)])
    menu.pages["walls"] = 5
    assert list(menu.ticked)[-1] == (f"  n{count - 1}" if count else "walls")
