"""Reading a mesh from a Movie.BYU geometry file.

    parts nodes polygons connectivity       four counts
    first last ...                          the polygons of each part, numbered from 1
    x y z ...                               the coordinates of each node
    node node -node ...                     the corners of each polygon; the last is negative

Numbers are separated by white space or, in columns of Fortran, by the sign of the second. A part is named by
its number, as in "part 1"; a polygon in no range belongs to a part named after the file. Exponents may be
written with D. Displacements and scalars are in files of their own, which are not read.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np

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
    parts, nodes, polygons, connectivity = header = text.wholes(0, 4, "a count in the header").tolist()
    if parts < 0 or min(header[1:]) < 1:
        raise text.wrong(0, "the header must count parts from 0, and nodes, polygons and corners from 1")
    first_node = 4 + 2 * parts
    first_corner = first_node + 3 * nodes
    end = first_corner + connectivity
    text.require(end, "connectivity")
    coordinates = text.vectors(first_node + 3 * np.arange(nodes), first_corner)

    # Corners.
    numbers = text.wholes(first_corner, connectivity, "a corner")
    corners = np.abs(numbers) - 1
    is_node = (corners >= 0) & (corners < nodes)
    if not is_node.all():
        rule = f"a corner must be a node number of 1 to {nodes:,}, or minus one"
        raise text.wrong(first_corner + int(is_node.argmin()), rule)
    ends = np.flatnonzero(numbers < 0)
    if len(ends) != polygons or numbers[-1] > 0:
        raise InputError(
            f"{path.name}: there must be {polygons:,} polygons, each ended by a negative corner, not"
            f" {len(ends):,}; correct the header or the corners"
        )

    # Parts.
    ranges = text.wholes(4, 2 * parts, "a part range").reshape(-1, 2)
    first, last = ranges.T
    is_wrong = (first < 1) | (last > polygons) | (first > last) | (np.cumsum(last - first + 1) > polygons)
    if is_wrong.any():
        part = int(is_wrong.argmax())
        rule = f"part {part + 1} must have polygons of 1 to {polygons:,}, in order, which no other part has"
        raise text.wrong(4 + 2 * part, rule)
    part_numbers = np.full(polygons, parts, np.intp)
    for part, (begin, end_of_part) in enumerate(ranges.tolist()):
        part_numbers[begin - 1 : end_of_part] = part
    names = [f"part {part + 1}" for part in range(parts)]
    if (part_numbers == parts).any():
        names.append(path.stem)
    left = len(text) - end
    skipped = (f"skipped words after the connectivity: {left:,}",) if left else ()
    counts = np.diff(ends, prepend=-1)
    raw = RawPolygons(coordinates, corners.astype(np.intp), counts, part_numbers, different(names))
    return repaired(raw, path.name, placement, skipped=skipped)
