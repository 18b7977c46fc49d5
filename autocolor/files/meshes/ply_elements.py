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
from typing import Final, NamedTuple, NoReturn

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, runs
from autocolor.checks import either, nearest
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import IN_PLY, NumberText
from autocolor.files.meshes.repair import name_of
from autocolor.files.reading import HEAD, shown, text_problem

VERTEX: Final = "vertex"
FACE: Final = "face"
STRIPS: Final = "tristrips"

LARGEST_HEADER: Final = 16 << 20
"""Limit: in bytes; a comment for each of a hundred thousand parts."""

LONGEST_LINE: Final = 1 << 16
MOST_ELEMENTS: Final = 100
MOST_PROPERTIES: Final = 1000
"""Limit: of all elements together."""

FORMATS: Final = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
"""The formats, and the byte orders of numbers in them."""

TYPES: Final = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8",
}  # fmt: skip
"""The types in a header, as numpy's. PLY has no integers of 64 bits, but some files do."""

FIRST_LINE: Final = re.compile(rb"ply[ \t]*(\r?\n|\r)")
COUNT: Final = re.compile(rb"[0-9]{1,18}")


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
    properties: tuple[Property, ...]

    @property
    def is_used(self) -> bool:
        """Whether it is part of a mesh."""
        return self.name in (VERTEX, FACE, STRIPS)

    @property
    def least_corners(self) -> int:
        """Limit: the least number of corners, one for each face, so that empty faces take little memory."""
        return self.count if self.name == FACE and any(each.count_type for each in self.properties) else 0


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
    names: list[tuple[str, int]] = []
    properties: list[list[Property]] = []
    comments: list[str] = []
    for number, (line, end) in enumerate(_lines(data, place), start=1):
        length = end
        words = line.split()
        where = f"{place}, line {number}"
        if not words or words[0] == b"obj_info" or number == 1:
            continue
        if words[0] == b"comment":
            comments.append(line.strip()[len(b"comment") :].strip().decode("utf-8", "replace"))
        elif words[0] == b"format":
            order = _order(words, where)
        elif words[0] == b"element":
            names.append(_element(words, where, [name for name, _ in names]))
            properties.append([])
        elif words[0] == b"property" and properties:
            properties[-1].append(_property(words, where, properties[-1]))
            if sum(map(len, properties)) > MOST_PROPERTIES:
                raise InputError(
                    f"{where}: a header must have at most {MOST_PROPERTIES:,} properties, not more; leave out"
                    " what is not needed"
                )
        elif words[0] == b"end_header":
            break
        else:
            raise InputError(
                f"{where}: a line of the header must be a format, a comment, an element, one of its"
                f" properties or end_header, not {shown(line.strip())}; export it again"
            )
    if order is None:
        raise InputError(f"{place}: a header must have a line 'format', not none; export it again")
    elements = tuple(
        Element(name, count, tuple(of_it)) for (name, count), of_it in zip(names, properties, strict=True)
    )
    return PlyHeader(order, elements, tuple(comments), length, number)


def _lines(data: bytes, place: str) -> Iterator[tuple[bytes, int]]:
    """Each line of the header, and the place after it. Raises InputError if the header does not end."""
    # A line that ends with CR may be followed by binary data that begins with LF.
    first = FIRST_LINE.match(data)
    feed = b"\r" if first is not None and first[1] == b"\r" else b"\n"
    at = 0
    while at < min(len(data), LARGEST_HEADER):
        end = data.find(feed, at, at + LONGEST_LINE)
        if end < 0 and len(data) - at > LONGEST_LINE:
            raise InputError(
                f"{place}: a line of the header must have at most {LONGEST_LINE:,} bytes, not more; export"
                " it again"
            )
        yield data[at:end] if end >= 0 else data[at:], end + 1 if end >= 0 else len(data)
        at = end + 1 if end >= 0 else len(data)
    most = f"within {LARGEST_HEADER:,} bytes" if at < len(data) else "before the file ends"
    raise InputError(f"{place}: a header must have a line 'end_header' {most}; export it again")


def _order(words: list[bytes], where: str) -> str:
    """The byte order of a line `format NAME 1.0`."""
    name = words[1].decode("latin-1") if len(words) == 3 else ""
    if name not in FORMATS or words[2] != b"1.0":
        raise InputError(
            f"{where}: a format must be {either(FORMATS)} and 1.0, not {shown(b' '.join(words[1:]))}; export"
            " it again"
        )
    return FORMATS[name]


def _element(words: list[bytes], where: str, before: list[str]) -> tuple[str, int]:
    """The name and the count of a line `element NAME COUNT`."""
    if len(words) != 3 or not COUNT.fullmatch(words[2]):
        raise InputError(
            f"{where}: an element must have a name and a count of at most 18 digits, not"
            f" {shown(b' '.join(words[1:]))}; export it again"
        )
    name = name_of(words[1])
    if name in before:
        raise InputError(
            f"{where}: the name of an element must be unique, not repeated: {name!r}; rename one"
        )
    if len(before) >= MOST_ELEMENTS:
        raise InputError(
            f"{where}: a header must have at most {MOST_ELEMENTS} elements, not more; leave out what is not"
            " needed"
        )
    return name, int(words[2])


