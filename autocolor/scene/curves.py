"""Mapping curves: the functions from intensities to fractions of the range of levels.

Paper: "The Lighting Model": nonlinear mappings of intensities can be tried. A curve is called with the
minimum, the maximum, and the array of all intensities to map; it returns a nondecreasing function from
intensities to fractions of the range, 0 to 1. To add a curve, define it here and register it: a function of
fractions with `curve_of_fractions`, or a function of intensities with `curve`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from autocolor.arrays import Singles

Fractions = Callable[[Singles], Singles]
"""A function of a float32 array: it may work in place and return its argument, or return a new array."""

MappingCurve = Callable[[np.float32, np.float32, Singles], Fractions]
"""A function of the minimum, the maximum and all intensities; returns the function to fractions."""

CurvePoints = tuple[tuple[float, float], ...]
"""Points (x, y) of a nondecreasing curve, from x = 0 to x = 1."""

GAMMA: Final = 2.2
"""Assumed: the exponent of a television monitor."""

LOGARITHM: Final = 15.0
"""Assumed: the range is mapped to the logarithms of 1 to 16, four doublings."""

CURVES: Final[dict[str, MappingCurve]] = {}
"""The registered curves, by the names that scenes use."""


def curve(name: str) -> Callable[[MappingCurve], MappingCurve]:
    """A decorator that registers a mapping curve under a name."""

    def register(function: MappingCurve) -> MappingCurve:
        CURVES[name] = function
        return function

    return register


def curve_of_fractions(name: str) -> Callable[[Fractions], Fractions]:
    """A decorator that registers a function of the linear fraction of the range."""

    def register(function: Fractions) -> Fractions:
        CURVES[name] = along_range(function)
        return function

    return register


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


def through_points(points: CurvePoints) -> MappingCurve:
    """The piecewise linear mapping curve through points."""
    xs, ys = zip(*points, strict=True)
    return along_range(lambda fractions: np.interp(fractions, xs, ys).astype(np.float32))


def mapping_curve(mapping: str | CurvePoints) -> MappingCurve:
    """The curve of a scene's `mapping`: one of `CURVES` by name, or the one through points."""
    return CURVES[mapping] if isinstance(mapping, str) else through_points(mapping)


@curve_of_fractions("linear")
def linear(fractions: Singles) -> Singles:
    """Levels proportional to intensity above the minimum."""
    return fractions


@curve_of_fractions("gamma")
def gamma(fractions: Singles) -> Singles:
    """The inverse of a monitor's power-law response."""
    return np.power(fractions, np.float32(1 / GAMMA))


@curve_of_fractions("logarithm")
def logarithm(fractions: Singles) -> Singles:
    """Dark intensities spread out and bright ones compressed, logarithmically."""
    mapped: Singles = np.log1p(fractions * np.float32(LOGARITHM)) / np.float32(np.log1p(LOGARITHM))
    return mapped


@curve("equalize")
def equalize(minimum: np.float32, maximum: np.float32, intensities: Singles) -> Fractions:
    """Histogram equalization: levels become equally frequent.

    The fraction of an intensity is its cumulative share of all intensities above the minimum. It is 0 at the
    minimum and 1 at the maximum, also where no intensity reaches them. Where ranges are held, what is within
    them is still spread evenly, so that less light hardly looks darker.
    """
    ends = [
        end for end, found in ((minimum, intensities.min()), (maximum, intensities.max())) if end != found
    ]
    values, counts = np.unique(np.append(intensities, ends), return_counts=True)
    below = np.cumsum(counts) - counts[0]
    shares: Singles = (below / max(below[-1], 1)).astype(np.float32)
    return lambda given: shares[np.searchsorted(values, given)]
