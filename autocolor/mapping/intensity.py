"""From intensities to levels, and from levels to words.

Paper: "The Lighting Model": the unscaled intensities are mapped to integer intensities for the display. The
minimum and the maximum intensity of each surface, or of the entire object, become the lowest and the highest
level; nonlinear mappings can be tried. "Light Source Color Blending", Figure 11: a word is the first word of
the surface's range plus the level. Departs: a scene can hold ranges of intensities, so that less light looks
darker. Departs: with a percentage as exposure, the brightest pixels do not set a range, such as specks seen
through a crack. Intensities beyond a range are shown as its nearest end.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from decimal import Decimal
from functools import lru_cache
from types import MappingProxyType
from typing import Final

import numpy as np

from autocolor.arrays import HALF, LARGEST_SINGLE, Singles, Words, halves_up, underflowing
from autocolor.errors import InputError
from autocolor.lighting.picture import IntensityRange, Picture
from autocolor.mapping.bands import Bands, band_numbers
from autocolor.mapping.ranges import BACKGROUND, LevelRange
from autocolor.scene.curves import ROUNDING, CurvePoints, Fractions, mapping_curve
from autocolor.scene.scene import AUTO, OBJECT, Exposure, Scene
from autocolor.visibility.visible_points import point_chunks

WHOLE: Final = 0
"""The number of the whole object's range; surfaces have numbers from 1 on."""

MOST_EVEN: Final = 0.6
"""Assumed: the largest minimum of a trimmed range, as a share of its maximum.

All levels for the little change of light across a flat sheet would show an edge where its highlight begins.
"""

UNSEEN: Final = 2.0**20
"""Assumed: how many times as strong a light that is not seen is than what is seen."""

SAMPLED: Final = 64
"""Every SAMPLEDth intensity is in the sample of `intensity_below`."""


def has_extent(extent: IntensityRange) -> bool:
    """Whether the minimum and the maximum differ by more than float32 rounding.

    >>> has_extent(IntensityRange(0.25, 0.5)), has_extent(IntensityRange(0.5, 0.5000001))
    (True, False)
    """
    return extent.maximum - extent.minimum > ROUNDING * extent.maximum


def ranges_of(scene: Scene, picture: Picture) -> Mapping[int, IntensityRange]:
    """The ranges that are mapped in a picture of a scene; see `mapped_ranges`."""
    return mapped_ranges(
        picture, scene.scaling, scene.exposure, ambient=scene.ambient, stage=stage_surfaces(scene)
    )


def stage_surfaces(scene: Scene) -> frozenset[int]:
    """The numbers of the surfaces of parts that are all stage."""
    of_object = {part.surface for part in scene.parts if not part.stage}
    return frozenset(n for n, row in enumerate(scene.surfaces, 1) if row.name not in of_object)


def mapped_ranges(
    picture: Picture,
    scaling: str,
    exposure: Exposure,
    *,
    ambient: float | None = None,
    stage: Set[int] = frozenset(),
) -> Mapping[int, IntensityRange]:
    """The range that is mapped to the levels of each visible surface, by number; the whole object's is WHOLE.

    Intensities are relative to the picture's scale. A surface has its held range; else the object's, if that
    is held or the scaling is "object"; else its own, which follows the picture. A surface without extent has
    the object's range. Assumed: an unlit floor has the intensity of the ambient light all over, and should
    look as dark as that is beside the rest. Nor is the `ambient` light a highlight where no light has a share
    of the picture: it is mapped as if a light UNSEEN times as strong were somewhere else. `stage` has the
    numbers of the surfaces that are not the object; see `following_ranges`.
    """
    held: dict[str, IntensityRange] = {}
    if not isinstance(exposure, str):
        for name, limits in exposure:
            # As exact as intensities: a range that is too narrow for them has no extent.
            low, high = (min(limit / picture.scale, LARGEST_SINGLE) for limit in limits)
            held[name] = IntensityRange(float(np.float32(low)), float(np.float32(high)))
    of_picture = following_ranges(picture, scaling, exposure, stage)
    whole = held.get(OBJECT, of_picture[WHOLE])
    least, most = picture.relative_ranges[WHOLE]
    if ambient is not None and OBJECT not in held and most * picture.scale <= ambient * (1 + ROUNDING):
        whole = IntensityRange(least, UNSEEN * max(most, 1.0))
    shares_whole = scaling == "object" or OBJECT in held
    ranges = {WHOLE: whole}
    for surface in picture.slices:
        number = surface.surface_number
        name = picture.surfaces[number - 1]
        own = whole if shares_whole else of_picture[number]
        if name != OBJECT:
            own = held.get(name, own)
        ranges[number] = own if has_extent(own) else whole
    return ranges


