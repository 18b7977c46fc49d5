"""Lights and their controls, as data.

Paper: "Light Controls". A light has a position and an intensity. With a direction or an aim it is a directed
light, which concentration and a cone can narrow; flaps can restrict any light. The effect of these controls
is computed in `lighting/light_controls`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Unpack

from autocolor.checks import Vector
from autocolor.scene.changes import FlapChanges, FlapsChanges, LightChanges
from autocolor.scene.columns.bars import Bar
from autocolor.scene.columns.column import WORLD_UNITS, Column, Row, Tier
from autocolor.scene.columns.problems import Problem
from autocolor.scene.columns.row_kinds import Nested
from autocolor.scene.columns.rows import changed
from autocolor.scene.columns.value_kinds import Number, Switch, Text, VectorKind


@dataclass(frozen=True, repr=False)
class Flap(Row):
    """A range of one object coordinate outside of which a light has no effect, and a switch.

    Paper: "Light Flaps and Cones", Figure 9. A point at the minimum or the maximum is lit.
    """

    noun: ClassVar[str] = "flap"

    minimum: Annotated[
        float,
        Column(Number(endless=-math.inf), Tier.LIGHT, "The smallest coordinate that is lit.", WORLD_UNITS),
    ] = -math.inf
    maximum: Annotated[
        float,
        Column(Number(endless=math.inf), Tier.LIGHT, "The largest coordinate that is lit.", WORLD_UNITS),
    ] = math.inf
    on: Annotated[bool, Column(Switch(), Tier.LIGHT, "Whether the flap restricts the light.")] = True

    def rules(self) -> Iterator[Problem]:
        """The minimum must not be above the maximum."""
        if self.minimum > self.maximum:
            ends = f"{self.minimum:g} to {self.maximum:g}"
            yield Problem((), f"the minimum must not be above the maximum, not {ends}; exchange them")

    def replace(self, /, **changes: Unpack[FlapChanges]) -> Flap:
        """The flap with some fields changed."""
        return changed(self, changes)


@dataclass(frozen=True, repr=False)
class Flaps(Row):
    """The flaps of one light in the X, Y and Z directions; None where there is no flap."""

    noun: ClassVar[str] = "flaps"

    x: Annotated[Flap | None, Column(Nested(Flap), Tier.LIGHT, "The range of X that is lit.")] = None
    y: Annotated[Flap | None, Column(Nested(Flap), Tier.LIGHT, "The range of Y that is lit.")] = None
    z: Annotated[Flap | None, Column(Nested(Flap), Tier.LIGHT, "The range of Z that is lit.")] = None

    def replace(self, /, **changes: Unpack[FlapsChanges]) -> Flaps:
        """The flaps with some changed; a table of fields changes only these fields of a flap."""
        return changed(self, changes)


@dataclass(frozen=True, repr=False)
class Light(Row):
    """One light.

    It has a direction, or an aim (its direction is then from the position to the aim), or neither; then it is
    a point source. Paper: "Light Direction and Concentration", "Light Flaps and Cones".
    """

    noun: ClassVar[str] = "light"
    alternatives: ClassVar[tuple[str, ...]] = ("direction", "aim")

    name: Annotated[str, Column(Text(), Tier.LIGHT, "The name of the light, which must be unique.")]
    position: Annotated[Vector, Column(VectorKind(), Tier.LIGHT, "The position of the light.", WORLD_UNITS)]
    intensity: Annotated[
        float,
        Column(
            Number(at_least=0),
            Tier.MIX,
            "The intensity of the light, without an upper limit.",
            bar=Bar(0, 2, 0.01),
        ),
    ] = 1.0
    on: Annotated[bool, Column(Switch(), Tier.MIX, "Whether the light is switched on.")] = True
    direction: Annotated[
        Vector | None,
        Column(
            VectorKind(has_length=True),
            Tier.LIGHT,
            "The direction of the light, of any length; excludes an aim.",
        ),
    ] = None
    aim: Annotated[
        Vector | None,
        Column(
            VectorKind(),
            Tier.LIGHT,
            "The point at which the light is aimed; excludes a direction.",
            WORLD_UNITS,
        ),
    ] = None
    concentration: Annotated[
        float,
        Column(
            Number(at_least=0),
            Tier.LIGHT,
            "C: the exponent of the cosine falloff around the direction.",
            bar=Bar(0, 100, 1),
        ),
    ] = 0.0
    cone_angle: Annotated[
        float | None,
        Column(
            Number(at_least=0, at_most=180, above=True),
            Tier.LIGHT,
            "A: the largest angle from the direction that is lit; if absent, there is no cone.",
            "degrees",
            bar=Bar(1, 90, 1),
            start=30.0,
        ),
    ] = None
    flaps: Annotated[
        Flaps, Column(Nested(Flaps), Tier.LIGHT, "The ranges of object coordinates that are lit.")
    ] = field(default_factory=Flaps)

    def rules(self) -> Iterator[Problem]:
        """At most one of direction and aim is given; without both, no control that needs one is given."""
        if self.direction is not None and self.aim is not None:
            yield Problem((), "it must have a direction or an aim, not both; leave one out")
        if self.aim is not None and self.aim == self.position:
            yield Problem((), f"the aim must not be the position, not both {self.aim}; move one of them")
        if self.direction is None and self.aim is None:
            for name, is_given in (
                ("concentration", self.concentration > 0),
                ("cone_angle", self.cone_angle is not None),
            ):
                if is_given:
                    rule = "must come with a direction or an aim, not with a point source; add an aim"
                    yield Problem((name,), rule)

    @property
    def shines(self) -> bool:
        """Whether the light is on and its intensity is above 0."""
        return self.on and self.intensity > 0

    @property
    def axis(self) -> Vector | None:
        """The unit vector of the light direction; None for a point source."""
        if self.direction is not None:
            toward = self.direction
        elif self.aim is not None:
            toward = tuple(a - p for a, p in zip(self.aim, self.position, strict=True))  # type: ignore[assignment]
        else:
            return None
        # Scale by the largest component first, as squares of very large or small ones over- or underflow.
        largest = max(abs(component) for component in toward)
        scaled = tuple(component / largest for component in toward)
        length = math.hypot(*scaled)
        return (scaled[0] / length, scaled[1] / length, scaled[2] / length)

    def replace(self, /, **changes: Unpack[LightChanges]) -> Light:
        """The light with some fields changed; a new direction removes the aim, and vice versa.

        Raises InputError for an unknown field or an invalid value.
        """
        return changed(self, changes)
