"""The rows of a menu for a row of a table, made from the descriptions of its columns.

So a column that is added to a table appears on the screens by itself: a number as a bar, a switch as a box, a
choice, a text, a vector as three bars, a row within a row with a heading of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

from autocolor.checks import Vector
from autocolor.scene.columns.angle_kinds import AngleCurve, AngleCurveKind
from autocolor.scene.columns.bars import Bar as Range
from autocolor.scene.columns.bars import bar_within
from autocolor.scene.columns.color_kinds import ColorKind, in_digits
from autocolor.scene.columns.column import WORLD_UNITS, Column, Field, Row, bar_of, fields_of
from autocolor.scene.columns.row_kinds import Nested, Variant
from autocolor.scene.columns.value_kinds import Choice as ChoiceKind
from autocolor.scene.columns.value_kinds import Number, Text, VectorKind, Whole
from autocolor.scene.columns.value_kinds import Switch as SwitchKind
from autocolor.widgets.bars import Bar
from autocolor.widgets.widget import Choice, Entry, Switch, Widget

Put = Callable[[Mapping[str, object]], object]
"""Changes fields of the row, by name."""

AXES: Final = "xyz"


class World(NamedTuple):
    """The bounds of the object, from which bars of coordinates get their range."""

    low: Vector
    high: Vector

    def range_of(self, axis: str) -> Range:
        """The usual range of a coordinate: that of the object and its whole size around.

        Without an axis, it is that of all three.
        """
        size = math.dist(self.low, self.high) or 1.0
        low, high = min(self.low), max(self.high)
        if axis:
            low, high = self.low[AXES.index(axis)], self.high[AXES.index(axis)]
        return bar_within(low - size, high + size)


def rows_of(row: Row, put: Put, world: World, leave_out: Sequence[str] = (), label: str = "") -> list[Widget]:
    """The rows for a row of a table, in the order of its columns; `put` is called with what is changed.

    Columns of `leave_out`, tables, references and absent vectors have none. `label` stands before the names.
    """
    found: list[Widget] = []
    for name, field in fields_of(type(row)).items():
        if name not in leave_out:
            value = vars(row)[name]
            found += _rows_of_field(f"{label}{name}", name, field, value, put, world)
    return found


def _rows_of_field(
    label: str, name: str, field: Field, value: Any, put: Put, world: World
) -> Iterator[Widget]:
    column = field.column
    kind, told = column.kind, column.help
    shown = label.replace("_", " ")
    if isinstance(kind, (Number, Whole)):
        yield _bar(shown, name, field, value, put, world)
    elif isinstance(kind, SwitchKind):
        yield Switch(shown, told, is_on=bool(value), flip=partial(_put, put, name, not value))
    elif isinstance(kind, ChoiceKind):
        choose = partial(_put, put, name)
        yield Choice(shown, told, names=kind.names, present=str(value), choose=choose)
    elif isinstance(kind, Text):
        yield Entry(shown, told, value=str(value), take=partial(_put, put, name))
    elif isinstance(kind, ColorKind):
        yield Entry(shown, told, value=in_digits(value), take=partial(_put, put, name))
    elif isinstance(kind, VectorKind) and value is not None:
        yield from _vector_rows(shown, name, column, value, put, world)
    elif isinstance(kind, AngleCurveKind):
        yield from _curve_rows(shown, name, kind, told, value, put)
    elif isinstance(kind, Variant):
        choose = partial(_put, put, name)
        yield Choice(shown, told, names=tuple(kind.classes), present=kind.name_of(value), choose=choose)
        yield from rows_of(value, put, world)
    elif isinstance(kind, Nested):
        yield from _nested_rows(label, name, kind, told, value, put, world)


def _nested_rows(
    label: str, name: str, kind: Nested, told: str, value: Any, put: Put, world: World
) -> Iterator[Widget]:
    """The rows of a row within a row; of an absent one, a switch that makes it."""
    if kind.inline:
        yield from rows_of(value, put, world)
        return
    inner = partial(_put, put, name)
    shown = label.replace("_", " ")
    if value is None:
        yield Switch(shown, told, is_on=False, flip=partial(inner, {}))
        return
    if "on" in fields_of(kind.row_class):
        flip = partial(inner, {"on": not value.on})
        yield Switch(shown, told, is_on=value.on, flip=flip)
    # In a narrow menu the name of the row itself is enough before those of its fields.
    yield from rows_of(value, inner, world, leave_out=("on",), label=f"{name} ")


def _bar(label: str, name: str, field: Field, value: float | None, put: Put, world: World) -> Bar:
    """The bar of a number; one that may be absent, or without a limit, has a box that switches it."""
    column = field.column
    kind = column.kind
    axis = next((word for word in label.split() if len(word) == 1 and word in AXES), "")
    usual = world.range_of(axis) if column.unit == WORLD_UNITS else bar_of(column) or Range(0, 1, 0.01)
    endless = kind.endless if isinstance(kind, Number) else None
    flip: Callable[[], object] | None = None
    present = value
    if endless is not None:
        limit = (world.low if endless < 0 else world.high)[AXES.find(axis)] if axis else 0.0
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


def _vector_rows(
    label: str, name: str, column: Column, value: Vector, put: Put, world: World
) -> Iterator[Widget]:
    for number, axis in enumerate(AXES):
        usual = world.range_of(axis) if column.unit == WORLD_UNITS else Range(-1, 1, 0.01)
        yield Bar(
            f"{label} {axis}",
            _help(column),
            value=value[number],
            low=usual.low,
            high=usual.high,
            step=usual.step,
            put=partial(_put_component, put, name, value, number),
        )


def _curve_rows(
    label: str, name: str, kind: AngleCurveKind, told: str, curve: AngleCurve | None, put: Put
) -> Iterator[Widget]:
    """A switch for a curve over angles, and a bar for the share of each of its points."""
    begun = kind.start if curve is None else None
    yield Switch(label, told, is_on=curve is not None, flip=partial(_put, put, name, begun))
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
            put=partial(_put_share, put, name, curve, number),
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
