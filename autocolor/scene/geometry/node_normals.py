"""Node normals: one unit vector for each smooth fan of polygons around a node.

Paper: "The Lighting Model" interpolates the normal between node normals; how they are made is not said.
Assumed: the mean of the normals of the adjoining polygons, each weighted by its angle at the node, so that
it does not depend on how a flat side was divided into polygons. A normal is not shared across parts, nor
across an edge where the polygons meet at more than the crease angle. Nodes at the same place count as one, so
that a file that repeats its nodes is as smooth as one that shares them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, Scratch, Singles, chunks, cross, lengths
from autocolor.immutable import Immutable, read_only
from autocolor.scene.geometry.fans import fans_of_corners, places_of_corners
from autocolor.scene.geometry.union_find import group_numbers, unite

CREASE_ANGLE: Final = 40.0
"""Assumed: degrees; edges of boxes stay sharp, and a cylinder of ten sides or more is smooth."""

POLYGONS_AT_ONCE: Final = 1 << 13
"""Few enough for their corners to stay in the processor's cache."""


@dataclass(frozen=True, eq=False, repr=False)
class NodeNormals(Immutable):
    """Unit normals, and which of them is at each corner of a polygon.

    `vectors` is (normals, 3) float32, `numbers` (polygons, 4) intp: rows of `vectors`. Both are stored by
    columns, so that `.T` is the contiguous array that the renderer works on.
    """

    vectors: Singles
    numbers: Indices


def node_normals(
    coordinates: Floats,
    node_numbers: Indices,
    part_numbers: Indices,
    crease_angle: float = CREASE_ANGLE,
    scratch: Scratch = np.empty,
) -> NodeNormals:
    """The normals at the corners of the polygons; a polygon without area adds nothing to any.

    `scratch` gives the arrays to work in, and those of the result: for a large mesh files may back them.
    """
    coordinate_rows, node_rows = np.ascontiguousarray(coordinates.T), np.ascontiguousarray(node_numbers.T)
    normals, angles = _normals_and_angles(coordinate_rows, node_rows, scratch)
    places = places_of_corners(coordinate_rows, node_rows, scratch)
    fans, opposite = fans_of_corners(places, part_numbers, normals, crease_angle, scratch)
    del places

    # Sum the normals of each fan, weighted by the angles.
    vectors, numbers = _weighted_sums(fans, normals, angles, scratch)
    del angles, fans
    if opposite:
        vectors, united = _united_with_opposite(vectors, opposite)
        for chunk in chunks(numbers.shape[1], POLYGONS_AT_ONCE):
            numbers[:, chunk] = united[numbers[:, chunk]]

    # Give a fan whose normals cancel out the normal of one of its polygons.
    sizes = scratch(vectors.shape[1:], np.float64)
    for chunk in chunks(len(sizes), POLYGONS_AT_ONCE):
        sizes[chunk] = lengths(vectors[:, chunk])
    canceled = np.flatnonzero(sizes < 1e-9)
    if len(canceled):
        polygon_of_fan = np.zeros(vectors.shape[1], np.intp)
        # Row by row: `maximum.at` of numpy 2.4 reads past the end of values that it broadcasts.
        for row in numbers:
            np.maximum.at(polygon_of_fan, row, np.arange(len(row)))
        vectors[:, canceled] = normals[:, polygon_of_fan[canceled]]
        vectors[2, canceled[~vectors[:, canceled].any(axis=0)]] = 1.0
        sizes[canceled] = 1.0
    singles: Singles = scratch(vectors.shape, np.float32)
    for chunk in chunks(len(sizes), POLYGONS_AT_ONCE):
        singles[:, chunk] = vectors[:, chunk] / sizes[chunk]
    return NodeNormals(read_only(singles.T), read_only(numbers.T))


def _normals_and_angles(
    coordinate_rows: Floats, node_rows: Indices, scratch: Scratch
) -> tuple[Floats, Floats]:
    """The normals of the polygons, (3, polygons), and the angles at their corners, (4, polygons)."""
    count = node_rows.shape[1]
    normals, angles = scratch((3, count), np.float64), scratch((4, count), np.float64)
    for chunk in chunks(count, POLYGONS_AT_ONCE):
        corners = np.take(coordinate_rows, node_rows[:, chunk], axis=1)
        normals[:, chunk] = polygon_normals(corners)
        angles[:, chunk] = _corner_angles(corners)
    return normals, angles


def _weighted_sums(
    fans: Indices, normals: Floats, angles: Floats, scratch: Scratch
) -> tuple[Floats, Indices]:
    """The sums of the weighted normals of each fan, (3, fans), and the fan of each corner, (4, polygons)."""
    sums = scratch((3, int(fans.max(initial=-1)) + 1), np.float64)
    sums[:] = 0.0
    numbers: Indices = scratch(angles.shape, np.intp)
    for chunk in chunks(angles.shape[1], POLYGONS_AT_ONCE):
        fan = fans[4 * chunk.start : 4 * chunk.stop]
        numbers[:, chunk] = fan.reshape(-1, 4).T
        for sum_row, normal_row in zip(sums, normals, strict=True):
            np.add.at(sum_row, fan, (angles[:, chunk] * normal_row[chunk]).T.ravel())
    return sums, numbers


def _united_with_opposite(sums: Floats, opposite: list[Indices]) -> tuple[Floats, Indices]:
    """The sums of fans, (3, fans), united with the fans of opposite winding next to them; each fan's column.

    Every fan has two sides, numbered `fan` and `fan + count`. The front of one is united with the back of a
    fan of opposite winding, so that a normal is never added to its own reverse.
    """
    count = sums.shape[1]
    sides = np.arange(2 * count)
    for one, other in opposite:
        unite(sides, np.concatenate([one, one + count]), np.concatenate([other + count, other]))
    # Groups are numbered by their lowest side, so those with the front of a fan come first.
    groups = group_numbers(sides)
    used = int(groups[:count].max()) + 1
    both = np.concatenate([sums, -sums], axis=1)
    return np.stack([np.bincount(groups, row)[:used] for row in both]), groups[:count]


def polygon_normals(corners: Floats) -> Floats:
    """Unit normals, (3, polygons), of corners (3, 4, polygons); zero for a polygon without area.

    The cross product of the diagonals also suits warped quads, and triangles that repeat a node.
    """
    size = np.ptp(corners, axis=1).max(axis=0)
    size[size == 0] = 1.0
    scaled = (corners[:, 1:] - corners[:, :1]) / size
    normals = cross(scaled[:, 1], scaled[:, 2] - scaled[:, 0])
    sizes = lengths(normals)
    flat = sizes < 1e-12
    sizes[flat] = 1.0
    normals[:, flat] = 0.0
    normals /= sizes
    return normals


def _corner_angles(corners: Floats) -> Floats:
    """The angle in radians at each corner, (4, polygons); 0 at the repeated corner of a triangle."""
    outgoing = np.roll(corners, -1, axis=1) - corners
    incoming = np.roll(outgoing, 1, axis=1)
    # A triangle repeats its last node.
    triangle = ~outgoing[:, 2].any(axis=0)
    outgoing[:, 2, triangle] = outgoing[:, 3, triangle]
    size = np.maximum(np.abs(outgoing).max(axis=0), np.abs(incoming).max(axis=0))
    size[size == 0] = 1.0
    outgoing /= size
    incoming /= size
    # Subtract from 0: -0.0 would give an edge without length an angle of 180 degrees.
    angles: Floats = np.arctan2(lengths(cross(incoming, outgoing)), 0.0 - (incoming * outgoing).sum(axis=0))
    angles[3, triangle] = 0.0
    return angles
