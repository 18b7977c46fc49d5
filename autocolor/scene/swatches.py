"""Paints to pick from: swatches, a field of colors, and finishes, which look like plastic, metal or glass.

The columns of swatches are hues. The rows go from light to dark, and then to muted paints. Grays are at the
left, and paints of cars of the time at the right. Lightness and hue are coordinates of Oklab (B. Ottosson,
2020, "A perceptual color space for image processing"), in which equal steps look about equal. The chroma of a
hue is a share of the largest that a monitor can show at its lightness, up to a limit. Assumed: the rows, the
limits and the paints of cars.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Floats, components_of
from autocolor.checks import Color, nearest, shown
from autocolor.errors import UsageError
from autocolor.immutable import read_only
from autocolor.scene.changes import SurfaceChanges
from autocolor.scene.surfaces import Surface

FIRST_HUE: Final = 20.0
"""The angle of the first hue in Oklab, in degrees: red."""

HUES: Final = 18


class Shade(NamedTuple):
    """A row of hues: their lightness, from 0 to 1, and their chroma, as a share of the largest possible."""

    lightness: float
    share: float
    most: float = 0.4


SHADES: Final = (
    Shade(0.92, 0.80, 0.07),
    Shade(0.86, 0.92, 0.16),
    Shade(0.78, 0.94, 0.19),
    Shade(0.69, 0.96),
    Shade(0.60, 0.96),
    Shade(0.51, 0.96),
    Shade(0.42, 0.96),
    Shade(0.33, 0.96),
    Shade(0.72, 0.40, 0.06),
    Shade(0.48, 0.40, 0.06),
)
"""Rows of light, full and dark paints, and two rows of muted paints."""

GRAYS: Final = (1.0, 0.92, 0.84, 0.75, 0.66, 0.57, 0.48, 0.38, 0.28, 0.0)
"""The lightness of the grays, from white to black."""

CAR_PAINTS: Final = (
    (242, 238, 226), (214, 200, 168), (196, 200, 204), (224, 176, 48), (214, 92, 28),
    (176, 16, 32), (108, 20, 28), (30, 74, 128), (22, 62, 48), (16, 18, 22),
)  # fmt: skip
"""Cream, champagne, silver, gold, orange, red, maroon, blue, racing green, black."""

ROWS: Final = len(SHADES)
COLUMNS: Final = HUES + 2


@cache
def swatches() -> Bytes:
    """The colors of the field, (ROWS * COLUMNS, 3) uint8, read-only, row by row from left to right."""
    field = np.empty((ROWS, COLUMNS, 3), np.uint8)
    hues = np.radians(FIRST_HUE + np.arange(HUES) * 360 / HUES)
    around = np.stack([np.cos(hues), np.sin(hues)], axis=1)
    for row, shade in enumerate(SHADES):
        chroma = np.minimum(shade.share * _strongest(shade.lightness, around), shade.most)
        field[row, 1:-1] = _bytes(_oklab(shade.lightness, around, chroma))
    field[:, 0] = _bytes(_oklab(np.array(GRAYS), np.zeros((ROWS, 2)), np.zeros(ROWS)))
    field[:, -1] = CAR_PAINTS
    return read_only(field.reshape(-1, 3))


def _oklab(lightness: float | Floats, around: Floats, chroma: Floats) -> Floats:
    """Colors in Oklab, (n, 3), of hues as unit vectors (n, 2)."""
    return np.column_stack([np.broadcast_to(lightness, len(around)), around * chroma[:, None]])


def _strongest(lightness: float, around: Floats) -> Floats:
    """The largest chroma of each hue that a monitor can show, (n,), found by bisection."""
    low, high = np.zeros(len(around)), np.full(len(around), 0.5)
    for _ in range(24):
        middle = (low + high) / 2
        linear = _linear(_oklab(lightness, around, middle))
        is_shown = ((linear >= 0) & (linear <= 1)).all(axis=1)
        low, high = np.where(is_shown, middle, low), np.where(is_shown, high, middle)
    return low


# Ottosson's matrices: to the cube roots of the responses of the cones, and from the responses to linear sRGB.
CONES: Final = np.array(
    [
        [1.0, 0.3963377774, 0.2158037573],
        [1.0, -0.1055613458, -0.0638541728],
        [1.0, -0.0894841775, -1.2914855480],
    ]
)
LINEAR: Final = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
)


def _linear(oklab: Floats) -> Floats:
    """Linear red, green and blue, (n, 3), of colors in Oklab; beyond 0 to 1 if no monitor can show them."""
    linear: Floats = (oklab @ CONES.T) ** 3 @ LINEAR.T
    return linear


def _bytes(oklab: Floats) -> Bytes:
    """The colors, (n, 3) uint8, rounded half up."""
    return components_of(np.clip(_linear(oklab), 0, 1))


WHITE: Final = (255, 255, 255)
DULL: Final = (96, 96, 100)
"""The gray of a highlight on a surface that scatters most of the light."""


@dataclass(frozen=True)
class Finish:
    """The reflectance and the blending of a finish. A surface with a finish keeps its object color.

    The light color is a mix of the object color and `light`, with the share `share` of `light`. Plastic and
    glass reflect light in its own color; a metal colors it. Paper: "Light Source Color Blending", Figure 15C:
    blending from the lowest level on looks like metallic paint.
    """

    diffuse: float
    specular: float
    exponent: float
    share: float
    blend: float
    light_percentage: float = 100.0
    light: Color = WHITE


FINISHES: Final[dict[str, Finish]] = {
    "plastic": Finish(0.7, 0.35, 12, share=1.0, blend=0.7, light_percentage=70.0),
    "paint": Finish(0.62, 0.62, 90, share=1.0, blend=0.6),
    "metallic": Finish(0.7, 0.6, 26, share=0.85, blend=0.0, light_percentage=90.0),
    "metal": Finish(0.35, 0.95, 14, share=0.65, blend=0.12),
    "rubber": Finish(0.8, 0.15, 4, share=0.65, blend=0.1, light=DULL),
    "glass": Finish(0.2, 1.0, 110, share=1.0, blend=0.3),
}
"""Assumed: all the numbers, chosen by looking at the coupe in its studio lights. Menus have this order."""


def finished(surface: Surface, name: str) -> SurfaceChanges:
    """The changes that give a surface a finish, for `scene.with_surface(surface.name, **changes)`.

    They leave its object color, `levels` and `two_sided`; a surface with a ramp gets the color in the middle
    of the ramp as its object color. Raises UsageError, with the closest name, for an unknown finish.
    """
    if name not in FINISHES:
        raise UsageError(f"there is no finish {shown(name)}{nearest(name, FINISHES)}")
    finish = FINISHES[name]
    return {
        "diffuse": finish.diffuse,
        "specular": finish.specular,
        "model": "phong",
        "exponent": finish.exponent,
        "object_color": surface.paint.color,
        "light_color": mixed(surface.paint.color, finish.light, finish.share),
        "blend": finish.blend,
        "light_percentage": finish.light_percentage,
    }


def mixed(color: Color, other: Color, share: float) -> Color:
    """A mix of two colors with a share of the second, from 0 to 1; components are rounded half up.

    >>> mixed((176, 16, 33), (255, 255, 255), 0.5)
    (216, 136, 144)
    """
    red, green, blue = (int(one + share * (two - one) + 0.5) for one, two in zip(color, other, strict=True))
    return red, green, blue
