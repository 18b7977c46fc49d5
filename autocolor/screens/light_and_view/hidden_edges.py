"""Leaving out the edges that are hidden, by the depths of what is visible in a picture.

An edge of the object belongs to what is visible, or lies behind it: three points of it are compared with the
farthest that is visible at the pixels around them. Assumed: an edge is drawn as a whole or not at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Singles
from autocolor.immutable import Immutable, read_only
from autocolor.scene.defaults import framed
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.screens.light_and_view.orthographic_views import Side
from autocolor.visibility.camera_space import rotated
from autocolor.visibility.projection import focal_length
from autocolor.visibility.visible_points import POINT, VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces

FAR_FIELD: Final = 0.5
"""Assumed: degrees of view of an eye so far away that it sees the object as an orthographic view shows it."""

FINER: Final = 2
"""Assumed: pixels to an element of a view in the raster that tells what is visible there."""

DEPTH: Final = POINT.start + 2
"""The row of visible points that has their depth."""

TESTED: Final = (0.2, 0.5, 0.8)
"""Assumed: the points of an edge that are looked at, as fractions of it; two of them must be visible."""

BEHIND: Final = 4e-3
"""Assumed: how far behind what is visible a point still belongs to it, as a fraction of the object's radius.

Looked at on two cars: a fourth of it and four times as much draw nearly the same edges.
"""


@dataclass(frozen=True, eq=False, repr=False)
class VisibleDepths(Immutable):
    """The depths of what is visible in a picture: for each pixel, the farthest of the nine around it.

    `farthest` is (lines, elements) float32, relative to `middle` in camera space and in `unit`; it is
    infinite at and beside the background. A point that is `behind` by less counts as visible.
    """

    view: View
    unit: float
    middle: float
    behind: float
    farthest: Singles


def visible_depths(visible: VisiblePoints) -> VisibleDepths:
    """The depths of the visible points of a picture."""
    depths = np.full((visible.lines + 2, visible.elements + 2), np.inf, np.float32)
    inner = np.full(visible.lines * visible.elements, np.inf, np.float32)
    inner[visible.pixels] = visible.rows[DEPTH]
    depths[1:-1, 1:-1] = inner.reshape(visible.lines, visible.elements)
    across = np.maximum(np.maximum(depths[:, :-2], depths[:, 1:-1]), depths[:, 2:])
    farthest = np.maximum(np.maximum(across[:-2], across[1:-1]), across[2:])
    return VisibleDepths(
        visible.view,
        visible.unit,
        float(visible.middle[2]),
        BEHIND * visible.radius,
        read_only(farthest),
    )


def depths_toward(mesh: Mesh, side: Side, part_numbers: Sequence[int] | None = None) -> VisibleDepths | None:
    """The depths of what one of the three views shows; None if there is nothing.

    The object fills the picture of an eye far away. With `part_numbers`, only these parts are there, so that
    a stage hides nothing.
    """
    alone = mesh
    if part_numbers is not None:
        chosen = np.isin(mesh.part_numbers, list(part_numbers))
        if not chosen.all():
            alone = Mesh(
                mesh.coordinates, mesh.node_numbers[chosen], mesh.part_numbers[chosen], mesh.part_names
            )
    if not len(alone.node_numbers):
        return None
    width, height = FINER * side.area.width, FINER * side.area.height
    x, y, z = side.toward
    far = View(side.toward, direction=(-x, -y, -z), field_of_view=FAR_FIELD)
    view = framed(far, alone.used_coordinates, width / height)
    return visible_depths(visible_surfaces(alone, view, (1,) * len(mesh.part_names), height, width))


def without_hidden(edges: Indices, coordinates: Floats, depths: VisibleDepths) -> Indices:
    """Those of some edges, (n, 2) nodes, that are not hidden; `coordinates` is (nodes, 3)."""
    starts, ends = (np.take(coordinates.T, nodes, axis=1) for nodes in edges.T)
    visible = [_are_visible(starts + at * (ends - starts), depths) for at in TESTED]
    kept: Indices = edges[np.sum(visible, axis=0) >= 2]
    return kept


def _are_visible(points: Floats, depths: VisibleDepths) -> Booleans:
    """Whether points, (3, n), are visible; of one outside of the picture nothing is known, and it counts."""
    lines, elements = depths.farthest.shape
    x, y, depth = rotated(depths.view.axes / depths.unit, points, depths.view.eye)
    before = depth > 0
    scale = focal_length(lines, depths.view.field_of_view) / np.where(before, depth, 1.0)
    element, line = np.floor(x * scale + elements / 2), np.floor(y * scale + lines / 2)
    known = before & (element >= 0) & (element < elements) & (line >= 0) & (line < lines)
    visible = np.ones(len(depth), np.bool_)
    rows = np.flatnonzero(known)
    farthest = depths.farthest[line[rows].astype(np.intp), element[rows].astype(np.intp)]
    visible[rows] = depth[rows] - depths.middle <= farthest + depths.behind
    return visible
