"""Converting the polygons of a file to a mesh of triangles and quads, with a message for each repair.

- A corner that repeats the previous one is removed: a quad becomes a triangle.
- A polygon with fewer than three corners left, or without area, is dropped.
- A polygon with more than four corners is split into quads and triangles.
- Warped, concave and crossed quads (bow-ties) are kept, since the renderer fills them scan line by scan line;
  `quad_shapes.py` counts them. Unused nodes are kept.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, cross, lengths
from autocolor.errors import InputError
from autocolor.files.repair.placement import PLAIN, Placement, placed
from autocolor.files.repair.polygons import MeshReport, Polygons
from autocolor.immutable import read_only
from autocolor.scene.geometry.node_normals import CREASE_ANGLE
from autocolor.scene.geometry.polygon_split import split_polygons
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON, MeshScalar

AT_A_TIME: Final = 1 << 14
"""Polygons to check at once, so that the arrays fit in the processor cache."""

FLAT: Final = 1e-12
"""Assumed: a triangle has no area if twice its area is below this fraction of the squared polygon size."""


def repaired(
    polygons: Polygons,
    place: str,
    placement: Placement = PLAIN,
    *,
    skipped: tuple[str, ...] = (),
) -> MeshReport:
    """The mesh of the polygons, with messages about what was repaired.

    `place` is the file's name in messages; `skipped` are messages to put before those of the repairs. Raises
    InputError if no polygon is left.
    """
    coordinates = placed(polygons.coordinates, placement)
    repairs = list(skipped)
    corners, counts, shortened = _without_repeats(polygons.corners, polygons.corner_counts)
    too_few = counts < 3
    try:
        node_numbers, owners = split_polygons(coordinates, corners, counts)
    except InputError as error:
        raise InputError(f"{place}: {error}") from None

    # Drop pieces without area, and so the polygons of which no piece is left.
    has_area = np.concatenate(
        [
            _have_area(coordinates[node_numbers[first : first + AT_A_TIME]])
            for first in range(0, max(len(node_numbers), 1), AT_A_TIME)
        ]
    )
    if not has_area.all():
        node_numbers, owners = node_numbers[has_area], owners[has_area]
    is_kept = np.zeros(len(counts), np.bool_)
    is_kept[owners] = True
    kinds = (
        (shortened & ~too_few & is_kept, "{} with repeated corners {} repaired"),
        (too_few, "{} with fewer than three different corners {} dropped"),
        (~too_few & ~is_kept, "{} without area {} dropped"),
        ((counts > 4) & is_kept, "{} with more than four corners {} split"),
    )
    for repaired_polygons, sentence in kinds:
        if count := int(repaired_polygons.sum()):
            polygon, was = ("polygon", "was") if count == 1 else ("polygons", "were")
            repairs.append(sentence.format(f"{count:,} {polygon}", was))
    if not len(node_numbers):
        raise InputError(f"{place}: a mesh must have a polygon with area, not none; add polygons")
    # A piece of a polygon has the scalars of the whole.
    scalars = tuple(
        each if each.of == NODE else MeshScalar(each.name, read_only(each.values[owners]), POLYGON)
        for each in polygons.scalars
    )
    mesh = Mesh(
        coordinates,
        node_numbers,
        polygons.part_numbers[owners],
        polygons.part_names,
        CREASE_ANGLE if placement.crease_angle is None else placement.crease_angle,
        scalars,
    )
    return MeshReport(mesh, tuple(f"{place}: {repair}" for repair in repairs))


def _without_repeats(corners: Indices, counts: Indices) -> tuple[Indices, Indices, Booleans]:
    """The corners and counts without corners that equal the next one, and which polygons had such corners."""
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


def _have_area(corners: Floats) -> Booleans:
    """Whether each polygon of (n, 4, 3) has area: neither diagonal splits it into two flat triangles.

    A bow-tie whose halves cancel has area; a polygon that runs forth and back along one path has none.
    """
    rows = np.ascontiguousarray(corners.T)
    size = np.ptp(rows, axis=1).max(axis=0)
    size[size == 0] = 1.0
    scaled = (rows - rows[:, :1]) / size

    def flat(first: int, second: int, third: int) -> Booleans:
        one, other = scaled[:, second] - scaled[:, first], scaled[:, third] - scaled[:, first]
        is_flat: Booleans = lengths(cross(one, other)) < FLAT
        return is_flat

    return ~((flat(0, 1, 2) & flat(0, 2, 3)) | (flat(0, 1, 3) & flat(1, 2, 3)))