def following_ranges(
    picture: Picture, scaling: str, exposure: Exposure, stage: Set[int] = frozenset()
) -> Mapping[int, IntensityRange]:
    """The ranges that follow the picture, by surface number, relative to its scale; the object's is WHOLE.

    With a percentage of the pixels as exposure, the ranges are trimmed, except those of surfaces without
    extent; if the scaling is "object", only WHOLE is trimmed. Of the whole picture, the pixels of the object
    are counted, without those of the `stage` surfaces: a highlight stays one however small the object is.
    """
    ranges = picture.relative_ranges
    if not isinstance(exposure, str) or exposure == AUTO:
        return ranges
    share = Decimal(exposure.removesuffix(" %")) / 100
    own = {surface.surface_number: surface.pixels for surface in picture.slices}
    of_object = [pixels for number, pixels in own.items() if number not in stage]
    places = {WHOLE: of_object or [slice(None)]}
    if scaling == "surface":
        places |= {number: [pixels] for number, pixels in own.items() if has_extent(ranges[number])}
    relative, counts = picture.relative, picture.counts
    trimmed = {
        number: trimmed_range(
            np.concatenate(
                [relative[some] if counts is None else relative[some].repeat(counts[some]) for some in slices]
            ),
            ranges[number],
            share,
        )
        for number, slices in places.items()
    }
    return {**ranges, **trimmed}


def trimmed_range(intensities: Singles, own: IntensityRange, share: Decimal) -> IntensityRange:
    """The range of a share of some intensities, without the brightest; `own` is the range of all of them.

    Of n intensities, the floor of n * (1 - share) are left out, and the maximum of the rest is the maximum of
    the range. This order statistic is one of the intensities, so scaling all light scales the range. If it
    does not exceed the minimum, nothing is left out, or all that is lit would be lost.

    Assumed: the darkest intensities count, because nothing is darker than the ambient light. But the minimum
    of the range is at most MOST_EVEN of its maximum.
    """
    maximum = own.maximum
    above = int(len(intensities) * (1 - share))
    if above:
        trimmed = intensity_below(intensities, above)
        if has_extent(IntensityRange(own.minimum, trimmed)):
            maximum = trimmed
    return IntensityRange(min(own.minimum, float(np.float32(MOST_EVEN * maximum))), maximum)


