"""Depth as a whole number: what the hidden-surface algorithms compare.

The inverse depth is linear along a line of the raster. Its first value and its step are rounded to whole
numbers once, and then stepped without any rounding: a running sum over all spans is exact, and the batch and
the literal algorithm find the same number at every pixel. It is off by at most half a unit for each pixel
from the left end of the span.

Below the depth a key has room for the number of the span.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Integers
from autocolor.visibility.projection import Projection

KEY_BITS: Final = 62
"""Of the 63 of a positive number; one is room for what rounding adds to the nearest."""


@dataclass(frozen=True)
class DepthScale:
    """Keys are whole multiples of `span_limit`; the inverse depth 1 is `factor` of them.

    The numbers of all spans are below `span_limit`, a power of two.
    """

    span_limit: int
    factor: float

    def key(self, inverse_depth: float) -> int:
        """The key of an inverse depth, or of a difference of two.

        Halves go to the even number: it is no level that anyone sees, and as exact either way.
        """
        return round(inverse_depth * self.factor) * self.span_limit

    def keys(self, inverse_depth: Floats) -> Integers:
        """The keys of inverse depths, or of differences of them; a number of a span can be added.

        A difference beyond the largest key can only belong to a span of one pixel, which takes no step.
        """
        whole = np.rint(inverse_depth * self.factor)
        most = 2.0**KEY_BITS / self.span_limit
        return np.clip(whole, -most, most, out=whole).astype(np.int64) * self.span_limit


def depth_scale(projected: Projection) -> DepthScale:
    """The finest scale that holds the nearest corner of a polygon and the numbers of all spans."""
    span_limit = 1 << (int(projected.first_crossing[-1]) + 1).bit_length()
    return DepthScale(span_limit, 2.0 ** (KEY_BITS - span_limit.bit_length() + 1) / projected.nearest)
