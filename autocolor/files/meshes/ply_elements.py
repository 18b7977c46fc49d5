"""The header of a PLY file: its elements, and the types of their properties.

A header is lines of text that end with LF, CR LF or CR, from `ply` to `end_header`. It may use the old names
of types, as in `uchar`, and the new ones, as in `uint8`.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Final, NamedTuple, NoReturn

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, Numbers, runs
from autocolor.checks import either, nearest
from autocolor.errors import InputError
from autocolor.files.meshes.repair import name_of
from autocolor.files.reading import HEAD, shown, text_problem

# -------------------- properties
# Which properties of a PLY file are what: coordinates, corners, parts, scalars, and what is not used.

AXES: Final = ("x", "y", "z")
VERTEX: Final = "vertex"
FACE: Final = "face"
STRIPS: Final = "tristrips"
CORNERS: Final = ("vertex_indices", "vertex_index")

PART: Final = "part"
PARTS: Final = (PART, "material_index", "group")
"""Properties of faces that divide them into parts; the first of them that a file has does."""

MOST_UNNAMED_PARTS: Final = 10_000
"""Assumed: a number that has more values is no part, but a scalar."""

NOT_SCALARS: Final = frozenset(
    (
        *("nx", "ny", "nz", "normal_x", "normal_y", "normal_z"),
        *("s", "t", "u", "v", "s0", "t0", "u0", "v0", "texture_s", "texture_t", "texture_u", "texture_v"),
        *("texcoord", "texnumber", "flags"),
        *("r", "g", "b", "a", "red", "green", "blue", "alpha"),
        *(
            f"{kind}_{part}"
            for kind in ("ambient", "diffuse", "specular")
            for part in ("red", "green", "blue", "alpha", "coeff", "power")
        ),
    )
)
"""Normals, colors and texture coordinates, ignored as those of OBJ files are, and flags of other programs."""

NAMED_PART: Final = re.compile(r"part (\d{1,9}) (.+)")
NAMED_SCALAR: Final = re.compile(r"scalar (\S+) (.+)")
PLAIN_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_.\-]{0,63}")


class Comments(NamedTuple):
    """What comments name: parts by number, and scalars by their properties."""

    parts: Mapping[int, str]
    scalars: Mapping[str, str]


def named_in(comments: Sequence[str]) -> Comments:
    """The names in comments such as `part 0 hood` and `scalar value_0 von Mises`; others say nothing."""
    parts: dict[int, str] = {}
    scalars: dict[str, str] = {}
    for comment in comments:
        if match := NAMED_PART.fullmatch(comment):
            parts.setdefault(int(match[1]), name_of(match[2].encode()))
        elif match := NAMED_SCALAR.fullmatch(comment):
            scalars.setdefault(match[1], name_of(match[2].encode()))
    return Comments(parts, scalars)


def is_scalar(name: str, comments: Comments) -> bool:
    """Whether a property of a vertex or a face, which is a number, is a scalar of the mesh."""
    return name in comments.scalars or (name not in NOT_SCALARS and name not in AXES)


def property_of(scalar: str, number: int) -> str:
    """The property that a scalar is written as; where that is not its name, a comment must give it."""
    is_free = scalar not in NOT_SCALARS and scalar not in (*AXES, *PARTS, *CORNERS)
    is_free = is_free and not scalar.startswith("value_")
    return scalar if is_free and PLAIN_NAME.fullmatch(scalar) else f"value_{number}"


LARGEST_HEADER: Final = 16 << 20
"""Assumed: in bytes; a comment for each of a hundred thousand parts."""

LONGEST_LINE: Final = 1 << 16
MOST_ELEMENTS: Final = 100
MOST_PROPERTIES: Final = 1000
"""Assumed: of all elements together."""

FORMATS: Final = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
"""The formats, and the byte orders of numbers in them."""

TYPES: Final = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8",
}  # fmt: skip
"""The types that a header names, as those of numpy. Integers of 64 bits are no PLY, but there are
files with them."""

FIRST_LINE: Final = re.compile(rb"ply[ \t]*(\r?\n|\r)")
COUNT: Final = re.compile(rb"[0-9]{1,18}")


class Property(NamedTuple):
    """A property: its name, and its type as numpy has it; for a list also the type of its count."""

    name: str
    type: str
    count_type: str | None = None

    @property
    def size(self) -> int:
        """The bytes of a value in a binary file; of a list, those of its count."""
        return np.dtype(self.count_type or self.type).itemsize


@dataclass(frozen=True)
class Element:
    """An element: its name, how many there are, and their properties."""

    name: str
    count: int
    properties: tuple[Property, ...]

    @property
    def is_used(self) -> bool:
        """Whether a mesh is made of it."""
        return self.name in (VERTEX, FACE, STRIPS)

    @property
    def least_corners(self) -> int:
        """How many corners its lists must have together at least.

        Assumed: one for each face, so that no file of empty faces takes much memory.
        """
        return self.count if self.name == FACE and any(each.count_type for each in self.properties) else 0


class Header(NamedTuple):
    """What a header says: the byte order, empty for text; the elements; the comments; its length in bytes."""

    order: str
    elements: tuple[Element, ...]
    comments: tuple[str, ...]
    length: int
    lines: int


def begins_as_ply(head: bytes) -> bool:
    """Whether a file begins as PLY does."""
    return FIRST_LINE.match(head) is not None


def parsed_header(data: bytes, place: str) -> Header:
    """The header at the start of a file; `place` is its name in messages. Raises InputError."""
    if problem := text_problem(data[:2]):
        raise InputError(f"{place}: a PLY file {problem}")
    if not FIRST_LINE.match(data):
        found = shown(data[:HEAD].split(b"\n")[0].strip())
        raise InputError(f"{place}: a PLY file must begin with a line 'ply', not {found}; export it again")
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
    return Header(order, elements, tuple(comments), length, number)


def _lines(data: bytes, place: str) -> Iterator[tuple[bytes, int]]:
    """Each line of the header, and where the next begins. Raises InputError where the header does not end."""
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


# -------------------- columns
# What a PLY file holds of its elements: columns of numbers and of lists of numbers.


class Lists(NamedTuple):
    """Lists, one a row: all their values, one list after the other, and how many each has."""

    values: AnyArray
    counts: Indices


Column = AnyArray | Lists


@dataclass(frozen=True)
class Rows:
    """The columns of an element by the names of its properties; `place_of` tells where a row is."""

    count: int
    columns: dict[str, Column]
    place_of: Callable[[int], str]


class PlyTables(NamedTuple):
    """The elements of a file by name, and what of it comes after them, as the end of a message."""

    elements: dict[str, Rows]
    skipped: tuple[str, ...] = ()


# -------------------- binary
# The elements of a binary PLY file.
#
# Elements whose rows all have the same size are looked at as arrays. Only where lists differ in their
# counts, as in a mesh of triangles and quads, does each row tell where the next begins.

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
            flat = values.astype(each.type).ravel()
            yield each.name, Lists(flat, np.full(len(rows), values.shape[1], np.intp))
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

    Measured: a million triangles and quads, in any order, in a fifth of a second.
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


# -------------------- text
# The elements of a PLY file in text: a line for each, which begins with its first property.
#
# Numbers are decimal; `nan` and `inf` are numbers, too, since scalars may be missing. Empty lines are
# skipped. Blocks of lines are converted to arrays at once, and looked at line by line only to say what is
# wrong.

BLOCK: Final = 1 << 21
"""Bytes converted at a time: enough for numpy to be efficient, and few enough to save memory."""

LONGEST_LINE_2: Final = 1 << 20
"""Assumed: in bytes; a polygon of a thousand corners with many scalars has a tenth of it."""

MOST_DIGITS: Final = 18
"""The digits of a whole number that surely is one of 64 bits."""

DIGITS: Final = b"0123456789 \t\n"
NUMERIC: Final = DIGITS + b"+-.eE" + b"nNaAiIfFtTyY"
"""What decimal numbers, `nan` and `infinity` are made of; `float` takes nothing else that is made of it."""

NUMBER: Final = re.compile(
    rb"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|(?i:nan|inf|infinity))"
)


class Block(NamedTuple):
    """Some lines that are not empty: all their numbers, and how many each line has."""

    numbers: Floats
    counts: Numbers


def read_text(data: bytes, header: Header, place: str) -> PlyTables:
    """The elements of a file; `place` is its name in messages. Raises InputError."""
    if problem := text_problem(data):
        raise InputError(f"{place}: an ascii PLY file {problem}")
    body = data[header.length :]
    if b"\r" in body:
        body = body.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    lines = TextLines(body, header.lines, place)
    elements: dict[str, Rows] = {}
    row = 0
    for element in header.elements:
        if not element.properties:
            raise InputError(
                f"{place}: an element must have a property, not none: {element.name!r}; export it again"
            )
        columns = _columns_2(lines, element, row)

        def place_of(at: int, first: int = row) -> str:
            return f"{place}, line {lines.number_of(first + at)}"

        elements[element.name] = Rows(element.count, columns, place_of)
        row += element.count
    left = lines.left()
    return PlyTables(elements, (f"skipped lines after the last element: {left:,}",) if left else ())


class TextLines:
    """The lines of a text that are not empty, taken one block after the other.

    `before` is how many lines of the file stand before the text.
    """

    def __init__(self, text: bytes, before: int, place: str) -> None:
        self.text = text
        self.before = before
        self.place = place
        self.at = 0
        self.taken = 0
        self.kept = Block(np.empty(0), np.empty(0, np.int64))
        # The numbers of lines are only wanted where something is wrong.
        self.line_numbers = cache(self._line_numbers)

    def take(self, most: int) -> Block:
        """The next lines, at most so many; none at the end. Raises InputError if one has no number."""
        while not len(self.kept.counts) and self.at < len(self.text):
            self.kept = self._next_block()
        numbers, counts = self.kept
        if len(counts) > most:
            end = int(counts[:most].sum())
            self.kept = Block(numbers[end:], counts[most:])
            numbers, counts = numbers[:end], counts[:most]
        else:
            self.kept = Block(numbers[:0], counts[:0])
        self.taken += len(counts)
        return Block(numbers, counts)

    def left(self) -> int:
        """How many lines that are not empty were not taken."""
        has_more = len(self.kept.counts) or self.at < len(self.text)
        return len(self.line_numbers()) - self.taken if has_more else 0

    def bytes_left(self) -> int:
        """How many bytes at most were not taken."""
        return len(self.text) - self.at + 1 + 2 * len(self.kept.numbers)

    def number_of(self, row: int) -> int:
        """The number in the file of a line of those that are not empty, counted from 0."""
        return int(self.line_numbers()[row]) + self.before + 1

    def refuse(self, row: int, sentence: str) -> NoReturn:
        """Raise InputError about one of the lines that are not empty."""
        raise InputError(f"{self.place}, line {self.number_of(row)}: {sentence}")

    def _next_block(self) -> Block:
        end = self.text.find(b"\n", min(self.at + BLOCK, len(self.text)))
        block = self.text[self.at :] if end < 0 else self.text[self.at : end + 1]
        self.at += len(block)
        block = block if block.endswith(b"\n") else block + b"\n"
        lines = np.frombuffer(block, np.uint8)
        is_space = lines <= ord(" ")
        ends = np.flatnonzero(lines == ord("\n"))
        if int(np.diff(ends, prepend=-1).max()) > LONGEST_LINE_2:
            raise InputError(
                f"{self.place}: a line must have at most {LONGEST_LINE_2:,} bytes, not more; split it"
            )
        counts = _words_a_line(is_space, ends)
        counts = counts[counts > 0]
        numbers = _numbers(block, is_space, int(counts.sum()))
        if numbers is None:
            self._refuse_number(block)
        return Block(numbers, counts)

    def _refuse_number(self, block: bytes) -> NoReturn:
        """Raise InputError about the first word of a block that is no number."""
        row = self.taken
        for line in block.split(b"\n"):
            words = line.split()
            for word in words:
                if not NUMBER.fullmatch(word):
                    self.refuse(row, f"a value must be a decimal number, not {shown(word)}; correct it")
            row += bool(words)
        raise InputError(f"{self.place}: a file must have numbers between spaces; export it again")

    def _line_numbers(self) -> Indices:
        """The numbers, from 0, of the lines that are not empty."""
        text = self.text if self.text.endswith(b"\n") else self.text + b"\n"
        lines = np.frombuffer(text, np.uint8)
        counts = _words_a_line(lines <= ord(" "), np.flatnonzero(lines == ord("\n")))
        return np.flatnonzero(counts)


def _words_a_line(is_space: Booleans, ends: Indices) -> Numbers:
    """The number of words in each line, given by where there is space and where lines end."""
    starts = ~is_space
    starts[1:] &= is_space[:-1]
    return np.add.reduceat(starts, np.concatenate([[0], ends[:-1] + 1]), dtype=np.int64)


def _numbers(block: bytes, is_space: Booleans, count: int) -> Floats | None:
    """The numbers of a block; None if a word is none."""
    longest = int(np.diff(np.flatnonzero(is_space), prepend=-1).max()) - 1
    if longest <= MOST_DIGITS and not block.translate(None, DIGITS):
        # Measured: a tenth of the time of converting word by word. With digits alone, parsing cannot stop.
        return np.fromstring(block, np.int64, sep=" ").astype(np.float64) if count else np.empty(0)
    if block.translate(None, NUMERIC):
        return None
    try:
        return np.fromiter(map(float, block.decode("ascii").split()), np.float64, count)
    except ValueError:
        return None


def _columns_2(lines: TextLines, element: Element, first: int) -> dict[str, Column]:
    """The columns of an element whose first row is one of the lines that are not empty."""
    # A number has a byte and one after it.
    least = 2 * (element.count * len(element.properties) + element.least_corners)
    if least > lines.bytes_left():
        raise InputError(
            f"{lines.place}: {element.count:,} elements {element.name!r} must have at least {least:,} bytes,"
            f" not {lines.bytes_left():,}; the file is cut short or its header is wrong, export it again"
        )
    pieces: list[list[Column]] = []
    row = 0
    while row < element.count:
        block = lines.take(element.count - row)
        if not len(block.counts):
            raise InputError(
                f"{lines.place}: there must be {element.count:,} elements {element.name!r}, not {row:,}; the"
                " file is cut short or its header is wrong, export it again"
            )
        pieces.append(list(_split(lines, block, element, first + row)))
        row += len(block.counts)
    if not pieces:
        return {
            each.name: Lists(np.empty(0), np.empty(0, np.intp)) if each.count_type else np.empty(0)
            for each in element.properties
        }
    names = [each.name for each in element.properties]
    return dict(zip(names, map(_joined, zip(*pieces, strict=True)), strict=True))


def _joined(pieces: tuple[Column, ...]) -> Column:
    """One column of those of several blocks."""
    lists = [each for each in pieces if isinstance(each, Lists)]
    if lists:
        return Lists(*(np.concatenate(column) for column in zip(*lists, strict=True)))
    return np.concatenate([each for each in pieces if not isinstance(each, Lists)])


def _split(lines: TextLines, block: Block, element: Element, first: int) -> Iterator[Column]:
    """The columns of the lines of a block; the first of them is so many lines after the header."""
    numbers, counts = block
    ends = np.cumsum(counts)
    at = ends - counts
    for each in element.properties:
        missing = np.flatnonzero(at >= ends)
        if len(missing):
            _refuse_width(lines, element, first + int(missing[0]), "has too few")
        values = numbers[at]
        at = at + 1
        if each.count_type is None:
            yield values
            continue
        # A comparison with NaN is false.
        wrong = np.flatnonzero(~((values >= 0) & (values == np.floor(values))))
        if len(wrong):
            row = int(wrong[0])
            lines.refuse(
                first + row,
                f"the count of a list must be a whole number from 0 on, not {values[row]:g}; correct it",
            )
        short = np.flatnonzero(values > ends - at)
        if len(short):
            _refuse_width(lines, element, first + int(short[0]), "has too few")
        count = values.astype(np.intp)
        yield Lists(numbers[_items(at, count)], count)
        at = at + count
    over = np.flatnonzero(at < ends)
    if len(over):
        _refuse_width(lines, element, first + int(over[0]), "has too many")


def _items(at: Indices, count: Indices) -> Indices:
    """The places of the values of lists that begin at some places."""
    filled = count > 0
    return runs(at[filled], count[filled])


def _refuse_width(lines: TextLines, element: Element, row: int, found: str) -> NoReturn:
    names = ", ".join(each.name for each in element.properties[:8])
    more = ", ..." if len(element.properties) > 8 else ""
    lines.refuse(
        row,
        f"a line of an element {element.name!r} must have the values of {names}{more}, and this {found};"
        " correct it",
    )
