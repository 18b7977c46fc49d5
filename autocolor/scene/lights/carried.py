"""What a light carries, as barn doors are: half-spaces in the frame of the light, and in the world.

The lights are in world coordinates here, where they follow nothing; see `following.lights_in_world`.
"""

from __future__ import annotations

from autocolor.scene.columns.rows import with_values
from autocolor.scene.lights.following import light_frame
from autocolor.scene.lights.half_spaces import HalfSpace
from autocolor.scene.lights.light import Light


def set_down(half_space: HalfSpace, light: Light) -> HalfSpace:
    """The half-space of a light in world coordinates; the same one if it is not carried."""
    if not half_space.carried:
        return half_space
    frame = light_frame(light)
    return with_values(
        half_space,
        {
            "point": frame.point_to_world(half_space.point),
            "direction": frame.direction_to_world(half_space.direction),
            "carried": False,
        },
    )


def taken_up(half_space: HalfSpace, light: Light) -> HalfSpace:
    """The half-space in the frame of its light, carried from now on; its plane stays where it is."""
    if half_space.carried:
        return half_space
    frame = light_frame(light)
    return with_values(
        half_space,
        {
            "point": frame.point_from_world(half_space.point),
            "direction": frame.direction_from_world(half_space.direction),
            "carried": True,
        },
    )
