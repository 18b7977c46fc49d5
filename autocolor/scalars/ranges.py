"""The own range of a scalar, which is shown where `[scalar]` gives no limits."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats

Limits = tuple[float, float]

UNIT: Final = (0.0, 1.0)
"""Assumed: the range of a scalar without any value."""

LEAST_EXTENT: Final = 1e-6
"""Assumed: a range that is shorter than this share of its numbers is noise of float32, and has no extent."""


def widened(low: float, high: float) -> Limits:
    """The range from `low` to `high` as numbers of float32, since those at the pixels are.

    Assumed: one without extent, as of a constant, is widened on both sides by half of its number, and by a
    half where that is 0; so the value is in the middle of the colors.

    >>> widened(1.0, 3.0), widened(8.0, 8.0), widened(0.0, 0.0)
    ((1.0, 3.0), (4.0, 12.0), (-0.5, 0.5))
    """
    low, high = float(np.float32(low)), float(np.float32(high))
    most = max(abs(low), abs(high))
    if high - low > LEAST_EXTENT * most:
        return low, high
    half = most / 2 if most > float(np.finfo(np.float32).tiny) * 4 else 0.5
    return float(np.float32(low - half)), float(np.float32(high + half))


def range_of(values: Floats) -> Limits:
    """The least and the largest of the values that are not missing, widened; UNIT if all are."""
    found = values[np.isfinite(values)]
    return widened(float(found.min()), float(found.max())) if len(found) else UNIT
