"""The lookup table entries of a surface: its object color blended with the light color, or its ramp.

Paper: "Light Source Color Blending", Figure 12. Levels up to the blend level are taken as
purely diffuse; above it the color shifts to the specular color in N equal steps. The method assumes that the
brightest points have the color of the light; it is not a physical prediction of color.

The module also has the white of a color, and colors by hue.
"""

from __future__ import annotations

import colorsys
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import HALF, Bytes, Floats, Singles, half_up
from autocolor.checks import Color
from autocolor.immutable import read_only
from autocolor.scene.surfaces import Paint

HALVES_UP: Final = (HALF + 1e-9,) * 3
"""Added to a blended color before it is truncated, to round it half up.

The small excess makes up for floating-point error, which may leave a half just below a half.
"""

FULL: Final = 255
"""The largest component of a color."""

AMOUNTS: Final = np.arange(-FULL, FULL + 1)
"""The amounts that can be added to the components."""


def blend_level(blend: float, levels: int) -> int:
    """The highest level that shows the object color alone."""
    return half_up(blend * (levels - 1))


def blend_from(level: int, levels: int) -> float:
    """The blend that has a given blend level, in as few digits as possible, but at least two.

    >>> blend_from(124, 249), blend_from(136, 249), blend_from(137, 249)
    (0.5, 0.55, 0.552)
    """
    blend = level / max(levels - 1, 1)
    rounded = (round(blend, digits) for digits in range(2, 9))
    return next((each for each in rounded if blend_level(each, levels) == level), blend)


@lru_cache(maxsize=512)
def entries_of(paint: Paint, levels: int, floor: float = 0.0) -> Bytes:
    """The entries of a paint, (levels, 3) uint8, read-only: red, green, blue, from the lowest level up.

    The blended colors are darkened in proportion to the level. `floor` is the brightness of the lowest level
    as a fraction of the highest: with 0 the lowest level is black; with minimum / maximum of the surface's
    intensities, brightness is proportional to intensity.

    Paper: a weight that grows by 1 / N for each of the N levels above the blend level; "another control
    should be added to adjust the percentage of the specular color at the maximum intensity". Assumed: the
    blend weights the two colors and the level darkens the result, so that blending two equal colors changes
    nothing. With a blend of 1 there is no shift.

    A ramp gives the colors of all levels by itself, without darkening or `floor`. Its colors are at equal
    distances, the first at the lowest level and the last at the highest. Each component is linear between two
    colors, and rounded half up, in whole numbers: a ramp of `levels` colors gives just these. A single level
    has the first color.
    """
    if paint.ramp is not None:
        return ramp_entries(paint.ramp, levels)
    return _blended(paint, color_shares(paint.blend, paint.light_percentage, levels, floor))


def entries_at(paint: Paint, fractions: Singles, levels: int, floor: float = 0.0) -> Bytes:
    """The entries of a paint at fractions of a range of levels, (n, 3) uint8, read-only.

    A fraction of the range is a level between the whole levels of `entries_of`; its color is computed alike.
    """
    if paint.ramp is not None:
        return _of_ramp_at(paint.ramp, fractions)
    level = fractions.astype(np.float64) * (levels - 1)
    return _blended(paint, _shares_at(level, paint.blend, paint.light_percentage, levels, floor))


