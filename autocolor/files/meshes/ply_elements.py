"""The elements of a PLY file: its header, and columns of numbers and of lists from text and binary.

A header is lines of text that end with LF, CR LF or CR, from `ply` to `end_header`. It may use the old names
of types, as in `uchar`, and the new ones, as in `uint8`. In text each row is a line of decimal numbers, `nan`
and `inf`; empty lines are skipped.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, runs
from autocolor.checks import listed, nearest
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import NumberText
from autocolor.files.meshes.repair import name_of
from autocolor.files.reading import HEAD, shown, text_problem

VERTEX: Final = "vertex"
FACE: Final = "face"
STRIPS: Final = "tristrips"

LARGEST_HEADER: Final = 16 << 20
"""Limit: in bytes; a comment for each of a hundred thousand parts."""

MOST_PROPERTIES: Final = 1000
"""Limit: elements and properties of all elements together."""

ORDERS: Final = {b"ascii": "", b"binary_little_endian": "<", b"binary_big_endian": ">"}
"""The byte order of numbers in each format; none in text."""

TYPES: Final = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8",
}  # fmt: skip
"""The types in a header, as numpy's. PLY has no integers of 64 bits, but some files do."""

FIRST_LINE: Final = re.compile(rb"ply[ \t]*(\r?\n|\r)")
HEADER_LINE: Final = re.compile(
    rb"\s*(?:(?:comment\b\s*(?P<comment>.*)|obj_info\b.*)?"
    rb"|format\s+(?P<format>ascii|binary_little_endian|binary_big_endian)\s+1\.0"
    rb"|element\s+(?P<element>\S+)\s+(?P<count>[0-9]{1,18})"
    rb"|property\s+(?:list\s+(?P<count_type>\S+)\s+)?(?P<type>\S+)\s+(?P<property>\S+)"
    rb"|(?P<end>end_header))\s*",
    re.DOTALL,
)


class Property(NamedTuple):
    """A property: its name, its type in numpy's words, and, for a list, the type of its count."""

    name: str
    type: str
    count_type: str | None = None

    @property
    def size(self) -> int:
        """The bytes in a binary file of a value, or of the count of a list."""
        return np.dtype(self.count_type or self.type).itemsize


@dataclass(frozen=True)
class Element:
    """An element: its name, how many there are, and their properties."""

    name: str
    count: int
    properties: tuple[Property, ...] = ()


class PlyHeader(NamedTuple):
    """A header: the byte order, empty for text; the elements; the comments; its length in bytes and lines."""

    order: str
    elements: tuple[Element, ...]
    comments: tuple[str, ...]
    length: int
    lines: int


def begins_as_ply(head: bytes) -> bool:
    """Whether a file begins as PLY does."""
    return FIRST_LINE.match(head) is not None


def parsed_header(data: bytes, place: str) -> PlyHeader:
    """The header at the start of a file; `place` is its name in messages. Raises InputError."""
    if problem := text_problem(data[:2]):
        raise InputError(f"{place}: a PLY file {problem}")
    if not FIRST_LINE.match(data):
        first_line = shown(data[:HEAD].split(b"\n")[0].strip())
        raise InputError(
            f"{place}: a PLY file must begin with a line 'ply', not {first_line}; export it again"
        )
    order: str | None = None
    elements: dict[str, Element] = {}
    properties: list[dict[str, Property]] = []
    comments: list[str] = []
    lines = _lines(data, place)
    next(lines)
    for number, (line, end) in enumerate(lines, start=2):
        match = HEADER_LINE.fullmatch(line)
        where = f"{place}, line {number}"
        if match is None or (match["property"] and not properties):
            raise InputError(
                f"{where}: a line of the header must be a format, a comment, an element with its count, one"
                f" of its properties or end_header, not {shown(line.strip())}; export it again"
            )
        length = end
        if match["comment"] is not None:
            comments.append(match["comment"].strip().decode("utf-8", "replace"))
        elif match["format"]:
            order = ORDERS[match["format"]]
        elif match["element"]:
            element = Element(name_of(match["element"]), int(match["count"]))
            _refuse_repeated(element.name, elements, "an element", where)
            elements[element.name] = element
            properties.append({})
        elif match["property"]:
            each = _property(match, where)
            _refuse_repeated(each.name, properties[-1], "a property", where)
            properties[-1][each.name] = each
        elif match["end"]:
            break
        is_counted = match["element"] or match["property"]
        if is_counted and len(properties) + sum(map(len, properties)) > MOST_PROPERTIES:
            raise InputError(
                f"{where}: a header must have at most {MOST_PROPERTIES:,} elements and properties, not more;"
                " leave out what is not needed"
            )
    if order is None:
        raise InputError(f"{place}: a header must have a line 'format', not none; export it again")
    with_properties = tuple(
        replace(element, properties=tuple(of_it.values()))
        for element, of_it in zip(elements.values(), properties, strict=True)
    )
    return PlyHeader(order, with_properties, tuple(comments), length, number)


