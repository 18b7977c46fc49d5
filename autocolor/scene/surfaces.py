"""The rows of the part table and the surface table.

Paper: "Introduction". Polygons are grouped into parts; a part has a surface type; a surface type has colors
and reflectance properties.
"""

from __future__ import annotations

from collections.abc import Iterator
from numbers import Real
from typing import ClassVar, Final, Unpack

from autocolor.checks import Color, listed
from autocolor.scene.changes import PaintChanges, PartChanges, ReflectanceChanges, SurfaceChanges
from autocolor.scene.columns import BarRange, Problem, Row, RowError, Tier, column_of, replaced
from autocolor.scene.kinds import ColorsKind, Whole, boolean, color, number, text
from autocolor.scene.reflection_models import MODELS, Phong, ReflectionModel
from autocolor.scene.row_kinds import OneRowOf, Reference, nested, table_row

MOST_SURFACES: Final = 255
"""Surface numbers have 8 bits, and 0 means that nothing is visible."""

MOST_LEVELS: Final = 1_000_000
"""Limit: levels of a surface, more than any lookup table has."""

MOST_RAMP_COLORS: Final = 1024
"""Limit: colors of a ramp, one for each entry of the lookup table."""

PHONG: Final = Phong()
"""The default reflection model."""


@table_row
class Part(Row):
    """A group of polygons with one surface. Paper: door, hood, roof, fender."""

    noun: ClassVar[str] = "part"

    name: str = text(tier=Tier.NOTHING, help="The name of the part, as in the mesh.")
    surface: str = column_of(Reference("surfaces"), tier=Tier.FRAME, help="The name of the part's surface.")
    stage: bool = boolean(
        default=False, tier=Tier.MIX, help="Whether the part is scenery; a new view frames the other parts."
    )

    def replace(self, /, **changes: Unpack[PartChanges]) -> Part:
        """The part with some fields changed."""
        return replaced(self, changes)


@table_row
class Reflectance(Row):
    """The reflectance properties of a surface: D, S, and a reflection model with its parameters.

    Paper: Figure 2.
    """

    diffuse: float = number(
        default=0.7, at_least=0, bar=BarRange(0, 1, 0.01), tier=Tier.MIX, help="D: the diffuse reflectance."
    )
    specular: float = number(
        default=0.5, at_least=0, bar=BarRange(0, 1, 0.01), tier=Tier.MIX, help="S: the specular reflectance."
    )
    model: ReflectionModel = column_of(
        OneRowOf(MODELS),
        default=PHONG,
        tier=Tier.LIGHT,
        help="The reflection model of the specular highlight.",
    )

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


@table_row
class Paint(Row):
    """The two colors of a surface and how they blend; or a ramp, which gives the color of every level.

    Paper: "Light Source Color Blending", Figure 12. Departs: a ramp of colors may replace the two colors and
    their blend, which then have their defaults.
    """

    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (
        ("object_color", "light_color", "blend", "light_percentage"),
        ("ramp",),
    )

    object_color: Color = color(
        default=(176, 176, 176), tier=Tier.ENTRIES, help="The color of diffuse reflection."
    )
    light_color: Color = color(
        default=(255, 255, 255), tier=Tier.ENTRIES, help="The color of the light source, shown in highlights."
    )
    blend: float = number(
        default=0.6,
        at_least=0,
        at_most=1,
        unit="fraction of the range of levels",
        bar=BarRange(0, 1, 0.01),
        tier=Tier.ENTRIES,
        help="The level above which the light color blends in; 1 for no blending.",
    )
    light_percentage: float = number(
        default=100.0,
        at_least=0,
        at_most=100,
        unit="percent",
        bar=BarRange(0, 100, 1),
        tier=Tier.ENTRIES,
        help="The share of the light color at the highest level.",
    )
    ramp: tuple[Color, ...] | None = column_of(
        ColorsKind(MOST_RAMP_COLORS),
        default=None,
        tier=Tier.ENTRIES,
        help="Colors at equal distances from the lowest level to the highest; excludes the two colors and"
        " their blend.",
    )

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


@table_row
class Surface(Row):
    """A surface type. Several parts can share it."""

    noun: ClassVar[str] = "surface"

    name: str = text(tier=Tier.MIX, help="The name of the surface, which must be unique.")
    reflectance: Reflectance = nested(
        Reflectance,
        default=Reflectance(),
        inline=True,
        tier=Tier.LIGHT,
        help="How the surface reflects light.",
    )
    paint: Paint = nested(
        Paint,
        default=Paint(),
        inline=True,
        tier=Tier.ENTRIES,
        help="The colors of the surface, and how they blend.",
    )
    two_sided: bool = boolean(
        default=True,
        tier=Tier.FRAME,
        help="Whether normals of polygons seen from behind are turned to the eye.",
    )
    levels: int | None = column_of(
        Whole(2, MOST_LEVELS),
        default=None,
        bar=BarRange(2, 256, 1),
        start=64,
        tier=Tier.LEVELS,
        help="The number of lookup table entries; if absent, a share of the remaining entries.",
    )

    def replace(self, /, **changes: Unpack[SurfaceChanges]) -> Surface:
        """The surface with some fields changed, also fields of its reflectance and its paint."""
        return replaced(self, changes)
