"""The rows of the part table and the surface table.

Paper: "Introduction". Polygons are grouped into parts; a part has a surface type; a surface type has colors
and reflectance properties.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from numbers import Real
from typing import Annotated, ClassVar, Final, Unpack

from autocolor.checks import Color, listed
from autocolor.scene.changes import PaintChanges, PartChanges, ReflectanceChanges, SurfaceChanges
from autocolor.scene.columns import BarRange, Column, Problem, Row, RowError, Tier, replaced
from autocolor.scene.kinds import Boolean, ColorKind, ColorsKind, Number, Text, Whole
from autocolor.scene.reflection_models import MODELS, Phong, ReflectionModel
from autocolor.scene.row_kinds import Nested, OneRowOf, Reference

MOST_SURFACES: Final = 255
"""Surface numbers have 8 bits, and 0 means that nothing is visible."""

MOST_LEVELS: Final = 1_000_000
"""Limit: levels of a surface, more than any lookup table has."""

MOST_RAMP_COLORS: Final = 1024
"""Limit: colors of a ramp, one for each entry of the lookup table."""

PHONG: Final = Phong()
"""The default reflection model."""


@dataclass(frozen=True, repr=False)
class Part(Row):
    """A group of polygons with one surface. Paper: door, hood, roof, fender."""

    noun: ClassVar[str] = "part"

    name: Annotated[str, Column(Text(), Tier.NOTHING, "The name of the part, as in the mesh.")]
    surface: Annotated[str, Column(Reference("surfaces"), Tier.FRAME, "The name of the part's surface.")]
    stage: Annotated[
        bool,
        Column(Boolean(), Tier.MIX, "Whether the part is scenery; a new view frames the other parts."),
    ] = False

    def replace(self, /, **changes: Unpack[PartChanges]) -> Part:
        """The part with some fields changed."""
        return replaced(self, changes)


@dataclass(frozen=True, init=False, repr=False)
class Reflectance(Row):
    """The reflectance properties of a surface: D, S, and a reflection model with its parameters.

    Paper: Figure 2.
    """

    diffuse: Annotated[
        float, Column(Number(at_least=0), Tier.MIX, "D: the diffuse reflectance.", bar=BarRange(0, 1, 0.01))
    ] = 0.7
    specular: Annotated[
        float, Column(Number(at_least=0), Tier.MIX, "S: the specular reflectance.", bar=BarRange(0, 1, 0.01))
    ] = 0.5
    model: Annotated[
        ReflectionModel,
        Column(OneRowOf(MODELS), Tier.LIGHT, "The reflection model of the specular highlight."),
    ] = PHONG

    def __init__(
        self,
        diffuse: float = 0.7,
        specular: float = 0.5,
        model: ReflectionModel | str | float = PHONG,
        *,
        exponent: float | None = None,
    ) -> None:
        """Set D, S and the model: a row, a name, or N of Phong's model as a number.

        `exponent` sets N, if the model has an N. Raises InputError.
        """
        if isinstance(model, Real) and not isinstance(model, bool):
            if exponent is not None:
                raise RowError([Problem(("exponent",), "must be given once, not twice; leave one out")])
            exponent, model = model, PHONG  # type: ignore[assignment]
        vars(self).update(diffuse=diffuse, specular=specular, model=model)
        self.__post_init__()
        if exponent is not None:
            vars(self).update(vars(replaced(self, {"exponent": exponent})))

    @property
    def exponent(self) -> float:
        """N of the reflection model. Raises AttributeError if the model has none."""
        values = vars(self.model)
        if "exponent" not in values:
            raise AttributeError(f"the model of a reflectance must have an exponent, not {self.model!r}")
        exponent: float = values["exponent"]
        return exponent

    def replace(self, /, **changes: Unpack[ReflectanceChanges]) -> Reflectance:
        """The reflectance with some fields changed; a new model starts with its default parameters."""
        return replaced(self, changes)


@dataclass(frozen=True, repr=False)
class Paint(Row):
    """The two colors of a surface and how they blend; or a ramp, which gives the color of every level.

    Paper: "Light Source Color Blending", Figure 12. Departs: a ramp is an alternative to the two colors and
    their blend, which have their defaults beside it.
    """

    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (
        ("object_color", "light_color", "blend", "light_percentage"),
        ("ramp",),
    )

    object_color: Annotated[Color, Column(ColorKind(), Tier.ENTRIES, "The color of diffuse reflection.")] = (
        176,
        176,
        176,
    )
    light_color: Annotated[
        Color, Column(ColorKind(), Tier.ENTRIES, "The color of the light source, shown in highlights.")
    ] = (255, 255, 255)
    blend: Annotated[
        float,
        Column(
            Number(at_least=0, at_most=1),
            Tier.ENTRIES,
            "The level above which the light color blends in; 1 for no blending.",
            "fraction of the range of levels",
        ),
    ] = 0.6
    light_percentage: Annotated[
        float,
        Column(
            Number(at_least=0, at_most=100),
            Tier.ENTRIES,
            "The share of the light color at the highest level.",
            "percent",
        ),
    ] = 100.0
    ramp: Annotated[
        tuple[Color, ...] | None,
        Column(
            ColorsKind(MOST_RAMP_COLORS),
            Tier.ENTRIES,
            "Colors at equal distances from the lowest level to the highest; excludes the two colors and"
            " their blend.",
        ),
    ] = None

    def rules(self) -> Iterator[Problem]:
        """A ramp stands alone."""
        blended = self.alternatives[0]
        if isinstance(self.ramp, tuple) and any(vars(self)[name] != getattr(Paint, name) for name in blended):
            others = listed(blended)
            yield Problem(
                ("ramp",), f"must stand without {others}, not beside them; leave out the ramp or these"
            )

    @property
    def color(self) -> Color:
        """The color that stands for the paint: the object color, or the color in the middle of the ramp.

            >>> Paint("#b01020").color, Paint(ramp=["#200", "#f60", "#fff"]).color
            ((176, 16, 32), (255, 102, 0))

        Of an even number of colors, it is the mean of the two in the middle.
        """
        if self.ramp is None:
            return self.object_color
        pairs = zip(self.ramp[(len(self.ramp) - 1) // 2], self.ramp[len(self.ramp) // 2], strict=True)
        red, green, blue = ((one + other + 1) // 2 for one, other in pairs)
        return red, green, blue

    def replace(self, /, **changes: Unpack[PaintChanges]) -> Paint:
        """The paint with some fields changed."""
        return replaced(self, changes)


@dataclass(frozen=True, repr=False)
class Surface(Row):
    """A surface type. Several parts can share it."""

    noun: ClassVar[str] = "surface"

    name: Annotated[str, Column(Text(), Tier.MIX, "The name of the surface, which must be unique.")]
    reflectance: Annotated[
        Reflectance, Column(Nested(Reflectance, inline=True), Tier.LIGHT, "How the surface reflects light.")
    ] = field(default_factory=Reflectance)
    paint: Annotated[
        Paint,
        Column(Nested(Paint, inline=True), Tier.ENTRIES, "The colors of the surface, and how they blend."),
    ] = field(default_factory=Paint)
    two_sided: Annotated[
        bool,
        Column(Boolean(), Tier.FRAME, "Whether normals of polygons seen from behind are turned to the eye."),
    ] = True
    levels: Annotated[
        int | None,
        Column(
            Whole(at_least=2, at_most=MOST_LEVELS),
            Tier.LEVELS,
            "The number of lookup table entries; if absent, a share of the remaining entries.",
            bar=BarRange(2, 256, 1),
            start=64,
        ),
    ] = None

    def replace(self, /, **changes: Unpack[SurfaceChanges]) -> Surface:
        """The surface with some fields changed, also fields of its reflectance and its paint."""
        return replaced(self, changes)