def _lines(data: bytes, place: str) -> Iterator[tuple[bytes, int]]:
    """Each line of the header, and the place after it. Raises InputError if the header does not end."""
    # A line that ends with CR may be followed by binary data that begins with LF.
    first = FIRST_LINE.match(data)
    feed = b"\r" if first is not None and first[1] == b"\r" else b"\n"
    at, most = 0, min(len(data), LARGEST_HEADER)
    while at < most:
        end = data.find(feed, at, most)
        if end < 0 and most < len(data):
            break
        end = most if end < 0 else end
        yield data[at:end], min(end + 1, most)
        at = end + 1
    where = f"within {LARGEST_HEADER:,} bytes" if most < len(data) else "before the file ends"
    raise InputError(f"{place}: a header must have a line 'end_header' {where}; export it again")


def _refuse_repeated(
    name: str, before: dict[str, Element] | dict[str, Property], what: str, where: str
) -> None:
    if name in before:
        raise InputError(f"{where}: the name of {what} must be unique, not repeated: {name!r}; rename one")


def _property(match: re.Match[bytes], where: str) -> Property:
    """The property of a line `property TYPE NAME` or `property list TYPE TYPE NAME`."""
    types = [word.decode("latin-1") for word in match.group("type", "count_type") if word]
    for each in types:
        if each not in TYPES:
            raise InputError(
                f"{where}: a type must be one of PLY, not {shown(each)}{nearest(each, TYPES)}; export it"
                " again"
            )
    kinds = [TYPES[each] for each in types]
    if kinds[1:] and kinds[1].startswith("f"):
        raise InputError(
            f"{where}: the count of a list must have a whole type, not {shown(types[1])}; export it again"
        )
    return Property(name_of(match["property"]), *kinds)


class Lists(NamedTuple):
    """The lists of all rows: their values, list after list, and the number of values in each list."""

    values: AnyArray
    counts: Indices


Column = AnyArray | Lists


@dataclass(frozen=True)
class ElementRows:
    """The columns of an element by the names of its properties; `place_of` tells where a row is."""

    count: int
    columns: dict[str, Column]
    place_of: Callable[[int], str]


# Binary: if all rows of an element have the same size, they are one numpy array. If lists differ in length,
# as in a mesh of triangles and quads, the rows are walked to find where each row begins.

ROWS_AT_ONCE: Final = 1 << 16
"""Rows that are walked at once, so that there are few Python values at a time."""

LONGEST_ROW: Final = 1 << 20
"""Limit: bytes of a row that becomes one numpy type."""

CODES: Final = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q"}
"""The types of counts as `struct` has them."""


def read_binary(data: bytes, header: PlyHeader, place: str) -> tuple[dict[str, ElementRows], tuple[str, ...]]:
    """The elements of a file by name, and a message if bytes follow the last element.

    `place` is the file's name in messages. Raises InputError if the file is cut short.
    """
    at = header.length
    elements: dict[str, ElementRows] = {}
    for element in header.elements:
        least = element.count * sum(each.size for each in element.properties)
        if least > len(data) - at:
            raise _cut_short(place, element, f"at least {least:,} bytes, not {len(data) - at:,}")
        columns, at = _columns(data, at, element, header.order, place)

        def place_of(row: int, name: str = element.name) -> str:
            return f"{place}, {name} {row}"

        elements[element.name] = ElementRows(element.count, columns, place_of)
    left = len(data) - at
    return elements, (f"skipped bytes after the last element: {left:,}",) if left else ()


def _cut_short(place: str, element: Element, rule: str) -> InputError:
    return InputError(f"{place}: {element.count:,} elements {element.name!r} must have {rule}; {CUT_SHORT}")


def _columns(data: bytes, at: int, element: Element, order: str, place: str) -> tuple[dict[str, Column], int]:
    """The columns of an element that begins at a byte, and where the next element begins."""
    lists = [each for each in element.properties if each.count_type]
    counts = [0] * len(lists)
    if lists and element.count:
        # Suppose that all rows have lists as long as the first row; this is checked below.
        first, _ = _walk(data, at, replace(element, count=1), order, place)
        counts = [int(count[0]) for count in first]
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
    if size > LONGEST_ROW or at + element.count * size > len(data):
        return _walked(data, at, element, order, place)
    rows = np.frombuffer(data, np.dtype(fields), element.count, at)
    columns: dict[str, Column] = {}
    for number, each in enumerate(element.properties):
        values = rows[f"value {number}"]
        if each.count_type is None:
            columns[each.name] = values
            continue
        if not (rows[f"count {number}"] == values.shape[1]).all():
            return _walked(data, at, element, order, place)
        columns[each.name] = Lists(
            values.astype(each.type).ravel(), np.full(len(rows), values.shape[1], np.intp)
        )
    return columns, at + element.count * size


