"""Legacy VTK grids of nodes in rows: STRUCTURED_GRID, RECTILINEAR_GRID and STRUCTURED_POINTS.

One layer of them is a surface of quads, the first of which turns from the first axis to the second.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.vtk.cells import Cells
from autocolor.files.meshes.vtk.cursor import VtkCursor
from autocolor.files.reading import shown
from autocolor.files.repair.cells import Flats

LAYERS: Final = (b"STRUCTURED_GRID", b"RECTILINEAR_GRID", b"STRUCTURED_POINTS")

AXES: Final = (b"X_COORDINATES", b"Y_COORDINATES", b"Z_COORDINATES")
MOST_NODES: Final = 4_000_000
"""Assumed: nodes of one layer. Where only its axes are written, a small file has many."""

VECTORS: Final = (b"ORIGIN", b"SPACING", b"ASPECT_RATIO")


def read_layer(cursor: VtkCursor, dataset: bytes) -> tuple[Floats, Cells]:
    """The nodes and the quads of a grid of one layer. Raises InputError."""
    dimensions: tuple[int, ...] | None = None
    points: Floats | None = None
    axes: dict[bytes, Floats] = {}
    vectors: dict[bytes, Floats] = {}
    while (keyword := cursor.peek()) and keyword not in (b"POINT_DATA", b"CELL_DATA"):
        words = cursor.words()
        if keyword == b"METADATA":
            cursor.skip_metadata()
        elif keyword == b"DIMENSIONS":
            dimensions = _dimensions(cursor, words, dataset)
        elif keyword in VECTORS and len(words) == 4:
            vectors[keyword] = _vector(cursor, words)
        elif keyword in AXES and len(words) == 3:
            what = keyword.decode()
            count = cursor.count(words[1], f"the count of {what}")
            axes[keyword] = cursor.coordinates(count, words[2], what)
        elif keyword == b"POINTS" and len(words) == 3:
            count = cursor.count(words[1], "the count of POINTS")
            points = cursor.coordinates(3 * count, words[2], "POINTS").reshape(-1, 3)
        else:
            raise InputError(
                f"{cursor.where}: there must be no {shown(b' '.join(words))} in {dataset.decode()}; correct"
                " the file"
            )
    if dimensions is None:
        raise InputError(f"{cursor.name}: a {dataset.decode()} must have DIMENSIONS, not none; add them")
    nodes = int(np.prod(dimensions, dtype=object))
    most = min(len(cursor.data), MOST_NODES)
    if nodes > most:
        raise InputError(
            f"{cursor.name}: a {dataset.decode()} must have at most as many nodes as the file has bytes, and"
            f" {MOST_NODES:,}, not {nodes:,}; take fewer"
        )
    if points is None:
        points = _points(cursor, dataset, dimensions, axes, vectors)
        if not (np.abs(points) <= LARGEST_COORDINATE).all():
            raise InputError(
                f"{cursor.name}: coordinates must be at most 1e30 in size; correct ORIGIN and SPACING"
            )
    if len(points) != nodes:
        raise InputError(
            f"{cursor.name}: a {dataset.decode()} must have the {nodes:,} nodes of its DIMENSIONS, not"
            f" {len(points):,}; correct them"
        )
    wide, high = (size for size in (*(each for each in dimensions if each > 1), 1, 1)[:2])
    first = (np.arange(wide - 1) + wide * np.arange(high - 1)[:, None]).ravel()
    table: Indices = first[:, None] + np.array([0, 1, wide + 1, wide])
    return points, Cells([Flats.of(table, np.arange(len(table)))], count=len(table))


def _dimensions(cursor: VtkCursor, words: list[bytes], dataset: bytes) -> tuple[int, ...]:
    """The three numbers of nodes along the axes, of which one at least is 1. Raises InputError."""
    sizes = tuple(cursor.count(word, "a number of DIMENSIONS") for word in words[1:])
    if len(sizes) != 3 or 0 in sizes or 1 not in sizes:
        raise InputError(
            f"{cursor.where}: a {dataset.decode()} must be one layer of nodes, as in DIMENSIONS 5 4 1, not"
            f" {shown(b' '.join(words))}; take its surface"
        )
    return sizes


def _vector(cursor: VtkCursor, words: list[bytes]) -> Floats:
    """The three numbers after a keyword. Raises InputError."""
    text = VtkCursor(b" ".join(words[1:]), cursor.where)
    text.as_text()
    return text.coordinates(3, b"double", words[0].decode("latin-1").upper())


def _points(
    cursor: VtkCursor,
    dataset: bytes,
    dimensions: tuple[int, ...],
    axes: dict[bytes, Floats],
    vectors: dict[bytes, Floats],
) -> Floats:
    """The nodes of a grid with straight axes. Raises InputError."""
    if dataset == b"STRUCTURED_POINTS":
        origin = vectors.get(b"ORIGIN", np.zeros(3))
        spacing = vectors.get(b"SPACING", vectors.get(b"ASPECT_RATIO", np.ones(3)))
        with np.errstate(over="ignore"):
            places = [
                start + step * np.arange(size)
                for start, step, size in zip(origin, spacing, dimensions, strict=True)
            ]
    else:
        places = [axes.get(axis, np.empty(0)) for axis in AXES]
        if dataset != b"RECTILINEAR_GRID" or tuple(map(len, places)) != dimensions:
            what = "POINTS" if dataset == b"STRUCTURED_GRID" else "coordinates of each of its DIMENSIONS"
            raise InputError(f"{cursor.name}: a {dataset.decode()} must have {what}; add them")
    z, y, x = np.meshgrid(*reversed(places), indexing="ij")
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
