"""The elements of a PLY file: its header, and columns of numbers and of lists from text and binary.

A header is lines of text that end with LF, CR LF or CR, from `ply` to `end_header`. It may use the old names
of types, as in `uchar`, and the new ones, as in `uint8`. In text each row is a line of decimal numbers, `nan`
and `inf`; empty lines are skipped.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Mapping
from itertools import islice
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, runs
from autocolor.checks import listed
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import NumberText
from autocolor.files.meshes.repair import name_of
from autocolor.files.reading import HEAD, shown, text_problem

LARGEST_HEADER: Final = 16 << 20
"""Limit: in bytes; a comment for each of a hundred thousand parts."""

CUT_SHORT: Final = "the file is cut short or its header is wrong, export it again"

ORDERS: Final = {b"ascii": "", b"binary_little_endian": "<", b"binary_big_endian": ">"}
"""The byte order of numbers in each format; none in text."""

WHOLES: Final = {
    b"char": "i1", b"uchar": "u1", b"short": "i2", b"ushort": "u2", b"int": "i4", b"uint": "u4",
    b"int8": "i1", b"uint8": "u1", b"int16": "i2", b"uint16": "u2", b"int32": "i4", b"uint32": "u4",
    b"int64": "i8", b"uint64": "u8",
}  # fmt: skip
"""The types of whole numbers in a header, as numpy's. PLY has none of 64 bits, but some files do."""

TYPES: Final = {**WHOLES, b"float": "f4", b"double": "f8", b"float32": "f4", b"float64": "f8"}

CODES: Final = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q"}
"""The types of counts as `struct` has them."""

FIRST_LINE: Final = re.compile(rb"ply[ \t]*(\r?\n|\r)")


class Property(NamedTuple):
    """A property: its type and, for a list, the type of its count, in numpy's words."""

    type: str
    count_type: str | None = None

    @property
    def size(self) -> int:
        """The bytes in a binary file of a value, or of the count of a list."""
        return int((self.count_type or self.type)[1])


class Element(NamedTuple):
    """How many rows an element has, and their properties by name."""

    rows: int
    properties: dict[str, Property]


class PlyHeader(NamedTuple):
    """A header: the byte order, empty for text; the elements by name; the comments; its bytes and lines."""

    order: str
    elements: Mapping[str, Element]
    comments: tuple[bytes, ...]
    length: int
    lines: int


def begins_as_ply(head: bytes) -> bool:
    """Whether a file begins as PLY does."""
    return FIRST_LINE.match(head) is not None


def parsed_header(data: bytes, place: str) -> PlyHeader:
    """The header at the start of a file; `place` is its name in messages. Raises InputError."""
    if problem := text_problem(data[:2]):
        raise InputError(f"{place}: a PLY file {problem}")
    first = FIRST_LINE.match(data)
    if first is None:
        found = shown(data[:HEAD].split(b"\n")[0].strip())
        raise InputError(f"{place}: a PLY file must begin with a line 'ply', not {found}; export it again")
    # A line that ends with CR may be followed by binary data that begins with LF.
    feed = b"\r" if first[1] == b"\r" else b"\r?\n"
    end = re.search(rb"[\r\n][ \t]*end_header[ \t]*(?:" + feed + rb"|\Z)", data[:LARGEST_HEADER])
    if end is None:
        raise InputError(
            f"{place}: a header must have a line 'end_header' within {LARGEST_HEADER:,} bytes; export it"
            " again"
        )
    order: str | None = None
    elements: dict[str, Element] = {}
    # The properties of the last element; none can stand before the first element.
    properties: dict[str, Property] | None = None
    comments = []
    lines = data[: end.end()].splitlines()
    for number, line in enumerate(lines[1:-1], start=2):
        match line.split():
            case [] | [b"obj_info", *_]:
                pass
            case [b"comment", *_]:
                comments.append(line.strip().removeprefix(b"comment").strip())
            case [b"format", byte_order, b"1.0"] if byte_order in ORDERS:
                order = ORDERS[byte_order]
            case [b"element", name, count] if (
                count.isdigit() and len(count) < 19 and name_of(name) not in elements
            ):
                properties = {}
                elements[name_of(name)] = Element(int(count), properties)
            case [b"property", *kinds, name] if (
                properties is not None and name_of(name) not in properties and (kind := _property(kinds))
            ):
                properties[name_of(name)] = kind
            case _:
                raise InputError(
                    f"{place}, line {number}: a line of the header must be a format, a comment, an element"
                    " with its count or one of its properties with a type of PLY, each with a name of its"
                    f" own, not {shown(line.strip())}; export it again"
                )
    if order is None:
        raise InputError(f"{place}: a header must have a line 'format', not none; export it again")
    return PlyHeader(order, elements, tuple(comments), end.end(), len(lines))


