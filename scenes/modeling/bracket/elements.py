"""Hexahedra with eight nodes: their strains, and the forces with which they answer displacements.

Each has nine incompatible modes beside the displacements of its nodes, so that it bends without locking
(E. L. Wilson and others, 1973; R. L. Taylor, P. J. Beresford and Wilson, 1976, for those that are no boxes).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, chunks

SIGNS: Final = np.array(
    [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
    np.float64,
)
"""The corners of the cube that every hexahedron is an image of."""

GAUSS: Final = SIGNS / np.sqrt(3.0)
"""The places in the cube at which stresses are computed; each has the weight 1."""

AT_ONCE: Final = 1024


@dataclass(frozen=True)
class Material:
    """Young's modulus in MPa, and Poisson's ratio."""

    young: float
    poisson: float

    @property
    def stiffness(self) -> Floats:
        """Stresses from strains, (6, 6), in the order xx, yy, zz, xy, yz, zx."""
        shear = self.young / (2 * (1 + self.poisson))
        bulk = self.young * self.poisson / ((1 + self.poisson) * (1 - 2 * self.poisson))
        matrix = np.diag([2 * shear] * 3 + [shear] * 3)
        matrix[:3, :3] += bulk
        return matrix


@dataclass(frozen=True)
class Elements:
    """Some hexahedra: strains and modes at their Gauss points, and their matrices.

    `strains` is (n, 8, 6, 24), `modes` (n, 8, 6, 9), `condensed` (n, 24, 24), `answers` (n, 9, 24): the modes
    that displacements of the corners bring with them. `volumes` is (n,).
    """

    material: Material
    strains: Floats
    modes: Floats
    condensed: Floats
    answers: Floats
    volumes: Floats

    def stresses(self, moved: Floats) -> Floats:
        """The stresses at the Gauss points, (n, 8, 6), of displacements of the corners, (n, 24)."""
        strain = np.einsum("egij,ej->egi", self.strains, moved)
        strain += np.einsum("egij,ejk,ek->egi", self.modes, self.answers, moved, optimize=True)
        return np.asarray(strain @ self.material.stiffness)


def elements_of(nodes: Floats, corners: Indices, material: Material) -> Iterator[Elements]:
    """The hexahedra, some at a time."""
    stiffness = material.stiffness
    for chunk in chunks(len(corners), AT_ONCE):
        places = nodes[corners[chunk]]
        middle = _jacobians(places, np.zeros((1, 3)))[:, 0]
        at_gauss = _jacobians(places, GAUSS)
        volumes = np.linalg.det(at_gauss)

        strains = _strains(np.einsum("gck,eglk->egcl", _slopes(GAUSS), np.linalg.inv(at_gauss)))
        # The modes 1 - r^2 in each direction of the cube, turned as at the middle.
        slopes = np.zeros((len(GAUSS), 3, 3))
        slopes[:, range(3), range(3)] = -2 * GAUSS
        turned = np.einsum("gck,elk->egcl", slopes, np.linalg.inv(middle))
        modes = _strains(turned * (np.linalg.det(middle)[:, None] / volumes)[:, :, None, None])

        # Condense the modes: they take the values at which they add no force of their own.
        weighted = volumes[:, :, None, None] * (stiffness @ strains)
        full = np.einsum("egki,egkj->eij", strains, weighted, optimize=True)
        mixed = np.einsum("egki,egkj->eij", modes, weighted, optimize=True)
        own = np.einsum(
            "egki,egkj->eij", modes, volumes[:, :, None, None] * (stiffness @ modes), optimize=True
        )
        answers = -np.linalg.solve(own, mixed)
        condensed = full + np.swapaxes(mixed, 1, 2) @ answers
        yield Elements(material, strains, modes, condensed, answers, volumes.sum(axis=1))


def shape(places: Floats) -> Floats:
    """How much each corner counts at places in the cube, (places, 8)."""
    return np.asarray(np.prod(1 + SIGNS * places[:, None], axis=-1) / 8)


def _slopes(places: Floats) -> Floats:
    """The derivatives of `shape` in the directions of the cube, (places, 8, 3)."""
    factors = 1 + SIGNS * places[:, None]
    others = np.stack([factors[..., 1] * factors[..., 2], factors[..., 2] * factors[..., 0]], axis=-1)
    products = np.concatenate([others, factors[..., :1] * factors[..., 1:2]], axis=-1)
    return np.asarray(SIGNS * products / 8)


def _jacobians(places: Floats, at: Floats) -> Floats:
    """How x, y and z change in the directions of the cube, (n, places, 3 directions, 3)."""
    return np.asarray(np.einsum("gck,ecl->egkl", _slopes(at), places))


def _strains(slopes: Floats) -> Floats:
    """Strains from displacements, (n, g, 6, 3 c), for slopes in x, y and z of c shapes, (n, g, c, 3)."""
    found = np.zeros((*slopes.shape[:2], 6, slopes.shape[2], 3))
    dx, dy, dz = np.moveaxis(slopes, -1, 0)
    found[:, :, 0, :, 0] = found[:, :, 3, :, 1] = found[:, :, 5, :, 2] = dx
    found[:, :, 1, :, 1] = found[:, :, 3, :, 0] = found[:, :, 4, :, 2] = dy
    found[:, :, 2, :, 2] = found[:, :, 4, :, 1] = found[:, :, 5, :, 0] = dz
    return found.reshape(*slopes.shape[:2], 6, -1)
