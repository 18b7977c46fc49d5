"""Depth as a whole number: the keys that the hidden-surface algorithms compare.

The inverse depth is linear along a scan line. Its first value and its step are rounded to whole numbers once,
and stepping adds no rounding: a running sum over all segments is exact, and the batch algorithm and the
literal one find the same number at every pixel. A key is off by at most half a unit for each pixel from the
left end of its segment.

The low bits of a key, below the depth, hold the number of the segment.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Numbers
from autocolor.visibility.projection import Projection

KEY_BITS: Final = 62
"""One less than the 63 bits of a positive number, because rounding may add to the nearest depth."""


@dataclass(frozen=True)
class DepthScale:
    """Keys are whole multiples of `segment_limit`; the inverse depth 1 is `factor` of them.

    `segment_limit` is a power of two above the numbers of all segments.
    """

    segment_limit: int
    factor: float

    def key(self, inverse_depth: float) -> int:
        """The key of an inverse depth, or of a difference of two.

        Halves are rounded to the even number; this is no level that is displayed, and as exact either way.
        """
        return round(inverse_depth * self.factor) * self.segment_limit

    def keys(self, inverse_depth: Floats) -> Numbers:
        """The keys of inverse depths, or of differences of them; the number of a segment can be added.

        A difference beyond the largest key can only belong to a segment of one pixel, which takes no step.
        """
        whole = np.rint(inverse_depth * self.factor)
        most = 2.0**KEY_BITS / self.segment_limit
        return np.clip(whole, -most, most, out=whole).astype(np.int64) * self.segment_limit


def depth_scale(projected: Projection) -> DepthScale:
    """The finest scale that holds the nearest corner of a polygon and the numbers of all segments."""
    segment_limit = 1 << (int(projected.first_segment[-1]) + 1).bit_length()
    return DepthScale(segment_limit, 2.0 ** (KEY_BITS - segment_limit.bit_length() + 1) / projected.nearest)
