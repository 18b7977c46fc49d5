"""Mapping curves: the functions from intensities to fractions of the range of levels.

Paper: "The Lighting Model": nonlinear mappings of intensities can be tried. A mapping curve is a function of
the minimum and the maximum of a range and of all intensities to map. It returns a nondecreasing function from
intensities to fractions of the range, 0 to 1.

To add a curve, define it here and name it in `CURVES` at the foot. `along_range` makes a mapping curve of a
function of the linear fraction of the range.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from autocolor.arrays import Indices, Singles

Fractions = Callable[[Singles], Singles]
"""A function of a float32 array. It may work in place and return its argument, or return a new array."""

MappingCurve = Callable[[np.float32, np.float32, Singles], Fractions]
"""A function of the minimum, the maximum and all intensities. It returns the function to fractions."""

CurvePoints = tuple[tuple[float, float], ...]
"""Points (x, y) of a nondecreasing curve, from x = 0 to x = 1."""

GAMMA: Final = 2.2
"""Assumed: the exponent of a television monitor."""

ROUNDING: Final = 2.0**-20
"""Assumed: eight units in the last place of float32, the rounding of a sum of lights."""

LOGARITHM: Final = 15.0
"""Assumed: the range is mapped to the logarithms of 1 to 16, four doublings."""


def mapping_curve(mapping: str | CurvePoints) -> MappingCurve:
    """The curve of a scene's `mapping`: a name in `CURVES`, or the curve through points."""
    return CURVES[mapping] if isinstance(mapping, str) else through_points(mapping)


def along_range(function: Fractions) -> MappingCurve:
    """The mapping curve that applies a function to the linear fraction of the range."""

    def curve_of_range(minimum: np.float32, maximum: np.float32, _: Singles) -> Fractions:
        width = maximum - minimum

        def fraction(intensities: Singles) -> Singles:
            fractions = intensities - minimum
            # Dividing, unlike multiplying by the reciprocal, maps the maximum to exactly 1.
            fractions /= width
            return function(fractions)

        return fraction

    return curve_of_range


def linear(fractions: Singles) -> Singles:
    """Levels proportional to intensity above the minimum."""
    return fractions


def gamma(fractions: Singles) -> Singles:
    """The inverse of a monitor's power-law response."""
    return np.power(fractions, np.float32(1 / GAMMA))


def logarithm(fractions: Singles) -> Singles:
    """Dark intensities spread out and bright intensities compressed, logarithmically."""
    mapped: Singles = np.log1p(fractions * np.float32(LOGARITHM)) / np.float32(np.log1p(LOGARITHM))
    return mapped


def through_points(points: CurvePoints) -> MappingCurve:
    """The piecewise linear mapping curve through points."""
    xs, ys = zip(*points, strict=True)
    return along_range(lambda fractions: np.interp(fractions, xs, ys).astype(np.float32))


def equalize(minimum: np.float32, maximum: np.float32, intensities: Singles) -> Fractions:
    """Histogram equalization: levels become equally frequent.

    The fraction of an intensity is its cumulative share of all intensities above the minimum. It is 0 at the
    minimum and 1 at the maximum, even if no intensity reaches them. With a fixed range, intensities are
    spread evenly, too, so that less light hardly looks darker. Assumed: intensities that differ by no more
    than the rounding of a sum of lights have one fraction, or a flat sheet would show all levels.
    """
    pairs = ((minimum, intensities.min()), (maximum, intensities.max()))
    ends = [end for end, reached in pairs if end != reached]
    values, counts = np.unique(np.append(intensities, ends), return_counts=True)
    starts = group_starts(values, float(ROUNDING * maximum))
    sizes = np.add.reduceat(counts, starts)
    below = np.cumsum(sizes) - sizes[0]
    shares: Singles = (below / max(below[-1], 1)).astype(np.float32)
    return lambda given: shares[np.searchsorted(values[starts], given, side="right") - 1]


def group_starts(values: Singles, width: float) -> Indices:
    """The places of rising values at which groups start: a group spans at most a width from its lowest value.

    >>> group_starts(np.array([1.0, 1.2, 1.4, 1.6, 9.0], np.float32), 0.5).tolist()
    [0, 3, 4]
    """
    # From each value to the first value beyond its width. Following the steps twice, four times and so on
    # from all starts known so far doubles their number.
    steps = np.append(np.searchsorted(values, values.astype(np.float64) + width, side="right"), len(values))
    starts = np.zeros(1, np.intp)
    while starts[-1] < len(values):
        starts = np.concatenate([starts, steps[starts]])
        steps = steps[steps]
    return starts[starts < len(values)]


CURVES: Final[dict[str, MappingCurve]] = {
    "linear": along_range(linear),
    "gamma": along_range(gamma),
    "logarithm": along_range(logarithm),
    "equalize": equalize,
}
"""Every mapping curve by the name that scenes use."""
