"""Intensity to level to word.

Paper: "The Lighting Model": the unscaled intensities are mapped into integer intensities for the display,
by the range of each surface or of the entire object; nonlinear mappings can be tried. "Light Source Color
Blending", Figure 11: a word is the first of its surface's range plus the level.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from autocolor.arrays import Singles, Words
from autocolor.errors import InputError
from autocolor.lighting.picture import IntensityRange, Picture
from autocolor.mapping.level_ranges import BACKGROUND, LevelRange
from autocolor.mapping.rounding import halves_up
from autocolor.scene.scene import Curve
from autocolor.visibility.visible_points import point_chunks

GAMMA: Final = 2.2
"""Assumed: the exponent of a television monitor."""

LOGARITHM: Final = 15.0
"""Assumed: the logarithm of 1 to 16, four doublings, over the range."""


def words_of(
    picture: Picture,
    ranges: Mapping[str, LevelRange],
    scaling: str = "surface",
    mapping: str | Curve = "linear",
) -> Words:
    """The words of a picture, (lines, elements) uint16; the background's where nothing is seen.

    `scaling` says whose minimum and maximum become the lowest and the highest level, each "surface" its own
    or the whole "object"; a range without extent becomes the highest level. Raises InputError for
    intensities that are not finite.
    """
    words = np.full(picture.lines * picture.elements, BACKGROUND, np.uint16)
    extents = picture.relative_ranges
    for surface in picture.slices:
        extent = extents[surface.surface_number]
        if not (np.isfinite(extent.minimum) and np.isfinite(extent.maximum)):
            name = picture.surfaces[surface.surface_number - 1]
            raise InputError(f"surface {name!r}: an intensity must be finite, not {extent.maximum:g}")
    if scaling == "object":
        of_all = fraction_of(extents[0], mapping, picture.relative)
        fractions_of = dict.fromkeys(extents, of_all)
    else:
        fractions_of = {
            surface.surface_number: fraction_of(
                extents[surface.surface_number], mapping, picture.relative[surface.pixels]
            )
            for surface in picture.slices
        }
    for chunk in point_chunks(picture.slices):
        intensities, pixels = picture.relative[chunk.pixels], picture.pixels[chunk.pixels]
        here = np.empty(len(pixels), np.uint16)
        for surface in chunk.slices:
            first, levels = ranges[picture.surfaces[surface.surface_number - 1]]
            fractions = fractions_of[surface.surface_number](intensities[surface.pixels])
            np.copyto(here[surface.pixels], levels_of(fractions, levels), casting="unsafe")
            here[surface.pixels] += np.uint16(first)
        words[pixels] = here
    words.flags.writeable = False
    return words.reshape(picture.lines, picture.elements)


def levels_of(shown: Singles, levels: int) -> Singles:
    """The levels, 0 to levels - 1, of fractions from 0 to 1, in the array of the fractions."""
    shown *= np.float32(levels - 1)
    return halves_up(shown)


def fraction_of(
    extent: IntensityRange, mapping: str | Curve, everything: Singles
) -> Callable[[Singles], Singles]:
    """How far along its range an intensity is shown, 0 to 1; `everything` is what "equalize" counts."""
    if extent.maximum == extent.minimum:
        return np.ones_like
    if mapping == "equalize":
        return equalized(everything)
    curve = curve_of(mapping)
    minimum, width = np.float32(extent.minimum), np.float32(extent.maximum) - np.float32(extent.minimum)

    def fraction(intensities: Singles) -> Singles:
        shown = intensities - minimum
        # Divide, for the maximum must come to exactly 1.
        shown /= width
        return curve(shown)

    return fraction


def curve_of(mapping: str | Curve) -> Callable[[Singles], Singles]:
    """A mapping as a function of fractions that never falls."""
    if isinstance(mapping, str):
        return CURVES[mapping]
    across, up = zip(*mapping, strict=True)
    return lambda shown: np.interp(shown, across, up).astype(np.float32)


def equalized(everything: Singles) -> Callable[[Singles], Singles]:
    """The share of all intensities above the least that each reaches, so that all levels are as frequent."""
    values, counts = np.unique(everything, return_counts=True)
    below = np.cumsum(counts) - counts[0]
    shares: Singles = (below / max(below[-1], 1)).astype(np.float32)
    return lambda intensities: shares[np.searchsorted(values, intensities)]


def _linear(shown: Singles) -> Singles:
    return shown


def _gamma(shown: Singles) -> Singles:
    return np.power(shown, np.float32(1 / GAMMA))


def _logarithm(shown: Singles) -> Singles:
    mapped: Singles = np.log1p(shown * np.float32(LOGARITHM)) / np.float32(np.log1p(LOGARITHM))
    return mapped


CURVES: Final[Mapping[str, Callable[[Singles], Singles]]] = {
    "linear": _linear,
    "gamma": _gamma,
    "logarithm": _logarithm,
}
