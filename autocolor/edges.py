"""Edges of polygons, cut by the lines of the raster.

An edge is known by its number in the flat corners of a projection: edge c * polygons + p runs from corner c
of polygon p to the next. It is always followed from its top to its bottom, whichever way the polygon runs,
so that polygons which share an edge are cut at the very same places and leave no crack.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from autocolor.projection import Projection

Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges and how to step them from line to line; every array is (edges,).

    An edge crosses the `count` lines from `first_line`; `across` (pixels) and `inverse_depth` are its values
    at the center of the first, and the steps what each further line adds. `top` and `bottom` are numbers of
    its ends in the flat corners of the projection.
    """

    top: Numbers
    bottom: Numbers
    first_line: Numbers
    count: Numbers
    across: Floats
    across_step: Floats
    inverse_depth: Floats
    inverse_depth_step: Floats


def edges(projected: Projection, numbers: Numbers) -> Edges:
    """The numbered edges; each must cross a line."""
    corners = projected.corners.ravel()
    following = (numbers + projected.corners.shape[1]) % len(corners)
    downward = projected.first_line[corners[numbers]] < projected.first_line[corners[following]]
    top, bottom = np.where(downward, numbers, following), np.where(downward, following, numbers)
    a, b = corners[top], corners[bottom]
    first_line = projected.first_line[a]
    height = projected.down[b] - projected.down[a]
    below_top = first_line + 0.5 - projected.down[a]
    across_step = (projected.across[b] - projected.across[a]) / height
    inverse_depth_step = (projected.inverse_depth[b] - projected.inverse_depth[a]) / height
    return Edges(
        top,
        bottom,
        first_line,
        projected.first_line[b] - first_line,
        projected.across[a] + below_top * across_step,
        across_step,
        projected.inverse_depth[a] + below_top * inverse_depth_step,
        inverse_depth_step,
    )
