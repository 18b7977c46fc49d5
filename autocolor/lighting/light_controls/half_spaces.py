"""Half-spaces: flaps along any planes.

Paper: "Light Flaps and Cones" names flaps that are not parallel to the axes as an addition.
"""

from __future__ import annotations

from dataclasses import dataclass

from autocolor.lighting.light_controls.control import registered
from autocolor.lighting.light_controls.sides import Side, Sides, side_of
from autocolor.scene.lights.carried import set_down
from autocolor.scene.lights.light import Light
from autocolor.scene.lights.vectors import unit_vector
from autocolor.visibility.visible_points import VisiblePoints


@registered
@dataclass(frozen=True, eq=False)
class HalfSpaces(Sides):
    """The half-spaces that are on: only what is inside all of them is lit.

    Departs: the paper has flaps along the axes alone. A point of a plane is lit, as that of a flap. What is
    left near soft edges is computed in `soft_sides`.
    """

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> HalfSpaces | None:
        """The half-spaces of a light, if any is on."""
        sides = half_space_sides(light, points)
        return cls.made_of(list(sides.values())) if sides else None


def half_space_sides(light: Light, points: VisiblePoints) -> dict[str, Side]:
    """The sides of the half-spaces that are on, by name; carried ones are where their light is."""
    sides: dict[str, Side] = {}
    for half_space in light.half_spaces:
        if half_space.on:
            placed = set_down(half_space, light)
            direction = unit_vector(placed.direction)
            least = sum(a * b for a, b in zip(direction, placed.point, strict=True))
            sides[half_space.name] = side_of(points, direction, least, half_space.edge_width)
    return sides
