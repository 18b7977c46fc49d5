"""Lights and their controls, as data.

Paper: "Light Controls". A light has a position and an intensity. With a direction or an aim it is a directed
light, which concentration and a cone can narrow. Flaps, half-spaces and links to surfaces and parts can
restrict any light. `lighting.controls` computes the effect of these controls, and `following` the position
of a light that follows something.

To add a light control, give `Light` a field with its column, write its formula in `lighting.controls`, and
name its share in `lighting.light`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import compress
from typing import ClassVar, Final, Unpack

import numpy as np

from autocolor.arrays import unit_vector
from autocolor.checks import Vector
from autocolor.errors import InputError
from autocolor.scene.changes import FlapChanges, FlapsChanges, HalfSpaceChanges, LightChanges, LinksChanges
from autocolor.scene.columns import (
    WORLD_UNITS,
    BarRange,
    Problem,
    Row,
    RowError,
    Tier,
    column_of,
    fields_of,
    replaced,
)
from autocolor.scene.kinds import VectorKind, boolean, coordinates, number, one_of, text, vector
from autocolor.scene.row_kinds import NamedRows, Reference, References, nested, table_row

AXES: Final = ("x", "y", "z")
"""The axes of the world in the order of coordinates."""

FALLOFFS: Final = ("none", "linear", "quadratic")
"""The factor of a light at a fraction f of its reach: 1, 1 - f, or (1 - f)^2."""

EYE: Final = "eye"
"""The value of `follows` of a light that is fixed to the eye."""

LEAST_TURN: Final = 1e-9
"""Assumed: the least sine of the angle between two sides of a triangle. Below it, rounding would decide."""

NUMBER_AT_END: Final = re.compile(r" [0-9]{1,9}\Z")

Names = tuple[str, ...]


@table_row
class Flap(Row):
    """A range of one object coordinate outside of which a light has no effect, and a switch.

    Paper: "Light Flaps and Cones", Figure 9. A point at the minimum or the maximum is lit. With an edge
    width, the light rises from nothing at an end to full light at this distance inside.
    """

    noun: ClassVar[str] = "flap"

    minimum: float = number(
        default=-math.inf,
        endless=-math.inf,
        unit=WORLD_UNITS,
        tier=Tier.LIGHT,
        help="The smallest coordinate that is lit.",
    )
    maximum: float = number(
        default=math.inf,
        endless=math.inf,
        unit=WORLD_UNITS,
        tier=Tier.LIGHT,
        help="The largest coordinate that is lit.",
    )
    on: bool = boolean(default=True, tier=Tier.LIGHT, help="Whether the flap restricts the light.")
    edge_width: float = number(
        default=0.0,
        at_least=0,
        unit=WORLD_UNITS,
        tier=Tier.LIGHT,
        help="The distance inside the ends to full light; 0 for sharp edges.",
    )

    def rules(self) -> Iterator[Problem]:
        """The minimum is at most the maximum."""
        if self.minimum > self.maximum:
            ends = f"{self.minimum:g} to {self.maximum:g}"
            yield Problem((), f"the minimum must be at most the maximum, not {ends}; exchange them")

    def replace(self, /, **changes: Unpack[FlapChanges]) -> Flap:
        """The flap with some fields changed."""
        return replaced(self, changes)


@table_row
class Flaps(Row):
    """The flaps of a light in the X, Y and Z directions; None for no flap."""

    noun: ClassVar[str] = "flaps"

    x: Flap | None = nested(Flap, default=None, tier=Tier.LIGHT, help="The range of X that is lit.")
    y: Flap | None = nested(Flap, default=None, tier=Tier.LIGHT, help="The range of Y that is lit.")
    z: Flap | None = nested(Flap, default=None, tier=Tier.LIGHT, help="The range of Z that is lit.")

    def replace(self, /, **changes: Unpack[FlapsChanges]) -> Flaps:
        """The flaps with some of them changed; a table of fields changes only these fields of a flap."""
        return replaced(self, changes)


@table_row
class HalfSpace(Row):
    """The points on one side of a plane, outside of which a light has no effect, and a switch.

    Paper: "Light Flaps and Cones" names flaps that are not parallel to the axes as an addition. A point of
    the plane is lit. With an edge width, the light rises from nothing at the plane to full light at this
    distance inside. A carried half-space moves and turns with its light, like a barn door: its point and its
    direction are coordinates of `following.light_frame`.
    """

    noun: ClassVar[str] = "half-space"

    name: str = text(tier=Tier.NOTHING, help="The name of the half-space, unique for the light.")
    point: Vector = coordinates(tier=Tier.LIGHT, help="A point of the plane.")
    direction: Vector = vector(
        tier=Tier.LIGHT, help="The direction from the plane to the side that is lit, of any length."
    )
    edge_width: float = number(
        default=0.0,
        at_least=0,
        unit=WORLD_UNITS,
        tier=Tier.LIGHT,
        help="The distance inside the plane to full light; 0 for a sharp edge.",
    )
    carried: bool = boolean(
        default=False, tier=Tier.LIGHT, help="Whether it moves and turns with the light, like a barn door."
    )
    on: bool = boolean(default=True, tier=Tier.LIGHT, help="Whether the half-space restricts the light.")

    @classmethod
    def through(
        cls,
        name: str,
        a: Sequence[float],
        b: Sequence[float],
        c: Sequence[float],
        /,
        **changes: Unpack[HalfSpaceChanges],
    ) -> HalfSpace:
        """The half-space whose plane goes through three points, (3,) each; `a` becomes its point.

        From the lit side, a, b and c turn counterclockwise. `changes` are further fields. Raises InputError
        for an invalid point, and for three points in a line.

            >>> HalfSpace.through("left", (0, 0, 0), (1, 0, 0), (0, 2, 0)).direction
            (0.0, 0.0, 1.0)
        """
        kind, problems = VectorKind(), list[Problem]()
        vectors = [
            kind.validated(point, (key,), problems) for key, point in zip("abc", (a, b, c), strict=True)
        ]
        if problems:
            raise RowError(problems, f"half-space {name!r}")
        points = np.array(vectors)
        # Scale the sides of the triangle first, so that no product over- or underflows.
        to_b, to_c = (side / (np.abs(side).max() or 1.0) for side in points[1:] - points[0])
        across = np.cross(to_b, to_c)
        length = float(np.linalg.norm(across))
        if length <= LEAST_TURN * float(np.linalg.norm(to_b) * np.linalg.norm(to_c)):
            given = ", ".join(str(tuple(point)) for point in points.tolist())
            raise InputError(
                f"half-space {name!r}: its three points must not be in a line, not {given}; move one of them"
            )
        point, direction = tuple(points[0].tolist()), tuple((across / length).tolist())
        return cls(name, point, direction).replace(**changes)

    def replace(self, /, **changes: Unpack[HalfSpaceChanges]) -> HalfSpace:
        """The half-space with some fields changed."""
        return replaced(self, changes)


@table_row
class Links(Row):
    """The surfaces and parts that a light shines on, by name; without names, it shines on everything.

    Departs: a light may shine on some surfaces and parts only; the paper's lights shine on everything. A
    point is lit if the light shines on its surface and on its part.
    """

    noun: ClassVar[str] = "links"

    only_surfaces: Names | None = column_of(
        References("surfaces"),
        default=None,
        tier=Tier.MIX,
        help="The surfaces that it shines on; if absent, all surfaces.",
    )
    except_surfaces: Names | None = column_of(
        References("surfaces"), default=None, tier=Tier.MIX, help="The surfaces that it does not shine on."
    )
    only_parts: Names | None = column_of(
        References("parts"),
        default=None,
        tier=Tier.LIGHT,
        help="The parts that it shines on; if absent, all parts.",
    )
    except_parts: Names | None = column_of(
        References("parts"), default=None, tier=Tier.LIGHT, help="The parts that it does not shine on."
    )

    def rules(self) -> Iterator[Problem]:
        """Surfaces are listed either to shine on or to except, and likewise parts."""
        for table in ("surfaces", "parts"):
            only, excepted = vars(self)[f"only_{table}"], vars(self)[f"except_{table}"]
            if only is not None and excepted is not None:
                rule = f"must be absent where only_{table} is given; leave one out"
                yield Problem((f"except_{table}",), rule)

    def replace(self, /, **changes: Unpack[LinksChanges]) -> Links:
        """The links with some fields changed."""
        return replaced(self, changes)

    @property
    def depend_on_parts(self) -> bool:
        """Whether some parts are not lit."""
        return self.only_parts is not None or self.except_parts is not None

    def shines_on_surface(self, surface: str) -> bool:
        """Whether the light shines on the surface of that name."""
        return bool(_selected([surface], self.only_surfaces, self.except_surfaces))

    def lit_parts(self, parts: Iterable[str]) -> set[str]:
        """The names among `parts` that the light shines on, without regard to their surfaces."""
        return _selected(parts, self.only_parts, self.except_parts)

    def within(self, surfaces: Collection[str], parts: Collection[str]) -> Links:
        """The links without names that are not in `surfaces` or `parts`.

        Assumed: a list that becomes empty is removed, so that the light shines on everything. No picture
        would show a light that shines on nothing.
        """
        remaining = {}
        for field_name, column in fields_of(Links).items():
            existing = surfaces if column.kind == References("surfaces") else parts
            if names := vars(self)[field_name]:
                remaining[field_name] = tuple(name for name in names if name in existing) or None
        return replaced(self, remaining)


def _selected(names: Iterable[str], only: Names | None, excepted: Names | None) -> set[str]:
    """The names that are in `only`, if that is given, and not excepted."""
    # A mesh may have many thousands of parts, so use sets.
    return (set(names) if only is None else set(names).intersection(only)).difference(excepted or ())


AXIS_CONTROLS: Final = ("concentration", "cone_angle", "inner_angle", "at_infinity")
"""The controls of a light that need an axis: a direction or an aim."""


@table_row
class Light(Row):
    """A light.

    With a direction or an aim, it is a directed light; an aim means the direction from the position to the
    aim. Without both, it is a point source. Paper: "Light Direction and Concentration", "Light Flaps and
    Cones". All rays of a light at infinity have its direction, so concentration and cone have no effect;
    flaps do.
    """

    noun: ClassVar[str] = "light"
    elsewhere: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("color", "colour", "light_color"), "; a light has no color here: set the surface's light_color"
    )
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (("direction",), ("aim",))

    name: str = text(tier=Tier.LIGHT, help="The name of the light, which must be unique.")
    position: Vector = coordinates(tier=Tier.LIGHT, help="The position of the light.")
    intensity: float = number(
        default=1.0,
        at_least=0,
        bar=BarRange(0, 2, 0.01),
        tier=Tier.MIX,
        help="The intensity of the light, without an upper limit.",
    )
    on: bool = boolean(default=True, tier=Tier.MIX, help="Whether the light is switched on.")
    direction: Vector | None = vector(
        default=None, tier=Tier.LIGHT, help="The direction of the light, of any length; excludes an aim."
    )
    aim: Vector | None = coordinates(
        default=None, tier=Tier.LIGHT, help="The point at which the light is aimed; excludes a direction."
    )
    concentration: float = number(
        default=0.0,
        at_least=0,
        bar=BarRange(0, 100, 1),
        tier=Tier.LIGHT,
        help="C: the exponent of the cosine of the angle from the direction.",
    )
    cone_angle: float | None = number(
        default=None,
        at_least=0,
        at_most=180,
        above=True,
        unit="degrees",
        bar=BarRange(1, 90, 1),
        start=30.0,
        tier=Tier.LIGHT,
        help="A: the largest angle from the direction that is lit; if absent, there is no cone.",
    )
    inner_angle: float | None = number(
        default=None,
        at_least=0,
        at_most=180,
        unit="degrees",
        bar=BarRange(0, 90, 1),
        start=0.0,
        tier=Tier.LIGHT,
        help="The angle of full light inside the cone; if absent, the cone is sharp.",
    )
    flaps: Flaps = nested(
        Flaps, default=Flaps(), tier=Tier.LIGHT, help="The ranges of object coordinates that are lit."
    )
    half_spaces: tuple[HalfSpace, ...] = column_of(
        NamedRows(HalfSpace), default=(), tier=Tier.LIGHT, help="Flaps along any planes, by name."
    )
    falloff: str = one_of(
        FALLOFFS,
        default="none",
        tier=Tier.LIGHT,
        help="How the light decreases with the distance, to nothing at its reach.",
    )
    reach: float | None = number(
        default=None,
        at_least=0,
        above=True,
        unit=WORLD_UNITS,
        tier=Tier.LIGHT,
        help="The distance at which a light with falloff ends.",
    )
    at_infinity: bool = boolean(
        default=False,
        tier=Tier.LIGHT,
        help="Whether its rays are parallel.",
    )
    follows: str | None = column_of(
        Reference("lights", EYE),
        default=None,
        tier=Tier.LIGHT,
        help="What it moves with: 'eye', or another light's name for the aim of that light.",
    )
    links: Links = nested(
        Links, default=Links(), inline=True, tier=Tier.LIGHT, help="The surfaces and parts that it shines on."
    )

    def rules(self) -> Iterator[Problem]:
        """At most one of direction and aim is given; without both, no control in AXIS_CONTROLS.

        The inner angle is at most the cone angle. A falloff needs a reach.
        """
        if self.direction is not None and self.aim is not None:
            yield Problem((), "it must have a direction or an aim, not both; leave one out")
        if self.aim is not None and self.aim == self.position:
            yield Problem((), f"the aim must differ from the position, {self.aim}; move one of them")
        if self.direction is None and self.aim is None:
            rule = "must come with a direction or an aim, not with a point source; add an aim"
            is_given = (self.concentration > 0, self.cone_angle is not None, self.at_infinity is True)
            for name in compress(("concentration", "cone_angle", "at_infinity"), is_given):
                yield Problem((name,), rule)
        inner, outer = self.inner_angle, self.cone_angle
        if inner is not None and outer is None:
            yield Problem(("inner_angle",), "must come with a cone, not without one; add a cone_angle")
        elif inner is not None and outer is not None and inner > outer:
            rule = f"must be at most the cone_angle, {outer:g}, not {inner:g}; exchange them"
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
        return replaced(self, changes)


def middle_between(one: Vector, other: Vector) -> Vector:
    """The point halfway between two points, however large their coordinates are."""
    x, y, z = (a / 2 + b / 2 for a, b in zip(one, other, strict=True))
    return x, y, z


def free_name(name: str, taken: Collection[str]) -> str:
    """The name if it is not taken; otherwise the name with the lowest number from 2 that is not taken.

    >>> free_name("key", ["key", "key 2"]), free_name("key 2", ["key", "key 2"]), free_name("rim", ["key"])
    ('key 3', 'key 3', 'rim')
    """
    if name not in taken:
        return name
    stem, number = NUMBER_AT_END.sub("", name), 2
    while f"{stem} {number}" in taken:
        number += 1
    return f"{stem} {number}"
