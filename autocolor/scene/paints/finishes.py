"""Finishes: what makes a surface look like plastic, paint, metal, rubber or glass, in any color.

Paper: "Light Source Color Blending", Figure 15C: blending from the lowest level on looks like metallic paint.
Assumed: all the numbers, which were chosen by looking at the coupe in its studio lights.

A finish keeps the object color. Its light color is the object color, brought toward the color of the light by
a share: what reflects at its surface, as plastic and glass do, has the color of the light; a metal colors it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from autocolor.checks import Color, nearest, shown
from autocolor.errors import UsageError
from autocolor.scene.changes import SurfaceChanges
from autocolor.scene.surfaces import Surface

WHITE: Final = (255, 255, 255)
DULL: Final = (96, 96, 100)
"""The gray of a highlight on what scatters most of the light."""


@dataclass(frozen=True)
class Finish:
    """The reflectance and the blending of a finish.

    The light color is the object color, brought toward `light` by `share`, from 0 to 1.
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
"""The finishes by name, in the order of a menu."""


def finished(surface: Surface, name: str) -> SurfaceChanges:
    """The changes that give a surface a finish, for `scene.with_surface(surface.name, **changes)`.

    Its object color, its levels and its sides stay. Raises UsageError, with the closest name, for an unknown
    finish.
    """
    if name not in FINISHES:
        raise UsageError(f"there is no finish {shown(name)}{nearest(name, FINISHES)}")
    finish = FINISHES[name]
    return {
        "diffuse": finish.diffuse,
        "specular": finish.specular,
        "model": "phong",
        "exponent": finish.exponent,
        "light_color": mixed(surface.paint.object_color, finish.light, finish.share),
        "blend": finish.blend,
        "light_percentage": finish.light_percentage,
    }


def mixed(color: Color, other: Color, share: float) -> Color:
    """The color, brought toward another by a share from 0 to 1; each component is rounded half up.

    >>> mixed((176, 16, 33), (255, 255, 255), 0.5)
    (216, 136, 144)
    """
    red, green, blue = (int(one + share * (two - one) + 0.5) for one, two in zip(color, other, strict=True))
    return red, green, blue
