"""The description of the difference of two scenes, in the words of the columns.

    key: intensity 1 -> 0.8
    body: object color #b01020; view: eye
    light fill added

It is derived from the columns, so a new column is described without a line here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any, Final, NamedTuple

from autocolor.scene.columns import MISSING, Kind, Row, fields_of, reset_fields
from autocolor.scene.kinds import ColorKind, ColorsKind, VectorKind, in_digits
from autocolor.scene.row_kinds import NamedRows, Nested, OneRowOf, RowList
from autocolor.scene.scene import Scene

SEVERAL: Final = 2
"""Rows of a table that are counted instead of named, if the names do not fit."""

FEWEST_DIGITS: Final = 4
"""Digits of a number, unless more are needed to tell two numbers apart."""

EXACT_DIGITS: Final = 17


class ColumnChange(NamedTuple):
    """A column that differs, as in "flaps z on", and its values, as in "1 -> 0.8"; empty for long values."""

    column: str
    values: str = ""

    def __str__(self) -> str:
        return f"{self.column} {self.values}" if self.values else self.column


class RowChange(NamedTuple):
    """A row that differs: the noun of its table, its name, and its columns that differ.

    Without columns, `verb` is "added" or "removed".
    """

    noun: str
    name: str
    columns: Sequence[ColumnChange] = ()
    verb: str = ""

    @property
    def title(self) -> str:
        """The noun and the name of the row. The scene's own columns have no row, so they stand for it."""
        if not self.name:
            return self.text(has_values=False)
        return self.name if self.name.startswith(self.noun) else f"{self.noun} {self.name}"

    @property
    def label(self) -> str:
        """The name before its columns. Parts often have the names of surfaces, so they keep their noun."""
        return self.title if self.noun == "part" else self.name

    def text(self, has_values: bool) -> str:
        """The columns, with or without their values; for a row without columns, the verb."""
        return self.verb or ", ".join(str(each) if has_values else each.column for each in self.columns)


def describe_look(before: Scene, after: Scene, most: int = 80) -> str:
    """The difference between the looks of two scenes, as `describe` says it: their views are left out."""
    return describe(before.replace(view=after.view), after, most)


def describe(before: Scene, after: Scene, most: int = 80) -> str:
    """The difference between two scenes in a line, empty if they are equal.

    The line has as much detail as fits in `most` characters: the columns with their values, the columns, the
    names of the rows, or at least how many rows differ. The shortest of these may be longer.

        describe(scene, scene.with_light("key", intensity=0.8))   # "key: intensity 1 -> 0.8"
    """
    if before.mesh is not after.mesh:
        return f"scene {after.name}"
    rows = list(_changed_rows(before, after))
    lines = [
        "; ".join(_with_columns(rows, has_values=True)),
        "; ".join(_with_columns(rows, has_values=False)),
        ", ".join(row.title for row in rows),
        ", ".join(_counted(rows)),
    ]
    return next((line for line in lines if len(line) <= most), lines[-1])


def _with_columns(rows: Sequence[RowChange], has_values: bool) -> Iterator[str]:
    """The rows with their columns; neighboring rows with the same text have it once: "key, rim: off"."""
    for text, group in groupby(rows, key=lambda row: row.text(has_values)):
        same = list(group)
        if same[0].verb:
            yield f"{', '.join(row.title for row in same)} {text}"
        elif same[0].name:
            yield f"{', '.join(row.label for row in same)}: {text}"
        else:
            yield text


def _counted(rows: Sequence[RowChange]) -> Iterator[str]:
    """The rows, or the number of rows of a table where several differ."""
    for noun, group in groupby(rows, key=lambda row: row.noun):
        same = list(group)
        if noun and len(same) >= SEVERAL:
            yield f"{len(same)} {noun}s"
        else:
            yield from ((row.name and row.title) or "settings" for row in same)


def _changed_rows(before: Scene, after: Scene) -> Iterator[RowChange]:
    """The rows that differ, in the order of the tables, and then the columns of the scene itself."""
    own: list[ColumnChange] = []
    for name, field in fields_of(Scene).items():
        one, other, kind = vars(before)[name], vars(after)[name], field.kind
        if name == "mesh" or one is other or one == other:
            continue
        if isinstance(kind, RowList):
            yield from _changed_rows_of(kind.row_class.noun, one, other)
        elif isinstance(kind, Nested) and None not in (one, other):
            columns = list(_changes(one, other))
            if columns:
                yield RowChange("", name, columns)
        elif isinstance(kind, Nested):
            row = other or one
            yield RowChange(name, vars(row).get("name", ""), verb="added" if one is None else "removed")
        else:
            own += _changes_of_value(name, kind, one, other)
    if own:
        yield RowChange("", "", own)


