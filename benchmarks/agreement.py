"""Whether a peer makes the same picture: nothing is compared in time that does not.

A picture agrees when the same pixels are covered, but for those within one pixel of a silhouette, where rules
of rasterization differ; and when intensities in 8 bits differ by less than what a few inner silhouettes
explain.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from autocolor import Scene
from benchmarks.comparison import Field, expected

MOST_MEDIAN, MOST_PERCENTILE = 1.0, 2.0
"""The largest difference of intensities, of 255: the median, and the 99th percentile."""

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Agreement:
    """How far two pictures of a scene agree.

    `uncovered` counts the pixels that only one of them covers, `astray` those of them that are not within one
    pixel of a silhouette. `median` and `percentile` (the 99th) are of the absolute differences of the pixels
    that both cover, in 255ths of the largest intensity.
    """

    uncovered: int
    astray: int
    median: float
    percentile: float

    def values(self) -> dict[str, Any]:
        """The numbers as plain values."""
        return {**asdict(self), "agrees": self.holds}

    @property
    def holds(self) -> bool:
        """Whether the pictures are the same for all that is measured."""
        return not self.astray and self.median <= MOST_MEDIAN and self.percentile <= MOST_PERCENTILE

    def __str__(self) -> str:
        return (
            f"coverage differs at {self.uncovered} pixels, {self.astray} of them away from silhouettes;"
            f" intensities by {self.median:.2f} of 255 (median) and {self.percentile:.2f} (99th percentile)"
        )


def near_silhouettes(covered: Mask) -> Mask:
    """The pixels within one pixel of a silhouette: with a covered and an uncovered one among its neighbors.

    >>> near_silhouettes(np.array([[True, True, True, False, False, False]])).astype(int)
    array([[0, 0, 1, 1, 0, 0]])
    """
    return _spread(covered) & _spread(~covered)


def agreement(field: Field, scene: Scene) -> Agreement:
    """How far a peer's field of a scene agrees with the picture of this renderer."""
    wanted, covered = expected(scene)
    covers = (field != np.array(scene.background)).any(axis=2)
    both, one = covers & covered, covers ^ covered
    difference = np.abs(field[both].astype(np.float32) - wanted[both]).max(axis=1)
    median, percentile = np.percentile(difference, (50, 99)).tolist() if both.any() else (255.0, 255.0)
    astray = one & ~near_silhouettes(covered)
    return Agreement(int(one.sum()), int(astray.sum()), median, percentile)


def _spread(mask: Mask) -> Mask:
    """The pixels that are, or have a neighbor that is, in the mask."""
    padded = np.pad(mask, 1)
    lines, elements = mask.shape
    parts = [
        padded[down : down + lines, across : across + elements] for down in range(3) for across in range(3)
    ]
    spread: Mask = np.logical_or.reduce(parts)
    return spread
