"""The rows of a menu for a row of a table, derived from the descriptions of its columns.

So a new column of a table appears on the screens by itself. A number is a bar, a switch a box, a vector three
bars; a choice and a text are rows of their own. The name of a nested row stands before the names of its
columns; all nested rows that are absent share a row, which adds them. A list of names has a switch for the
whole list, and a box for each name of a table; many names come in pages, so that they do not fill the menu.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final, NamedTuple

from autocolor.checks import Vector
from autocolor.scene.columns import WORLD_UNITS, BarRange, Column, Row, fields_of
from autocolor.scene.kinds import (
    AngleCurve,
    AngleCurveKind,
    Boolean,
    ColorKind,
    Number,
    OneOf,
    Text,
    VectorKind,
    Whole,
    in_digits,
)
from autocolor.scene.row_kinds import Nested, OneRowOf, Reference, References
from autocolor.widgets.bars import Bar, bar_within, rounded_to
from autocolor.widgets.items import CHARACTER
from autocolor.widgets.menu import paged
from autocolor.widgets.widget import MARGIN, Button, Choice, Entry, Place, Switch, Widget

Put = Callable[[Mapping[str, object]], object]
"""Changes fields of the row, by name."""

PutValue = Callable[[object], object]
"""Changes one field of the row."""

AXES: Final = "xyz"

NAMES_A_PAGE: Final = 7
"""Assumed: names that are shown at once; a list of so many fits in the menu of a light."""

INDENT: Final = "  "

NONE: Final = "none"
"""The choice of no name."""


class TableNames(NamedTuple):
    """The names of the rows of each table, and the number of the page of names that is shown, by table."""

    of: Callable[[str], Sequence[str]]
    pages: dict[str, int]


class World(NamedTuple):
    """The bounds of the object, from which bars of coordinates get their range, and the names of tables."""

    low: Vector
    high: Vector
    names: TableNames = TableNames(lambda _: (), {})
    everything: tuple[Vector, Vector] | None = None
    """The bounds of the object with the stage; None if there is no stage."""

    @property
    def size(self) -> float:
        """The whole size of the object, from its least corner to its largest; 1 for a point."""
        return math.dist(self.low, self.high) or 1.0

    def range_of(self, axis: str) -> BarRange:
        """The usual range of a coordinate: the object's extent, widened by its whole size on both sides.

        Without an axis, the range covers the extents along all three axes.
        """
        low, high = min(self.low), max(self.high)
        if axis:
            low, high = self.low[AXES.index(axis)], self.high[AXES.index(axis)]
        return bar_within(low - self.size, high + self.size)

    def end_beyond(self, axis: str, sign: float, margin: float) -> float:
        """A coordinate beyond which nothing is: below everything, or with a positive sign above it.

        It is at least `margin` away, and less than two steps of the axis's bar farther.
        """
        corners, step = self.everything or (self.low, self.high), self.range_of(axis).step
        farthest = corners[sign > 0][AXES.index(axis)]
        return rounded_to(farthest + math.copysign(margin + step, sign), step)


@dataclass(frozen=True)
class AddRow(Button):
    """A row whose value names absent things, each with its help; a pick on a name adds the thing."""

    names: Mapping[str, str] = field(default_factory=dict)
    add: Callable[[str], object] = lambda _: None

    def _name_at(self, place: Place) -> str:
        """The name at a place; at the left of all names, the first."""
        start = self.area.right + 1 - MARGIN - CHARACTER * len(self.value)
        before = max(0, (place.element - start) // CHARACTER)
        return list(self.names)[self.value[:before].count(" ")]

    def hint_at(self, place: Place) -> str:
        name = self._name_at(place)
        return f"Add {self.label} {name}. {self.names[name]}"

    def pick(self, place: Place) -> object:
        return self.add(self._name_at(place))


class _Menu(NamedTuple):
    """The context of the rows of a table row; `label` stands before the names of its columns.

    `axis` is the axis of its coordinates, if it is a row for one axis, and `edge` the width of its edges.
    """

    put: Put
    world: World
    label: str = ""
    axis: str = ""
    edge: float = 0.0


def rows_of(
    row: Row, put: Put, world: World, leave_out: Sequence[str] = (), columns: Sequence[str] | None = None
) -> list[Widget]:
    """The rows for a row of a table, in the order of its columns; `put` is called with the changed fields.

    With `columns`, only these columns have rows, in this order. Columns of `leave_out`, tables, rows by
    name, held ranges and absent vectors have no rows.
    """
    return list(_rows_in(_Menu(put, world), row, leave_out, columns))


def _rows_in(
    menu: _Menu, row: Row, leave_out: Sequence[str] = (), columns: Sequence[str] | None = None
) -> Iterator[Widget]:
    fields = fields_of(type(row))
    absent = {}
    for name in fields if columns is None else columns:
        if name in leave_out:
            continue
        column, value = fields[name], vars(row)[name]
        if isinstance(column.kind, Nested) and value is None:
            absent[name] = column.help
        else:
            yield from _rows_of_field(menu, name, column, value)
    if absent:
        added, add = " ".join(f"+{name}" for name in absent), partial(_put_value, menu.put, value={})
        yield AddRow(menu.label.strip(), value=added, names=absent, add=add)


def _rows_of_field(menu: _Menu, name: str, column: Column, value: Any) -> Iterator[Widget]:
    kind, help = column.kind, column.help
    shown = f"{menu.label}{name}".replace("_", " ")
    put = partial(_put_value, menu.put, name)
    if isinstance(kind, (Number, Whole)):
        yield _bar(menu, shown, name, column, value)
    elif isinstance(kind, Boolean):
        yield Switch(shown, help, is_on=bool(value), flip=partial(put, not value))
    elif isinstance(kind, OneOf):
        yield Choice(shown, help, names=kind.names, present=str(value), choose=put)
    elif isinstance(kind, Text):
        yield Entry(shown, help, value=str(value), take=put)
    elif isinstance(kind, ColorKind):
        yield Entry(shown, help, value=in_digits(value), take=put)
    elif isinstance(kind, VectorKind) and value is not None:
        yield from _vector_rows(menu, shown, column, value, put)
    elif isinstance(kind, AngleCurveKind):
        yield from _curve_rows(shown, kind, help, value, put)
    elif isinstance(kind, Reference):
        none = (NONE,) if column.is_optional else ()
        names = dict.fromkeys((*none, *kind.words, *menu.world.names.of(kind.table)))
        yield Choice(
            shown,
            help,
            names=tuple(names),
            present=NONE if value is None else value,
            choose=lambda name: put(None if name in none else name),
        )
    elif isinstance(kind, References):
        yield from _list_rows(shown, column, kind.table, value, put, menu.world.names)
    elif isinstance(kind, OneRowOf):
        yield Choice(shown, help, names=tuple(kind.classes), present=kind.name_of(value), choose=put)
        yield from _rows_in(menu, value)
    elif isinstance(kind, Nested) and kind.inline:
        yield from _rows_in(menu, value)
    elif isinstance(kind, Nested):
        axis, edge = name if name in AXES else "", vars(value).get("edge_width", 0.0)
        if "on" in fields_of(type(value)):
            yield Switch(shown, help, is_on=value.on, flip=partial(_put_value, put, "on", not value.on))
        # The menu is narrow: put only the row's own name before the names of its fields.
        yield from _rows_in(_Menu(put, menu.world, f"{name} ", axis, edge), value, ("on",))


def _put_value(put: Put, name: str, value: object) -> object:
    return put({name: value})


def _help(column: Column) -> str:
    """The text of the message line for a number, with its unit."""
    return f"{column.help} In {column.unit}." if column.unit else column.help


def _bar(menu: _Menu, label: str, name: str, column: Column, value: float | None) -> Bar:
    """The bar of a number. A box switches a number that may be absent, or without a limit."""
    axis, kind, is_whole = menu.axis, column.kind, isinstance(column.kind, Whole)
    usual = column.bar or BarRange(0, 1, 0.01)
    if column.unit == WORLD_UNITS and isinstance(kind, Number) and kind.at_least == 0:
        # A length reaches up to the whole size of the object.
        usual = bar_within(0, menu.world.size)
        usual = usual._replace(low=usual.step) if kind.above else usual
    elif column.unit == WORLD_UNITS:
        usual = menu.world.range_of(axis)
    endless = kind.endless if isinstance(kind, Number) else None
    put, present = partial(_put_value, menu.put, name), value
    flip: Callable[[], object] | None = None
    if endless is not None:
        limit = menu.world.end_beyond(axis, endless, menu.edge) if axis else 0.0
        present = None if value == endless else value
        flip = partial(put, limit if present is None else endless)
    elif column.is_optional:
        start = usual.low if column.start is None else column.start
        flip = partial(put, _number(start, is_whole) if value is None else None)
    return Bar(
        label,
        _help(column),
        value=present,
        **usual._asdict(),
        unit=column.unit if len(column.unit) < 8 else "",
        put=lambda value: put(_number(value, is_whole)),
        flip=flip,
    )


def _number(value: float, is_whole: bool) -> float:
    """A number as a column of whole numbers takes it."""
    return int(value) if is_whole and value == int(value) else value


def _vector_rows(menu: _Menu, label: str, column: Column, vector: Vector, put: PutValue) -> Iterator[Widget]:
    def put_component(number: int, value: float) -> object:
        return put((*vector[:number], value, *vector[number + 1 :]))

    for number, axis in enumerate(AXES):
        usual = menu.world.range_of(axis) if column.unit == WORLD_UNITS else BarRange(-1, 1, 0.01)
        yield Bar(
            f"{label} {axis}",
            _help(column),
            value=vector[number],
            **usual._asdict(),
            put=partial(put_component, number),
        )


def _curve_rows(
    label: str, kind: AngleCurveKind, help: str, curve: AngleCurve | None, put: PutValue
) -> Iterator[Widget]:
    """A switch for a curve over angles, and a bar for the share at each of its points."""
    begun = kind.start if curve is None else None
    yield Switch(label, help, is_on=curve is not None, flip=partial(put, begun))
    shares = dict(curve or ())

    def put_share(angle: float, share: float) -> object:
        return put(tuple({**shares, angle: share}.items()))

    for number, (angle, share) in enumerate(shares.items()):
        usual = bar_within(0 if number else kind.least, 1)
        yield Bar(
            f"at {angle:g} degrees", help, value=share, **usual._asdict(), put=partial(put_share, angle)
        )


def _list_rows(
    label: str, column: Column, table: str, value: Sequence[str] | None, put: PutValue, tables: TableNames
) -> Iterator[Widget]:
    """A switch that gives an empty list; below it a switch for each name of a page."""
    begun = () if value is None else None
    yield Switch(label, column.help, is_on=value is not None, flip=partial(put, begun))
    if value is None:
        return
    names, turn = tables.of(table), partial(tables.pages.__setitem__, table)
    help = f"The page of the {len(names)} {table} that is shown below; {len(value)} are in the list."
    shown, turning = paged(names, NAMES_A_PAGE, tables.pages.get(table, 0), help, turn, within=label)
    yield from turning
    for name in shown:
        wanted = {*value} ^ {name}
        chosen = tuple(each for each in names if each in wanted)
        is_in = name in value
        help = f"{'Remove' if is_in else 'Add'} {name} {'from' if is_in else 'to'} the list: {label}."
        yield Switch(f"{INDENT}{name}", help, within=label, is_on=is_in, flip=partial(put, chosen))
