"""The elements of a PLY file: its header, and columns of numbers and of lists from text and binary.

A header is lines of text that end with LF, CR LF or CR, from `ply` to `end_header`. It may use the old names
of types, as in `uchar`, and the new ones, as in `uint8`. In text each row is a line of decimal numbers, `nan`
and `inf`; empty lines are skipped.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from itertools import islice
from typing import Final, Literal, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Indices, runs
from autocolor.checks import listed
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import NumberText
from autocolor.files.meshes.repair import name_of
from autocolor.files.reading import HEAD, shown, text_lines, text_problem

ORDERS: Final = {b"ascii": "", b"binary_little_endian": "<", b"binary_big_endian": ">"}
"""The byte order of numbers in each format; none in text."""

WHOLES: Final = {
    b"char": "i1", b"uchar": "u1", b"short": "i2", b"ushort": "u2", b"int": "i4", b"uint": "u4",
    b"int8": "i1", b"uint8": "u1", b"int16": "i2", b"uint16": "u2", b"int32": "i4", b"uint32": "u4",
    b"int64": "i8", b"uint64": "u8",
}  # fmt: skip
"""The types of whole numbers in a header, as numpy's. PLY has none of 64 bits, but some files do."""

TYPES: Final = {**WHOLES, b"float": "f4", b"double": "f8", b"float32": "f4", b"float64": "f8"}

FIRST_LINE: Final = re.compile(rb"ply[ \t]*(\r?\n|\r)")


class Property(NamedTuple):
    """A property: its type and, for a list, the type of its count, in numpy's words."""

    type: str
    count_type: str | None = None

    @property
    def first(self) -> str:
        """The type of what comes first in a row: the count of a list, or the value."""
        return self.count_type or self.type


class Element(NamedTuple):
    """How many rows an element has, and their properties by name."""

    rows: int
    properties: dict[str, Property]

    @property
    def in_text(self) -> Element:
        """The element with the types of numbers that are parsed."""
        kinds = {name: Property("f8", each.count_type and "f8") for name, each in self.properties.items()}
        return Element(self.rows, kinds)


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
    end = re.search(rb"[\r\n][ \t]*end_header[ \t]*(?:" + feed + rb"|\Z)", data)
    if end is None:
        raise InputError(f"{place}: a header must have a line 'end_header', not none; export it again")
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
    """How many rows an element has, and its columns by the names of its properties."""

    length: int
    columns: dict[str, Column]


class _WrongRowError(Exception):
    """A row of an element has other values than the header says, or ends after the file."""


def read_elements(data: bytes, header: PlyHeader, place: str) -> tuple[dict[str, ElementRows], list[str]]:
    """The elements of a file by name, and a message if bytes or lines follow the last element.

    `place` is the file's name in messages. Raises InputError.
    """
    elements: dict[str, ElementRows] = {}
    at, end, text = header.length, len(data), None
    if not header.order:
        # Empty lines stand for the header, so that line numbers are those of the file.
        below = b"\n" * header.lines + data[at:]
        text = NumberText(text_lines(below, place, "an ascii PLY file"), place)
        numbers = text.values(0, len(text)).data
        lines = np.append(text.lines(), len(text))
        at, end = 0, len(lines) - 1
    for name, element in header.elements.items():
        try:
            if text is None:
                columns, at = _binary_columns(data, at, element, header.order)
            else:
                bounds = lines[at : at + element.rows + 1]
                if len(bounds) <= element.rows:
                    raise _WrongRowError
                columns = _columns(element.in_text, bounds * 8, numbers, "=")
                at += element.rows
        except _WrongRowError as error:
            if text is None or not error.args:
                raise InputError(
                    f"{place}: {element.rows:,} elements {name!r} must end within the file, with lists of 0"
                    " or more values; the file is cut short or its header is wrong, export it again"
                ) from None
            properties = listed([*islice(element.properties, 8)] or ["none"])
            line = text.line(int(bounds[error.args[0]]))
            raise InputError(
                f"{place}, line {line}: a line of an element {name!r} must have the values of {properties},"
                " with the count before each list, and no others; correct it"
            ) from None
        elements[name] = ElementRows(element.rows, columns)
    unit = "bytes" if text is None else "lines"
    return elements, [f"skipped {unit} after the last element: {end - at:,}"] if at < end else []


