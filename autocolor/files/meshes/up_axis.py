"""Whether a mesh that was read with z up seems to lie on its side, and y is up.

Many programs write y up, and few formats say which axis is up. Three clues compare y with z:

- symmetry: most objects are equal on their left and right, few on their top and bottom. The up axis is not an
  axis along which the object equals its mirror image.
- rest: an object rests on a broad bottom, or on feet that stand apart, and seldom on its front or side. Its
  top is seldom as broad: half of the top is subtracted.
- ground: a modeler puts an object on the ground, whose coordinate is 0.

The prior of the format is the fourth clue. A clue is positive for y and negative for z. Without clues, as for
a sphere or a machine part, the prior alone hints at nothing.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats
from autocolor.scene.mesh import Mesh

Y: Final = 1
Z: Final = 2

SYMMETRY: Final = 0.6
REST: Final = 0.8
GROUND: Final = 0.3
"""Assumed: the weights of the clues, which are from -1 to 1, the ground's -1, 0 or 1."""

LEAST_SUM: Final = 0.25
"""Assumed: the weighted sum from which a mesh is said to lie. Measured with the 104 meshes that it was chosen
by, read as OBJ: it finds 41 of 48 that lie, and hints at 1 of 56 that stand; off the ground, 37 and 3."""

LEAST_POLYGONS: Final = 8
"""Assumed: the polygons of a mesh from which its shape is a clue."""

MOST_POLYGONS: Final = 5_000
"""Assumed: the polygons that are looked at, taken at equal distances from the table."""

CELLS: Final = 20
"""Assumed: cells along the longest side of the object's box, in which symmetry is compared."""

SLAB: Final = 0.03
"""Assumed: the part of an extent that counts as the bottom or as the top."""

NEAR_GROUND: Final = 0.01
"""Assumed: the distance from 0 of an object on the ground, as a part of its longest extent."""


def seems_to_lie(mesh: Mesh, prior: float = 0.0) -> bool:
    """Whether a mesh that was read with z up seems to have y up.

    `prior` is the clue of the format, positive if its files often have y up.
    """
    numbers = mesh.node_numbers
    if len(numbers) < LEAST_POLYGONS:
        return False
    step = -(-len(numbers) // MOST_POLYGONS)
    points = mesh.coordinates[numbers[::step].ravel()]
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    # A mesh has area, so its size is positive. Unit size keeps squares in range.
    points = (points - (low + high) / 2) / size
    symmetry, rest, ground = _symmetries(points), _rests(points), np.abs(low) < NEAR_GROUND * size
    clues = SYMMETRY * (symmetry[Z] - symmetry[Y])
    stands = [low - high / 2 for low, high in rest]
    clues += REST * (max(stands[Y] - max(rest[Z]), 0.0) - max(stands[Z] - max(rest[Y]), 0.0))
    if not ground[0]:
        # With a corner at the origin, 0 is no ground.
        clues += GROUND * (float(ground[Y]) - float(ground[Z]))
    return bool(clues + prior > LEAST_SUM)


def _symmetries(points: Floats) -> list[float]:
    """How equal the points of a centered object of unit size are to their mirror image along each axis.

    It is the number of cells that are full in both, over the number of cells that are full in either.
    """
    is_full = np.zeros((CELLS + 1,) * 3, np.bool_)
    # Rounding, unlike cutting, puts mirrored points into mirrored cells.
    is_full[tuple((np.rint(points * CELLS) + CELLS // 2).astype(np.intp).T)] = True
    mirrored = [np.flip(is_full, axis) for axis in range(3)]
    return [float((is_full & other).sum() / (is_full | other).sum()) for other in mirrored]


def _rests(points: Floats) -> list[tuple[float, float]]:
    """How broadly a centered object rests on the low and the high end of each axis, from 0 to 1.

    It is the box around the slab at the end, as a part of the object's box across the axis. Narrow sides of
    the object count less, by the root of their area.
    """
    extents = np.ptp(points, axis=0)
    faces = np.array([np.delete(extents, axis).prod() for axis in range(3)])
    rests = []
    for axis in range(3):
        reach = (0.5 - SLAB) * extents[axis]
        low, high = (
            np.ptp(np.delete(points[is_in], axis, axis=1), axis=0).prod()
            for is_in in (points[:, axis] <= -reach, points[:, axis] >= reach)
        )
        scale = np.sqrt(faces[axis] * faces.max())
        rests.append((float(low / scale), float(high / scale)) if scale > 0 else (0.0, 0.0))
    return rests
