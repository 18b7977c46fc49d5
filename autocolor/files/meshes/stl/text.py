"""The triangles of an STL file in text, whose solids are parts.

    solid hood
      facet normal 0 0 1
        outer loop
          vertex 0 0 0
          vertex 1 0 0
          vertex 0 1 0
        endloop
      endfacet
    endsolid hood

Words may be in capitals, and lines broken anywhere but in the names of solids. Normals are ignored.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain
from typing import Final, NamedTuple, NoReturn

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.obj.lines import NUMBER
from autocolor.files.reading import shown

BLOCK: Final = 1 << 21
"""Bytes converted at a time."""

LONGEST_FACET: Final = 1 << 16
"""Assumed: in bytes; a facet seldom has more than three hundred."""

SOLID: Final = re.compile(rb"^[ \t]*(end)?solid\b([^\n]*)$", re.MULTILINE | re.IGNORECASE)

FACET: Final = "facet normal . . . outer loop vertex . . . vertex . . . vertex . . . endloop endfacet"
WORDS: Final = tuple(word.encode() for word in FACET.split())
KEYWORDS: Final = tuple((at, word) for at, word in enumerate(WORDS) if word != b".")
COORDINATES: Final = (8, 9, 10, 12, 13, 14, 16, 17, 18)
"""The words of a facet that are coordinates."""

NUMERIC: Final = b"0123456789+-.e "


class TextTriangles(NamedTuple):
    """The corners of triangles, (corners, 3); the part number of each, the names of parts, and messages."""

    corners: Floats
    part_numbers: Indices
    names: tuple[bytes, ...]
    messages: tuple[str, ...]


def read_text(data: bytes, place: str) -> TextTriangles:
    """The triangles of a file whose lines end with LF; `place` is its name in messages. Raises InputError."""
    corners = [np.empty((0, 3))]
    counts: list[int] = []
    names: list[bytes] = []
    name: bytes | None = None
    begin = 0
    for match in chain(SOLID.finditer(data), (None,)):
        end = len(data) if match is None else match.start()
        found = [_corners(data, *block, place) for block in _blocks(data, begin, end, place)]
        if name is None and found:
            _refuse(data, begin, place, "a facet must stand in a solid, not outside; add a line 'solid'")
        if name is not None and found:
            corners += found
            counts.append(sum(map(len, found)) // 3)
            names.append(name)
        if match is None:
            break
        if name is None and match[1]:
            _refuse(data, match.start(), place, "a solid must begin before it ends; remove the line")
        if name is not None and not match[1]:
            _refuse(data, match.start(), place, "a solid must end before the next; add a line 'endsolid'")
        name = None if match[1] else match[2]
        begin = match.end()
    return TextTriangles(
        np.concatenate(corners),
        np.repeat(np.arange(len(counts)), np.array(counts, np.intp)),
        tuple(names),
        ("the last solid has no 'endsolid': the file may be cut short",) if name is not None else (),
    )


def _blocks(data: bytes, begin: int, end: int, place: str) -> Iterator[tuple[int, int]]:
    """The facets between two places, in blocks of about BLOCK bytes, by where these begin and end."""
    while begin < end:
        most = min(begin + BLOCK, end)
        found = ENDFACET.search(data, most, min(most + LONGEST_FACET, end))
        if found is None and most + LONGEST_FACET < end:
            _refuse(
                data, most, place, f"a facet must have at most {LONGEST_FACET:,} bytes, not more; correct it"
            )
        stop = end if found is None else found.end()
        if data[begin:stop].strip():
            yield begin, stop
        begin = stop


ENDFACET: Final = re.compile(rb"endfacet\s", re.IGNORECASE)


def _corners(data: bytes, begin: int, end: int, place: str) -> Floats:
    """The corners of whole facets, (corners, 3)."""
    words = data[begin:end].lower().split()
    facets = len(words) // len(WORDS)
    if len(words) != facets * len(WORDS) or any(
        words[at :: len(WORDS)].count(word) != facets for at, word in KEYWORDS
    ):
        _refuse_words(data, begin, end, place)
    corners = np.empty((len(COORDINATES), facets))
    for row, at in enumerate(COORDINATES):
        column = words[at :: len(WORDS)]
        try:
            if b" ".join(column).translate(None, NUMERIC):
                raise ValueError
            corners[row] = np.fromiter(map(float, column), np.float64, facets)
        except ValueError:
            _refuse_words(data, begin, end, place)
    if not (np.abs(corners) <= LARGEST_COORDINATE).all():
        _refuse_words(data, begin, end, place)
    return corners.T.reshape(-1, 3)


def _refuse_words(data: bytes, begin: int, end: int, place: str) -> NoReturn:
    """Raise InputError about the first word that is wrong."""
    at = 0
    for at, match in enumerate(re.finditer(rb"\S+", data[begin:end])):
        wanted = WORDS[at % len(WORDS)]
        word = match[0]
        if wanted != b"." and word.lower() != wanted:
            _refuse(
                data,
                begin + match.start(),
                place,
                f"a facet must be {FACET!r}, with numbers for the points, and {wanted.decode()!r} must stand"
                f" here, not {shown(word)}; correct it",
            )
        if at % len(WORDS) in COORDINATES and not (
            NUMBER.fullmatch(word) and abs(float(word)) <= LARGEST_COORDINATE
        ):
            rule = "a coordinate must be a decimal number of at most 1e30 in size"
            _refuse(data, begin + match.start(), place, f"{rule}, not {shown(word)}; correct it")
    wanted = WORDS[(at + 1) % len(WORDS)]
    _refuse(
        data, end, place, f"a facet must be {FACET!r}, and not end before its {wanted.decode()!r}; correct it"
    )


def _refuse(data: bytes, at: int, place: str, sentence: str) -> NoReturn:
    """Raise InputError about what stands at a byte."""
    # Spaces before it may be lines of their own.
    at += len(data[at : at + LONGEST_FACET]) - len(data[at : at + LONGEST_FACET].lstrip())
    line = data.count(b"\n", 0, min(at, max(len(data) - 1, 0))) + 1
    raise InputError(f"{place}, line {line}: {sentence}")
