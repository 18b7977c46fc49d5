"""A scene as General Motors could have shown it in 1983: what the paper describes, and nothing since.

Departs: this program has interpolated normals on the surface, trimmed ranges of intensities, dither, other
reflection models and more light controls, all of them in columns. Here they are set to what the paper has.
Paints, scalars and the division of the words stay: they are data of the table.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, Final

from autocolor.scene.lights import Flap, Flaps, Light, Links
from autocolor.scene.reflection_models import BlinnPhong, CookTorrance, Phong, ReflectionModel
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
    return {**OF_SCENE, "surfaces": tuple(map(_surface, surfaces)), "lights": tuple(map(_light, lights))}


def _surface(surface: Surface) -> Surface:
    reflectance = surface.reflectance
    model = Phong(_phong_exponent(reflectance.model))
    return surface.replace(reflectance=dataclasses.replace(reflectance, model=model))


def _phong_exponent(model: ReflectionModel) -> float:
    """N of Phong's model with a highlight as wide: E is twice the angle of the half vector."""
    if isinstance(model, (BlinnPhong, CookTorrance)):
        return model.steepness / 4
    return model.steepness


def _light(light: Light) -> Light:
    flaps = {axis: _sharp(flap) for axis, flap in vars(light.flaps).items()}
    return light.replace(**OF_LIGHT, flaps=Flaps(**flaps))


def _sharp(flap: Flap | None) -> Flap | None:
    return None if flap is None else flap.replace(edge_width=0.0)
