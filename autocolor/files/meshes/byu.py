"""Reading a mesh from a Movie.BYU geometry file.

    parts nodes polygons connectivity       four counts
    first last ...                          the polygons of each part, numbered from 1
    x y z ...                               the coordinates of each node
    node node -node ...                     the corners of each polygon; the last is negative

Numbers are separated by white space or, in columns of Fortran, by the sign of the second. A part is named by
its number, as in "part 1"; a polygon in no range belongs to a part named after the file, and one in several
ranges to the last. Exponents may be written with D. Displacements and scalars are in files of their own,
which are not read.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import Indices
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import GROWTH, NumberText
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, different, repaired
from autocolor.files.reading import read_whole, text_lines

TOUCHING: Final = re.compile(rb"(?<=[0-9.])(?=[+-])")
"""Where a number with a sign begins right after another; the sign of an exponent follows a letter."""


def read_byu(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a Movie.BYU file, and what was repaired. Raises InputError."""
    data = text_lines(read_whole(path, GROWTH), path.name, "a Movie.BYU file")
    text = NumberText(TOUCHING.sub(b" ", data), path.name)
    text.require(4, "header")
    parts, nodes, polygons, connectivity = counts = text.wholes(0, 4, "a count in the header").tolist()
    for at, (count, least) in enumerate(zip(counts, (0, 1, 1, 1), strict=True)):
        if count < least:
            raise text.wrong(at, f"a count in the header must be at least {least}")
    first_node = 4 + 2 * parts
    first_corner = first_node + 3 * nodes
    end = first_corner + connectivity
    text.require(end, "connectivity")
    coordinates = text.vectors(first_node + 3 * np.arange(nodes), first_corner)

    # Corners.
    numbers = text.wholes(first_corner, connectivity, "a corner")
    corners = np.abs(numbers) - 1
    wrong = np.flatnonzero((corners < 0) | (corners >= nodes))
    if len(wrong):
        rule = f"a corner must be a node number of 1 to {nodes:,}, or minus one"
        raise text.wrong(first_corner + int(wrong[0]), rule)
    ends = np.flatnonzero(numbers < 0)
    if len(ends) != polygons or numbers[-1] > 0:
        raise InputError(
            f"{path.name}: there must be {polygons:,} polygons, as the header says, not {len(ends):,}, each"
            " ended by a negative corner; correct the header or the connectivity"
        )

    names, part_numbers = _parts(text, parts, polygons, path.stem)
    left = len(text) - end
    skipped = (f"skipped words after the connectivity: {left:,}",) if left else ()
    raw = RawPolygons(coordinates, corners.astype(np.intp), np.diff(ends, prepend=-1), part_numbers, names)
    return repaired(raw, path.name, placement, skipped=skipped)


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
    # Each polygon of a range takes time.
    if (count := int((ranges[:, 1] - ranges[:, 0] + 1).sum())) > 2 * polygons:
        raise InputError(
            f"{text.place}: the ranges of {parts:,} parts must overlap less: they have {count:,} polygons,"
            f" and the file {polygons:,}; give each polygon one part"
        )
    part_numbers = np.full(polygons, parts, np.intp)
    for part, (first, last) in enumerate(ranges.tolist()):
        part_numbers[first - 1 : last] = part
    names = [f"part {part + 1}" for part in range(parts)]
    if (part_numbers == parts).any():
        names.append(stem)
    return different(names), part_numbers
