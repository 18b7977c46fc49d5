"""The row that tells which scalar is shown in color, and how.

Paper: "Introduction": scalar variables such as stress on the surface of an object are shown in color. The
keys are those of the table `[scalar]` of a scene file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Final

from autocolor.checks import Color, Vector
from autocolor.scene.columns.bars import Bar
from autocolor.scene.columns.color_kinds import ColorKind
from autocolor.scene.columns.column import Column, Row, Tier
from autocolor.scene.columns.reference_kinds import References
from autocolor.scene.columns.value_kinds import Number, Switch, Text, VectorKind, Whole
from autocolor.scene.scalars.scalar_kinds import EndColor, Limits, ScaleKind

MOST_BANDS: Final = 256
UP: Final = (0.0, 0.0, 1.0)


@dataclass(frozen=True, repr=False)
class Scalar(Row):
    """The scalar that colors the surfaces, its limits, bands and colors."""

    noun: ClassVar[str] = "scalar"

    name: Annotated[
        str,
        Column(Text(), Tier.MIX, "A scalar of the mesh, or a computed one such as 'mean curvature'."),
    ]
    limits: Annotated[
        tuple[float, float] | None,
        Column(
            Limits(),
            Tier.LEVELS,
            "Where the first band begins and the last ends; if absent, its range.",
        ),
    ] = None
    scale: Annotated[
        str | tuple[Color, ...],
        Column(ScaleKind(), Tier.ENTRIES, "The color scale: a name, or a list of colors."),
    ] = "viridis"
    bands: Annotated[
        int, Column(Whole(2, MOST_BANDS), Tier.LEVELS, "The number of colors.", bar=Bar(2, 64, 1))
    ] = 16
    shades: Annotated[
        int | None,
        Column(
            Whole(1, MOST_BANDS),
            Tier.LEVELS,
            "The levels of each color; 1 for flat color codes. If absent, as many as fit, at most 8.",
            bar=Bar(1, 16, 1),
            start=8,
        ),
    ] = None
    below: Annotated[
        Color | None,
        Column(
            EndColor(),
            Tier.ENTRIES,
            "The color below the limits; if absent, that of the first band.",
        ),
    ] = None
    above: Annotated[
        Color | None,
        Column(
            EndColor(),
            Tier.ENTRIES,
            "The color above the limits; if absent, that of the last band.",
        ),
    ] = None
    missing: Annotated[Color, Column(ColorKind(), Tier.ENTRIES, "The color where there is no value.")] = (
        128,
        128,
        128,
    )
    legend: Annotated[bool, Column(Switch(), Tier.NOTHING, "Whether the legend is drawn on the display.")] = (
        True
    )
    surfaces: Annotated[
        tuple[str, ...] | None,
        Column(
            References("surfaces"),
            Tier.LEVELS,
            "The surfaces that it colors; if absent, all but those of stage parts alone.",
        ),
    ] = None
    direction: Annotated[
        Vector,
        Column(
            VectorKind(has_length=True),
            Tier.MIX,
            "The axis of a distance, the pull of a draft angle, the up of a slope, or the run of stripes.",
        ),
    ] = UP
    stripes: Annotated[
        float,
        Column(
            Number(at_least=1, at_most=1000), Tier.MIX, "Zebra stripes in a half turn.", bar=Bar(1, 60, 1)
        ),
    ] = 12.0
