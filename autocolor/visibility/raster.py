"""Nodes on the raster: where the perspective puts them, and which lines and pixel centers they are before."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices, chunks

ROUNDING: Final = 1e-6
"""In pixels, far above the rounding of a crossing."""

NODES_AT_ONCE: Final = 1 << 14


class Raster(NamedTuple):
    """The lines and elements of a raster, and its focal length in pixels."""

    lines: int
    elements: int
    focal_length: float


class OnRaster(NamedTuple):
    """Where nodes lie on a raster, each (nodes,): as in `projection.Projection`."""

    x: Floats
    y: Floats
    inverse_depth: Floats
    first_line: Indices


def on_raster(positions: Floats, near: float, raster: Raster) -> OnRaster:
    """Where nodes lie on the raster; those nearer than the near plane are put on it.

    `positions`, (3, nodes), are in camera space.
    """
    count = positions.shape[1]
    x, y, inverse_depth = np.empty(count), np.empty(count), np.empty(count)
    first_line = np.empty(count, np.intp)
    for chunk in chunks(count, NODES_AT_ONCE):
        right, down, depth = positions[:, chunk]
        np.divide(1.0, np.maximum(depth, near), out=inverse_depth[chunk])
        scale = raster.focal_length * inverse_depth[chunk]
        np.add(right * scale, raster.elements / 2, out=x[chunk])
        np.add(down * scale, raster.lines / 2, out=y[chunk])
        first_line[chunk] = np.clip(np.ceil(y[chunk] - 0.5), 0, raster.lines)
    return OnRaster(x, y, inverse_depth, first_line)


def left_center(x: Floats) -> Floats:
    """The first element whose center may be at x or right of it, if a crossing is rounded to the left."""
    return np.ceil(x - (0.5 + ROUNDING))


def right_center(x: Floats) -> Floats:
    """The first element whose center is right of x, if a crossing is rounded to the right."""
    return np.ceil(x - (0.5 - ROUNDING))
