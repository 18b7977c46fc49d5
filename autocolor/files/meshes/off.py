"""Reading a mesh from an OFF file in text.

    OFF
    nodes polygons edges
    x y z ...               each node on a line, with its normal (NOFF) and color (COFF)
    4 0 1 2 3 ...           each polygon: its number of corners, its nodes from 0, and its color

The first word may be OFF, COFF, NOFF, CNOFF or one of these with ST before it, or be left out; the counts may
follow it on its line, even without a space. Comments begin with `#`. Colors are left out. Files of four
coordinates or in binary are refused. trimesh is not used: it splits all quads.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import Indices
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import GROWTH, NumberText
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.reading import read_whole, shown, text_lines

KEYWORD: Final = re.compile(rb"\s*+([A-Za-z0-9]*?OFF)(?![A-Za-z_])")
KNOWN: Final = re.compile(rb"(ST)?(C)?(N)?OFF")
COMMENT: Final = re.compile(rb"#[^\n]*")


def begins_as_off(head: bytes) -> bool:
    """Whether a file begins with the keyword of an OFF file."""
    keyword = KEYWORD.match(head)
    return keyword is not None and KNOWN.fullmatch(keyword[1]) is not None


def read_off(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of an OFF file, and what was repaired. Raises InputError."""
    data = text_lines(read_whole(path, GROWTH), path.name, "an OFF file")
    if b"#" in data:
        data = COMMENT.sub(b"", data)
    keyword = KEYWORD.match(data)
    word = b"OFF" if keyword is None else keyword[1]
    known = KNOWN.fullmatch(word)
    if known is None:
        raise InputError(
            f"{path.name}: an OFF file must begin OFF, COFF, NOFF or STOFF, not {shown(word)}; write it with"
            " three coordinates, as text"
        )
    if keyword is not None:
        # Spaces keep the places of the other words.
        data = b" " * keyword.end(1) + data[keyword.end(1) :]
    text = NumberText(data, path.name)
    text.require(3, "header")
    nodes, polygons = text.wholes(0, 2, "a count in the header").tolist()
    lines = text.lines()
    lines = np.append(lines[lines > 2], len(text))
    if nodes < 1 or polygons < 1 or nodes + polygons >= len(lines):
        raise InputError(
            f"{path.name}: the header must count the lines of nodes and polygons, 1 or more, not {nodes:,}"
            f" and {polygons:,} of {len(lines) - 1:,} lines; export it again"
        )
    begins, end = lines[:nodes], int(lines[nodes])
    widths = np.diff(begins, append=end)
    size = 6 if known[3] else 3
    if widths.min() < size:
        raise text.wrong(int(begins[widths.argmin()]), f"the line of a node must have {size} numbers")
    table = text.vectors(begins, end, size)
    width = size + 2 * (known[1] is not None)
    skipped = ["left out the colors of nodes"] if (widths > width).any() else []
    begins, end = lines[nodes : nodes + polygons], int(lines[nodes + polygons])
    corners, counts = _polygons(text, begins, end, nodes)
    if len(corners) + polygons < end - int(begins[0]):
        skipped.append("left out the colors of polygons")
    if left := len(text) - end:
        skipped.append(f"skipped words that are neither nodes nor polygons: {left:,}")
    raw = RawPolygons(
        table[:, :3],
        corners,
        counts,
        np.zeros(polygons, np.intp),
        (path.stem,),
        normals=table[:, 3:] if known[3] else None,
        corner_normals=corners if known[3] else None,
    )
    return repaired(raw, path.name, placement, skipped=tuple(skipped))


def _polygons(text: NumberText, begins: Indices, end: int, nodes: int) -> tuple[Indices, Indices]:
    """The corners of the polygons that begin at some words, and the count of each. Raises InputError."""
    first = int(begins[0])
    numbers = text.values(first, end - first)
    starts = begins - first
    sizes = numbers[starts]
    is_count = (sizes >= 0) & (sizes < np.diff(begins, append=end)) & (np.floor(sizes) == sizes)
    if not is_count.all():
        rule = "a polygon must begin with the number of the corners on its line"
        raise text.wrong(int(begins[is_count.argmin()]), rule)
    counts = sizes.astype(np.intp)
    # Corners follow the count of their polygon; a color may follow them.
    steps = np.zeros(len(numbers) + 1, np.int8)
    steps[starts + 1] = 1
    steps[starts + 1 + counts] -= 1
    is_corner = np.cumsum(steps[:-1], dtype=np.int8) > 0
    corners = numbers[is_corner]
    is_node = (corners >= 0) & (corners < nodes) & (np.floor(corners) == corners)
    if not is_node.all():
        at = first + int(np.flatnonzero(is_corner)[is_node.argmin()])
        raise text.wrong(at, f"a corner must be a node number from 0 to {nodes - 1:,}")
    return corners.astype(np.intp), counts
