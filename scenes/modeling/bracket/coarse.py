"""A coarse space for conjugate gradients: lumps of nodes that move as rigid bodies.

Bending a slender part moves many nodes a little each, which a preconditioner of single nodes sees last. The
matrix of the lumps' six motions each is small, and is inverted once.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from autocolor.arrays import Floats, Indices, chunks

LUMPS_ALONG: Final = 8
"""The lumps along the longest side of the solid."""

AT_ONCE: Final = 1024

SLIGHT: Final = 1e-9
"""What a motion is made stiffer by, as a share of its stiffness."""


class CoarseSpace:
    """The motions of the lumps, and the inverse of their matrix."""

    def __init__(
        self, nodes: Floats, corners: Indices, matrices: Floats, is_free: npt.NDArray[np.bool_]
    ) -> None:
        low, high = nodes.min(axis=0), nodes.max(axis=0)
        cells = np.floor((nodes - low) / ((high - low).max() * (1 + 1e-9)) * LUMPS_ALONG)
        _, lumps = np.unique(cells, axis=0, return_inverse=True)
        self.lumps = lumps.reshape(-1)
        count = int(self.lumps.max()) + 1

        # Three shifts and three turns about the middle of each lump; what is held does not move.
        totals = np.stack([np.bincount(self.lumps, component, count) for component in nodes.T], axis=1)
        x, y, z = (nodes - (totals / np.bincount(self.lumps)[:, None])[self.lumps]).T
        self.motions = np.zeros((len(nodes), 3, 6))
        self.motions[:, range(3), range(3)] = 1.0
        self.motions[:, 1, 3], self.motions[:, 2, 3] = -z, y
        self.motions[:, 2, 4], self.motions[:, 0, 4] = -x, z
        self.motions[:, 0, 5], self.motions[:, 1, 5] = -y, x
        self.motions *= is_free[:, :, None]

        entries = np.zeros(36 * count * count)
        for chunk in chunks(len(corners), AT_ONCE):
            motions = self.motions[corners[chunk]]
            blocks = matrices[chunk].reshape(-1, 8, 3, 8, 3)
            half = np.einsum("eakbl,eblj->eakbj", blocks, motions, optimize=True)
            whole = np.einsum("eaki,eakbj->eabij", motions, half, optimize=True)
            own = 6 * self.lumps[corners[chunk]]
            rows = own[:, :, None, None, None] + np.arange(6)[:, None]
            places = rows * (6 * count) + own[:, None, :, None, None] + np.arange(6)
            entries += np.bincount(places.reshape(-1), whole.reshape(-1), len(entries))
        # Lumps that are held, or too small to turn, have motions without stiffness: give them a little.
        matrix = entries.reshape(6 * count, -1)
        own_stiffness = np.diagonal(matrix)
        slight = np.where(own_stiffness > 0, SLIGHT * own_stiffness, own_stiffness.max())
        self.inverse: Floats = np.linalg.inv(matrix + np.diag(slight))

    def corrected(self, force: Floats) -> Floats:
        """The displacements, (3 n,), with which the lumps answer a force, (3 n,)."""
        own = np.einsum("nki,nk->ni", self.motions, force.reshape(-1, 3))
        sums = np.stack(
            [np.bincount(self.lumps, component, len(self.inverse) // 6) for component in own.T], axis=1
        )
        # Not by `@`, whose threads wait for each other on a busy machine.
        answer = np.einsum("ij,j->i", self.inverse, sums.reshape(-1)).reshape(-1, 6)
        moved: Floats = np.einsum("nki,ni->nk", self.motions, answer[self.lumps])
        return moved.reshape(-1)
