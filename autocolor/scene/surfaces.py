"""The tables of parts and surfaces.

Paper: "Introduction". Polygons are grouped to parts; a part has a surface type; a surface type has colors and
reflectance properties. Everything here is checked when it is made and never changes afterwards.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final

import numpy as np

from autocolor.checks import (
    Color,
    color,
    field_names,
    finite,
    kind,
    known_fields,
    switch,
    text,
    with_checked,
)
from autocolor.errors import InputError

MOST_SURFACES: Final = 255
"""Surface numbers are held in 8 bits, and 0 means that nothing is seen."""


@dataclass(frozen=True)
class Part:
    """A group of polygons with one surface. Paper: door, hood, roof, fender."""

    name: str
    surface: str

    def __post_init__(self) -> None:
        problems: list[str] = []
        text(problems, "a part's name", self.name)
        text(problems, f"part {self.name!r}: surface", self.surface)
        if problems:
            raise InputError(problems)

    def replace(self, **changes: Any) -> Part:
        """The part with some fields changed."""
        return dataclasses.replace(self, **known_fields(Part, changes, f"part {self.name!r}"))


@dataclass(frozen=True)
class Reflectance:
    """The reflectance properties of a surface: D, S and N, all at least 0 and with no upper limit.

    Paper: Figure 2.
    """

    diffuse: float = 0.7
    specular: float = 0.5
    exponent: float = 20.0

    def __post_init__(self) -> None:
        vars(self).update(_checked(REFLECTANCE_CHECKS, vars(self)))


@dataclass(frozen=True)
class Paint:
    """The two colors of a surface and how they blend.

    `blend` is where the object color begins to give way to the light color, as a fraction of the surface's
    range of levels: 1 never, 0 from the lowest level. `light_percentage` is how much of the light color is
    reached at the maximum, 0 to 100. Paper: "Light Source Color Blending", Figure 12.
    """

    object_color: Color = (176, 176, 176)
    light_color: Color = (255, 255, 255)
    blend: float = 0.6
    light_percentage: float = 100.0

    def __post_init__(self) -> None:
        vars(self).update(_checked(PAINT_CHECKS, vars(self)))


Check = Callable[[list[str], str, object], object]
REFLECTANCE_CHECKS: Final[Mapping[str, Check]] = dict.fromkeys(
    ("diffuse", "specular", "exponent"), partial(finite, at_least=0.0)
)
PAINT_CHECKS: Final[Mapping[str, Check]] = {
    "object_color": color,
    "light_color": color,
    "blend": partial(finite, at_least=0.0, at_most=1.0),
    "light_percentage": partial(finite, at_least=0.0, at_most=100.0),
}


def _checked(checks: Mapping[str, Check], values: Mapping[str, object]) -> dict[str, object]:
    """The values of some fields as they are held; InputError names every one that breaks a rule."""
    problems: list[str] = []
    checked = {}
    for name, value in values.items():
        checked[name] = checks[name](problems, name, value)
    if problems:
        raise InputError(problems)
    return checked


@dataclass(frozen=True)
class Surface:
    """A surface type: a kind of finish that parts share.

    `two_sided` turns the normal of a polygon seen from behind to the eye. `levels` is how many entries of
    the lookup table the surface owns, at least 2; None for an equal share.
    """

    name: str
    reflectance: Reflectance = field(default_factory=Reflectance)
    paint: Paint = field(default_factory=Paint)
    two_sided: bool = True
    levels: int | None = None

    def __post_init__(self) -> None:
        problems: list[str] = []
        place = f"surface {self.name!r}"
        text(problems, "a surface's name", self.name)
        kind(problems, f"{place}: reflectance", self.reflectance, Reflectance)
        kind(problems, f"{place}: paint", self.paint, Paint)
        object.__setattr__(self, "two_sided", switch(problems, f"{place}: two_sided", self.two_sided))
        if self.levels is not None:
            whole = isinstance(self.levels, (int, np.integer)) and not isinstance(self.levels, bool)
            if not whole or self.levels < 2:
                problems.append(f"{place}: levels must be a whole number of at least 2, not {self.levels!r}")
            else:
                object.__setattr__(self, "levels", int(self.levels))
        if problems:
            raise InputError(problems)

    def replace(self, **changes: Any) -> Surface:
        """The surface with some fields changed, those of its reflectance and of its paint among them."""
        own: dict[str, object] = {}
        reflectance: dict[str, object] = {}
        paint: dict[str, object] = {}
        for name, value in changes.items():
            table = paint if name in PAINT_CHECKS else reflectance if name in REFLECTANCE_CHECKS else own
            table[name] = value
        surface = self
        if own:
            names = [*field_names(Surface), *REFLECTANCE_CHECKS, *PAINT_CHECKS]
            surface = dataclasses.replace(self, **known_fields(Surface, own, f"surface {self.name!r}", names))
        tables: dict[str, object] = {}
        try:
            if reflectance:
                tables["reflectance"] = with_checked(
                    surface.reflectance, _checked(REFLECTANCE_CHECKS, reflectance)
                )
            if paint:
                tables["paint"] = with_checked(surface.paint, _checked(PAINT_CHECKS, paint))
        except InputError as error:
            raise InputError([f"surface {self.name!r}: {problem}" for problem in error.problems]) from None
        return with_checked(surface, tables)

    def is_but_for_paint(self, other: Surface) -> bool:
        """Whether the two surfaces differ in their paint at most."""
        return (self.name, self.reflectance, self.two_sided, self.levels) == (
            other.name,
            other.reflectance,
            other.two_sided,
            other.levels,
        )
