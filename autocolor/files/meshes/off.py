"""Reading a mesh from an OFF file in text.

    OFF
    nodes polygons edges
    x y z ...               each node on a line; its normal and color are skipped
    4 0 1 2 3 ...           each polygon: its number of corners, its nodes from 0; colors are skipped

The first word may be OFF, COFF, NOFF, CNOFF or one of these with ST before it, or be left out. Comments begin
with `#`. Files of four coordinates or in binary are refused. trimesh is not used: it
splits all quads.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import GROWTH, NumberText
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.reading import read_whole, shown, text_lines
from autocolor.scene.geometry.polygon_split import MOST_CORNERS

KEYWORD: Final = re.compile(rb"\s*([A-Za-z0-9]*OFF)\b")
KNOWN: Final = re.compile(rb"(ST)?C?N?OFF")
COMMENT: Final = re.compile(rb"#[^\n]*")


def read_off(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of an OFF file, and what was repaired. Raises InputError."""
    data = text_lines(read_whole(path, GROWTH), path.name, "an OFF file")
    if b"#" in data:
        data = COMMENT.sub(b"", data)
    keyword = KEYWORD.match(data)
    if keyword is not None:
        if not KNOWN.fullmatch(keyword[1]):
            raise InputError(
                f"{path.name}: an OFF file must begin OFF, COFF, NOFF or STOFF, not {shown(keyword[1])};"
                " write it with three coordinates, as text"
            )
        # Spaces keep the places of the other words.
        data = b" " * keyword.end(1) + data[keyword.end(1) :]
    text = NumberText(data, path.name)
    text.require(3, "header")
    nodes, polygons = text.wholes(0, 2, "a count in the header").tolist()
    for at, count in enumerate((nodes, polygons)):
        if not 1 <= count <= len(text):
            raise text.wrong(at, f"a count must be from 1 to {len(text):,}, the count of words in the file")
    lines, _ = text.lines()
    coordinates, first = _coordinates(text, lines, nodes)
    corners, counts, begins, end = _polygons(text, lines, first, polygons, nodes)
    left = len(text) - end
    table = RawPolygons(
        coordinates,
        corners,
        counts,
        np.zeros(polygons, np.intp),
        (path.stem,),
        place_of=lambda row: f"line {text.line(begins[row])}",
    )
    skipped = (f"skipped words that are neither nodes nor polygons: {left:,}",) if left else ()
    return repaired(table, path.name, placement, skipped=skipped)


def _coordinates(text: NumberText, lines: Indices, nodes: int) -> tuple[Floats, int]:
    """The coordinates, (nodes, 3), and the first word after them. Raises InputError."""
    first = int(lines[lines > 2][0]) if (lines > 2).any() else len(text)
    text.require(first + 3 * nodes, "nodes")
    rows = np.append(lines[lines >= first], len(text))[: nodes + 1]
    width = int(rows[1] - rows[0])
    if width <= 3 or not np.array_equal(rows, first + width * np.arange(nodes + 1)):
        return text.coordinates(first, 3 * nodes).reshape(-1, 3), first + 3 * nodes
    end = first + nodes * width
    # Each node has equally many further words: convert whole lines.
    table = text.values(first, nodes * width).reshape(nodes, width)
    for at in range(3):
        wrong = np.flatnonzero(~(np.abs(table[:, at]) <= LARGEST_COORDINATE))
        if len(wrong):
            text.coordinates(first + int(wrong[0]) * width + at, 1)
    return np.ascontiguousarray(table[:, :3]), end


def _polygons(
    text: NumberText, lines: Indices, first: int, polygons: int, nodes: int
) -> tuple[Indices, Indices, Indices, int]:
    """The corners, their number in each polygon, its first word, and the word after the last polygon.

    Raises InputError.
    """
    # Each polygon begins a line, so words after its corners may be anything.
    lines = np.concatenate([[first], lines[lines > first]])
    if first >= len(text) or len(lines) < polygons:
        raise InputError(
            f"{text.place}: there must be {polygons:,} lines of polygons, as the header says, not"
            f" {len(lines) if first < len(text) else 0:,}; correct the header or the polygons"
        )
    begins = lines[:polygons]
    limits = np.append(lines, len(text))[1 : polygons + 1]
    counts = np.empty(polygons, np.intp)
    corners = []
    for begin in range(0, polygons, 1 << 16):
        rows = slice(begin, min(begin + (1 << 16), polygons))
        at, end = int(begins[rows][0]), int(limits[rows][-1])
        numbers = text.values(at, end - at)
        starts = begins[rows] - at
        sizes = numbers[starts]
        wrong = np.flatnonzero(
            ~((sizes >= 0) & (sizes <= limits[rows] - begins[rows] - 1) & (np.floor(sizes) == sizes))
        )
        if len(wrong):
            raise text.wrong(
                at + int(starts[wrong[0]]), "a polygon must begin with the number of the corners on its line"
            )
        if sizes.max() > MOST_CORNERS:
            raise text.wrong(
                at + int(starts[sizes.argmax()]), f"a polygon must have at most {MOST_CORNERS:,} corners"
            )
        counts[rows] = sizes
        owner = np.repeat(np.arange(len(sizes)), limits[rows] - begins[rows])
        place = np.arange(end - at) - starts[owner]
        chosen = np.flatnonzero((place >= 1) & (place <= sizes[owner]))
        of_corners = numbers[chosen]
        is_node = (of_corners >= 0) & (of_corners < nodes) & (np.floor(of_corners) == of_corners)
        wrong = np.flatnonzero(~is_node)
        if len(wrong):
            raise text.wrong(
                at + int(chosen[wrong[0]]), f"a corner must be a node number from 0 to {nodes - 1:,}"
            )
        corners.append(of_corners.astype(np.intp))
    return np.concatenate(corners), counts, begins, int(limits[-1])


def begins_as_off(head: bytes) -> bool:
    """Whether a file begins with the keyword of an OFF file."""
    keyword = KEYWORD.match(head)
    return keyword is not None and KNOWN.fullmatch(keyword[1]) is not None
