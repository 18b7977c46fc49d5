"""Mapping curves: how far up the range of levels an intensity is shown.

Paper: "The Lighting Model": nonlinear mappings of intensities can be tried. A curve is given the minimum and
the maximum of the intensities that it maps, and all of these; it returns the function from intensity to a
fraction of the range, 0 to 1, that never falls. To add a curve, define it here, under its name: as a function
of fractions by `curve_of_fractions`, or of intensities by `curve`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from autocolor.arrays import Singles

Fractions = Callable[[Singles], Singles]
"""A function of float32 arrays, which works in the array that it is given or returns another."""

MappingCurve = Callable[[np.float32, np.float32, Singles], Fractions]
"""The function from intensities to fractions, of a minimum, a maximum and all intensities."""

CurvePoints = tuple[tuple[float, float], ...]
"""Points (x, y) of a curve that never falls, from x = 0 to x = 1."""

GAMMA: Final = 2.2
"""Assumed: the exponent of a television monitor."""

LOGARITHM: Final = 15.0
"""Assumed: the logarithm of 1 to 16, four doublings, over the range."""

CURVES: Final[dict[str, MappingCurve]] = {}
"""The curves by the names that a scene gives them."""


def curve(name: str) -> Callable[[MappingCurve], MappingCurve]:
    """Register a mapping curve under the name that a scene gives it."""

    def register(made: MappingCurve) -> MappingCurve:
        CURVES[name] = made
        return made

    return register


def curve_of_fractions(name: str) -> Callable[[Fractions], Fractions]:
    """Register a function of the fraction of the range that an intensity is at."""

    def register(function: Fractions) -> Fractions:
        CURVES[name] = along_range(function)
        return function

    return register


def along_range(function: Fractions) -> MappingCurve:
    """The mapping curve that applies a function to the fraction of the range that an intensity is at."""

    def of_extent(minimum: np.float32, maximum: np.float32, _: Singles) -> Fractions:
        width = maximum - minimum

        def fraction(intensities: Singles) -> Singles:
            fractions = intensities - minimum
            # Divide, for the maximum must come to exactly 1.
            fractions /= width
            return function(fractions)

        return fraction

    return of_extent


def through_points(points: CurvePoints) -> MappingCurve:
    """The mapping curve of straight lines between points."""
    xs, ys = zip(*points, strict=True)
    return along_range(lambda fractions: np.interp(fractions, xs, ys).astype(np.float32))


def mapping_curve(mapping: str | CurvePoints) -> MappingCurve:
    """The curve of a scene's mapping: one of `CURVES` by its name, or one through points."""
    return CURVES[mapping] if isinstance(mapping, str) else through_points(mapping)


@curve_of_fractions("linear")
def linear(fractions: Singles) -> Singles:
    """As intensities grow."""
    return fractions


@curve_of_fractions("gamma")
def gamma(fractions: Singles) -> Singles:
    """The inverse of a monitor's response."""
    return np.power(fractions, np.float32(1 / GAMMA))


@curve_of_fractions("logarithm")
def logarithm(fractions: Singles) -> Singles:
    """Equal ratios of intensities are equal steps."""
    mapped: Singles = np.log1p(fractions * np.float32(LOGARITHM)) / np.float32(np.log1p(LOGARITHM))
    return mapped


@curve("equalize")
def equalize(minimum: np.float32, maximum: np.float32, intensities: Singles) -> Fractions:
    """The share of all intensities above the least that each reaches, so that all levels are as frequent."""
    values, counts = np.unique(intensities, return_counts=True)
    below = np.cumsum(counts) - counts[0]
    shares: Singles = (below / max(below[-1], 1)).astype(np.float32)
    return lambda some: shares[np.searchsorted(values, some)]
