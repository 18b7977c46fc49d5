"""Paints to pick from: swatches, a field of colors, and finishes, which look like plastic, metal or glass.

The columns of swatches are hues. The rows go from light to dark, and then to muted paints. Grays are at the
left, and paints of cars of the time at the right: cream, champagne, silver, gold, orange, red, maroon, blue,
racing green, black. Lightness and hue are coordinates of Oklab (B. Ottosson, 2020, "A perceptual color space
for image processing"), in which equal steps look about equal: 18 hues 20 degrees apart, each with nearly the
largest chroma that a monitor can show at its lightness, up to a limit. Assumed: the rows, the limits and the
paints of cars.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.checks import Color, nearest, shown
from autocolor.errors import UsageError
from autocolor.immutable import read_only
from autocolor.scene.changes import SurfaceChanges
from autocolor.scene.surfaces import Surface

SWATCHES: Final = """
    ffffff fadddc faded4 fadfca fae1b8 efe6b1 deecb8 cdf1c5 bdf4d5 b1f5e6
    adf3f7 c4ecfa d1e8fa d9e5fa e0e3fa e8e0fa f4dafa fadaee fadbe3 f2eee2
    e4e4e4 fcbfbe fcc2ae fcc498 fbc86d ead33f c4e05c 96ea83 5cf1ac 3eefd5
    3eebf4 87e0fb a7d8fb b9d2fb c8cdfb d8c7fb f0bbfb fcb9e5 fcbdcf d6c8a8
    cacaca fb9797 fb9b79 fb9e4a eaab27 ceb927 aac628 6dd456 2ed792 2ed3bb
    2dcfd7 2dcaf2 6bc1fb 90b8fb aab0fb c4a5fb e790fb fb8ad8 fb92b4 c4c8cc
    aeaeae fc5e68 fc6427 df8018 c79018 b09c19 90a819 40b919 1db77a 1db39e
    1db0b7 1daccf 1ca5ef 5f9afb 8a8dfb ae7bfb dd52fb fc3acd fc5396 e0b030
    929292 ea1942 d54e12 b96912 a57712 918112 768b13 349913 169765 169483
    169197 168eab 1589c6 2878fa 6e66fa 9b49fa c31ae3 d718ae e3197a d65c1c
    777777 bd1233 ab3d0c 95530c 845e0c 74670c 5e6f0d 287a0d 10794f 107668
    0f7479 0f7189 0f6d9f 0b5cd5 5830f9 8215e1 9c13b6 ad118b b71161 b01020
    5d5d5d 910b25 832d07 723e07 654707 584e07 475407 1c5d07 095c3b 095a4f
    09585c 095669 08527a 0645a4 4311cb 630ead 780b8c 850b6a 8c0b49 6c141c
    424242 680518 5d1e03 502b03 473103 3d3603 313b03 114104 044028 043f36
    043e40 043c4a 043957 033076 2e0993 46077c 550664 5f054b 640533 1e4a80
    292929 c89695 c69889 c19c7f b8a17a ada67b 9fab80 91ae8b 84b198 81b0a6
    81aeb1 80adbb 83aac7 90a6ca 9da1ca aa9dc5 b699bc bf96b0 c595a3 163e30
    000000 7c504f 7b5244 715844 6a5b44 635e44 5a6244 4b6646 486555 48645e
    486365 48636b 476174 4a5e80 575a7f 63567b 6d5373 755068 7a4f5c 101216
"""
"""The hexadecimal colors of the field, ROWS rows from left to right, each on two lines."""

ROWS: Final = 10
COLUMNS: Final = 20

CAR_PAINTS: Final = (
    "cream", "champagne", "silver", "gold", "orange", "red", "maroon", "blue", "racing green", "black"
)  # fmt: skip
"""The names of the paints of cars: the last column of the field, from the top."""


@cache
def swatches() -> Bytes:
    """The colors of the field, (ROWS * COLUMNS, 3) uint8, read-only, row by row from left to right."""
    return read_only(np.frombuffer(bytes.fromhex(SWATCHES), np.uint8).reshape(-1, 3))


def car_paints() -> dict[str, Color]:
    """The colors of CAR_PAINTS by name."""
    return dict(zip(CAR_PAINTS, map(tuple, swatches()[COLUMNS - 1 :: COLUMNS].tolist()), strict=True))


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