def intensity_below(intensities: Singles, above: int) -> float:
    """The intensity that is followed by `above` others in rising order.

    A sample gives a threshold, and only the intensities from it on are sorted, unless they are too few.
    Measured: for 213,000 intensities 0.1 ms; sorting all of them as far as needed takes 1.3 ms.
    """
    sample = np.sort(intensities[::SAMPLED])
    candidates = intensities[intensities >= sample[max(0, len(sample) - 2 * (above // SAMPLED) - 8)]]
    if len(candidates) <= above:
        candidates = intensities
    place = len(candidates) - 1 - above
    return float(np.partition(candidates, place)[place])


def held_name(exposure: Exposure, surface: str) -> str:
    """The name of the held range by which a surface is mapped: its own or the object's; empty without any."""
    held = () if isinstance(exposure, str) else [name for name, _ in exposure]
    own = surface if surface != OBJECT else ""
    return next((name for name in (own, OBJECT) if name and name in held), "")


def is_held(exposure: Exposure) -> bool:
    """Whether the range of the object is held, and with it all ranges."""
    return not isinstance(exposure, str) and OBJECT in dict(exposure)


def held_exposure(
    picture: Picture, scaling: str, exposure: Exposure = AUTO, stage: Set[int] = frozenset()
) -> Exposure:
    """The exposure that holds the ranges that are mapped now, so that no word changes.

    A range without extent is not held; if no range has an extent, the exposure stays as it is.
    """
    held = {} if isinstance(exposure, str) else dict(exposure)
    each_has_its_own = scaling == "surface" and OBJECT not in held
    for number, extent in following_ranges(picture, scaling, exposure, stage).items():
        # A trimmed range of one intensity is no range to hold.
        has_range = has_extent(extent) and has_extent(picture.relative_ranges[number])
        if (number == WHOLE or each_has_its_own) and has_range:
            name = picture.surfaces[number - 1] if number else OBJECT
            if number and name == OBJECT:
                continue
            held.setdefault(name, (extent.minimum * picture.scale, extent.maximum * picture.scale))
    return tuple(held.items()) or exposure


@underflowing
def words_of(
    picture: Picture,
    ranges: Mapping[str, LevelRange],
    extents: Mapping[int, IntensityRange],
    mapping: str | CurvePoints = "linear",
    dither: str = "off",
    bands: Mapping[str, Bands] = MappingProxyType({}),
) -> Words:
    """The words of a picture, (lines, elements) uint16, read-only; BACKGROUND where nothing is visible.

    The minimum and the maximum of the range that is mapped for a surface, in `extents` from `mapped_ranges`,
    become its lowest and its highest level; intensities beyond the range become the nearer of the two. If no
    range has an extent, every pixel gets the middle level, which is neither black nor a highlight. On a
    surface with `bands`, the intensity gives the shade and the scalar the band. Raises InputError if an
    intensity is not finite.
    """
    words = np.full(picture.lines * picture.elements, BACKGROUND, np.uint16)
    for surface in picture.slices:
        extent = picture.relative_ranges[surface.surface_number]
        if not (np.isfinite(extent.minimum) and np.isfinite(extent.maximum)):
            name = picture.surfaces[surface.surface_number - 1]
            raise InputError(f"surface {name!r}: an intensity must be finite, not {extent.maximum:g}")
    fractions_of = fractions_by_surface(picture, extents, mapping)
    thresholds = ordered_thresholds(picture.lines, picture.elements) if dither == "ordered" else None
    for chunk in point_chunks(picture.slices):
        intensities, pixels = picture.relative[chunk.pixels], picture.pixels[chunk.pixels]
        here = np.empty(len(pixels), np.uint16)
        for surface in chunk.slices:
            name = picture.surfaces[surface.surface_number - 1]
            first, levels = ranges[name]
            if name in bands:
                levels = bands[name].shades
            fractions = fractions_of[surface.surface_number](intensities[surface.pixels])
            if thresholds is None or not has_extent(extents[surface.surface_number]):
                here_levels = levels_of(fractions, levels, out=fractions)
            else:
                here_levels = dithered_levels(fractions, levels, thresholds.take(pixels[surface.pixels]))
            np.copyto(here[surface.pixels], here_levels, casting="unsafe")
            here[surface.pixels] += np.uint16(first)
            if name in bands and picture.scalar_values is not None:
                values = picture.scalar_values[chunk.pixels][surface.pixels]
                here[surface.pixels] += band_numbers(values, bands[name]) * np.uint16(levels)
        words[pixels] = here
    words.flags.writeable = False
    return words.reshape(picture.lines, picture.elements)


@underflowing
def fractions_by_surface(
    picture: Picture,
    extents: Mapping[int, IntensityRange],
    mapping: str | CurvePoints,
    only: int | None = None,
) -> Mapping[int, Fractions]:
    """The function from the intensities of each visible surface to fractions, 0 to 1, by surface number.

    `extents` is the result of `mapped_ranges`; intensities are relative to the picture's scale. With `only`,
    the result has the function of that surface alone, if it is visible.
    """
    intensities_of = {
        surface.surface_number: picture.relative[surface.pixels]
        for surface in picture.slices
        if only in (None, surface.surface_number)
    }
    functions: dict[int, Fractions] = {}
    for number in intensities_of:
        # Surfaces that are mapped by the whole object's range share one function.
        of = WHOLE if extents[number] is extents[WHOLE] else number
        if of not in functions:
            everything = picture.relative if of == WHOLE else intensities_of[number]
            own = picture.relative_ranges[of]
            if of == WHOLE and picture.apart:
                own = IntensityRange(float(everything.min()), float(everything.max()))
            functions[of] = fraction_of(extents[of], mapping, everything, own)
        functions[number] = functions[of]
    return {number: functions[number] for number in intensities_of}


def levels_of(fractions: Singles, levels: int, out: Singles | None = None) -> Singles:
    """The levels, 0 to levels - 1, for fractions from 0 to 1, as float32; `out` may be `fractions`."""
    scaled = np.multiply(fractions, np.float32(levels - 1), out=out)
    return halves_up(scaled, out=scaled)


def dithered_levels(fractions: Singles, levels: int, thresholds: Singles) -> Singles:
    """The levels, 0 to levels - 1, for fractions from 0 to 1 and a threshold between 0 and 1 for each.

    A fraction between two levels gets the upper level if it exceeds the lower level by more than the
    complement of the threshold. The lowest and the highest level stay whole.
    """
    scaled = fractions * np.float32(levels - 1)
    scaled += thresholds
    levels_below: Singles = np.floor(scaled, out=scaled)
    return levels_below


@lru_cache(maxsize=2)
def ordered_thresholds(lines: int, elements: int) -> Singles:
    """The thresholds of a raster, (lines * elements,) float32: 64 values in tiles of 8 x 8 pixels.

    The order within a tile is that of B. E. Bayer, 1973, "An optimum method for two-level rendition of
    continuous-tone pictures". The mean of the thresholds is a half, so dithering keeps the mean level.
    """
    tile = np.zeros((1, 1))
    for _ in range(3):
        tile = np.block([[4 * tile, 4 * tile + 2], [4 * tile + 3, 4 * tile + 1]])
    tile = (tile + HALF) / tile.size
    line, element = np.arange(lines) % len(tile), np.arange(elements) % len(tile)
    thresholds = tile[np.ix_(line, element)].astype(np.float32).ravel()
    thresholds.flags.writeable = False
    return thresholds


@underflowing
def fraction_of(
    mapped: IntensityRange, mapping: str | CurvePoints, everything: Singles, own: IntensityRange
) -> Fractions:
    """The function from intensities to fractions of a range, 0 to 1; a half for a range without extent.

    `everything` has all intensities that are mapped with this range, and `own` is their own range.
    Intensities beyond the range that is mapped have the fractions of its ends.
    """
    if not has_extent(mapped):
        return lambda intensities: np.full_like(intensities, HALF)
    low, high = np.float32(mapped.minimum), np.float32(mapped.maximum)
    if low <= own.minimum and own.maximum <= high:
        return mapping_curve(mapping)(low, high, everything)
    curve = mapping_curve(mapping)(low, high, np.clip(everything, low, high))
    return lambda intensities: curve(np.clip(intensities, low, high))
