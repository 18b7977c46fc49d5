"""Measures of a picture of an object: its tone in color; in white, its darkness, spread and creases."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Bytes, Indices, Singles
from benchmarks.form.creases import Creases

DARK: Final = 24
"""A gray below it is black to the eye."""

BRIGHT: Final = 250
"""A gray above it has no form left."""

MOST_EXTREME: Final = 0.02
"""The bound of the shares of dark and of bright pixels."""

LEAST_SPREAD: Final = 90
"""The bound of the spread on curved shapes."""

TONES: Final = (0.42, 0.58)
"""The bounds of the tone of the created view."""

LUMA: Final = (0.299, 0.587, 0.114)
"""The weights of red, green and blue in the luma of a color (ITU-R BT.601)."""

SEEN: Final = 8
"""Grays that differ by so much on both sides of a crease show it."""

LEAST_SHOWN: Final = 0.95
"""Assumed: the bound of the share of edges that show; under any light some directions look alike."""

FEWEST_PAIRS: Final = 6
"""An edge with fewer pairs of pixels is too short to be judged."""


@dataclass(frozen=True)
class Measures:
    """The measures of one picture, or the worst of several; shares are fractions.

    `spread` is the distance of the 5th from the 95th percentile of the gray. `edges_shown` and `pairs_shown`
    are the shares of edges and of pairs of pixels that differ by at least SEEN, and `faintest` the least
    median difference along an edge; they are None where no crease is seen. `tone` is the median luma of the
    object, 0 to 1, in the colors that people get, and None for other views than the created view.
    """

    dark: float
    bright: float
    spread: float
    mean: float
    edges: int
    edges_shown: float | None
    pairs_shown: float | None
    faintest: float | None
    tone: float | None = None

    def broken(self, is_curved: bool) -> tuple[str, ...]:
        """The names of the bounds that are broken."""
        bounds = {
            "dark": self.dark > MOST_EXTREME,
            "bright": self.bright > MOST_EXTREME,
            "spread": is_curved and self.spread < LEAST_SPREAD,
            "edges": self.edges_shown is not None and self.edges_shown < LEAST_SHOWN,
            "tone": self.tone is not None and not TONES[0] <= self.tone <= TONES[1],
        }
        return tuple(name for name, is_broken in bounds.items() if is_broken)


def measure(gray: Bytes, pixels: Indices, creases: Creases) -> Measures:
    """The measures of a picture, given as the gray of the raster, flat; `pixels` are those of the object."""
    grays = gray[pixels]
    if not len(grays):
        return Measures(0.0, 0.0, 0.0, 0.0, 0, None, None, None)
    low, high = np.percentile(grays, (5, 95)).tolist()
    differences = np.abs(gray[creases.one].astype(np.float32) - gray[creases.other])
    medians = edge_medians(differences, creases)
    return Measures(
        dark=float(np.mean(grays < DARK)),
        bright=float(np.mean(grays > BRIGHT)),
        spread=high - low,
        mean=float(grays.mean()),
        edges=len(medians),
        edges_shown=float(np.mean(medians >= SEEN)) if len(medians) else None,
        pairs_shown=float(np.mean(differences >= SEEN)) if len(differences) else None,
        faintest=float(medians.min()) if len(medians) else None,
    )


def tone(colors: Bytes) -> float | None:
    """The median luma of some colors, (n, 3), from 0 to 1; None without colors."""
    return float(np.median(colors @ np.array(LUMA))) / 255 if len(colors) else None


def edge_medians(differences: Singles, creases: Creases) -> Singles:
    """The median difference along each edge with at least FEWEST_PAIRS pairs."""
    counts = creases.pairs_of_edge
    ordered = differences[np.lexsort((differences, creases.edges))]
    first = np.cumsum(counts) - counts
    medians: Singles = (ordered[first + (counts - 1) // 2] + ordered[first + counts // 2]) / np.float32(2)
    return medians[counts >= FEWEST_PAIRS]


def worst(every: Sequence[Measures]) -> Measures:
    """The worst of each measure among several; the mean is that of the means.

    The tone is the first that is not None.
    """
    return Measures(
        dark=max(each.dark for each in every),
        bright=max(each.bright for each in every),
        spread=min(each.spread for each in every),
        mean=sum(each.mean for each in every) / len(every),
        edges=sum(each.edges for each in every),
        edges_shown=min((each.edges_shown for each in every if each.edges_shown is not None), default=None),
        pairs_shown=min((each.pairs_shown for each in every if each.pairs_shown is not None), default=None),
        faintest=min((each.faintest for each in every if each.faintest is not None), default=None),
        tone=next((each.tone for each in every if each.tone is not None), None),
    )