def _property(words: list[bytes], where: str, before: list[Property]) -> Property:
    """The property of a line `property TYPE NAME` or `property list TYPE TYPE NAME`."""
    is_list = words[1:2] == [b"list"]
    types = [word.decode("latin-1") for word in words[1 + is_list : -1]]
    if len(types) != 1 + is_list:
        raise InputError(
            f"{where}: a property must be a type and a name, or list, two types and a name, not"
            f" {shown(b' '.join(words[1:]))}; export it again"
        )
    for each in types:
        if each not in TYPES:
            raise InputError(
                f"{where}: a type must be one of PLY, not {shown(each)}{nearest(each, TYPES)}; export it"
                " again"
            )
    if is_list and TYPES[types[0]].startswith("f"):
        raise InputError(
            f"{where}: the count of a list must have a whole type, not {shown(types[0])}; export it again"
        )
    name = name_of(words[-1])
    if any(name == each.name for each in before):
        raise InputError(
            f"{where}: the name of a property must be unique, not repeated: {name!r}; rename one"
        )
    return Property(name, TYPES[types[-1]], TYPES[types[0]] if is_list else None)


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

Step = tuple[int, str, int]
"""A list in a row: the bytes before its count, the type of the count, and the bytes of a value."""


def read_binary(data: bytes, header: PlyHeader, place: str) -> tuple[dict[str, ElementRows], tuple[str, ...]]:
    """The elements of a file by name, and a message if bytes follow the last element.

    `place` is the file's name in messages. Raises InputError if the file is cut short.
    """
    at = header.length
    elements: dict[str, ElementRows] = {}
    for element in header.elements:
        least = element.count * sum(each.size for each in element.properties) + element.least_corners
        if least > len(data) - at:
            _refuse_short(place, element, f"at least {least:,} bytes, not {len(data) - at:,}")
        columns, at = _columns(data, at, element, header.order, place)

        def place_of(row: int, name: str = element.name) -> str:
            return f"{place}, {name} {row}"

        elements[element.name] = ElementRows(element.count, columns, place_of)
    left = len(data) - at
    return elements, (f"skipped bytes after the last element: {left:,}",) if left else ()


def _refuse_short(place: str, element: Element, rule: str) -> NoReturn:
    raise InputError(f"{place}: {element.count:,} elements {element.name!r} must have {rule}; {CUT_SHORT}")


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
    if not element.is_used:
        return {}, end
    sizes = np.full(element.count, sum(each.size for each in element.properties))
    for count, (_, _, width) in zip(counts, _steps(element.properties)[0], strict=True):
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

    For an unused element, only the counts of the last rows are returned.

    Measured: a million triangles and quads, in any order, in a fifth of a second.
    """
    steps, tail = _steps(element.properties)
    blocks: list[AnyArray] = []
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
            blocks.clear()
        blocks.append(np.array(counts, np.intp).reshape(rows, -1))
    return list(np.ascontiguousarray(np.concatenate(blocks).T)), at


def _steps(properties: tuple[Property, ...]) -> tuple[list[Step], int]:
    """The lists of a row, and the bytes after the last list."""
    steps = []
    before = 0
    for each in properties:
        before += 0 if each.count_type else each.size
        if each.count_type:
            steps.append((before, each.count_type, np.dtype(each.type).itemsize))
            before = 0
    return steps, before


def _walk_short_lists(data: bytes, at: int, rows: int, step: Step, tail: int, counts: list[int]) -> int:
    """Append the count of the list in each row, a byte. Returns the place where the rows end."""
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
    """Append the counts of the lists in each row, up to a negative count. Returns the end of the rows."""
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


CUT_SHORT: Final = "the file is cut short or its header is wrong, export it again"

LONGEST_TEXT_LINE: Final = 1 << 20
"""Limit: bytes of a row in text; a polygon of a thousand corners with many scalars has a tenth of it."""


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
    firsts, longest = text.lines()
    if longest > LONGEST_TEXT_LINE:
        raise InputError(f"{place}: a line must have at most {LONGEST_TEXT_LINE:,} bytes, not more; split it")
    numbers = text.values(0, len(text), IN_PLY)
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
        corners = sum(len(each.values) for each in columns.values() if isinstance(each, Lists))
        if corners < element.least_corners:
            raise InputError(
                f"{place}: {element.count:,} elements {element.name!r} must have at least as many corners,"
                f" not {corners:,}; {CUT_SHORT}"
            )

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
        names = ", ".join(each.name for each in element.properties[:8])
        more = ", ..." if len(element.properties) > 8 else ""
        raise InputError(
            f"{text.place}, line {text.line(int(begins[is_wrong.argmax()]))}: a line of an element"
            f" {element.name!r} must have the values of {names}{more}, and this {fault}; correct it"
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