def ramp_entries(ramp: tuple[Color, ...], levels: int) -> Bytes:
    """The colors of a ramp at each level, (levels, 3) uint8, read-only."""
    colors = np.array(ramp, np.int64)
    steps, last = max(levels - 1, 1), len(ramp) - 1
    place = np.arange(levels) * last
    below = np.minimum(place // steps, last - 1)
    above_share = (place - below * steps)[:, None]
    sums = colors[below] * (steps - above_share) + colors[below + 1] * above_share
    return read_only(((2 * sums + steps) // (2 * steps)).astype(np.uint8))


def _of_ramp_at(ramp: tuple[Color, ...], fractions: Singles) -> Bytes:
    """The colors of a ramp at fractions of its length, (n, 3) uint8, read-only."""
    colors, places = np.array(ramp, np.float64), np.arange(len(ramp))
    place = fractions.astype(np.float64) * (len(ramp) - 1)
    mixed = [np.interp(place, places, component) for component in colors.T]
    return read_only((np.stack(mixed, axis=1) + HALVES_UP).astype(np.uint8))


def _blended(paint: Paint, shares: Floats) -> Bytes:
    """The colors of a paint, (n, 3) uint8, read-only, by the weights of its two colors, (n, 3)."""
    # Blend and round in one matrix product. Measured with cold caches, where the calls cost more than the
    # arithmetic: a separate rounding, or "@" instead of "dot", takes 1.4 times as long; both take twice.
    colors = np.array((paint.object_color, paint.light_color, HALVES_UP), np.float64)
    entries: Bytes = shares.dot(colors).astype(np.uint8)
    entries.setflags(write=False)
    return entries


@lru_cache(maxsize=128)
def color_shares(blend: float, percentage: float, levels: int, floor: float) -> Floats:
    """The weights of the object color, the light color and the rounding term at each level, (levels, 3).

    The weight of the light color is 0 up to the blend level; that of the rounding term is always 1.
    """
    return _shares_at(np.arange(levels, dtype=np.float64), blend, percentage, levels, floor)


def _shares_at(level: Floats, blend: float, percentage: float, levels: int, floor: float) -> Floats:
    """The weights of `color_shares` at some levels, (n, 3), read-only."""
    begin = blend_level(blend, levels)
    weight = np.maximum(level - begin, 0) / max(levels - 1 - begin, 1) * (percentage / 100)
    share = floor + (1 - floor) * level / max(levels - 1, 1)
    shares = np.stack([(1 - weight) * share, weight * share, np.ones(len(level))], axis=1)
    shares.flags.writeable = False
    return shares


def white_of(color: Color) -> int:
    """The white of a color: the mean of its components, 0 to 255.

    Paper: Figure 13. "The white bar can be used to quickly increase or decrease all three color components
    equally to generate tints or shades." Assumed: with the mean, the bar is empty for black alone and full
    for white alone.

    >>> white_of((255, 0, 0)), white_of((10, 20, 31))
    (85, 20)
    """
    return half_up(sum(color) / 3)


def with_white(color: Color, white: int) -> Color:
    """The color with the same amount added to each component, such that their mean is `white`, 0 to 255.

    Assumed: a component that reaches 0 or 255 stays there while the others go on; otherwise a full red would
    have no tints. Ties go to the lower amount.

    >>> with_white((255, 0, 0), 135), with_white((100, 60, 20), 40)
    ((255, 75, 75), (80, 40, 0))
    """
    tints = np.clip(np.array(color) + AMOUNTS[:, None], 0, FULL)
    red, green, blue = tints[np.abs(tints.sum(axis=1) - 3 * white).argmin()].tolist()
    return red, green, blue


class Hsv(NamedTuple):
    """A color by its hue in degrees, 0 to 360, and its saturation and value in percent, 0 to 100."""

    hue: float
    saturation: float
    value: float


def hsv_of(color: Color) -> Hsv:
    """The hue, saturation and value of a color, not rounded; the hue of a gray is 0.

    >>> hsv_of((255, 128, 0)).saturation, hsv_of((64, 64, 64)).hue
    (100.0, 0.0)
    """
    hue, saturation, value = colorsys.rgb_to_hsv(*[part / FULL for part in color])
    return Hsv(360 * hue, 100 * saturation, 100 * value)


def color_of_hsv(hsv: Hsv) -> Color:
    """The color that is nearest to a hue, saturation and value; `hsv_of` of a color gives the color back.

    >>> color_of_hsv(Hsv(210, 100, 50)), color_of_hsv(Hsv(360, 100, 100))
    ((0, 64, 128), (255, 0, 0))
    """
    parts = colorsys.hsv_to_rgb(hsv.hue / 360, hsv.saturation / 100, hsv.value / 100)
    red, green, blue = [half_up(FULL * part) for part in parts]
    return red, green, blue
