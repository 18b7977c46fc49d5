"""Bands: the levels of surfaces that a scalar colors.

Paper: "Introduction": scalar variables such as stress on the surface of an object, in color. The level range
of such a surface is divided into bands, one a color, and each band into shades of the light:

    word = first + band * shades + shade

So band and shade can be read from a word, and another color scale changes entries alone. A scalar that is
shown in flat color codes has one shade. Assumed: values beyond the limits have the first and the last band.
If they have colors of their own, further bands follow for these values, and another band for missing values.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Singles, Words
from autocolor.checks import Color
from autocolor.errors import InputError
from autocolor.immutable import read_only
from autocolor.lighting.picture import Picture
from autocolor.mapping.colors import HALVES_UP
from autocolor.mapping.ranges import BACKDROP, FEWEST_LEVELS, SURFACE_WORDS, USEFUL_LEVELS
from autocolor.scalars.computed import UNIT, widened
from autocolor.scene.color_scales import scale_colors
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface

DARKEST: Final = 0.5
"""Assumed: the brightness of the darkest shade as a fraction of its color. With less, most of a
shiny surface is too dark to recognize its band."""

ROUNDING: Final = 2.0**-20
"""Assumed: the error of interpolation, as a fraction of the larger limit."""

MOST_SHADES: Final = 8
"""Assumed: the shades of each band if no number is asked for; more are hardly visible within a band."""


class Bands(NamedTuple):
    """The division of a surface's levels: `bands` bands of `shades` levels from one limit to the other.

    After them come the bands of values below, above and missing, as far as these have bands of their own.
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
        """The band number for missing values, if they have a band."""
        return self.bands + self.has_below + self.has_above

    def brightest(self, band: int) -> int:
        """The highest level of a band."""
        return (band + 1) * self.shades - 1


def band_numbers(values: Singles, bands: Bands) -> Words:
    """The band of each value: floor((value - low) / (high - low) * bands) between the limits.

    A value at the upper limit is in the last band. Assumed: a value that is beyond a limit, or below the edge
    of a band, by no more than rounding counts as the limit or the edge. Otherwise single pixels would have
    the color of values beyond it, and a wall whose value is that of an edge two colors.

    >>> band_numbers(np.array([0, 2.4, 2.5, 2.499998, 10, 11], np.float32), Bands(0, 10, 4, 1)).tolist()
    [0, 0, 1, 1, 3, 3]
    """
    low, high, count = bands[:3]
    exact = values.astype(np.float64)
    is_missing = np.isnan(exact)
    exact[is_missing] = low
    rounding = ROUNDING * max(abs(low), abs(high))
    is_below, is_above = exact < low - rounding, exact > high + rounding
    # Values far beyond the limits would be beyond the integers, too.
    np.clip(exact, low, high, out=exact)
    # numpy 1 tells of an overflow of numbers that are not in the array, where the limits are close together.
    with np.errstate(over="ignore"):
        fractions = (exact - low + rounding) / (high - low)
    numbers = np.minimum(np.floor(fractions * count), count - 1).astype(np.uint16)
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

    The bands have the colors of the scale; `ends` are the colors below and above the limits, or None. The
    highest shade of a band has its color; `floor` is the brightness of the lowest shade as a fraction of it.
    """
    beyond = [color for color in ends if color is not None]
    colors = np.vstack([scale_colors(scale, bands.bands), *beyond, *[missing] * bands.has_missing])
    top = bands.shades - 1
    shares = floor + (1 - floor) * np.arange(bands.shades) / top if top else np.ones(1)
    entries = np.floor(colors[:, np.newaxis].astype(np.float64) * shares[:, np.newaxis] + HALVES_UP)
    return read_only(entries.astype(np.uint8).reshape(-1, 3))


def bands_by_surface(scene: Scene, picture: Picture) -> Mapping[str, Bands]:
    """The bands of each surface in use that the scalar colors, by name; none without a scalar.

    All bands have the same number of shades. Raises InputError if the words do not suffice for them.
    """
    scalar, values = scene.scalar, picture.scalar_values
    if scalar is None or values is None:
        return {}
    low, high = scalar.limits or own_limits(picture)
    colored = colored_surfaces(scene)
    seen = scene.staged
    used = {seen.parts[number].surface for number in seen.mesh.parts_in_use}
    lacking = {
        picture.surfaces[each.surface_number - 1]
        for each in picture.slices
        if np.isnan(values[each.pixels]).any()
    }
    rows = [surface for surface in scene.surfaces if surface.name in used]
    # No value of the object is beyond the scalar's own range; stage values beyond it have the end colors.
    has_ends = scalar.limits is not None
    has_below, has_above = has_ends and scalar.below is not None, has_ends and scalar.above is not None
    bands = {
        row.name: Bands(low, high, scalar.bands, 1, has_below, has_above, row.name in lacking)
        for row in rows
        if row.name in colored
    }
    words = SURFACE_WORDS - BACKDROP.levels * scene.has_backdrop
    shades = _shades(scalar, rows, bands, words) if bands else 1
    return {name: each._replace(shades=shades) for name, each in bands.items()}


def colored_surfaces(scene: Scene) -> Sequence[str]:
    """The names of the surfaces that the scalar colors; by default all but the surfaces of the stage."""
    if scene.scalar is None:
        return ()
    if scene.scalar.surfaces is not None:
        return scene.scalar.surfaces
    return tuple(dict.fromkeys(part.surface for part in scene.parts if not part.stage))


def own_limits(picture: Picture) -> tuple[float, float]:
    """The own range of the scalar of a picture, where its first band begins and its last band ends.

    It does not depend on the color scale: if it were symmetric for a diverging scale, another scale would
    change words. A picture that was made of rasters may have a range without extent; it is `widened`.
    """
    return widened(*(picture.scalar_limits or UNIT))


def _shades(scalar: Scalar, surfaces: Sequence[Surface], bands: Mapping[str, Bands], words: int) -> int:
    """The shades of each band: the scalar's number if it has any, else as many as the words suffice for.

    Assumed: the levels that a colored surface asks for are meant for its paint, and its bands take the levels
    that they need. The other surfaces have the levels that they ask for. A surface that asks for none has at
    least FEWEST_LEVELS, or USEFUL_LEVELS if the shades can be chosen. Raises InputError if there are too few
    words.
    """
    others = [surface.levels for surface in surfaces if surface.name not in bands]
    left = words - sum(filter(None, others))
    room, useful = (left - others.count(None) * fewest for fewest in (FEWEST_LEVELS, USEFUL_LEVELS))
    if room < 0:
        # The other surfaces ask for too much; `level_ranges` refuses that.
        return 1
    total = sum(each.total for each in bands.values())
    shades = scalar.shades or max(1, min(MOST_SHADES, useful // total))
    if total * shades > room:
        first, *more = bands
        raise InputError(_refusal(first, len(more), total, shades, room))
    return shades


def _refusal(name: str, others: int, total: int, shades: int, room: int) -> str:
    """The message about bands and shades for which there are too few words.

    `total` is the number of bands of all surfaces that the scalar colors, `others` the number of these
    surfaces besides the named one, and `room` the number of words.
    """
    label = f"surface {name!r}" + (f" and {others} more" if others else "")
    most = room // total
    remedy = (
        f"choose at most {most} shade{'s' * (most > 1)}, or fewer bands"
        if most
        else "choose fewer bands, or color fewer surfaces"
    )
    return (
        f"{label}: bands times shades must be at most {room}, the words that are left, not {total} x {shades}"
        f" = {total * shades}; {remedy}"
    )
