"""The elements of a PLY file: its header, and columns of numbers and of lists from text and binary.

A header is lines of text that end with LF, CR LF or CR, from `ply` to `end_header`. It may use the old names
of types, as in `uchar`, and the new ones, as in `uint8`. In text each row is a line of decimal numbers, `nan`
and `inf`; empty lines are skipped.
"""

from __future__ import annotations

import re
import struct
from contextlib import suppress
from itertools import islice
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Indices, runs
from autocolor.checks import listed
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import NumberText
from autocolor.files.meshes.repair import name_of
from autocolor.files.reading import HEAD, shown, text_lines, text_problem

ORDERS: Final = {b"ascii": "", b"binary_little_endian": "<", b"binary_big_endian": ">"}
"""The byte order of numbers in each format; none in text."""

TYPES: Final = {
    b"char": "b", b"uchar": "B", b"short": "h", b"ushort": "H", b"int": "i", b"uint": "I",
    b"int8": "b", b"uint8": "B", b"int16": "h", b"uint16": "H", b"int32": "i", b"uint32": "I",
    b"int64": "q", b"uint64": "Q",
    b"float": "f", b"double": "d", b"float32": "f", b"float64": "d",
}  # fmt: skip
"""The letters of the types, in `struct` and numpy. PLY has no whole numbers of 64 bits, but some files do."""

FIRST_LINE: Final = re.compile(rb"ply[ \t]*(\r?\n|\r)")

Properties = dict[str, tuple[str, ...]]
"""The types of an element's properties by their names: two for a list, that of its count first."""


def begins_as_ply(head: bytes) -> bool:
    """Whether a file begins as PLY does."""
    return FIRST_LINE.match(head) is not None


def _header(data: bytes, place: str) -> tuple[str, dict[str, tuple[int, Properties]], list[bytes], int]:
    """The byte order, the count of rows and the properties of each element, the comments, and the length.

    Raises InputError.
    """
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
    elements: dict[str, tuple[int, Properties]] = {}
    comments = []
    for number, line in enumerate(data[: end.end()].splitlines()[1:-1], start=2):
        # Properties are of the last element.
        properties = next((each for _, each in reversed(elements.values())), None)
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
                elements[name_of(name)] = int(count), {}
            case [b"property", *kinds, name] if (
                properties is not None and name_of(name) not in properties and (types := _types(kinds))
            ):
                properties[name_of(name)] = types
            case _:
                raise InputError(
                    f"{place}, line {number}: a line of the header must be a format, comment, element or"
                    f" property of PLY, named once, not {shown(line.strip())}; export it again"
                )
    if order is None:
        raise InputError(f"{place}: a header must have a line 'format', not none; export it again")
    return order, elements, comments, end.end()


def _types(kinds: list[bytes]) -> tuple[str, ...]:
    """The types in the words before the name of a property, `TYPE` or `list COUNT TYPE`; or none."""
    match kinds:
        case [kind] if kind in TYPES:
            return (TYPES[kind],)
        case [b"list", count, kind] if TYPES.get(count, "f") not in "fd" and kind in TYPES:
            return TYPES[count], TYPES[kind]
    return ()


class Lists(NamedTuple):
    """The lists of all rows: their values, list after list, and the number of values in each list."""

    values: AnyArray
    counts: Indices


Columns = dict[str, AnyArray | Lists]


class ElementRows(NamedTuple):
    """How many rows an element has, and its columns by the names of its properties."""

    length: int
    columns: Columns


class _WrongRowError(Exception):
    """A row of an element has other values than the header says, or ends after the file."""


