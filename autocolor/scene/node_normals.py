"""Node normals: one unit vector for each smooth fan of polygons around a node.

Paper: "The Lighting Model" interpolates the normal between node normals; how they are made is not said.
Assumed: the mean of the normals of the adjoining polygons, each weighted by its angle at the node, so that
it does not depend on how a flat side was cut into polygons. A normal is not shared across parts, nor across
an edge where the polygons meet at more than the crease angle. Nodes at the same place count as one, so that
a file that repeats its nodes is as smooth as one that shares them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Numbers, chunks, cross, lengths
from autocolor.scene.fans import fans_of_corners, places_of_corners
from autocolor.scene.union_find import group_numbers, join

CREASE_ANGLE: Final = 40.0
"""Assumed: degrees; edges of boxes stay sharp, and a cylinder of ten sides or more is smooth."""

POLYGONS_AT_ONCE: Final = 1 << 13
"""So many that their corners stay near the processor."""


@dataclass(frozen=True, eq=False)
class NodeNormals:
    """`vectors` is (normals, 3) float64, unit; `numbers` is (polygons, 4) intp: the row for each corner.

    In memory both lie column by column, as the renderer takes them.
    """

    vectors: Floats
    numbers: Numbers


def node_normals(
    coordinates: Floats, node_numbers: Numbers, part_numbers: Numbers, crease_angle: float = CREASE_ANGLE
) -> NodeNormals:
    """The normals at the corners of the polygons; a polygon without area adds nothing to any."""
    rows, columns = np.ascontiguousarray(coordinates.T), np.ascontiguousarray(node_numbers.T)
    normals, angles = _normals_and_angles(rows, columns)
    fans, against = fans_of_corners(places_of_corners(rows, columns), part_numbers, normals, crease_angle)

    # Add up the normals of each fan, weighted by the angles.
    vectors, numbers = _weighted_sums(fans, normals, angles)
    if against:
        vectors, together = _with_other_sides(vectors, against)
        numbers = together[numbers]

    # Give a fan whose normals cancel the normal of one of its polygons.
    sizes = lengths(vectors)
    lost = np.flatnonzero(sizes < 1e-9)
    if len(lost):
        polygon_of_fan = np.zeros(vectors.shape[1], np.intp)
        # Row by row: `maximum.at` of numpy 2.4 reads beyond values that it has to repeat.
        for row in numbers:
            np.maximum.at(polygon_of_fan, row, np.arange(len(row)))
        vectors[:, lost] = normals[:, polygon_of_fan[lost]]
        vectors[2, lost[~vectors[:, lost].any(axis=0)]] = 1.0
        sizes[lost] = 1.0
    vectors /= sizes
    return NodeNormals(vectors.T, numbers.T)


def _normals_and_angles(rows: Floats, columns: Numbers) -> tuple[Floats, Floats]:
    """The normals of the polygons, (3, polygons), and the angles at their corners, (4, polygons)."""
    normals, angles = np.empty((3, columns.shape[1])), np.empty(columns.shape)
    for some in chunks(columns.shape[1], POLYGONS_AT_ONCE):
        corners = np.take(rows, columns[:, some], axis=1)
        normals[:, some] = polygon_normals(corners)
        angles[:, some] = _corner_angles(corners)
    return normals, angles


def _weighted_sums(fans: Numbers, normals: Floats, angles: Floats) -> tuple[Floats, Numbers]:
    """The sums of the weighted normals of each fan, (3, fans), and the fan of each corner, (4, polygons)."""
    sums = np.zeros((3, int(fans.max(initial=-1)) + 1))
    numbers = np.empty(angles.shape, np.intp)
    for some in chunks(angles.shape[1], POLYGONS_AT_ONCE):
        fan = fans[4 * some.start : 4 * some.stop]
        numbers[:, some] = fan.reshape(-1, 4).T
        for sum_row, normal_row in zip(sums, normals, strict=True):
            np.add.at(sum_row, fan, (angles[:, some] * normal_row[some]).T.ravel())
    return sums, numbers


def _with_other_sides(sums: Floats, against: list[Numbers]) -> tuple[Floats, Numbers]:
    """The sums of fans, (3, fans), with those of the fans that are wound against them, and each fan's column.

    Every fan stands twice, once for each of its sides; what is wound against each other joins crosswise. So
    a normal is never added to its own opposite.
    """
    count = sums.shape[1]
    sides = np.arange(2 * count)
    for one, other in against:
        join(sides, np.concatenate([one, one + count]), np.concatenate([other + count, other]))
    # The groups in which a fan shows its own side come first.
    groups = group_numbers(sides)
    used = int(groups[:count].max()) + 1
    both = np.concatenate([sums, -sums], axis=1)
    return np.stack([np.bincount(groups, row)[:used] for row in both]), groups[:count]


def polygon_normals(corners: Floats) -> Floats:
    """Unit normals, (3, polygons), of corners (3, 4, polygons); zero for a polygon without area.

    The cross product of the diagonals serves warped quads too, and triangles that repeat a node.
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
    """The angle of the polygon at each corner in radians, (4, polygons); a repeated corner has it once."""
    onward = np.roll(corners, -1, axis=1) - corners
    inward = np.roll(onward, 1, axis=1)
    # A triangle repeats its last node.
    triangle = ~onward[:, 2].any(axis=0)
    onward[:, 2, triangle] = onward[:, 3, triangle]
    size = np.maximum(np.abs(onward).max(axis=0), np.abs(inward).max(axis=0))
    size[size == 0] = 1.0
    onward /= size
    inward /= size
    # Subtract from 0: a negated 0 would make of an edge without length an angle of 180 degrees.
    angles: Floats = np.arctan2(lengths(cross(inward, onward)), 0.0 - (inward * onward).sum(axis=0))
    angles[3, triangle] = 0.0
    return angles
