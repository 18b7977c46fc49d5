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
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import GROWTH, NumberText
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.reading import read_whole, shown, text_lines

KEYWORD: Final = re.compile(rb"\s*+([A-Za-z0-9]*?OFF)(?![A-Za-z_])")
KNOWN: Final = re.compile(rb"(ST)?(C)?(N)?OFF")
COMMENT: Final = re.compile(rb"#[^\n]*")

POLYGONS_AT_ONCE: Final = 1 << 16


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
    for at, count in enumerate((nodes, polygons)):
        if not 1 <= count <= len(text):
            raise text.wrong(at, f"a count must be from 1 to {len(text):,}, the count of words in the file")
    lines = text.lines()
    lines = lines[lines > 2]
    has_normals = known[3] is not None
    # What a node has beside its color.
    width = 3 + 3 * has_normals + 2 * (known[1] is not None)
    table = _nodes(text, lines, nodes, polygons, width, has_normals=has_normals)
    corners, counts, begins, end, are_colored = _polygons(text, lines, table.end, polygons, nodes)
    skipped = [
        f"left out the colors of {what}"
        for what, are_there in (("nodes", table.are_colored), ("polygons", are_colored))
        if are_there
    ]
    if left := len(text) - end:
        skipped.append(f"skipped words that are neither nodes nor polygons: {left:,}")
    raw = RawPolygons(
        table.coordinates,
        corners,
        counts,
        np.zeros(polygons, np.intp),
        (path.stem,),
        place_of=lambda row: f"line {text.line(begins[row])}",
        normals=table.normals,
        corner_normals=None if table.normals is None else corners,
    )
    return repaired(raw, path.name, placement, skipped=tuple(skipped))


class Nodes(NamedTuple):
    """The coordinates, (nodes, 3), and normals, if any; the word after them, and whether there are colors."""

    coordinates: Floats
    normals: Floats | None
    end: int
    are_colored: bool


def _nodes(
    text: NumberText, lines: Indices, nodes: int, polygons: int, width: int, *, has_normals: bool
) -> Nodes:
    """The nodes, whose lines begin at the first of some words. Raises InputError.

    `width` is the number of words of a node without a color. If the file has too few lines for each node to
    have its own, the nodes follow each other, wherever lines end.
    """
    first = int(lines[0]) if len(lines) else len(text)
    text.require(first + 3 * nodes, "nodes")
    rows = np.append(lines, len(text))[: nodes + 1]
    begins, widths = rows[:-1], np.diff(rows)
    if len(lines) < nodes + polygons or widths.min() < 3:
        text.require(first + width * nodes, "nodes")
        begins, widths = first + width * np.arange(nodes), np.full(nodes, width)
    end = int(begins[-1] + widths[-1])
    normals = None
    if has_normals:
        normals = np.full((nodes, 3), np.nan)
        has_normal = widths >= 6
        if has_normal.any():
            normals[has_normal] = text.vectors_at(begins[has_normal] + 3, end)
    return Nodes(text.coordinates_at(begins, end), normals, end, bool((widths > width).any()))


def _polygons(
    text: NumberText, lines: Indices, first: int, polygons: int, nodes: int
) -> tuple[Indices, Indices, Indices, int, bool]:
    """The corners, their number in each polygon, its first word, the word after the last polygon.

    The last value is whether words follow the corners of a polygon. Raises InputError.
    """
    lines = np.concatenate([[first], lines[lines > first]])
    if first >= len(text) or len(lines) < polygons:
        raise InputError(
            f"{text.place}: there must be {polygons:,} lines of polygons, as the header says, not"
            f" {len(lines) if first < len(text) else 0:,}; correct the header or the polygons"
        )
    begins = lines[:polygons]
    widths = np.diff(np.append(lines, len(text))[: polygons + 1])
    counts = np.empty(polygons, np.intp)
    corners = []
    for row in range(0, polygons, POLYGONS_AT_ONCE):
        rows = slice(row, row + POLYGONS_AT_ONCE)
        at, end = int(begins[rows][0]), int(begins[rows][-1] + widths[rows][-1])
        numbers = text.values(at, end - at)
        starts = begins[rows] - at
        sizes = numbers[starts]
        wrong = np.flatnonzero(~((sizes >= 0) & (sizes < widths[rows]) & (np.floor(sizes) == sizes)))
        if len(wrong):
            rule = "a polygon must begin with the number of the corners on its line"
            raise text.wrong(at + int(starts[wrong[0]]), rule)
        counts[rows] = sizes
        place = np.arange(end - at) - np.repeat(starts, widths[rows])
        chosen = np.flatnonzero((place >= 1) & (place <= np.repeat(sizes, widths[rows])))
        of_corners = numbers[chosen]
        is_node = (of_corners >= 0) & (of_corners < nodes) & (np.floor(of_corners) == of_corners)
        wrong = np.flatnonzero(~is_node)
        if len(wrong):
            rule = f"a corner must be a node number from 0 to {nodes - 1:,}"
            raise text.wrong(at + int(chosen[wrong[0]]), rule)
        corners.append(of_corners.astype(np.intp))
    end = int(begins[-1] + widths[-1])
    return np.concatenate(corners), counts, begins, end, bool((widths > counts + 1).any())


def begins_as_off(head: bytes) -> bool:
    """Whether a file begins with the keyword of an OFF file."""
    keyword = KEYWORD.match(head)
    return keyword is not None and KNOWN.fullmatch(keyword[1]) is not None
