"""Bands: the levels of surfaces that a scalar colors.

Paper: "Introduction": scalar variables such as stress on the surface of an object, in color. The level range
of such a surface is divided into bands, one a color, and each band into shades of the light:

    word = first + band * shades + shade

So both can be read from a word, another color scale is entries alone, and a scalar that is shown in flat
color codes has one shade. Assumed: beyond the limits are the first and the last band, unless these have
colors of their own; then, as where there is no value, further bands follow.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Singles, Words
from autocolor.checks import Color
from autocolor.immutable import read_only
from autocolor.mapping.color_blending import HALVES_UP
from autocolor.scene.scalars.color_scales import scale_colors

DARKEST: Final = 0.5
"""Assumed: what the darkest shade keeps of a color, so that its band can be told; with less, most of
a shiny surface is too dark for that."""

ROUNDING: Final = 2.0**-20
"""Assumed: what interpolation may be off by, as a fraction of the larger limit."""


class Bands(NamedTuple):
    """How the levels of a surface are divided: `bands` of `shades` from one limit to the other.

    After them come those of values below, above and missing, where they have their own.
    """

    low: float
    high: float
    bands: int
    shades: int
    has_below: bool = False
    has_above: bool = False
    has_missing: bool = False

    @property
    def total(self) -> int:
        """The number of all bands."""
        return self.bands + self.has_below + self.has_above + self.has_missing

    @property
    def levels(self) -> int:
        """The number of all levels."""
        return self.total * self.shades

    @property
    def below(self) -> int:
        """The band of values below the limits."""
        return self.bands if self.has_below else 0

    @property
    def above(self) -> int:
        """The band of values above the limits."""
        return self.bands + self.has_below if self.has_above else self.bands - 1

    @property
    def missing(self) -> int:
        """The band where there is no value, of those that have one."""
        return self.bands + self.has_below + self.has_above

    def brightest(self, band: int) -> int:
        """The highest level of a band."""
        return (band + 1) * self.shades - 1


def band_numbers(values: Singles, bands: Bands) -> Words:
    """The band of each value: floor((value - low) / (high - low) * bands) between the limits.

    A value at the upper limit is in the last band. Assumed: what is beyond a limit by no more than rounding
    is not beyond it, or single pixels would be where a value only reaches the limit.

    >>> band_numbers(np.array([0, 2.4, 2.5, 10, 11], np.float32), Bands(0, 10, 4, 1)).tolist()
    [0, 0, 1, 3, 3]
    """
    low, high, count = bands[:3]
    exact = values.astype(np.float64)
    is_missing = np.isnan(exact)
    exact[is_missing] = low
    rounding = ROUNDING * max(abs(low), abs(high))
    is_below, is_above = exact < low - rounding, exact > high + rounding
    # What is far beyond the limits would be beyond the integers, too.
    np.clip(exact, low, high, out=exact)
    numbers = np.minimum(np.floor((exact - low) / (high - low) * count), count - 1).astype(np.uint16)
    numbers[is_below] = bands.below
    numbers[is_above] = bands.above
    numbers[is_missing] = bands.missing
    return numbers


@lru_cache(maxsize=64)
def band_entries(
    scale: str | tuple[Color, ...],
    ends: tuple[Color | None, Color | None],
    missing: Color,
    bands: Bands,
    floor: float = DARKEST,
) -> Bytes:
    """The entries of a surface with bands, (levels, 3) uint8, read-only.

    The colors of the bands are those of the scale, and `ends` those below and above the limits, if they have
    some. A band's highest shade has its color; `floor` is the brightness of the lowest as a fraction of that.
    """
    beyond = [color for color in ends if color is not None]
    colors = np.vstack([scale_colors(scale, bands.bands), *beyond, *[missing] * bands.has_missing])
    top = bands.shades - 1
    shares = floor + (1 - floor) * np.arange(bands.shades) / top if top else np.ones(1)
    entries = np.floor(colors[:, np.newaxis].astype(np.float64) * shares[:, np.newaxis] + HALVES_UP)
    return read_only(entries.astype(np.uint8).reshape(-1, 3))
