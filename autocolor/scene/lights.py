"""A light and its controls, as data.

Paper: "Light Controls". A light has a position and an intensity; a direction makes it a directed light,
whose concentration, cone and flaps restrict and shape what it gives. What these numbers do to the light at
a point is computed in `light_controls`.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from autocolor.checks import Vector, finite, known_fields, switch, text, vector
from autocolor.errors import InputError


@dataclass(frozen=True)
class Flap:
    """A minimum and a maximum of one object coordinate, with a switch that keeps both.

    Paper: "Light Flaps and Cones", Figure 9. A point outside gets nothing from the light; a point at the
    minimum or the maximum is lit.
    """

    minimum: float = -math.inf
    maximum: float = math.inf
    on: bool = True

    def __post_init__(self) -> None:
        problems: list[str] = []
        for name in ("minimum", "maximum"):
            value = getattr(self, name)
            open_end = -math.inf if name == "minimum" else math.inf
            if not (isinstance(value, float) and value == open_end):
                value = finite(problems, f"a flap's {name}", value)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "on", switch(problems, "a flap's switch", self.on))
        if not problems and self.minimum > self.maximum:
            problems.append(
                f"a flap's minimum must not be above its maximum, not {self.minimum:g} to {self.maximum:g}"
            )
        if problems:
            raise InputError(problems)

    def replace(self, **changes: Any) -> Flap:
        """The flap with some fields changed."""
        return dataclasses.replace(self, **known_fields(Flap, changes, "flap"))


@dataclass(frozen=True)
class Flaps:
    """The flaps of one light in the X, Y and Z directions; None where there is no flap."""

    x: Flap | None = None
    y: Flap | None = None
    z: Flap | None = None

    def __post_init__(self) -> None:
        for axis in "xyz":
            flap = getattr(self, axis)
            if isinstance(flap, Mapping):
                object.__setattr__(self, axis, Flap(**known_fields(Flap, flap, f"flap {axis}")))
            elif flap is not None and not isinstance(flap, Flap):
                raise InputError(
                    f"flap {axis} must be a Flap or a table of minimum, maximum and on, not {flap!r}"
                )

    def replace(self, **changes: Any) -> Flaps:
        """The flaps with some of them changed; a table of some fields of a flap leaves its others."""
        changes = known_fields(Flaps, changes, "flaps")
        for axis, change in changes.items():
            flap = getattr(self, axis)
            if isinstance(change, Mapping) and flap is not None:
                changes[axis] = flap.replace(**change)
        return dataclasses.replace(self, **changes)


@dataclass(frozen=True)
class Light:
    """One light of the studio.

    `position` and `aim` are points in world coordinates; `direction` is a vector of any length. A light has
    a direction or an aim (the direction then follows the position) or neither: then it is a point source.
    `concentration` is the exponent C >= 0, `cone_angle` the angle A in degrees, above 0 to 180, from the
    direction; `intensity` is at least 0 and has no upper limit.
    Paper: "Light Direction and Concentration", "Light Flaps and Cones".
    """

    name: str
    position: Vector
    intensity: float = 1.0
    on: bool = True
    direction: Vector | None = None
    aim: Vector | None = None
    concentration: float = 0.0
    cone_angle: float | None = None
    flaps: Flaps = field(default_factory=Flaps)

    def __post_init__(self) -> None:
        problems: list[str] = []
        text(problems, "a light's name", self.name)
        place = f"light {self.name!r}"

        def keep(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        keep("position", vector(problems, f"{place}: position", self.position))
        keep("intensity", finite(problems, f"{place}: intensity", self.intensity, at_least=0.0))
        keep("concentration", finite(problems, f"{place}: concentration", self.concentration, at_least=0.0))
        keep("on", switch(problems, f"{place}: on", self.on))
        if self.direction is not None:
            keep("direction", vector(problems, f"{place}: direction", self.direction, not_zero=True))
        if self.aim is not None:
            keep("aim", vector(problems, f"{place}: aim", self.aim))
        if self.cone_angle is not None:
            angle = finite(problems, f"{place}: cone_angle", self.cone_angle, at_least=0.0, at_most=180.0)
            if angle == self.cone_angle == 0:
                problems.append(f"{place}: cone_angle must be above 0, not 0; leave it out for no cone")
            keep("cone_angle", angle)
        if isinstance(self.flaps, Mapping):
            try:
                keep("flaps", Flaps(**known_fields(Flaps, self.flaps, "flaps")))
            except InputError as error:
                problems.extend(f"{place}: {problem}" for problem in error.problems)
        elif not isinstance(self.flaps, Flaps):
            problems.append(f"{place}: flaps must be a table of x, y and z, not {self.flaps!r}")
        if not problems:
            problems.extend(self._direction_problems(place))
        if problems:
            raise InputError(problems)

    def _direction_problems(self, place: str) -> list[str]:
        if self.direction is not None and self.aim is not None:
            return [f"{place}: it must have a direction or an aim, not both; leave one out"]
        if self.aim is not None and self.aim == self.position:
            return [f"{place}: the aim must not be the position, not both {self.aim}; move one of them"]
        if self.direction is None and self.aim is None:
            controls = ["concentration"] * (self.concentration > 0) + ["cone_angle"] * (
                self.cone_angle is not None
            )
            return [
                f"{place}: {name} must come with a direction or an aim, not with a point source; add an aim"
                for name in controls
            ]
        return []

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

    def replace(self, **changes: Any) -> Light:
        """The light with some fields changed; giving a direction drops the aim, and the other way round.

        Raises InputError for an unknown field or a value that breaks a rule.
        """
        changes = known_fields(Light, changes, f"light {self.name!r}")
        if changes.get("direction") is not None and "aim" not in changes:
            changes["aim"] = None
        if changes.get("aim") is not None and "direction" not in changes:
            changes["direction"] = None
        if isinstance(changes.get("flaps"), Mapping):
            changes["flaps"] = self.flaps.replace(**changes["flaps"])
        return dataclasses.replace(self, **changes)