def _property(kinds: list[bytes]) -> Property | None:
    """The property of the words before its name, TYPE or `list` COUNT_TYPE TYPE; None for other words."""
    match kinds:
        case [kind] if kind in TYPES:
            return Property(TYPES[kind])
        case [b"list", count, kind] if count in WHOLES and kind in TYPES:
            return Property(TYPES[kind], WHOLES[count])
    return None


class Lists(NamedTuple):
    """The lists of all rows: their values, list after list, and the number of values in each list."""

    values: AnyArray
    counts: Indices


Column = AnyArray | Lists


class ElementRows(NamedTuple):
    """The columns of an element by the names of its properties; `place_of` tells where a row is."""

    length: int
    columns: dict[str, Column]
    place_of: Callable[[int], str]


def read_binary(data: bytes, header: PlyHeader, place: str) -> tuple[dict[str, ElementRows], tuple[str, ...]]:
    """The elements of a file by name, and a message if bytes follow the last element.

    `place` is the file's name in messages. Raises InputError if the file is cut short.
    """
    at = header.length
    elements: dict[str, ElementRows] = {}
    for name, element in header.elements.items():
        try:
            columns, at = _even_columns(data, at, element, header.order) or _uneven_columns(
                data, at, element, header.order
            )
        except _CutShortError:
            raise InputError(
                f"{place}: {element.rows:,} elements {name!r} must end within the file, with lists of 0 or"
                f" more values; {CUT_SHORT}"
            ) from None

        def place_of(row: int, name: str = name) -> str:
            return f"{place}, {name} {row}"

        elements[name] = ElementRows(element.rows, columns, place_of)
    left = len(data) - at
    return elements, (f"skipped bytes after the last element: {left:,}",) if left else ()


class _CutShortError(Exception):
    """The rows of an element do not end within the file."""


def _even_columns(data: bytes, at: int, element: Element, order: str) -> tuple[dict[str, Column], int] | None:
    """The columns of an element that begins at a byte, and where the next one begins.

    None if the rows are not all as long as the first.
    """
    rows = element.rows
    if not rows:
        return None
    counts, end = _walked(data, at, element._replace(rows=1), order)
    size, lengths = end - at, iter(counts[:, 0].tolist())
    if rows * size > len(data) - at:
        return None
    end = at + rows * size
    columns: dict[str, Column] = {}
    for name, each in element.properties.items():
        columns[name] = np.ndarray((rows,), order + (each.count_type or each.type), data, at, (size,))
        at += each.size
        if each.count_type:
            length, width = next(lengths), int(each.type[1])
            if (columns[name] != length).any():
                return None
            values = np.ndarray((rows, length), order + each.type, data, at, (size, width))
            columns[name] = Lists(values.astype(each.type).ravel(), np.full(rows, length))
            at += length * width
    return columns, end


def _uneven_columns(data: bytes, at: int, element: Element, order: str) -> tuple[dict[str, Column], int]:
    """The same for rows of any sizes."""
    counts, end = _walked(data, at, element, order)
    lists = [each for each in element.properties.values() if each.count_type]
    sizes = np.full(element.rows, sum(each.size for each in element.properties.values()))
    for count, each in zip(counts, lists, strict=True):
        sizes += count * int(each.type[1])
    # The place of the next property in each row.
    places = at + np.cumsum(sizes) - sizes
    lengths = iter(counts)
    columns: dict[str, Column] = {}

    def numbers(places: Indices, code: str) -> AnyArray:
        everywhere = np.ndarray((len(data) - int(code[1]) + 1,), order + code, data, strides=(1,))
        return everywhere[places]

    for name, each in element.properties.items():
        if each.count_type is None:
            columns[name] = numbers(places, each.type)
            places += each.size
        else:
            count, width = next(lengths), int(each.type[1])
            places += each.size
            filled = np.flatnonzero(count)
            items = runs(places[filled], count[filled], np.full(len(filled), width))
            columns[name] = Lists(numbers(items, each.type), count)
            places += count * width
    return columns, end


