"""A row of a made-up table, with a column of each kind: whatever is added to a table appears by itself."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.checks import Color, Vector
from autocolor.scene.columns import WORLD_UNITS, BarRange, Row, Tier, column_of, replaced
from autocolor.scene.kinds import (
    AngleCurve,
    AngleCurveKind,
    CurveKind,
    Whole,
    boolean,
    color,
    coordinates,
    number,
    one_of,
    text,
    vector,
)
from autocolor.scene.row_kinds import OneRowOf, Reference, References, nested, table_row
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import Area
from autocolor.widgets.rows import NAMES_A_PAGE, AddRow, TableNames, World, rows_of
from autocolor.widgets.widget import Choice, Entry, Place, Switch, Widget

MIX = Tier.MIX
WORLD = World((-1.0, -2.0, 0.0), (1.0, 2.0, 1.0))
SIZE = math.sqrt(4 + 16 + 1)
AREA = Area(505, 0, 639, 15)


@table_row
class Shutter(Row):
    low: float = number(default=-math.inf, endless=-math.inf, unit=WORLD_UNITS, tier=MIX, help="Low.")
    high: float = number(default=math.inf, endless=math.inf, unit=WORLD_UNITS, tier=MIX, help="High.")
    on: bool = boolean(default=True, tier=MIX, help="Whether it is used.")


@table_row
class Shutters(Row):
    x: Shutter | None = nested(Shutter, default=None, tier=MIX, help="Across.")
    z: Shutter | None = nested(Shutter, default=None, tier=MIX, help="Upward.")


@table_row
class Haze(Row):
    density: float = number(default=0.25, at_least=0, at_most=1, tier=MIX, help="How dense.")


@table_row
class Smooth(Row):
    grain: float = number(default=0.5, at_least=0, at_most=1, tier=MIX, help="How fine.")


@table_row
class Coarse(Row):
    size: int = column_of(Whole(1, 9), default=3, tier=MIX, help="How coarse.")


@table_row
class Lamp(Row):
    """One column of each kind."""

    name: str = text(default="lamp", tier=MIX, help="Its name.")
    share: float = number(default=0.5, at_least=0, at_most=1, tier=MIX, help="A share.")
    tilt_angle: float | None = number(
        default=None,
        at_least=0,
        at_most=180,
        unit="degrees",
        bar=BarRange(0, 90, 1),
        start=30.0,
        tier=MIX,
        help="A tilt.",
    )
    blades: int = column_of(Whole(2, 12), default=6, bar=BarRange(2, 12, 1), tier=MIX, help="Blades.")
    count: int | None = column_of(
        Whole(1, 100), default=None, bar=BarRange(1, 100, 1), tier=MIX, help="A count."
    )
    reach: float = number(default=1.0, unit=WORLD_UNITS, tier=MIX, help="How far.")
    on: bool = boolean(default=True, tier=MIX, help="Whether it is on.")
    mode: str = one_of(("wide", "narrow"), default="wide", tier=MIX, help="Its mode.")
    tint: Color = color(default=(255, 0, 0), tier=MIX, help="Its tint.")
    place: Vector = coordinates(default=(0.0, 0.0, 0.0), tier=MIX, help="Where it is.")
    facing: Vector | None = vector(default=None, tier=MIX, help="Where it faces.")
    finish: Row = column_of(
        OneRowOf({"smooth": Smooth, "coarse": Coarse}), default=Smooth(), tier=MIX, help="Its finish."
    )
    haze: Haze = nested(Haze, default=Haze(), inline=True, tier=MIX, help="Its haze.")
    shutters: Shutters = nested(Shutters, default=Shutters(), tier=MIX, help="Its shutters.")
    sheen: AngleCurve | None = column_of(
        AngleCurveKind(0.1, ((0.0, 0.2), (40.0, 0.4), (90.0, 1.0))), default=None, tier=MIX, help="Its sheen."
    )
    curve: object = column_of(CurveKind({"linear": 1}), default="linear", tier=MIX, help="Its curve.")
    width: float = number(default=0.0, at_least=0, unit=WORLD_UNITS, tier=MIX, help="How wide.")
    length: float | None = number(
        default=None, at_least=0, above=True, unit=WORLD_UNITS, tier=MIX, help="How long."
    )
    follows: str | None = column_of(Reference("lamps", "sun"), default=None, tier=MIX, help="What leads.")
    post: str = column_of(Reference("posts"), default="a", tier=MIX, help="Its post.")
    walls: tuple[str, ...] | None = column_of(References("walls"), default=None, tier=MIX, help="Its walls.")


class Table:
    """A lamp whose rows change it, in a world that knows some names. `options` are for `rows_of`."""

    def __init__(
        self, lamp: Lamp | None = None, names: Sequence[str] = ("a", "b", "c"), **options: Any
    ) -> None:
        self.lamp = Lamp() if lamp is None else lamp
        self.names, self.pages, self.options = names, dict[str, int](), options

    def put(self, changes: Mapping[str, Any]) -> None:
        self.lamp = replaced(self.lamp, changes)

    def rows(self, **options: Any) -> dict[str, Widget]:
        world = World(WORLD.low, WORLD.high, TableNames(lambda table: self.names, self.pages))
        rows = rows_of(self.lamp, self.put, world, **self.options, **options)
        return {row.label: row.at(AREA) for row in rows}

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
        "finish": Choice, "grain": Bar, "density": Bar, "shutters": AddRow,
        "sheen": Switch, "width": Bar, "length": Bar, "follows": Choice, "post": Choice, "walls": Switch,
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


@pytest.mark.parametrize("label", ["share", "blades", "reach", "place y", "grain", "density"])
def test_pointing_along_a_bar_puts_the_number_at_that_place_alone(table: Table, label: str) -> None:
    before = table.bar(label).value
    table.bar(label).drag(Place(520, 8), Place(520, 8), Place(620, 8))
    after = table.bar(label)
    assert after.value is not None
    assert after.value != before
    assert after.low < after.value < after.high
    assert sum(value != vars(Lamp())[key] for key, value in vars(table.lamp).items()) == 1
    assert type(table.lamp.blades) is int


def test_bars_reach_the_whole_size_around_the_object_or_to_their_limits(table: Table) -> None:
    given = Table(Lamp(facing=(0.0, 0.0, -1.0)))
    for label, low, high in (
        ("place x", -1 - SIZE, 1 + SIZE),
        ("place y", -2 - SIZE, 2 + SIZE),
        ("reach", -2 - SIZE, 2 + SIZE),
        ("facing x", -1, 1),
        ("tilt angle", 0, 90),
        ("width", 0, SIZE),
    ):
        assert (given.bar(label).low, given.bar(label).high) == pytest.approx((low, high))
    # A number that must be above 0 begins with a step.
    given.bar("length").pick(Place(632, 8))
    assert given.lamp.length == given.bar("length").step == given.bar("length").low
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
        assert entry.value == {"name": "lamp", "tint": "#ff0000"}[label]
        assert not entry.is_proposed
        entry.take(typed)
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


def test_an_absent_row_is_added_by_its_name_in_a_row_and_then_switched(table: Table) -> None:
    # The names are at the right; a pick at their left adds the first.
    for element, name, hint in ((628, "z", "Add shutters z. Upward."), (520, "x", "Add shutters x. Across.")):
        row = table.rows()["shutters"]
        assert row.hint_at(Place(element, 8)) == hint
        row.pick(Place(element, 8))
        assert {f"{name} low", f"{name} high"} <= set(table.rows())
        assert f"{name} on" not in table.rows()
    assert table.lamp.shutters == Shutters(Shutter(), Shutter())
    assert "shutters" not in table.rows()
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
    world = World((low,) * 3, (low + size,) * 3, everything=((low - 1,) * 3, (low + size + 1,) * 3))
    for axis in "xyz":
        below, above = (world.end_beyond(axis, sign, margin) for sign in (-1, 1))
        for distance in (low - 1 - below, above - (low + size + 1)):
            assert margin - 1e-6 <= distance <= margin + 2 * world.range_of(axis).step + 1e-6


# Names of rows of other tables are chosen by pointing: one of them, or a list.

NEXT = Place(600, 8)


def ticked(table: Table) -> dict[str, bool]:
    """The rows of a list that are switches, and whether they are on."""
    return {label: row.is_on for label, row in table.rows().items() if isinstance(row, Switch)}


@pytest.mark.parametrize(
    ("label", "names", "taken"),
    [("post", ("a", "b", "c"), ["b", "c", "a"]), ("follows", ("a", "sun", "none"), ["sun", "a", None])],
)
def test_a_name_is_chosen_among_those_of_its_table_or_none_if_it_may_be_absent(
    label: str, names: Sequence[str], taken: list[str | None]
) -> None:
    menu, found = Table(names=names), []
    for _ in names:
        menu.rows()[label].pick(NEXT)
        found.append(vars(menu.lamp)[label])
    assert found == taken


def test_a_list_is_made_by_its_box_and_names_go_in_and_out_in_the_order_of_their_table() -> None:
    menu = Table(columns=["walls"])
    assert ticked(menu) == {"walls": False}
    menu.rows()["walls"].pick(NEXT)
    assert vars(menu.lamp)["walls"] == ()
    assert ticked(menu) == {"walls": True, "  a": False, "  b": False, "  c": False}
    for label in ("  b", "  c", "  a", "  b"):
        menu.rows()[label].pick(NEXT)
    assert menu.lamp.walls == ("a", "c")
    assert menu.rows()["  a"].help == "Remove a from the list: walls."
    assert menu.rows()["  b"].help == "Add b to the list: walls."
    assert menu.rows()["  c"].key == "walls.  c"
    menu.rows()["walls"].pick(NEXT)
    assert menu.lamp.walls is None


def test_many_names_come_in_pages_the_last_of_which_stands_for_those_that_went() -> None:
    names = [f"n{number}" for number in range(2 * NAMES_A_PAGE + 1)]
    menu, seen = Table(Lamp(walls=("n1",)), names, columns=["walls"]), list[str]()
    for title in ("1 of 3", "2 of 3", "3 of 3"):
        page = menu.rows()["page"]
        assert isinstance(page, Choice)
        assert (page.present, page.key) == (title, "walls.page")
        assert page.help == f"The page of the {len(names)} walls that is shown below; 1 are in the list."
        seen += [label.strip() for label in ticked(menu) if label != "walls"]
        page.pick(NEXT)
    assert seen == names
    assert "  n0" in ticked(menu)
    menu.pages["walls"] = 5
    for count in (NAMES_A_PAGE + 1, NAMES_A_PAGE, 1):
        menu.names = names[:count]
        assert list(ticked(menu))[-1] == f"  n{count - 1}"
    menu.names = []
    assert list(ticked(menu)) == ["walls"]
