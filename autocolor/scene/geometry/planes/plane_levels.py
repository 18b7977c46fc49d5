"""Levels: patches of polygons that lie in one plane within a tolerance, but at a distance that is real.

Corners that were rounded are scattered to both sides of their plane. A patch all of whose corners are on one
side, by more than they are scattered, lies in front of the others or behind them and has a plane of its own.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices
from autocolor.scene.geometry.planes.coordinate_rounding import EXACT, Rounding
from autocolor.scene.geometry.planes.plane_cells import Facets, part_of
from autocolor.scene.geometry.planes.plane_fits import fitted, renumbered

MOST_LEVELS: Final = 8
"""How many levels of a plane are found at most; what is left is one more."""

PASSES: Final = 3
"""How often a plane is fitted to a level: to its largest patch, and then to all that are near it."""

FACTOR: Final = 4.0
"""Assumed: the distance of a patch is real if it is so many times its scatter and a corner's rounding."""

UNKNOWN: Final = 32.0
"""Assumed: so many times its scatter, if it isn't known how corners are rounded; measured: with 4, in some of
the planes of a few triangles that were rounded and then moved a decal was apart."""


def levels(found: Facets, groups: Indices, patches: Indices, rounding: Rounding, middle: Floats) -> Indices:
    """The level of each polygon in its group, 0 for that of the largest patch.

    `groups` are sorted; `patches` are numbers of patches, none in two groups. `rounding` is that of the
    coordinates of `found` plus `middle`, (3,).
    """
    result = np.full(len(groups), MOST_LEVELS, np.intp)
    left = np.arange(len(groups))
    for level in range(MOST_LEVELS):
        if not len(left):
            break
        near = _level(
            part_of(found, left),
            renumbered(groups[left]),
            np.unique(patches[left], return_inverse=True)[1],
            rounding,
            middle,
        )
        result[left[near]] = level
        left = left[~near]
    return result


def _level(found: Facets, groups: Indices, patches: Indices, rounding: Rounding, middle: Floats) -> Booleans:
    """Which polygons lie at the level of the largest patch of their group."""
    group = np.empty(int(patches.max()) + 1, np.intp)
    group[patches] = groups
    areas = np.bincount(patches, found.areas)
    order = np.lexsort((-areas, group))
    largest = order[np.diff(group[order], prepend=-1) != 0]
    near = np.zeros(len(group), np.bool_)
    near[largest] = True
    corners = np.bincount(patches) * 4.0
    for _ in range(PASSES):
        core = np.flatnonzero(near[patches])
        fits = fitted(found if len(core) == len(patches) else part_of(found, core), groups[core])
        off = fits.off(found.corners, groups)
        mean = np.bincount(patches, off.sum(axis=0)) / corners
        scatter = np.sqrt(np.bincount(patches, ((off - mean[patches]) ** 2).sum(axis=0)) / corners)
        square = np.bincount(groups[core], (off[:, core] ** 2).sum(axis=0))
        scattered = scatter + np.sqrt(square / np.bincount(groups[core]) / 4)[group]
        away = found.centers - fits.points[:, groups]
        reach = np.sqrt(np.bincount(patches, (away**2).sum(axis=0)) * 4 / corners)
        # The plane is as inexact as its corners, and more so beside it.
        beside = 1 + 2 * reach / np.where(fits.widths > 0, fits.widths, np.inf)[group]
        least = np.full(len(group), rounding.most)
        # Along an axis all corners of a plane are rounded alike.
        at = np.abs(fits.normals).argmax(axis=0)
        along = np.abs(fits.normals).sum(axis=0) < 1 + 1e-9
        distances = np.abs(fits.points[at, np.arange(len(at))] + middle[at])
        exact = EXACT * (1 + float(np.abs(middle).max()))
        alike = along[group] & (scattered <= exact)
        least[alike] = np.maximum(rounding.fraction * distances[group[alike]], exact)
        before = near
        near = np.abs(mean) <= (FACTOR if rounding.known else UNKNOWN) * scattered + FACTOR * least * beside
        near[largest] = True
        if (near == before).all():
            break
    return near[patches]