def read_elements(data: bytes, place: str) -> tuple[dict[str, ElementRows], list[bytes], list[str]]:
    """The elements of a file by name, its comments, and a message if bytes or lines follow the last element.

    `place` is the file's name in messages. Raises InputError.
    """
    order, declared, comments, at = _header(data, place)
    elements: dict[str, ElementRows] = {}
    end, text = len(data), None
    if not order:
        # The header is left blank, so that line numbers are those of the file.
        below = re.sub(rb"[^\r\n]", b" ", data[:at]) + data[at:]
        text = NumberText(text_lines(below, place, "an ascii PLY file"), place)
        numbers = text.values(0, len(text)).data
        lines = np.append(text.lines(), len(text))
        at, end = 0, len(lines) - 1
    for name, (rows, properties) in declared.items():
        try:
            if rows > end - at:
                raise _WrongRowError
            if text is None:
                columns, at = _binary_columns(data, at, rows, properties, order)
            else:
                bounds = lines[at : at + rows + 1]
                doubles = {each: ("d",) * len(types) for each, types in properties.items()}
                columns = _columns(doubles, bounds * 8, numbers, "=")
                at += rows
        except _WrongRowError as error:
            if text is None or not error.args:
                raise InputError(
                    f"{place}: {rows:,} elements {name!r} must end within the file, with lists of 0 or more"
                    " values; export it again"
                ) from None
            line = text.line(int(bounds[error.args[0]]))
            raise InputError(
                f"{place}, line {line}: an element {name!r} must have the values of"
                f" {listed([*islice(properties, 4)] or ['none'])}, the count before each list, and no others;"
                " correct it"
            ) from None
        elements[name] = ElementRows(rows, columns)
    unit = "bytes" if text is None else "lines"
    skipped = [f"skipped {unit} after the last element: {end - at:,}"] if at < end else []
    return elements, comments, skipped


def _binary_columns(
    data: bytes, at: int, rows: int, properties: Properties, order: str
) -> tuple[Columns, int]:
    """The columns of an element that begins at a byte, and where it ends. Raises _WrongRowError."""
    with suppress(ValueError):
        return _alike(data, at, rows, properties, order)
    # For each list of a row: what stands between the list before it and its values, and the bytes of a value.
    lists, tail = [], order
    for first, *kind in properties.values():
        tail += first
        if kind:
            lists.append((struct.Struct(tail), struct.calcsize(order + kind[0])))
            tail = order
    bounds = [at]
    try:
        for _ in range(rows):
            for head, width in lists:
                at += head.size + head.unpack_from(data, at)[-1] * width
            at += struct.calcsize(tail)
            bounds.append(at)
    except (struct.error, OverflowError):
        raise _WrongRowError from None
    if at > len(data):
        raise _WrongRowError
    return _columns(properties, np.array(bounds), data, order), at


def _alike(data: bytes, at: int, rows: int, properties: Properties, order: str) -> tuple[Columns, int]:
    """As `_binary_columns`, if each list has as many values in all rows. Raises ValueError otherwise."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for number, (first, *kind) in enumerate(properties.values()):
        fields.append((f"{number}", order + first))
        if kind:
            count = np.frombuffer(data, fields, 1, at)[f"{number}"][0]
            fields.append((f"list {number}", order + kind[0], (int(count),)))
    table = np.frombuffer(data, fields, rows, at)
    columns: Columns = {}
    for number, (name, types) in enumerate(properties.items()):
        columns[name] = values = np.ascontiguousarray(table[f"{number}"])
        if len(types) > 1:
            if (values != values[0]).any():
                raise ValueError
            columns[name] = Lists(table[f"list {number}"].ravel(), values.astype(np.intp))
    return columns, at + table.nbytes


def _columns(properties: Properties, bounds: Indices, data: bytes | memoryview, order: str) -> Columns:
    """The columns of an element, whose numbers have a byte order. Raises _WrongRowError with a row.

    `bounds` are the bytes where the rows begin, and where the last one ends.
    """

    def values(places: Indices, kind: str) -> AnyArray:
        """The values of a type at some places."""
        most = memoryview(data).nbytes - struct.calcsize(f"={kind}") + 1
        return np.ndarray((max(most, 0),), order + kind, data, strides=(1,))[places]

    def require(is_right: Booleans) -> None:
        if not is_right.all():
            raise _WrongRowError(int(is_right.argmin()))

    columns: Columns = {}
    at, ends = bounds[:-1].copy(), bounds[1:]
    for name, (first, *kind) in properties.items():
        width = struct.calcsize(f"={first}")
        require(at + width <= ends)
        columns[name] = counts = values(at, first)
        at += width
        if kind:
            width = struct.calcsize(f"={kind[0]}")
            require((counts >= 0) & (counts <= (ends - at) // width) & (counts == np.floor(counts)))
            counts = counts.astype(np.intp)
            filled = np.flatnonzero(counts)
            places = runs(at[filled], counts[filled], np.full(len(filled), width))
            columns[name] = Lists(values(places, kind[0]), counts)
            at += counts * width
    require(at == ends)
    return columns
