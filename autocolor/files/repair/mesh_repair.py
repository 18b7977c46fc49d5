"""From the polygons of a file to a mesh of triangles and quads, with a sentence for every repair.

- A corner that repeats the one before it is left out: a quad becomes a triangle.
- A polygon with fewer than three corners left, or without area, is dropped.
- A polygon of more than four corners is split into quads and triangles.
- Quads that are warped, concave or crossed (bow-ties) are kept as they are, for the renderer goes through
  them scan line by scan line; `quad_shapes.py` counts them. Nodes that no polygon uses are kept.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Flags, Floats, Numbers, cross, lengths
from autocolor.errors import InputError
from autocolor.files.repair.polygon_split import split_polygons
from autocolor.files.repair.polygons import MeshReport, Polygons, upright
from autocolor.scene.mesh import Mesh
from autocolor.scene.node_normals import CREASE_ANGLE

AT_A_TIME: Final = 1 << 14
"""Polygons whose corners are looked at together, so that the arrays stay near the processor."""

FLAT: Final = 1e-12
"""Assumed: twice the area of a triangle over the square of the polygon's size, below which it has none."""


def repaired(
    polygons: Polygons,
    place: str,
    *,
    up: str = "z",
    crease_angle: float | None = None,
    skipped: tuple[str, ...] = (),
) -> MeshReport:
    """The mesh of the polygons; `place` is the file's name and `skipped` are sentences for the report.

    Raises InputError where no polygon is left.
    """
    coordinates = upright(polygons.coordinates, up)
    repairs = list(skipped)
    corners, counts, shortened = _without_repeats(polygons.corners, polygons.corner_counts)
    few = counts < 3
    try:
        node_numbers, owners = split_polygons(coordinates, corners, counts)
    except InputError as error:
        raise InputError(f"{place}: {error}") from None

    # Drop pieces without area; a polygon is dropped when no piece of it is left.
    wide = np.concatenate(
        [
            _have_area(coordinates[node_numbers[first : first + AT_A_TIME]])
            for first in range(0, max(len(node_numbers), 1), AT_A_TIME)
        ]
    )
    if not wide.all():
        node_numbers, owners = node_numbers[wide], owners[wide]
    left = np.zeros(len(counts), np.bool_)
    left[owners] = True
    noted = (
        (shortened & ~few & left, "{} with repeated corners {} repaired"),
        (few, "{} with fewer than three different corners {} dropped"),
        (~few & ~left, "{} without area {} dropped"),
        ((counts > 4) & left, "{} with more than four corners {} split"),
    )
    for which, sentence in noted:
        if count := int(which.sum()):
            polygon, was = ("polygon", "was") if count == 1 else ("polygons", "were")
            repairs.append(sentence.format(f"{count:,} {polygon}", was))
    if not len(node_numbers):
        raise InputError(f"{place}: a mesh must have a polygon with area, not none; add polygons")
    mesh = Mesh(
        coordinates,
        node_numbers,
        polygons.part_numbers[owners],
        polygons.part_names,
        CREASE_ANGLE if crease_angle is None else crease_angle,
    )
    return MeshReport(mesh, tuple(f"{place}: {repair}" for repair in repairs))


def _without_repeats(corners: Numbers, counts: Numbers) -> tuple[Numbers, Numbers, Flags]:
    """Corners and counts without a corner that equals the following one, and which polygons had such."""
    following = np.arange(1, len(corners) + 1)
    ends = np.cumsum(counts)
    filled = counts > 0
    following[ends[filled] - 1] = (ends - counts)[filled]
    kept = corners != corners[following]
    if kept.all():
        return corners, counts, np.zeros(len(counts), np.bool_)
    owners = np.repeat(np.arange(len(counts)), counts)
    kept_counts = np.bincount(owners[kept], minlength=len(counts))
    return corners[kept], kept_counts, kept_counts != counts


def _have_area(corners: Floats) -> Flags:
    """Whether polygons (n, 4, 3) cover any area: on neither diagonal are both triangles flat.

    A bow-tie whose halves cancel has area; a polygon that goes the same way there and back has none.
    """
    rows = np.ascontiguousarray(corners.T)
    size = np.ptp(rows, axis=1).max(axis=0)
    size[size == 0] = 1.0
    scaled = (rows - rows[:, :1]) / size

    def flat(first: int, second: int, third: int) -> Flags:
        onward, back = scaled[:, second] - scaled[:, first], scaled[:, third] - scaled[:, first]
        below: Flags = lengths(cross(onward, back)) < FLAT
        return below

    return ~((flat(0, 1, 2) & flat(0, 2, 3)) | (flat(0, 1, 3) & flat(1, 2, 3)))
