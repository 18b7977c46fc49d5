"""The rows of a menu for a row of a table, made from the descriptions of its columns.

So a column that is added to a table appears on the screens by itself: a number as a bar, a switch as a box, a
choice, a text, a vector as three bars, a row within a row with its name before those of its columns, a list
of names as a box for each.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final, NamedTuple

from autocolor.checks import Vector
from autocolor.scene.columns.angle_kinds import AngleCurve, AngleCurveKind
from autocolor.scene.columns.bars import Bar as Range
from autocolor.scene.columns.bars import bar_within
from autocolor.scene.columns.color_kinds import ColorKind, in_digits
from autocolor.scene.columns.column import WORLD_UNITS, Column, Field, Row, bar_of, fields_of
from autocolor.scene.columns.named_row_kinds import NamedRows
from autocolor.scene.columns.reference_kinds import Referring
from autocolor.scene.columns.row_kinds import Nested, Variant
from autocolor.scene.columns.value_kinds import Choice as ChoiceKind
from autocolor.scene.columns.value_kinds import Number, Text, VectorKind, Whole
from autocolor.scene.columns.value_kinds import Switch as SwitchKind
from autocolor.widgets.bars import Bar
from autocolor.widgets.name_rows import INDENT, KnownNames, reference_rows
from autocolor.widgets.widget import Choice, Entry, Heading, Switch, Widget

Put = Callable[[Mapping[str, object]], object]
"""Changes fields of the row, by name."""

AXES: Final = "xyz"


class World(NamedTuple):
    """The bounds of the object, from which bars of coordinates get their range, and the names of tables."""

    low: Vector
    high: Vector
    names: KnownNames = KnownNames(lambda _: (), {})

    @property
    def size(self) -> float:
        """The whole size of the object, from its least corner to its largest; 1 for a point."""
        return math.dist(self.low, self.high) or 1.0

    def range_of(self, axis: str) -> Range:
        """The usual range of a coordinate: that of the object and its whole size around.

        Without an axis, it is that of all three.
        """
        low, high = min(self.low), max(self.high)
        if axis:
            low, high = self.low[AXES.index(axis)], self.high[AXES.index(axis)]
        return bar_within(low - self.size, high + self.size)

    def range_of_lengths(self, is_zero_left_out: bool) -> Range:
        """The usual range of a length: up to the whole size of the object."""
        usual = bar_within(0, self.size)
        return usual._replace(low=usual.step) if is_zero_left_out else usual


class _Menu(NamedTuple):
    """What the rows of a row of a table are made with; `label` stands before the names of its columns.

    `axis` is the axis of its coordinates, where it is a row for one axis.
    """

    put: Put
    world: World
    label: str = ""
    axis: str = ""


def rows_of(row: Row, put: Put, world: World, leave_out: Sequence[str] = ()) -> list[Widget]:
    """The rows for a row of a table, in the order of its columns; `put` is called with what is changed.

    Columns of `leave_out`, tables, held ranges and absent vectors have none.
    """
    return list(_rows_in(_Menu(put, world), row, leave_out))


def _rows_in(menu: _Menu, row: Row, leave_out: Sequence[str] = ()) -> Iterator[Widget]:
    for name, field in fields_of(type(row)).items():
        if name not in leave_out:
            yield from _rows_of_field(menu, name, field, vars(row)[name])


def _rows_of_field(menu: _Menu, name: str, field: Field, value: Any) -> Iterator[Widget]:
    column = field.column
    kind, told = column.kind, column.help
    shown = f"{menu.label}{name}".replace("_", " ")
    put = partial(_put, menu.put, name)
    if isinstance(kind, (Number, Whole)):
        yield _bar(menu, shown, name, field, value)
    elif isinstance(kind, SwitchKind):
        yield Switch(shown, told, is_on=bool(value), flip=partial(put, not value))
    elif isinstance(kind, ChoiceKind):
        yield Choice(shown, told, names=kind.names, present=str(value), choose=put)
    elif isinstance(kind, Text):
        yield Entry(shown, told, value=str(value), take=put)
    elif isinstance(kind, ColorKind):
        yield Entry(shown, told, value=in_digits(value), take=put)
    elif isinstance(kind, VectorKind) and value is not None:
        yield from _vector_rows(menu, shown, name, column, value)
    elif isinstance(kind, AngleCurveKind):
        yield from _curve_rows(menu, shown, name, kind, told, value)
    elif isinstance(kind, Referring):
        yield from reference_rows(shown, field, kind, value, put, menu.world.names)
    elif isinstance(kind, Variant):
        yield Choice(shown, told, names=tuple(kind.classes), present=kind.name_of(value), choose=put)
        yield from _rows_in(menu, value)
    elif isinstance(kind, Nested) and kind.inline:
        yield from _rows_in(menu, value)
    elif isinstance(kind, Nested):
        axis = name if name in AXES else ""
        # In a narrow menu the name of the row itself is enough before those of its fields.
        inside = _Menu(put, menu.world, f"{name} ", axis)
        yield from _rows_of_row(inside, shown, told, value)
    elif isinstance(kind, NamedRows):
        if value:
            yield Heading(shown)
        for row in value:
            inside = _Menu(partial(_put, put, row.name), menu.world, INDENT)
            for each in _rows_of_row(inside, row.name, told, row, ("name",)):
                # Others have rows of the same labels.
                yield replace(each, within=f"{name}.{row.name}", help=f"{row.name}: {each.help}")


def _rows_of_row(
    menu: _Menu, label: str, told: str, row: Row | None, leave_out: Sequence[str] = ()
) -> Iterator[Widget]:
    """The rows of a row within a row, after its own switch if it has one; of an absent row, what makes it."""
    if row is None:
        yield Switch(label, told, is_on=False, flip=partial(menu.put, {}))
        return
    if "on" in fields_of(type(row)):
        is_on = vars(row)["on"]
        yield Switch(label, told, is_on=is_on, flip=partial(_put, menu.put, "on", not is_on))
    yield from _rows_in(menu, row, (*leave_out, "on"))


def _bar(menu: _Menu, label: str, name: str, field: Field, value: float | None) -> Bar:
    """The bar of a number; one that may be absent, or without a limit, has a box that switches it."""
    column, put, axis = field.column, menu.put, menu.axis
    kind = column.kind
    usual = bar_of(column) or Range(0, 1, 0.01)
    if column.unit == WORLD_UNITS and isinstance(kind, Number) and kind.at_least == 0:
        usual = menu.world.range_of_lengths(is_zero_left_out=kind.above)
    elif column.unit == WORLD_UNITS:
        usual = menu.world.range_of(axis)
    endless = kind.endless if isinstance(kind, Number) else None
    flip: Callable[[], object] | None = None
    present = value
    if endless is not None:
        limit = (menu.world.low if endless < 0 else menu.world.high)[AXES.find(axis)] if axis else 0.0
        present = None if value == endless else value
        flip = partial(_put, put, name, limit if present is None else endless)
    elif field.is_optional:
        start = usual.low if column.start is None else column.start
        start = int(start) if isinstance(kind, Whole) else start
        flip = partial(_put, put, name, start if value is None else None)
    return Bar(
        label,
        _help(column),
        value=present,
        low=usual.low,
        high=usual.high,
        step=usual.step,
        unit=column.unit if len(column.unit) < 8 else "",
        put=partial(_put_number, put, name, isinstance(kind, Whole)),
        flip=flip,
    )


def _vector_rows(menu: _Menu, label: str, name: str, column: Column, value: Vector) -> Iterator[Widget]:
    for number, axis in enumerate(AXES):
        is_place = column.unit == WORLD_UNITS
        usual = menu.world.range_of(axis) if is_place else Range(-1, 1, 0.01)
        yield Bar(
            f"{label} {axis}",
            _help(column),
            value=value[number],
            low=usual.low,
            high=usual.high,
            step=usual.step,
            put=partial(_put_component, menu.put, name, value, number),
        )


def _curve_rows(
    menu: _Menu, label: str, name: str, kind: AngleCurveKind, told: str, curve: AngleCurve | None
) -> Iterator[Widget]:
    """A switch for a curve over angles, and a bar for the share of each of its points."""
    begun = kind.start if curve is None else None
    yield Switch(label, told, is_on=curve is not None, flip=partial(_put, menu.put, name, begun))
    curve = curve or ()
    for number, (angle, share) in enumerate(curve):
        limits = kind.share_kind(number)
        usual = bar_within(limits.at_least, limits.at_most)
        yield Bar(
            f"at {angle:g} degrees",
            told,
            value=share,
            low=usual.low,
            high=usual.high,
            step=usual.step,
            put=partial(_put_share, menu.put, name, curve, number),
        )


def _help(column: Column) -> str:
    """What the message line says of a number: what it is, and its unit."""
    return f"{column.help} In {column.unit}." if column.unit else column.help


def _put(put: Put, name: str, value: object) -> object:
    return put({name: value})


def _put_number(put: Put, name: str, is_whole: bool, value: float) -> object:
    return put({name: int(value) if is_whole and value == int(value) else value})


def _put_share(put: Put, name: str, curve: AngleCurve, number: int, share: float) -> object:
    return put({name: (*curve[:number], (curve[number][0], share), *curve[number + 1 :])})


def _put_component(put: Put, name: str, vector: Vector, number: int, value: float) -> object:
    return put({name: (*vector[:number], value, *vector[number + 1 :])})
