"""The level of an intensity, its word, and the color of the entry.

Paper: "The Lighting Model": the minimum and the maximum of a range become its lowest and highest level.
"Light Source Color Blending", Figures 11 and 12: the word is the first word of the surface plus the level,
and the entry blends the two colors of the surface. `mapping` has the formulas.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from autocolor.arrays import HALF
from autocolor.checks import Color
from autocolor.explanation.point import PointExplained
from autocolor.mapping.bands import DARKEST, Bands, band_numbers
from autocolor.mapping.colors import color_shares
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import (
    WHOLE,
    fractions_by_surface,
    has_extent,
    held_name,
    ordered_thresholds,
    ranges_of,
)


@dataclass(frozen=True)
class ScalarExplained:
    """The value of the scalar, None where it is missing, and its band among the bands of the surface."""

    name: str
    value: float | None
    minimum: float
    maximum: float
    band: int
    bands: int
    shades: int
    band_color: Color


@dataclass(frozen=True)
class LevelExplained:
    """The level of the intensity within the range that is mapped, and the entry of that level.

    The range belongs to `range_of`, "surface" or "object". `fraction` is the intensity's fraction of the
    range, 0 to 1, and `mapped_fraction` the same after the mapping curve. The level is mapped_fraction
    (levels - 1) + `threshold`, rounded down; without dithering the threshold is a half. On a surface that a
    scalar colors, it is the level of a shade within the band. `light_share` is the weight of the light color
    in the entry, `brightness` the share of the color that the level leaves.

    If the surface has a ramp, `ramp_color` is the number, counted from 1, of the ramp's last color at or
    below the level. It stands in place of the object color, and the next color in place of the light color.
    """

    range_of: str
    is_held: bool
    minimum: float
    maximum: float
    fraction: float
    mapped_fraction: float
    threshold: float
    level: int
    levels: int
    first_word: int
    scalar: ScalarExplained | None
    object_color: Color
    light_color: Color
    light_share: float
    brightness: float
    ramp_color: int | None


def level_explained(image: DisplayImage, at: PointExplained, place: int) -> LevelExplained:
    """The level at a visible point of an image whose words stand for levels; `place` is that of the point."""
    scene, picture = image.scene, image.mapped
    paint = scene.surfaces[at.surface - 1].paint
    first, levels = image.ranges[at.surface_name]

    # The fraction of the range that is mapped.
    extents = ranges_of(scene, picture)
    extent, relative = extents[at.surface], picture.relative[place : place + 1]
    low, high = extent.minimum, extent.maximum
    fraction = HALF
    if has_extent(extent):
        fraction = min(max((float(relative[0]) - low) / (high - low), 0.0), 1.0)
    fractions = fractions_by_surface(picture, extents, scene.mapping, only=at.surface)[at.surface]
    mapped = float(fractions(relative.copy())[0])

    # The level, of the surface or of the shades of a band.
    bands, darkest = image.bands.get(at.surface_name), image.floor_of(at.surface_name)
    if bands is not None:
        levels = bands.shades
        darkest = darkest if scene.contrast == "floor" else DARKEST
    threshold = HALF
    if scene.dither == "ordered" and has_extent(extent):
        threshold = float(ordered_thresholds(picture.lines, picture.elements)[picture.pixels[place]])
    level = math.floor(mapped * (levels - 1) + threshold)

    # The color of its entry.
    brightness = darkest + (1 - darkest) * level / (levels - 1) if levels > 1 else 1.0
    ramp_color, colors, share = None, (paint.object_color, paint.light_color), 0.0
    if bands is None and paint.ramp is not None:
        brightness = 1.0
        ramp_color, share = ramp_place(len(paint.ramp), level, levels)
        colors = paint.ramp[ramp_color - 1], paint.ramp[ramp_color]
    elif bands is None:
        _, share, _ = color_shares(paint.blend, paint.light_percentage, levels, 1.0)[level].tolist()
    return LevelExplained(
        range_of="object" if extent is extents[WHOLE] else "surface",
        is_held=bool(held_name(scene.exposure, at.surface_name)),
        minimum=low * picture.scale,
        maximum=high * picture.scale,
        fraction=fraction,
        mapped_fraction=mapped,
        threshold=threshold,
        level=level,
        levels=levels,
        first_word=first,
        scalar=None if bands is None else scalar_explained(image, bands, first, place),
        object_color=colors[0],
        light_color=colors[1],
        light_share=share,
        brightness=brightness,
        ramp_color=ramp_color,
    )


def word_of(level: LevelExplained) -> int:
    """The word of a level: the first word of the surface, the bands below, and the level."""
    below = 0 if level.scalar is None else level.scalar.band * level.scalar.shades
    return level.first_word + below + level.level


def ramp_place(colors: int, level: int, levels: int) -> tuple[int, float]:
    """The number, from 1, of the color of a ramp before a level, and the weight of the next color there.

    >>> ramp_place(3, 60, 101), ramp_place(3, 100, 101)
    ((2, 0.2), (2, 1.0))
    """
    steps = max(levels - 1, 1)
    before = min(level * (colors - 1) // steps, colors - 2)
    return before + 1, (level * (colors - 1) - before * steps) / steps


def scalar_explained(image: DisplayImage, bands: Bands, first_word: int, place: int) -> ScalarExplained:
    """The value of the scene's scalar at a visible point, and its band."""
    scalar, values = image.scene.scalar, image.mapped.scalar_values
    assert scalar is not None
    assert values is not None
    value = float(values[place])
    number = int(band_numbers(values[place : place + 1], bands)[0])
    # The highest shade of a band has its color.
    red, green, blue = image.entries[first_word + bands.brightest(number)].tolist()
    return ScalarExplained(
        scalar.name,
        None if math.isnan(value) else value,
        bands.low,
        bands.high,
        number,
        bands.bands,
        bands.shades,
        (red, green, blue),
    )
