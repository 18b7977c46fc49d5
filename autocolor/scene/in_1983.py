"""A scene as General Motors could have shown it in 1983: what the paper describes, and nothing since.

Departs: this program also has dither, other reflection models, trimmed ranges of intensities and more light
controls, all of them in columns. Here they are set to what the paper has. Paints, scalars and the division of
the words stay: they are data of the table.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from autocolor.scene.lights import Flaps, Light, Links
from autocolor.scene.reflection_models import Phong, ReflectionModel
from autocolor.scene.surfaces import Surface

OF_SCENE: Final[Mapping[str, Any]] = {
    "interpolation": "linear",
    "mapping": "linear",
    "contrast": "stretch",
    "exposure": "auto",
    "dither": "off",
    "words": "levels",
}
"""The columns of a scene, and their values: normals linear in the picture, levels from minimum to maximum."""

OF_LIGHT: Final[Mapping[str, Any]] = {
    "inner_angle": None,
    "half_spaces": (),
    "falloff": "none",
    "at_infinity": False,
    "links": Links(),
}
"""The columns of a light, and their values. Soft edges of flaps become sharp, too."""


def changes_to_1983(surfaces: Sequence[Surface], lights: Sequence[Light]) -> dict[str, Any]:
    """The columns of a scene that change, with its surfaces and lights.

    Every surface has Phong's model, with about the highlight that it has, and an S that does not grow.
    """
    return {
        **OF_SCENE,
        "surfaces": [each.replace(model=Phong(_phong_exponent(each.reflectance.model))) for each in surfaces],
        "lights": [each.replace(**OF_LIGHT, flaps=_sharp(each.flaps)) for each in lights],
    }


def _phong_exponent(model: ReflectionModel) -> float:
    """N of Phong's model with a highlight as wide: E is twice the angle of the half vector."""
    return model.steepness if isinstance(model, Phong) else model.steepness / 4


def _sharp(flaps: Flaps) -> Any:
    """The changes that give flaps sharp edges."""
    return {axis: {"edge_width": 0.0} for axis, flap in vars(flaps).items() if flap is not None}
