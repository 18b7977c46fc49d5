"""The tables of parts and surfaces.

Paper: "Introduction". Polygons are grouped to parts; a part has a surface type; a surface type has colors and
reflectance properties.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Final, Unpack

from autocolor.checks import Color
from autocolor.scene.changes import PaintChanges, PartChanges, ReflectanceChanges, SurfaceChanges
from autocolor.scene.column_kinds import ColorKind, Nested, Number, Reference, Switch, Text, Variant, Whole
from autocolor.scene.columns import Column, Row, Tier, changed
from autocolor.scene.reflection_models import MODELS, Phong, ReflectionModel

MOST_SURFACES: Final = 255
"""Surface numbers are held in 8 bits, and 0 means that nothing is seen."""

PHONG: Final = Phong()
"""The model of a reflectance that is given none."""


@dataclass(frozen=True)
class Part(Row):
    """A group of polygons with one surface. Paper: door, hood, roof, fender."""

    noun: ClassVar[str] = "part"

    name: Annotated[str, Column(Text(), Tier.NOTHING, "What the part is called, as in the mesh.")]
    surface: Annotated[str, Column(Reference("surfaces"), Tier.FRAME, "The name of its surface.")]

    def replace(self, **changes: Unpack[PartChanges]) -> Part:
        """The part with some fields changed."""
        return changed(self, changes)


@dataclass(frozen=True, init=False)
class Reflectance(Row):
    """The reflectance properties of a surface: D, S, and a reflection model with its own parameters.

    Paper: Figure 2.
    """

    diffuse: Annotated[
        float, Column(Number(at_least=0), Tier.MIX, "D: how much is reflected to all sides.")
    ] = 0.7
    specular: Annotated[
        float, Column(Number(at_least=0), Tier.MIX, "S: how much is reflected around the mirror direction.")
    ] = 0.5
    model: Annotated[
        ReflectionModel, Column(Variant(MODELS), Tier.LIGHT, "The reflection model of the highlight.")
    ] = PHONG

    def __init__(
        self,
        diffuse: float = 0.7,
        specular: float = 0.5,
        model: ReflectionModel | str | float = PHONG,
        *,
        exponent: float | None = None,
    ) -> None:
        """D, S, and a model or its name; a number or `exponent` is N of Phong's model. Raises InputError."""
        if isinstance(model, (float, int)):
            exponent, model = model, PHONG
        vars(self).update(diffuse=diffuse, specular=specular, model=model)
        self.__post_init__()
        if exponent is not None:
            vars(self).update(vars(changed(self, {"exponent": exponent})))

    @property
    def exponent(self) -> float:
        """N of the reflection model; AttributeError where the model has none."""
        values = vars(self.model)
        if "exponent" not in values:
            raise AttributeError(f"the model of a reflectance must have an exponent, not {self.model!r}")
        exponent: float = values["exponent"]
        return exponent

    def replace(self, **changes: Unpack[ReflectanceChanges]) -> Reflectance:
        """The reflectance with some fields changed; another model begins with its own defaults."""
        return changed(self, changes)


@dataclass(frozen=True)
class Paint(Row):
    """The two colors of a surface and how they blend.

    Paper: "Light Source Color Blending", Figure 12.
    """

    object_color: Annotated[
        Color, Column(ColorKind(), Tier.ENTRIES, "The color of the object, of diffuse light.")
    ] = (176, 176, 176)
    light_color: Annotated[
        Color, Column(ColorKind(), Tier.ENTRIES, "The color of the light source, of highlights.")
    ] = (255, 255, 255)
    blend: Annotated[
        float,
        Column(
            Number(at_least=0, at_most=1),
            Tier.ENTRIES,
            "Where the object color begins to give way to the light color: 1 never, 0 from the lowest level.",
            "fraction of the range of levels",
        ),
    ] = 0.6
    light_percentage: Annotated[
        float,
        Column(
            Number(at_least=0, at_most=100),
            Tier.ENTRIES,
            "How much of the light color is reached at the maximum.",
            "percent",
        ),
    ] = 100.0

    def replace(self, **changes: Unpack[PaintChanges]) -> Paint:
        """The paint with some fields changed."""
        return changed(self, changes)


@dataclass(frozen=True)
class Surface(Row):
    """A surface type: a kind of finish that parts share."""

    noun: ClassVar[str] = "surface"

    name: Annotated[str, Column(Text(), Tier.MIX, "What the surface is called; names differ.")]
    reflectance: Annotated[
        Reflectance, Column(Nested(Reflectance, inline=True), Tier.LIGHT, "How it reflects light.")
    ] = field(default_factory=Reflectance)
    paint: Annotated[
        Paint, Column(Nested(Paint, inline=True), Tier.ENTRIES, "Its colors and how they blend.")
    ] = field(default_factory=Paint)
    two_sided: Annotated[
        bool,
        Column(
            Switch(), Tier.FRAME, "Whether the normal of a polygon seen from behind is turned to the eye."
        ),
    ] = True
    levels: Annotated[
        int | None,
        Column(Whole(at_least=2), Tier.LEVELS, "How many entries of the table it owns; absent for a share."),
    ] = None

    def replace(self, **changes: Unpack[SurfaceChanges]) -> Surface:
        """The surface with some fields changed, those of its reflectance and of its paint among them."""
        return changed(self, changes)
