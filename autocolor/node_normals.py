"""Node normals: one unit vector for each smooth fan of polygons around a node.

Paper: "The Lighting Model" interpolates the normal between node normals; how they are made is not said.
Assumed: the mean of the normals of the adjoining polygons, each weighted by its angle at the node, so that
it does not depend on how a flat side was cut into polygons. A normal is not shared across parts, nor across
an edge where the polygons meet at more than the crease angle. Nodes at the same place count as one, so that
a file that repeats its nodes is as smooth as one that shares them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

CREASE_ANGLE = 40.0
"""Assumed: degrees; edges of boxes stay sharp, and a cylinder of ten sides or more is smooth."""


@dataclass(frozen=True, eq=False)
class NodeNormals:
    """`vectors` is (normals, 3) float64, unit; `numbers` is (polygons, 4) intp: the row for each corner."""

    vectors: npt.NDArray[np.float64]
    numbers: npt.NDArray[np.intp]


def node_normals(
    coordinates: npt.NDArray[np.float64],
    node_numbers: npt.NDArray[np.intp],
    part_numbers: npt.NDArray[np.intp],
    crease_angle: float = CREASE_ANGLE,
) -> NodeNormals:
    """The normals at the corners of the polygons; a polygon without area adds nothing to any."""
    polygon_count = len(node_numbers)
    corner_count = 4 * polygon_count
    corners = coordinates[node_numbers]
    normals = polygon_normals(corners)

    # Join corners around a node, across the edges that are no crease.
    places = _places(coordinates)[node_numbers]
    first, second, opposed = _joined_corners(places, part_numbers, normals, crease_angle)

    # Let every corner stand twice, once for each side of its polygon: polygons that were wound against
    # each other join crosswise, and a fan never adds a normal to its own opposite.
    if opposed.any():
        first, second = (
            np.concatenate([first, first + corner_count]),
            np.concatenate([second + opposed * corner_count, second + ~opposed * corner_count]),
        )
        fans = _least_joined(2 * corner_count, first, second)
    else:
        fans = _least_joined(corner_count, first, second)

    # Add up each fan's normals, weighted by the angles.
    weighted = (_corner_angles(corners)[..., None] * normals[:, None, :]).reshape(corner_count, 3)
    if len(fans) > corner_count:
        weighted = np.concatenate([weighted, -weighted])
    fan_of_corner = fans[:corner_count]
    used, numbers = np.unique(fan_of_corner, return_inverse=True)
    sums = np.stack([np.bincount(fans, weighted[:, axis], minlength=len(fans)) for axis in range(3)], axis=1)
    vectors = sums[used]

    # Give a fan whose normals cancel the normal of one of its polygons.
    lengths = np.linalg.norm(vectors, axis=1)
    lost = np.flatnonzero(lengths < 1e-9)
    if len(lost):
        polygon_of_fan = np.zeros(len(used), np.intp)
        polygon_of_fan[numbers] = np.arange(corner_count) // 4
        vectors[lost] = normals[polygon_of_fan[lost]]
        vectors[lost[~vectors[lost].any(axis=1)]] = (0.0, 0.0, 1.0)
        lengths = np.linalg.norm(vectors, axis=1)
    return NodeNormals(vectors / lengths[:, None], numbers.reshape(polygon_count, 4).astype(np.intp))


def polygon_normals(corners: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Unit normals, (polygons, 3), of corners (polygons, 4, 3); zero for a polygon without area.

    The cross product of the diagonals serves warped quads too, and triangles that repeat a node.
    """
    size = np.ptp(corners, axis=1).max(axis=1)
    size[size == 0] = 1.0
    scaled = (corners - corners[:, :1]) / size[:, None, None]
    normals = np.cross(scaled[:, 2] - scaled[:, 0], scaled[:, 3] - scaled[:, 1])
    lengths = np.linalg.norm(normals, axis=1)
    flat = lengths < 1e-12
    lengths[flat] = 1.0
    normals[flat] = 0.0
    unit: npt.NDArray[np.float64] = normals / lengths[:, None]
    return unit


