"""The view: eye position, view direction, rotation of the picture plane, and field of view; named views.

Paper: "Light Direction and Concentration", Figure 5 (eye, view direction, RESCALE, ANGLE).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import ClassVar, Final, NamedTuple, Unpack

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.immutable import read_only
from autocolor.scene.changes import NamedViewChanges, ViewChanges
from autocolor.scene.columns import BarRange, Problem, Row, Tier, replaced
from autocolor.scene.kinds import coordinates, number, short_turn, text, vector
from autocolor.scene.row_kinds import nested, table_row

MOST_VIEWS: Final = 64
"""Limit: named views of a scene."""

ASPECT: Final = 640 / 480
"""Assumed: the width over the height of the paper's display."""

VERTICAL: Final = 1e-9
"""Assumed: a view is vertical if the eye's horizontal distance from the target is a smaller part of its
height over the target."""


class Polar(NamedTuple):
    """A place as seen from a point: azimuth from +x toward +y and elevation, in degrees, and distance."""

    azimuth: float
    elevation: float
    distance: float

    def between(self, other: Polar, share: float) -> Polar:
        """The place at a share of the way to another place. Opposite azimuths turn counterclockwise."""
        right = short_turn(self.azimuth, other.azimuth)
        return Polar(
            self.azimuth + share * right,
            self.elevation + share * (other.elevation - self.elevation),
            self.distance + share * (other.distance - self.distance),
        )

    def from_point(self, point: Vector) -> Vector:
        """The place in world coordinates, as seen from a point."""
        azimuth, elevation = math.radians(self.azimuth), math.radians(self.elevation)
        flat = self.distance * math.cos(elevation)
        x, y, z = point
        return (
            x + flat * math.cos(azimuth),
            y + flat * math.sin(azimuth),
            z + self.distance * math.sin(elevation),
        )


