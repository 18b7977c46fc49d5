"""The normals of a file at the corners of a mesh, made fit for rendering.

- A normal of any length becomes a unit vector. Where the file has none, or one that is zero or not finite, it
  is computed.
- The renderer takes the side of a polygon that its corners run around counterclockwise for its front, and a
  normal for the front's. Files mix windings, and their normals point outward all the same. So the normals of
  a polygon that together point to its back are turned over: a surface with two sides then looks as its author
  saw it. A single normal that points to the back stays, as at the rim of a thin sheet that is smooth.
- Equal normals at one place are one normal, so that the mesh is as smooth there as it looks.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Singles, chunks, dot, underflowing
from autocolor.files.meshes.welding import welded
from autocolor.immutable import read_only
from autocolor.scene.geometry.normals import NodeNormals, places_of_corners, polygon_normals

NEARLY_UNIT: Final = 1e-6
"""Assumed: a length so near to 1 is rounding; such a normal stays as it is, to be read back equal."""

SHORTEST: Final = 1e-150
"""The squares of shorter vectors have lost digits; they count as zero."""

POLYGONS_AT_ONCE: Final = 1 << 13


@underflowing
def file_normals(
    coordinates: Floats, node_numbers: Indices, vectors: Floats, rows: Indices
) -> tuple[NodeNormals | None, list[str]]:
    """The normals of a mesh, and messages about what is computed or turned over; None if all are computed.

    `vectors`, (normals, 3), are the file's, in the axes of the mesh; `rows`, (polygons, 4), has the row of
    the normal at each corner, or any other number if it is missing. Where normals are missing, the numbers of
    the result are -1.
    """
    unit, is_sound = _units(vectors)
    rows = np.ascontiguousarray(rows.T)
    rows[(rows < 0) | (rows >= len(unit))] = -1
    # The last row stands for a missing normal.
    rows[~np.append(is_sound, False)[rows]] = -1
    sentences, is_quad = list[str](), node_numbers[:, 2] != node_numbers[:, 3]
    if missing := int((rows[:3] < 0).sum() + ((rows[3] < 0) & is_quad).sum()):
        sentences.append(f"computed the normals of corners that have none: {missing:,}")
    if (rows < 0).all():
        return None, sentences
    is_turned = _point_back(coordinates, node_numbers, unit, rows)
    if count := int(is_turned.sum()):
        sentences.append(f"turned over the normals of polygons that wind the other way: {count:,}")
        rows = np.where(is_turned & (rows >= 0), rows + len(unit), rows)
        unit = np.concatenate([unit, 0 - unit])
    return _without_copies(coordinates, node_numbers, unit, rows), sentences


def _units(vectors: Floats) -> tuple[Singles, Booleans]:
    """The vectors, (n, 3), as unit vectors of float32, and which of them are finite and not zero."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        sizes = np.sqrt((vectors**2).sum(axis=1, keepdims=True))
        unit = np.where(np.abs(sizes - 1) < NEARLY_UNIT, vectors, vectors / sizes)
    is_sound = np.isfinite(sizes[:, 0]) & (sizes[:, 0] > SHORTEST)
    unit[~is_sound] = 0.0
    # Adding 0 turns -0 into 0.
    return unit.astype(np.float32) + np.float32(0), is_sound


def _point_back(coordinates: Floats, node_numbers: Indices, unit: Singles, rows: Indices) -> Booleans:
    """Whether the normals of each polygon together point to its back."""
    is_turned, vectors = list[Booleans](), np.append(unit, np.zeros((1, 3), np.float32), axis=0).T
    for chunk in chunks(len(node_numbers), POLYGONS_AT_ONCE):
        planes = polygon_normals(np.take(coordinates.T, node_numbers[chunk].T, axis=1))
        is_turned.append(dot(planes, np.take(vectors, rows[:, chunk], axis=1).sum(axis=1)) < 0)
    return np.concatenate(is_turned)


def _without_copies(coordinates: Floats, node_numbers: Indices, unit: Singles, rows: Indices) -> NodeNormals:
    """The normals in which equal vectors at one place are one row, and rows of different places differ."""
    different, row_of = welded(unit)
    places = places_of_corners(np.ascontiguousarray(coordinates.T), np.ascontiguousarray(node_numbers.T))
    is_own = rows >= 0
    keys, numbers = np.unique(places[is_own] * len(different) + row_of[rows[is_own]], return_inverse=True)
    own = np.full(rows.shape, -1)
    own[is_own] = numbers.ravel()
    vectors = np.ascontiguousarray(different[keys % len(different)].T)
    return NodeNormals(read_only(vectors.T), read_only(own.T))