def _walked(data: bytes, at: int, element: Element, order: str) -> tuple[Indices, int]:
    """The counts of the lists of an element that begins at a byte, (lists, rows), and where it ends."""
    if element.rows * sum(each.size for each in element.properties.values()) > len(data) - at:
        raise _CutShortError
    # For each list of a row: the bytes from the list before it to its values, how to read its count, where
    # the count is, and the bytes of a value.
    lists, tail = [], 0
    for each in element.properties.values():
        if each.count_type:
            unpack = struct.Struct(order + CODES[each.count_type]).unpack_from
            lists.append((tail + each.size, unpack, tail, int(each.type[1])))
        tail = 0 if each.count_type else tail + each.size
    if not lists:
        return np.empty((0, element.rows), np.intp), at + element.rows * tail
    some: list[int] = []
    try:
        if [each.count_type for each in element.properties.values() if each.count_type] == ["u1"]:
            # Measured: a third of the time of the general case below.
            head, _, before, width = lists[0]
            for _ in range(element.rows):
                count = data[at + before]
                some.append(count)
                at += head + count * width + tail
        for _ in range(0 if some else element.rows):
            for head, unpack, before, width in lists:
                (count,) = unpack(data, at + before)
                some.append(count)
                at += head + count * width
            at += tail
        counts = np.array(some, np.intp).reshape(-1, len(lists)).T
    except (IndexError, OverflowError, struct.error):
        raise _CutShortError from None
    if at > len(data) or counts.min(initial=0) < 0:
        raise _CutShortError
    return np.ascontiguousarray(counts), at


def read_text(data: bytes, header: PlyHeader, place: str) -> tuple[dict[str, ElementRows], tuple[str, ...]]:
    """The elements of a file by name, and a message if lines follow the last element.

    `place` is the file's name in messages. Raises InputError.
    """
    if problem := text_problem(data):
        raise InputError(f"{place}: an ascii PLY file {problem}")
    body = data[header.length :].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    # Empty lines stand for the header, so that line numbers are those of the file.
    text = NumberText(b"\n" * header.lines + body, place)
    firsts = text.lines()
    numbers = text.values(0, len(text))
    ends = np.append(firsts[1:], len(text))
    elements: dict[str, ElementRows] = {}
    row = 0
    for name, element in header.elements.items():
        begins = firsts[row : row + element.rows]
        if len(begins) < element.rows:
            raise InputError(
                f"{place}: there must be {element.rows:,} elements {name!r}, not {len(begins):,}; {CUT_SHORT}"
            )

        def place_of(at: int, begins: Indices = begins) -> str:
            return f"{place}, line {text.line(int(begins[at]))}"

        columns, is_right = _text_columns(numbers, begins, ends[row : row + element.rows], element)
        if not is_right.all():
            properties = listed([*islice(element.properties, 8)] or ["none"])
            raise InputError(
                f"{place_of(int(is_right.argmin()))}: a line of an element {name!r} must have the values of"
                f" {properties}, with the count before each list, and no others; correct it"
            )
        elements[name] = ElementRows(element.rows, columns, place_of)
        row += element.rows
    more = len(firsts) - row
    return elements, (f"skipped lines after the last element: {more:,}",) if more else ()


def _text_columns(
    numbers: Floats, begins: Indices, ends: Indices, element: Element
) -> tuple[dict[str, Column], Booleans]:
    """The columns of an element whose rows begin and end at some numbers, and which of the rows are right.

    Where a row is wrong, the columns end.
    """
    columns: dict[str, Column] = {}
    at = begins.copy()
    for name, each in element.properties.items():
        is_right = at < ends
        if not is_right.all():
            return columns, is_right
        columns[name] = values = numbers[at]
        at += 1
        if each.count_type:
            is_right = (values >= 0) & (values <= ends - at) & (values == np.floor(values))
            if not is_right.all():
                return columns, is_right
            count = values.astype(np.intp)
            filled = count > 0
            columns[name] = Lists(numbers[runs(at[filled], count[filled])], count)
            at += count
    return columns, at == ends