def _changed_rows_of(noun: str, before: Sequence[Any], after: Sequence[Any]) -> Iterator[RowChange]:
    """The rows that differ in a table. Rows are matched by name, or by place where rows are renamed."""
    befores, afters = ({row.name: row for row in rows} for rows in (before, after))
    if len(before) == len(after) and befores.keys() != afters.keys():
        pairs = list(zip(before, after, strict=True))
    else:
        pairs = [(row, afters.get(row.name)) for row in before]
        pairs += [(None, row) for row in after if row.name not in befores]
    changes = []
    for one, other in pairs:
        if other is None:
            changes.append(RowChange(noun, one.name, verb="removed"))
        elif one is None:
            changes.append(RowChange(noun, other.name, verb="added"))
        elif columns := list(_changes(one, other)):
            changes.append(RowChange(noun, one.name, columns))
    if not changes and list(befores) != list(afters):
        changes.append(RowChange("", f"{noun}s", [ColumnChange("order")]))
    yield from changes


def _changes(before: Row | None, after: Row, path: str = "") -> Iterator[ColumnChange]:
    """The columns in which two rows of a class differ.

    Without a row before, the new row is compared with the defaults of its columns.
    """
    resets = reset_fields(after)
    for name, field in fields_of(type(after)).items():
        if name in resets and vars(after)[name] is not None:
            continue
        other, kind = vars(after)[name], field.kind
        if before is not None:
            one = vars(before)[name]
        else:
            one = None if field.default is MISSING else field.default
        if one is other or one == other:
            continue
        yield from _changes_of_value(f"{path}{_words(name)}", kind, one, other, path)


def _changes_of_value(
    label: str, kind: Kind[Any], one: Any, other: Any, path: str = ""
) -> Iterator[ColumnChange]:
    """The changes of a column from one value to another; `path` stands before the columns of inline rows."""
    label = _words(label)
    if isinstance(kind, Nested):
        if other is None:
            yield ColumnChange(f"no {label}")
            return
        inner = list(_changes(one, other, path if kind.inline else f"{label} "))
        # A new row may have the defaults in all columns.
        yield from inner or [ColumnChange(f"{label} on")]
    elif isinstance(kind, OneRowOf):
        is_same_class = type(one) is type(other)
        if not is_same_class:
            yield ColumnChange(label, f"{kind.name_of(one)} -> {kind.name_of(other)}")
        yield from _changes(one if is_same_class else None, other, path)
    elif isinstance(kind, NamedRows):
        ones, others = ({row.name: row for row in rows or ()} for rows in (one, other))
        for name in dict.fromkeys([*ones, *others]):
            if name not in others:
                yield ColumnChange(f"no {label} {name}")
            elif ones.get(name) != others[name]:
                changes = _changes(ones.get(name), others[name], f"{label} {name} ")
                yield from (each for each in changes if each.column != f"{label} {name} name")
    elif isinstance(kind, VectorKind) and None not in (one, other):
        axes = [number for number in range(3) if one[number] != other[number]]
        if len(axes) == 1:
            label, one, other = f"{label} {'xyz'[axes[0]]}", one[axes[0]], other[axes[0]]
            yield ColumnChange(label, " -> ".join(_numbers(one, other)))
        else:
            yield ColumnChange(label)
    elif isinstance(other, bool):
        # The column "on" is a switch, which says its state: "key: off".
        state = "on" if other else "off"
        yield ColumnChange(f"{path}{state}" if label == f"{path}on" else f"{label} {state}")
    else:
        yield ColumnChange(label, _arrow(kind, one, other))


def _arrow(kind: Kind[Any], one: Any, other: Any) -> str:
    """Two values with an arrow between them; colors or another long value alone; empty for a list."""
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        texts: Sequence[str] = _numbers(one, other)
    else:
        texts = [_text(kind, value) for value in (one, other)]
    return " -> ".join(texts) if all(texts) and not isinstance(kind, (ColorKind, ColorsKind)) else texts[1]


def _text(kind: Kind[Any], value: Any) -> str:
    """A value as short text; empty for a list, except a list of colors."""
    if value is None:
        return "none"
    if isinstance(kind, ColorKind):
        return in_digits(value)
    if isinstance(kind, ColorsKind):
        return " ".join(map(in_digits, value))
    if isinstance(value, (int, float)):
        return f"{value:.{FEWEST_DIGITS}g}"
    return value if isinstance(value, str) else ""


def _numbers(one: float, other: float) -> list[str]:
    """Two numbers in the fewest digits that tell them apart."""
    for digits in range(FEWEST_DIGITS, EXACT_DIGITS + 1):
        texts = [f"{value:.{digits}g}" if math.isfinite(value) else "none" for value in (one, other)]
        if texts[0] != texts[1]:
            break
    return texts


def _words(name: str) -> str:
    return name.replace("_", " ")
