"""Half-spaces: flaps along any planes, of which a light may have any number.

Paper: "Light Flaps and Cones" names flaps that are not parallel to the axes as an addition. Their effect is
computed in `lighting.light_controls.half_spaces`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Unpack

from autocolor.checks import Vector
from autocolor.scene.changes import HalfSpaceChanges
from autocolor.scene.columns.column import WORLD_UNITS, Column, Row, Tier
from autocolor.scene.columns.rows import changed
from autocolor.scene.columns.value_kinds import Number, Switch, Text, VectorKind


@dataclass(frozen=True, repr=False)
class HalfSpace(Row):
    """The points on one side of a plane, outside of which a light has no effect, and a switch.

    A point of the plane is lit. With an edge width, the light goes from nothing at the plane to all of it at
    this distance inside. One that is carried by its light, as barn doors are, is told in the coordinates of
    the light (see `following.light_frame`).
    """

    noun: ClassVar[str] = "half-space"

    name: Annotated[str, Column(Text(), Tier.NOTHING, "The name of the half-space, unique for the light.")]
    point: Annotated[Vector, Column(VectorKind(), Tier.LIGHT, "A point of the plane.", WORLD_UNITS)]
    direction: Annotated[
        Vector,
        Column(
            VectorKind(has_length=True),
            Tier.LIGHT,
            "The direction from the plane to the side that is lit, of any length.",
        ),
    ]
    edge_width: Annotated[
        float,
        Column(
            Number(at_least=0),
            Tier.LIGHT,
            "How far inside the plane the light is whole; 0 for a sharp edge.",
            WORLD_UNITS,
        ),
    ] = 0.0
    carried: Annotated[
        bool, Column(Switch(), Tier.LIGHT, "Whether it moves and turns with the light, as barn doors do.")
    ] = False
    on: Annotated[bool, Column(Switch(), Tier.LIGHT, "Whether it restricts the light.")] = True

    def replace(self, /, **changes: Unpack[HalfSpaceChanges]) -> HalfSpace:
        """The half-space with some fields changed."""
        return changed(self, changes)
