"""What columns determine for rows: changes of fields, plain values as in files, and the cost of an edit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from autocolor.checks import listed, shown
from autocolor.scene.columns.column import Row, SomeRow, Tier, check, fields_of, keys_of, row_label
from autocolor.scene.columns.problems import REFUSED, Problem, RowError, unknown

MOST_KEYS: Final = 64
"""Assumed: an upper bound on the keys of any table."""

PLAIN_TYPES: Final = frozenset((float, int, bool, str, tuple, list))
"""Types of most values, none of them a table; asking for `Mapping` takes several times as long."""


def changed(row: SomeRow, changes: Mapping[str, Any]) -> SomeRow:
    """The row with some fields or keys changed; a table for a row inside it changes that row's keys.

    Raises RowError with every problem.

    Measured: with cold caches each call costs more than what it computes, so this one makes few.
    """
    fields = fields_of(type(row))
    problems: list[Problem] = []
    values, inside = _values_by_field(row, changes, problems)
    # Copy the columns only: cached properties may depend on them.
    copy = object.__new__(type(row))
    present, fresh = vars(row), vars(copy)
    fresh.update(present if len(present) == len(fields) else {name: present[name] for name in fields})
    fresh.update(values)
    for name, table in inside.items():
        fresh[name] = fields[name].column.kind.changed(fresh[name], table, (name,), problems)
        if not isinstance(fresh[name], Row):
            values[name] = fresh[name]
    if values or type(row).rules is not Row.rules:
        try:
            check(copy, {name: fields[name] for name in values})
        except RowError as error:
            problems.extend(error.found)
    if problems:
        raise RowError(problems, row_label(row))
    return copy


def with_values(row: SomeRow, values: Mapping[str, object]) -> SomeRow:
    """The row with other values in some fields, which were checked already.

    Cached properties are copied, too: none may depend on these fields.
    """
    copy = object.__new__(type(row))
    fresh = vars(copy)
    fresh.update(vars(row))
    fresh.update(values)
    return copy


def _values_by_field(
    row: Row, changes: Mapping[str, Any], problems: list[Problem]
) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """The new values of fields, and the tables of keys for the rows inside others.

    Problems are appended, and unknown names left out.
    """
    if len(changes) > MOST_KEYS:
        text = f"it must be a table of at most {MOST_KEYS} keys, not {len(changes):,}"
        raise RowError([Problem((), text)], row_label(row))
    fields, keys = fields_of(type(row)), keys_of(type(row))
    values: dict[str, Any] = {}
    inside: dict[str, dict[str, Any]] = {}
    for name, value in changes.items():
        key = keys.get(name)
        if key is not None and key.is_inside:
            inside.setdefault(key.field, {})[name] = value
        elif name not in fields:
            problems.append(unknown(name, {**fields, **keys}))
        elif type(value) not in PLAIN_TYPES and isinstance(value, Mapping):
            inside.setdefault(name, {}).update(value)
        else:
            values[name] = value
    if row.alternatives and any(values.get(name) is not None for name in row.alternatives):
        values = {**dict.fromkeys(row.alternatives), **values}
    return values, inside


def made(cls: type[SomeRow], table: object) -> SomeRow:
    """The row of a class for a table of keys and plain values; omitted keys have their defaults.

    Raises RowError with every problem.
    """
    if not isinstance(table, Mapping):
        raise RowError([Problem((), f"must be a table of {listed(keys_of(cls))}, not {shown(table)}")])
    fields = fields_of(cls)
    row = object.__new__(cls)
    vars(row).update(
        {name: REFUSED if field.default is None else field.default() for name, field in fields.items()}
    )
    problems: list[Problem] = []
    values, inside = _values_by_field(row, table, problems)
    problems.extend(
        Problem((name,), f"{name} {field.column.kind.rule()}, not missing; add it", names_key=True)
        for name, field in fields.items()
        if field.default is None and name not in values and name not in inside
    )
    made_row = vars(row)
    made_row.update(values)
    for name, keys in inside.items():
        made_row[name] = fields[name].column.kind.changed(made_row[name], keys, (name,), problems)
    try:
        check(row, fields)
    except RowError as error:
        problems.extend(error.found)
    if problems:
        raise RowError(problems, row_label(row))
    return row


def plain(row: Row) -> dict[str, object]:
    """The row as keys and plain values, which TOML and JSON can hold; None values are omitted."""
    values = vars(row)
    return {
        key: value
        for name, field in fields_of(type(row)).items()
        if values[name] is not None
        for key, value in field.column.kind.written(name, values[name]).items()
        if value is not None
    }


def difference(one: Row, other: Row) -> dict[str, object]:
    """The keys and plain values by which `changed` makes one row equal to another of its class.

    A value that is taken away is None; an infinite one is written as it is. Meshes are left out.
    """
    ones, others = vars(one), vars(other)
    told: dict[str, object] = {}
    for name, field in fields_of(type(one)).items():
        before, after, kind = ones[name], others[name], field.column.kind
        if before is after:
            continue
        if after is None:
            told[name] = None
        elif before is None:
            told.update(kind.written(name, after))
        else:
            told.update(kind.difference(name, before, after))
    return told


def cost(one: Row, other: Row, own: Tier = Tier.FRAME) -> Tier | None:
    """The cost of an edit from one row to another: the largest of its columns; None if all are equal.

    For rows of different classes it is `own`.
    """
    if type(one) is not type(other):
        return own
    ones, others = vars(one), vars(other)
    most: Tier | None = None
    for name, (column, _, _) in fields_of(type(one)).items():
        if ones[name] is not others[name]:
            costs = column.kind.cost(ones[name], others[name], column.tier)
            if costs is not None and (most is None or costs > most):
                most = costs
    return most
