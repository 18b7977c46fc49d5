"""The header of a PLY file: its elements, and the types of their properties.

A header is lines of text that end with LF, CR LF or CR, from `ply` to `end_header`. It may use the old names
of types, as in `uchar`, and the new ones, as in `uint8`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor.checks import either, nearest
from autocolor.errors import InputError
from autocolor.files.meshes.ply.properties import FACE, STRIPS, VERTEX
from autocolor.files.reading import HEAD, shown, text_problem
from autocolor.files.repair.names import name_of

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
