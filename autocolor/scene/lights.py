"""A light and its controls, as data.

Paper: "Light Controls". A light has a position and an intensity; a direction makes it a directed light,
whose concentration, cone and flaps restrict and shape what it gives. What these numbers do to the light at
a point is computed in `lighting/light_controls`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Unpack

from autocolor.checks import Vector
from autocolor.scene.changes import FlapChanges, FlapsChanges, LightChanges
from autocolor.scene.column_kinds import Nested, Number, Switch, Text, VectorKind
from autocolor.scene.columns import Column, Problem, Row, Tier, changed


@dataclass(frozen=True)
class Flap(Row):
    """A minimum and a maximum of one object coordinate, with a switch that keeps both.

    Paper: "Light Flaps and Cones", Figure 9. A point outside gets nothing from the light; a point at the
    minimum or the maximum is lit.
    """

    noun: ClassVar[str] = "flap"

    minimum: Annotated[
        float, Column(Number(endless=-math.inf), Tier.LIGHT, "The least coordinate that is lit.", "units")
    ] = -math.inf
    maximum: Annotated[
        float, Column(Number(endless=math.inf), Tier.LIGHT, "The largest coordinate that is lit.", "units")
    ] = math.inf
    on: Annotated[bool, Column(Switch(), Tier.LIGHT, "Whether the flap cuts the light.")] = True

    def rules(self) -> Iterator[Problem]:
        """The minimum must not be above the maximum."""
        if self.minimum > self.maximum:
            ends = f"{self.minimum:g} to {self.maximum:g}"
            yield Problem((), f"the minimum must not be above the maximum, not {ends}; exchange them")

    def replace(self, **changes: Unpack[FlapChanges]) -> Flap:
        """The flap with some fields changed."""
        return changed(self, changes)


@dataclass(frozen=True)
class Flaps(Row):
    """The flaps of one light in the X, Y and Z directions; None where there is no flap."""

    noun: ClassVar[str] = "flaps"

    x: Annotated[
        Flap | None, Column(Nested(Flap), Tier.LIGHT, "A range of X, outside of which it is dark.")
    ] = None
    y: Annotated[
        Flap | None, Column(Nested(Flap), Tier.LIGHT, "A range of Y, outside of which it is dark.")
    ] = None
    z: Annotated[
        Flap | None, Column(Nested(Flap), Tier.LIGHT, "A range of Z, outside of which it is dark.")
    ] = None

    def replace(self, **changes: Unpack[FlapsChanges]) -> Flaps:
        """The flaps with some of them changed; a table of some fields of a flap leaves its others."""
        return changed(self, changes)


@dataclass(frozen=True)
class Light(Row):
    """One light of the studio.

    A light has a direction or an aim (the direction then follows the position) or neither: then it is a point
    source. Paper: "Light Direction and Concentration", "Light Flaps and Cones".
    """

    noun: ClassVar[str] = "light"
    alternatives: ClassVar[tuple[str, ...]] = ("direction", "aim")

    name: Annotated[str, Column(Text(), Tier.LIGHT, "What the light is called; names differ.")]
    position: Annotated[Vector, Column(VectorKind(), Tier.LIGHT, "Where the light is.", "world units")]
    intensity: Annotated[
        float, Column(Number(at_least=0), Tier.MIX, "How much light it gives; there is no upper limit.")
    ] = 1.0
    on: Annotated[bool, Column(Switch(), Tier.MIX, "Whether the light shines.")] = True
    direction: Annotated[
        Vector | None,
        Column(
            VectorKind(has_length=True), Tier.LIGHT, "Where it points, a vector of any length; or an aim."
        ),
    ] = None
    aim: Annotated[
        Vector | None, Column(VectorKind(), Tier.LIGHT, "The point that it is aimed at.", "world units")
    ] = None
    concentration: Annotated[
        float,
        Column(
            Number(at_least=0), Tier.LIGHT, "C: it falls off from its direction as the cosine to this power."
        ),
    ] = 0.0
    cone_angle: Annotated[
        float | None,
        Column(
            Number(at_least=0, at_most=180, above=True),
            Tier.LIGHT,
            "A: nothing is lit farther from the direction than this; absent for no cone.",
            "degrees",
        ),
    ] = None
    flaps: Annotated[
        Flaps, Column(Nested(Flaps), Tier.LIGHT, "Ranges of object coordinates, outside of which it is dark.")
    ] = field(default_factory=Flaps)

    def rules(self) -> Iterator[Problem]:
        """A direction or an aim, or neither, and then no control that needs one."""
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
        """Whether it gives any light."""
        return self.on and self.intensity > 0

    @property
    def axis(self) -> Vector | None:
        """The unit vector of the light direction, or None for a point source."""
        if self.direction is not None:
            toward = self.direction
        elif self.aim is not None:
            toward = tuple(a - p for a, p in zip(self.aim, self.position, strict=True))  # type: ignore[assignment]
        else:
            return None
        # Scale by the largest component first: squares of very short or long vectors leave the float range.
        largest = max(abs(component) for component in toward)
        scaled = tuple(component / largest for component in toward)
        length = math.hypot(*scaled)
        return (scaled[0] / length, scaled[1] / length, scaled[2] / length)

    def replace(self, **changes: Unpack[LightChanges]) -> Light:
        """The light with some fields changed; giving a direction drops the aim, and the other way round.

        Raises InputError for an unknown field or a value that breaks a rule.
        """
        return changed(self, changes)
