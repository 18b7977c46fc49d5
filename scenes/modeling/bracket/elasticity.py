"""Linear elasticity: displacements and stresses of a solid of hexahedra.

The equations are solved by conjugate gradients, product by product of the hexahedra's own matrices.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from autocolor.arrays import Floats, Indices
from scenes.modeling.bracket.coarse import CoarseSpace
from scenes.modeling.bracket.elements import GAUSS, Material, elements_of, shape

TOLERANCE: Final = 1e-11
"""The size of what is left of the load, as a share of it, at which the displacements are taken."""

MOST_STEPS: Final = 5000
"""The solids here take some hundred."""


def displacements(
    nodes: Floats, corners: Indices, material: Material, load: Floats, is_held: npt.NDArray[np.bool_]
) -> Floats:
    """The displacements of the nodes under a load, all (n, 3): in millimeters and newtons.

    `is_held`, (n, 3), says which components are held at 0. Raises ArithmeticError if they can move freely.
    """
    matrices = np.concatenate([each.condensed for each in elements_of(nodes, corners, material)])
    of_element = (3 * corners[:, :, None] + np.arange(3)).reshape(len(corners), 24)
    is_free = ~is_held.reshape(-1)
    flat = of_element.reshape(-1)

    def force(moved: Floats) -> Floats:
        own = np.matmul(matrices, moved[of_element][:, :, None])
        return np.asarray(np.bincount(flat, own.reshape(-1), moved.size) * is_free, np.float64)

    diagonal = np.bincount(flat, np.diagonal(matrices, axis1=1, axis2=2).reshape(-1), nodes.size)
    coarse = CoarseSpace(nodes, corners, matrices, is_free.reshape(-1, 3))

    def preconditioned(left: Floats) -> Floats:
        return (left / diagonal + coarse.corrected(left)) * is_free

    # Conjugate gradients.
    moved, left = np.zeros(nodes.size), load.reshape(-1) * is_free
    enough = TOLERANCE**2 * _dot(left, left)
    ahead = preconditioned(left)
    step, size = ahead, _dot(left, ahead)
    for _ in range(MOST_STEPS):
        if _dot(left, left) <= enough:
            return moved.reshape(-1, 3)
        pull = force(step)
        length = size / _dot(step, pull)
        moved, left = moved + length * step, left - length * pull
        ahead = preconditioned(left)
        before, size = size, _dot(left, ahead)
        step = ahead + size / before * step
    raise ArithmeticError(f"no solution after {MOST_STEPS} steps: the solid must be held; hold more of it")


def _dot(one: Floats, other: Floats) -> float:
    """The dot product, summed in the same order whatever library numpy calls for `@`."""
    return float((one * other).sum())


def node_stresses(nodes: Floats, corners: Indices, material: Material, moved: Floats) -> Floats:
    """The stresses at the nodes in MPa, (n, 6): xx, yy, zz, xy, yz, zx.

    Those at the Gauss points are extended to the corners of each hexahedron, and the mean of all at a node is
    taken, weighted by volume.
    """
    extended = np.linalg.inv(shape(GAUSS))
    sums, weights = np.zeros((len(nodes), 6)), np.zeros(len(nodes))
    first = 0
    for each in elements_of(nodes, corners, material):
        own = corners[first : first + len(each.volumes)]
        first += len(own)
        stresses = each.stresses(moved[own].reshape(len(own), 24))
        at_corners = np.einsum("cg,egs->ecs", extended, stresses) * each.volumes[:, None, None]
        for component in range(6):
            sums[:, component] += np.bincount(
                own.reshape(-1), at_corners[:, :, component].reshape(-1), len(nodes)
            )
        weights += np.bincount(own.reshape(-1), np.repeat(each.volumes, 8), len(nodes))
    return sums / weights[:, None]


def von_mises(stresses: Floats) -> Floats:
    """The von Mises stress of each row: what yields in tension at as much yields here.

    >>> float(von_mises(np.array([[200.0, 0, 0, 0, 0, 0]]))[0])
    200.0
    """
    xx, yy, zz, xy, yz, zx = stresses.T
    normal = ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2
    return np.asarray(np.sqrt(normal + 3 * (xy**2 + yz**2 + zx**2)))
