"""Flaps: ranges of object coordinates outside of which a light has no effect.

Paper: "Light Flaps and Cones", Figure 9. Their effect is computed in `lighting.light_controls.flap_sides`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar, Unpack

from autocolor.scene.changes import FlapChanges, FlapsChanges
from autocolor.scene.columns.column import WORLD_UNITS, Column, Row, Tier
from autocolor.scene.columns.problems import Problem
from autocolor.scene.columns.row_kinds import Nested
from autocolor.scene.columns.rows import changed
from autocolor.scene.columns.value_kinds import Number, Switch


@dataclass(frozen=True, repr=False)
class Flap(Row):
    """A range of one object coordinate outside of which a light has no effect, and a switch.

    Paper: "Light Flaps and Cones", Figure 9. A point at the minimum or the maximum is lit. Departs: with an
    edge width, the light goes from nothing at an end to all of it at this distance inside.
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
    edge_width: Annotated[
        float,
        Column(
            Number(at_least=0),
            Tier.LIGHT,
            "How far inside its ends the light is whole; 0 for sharp edges.",
            WORLD_UNITS,
        ),
    ] = 0.0

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
