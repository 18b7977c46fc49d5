"""The rows of a menu for a row of a table, derived from the descriptions of its columns.

So a new column of a table appears on the screens by itself. A number is a bar, a switch a box, a vector three
bars; a choice and a text are rows of their own. The name of a nested row stands before the names of its
columns. A list of names has a switch for the whole list, and a box for each name of a table; many names come
in pages, so that they do not fill the menu.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
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
from autocolor.scene.row_kinds import NamedRows, Nested, OneRowOf, Reference, References, Referring
from autocolor.widgets.bars import Bar, bar_within, rounded_to
from autocolor.widgets.widget import Choice, Entry, Heading, Switch, Widget, short_label

Put = Callable[[Mapping[str, object]], object]
"""Changes fields of the row, by name."""

AXES: Final = "xyz"

TakeNames = Callable[[Any], object]
"""Takes a name, names, or None."""

NAMES_A_PAGE: Final = 12
"""Assumed: names that are shown at once; two lists of so many fit in a menu."""

LONGEST_LABEL: Final = 14
"""Characters of a label beside a box."""

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

        It is at least `margin` and less than two steps of the axis's bar away.
        """
        low, high = self.everything or (self.low, self.high)
        step = self.range_of(axis).step
        number = AXES.index(axis)
        farthest = high[number] if sign > 0 else -low[number]
        end = rounded_to((math.floor((farthest + margin) / step) + 1) * step, step)
        return end if sign > 0 else -end

    def range_of_lengths(self, is_zero_left_out: bool) -> BarRange:
        """The usual range of a length: up to the whole size of the object."""
        usual = bar_within(0, self.size)
        return usual._replace(low=usual.step) if is_zero_left_out else usual


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

    With `columns`, only these columns have rows, in this order. Columns of `leave_out`, tables, held ranges
    and absent vectors have no rows.
    """
    return list(_rows_in(_Menu(put, world), row, leave_out, columns))


def _rows_in(
    menu: _Menu, row: Row, leave_out: Sequence[str] = (), columns: Sequence[str] | None = None
) -> Iterator[Widget]:
    fields = fields_of(type(row))
    for name in fields if columns is None else columns:
        if name not in leave_out:
            yield from _rows_of_field(menu, name, fields[name], vars(row)[name])


def _rows_of_field(menu: _Menu, name: str, column: Column, value: Any) -> Iterator[Widget]:
    kind, help = column.kind, column.help
    shown = f"{menu.label}{name}".replace("_", " ")
    put = partial(_put, menu.put, name)
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
        yield from _vector_rows(menu, shown, name, column, value)
    elif isinstance(kind, AngleCurveKind):
        yield from _curve_rows(menu, shown, name, kind, help, value)
    elif isinstance(kind, Referring):
        yield from reference_rows(shown, column, kind, value, put, menu.world.names)
    elif isinstance(kind, OneRowOf):
        yield Choice(shown, help, names=tuple(kind.classes), present=kind.name_of(value), choose=put)
        yield from _rows_in(menu, value)
    elif isinstance(kind, Nested) and kind.inline:
        yield from _rows_in(menu, value)
    elif isinstance(kind, Nested):
        axis, edge = name if name in AXES else "", vars(value).get("edge_width", 0.0) if value else 0.0
        # The menu is narrow: put only the row's own name before the names of its fields.
        inside = _Menu(put, menu.world, f"{name} ", axis, edge)
        yield from _rows_of_row(inside, shown, help, value)
    elif isinstance(kind, NamedRows):
        if value:
            yield Heading(shown)
        for row in value:
            inside = _Menu(partial(_put, put, row.name), menu.world, INDENT)
            for each in _rows_of_row(inside, row.name, help, row, ("name",)):
                # Other named rows have the same labels.
                yield replace(each, within=f"{name}.{row.name}", help=f"{row.name}: {each.help}")


def _rows_of_row(
    menu: _Menu, label: str, help: str, row: Row | None, leave_out: Sequence[str] = ()
) -> Iterator[Widget]:
    """The rows of a nested row, after its own switch if it has one. An absent row is a switch alone."""
    if row is None:
        yield Switch(label, help, is_on=False, flip=partial(menu.put, {}))
        return
    if "on" in fields_of(type(row)):
        is_on = vars(row)["on"]
        yield Switch(label, help, is_on=is_on, flip=partial(_put, menu.put, "on", not is_on))
    yield from _rows_in(menu, row, (*leave_out, "on"))


def _bar(menu: _Menu, label: str, name: str, column: Column, value: float | None) -> Bar:
    """The bar of a number. A box switches a number that may be absent, or without a limit."""
    put, axis = menu.put, menu.axis
    kind = column.kind
    usual = column.bar or BarRange(0, 1, 0.01)
    if column.unit == WORLD_UNITS and isinstance(kind, Number) and kind.at_least == 0:
        usual = menu.world.range_of_lengths(is_zero_left_out=kind.above)
    elif column.unit == WORLD_UNITS:
        usual = menu.world.range_of(axis)
    endless = kind.endless if isinstance(kind, Number) else None
    flip: Callable[[], object] | None = None
    present = value
    if endless is not None:
        limit = menu.world.end_beyond(axis, endless, menu.edge) if axis else 0.0
        present = None if value == endless else value
        flip = partial(_put, put, name, limit if present is None else endless)
    elif column.is_optional:
        start = usual.low if column.start is None else column.start
        start = int(start) if isinstance(kind, Whole) else start
        flip = partial(_put, put, name, start if value is None else None)
    return Bar(
        label,
        _help(column),
        value=present,
        **usual._asdict(),
        unit=column.unit if len(column.unit) < 8 else "",
        put=partial(_put_number, put, name, isinstance(kind, Whole)),
        flip=flip,
    )


def _vector_rows(menu: _Menu, label: str, name: str, column: Column, value: Vector) -> Iterator[Widget]:
    for number, axis in enumerate(AXES):
        is_place = column.unit == WORLD_UNITS
        usual = menu.world.range_of(axis) if is_place else BarRange(-1, 1, 0.01)
        yield Bar(
            f"{label} {axis}",
            _help(column),
            value=value[number],
            **usual._asdict(),
            put=partial(_put_component, menu.put, name, value, number),
        )


def _curve_rows(
    menu: _Menu, label: str, name: str, kind: AngleCurveKind, help: str, curve: AngleCurve | None
) -> Iterator[Widget]:
    """A switch for a curve over angles, and a bar for the share at each of its points."""
    begun = kind.start if curve is None else None
    yield Switch(label, help, is_on=curve is not None, flip=partial(_put, menu.put, name, begun))
    curve = curve or ()
    for number, (angle, share) in enumerate(curve):
        usual = bar_within(0 if number else kind.least, 1)
        yield Bar(
            f"at {angle:g} degrees",
            help,
            value=share,
            **usual._asdict(),
            put=partial(_put_share, menu.put, name, curve, number),
        )


def reference_rows(
    label: str, column: Column, kind: Referring[Any], value: Any, take: TakeNames, tables: TableNames
) -> Iterator[Widget]:
    """The rows for a column of names; `take` is called with the new name or names."""
    names = tables.of(kind.table)
    if isinstance(kind, References):
        yield from _list_rows(label, column, value, take, tables.pages, (kind.table, names))
    elif isinstance(kind, Reference):
        first = (NONE,) if column.is_optional else ()
        word = kind.words
        yield Choice(
            label,
            column.help,
            names=(*first, *word, *(name for name in names if name not in (*first, *word))),
            present=NONE if value is None else value,
            choose=partial(_choose, take, column.is_optional),
        )


def _list_rows(
    label: str,
    column: Column,
    value: Sequence[str] | None,
    take: TakeNames,
    pages: dict[str, int],
    table: tuple[str, Sequence[str]],
) -> Iterator[Widget]:
    """A switch that gives an empty list; below it a switch for each name of a page."""
    what, names = table
    is_given = value is not None
    short = short_label(label, LONGEST_LABEL)
    yield Switch(short, column.help, is_on=is_given, flip=partial(take, None if is_given else ()))
    if value is None:
        return
    page = min(pages.get(what, 0), max(0, len(names) - 1) // NAMES_A_PAGE)
    if len(names) > NAMES_A_PAGE:
        numbers = range(0, len(names), NAMES_A_PAGE)
        titles = [f"{first + 1} to {min(first + NAMES_A_PAGE, len(names))}" for first in numbers]
        yield Choice(
            what,
            within=label,
            help=f"The page of the {len(names)} {what} that is shown below; {len(value)} are in the list.",
            names=titles,
            present=titles[page],
            choose=lambda title: pages.__setitem__(what, titles.index(title)),
            turns_pages=True,
        )
    for name in names[page * NAMES_A_PAGE : (page + 1) * NAMES_A_PAGE]:
        wanted = {*value} ^ {name}
        chosen = tuple(each for each in names if each in wanted)
        is_in = name in value
        help = f"{'Remove' if is_in else 'Add'} {name} {'from' if is_in else 'to'} the list: {label}."
        yield Switch(f"{INDENT}{name}", help, within=label, is_on=is_in, flip=partial(take, chosen))


def _choose(take: TakeNames, has_none: bool, name: str) -> object:
    return take(None if has_none and name == NONE else name)


def _help(column: Column) -> str:
    """The text of the message line for a number, with its unit."""
    return f"{column.help} In {column.unit}." if column.unit else column.help


def _put(put: Put, name: str, value: object) -> object:
    return put({name: value})


def _put_number(put: Put, name: str, is_whole: bool, value: float) -> object:
    return put({name: int(value) if is_whole and value == int(value) else value})


def _put_share(put: Put, name: str, curve: AngleCurve, number: int, share: float) -> object:
    return put({name: (*curve[:number], (curve[number][0], share), *curve[number + 1 :])})


def _put_component(put: Put, name: str, vector: Vector, number: int, value: float) -> object:
    return put({name: (*vector[:number], value, *vector[number + 1 :])})
