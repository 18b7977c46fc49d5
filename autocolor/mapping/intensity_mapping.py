"""From intensities to levels, and from levels to words.

Paper: "The Lighting Model": the unscaled intensities are mapped to integer intensities for the display,
by the range of each surface or of the entire object; nonlinear mappings can be tried. "Light Source Color
Blending", Figure 11: a word is the first word of the surface's range plus the level.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from autocolor.arrays import Singles, Words
from autocolor.errors import InputError
from autocolor.lighting.picture import IntensityRange, Picture
from autocolor.mapping.level_ranges import BACKGROUND, LevelRange
from autocolor.mapping.rounding import halves_up
from autocolor.scene.curves import CurvePoints, mapping_curve
from autocolor.visibility.visible_points import point_chunks


def words_of(
    picture: Picture,
    ranges: Mapping[str, LevelRange],
    scaling: str = "surface",
    mapping: str | CurvePoints = "linear",
) -> Words:
    """The words of a picture, (lines, elements) uint16, read-only; BACKGROUND where nothing is visible.

    The minimum and maximum intensity become the lowest and highest level: those of each surface if `scaling`
    is "surface", those of the whole picture if it is "object". Where they are equal, every pixel gets the
    highest level. Raises InputError if an intensity is not finite.
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
            np.copyto(here[surface.pixels], levels_of(fractions, levels, out=fractions), casting="unsafe")
            here[surface.pixels] += np.uint16(first)
        words[pixels] = here
    words.flags.writeable = False
    return words.reshape(picture.lines, picture.elements)


def levels_of(fractions: Singles, levels: int, out: Singles | None = None) -> Singles:
    """The levels, 0 to levels - 1, for fractions from 0 to 1, as float32; `out` may be `fractions`."""
    scaled = np.multiply(fractions, np.float32(levels - 1), out=out)
    return halves_up(scaled, out=scaled)


def fraction_of(
    extent: IntensityRange, mapping: str | CurvePoints, everything: Singles
) -> Callable[[Singles], Singles]:
    """The function from intensities to fractions of the range, 0 to 1.

    `everything` holds all intensities that are mapped with this range.
    """
    if extent.maximum == extent.minimum:
        return np.ones_like
    return mapping_curve(mapping)(np.float32(extent.minimum), np.float32(extent.maximum), everything)
