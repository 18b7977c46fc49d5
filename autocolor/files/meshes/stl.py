"""Reading a mesh from an STL file, binary or text, welded; and writing a binary one.

A binary file may begin with `solid`, as text does. A file is binary if its count of triangles gives its size.
Each solid of a text is a part with its name; a binary file is one part, named after the file.
Normals, attributes, colors and the text before binary triangles are ignored: the normals are those of flat
triangles. Corners at the same place become one node; then triangles without area are dropped and counted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import cycle
from pathlib import Path
from typing import Final, NoReturn

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, Singles, underflowing
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import decimal, parsed
from autocolor.files.meshes.repair import (
    PLAIN,
    MeshReport,
    Placement,
    RawPolygons,
    different,
    name_of,
    repaired,
)
from autocolor.files.meshes.welding import welded
from autocolor.files.reading import UTF_8_MARK, read_whole, shown, text_lines
from autocolor.scene.geometry.normals import polygon_normals
from autocolor.scene.mesh import Mesh

GROWTH: Final = 6
"""Measured: how many times its size a binary file takes. A text takes half of that, in ten times the time."""

BEGINNING: Final = re.compile(rb"\s*+(?:(?:[#;!]|//)[^\r\n]*+\s*+)*+solid\b", re.IGNORECASE)
"""A solid in text, after empty lines and comments."""

FACET_WORDS: Final = re.compile(rb"[\r\n]\s*facet\s+(?:normal|outer)\s", re.IGNORECASE)


def read_stl(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of an STL file, and what was repaired or skipped.

    Raises InputError, with the place of each problem, and MissingInputError if the file does not exist.
    """
    corners, part_numbers, names, skipped = _triangles(path)
    points, rows = welded(corners)
    del corners
    polygons = RawPolygons(
        points.astype(np.float64, copy=False),
        rows,
        np.full(len(rows) // 3, 3, np.intp),
        part_numbers,
        names,
    )
    del points, rows
    return repaired(polygons, path.name, placement, skipped=tuple(skipped))


def _triangles(path: Path) -> tuple[AnyArray, Indices, tuple[str, ...], list[str]]:
    """The corners of the triangles, (corners, 3), their part numbers, the names of parts, and messages."""
    data = read_whole(path, GROWTH)
    is_text = BEGINNING.match(data) is not None and b"\0" not in data[:BEFORE_TRIANGLES]
    if (is_text or data[:2] in (b"\xff\xfe", b"\xfe\xff")) and len(data) != _binary_size(data):
        return read_text(text_lines(data, path.name, "an ascii STL file"), path.name, path.stem)
    corners, messages = read_binary(data, path.name)
    return corners, np.zeros(len(corners) // 3, np.intp), (path.stem,), messages


def begins_as_stl(head: bytes) -> bool:
    """Whether a file begins with a solid in text. Binary files are recognized by their suffix alone."""
    return BEGINNING.match(head.removeprefix(UTF_8_MARK)) is not None and FACET_WORDS.search(head) is not None


# A binary file has 80 bytes of any text, the count of triangles, and 50 bytes for each triangle.

BEFORE_TRIANGLES: Final = 84
TRIANGLE: Final = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def _binary_size(data: bytes) -> int:
    """The size of a binary file with the count of triangles that is in the data."""
    count = int.from_bytes(data[BEFORE_TRIANGLES - 4 : BEFORE_TRIANGLES], "little")
    return BEFORE_TRIANGLES + TRIANGLE.itemsize * count


def read_binary(data: bytes, place: str) -> tuple[Singles, list[str]]:
    """The corners of the triangles, (corners, 3), and messages about what was skipped.

    `place` is the file's name in messages. Raises InputError if the file is cut short, or about a triangle
    with a coordinate that is no finite number of at most 1e30 in size.
    """
    size = _binary_size(data)
    count = (size - BEFORE_TRIANGLES) // TRIANGLE.itemsize
    if size > len(data):
        raise InputError(
            f"{place}: a binary STL file of {count:,} triangles must have {size:,} bytes, not {len(data):,};"
            " export it again"
        )
    corners = np.array(np.frombuffer(data, TRIANGLE, count, BEFORE_TRIANGLES)["corners"]).reshape(-1, 3)
    # A comparison with NaN is false. The bound is rounded to float32 as the coordinates are.
    is_right = np.abs(corners) <= np.float32(LARGEST_COORDINATE)
    if not is_right.all():
        row, axis = np.argwhere(~is_right)[0].tolist()
        raise InputError(
            f"{place}, facet {row // 3 + 1}: a coordinate must be a finite number of at most 1e30 in size,"
            f" not {corners[row, axis]:g}; correct it"
        )
    left = len(data) - size
    return corners, [f"skipped bytes after the last triangle: {left:,}"] if left else []


TRIANGLES_OF: Final = np.array([[[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [1, 3, 0]], [[0, 1, 2], [0, 0, 0]]])
"""The corners of the triangles of a polygon, by the corner where its diagonal begins (see `Diagonals`)."""


@underflowing
def stl_bytes(mesh: Mesh) -> bytes:
    """The mesh as a binary STL file: its triangles, and two triangles for each quad.

    A quad is cut along its diagonal of `Mesh.diagonals`, which is the shorter one in most quads. Coordinates
    are rounded to float32. The normals are unit vectors by the right-hand rule, 0 for triangles without area.
    """
    at = TRIANGLES_OF[mesh.diagonals.starts].reshape(-1, 6)
    triangles = np.take_along_axis(mesh.node_numbers, at, axis=1).reshape(-1, 3)
    # Leave out triangles that repeat a corner.
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    records = np.zeros(len(triangles), TRIANGLE)
    records["corners"] = mesh.coordinates[triangles]
    # The normals fit the corners in the file, so that a file that is read is written again the same.
    records["normal"] = polygon_normals(records["corners"][:, [0, 1, 2, 2]].T.astype(np.float64)).T
    # The text must not begin with the word `solid`.
    begin = b"binary STL, written by autocolor".ljust(BEFORE_TRIANGLES - 4)
    return begin + len(records).to_bytes(4, "little") + records.tobytes()


# In text, solids are parts:
#
#     solid hood
#       facet normal 0 0 1
#         outer loop
#           vertex 0 0 0
#           vertex 1 0 0
#           vertex 0 1 0
#         endloop
#       endfacet
#     endsolid hood
#
# Words may be in capitals, and lines broken anywhere but in the names of solids. Other programs write `end
# loop`, a `facet` without its normal, lines of colors and comments, numbers with the exponent D, or no
# `endsolid`. Facets outside of solids are a part named after the file. Habits are brought to the form above,
# and lines keep their numbers.

BLOCK: Final = 1 << 21
"""Bytes converted at a time."""

SOLID: Final = re.compile(rb"^[ \t]*(end[ \t]*)?solid\b([^\n]*)$", re.MULTILINE | re.IGNORECASE)
ENDFACET: Final = re.compile(rb"end[ \t]*facet\s", re.IGNORECASE)

HABITS: Final = (
    (re.compile(rb"(?:#|;|!|//|^[ \t]*colou?r\b)[^\n]*", re.MULTILINE | re.IGNORECASE), rb""),
    (re.compile(rb"\bend[ \t]+(loop|facet)\b", re.IGNORECASE), rb"end\1"),
    (re.compile(rb"\bfacet(\s+)(?:normal(\s+))?(?=outer\b)", re.IGNORECASE), rb"facet normal 0 0 0\1\2"),
)
"""Habits of other programs, and the words for them on as many lines."""

FACET: Final = "facet normal . . . outer loop vertex . . . vertex . . . vertex . . . endloop endfacet"
WORDS: Final = tuple(word.encode() for word in FACET.split())
KEYWORDS: Final = tuple((at, word) for at, word in enumerate(WORDS) if word != b".")
COORDINATES: Final = (8, 9, 10, 12, 13, 14, 16, 17, 18)
"""The words of a facet that are coordinates."""


def read_text(data: bytes, place: str, stem: str) -> tuple[Floats, Indices, tuple[str, ...], list[str]]:
    """The corners of triangles, (corners, 3), their part numbers, the names of parts, and messages.

    The lines of `data` end with LF; `place` is the file's name in messages, `stem` the name of a solid
    without one. Raises InputError.
    """
    solids = [*SOLID.finditer(data)]
    ends = [*(match.start() for match in solids), len(data)]
    all_corners, counts, names = [np.empty((0, 3))], [], []
    for match, end in zip((None, *solids), ends, strict=True):
        corners = [*_corners(data, match.end() if match else 0, end, place)]
        # Empty lines and comments are no facets.
        if count := sum(map(len, corners)) // 3:
            all_corners += corners
            counts.append(count)
            names.append(name_of(match[2] if match and not match[1] else b"") or stem)
    is_cut = solids and not solids[-1][1]
    return (
        np.concatenate(all_corners),
        np.repeat(np.arange(len(counts)), np.array(counts, np.intp)),
        different(names),
        ["the last solid has no 'endsolid': the file may be cut short"] if is_cut else [],
    )


def _corners(data: bytes, begin: int, end: int, place: str) -> Iterator[Floats]:
    """The corners of the facets between two places, (corners, 3), of about BLOCK bytes at a time."""
    while begin < end:
        last = ENDFACET.search(data, min(begin + BLOCK, end), end)
        stop = end if last is None else last.end()
        text = data[begin:stop]
        if text.strip():
            corners = _corners_of_facets(text)
            if corners is None:
                for habit, words in HABITS:
                    text = habit.sub(words, text)
                corners = _corners_of_facets(text)
            if corners is None:
                _refuse(text, data.count(b"\n", 0, begin) + 1, place)
            yield corners
        begin = stop


def _corners_of_facets(text: bytes) -> Floats | None:
    """The corners of whole facets, (corners, 3); None if a word is wrong."""
    words = text.lower().split()
    facets, more = divmod(len(words), len(WORDS))
    if more or any(words[at :: len(WORDS)].count(word) != facets for at, word in KEYWORDS):
        return None
    try:
        corners = np.stack([parsed(b" ".join(words[at :: len(WORDS)]), facets) for at in COORDINATES])
    except ValueError:
        return None
    return corners.T.reshape(-1, 3) if (np.abs(corners) <= LARGEST_COORDINATE).all() else None


def _refuse(text: bytes, line: int, place: str) -> NoReturn:
    """Raise InputError about the first word of facets, from a line on, that is wrong."""
    # The end is an empty word.
    words = zip(re.finditer(rb"\S+|\Z", text.rstrip()), cycle(enumerate(WORDS)), strict=False)
    for match, (number, wanted) in words:
        word = match[0]
        if number in COORDINATES and word:
            is_right = abs(decimal(word)) <= LARGEST_COORDINATE
        else:
            is_right = wanted == word.lower() or (wanted == b"." and word != b"")
        if not is_right:
            break
    line += text.count(b"\n", 0, match.start())
    expected = "a number of at most 1e30 in size" if number in COORDINATES else repr(wanted.decode())
    raise InputError(
        f"{place}, line {line}: a facet must have {expected} here, not {shown(word) if word else 'its end'};"
        " correct it"
    )
