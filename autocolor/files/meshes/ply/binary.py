"""The elements of a binary PLY file.

Elements whose rows all have the same size are looked at as arrays. Only where lists differ in their counts,
as in a mesh of triangles and quads, does each row tell where the next begins.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import replace
from typing import Final, NoReturn

import numpy as np

from autocolor.arrays import AnyArray, Indices, runs
from autocolor.errors import InputError
from autocolor.files.meshes.ply.columns import Column, Lists, PlyTables, Rows
from autocolor.files.meshes.ply.header import Element, Header, Property

ROWS_AT_ONCE: Final = 1 << 16
"""Rows whose places are Python values at once."""

LONGEST_ROW: Final = 1 << 20
"""Bytes of a row that numpy is given as one type."""

CODES: Final = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q"}
"""The types of counts as `struct` has them."""

Step = tuple[int, str, int]
"""Of a list in a row: the bytes before its count, the type of the count, and the bytes of a value."""


def read_binary(data: bytes, header: Header, place: str) -> PlyTables:
    """The elements of a file; `place` is its name in messages. Raises InputError if it is cut short."""
    at = header.length
    elements: dict[str, Rows] = {}
    for element in header.elements:
        least = element.count * sum(each.size for each in element.properties) + element.least_corners
        if least > len(data) - at:
            _refuse_short(place, element, f"at least {least:,} bytes, not {len(data) - at:,}")
        columns, at = _columns(data, at, element, header.order, place)

        def place_of(row: int, name: str = element.name) -> str:
            return f"{place}, {name} {row}"

        elements[element.name] = Rows(element.count, columns, place_of)
    left = len(data) - at
    return PlyTables(elements, (f"skipped bytes after the last element: {left:,}",) if left else ())


def _refuse_short(place: str, element: Element, rule: str) -> NoReturn:
    raise InputError(
        f"{place}: {element.count:,} elements {element.name!r} must have {rule}; the file is cut short or its"
        " header is wrong, export it again"
    )


def _columns(data: bytes, at: int, element: Element, order: str, place: str) -> tuple[dict[str, Column], int]:
    """The columns of an element that begins at a byte, and where the next element begins."""
    lists = [each for each in element.properties if each.count_type]
    counts = _first_counts(data, at, element, order, place) if lists and element.count else [0] * len(lists)
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    left = iter(counts)
    for number, each in enumerate(element.properties):
        if each.count_type:
            fields.append((f"count {number}", order + each.count_type))
            fields.append((f"value {number}", order + each.type, (next(left),)))
        else:
            fields.append((f"value {number}", order + each.type))
    size = sum(each.size for each in element.properties) + sum(
        count * np.dtype(each.type).itemsize for count, each in zip(counts, lists, strict=True)
    )
    if not fields:
        return {}, at
    if size <= LONGEST_ROW and at + element.count * size <= len(data):
        rows = np.frombuffer(data, np.dtype(fields), element.count, at)
        found = [number for number, each in enumerate(element.properties) if each.count_type]
        if all((rows[f"count {number}"] == count).all() for number, count in zip(found, counts, strict=True)):
            return dict(_columns_of_rows(rows, element)), at + element.count * size
    return _walked(data, at, element, order, place)


def _columns_of_rows(rows: AnyArray, element: Element) -> Iterator[tuple[str, Column]]:
    """The columns of rows of the same size."""
    for number, each in enumerate(element.properties):
        values = rows[f"value {number}"]
        if each.count_type:
            # Measured: a column at a time takes a third of the time of the rows, which are not aligned.
            table = np.empty(values.shape, np.dtype(each.type))
            for at in range(values.shape[1]):
                table[:, at] = values[:, at]
            yield each.name, Lists(table.ravel(), np.full(len(rows), values.shape[1], np.intp))
        else:
            yield each.name, values


def _first_counts(data: bytes, at: int, element: Element, order: str, place: str) -> list[int]:
    """The counts of the lists of the first row."""
    counts, _ = _walk(data, at, replace(element, count=1), order, place)
    return [int(count[0]) for count in counts]


def _walked(data: bytes, at: int, element: Element, order: str, place: str) -> tuple[dict[str, Column], int]:
    """The columns of rows of different sizes, and where the next element begins."""
    counts, end = _walk(data, at, element, order, place)
    if not element.is_used:
        return {}, end
    sizes = np.full(element.count, sum(each.size for each in element.properties))
    for count, (_, _, width) in zip(counts, _steps(element.properties), strict=True):
        sizes += count * width
    # The place of the next property in each row.
    places = np.cumsum(sizes)
    places += at - sizes
    columns: dict[str, Column] = {}
    for each in element.properties:
        width = np.dtype(each.type).itemsize
        if each.count_type is None:
            columns[each.name] = _gathered(data, places, order + each.type)
            places += width
        else:
            count = counts.pop(0)
            places += each.size
            filled = np.flatnonzero(count)
            steps = np.full(len(filled), width)
            items = runs(places[filled], count[filled], steps) if len(filled) else filled
            columns[each.name] = Lists(_gathered(data, items, order + each.type), count)
            places += count * width
    return columns, end


def _gathered(data: bytes, places: Indices, code: str) -> AnyArray:
    """The numbers of a type that begin at some bytes."""
    dtype = np.dtype(code)
    everywhere = np.ndarray((len(data) - dtype.itemsize + 1,), dtype, data, strides=(1,))
    return everywhere[places]


def _walk(data: bytes, at: int, element: Element, order: str, place: str) -> tuple[list[Indices], int]:
    """The counts of each list of the rows of an element that begins at a byte, and where it ends.

    Of an element that is not used, the counts are those of the last rows.

    Measured: a million triangles and quads in a tenth of a second.
    """
    steps = _steps(element.properties)
    tail = _tail(element.properties)
    found: list[AnyArray] = []
    for first in range(0, element.count, ROWS_AT_ONCE):
        counts: list[int] = []
        rows = min(ROWS_AT_ONCE, element.count - first)
        try:
            if len(steps) == 1 and steps[0][1] == "u1":
                at = _walk_short_lists(data, at, rows, steps[0], tail, counts)
            else:
                at = _walk_lists(data, at, rows, steps, tail, order, counts)
        except (IndexError, struct.error):
            at = len(data) + 1
        if counts and counts[-1] < 0:
            row = first + (len(counts) - 1) // len(steps)
            raise InputError(
                f"{place}, {element.name} {row}: the count of a list must be 0 or more, not less; export it"
                " again"
            )
        if at > len(data):
            _refuse_short(place, element, "all their lists before the end, not after it")
        if not element.is_used:
            found.clear()
        found.append(np.array(counts, np.intp).reshape(rows, -1))
    return list(np.ascontiguousarray(np.concatenate(found).T)), at


def _steps(properties: tuple[Property, ...]) -> list[Step]:
    """The lists of a row."""
    steps = []
    before = 0
    for each in properties:
        if each.count_type:
            steps.append((before, each.count_type, np.dtype(each.type).itemsize))
            before = 0
        else:
            before += each.size
    return steps


def _tail(properties: tuple[Property, ...]) -> int:
    """The bytes after the last list."""
    sizes = [0 if each.count_type else each.size for each in properties]
    last = max(number for number, each in enumerate(properties) if each.count_type)
    return sum(sizes[last + 1 :])


def _walk_short_lists(data: bytes, at: int, rows: int, step: Step, tail: int, counts: list[int]) -> int:
    """Append the count of the one list of each row, which is a byte; returns where the rows end."""
    before, _, size = step
    fixed = 1 + tail + before
    at += before
    append = counts.append
    for _ in range(rows):
        count = data[at]
        append(count)
        at += fixed + count * size
    return at - before


def _walk_lists(
    data: bytes, at: int, rows: int, steps: list[Step], tail: int, order: str, counts: list[int]
) -> int:
    """Append the counts of the lists of each row, up to a negative one; returns where the rows end."""
    unpackers = [
        (before, struct.Struct(order + CODES[code]).unpack_from, np.dtype(code).itemsize, size)
        for before, code, size in steps
    ]
    for _ in range(rows):
        for before, unpack, width, size in unpackers:
            (count,) = unpack(data, at + before)
            counts.append(count)
            at += before + width + count * size
            if count < 0 or at > len(data):
                return len(data) + 1
        at += tail
    return at