def _walked(data: bytes, at: int, element: Element, order: str, place: str) -> tuple[dict[str, Column], int]:
    """The columns of rows of different sizes, and where the next element begins."""
    counts, end = _walk(data, at, element, order, place)
    sizes = np.full(element.count, sum(each.size for each in element.properties))
    for count, each in zip(counts, [each for each in element.properties if each.count_type], strict=True):
        sizes += count * np.dtype(each.type).itemsize
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

    Measured: a million triangles and quads, in any order, in a third of a second.
    """
    # For each list of a row: the bytes before its count, how to read it, the bytes before its values, and the
    # bytes of a value. Then the bytes after the last list.
    lists, tail = [], 0
    for each in element.properties:
        if each.count_type:
            unpack = struct.Struct(order + CODES[each.count_type]).unpack_from
            lists.append((tail, unpack, tail + each.size, np.dtype(each.type).itemsize))
        tail = 0 if each.count_type else tail + each.size
    count_types = [each.count_type for each in element.properties if each.count_type]
    counts = np.empty((element.count, len(lists)), np.intp)
    for first in range(0, element.count, ROWS_AT_ONCE):
        some: list[int] = []
        rows = min(ROWS_AT_ONCE, element.count - first)
        try:
            if count_types == ["u1"]:
                before, _, width, size = lists[0]
                for _ in range(rows):
                    count = data[at + before]
                    some.append(count)
                    at += width + count * size + tail
            else:
                for _ in range(rows):
                    for before, unpack, width, size in lists:
                        (count,) = unpack(data, at + before)
                        some.append(count)
                        at += width + count * size
                    at += tail
        except (IndexError, OverflowError, struct.error):
            at = len(data) + 1
        if some and min(some) < 0:
            row = first + next(place for place, count in enumerate(some) if count < 0) // len(lists)
            raise InputError(
                f"{place}, {element.name} {row}: the count of a list must be 0 or more, not less; export it"
                " again"
            )
        if at > len(data):
            raise _cut_short(place, element, "all their lists before the end, not after it")
        counts[first : first + rows] = np.array(some, np.intp).reshape(rows, -1)
    return list(np.ascontiguousarray(counts.T)), at


CUT_SHORT: Final = "the file is cut short or its header is wrong, export it again"


def read_text(data: bytes, header: PlyHeader, place: str) -> tuple[dict[str, ElementRows], tuple[str, ...]]:
    """The elements of a file by name, and a message if lines follow the last element.

    `place` is the file's name in messages. Raises InputError.
    """
    if problem := text_problem(data):
        raise InputError(f"{place}: an ascii PLY file {problem}")
    body = data[header.length :]
    if b"\r" in body:
        body = body.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    # Empty lines stand for the header, so that line numbers are those of the file.
    text = NumberText(b"\n" * header.lines + body, place)
    firsts = text.lines()
    numbers = text.values(0, len(text))
    ends = np.append(firsts[1:], len(text))
    elements: dict[str, ElementRows] = {}
    row = 0
    for element in header.elements:
        if not element.properties:
            raise InputError(
                f"{place}: an element must have a property, not none: {element.name!r}; export it again"
            )
        begins = firsts[row : row + element.count]
        if len(begins) < element.count:
            raise InputError(
                f"{place}: there must be {element.count:,} elements {element.name!r}, not {len(begins):,};"
                f" {CUT_SHORT}"
            )
        columns = _text_columns(text, numbers, begins, ends[row : row + element.count], element)

        def place_of(at: int, begins: Indices = begins) -> str:
            return f"{place}, line {text.line(int(begins[at]))}"

        elements[element.name] = ElementRows(element.count, columns, place_of)
        row += element.count
    more = len(firsts) - row
    return elements, (f"skipped lines after the last element: {more:,}",) if more else ()


def _text_columns(
    text: NumberText, numbers: Floats, begins: Indices, ends: Indices, element: Element
) -> dict[str, Column]:
    """The columns of an element whose rows begin and end at some numbers."""
    columns: dict[str, Column] = {}
    at = begins.copy()

    def refuse_width(is_wrong: Booleans, fault: str) -> None:
        if not is_wrong.any():
            return
        line = text.line(int(begins[is_wrong.argmax()]))
        names = listed([each.name for each in element.properties[:8]])
        raise InputError(
            f"{text.place}, line {line}: a line of an element {element.name!r} must have the values of"
            f" {names}, and this {fault}; correct it"
        )

    for each in element.properties:
        refuse_width(at >= ends, "has too few")
        values = numbers[at]
        at += 1
        if each.count_type is None:
            columns[each.name] = values
            continue
        # A comparison with NaN is false.
        wrong = np.flatnonzero(~((values >= 0) & (values == np.floor(values))))
        if len(wrong):
            raise text.wrong(int(at[wrong[0]]) - 1, "the count of a list must be a whole number from 0 on")
        refuse_width(values > ends - at, "has too few")
        count = values.astype(np.intp)
        filled = count > 0
        columns[each.name] = Lists(numbers[runs(at[filled], count[filled])], count)
        at += count
    refuse_width(at < ends, "has too many")
    return columns
