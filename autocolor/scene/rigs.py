"""Lights moved as a whole: rigs, which light another object in the same way, and mirrored lights.

A rig has the lights of a scene and the size of its object. Assumed: the lights keep their directions and
their places relative to the object. They are moved with the middle of its box, and are nearer or farther as
the diagonal of the box is shorter or longer. Lights that follow something keep their place relative to that,
nearer or farther. Widths and reaches are scaled with the diagonal. Intensities stay, as the light at a point
does not depend on its distance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import ClassVar

import numpy as np

from autocolor.checks import Vector, either
from autocolor.errors import UsageError
from autocolor.scene.columns import REFUSED, WORLD_UNITS, Problem, Row, Tier, column_of, fields_of, replaced
from autocolor.scene.following import light_frame, moved_vectors
from autocolor.scene.kinds import Number, coordinates
from autocolor.scene.lights import AXES, Flap, HalfSpace, Light, middle_between
from autocolor.scene.row_kinds import RowList, TableRows, table_row


@table_row
class Rig(Row):
    """The lights of a scene, and the least and the largest coordinates of the object that they light."""

    noun: ClassVar[str] = "rig"

    minimum: Vector = coordinates(tier=Tier.LIGHT, help="The smallest coordinates of the object.")
    maximum: Vector = coordinates(tier=Tier.LIGHT, help="The largest coordinates of the object.")
    lights: TableRows[Light] = column_of(
        RowList(Light), default=TableRows(), tier=Tier.MIX, help="The lights."
    )

    def rules(self) -> Iterator[Problem]:
        """No coordinate of the minimum is above that of the maximum."""
        if self.minimum is not REFUSED and self.maximum is not REFUSED:
            for axis, low, high in zip(AXES, self.minimum, self.maximum, strict=True):
                if low > high:
                    ends = f"{low:g} to {high:g}"
                    yield Problem(
                        (), f"the minimum of {axis} must be at most the maximum, not {ends}; exchange them"
                    )

    def fitted(self, minimum: Vector, maximum: Vector) -> tuple[Light, ...]:
        """The lights fitted to an object with other least and largest coordinates.

        For the same object they are exactly the same lights. An object that is a point has no size: then
        distances stay. Raises InputError if a coordinate would be too large, or a light and its aim would be
        too close to each other.
        """
        if (minimum, maximum) == (self.minimum, self.maximum):
            return self.lights
        before, after = math.dist(self.minimum, self.maximum), math.dist(minimum, maximum)
        scale = after / before if before > 0 and after > 0 else 1.0
        old = middle_between(self.minimum, self.maximum)
        new = middle_between(minimum, maximum)
        return tuple(_moved(light, scale, old, new) for light in self.lights)


def _moved(light: Light, scale: float, old: Vector, new: Vector) -> Light:
    """The light scaled about the point `old`, which moves to `new`.

    A light that follows something is scaled about the origin of its frame, and a carried half-space about its
    light.
    """

    def moved(axis: int, value: float) -> float:
        return new[axis] + scale * (value - old[axis])

    def moved_point(point: Vector) -> Vector:
        return moved(0, point[0]), moved(1, point[1]), moved(2, point[2])

    def scaled_point(point: Vector) -> Vector:
        x, y, z = (scale * component for component in point)
        return x, y, z

    def half_space(row: HalfSpace) -> HalfSpace:
        vectors = moved_vectors(row, scaled_point if row.carried else moved_point, _same)
        return replaced(row, {**vectors, **_scaled_lengths(row, scale)})

    flaps = {}
    for axis, name in enumerate(AXES):
        flap: Flap | None = vars(light.flaps)[name]
        if flap is not None:
            ends = {"minimum": moved(axis, flap.minimum), "maximum": moved(axis, flap.maximum)}
            flaps[name] = replaced(flap, {**_scaled_lengths(flap, scale), **ends})
    vectors = moved_vectors(light, moved_point if light.follows is None else scaled_point, _same)
    return replaced(
        light,
        {
            **vectors,
            **_scaled_lengths(light, scale),
            "flaps": flaps,
            "half_spaces": [half_space(row) for row in light.half_spaces],
        },
    )


def _same(direction: Vector) -> Vector:
    return direction


def _scaled_lengths(row: Row, scale: float) -> dict[str, float]:
    """The lengths of a row, which are in world units, by column, times a scale; None values are left out."""
    return {
        name: scale * vars(row)[name]
        for name, column in fields_of(type(row)).items()
        if isinstance(column.kind, Number) and column.unit == WORLD_UNITS and vars(row)[name] is not None
    }


def mirrored(light: Light, name: str, axis: str, about: float) -> Light:
    """The light mirrored in the plane where the coordinate of an axis is `about`, under another name.

    Its position, its aim or direction, its half-spaces and the flap of that axis are mirrored. Raises
    UsageError for an axis that is not x, y or z, InputError if a coordinate would be too large.
    """
    number = axis_number(axis)
    flap: Flap | None = vars(light.flaps)[axis]
    if flap is not None:
        flap = flap.replace(minimum=2 * about - flap.maximum, maximum=2 * about - flap.minimum)
    vectors = moved_vectors(light, _reflection(number, about), _reflection(number, 0.0))
    copy = replaced(light, {**vectors, "name": name, "flaps": {axis: flap}})
    if not light.half_spaces:
        return copy
    mirror = np.eye(3)
    mirror[number, number] = -1
    # Mirrored axes are left-handed, and the frame of the copy is right-handed: one of its axes is reversed.
    turned = np.diag(light_frame(copy).axes @ mirror @ light_frame(light).axes.T) < 0
    half_spaces = []
    for row in light.half_spaces:
        copied = row
        for each in np.flatnonzero(turned).tolist() if row.carried else [number]:
            point = _reflection(each, 0.0 if row.carried else about)
            copied = replaced(copied, moved_vectors(copied, point, _reflection(each, 0.0)))
        half_spaces.append(copied)
    return copy.replace(half_spaces=half_spaces)


def axis_number(axis: str) -> int:
    """The number of an axis, 0 to 2. Raises UsageError for any other name than x, y and z."""
    if axis not in AXES:
        raise UsageError(f"an axis must be {either(AXES)}, not {axis!r}")
    return AXES.index(axis)


def _reflection(axis: int, about: float) -> Callable[[Vector], Vector]:
    """The function that mirrors points in the plane where the coordinate of an axis is `about`."""

    def reflected(point: Vector) -> Vector:
        x, y, z = (
            2 * about - component if number == axis else component for number, component in enumerate(point)
        )
        return x, y, z

    return reflected
