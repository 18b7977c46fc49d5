"""Exposure: the range of intensities that the levels of each surface show.

Paper: "The Lighting Model": the minimum and the maximum intensity of each surface, or of the entire object,
are mapped to the display. Departs: a scene can hold ranges, which then do not follow the picture, so that
less light looks darker; intensities beyond a held range are shown as its nearest end.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from autocolor.arrays import LARGEST_SINGLE
from autocolor.lighting.picture import IntensityRange, Picture
from autocolor.scene.scene import AUTO, OBJECT, Exposure

WHOLE: Final = 0
"""The number of the whole object's range, beside those of the surfaces."""

ROUNDING: Final = 2.0**-20
"""Assumed: eight units in the last place of float32, which a sum of lights may be off by."""


def has_extent(extent: IntensityRange) -> bool:
    """Whether the minimum and the maximum differ by more than float32 rounding.

    >>> has_extent(IntensityRange(0.25, 0.5)), has_extent(IntensityRange(0.5, 0.5000001))
    (True, False)
    """
    return extent.maximum - extent.minimum > ROUNDING * extent.maximum


def mapped_ranges(picture: Picture, scaling: str, exposure: Exposure) -> Mapping[int, IntensityRange]:
    """The range that is mapped to the levels of each visible surface, by number; the whole object's is WHOLE.

    Intensities are relative to the picture's scale. A surface has its held range; else the object's, if that
    is held or the scaling is "object"; else its own in the picture. One without extent has the object's.
    Assumed: an unlit floor has the intensity of the ambient light all over, and should look as dark as that
    is beside the rest.
    """
    held: dict[str, IntensityRange] = {}
    if not isinstance(exposure, str):
        for name, limits in exposure:
            # As exact as intensities are, so that what is too narrow for them has no extent.
            low, high = (min(limit / picture.scale, LARGEST_SINGLE) for limit in limits)
            held[name] = IntensityRange(float(np.float32(low)), float(np.float32(high)))
    found = picture.relative_ranges
    whole = held.get(OBJECT, found[WHOLE])
    shares_whole = scaling == "object" or OBJECT in held
    ranges = {WHOLE: whole}
    for surface in picture.slices:
        number = surface.surface_number
        name = picture.surfaces[number - 1]
        own = whole if shares_whole else found[number]
        if name != OBJECT:
            own = held.get(name, own)
        ranges[number] = own if has_extent(own) else whole
    return ranges


def held_exposure(picture: Picture, scaling: str, exposure: Exposure = AUTO) -> Exposure:
    """The exposure that holds the ranges that are mapped now, so that no word changes.

    A range without extent is not held; the result is AUTO if none has one.
    """
    held = {} if isinstance(exposure, str) else dict(exposure)
    each_has_its_own = scaling == "surface" and OBJECT not in held
    for number, extent in picture.relative_ranges.items():
        if (number == WHOLE or each_has_its_own) and has_extent(extent):
            name = picture.surfaces[number - 1] if number else OBJECT
            if number and name == OBJECT:
                continue
            held.setdefault(name, (extent.minimum * picture.scale, extent.maximum * picture.scale))
    return tuple(held.items()) or AUTO