def _binary_columns(data: bytes, at: int, element: Element, order: str) -> tuple[dict[str, Column], int]:
    """The columns of an element that begins at a byte, and where it ends. Raises _WrongRowError."""
    rows, left = element.rows, len(data) - at
    if rows * max(1, sum(int(each.first[1]) for each in element.properties.values())) > left:
        raise _WrongRowError
    size = _bounds(data, at, element._replace(rows=1), order)[1] - at
    if 0 < rows * size <= left:
        with suppress(_WrongRowError):
            columns = _columns(element, at + size * np.arange(rows + 1), data, order, size)
            return columns, at + rows * size
    bounds = _bounds(data, at, element, order)
    if bounds[-1] > len(data):
        raise _WrongRowError
    return _columns(element, np.array(bounds), data, order), bounds[-1]


def _bounds(data: bytes, at: int, element: Element, order: str) -> list[int]:
    """Where each row of an element begins, and where the last one ends. Raises _WrongRowError."""
    # For each list of a row: the type of its count, how many bytes after the list before it its count and its
    # values begin, and the bytes of a value.
    lists, tail = [], 0
    for each in element.properties.values():
        begin, tail = tail, tail + int(each.first[1])
        if each.count_type:
            lists.append((each.count_type, begin, tail, int(each.type[1])))
            tail = 0
    byte_order: Literal["little", "big"] = "big" if order == ">" else "little"
    bounds = [at]
    if [kind for kind, *_ in lists] == ["u1"]:
        # Measured: a fifth of the time of the general case below.
        _, begin, end, width = lists[0]
        with suppress(IndexError):
            for _ in range(element.rows):
                at += end + data[at + begin] * width + tail
                bounds.append(at)
            return bounds
        raise _WrongRowError
    for _ in range(element.rows):
        for kind, begin, end, width in lists:
            count = int.from_bytes(data[at + begin : at + end], byte_order, signed=kind[0] == "i")
            if count < 0:
                raise _WrongRowError
            at += end + count * width
        at += tail
        bounds.append(at)
    return bounds


def _columns(
    element: Element, bounds: Indices, data: bytes | memoryview, order: str, size: int = 0
) -> dict[str, Column]:
    """The columns of an element, whose numbers have a byte order. Raises _WrongRowError with a row.

    `bounds` are the bytes where the rows begin, and where the last one ends. `size` is the bytes of each row
    if all rows must be alike.
    """

    def values(places: Indices, kind: str, count: int = 1) -> AnyArray:
        """The values of a type, `count` of them at each of some places, one after the other."""
        width = int(kind[1])
        if size:
            return np.ndarray((len(places), count), order + kind, data, int(places[0]), (size, width)).ravel()
        most = memoryview(data).nbytes - width + 1
        return np.ndarray((max(most, 0),), order + kind, data, strides=(1,))[places]

    def require(is_right: Booleans) -> None:
        if not is_right.all():
            raise _WrongRowError(int(is_right.argmin()))

    columns: dict[str, Column] = {}
    at, ends = bounds[:-1].copy(), bounds[1:]
    for name, each in element.properties.items():
        width = int(each.first[1])
        require(at + width <= ends)
        columns[name] = counts = values(at, each.first)
        at += width
        if each.count_type:
            width = int(each.type[1])
            require((counts >= 0) & (counts <= (ends - at) // width) & (counts == np.floor(counts)))
            counts = counts.astype(np.intp)
            if size:
                require(counts == counts[0])
                numbers = values(at, each.type, int(counts[0]))
            else:
                filled = np.flatnonzero(counts)
                places = runs(at[filled], counts[filled], np.full(len(filled), width))
                numbers = values(places, each.type)
            columns[name] = Lists(numbers, counts)
            at += counts * width
    require(at == ends)
    return columns
