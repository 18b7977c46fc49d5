"""Reading a mesh from a Movie.BYU geometry file.

    parts nodes polygons connectivity       four counts
    first last ...                          the polygons of each part, numbered from 1
    x y z ...                               the coordinates of each node
    node node -node ...                     the corners of each polygon; the last is negative

Numbers stand in columns (whole numbers of the width of the header's, coordinates of 12), where they may
touch, or are separated by white space. A part is named by its number, as in "part 1"; a polygon in no range
belongs to a part named after the file, and one in several ranges to the last. Exponents may be written with
D. Displacements and scalars are in files of their own, which are not read.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import Indices, Numbers
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import GROWTH, NumberText
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.reading import read_whole, text_lines

TOUCHING: Final = re.compile(rb"(?<=[0-9.])(?=[+-])")
"""Where a number with a sign begins right after another; the sign of an exponent follows a letter."""

WIDTHS: Final = (5, 6, 7, 8, 9, 10)
"""Assumed: the columns of whole numbers. The manual has 8; older files have 5."""

COORDINATE_WIDTH: Final = 12

MOST_OVERLAP: Final = 100
"""Limit: part ranges that contain a polygon, on average; each takes time."""


def read_byu(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a Movie.BYU file, and what was repaired. Raises InputError."""
    data = text_lines(read_whole(path, GROWTH), path.name, "a Movie.BYU file")
    text = _text_with_spaces(data, path.name)
    text.require(4, "header")
    parts, nodes, polygons, connectivity = _counts(text)
    first_node = 4 + 2 * parts
    first_corner = first_node + 3 * nodes
    end = first_corner + connectivity
    text.require(first_node, "part ranges")
    text.require(first_corner, "coordinates")
    text.require(end, "connectivity")
    names, part_numbers = _parts(text, parts, polygons, path.stem)
    coordinates = text.coordinates(first_node, 3 * nodes).reshape(-1, 3)
    corners, corner_counts = _corners(text, first_corner, connectivity, polygons, nodes)
    left = len(text) - end
    skipped = (f"skipped words after the connectivity: {left:,}",) if left else ()
    table = RawPolygons(coordinates, corners, corner_counts, part_numbers, names)
    return repaired(table, path.name, placement, skipped=skipped)


def _text_with_spaces(data: bytes, place: str) -> NumberText:
    """The text with spaces between numbers that touch."""
    first = data.lstrip(b"\n").split(b"\n", 1)[0].rstrip()
    text = NumberText(TOUCHING.sub(b" ", data), place)
    width = len(first) // 4
    in_columns = len(first) % 4 == 0 and width in WIDTHS
    if not in_columns or _is_enough(text, len(first.split())):
        return text
    # Numbers that fill their columns touch without a sign between them.
    whole, decimal = (re.compile(rb"[^\n]{%d}" % each) for each in (width, COORDINATE_WIDTH))
    lines = []
    for line in data.split(b"\n"):
        if b"." not in line:
            line = whole.sub(rb"\g<0> ", line)
        elif len(line) % COORDINATE_WIDTH == 0:
            line = decimal.sub(rb"\g<0> ", line)
        lines.append(TOUCHING.sub(b" ", line))
    return NumberText(b"\n".join(lines), place)


def _is_enough(text: NumberText, in_first_line: int) -> bool:
    """Whether a text has as many numbers as its header says."""
    if in_first_line < 4 or len(text) < 4:
        return False
    parts, nodes, _, connectivity = text.wholes(0, 4, "a count").tolist()
    return len(text) >= int(4 + 2 * parts + 3 * nodes + connectivity)


def _counts(text: NumberText) -> tuple[int, int, int, int]:
    """The four counts of the header. Raises InputError if a count is too small or too large."""
    parts, nodes, polygons, connectivity = text.wholes(0, 4, "a count in the header").tolist()
    for at, (count, least) in enumerate(((parts, 0), (nodes, 1), (polygons, 1), (connectivity, 1))):
        if count < least:
            raise text.wrong(at, f"a count in the header must be at least {least}")
    if polygons > connectivity:
        raise text.wrong(2, f"the polygons must be at most as many as their corners, {connectivity:,}")
    return parts, nodes, polygons, connectivity


def _parts(text: NumberText, parts: int, polygons: int, stem: str) -> tuple[tuple[str, ...], Indices]:
    """The names of the parts, and the part number of each polygon. Raises InputError."""
    ranges = text.wholes(4, 2 * parts, "a part range").reshape(-1, 2)
    wrong = np.flatnonzero((ranges[:, 0] < 1) | (ranges[:, 1] > polygons) | (ranges[:, 0] > ranges[:, 1]))
    if len(wrong):
        part = int(wrong[0])
        first, last = ranges[part].tolist()
        raise InputError(
            f"{text.place}, line {text.line(4 + 2 * part)}: part {part + 1} must have polygons of 1 to"
            f" {polygons:,}, in order, not {first} to {last}; correct its range"
        )
    # A polygon in several ranges belongs to the last part.
    part_numbers = np.full(polygons, parts, np.intp)
    if (ranges[:, 1] - ranges[:, 0] + 1).sum() > MOST_OVERLAP * polygons:
        raise InputError(
            f"{text.place}: the ranges of {parts:,} parts must overlap less; give each polygon one part"
        )
    for part, (first, last) in enumerate(ranges.tolist()):
        part_numbers[first - 1 : last] = part
    names = [f"part {part + 1}" for part in range(parts)]
    if (part_numbers == parts).any():
        names.append(stem if stem not in names else f"{stem} rest")
    return tuple(names), part_numbers


def _corners(text: NumberText, first: int, count: int, polygons: int, nodes: int) -> tuple[Indices, Numbers]:
    """The rows of the corners, and their count in each polygon. Raises InputError."""
    numbers = text.wholes(first, count, "a corner")
    sizes = np.abs(numbers)
    wrong = np.flatnonzero((sizes < 1) | (sizes > nodes))
    if len(wrong):
        raise text.wrong(
            first + int(wrong[0]), f"a corner must be a node number of 1 to {nodes:,}, or minus one"
        )
    ends = np.flatnonzero(numbers < 0)
    if numbers[-1] > 0:
        raise text.wrong(first + count - 1, "the last corner of the last polygon must be negative")
    if len(ends) != polygons:
        raise InputError(
            f"{text.place}: there must be {polygons:,} polygons, as the header says, not {len(ends):,}, each"
            " ended by a negative corner; correct the header or the connectivity"
        )
    return (sizes - 1).astype(np.intp), np.diff(ends, prepend=-1)
