"""The rows of mapped tables: checked in chunks, and converted where rendering does not read them as they are.

Rows are counted from 0, as numpy does. A table is held as it is if it has the type and the order that
rendering reads; any other is copied, in chunks too.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Booleans, chunks
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.immutable import read_only
from autocolor.logs import logger_of

LOG: Final = logger_of(__name__)

ROWS_AT_ONCE: Final = 1 << 16

UNIT: Final = 1e-3
"""Assumed: how far the length of a unit vector may be from 1."""

Rule = Callable[[AnyArray], Booleans]
"""Which of some rows, (columns, rows), are right."""


def checked(name: str, table: AnyArray, thing: str, rule: Rule, remedy: str) -> None:
    """Raise InputError for the first row of a table, (rows,) or (rows, columns), that is not right.

    `thing` says what must be, in the words of the refusal.
    """
    rows = table.T if table.ndim > 1 else table[None]
    for chunk in chunks(rows.shape[1], ROWS_AT_ONCE):
        right = rule(rows[:, chunk])
        if not right.all():
            row = chunk.start + int(np.argmin(right))
            found = table[row].tolist()
            raise InputError(f"{name}: {thing}, not {found} (row {row}, counted from 0); {remedy}")


def is_shaped(name: str, table: AnyArray, what: str, rows: int | None, widths: tuple[int, ...]) -> None:
    """Raise InputError unless a table has this many rows and one of the widths; (rows,) has the width 0."""
    width = table.shape[1] if table.ndim > 1 else 0
    if width in widths and rows in (None, len(table)):
        return
    count = "rows" if rows is None else str(rows)
    shapes = " or ".join(f"({count}, {width})" if width else f"({count},)" for width in widths)
    raise InputError(f"{name}: the shape of {what} must be {shapes}, not {table.shape}; write it again")


def is_of(name: str, table: AnyArray, what: str, kinds: str) -> None:
    """Raise InputError unless the numbers are whole ("iu"), or of any kind ("iuf")."""
    if table.dtype.kind not in kinds:
        rule = "whole numbers" if kinds == "iu" else "numbers"
        raise InputError(f"{name}: {what} must be {rule}, not {table.dtype}; convert them")


def within(count: int) -> Rule:
    """The rule that all are from 0 to below `count`; numbers of any integer type are compared exactly."""

    def rule(rows: AnyArray) -> Booleans:
        right: Booleans = np.asarray(((rows >= 0) & (rows < count)).all(axis=0))
        return right

    return rule


def are_coordinates(rows: AnyArray) -> Booleans:
    """Which rows are finite and at most 1e30 in size."""
    # The largest is infinite in half precision.
    numbers = rows.astype(np.float32) if rows.dtype.newbyteorder("=") == np.float16 else rows
    right: Booleans = np.asarray((np.abs(numbers) <= LARGEST_COORDINATE).all(axis=0))
    return right


def are_unit_vectors(rows: AnyArray) -> Booleans:
    """Which rows, each a vector, have the length 1 within `UNIT`."""
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.sqrt((rows.astype(np.float64) ** 2).sum(axis=0))
    right: Booleans = np.abs(lengths - 1) <= UNIT
    return right


def as_read(name: str, table: AnyArray, dtype: type[Any]) -> AnyArray:
    """The table itself, or its copy in this type and by columns; the log tells of a copy."""
    rows = table.T
    if table.dtype == dtype and rows.flags.c_contiguous and rows.flags.aligned:
        return table
    LOG.info(
        "%s: copied, for it is not %s stored by columns, but %s stored %s",
        name,
        np.dtype(dtype),
        table.dtype,
        "by columns" if rows.flags.c_contiguous else "by rows",
    )
    copy = np.empty(rows.shape, dtype)
    for chunk in chunks(rows.shape[-1], ROWS_AT_ONCE):
        copy[..., chunk] = rows[..., chunk]
    return read_only(copy).T
