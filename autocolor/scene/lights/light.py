"""Lights and their controls, as data.

Paper: "Light Controls". A light has a position and an intensity. With a direction or an aim it is a directed
light, which concentration and a cone can narrow; flaps can restrict any light. The effect of these controls
is computed in `lighting/light_controls`. What a light follows is worked out in `following`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Final, Unpack

from autocolor.checks import Vector
from autocolor.scene.changes import LightChanges
from autocolor.scene.columns.bars import Bar
from autocolor.scene.columns.column import WORLD_UNITS, Column, Row, Tier
from autocolor.scene.columns.named_row_kinds import NamedRows
from autocolor.scene.columns.problems import Problem
from autocolor.scene.columns.reference_kinds import WordOrName
from autocolor.scene.columns.row_kinds import Nested
from autocolor.scene.columns.rows import changed
from autocolor.scene.columns.value_kinds import Choice, Number, Switch, Text, VectorKind
from autocolor.scene.lights.flaps import Flaps
from autocolor.scene.lights.half_spaces import HalfSpace
from autocolor.scene.lights.links import Links
from autocolor.scene.lights.vectors import unit_vector

FALLOFFS: Final = ("none", "linear", "quadratic")
"""What is left of a light at a distance, as a fraction f of its reach: all of it, 1 - f, or (1 - f)^2."""

EYE: Final = "eye"
"""What a light that is fixed to the eye follows."""


@dataclass(frozen=True, repr=False)
class Light(Row):
    """One light.

    It has a direction, or an aim (its direction is then from the position to the aim), or neither; then it is
    a point source. Paper: "Light Direction and Concentration", "Light Flaps and Cones". The rays of a light
    at infinity all have its direction: its concentration and its cone have no effect, its flaps still have.
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
            "C: the exponent of the cosine of the angle from the direction.",
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
    inner_angle: Annotated[
        float | None,
        Column(
            Number(at_least=0, at_most=180),
            Tier.LIGHT,
            "The angle up to which all of the light is left; if absent, the cone is sharp.",
            "degrees",
            bar=Bar(0, 90, 1),
            start=0.0,
        ),
    ] = field(default=None, kw_only=True)
    flaps: Annotated[
        Flaps, Column(Nested(Flaps), Tier.LIGHT, "The ranges of object coordinates that are lit.")
    ] = field(default_factory=Flaps)
    half_spaces: Annotated[
        tuple[HalfSpace, ...],
        Column(NamedRows(HalfSpace), Tier.LIGHT, "Flaps along any planes, by name."),
    ] = ()
    falloff: Annotated[
        str,
        Column(Choice(FALLOFFS), Tier.LIGHT, "How it falls with the distance, to nothing at its reach."),
    ] = "none"
    reach: Annotated[
        float | None,
        Column(
            Number(at_least=0, above=True),
            Tier.LIGHT,
            "The distance at which nothing is left of a light that falls with the distance.",
            WORLD_UNITS,
        ),
    ] = None
    at_infinity: Annotated[
        bool,
        Column(Switch(), Tier.LIGHT, "Whether its rays are parallel, as if the position were endlessly far."),
    ] = False
    follows: Annotated[
        str | None,
        Column(
            WordOrName("lights", EYE),
            Tier.LIGHT,
            "What it is fixed to: 'eye', or the name of another light, for the point at which that is aimed.",
        ),
    ] = None
    links: Annotated[
        Links, Column(Nested(Links, inline=True), Tier.LIGHT, "The surfaces and parts that it shines on.")
    ] = field(default_factory=Links)

    def rules(self) -> Iterator[Problem]:
        """At most one of direction and aim is given; without both, no control that needs one is given.

        An inner angle comes with a cone that is not narrower, and a falloff with a reach.
        """
        if self.direction is not None and self.aim is not None:
            yield Problem((), "it must have a direction or an aim, not both; leave one out")
        if self.aim is not None and self.aim == self.position:
            yield Problem((), f"the aim must not be the position, not both {self.aim}; move one of them")
        if self.direction is None and self.aim is None:
            for name, is_given in (
                ("concentration", self.concentration > 0),
                ("cone_angle", self.cone_angle is not None),
                ("at_infinity", self.at_infinity is True),
            ):
                if is_given:
                    rule = "must come with a direction or an aim, not with a point source; add an aim"
                    yield Problem((name,), rule)
        yield from self._rules_of_controls()

    def _rules_of_controls(self) -> Iterator[Problem]:
        inner, outer = self.inner_angle, self.cone_angle
        if inner is not None and outer is None:
            yield Problem(("inner_angle",), "must come with a cone, not without one; add a cone_angle")
        elif inner is not None and outer is not None and inner > outer:
            rule = f"must not be above the cone_angle, not {inner:g} and {outer:g}; exchange them"
            yield Problem(("inner_angle",), rule)
        if self.falloff in FALLOFFS[1:] and self.reach is None:
            yield Problem(("falloff",), f"must come with a reach, not {self.falloff!r} alone; add a reach")
        if self.falloff in FALLOFFS[1:] and self.at_infinity is True:
            rule = f"must be 'none' for a light at infinity, not {self.falloff!r}; change one of them"
            yield Problem(("falloff",), rule)

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
        return unit_vector(toward)

    def replace(self, /, **changes: Unpack[LightChanges]) -> Light:
        """The light with some fields changed; a new direction removes the aim, and vice versa.

        Raises InputError for an unknown field or an invalid value.
        """
        return changed(self, changes)