def _corner_angles(corners: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The angle of the polygon at each corner in radians, (polygons, 4); a repeated corner has it once."""
    triangle = (corners[:, 2] == corners[:, 3]).all(axis=1)
    following = np.roll(corners, -1, axis=1)
    following[triangle, 2] = corners[triangle, 0]
    previous = np.roll(corners, 1, axis=1)
    previous[triangle, 0] = corners[triangle, 2]
    onward, back = following - corners, previous - corners
    size = np.maximum(np.abs(onward).max(axis=2), np.abs(back).max(axis=2))[..., None]
    size[size == 0] = 1.0
    onward, back = onward / size, back / size
    sine = np.linalg.norm(np.cross(onward, back), axis=2)
    cosine = (onward * back).sum(axis=2)
    angles: npt.NDArray[np.float64] = np.arctan2(sine, cosine)
    angles[triangle, 3] = 0.0
    return angles


def _places(coordinates: npt.NDArray[np.float64]) -> npt.NDArray[np.intp]:
    """A number for each node, the same for nodes at the same place."""
    if not len(coordinates):
        return np.empty(0, np.intp)
    order = np.lexsort(coordinates.T)
    moved = (np.diff(coordinates[order], axis=0) != 0).any(axis=1)
    places = np.empty(len(coordinates), np.intp)
    places[order] = np.concatenate([[0], np.cumsum(moved)])
    return places


def _joined_corners(
    places: npt.NDArray[np.intp],
    part_numbers: npt.NDArray[np.intp],
    normals: npt.NDArray[np.float64],
    crease_angle: float,
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], npt.NDArray[np.bool_]]:
    """Pairs of corners to share a normal, and whether the two polygons are wound against each other.

    Corner 4 p + c is corner c of polygon p.
    """
    polygon_count = len(places)
    start, end = places.ravel(), np.roll(places, -1, axis=1).ravel()
    corner = np.arange(4 * polygon_count)
    onward = np.roll(corner.reshape(-1, 4), -1, axis=1).ravel()

    # Sort the edges so that the polygons of a part along the same edge stand next to each other.
    real = start != end
    corner, onward, start, end = corner[real], onward[real], start[real], end[real]
    low, high = np.minimum(start, end), np.maximum(start, end)
    part = part_numbers[corner // 4]
    order = np.lexsort((part, high, low))
    same = (
        (low[order][1:] == low[order][:-1])
        & (high[order][1:] == high[order][:-1])
        & (part[order][1:] == part[order][:-1])
    )
    one, other = order[:-1][same], order[1:][same]

    # Leave creases sharp; where the edge runs the same way in both, one polygon shows its other side.
    opposed = start[one] == start[other]
    cosine = (normals[corner[one] // 4] * normals[corner[other] // 4]).sum(axis=1)
    cosine[opposed] *= -1
    smooth = cosine >= np.cos(np.radians(crease_angle)) - 1e-9
    one, other, opposed = one[smooth], other[smooth], opposed[smooth]

    # Join the corners at both ends of the edge.
    other_start = np.where(opposed, corner[other], onward[other])
    other_end = np.where(opposed, onward[other], corner[other])
    # Where a triangle repeats its last node, its corner 2 stands for corner 3 as well.
    first = np.concatenate([corner[one], onward[one]])
    second = np.concatenate([other_start, other_end])
    repeated = np.flatnonzero(places[:, 2] == places[:, 3]) * 4
    return (
        np.concatenate([first, repeated + 2]),
        np.concatenate([second, repeated + 3]),
        np.concatenate([opposed, opposed, np.zeros(len(repeated), np.bool_)]),
    )


def _least_joined(
    count: int, first: npt.NDArray[np.intp], second: npt.NDArray[np.intp]
) -> npt.NDArray[np.intp]:
    """For each of `count` things the least number that it is joined to, directly or through others."""
    least = np.arange(count)
    while True:
        # Pass the least number across every join, then follow it to the least number of that one.
        lower = np.minimum(least[first], least[second])
        following = least.copy()
        np.minimum.at(following, least[first], lower)
        np.minimum.at(following, least[second], lower)
        np.minimum.at(following, first, lower)
        np.minimum.at(following, second, lower)
        following = following[following]
        if (following == least).all():
            return least
        least = following