@table_row
class View(Row):
    """An eye position, and a view direction or a target. The world's z axis points up."""

    noun: ClassVar[str] = "view"
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (("direction",), ("target",))

    eye: Vector = coordinates(tier=Tier.FRAME, help="The position of the eye.")
    direction: Vector | None = vector(
        default=None, tier=Tier.FRAME, help="The view direction, of any length; excludes a target."
    )
    target: Vector | None = coordinates(
        default=None, tier=Tier.FRAME, help="The point that the eye looks at; excludes a direction."
    )
    angle: float = number(
        default=0.0,
        turns=True,
        unit="degrees",
        bar=BarRange(-180, 180, 1),
        tier=Tier.FRAME,
        help="The rotation of the horizontal axis of the picture plane.",
    )
    field_of_view: float = number(
        default=30.0,
        at_least=0.01,
        at_most=179,
        unit="degrees",
        bar=BarRange(5, 120, 1),
        tier=Tier.FRAME,
        help="The vertical field of view at 4:3 and wider; narrower pictures have the horizontal one of 4:3.",
    )

    def rules(self) -> Iterator[Problem]:
        """Exactly one of direction and target is given, and the target is not the eye."""
        if (self.direction is None) == (self.target is None):
            yield Problem((), "it must have either a direction or a target; give one of them")
        elif self.target is not None and self.target == self.eye:
            yield Problem((), f"the target must differ from the eye, {self.eye}; move one of them")

    @cached_property
    def axes(self) -> Floats:
        """The axes of camera space, right, down and forward, as the rows of a (3, 3) rotation matrix.

        The camera coordinates of a point are axes @ (point - eye): x to the right, like elements; y down,
        like lines; and the depth along the view direction.
        Assumed: if the view direction is vertical, the top of the picture is +y.
        """
        if self.direction is not None:
            toward = np.array(self.direction)
        else:
            assert self.target is not None
            toward = np.array(self.target) - np.array(self.eye)
        x, y, z = (toward / np.abs(toward).max()).tolist()
        length = math.hypot(x, y, z)
        x, y, z = x / length, y / length, z / length
        # Right is forward x up, and down is forward x right. Measured: np.cross takes ten times as long.
        u, v, w, flat = y, -x, 0.0, math.hypot(x, y)
        # Closer to the vertical than this, rounding errors would determine the rotation of the picture.
        if flat < VERTICAL:
            u, v, w, flat = -z, 0.0, x, math.hypot(z, x)
        u, v, w = u / flat, v / flat, w / flat
        right, down = np.array([u, v, w]), np.array([y * w - z * v, z * u - x * w, x * v - y * u])
        turn = math.radians(self.angle)
        cosine, sine = math.cos(turn), math.sin(turn)
        axes = np.array([cosine * right - sine * down, sine * right + cosine * down, (x, y, z)])
        return read_only(axes)

    def half_height(self, aspect: float) -> float:
        """Half the height of a picture at a depth of 1; `aspect` is its width over its height.

        Assumed: a picture that is narrower than 4:3 shows more above and below. With the same height it would
        cut off the sides of the object.
        """
        return math.tan(math.radians(self.field_of_view) / 2) * max(1.0, ASPECT / aspect)

    def between(self, other: View, share: float) -> View:
        """The view at a share of the way to another view, unchecked: the eye turns around the target.

        The azimuth goes the shortest way, elevation and distance are linear, and the target moves along a
        line. An eye that is the same in both views stays. Assumed: where a view has a direction, the eye
        moves along a line, and the direction turns by azimuth and elevation, so that the horizon stays level.
        """
        if other is self:
            return self
        mixed = super().between(other, share)
        if self.target is not None and other.target is not None:
            if self.eye != other.eye:
                away = self.polar(self.target).between(other.polar(other.target), share)
                vars(mixed)["eye"] = away.from_point(vars(mixed)["target"])
        elif (self.direction, self.target) != (other.direction, other.target):
            x, y, z = self._away.between(other._away, share).from_point((0.0, 0.0, 0.0))
            vars(mixed).update(direction=(0.0 - x, 0.0 - y, 0.0 - z), target=None)
        return mixed

    def polar(self, target: Vector) -> Polar:
        """The place of the eye as seen from a point.

        If the eye is vertically above or below, the azimuth is that of the picture's bottom or top.
        """
        return self._polar(*(a - b for a, b in zip(self.eye, target, strict=True)))

    @property
    def _away(self) -> Polar:
        """The direction against the view direction, with a distance of 1."""
        return self._polar(*(-self.axes[2]).tolist())

    def _polar(self, x: float, y: float, z: float) -> Polar:
        flat = math.hypot(x, y)
        # The picture's bottom points to the side of a lower eye; seen from below, its top does.
        bottom = (self.axes[1] if z > 0 else -self.axes[1]).tolist()
        is_vertical = flat < VERTICAL * abs(z)
        azimuth = math.atan2(bottom[1], bottom[0]) if is_vertical else math.atan2(y, x)
        return Polar(math.degrees(azimuth), math.degrees(math.atan2(z, flat)), math.hypot(x, y, z))

    def orbit_target(self, low: Vector, high: Vector) -> Vector:
        """The point to orbit: the target, else the point on the line of sight at the depth of the object.

        `low` and `high` are the object's bounds.
        """
        if self.target is not None:
            return self.target
        eye, forward = np.array(self.eye), self.axes[2]
        depth = float(((np.array(low) + np.array(high)) / 2 - eye) @ forward)
        x, y, z = (eye + forward * max(depth, math.dist(low, high) / 2 or 1.0)).tolist()
        return x, y, z

    def replace(self, /, **changes: Unpack[ViewChanges]) -> View:
        """The view with some fields changed; a new direction removes the target, and vice versa."""
        return replaced(self, changes)


@table_row
class NamedView(Row):
    """A view with a name, to come back to."""

    noun: ClassVar[str] = "named view"

    name: str = text(tier=Tier.NOTHING, help="The name, unique among the named views.")
    view: View = nested(View, inline=True, tier=Tier.NOTHING, help="The view.")

    def replace(self, /, **changes: Unpack[NamedViewChanges]) -> NamedView:
        """The named view with some fields changed, also fields of its view."""
        return replaced(self, changes)
