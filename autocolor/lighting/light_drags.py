"""How a light changes when its highlight, or an end of one of its controls, is dragged to what is seen.

Paper: "Light Controls". The paper moves lights in three views; here they follow a point of the picture. These
are functions from a scene to a scene, for `Studio.edit`.
"""

from __future__ import annotations

import math
from typing import Final, get_args

import numpy as np

from autocolor.checks import either, nearest, shown
from autocolor.errors import UsageError
from autocolor.lighting.far_away import seen_from_afar
from autocolor.lighting.light_controls.flap_sides import Axis, FlapEnd, flaps_of
from autocolor.scene.lights.flaps import Flap
from autocolor.scene.lights.following import light_frame
from autocolor.scene.lights.vectors import unit_vector
from autocolor.scene.scene import NORMALS, Scene
from autocolor.visibility.sight import Seen

LEAST_CONE: Final = 0.03
"""Assumed: in degrees; the cosine of a narrower cone can't be told from 1 in float32."""


def highlight_placed(scene: Scene, seen: Seen | None, light: str) -> Scene:
    """The scene with a light moved so that the middle of its highlight, cos(E) = 1, is at a point P.

    The light keeps its distance from P, and moves to where the view is reflected to: to P plus the distance
    times R. If it has an aim, that becomes P; if it has a direction, that leads to P; a point source stays
    one. Assumed: of the places that give this highlight, the one at the same distance changes the light at P
    least. A light at infinity moves and turns in the same way, so that it has this highlight whether it is at
    infinity or not. One that follows something moves in its coordinates, and follows it from then on. Where
    words stand for normals, light and eye are taken as far away: then P is the middle of the object, with the
    normal that is seen.

    There the half vector is the normal, so that the specular factors of Phong and of Blinn are largest at P.
    That of Cook and Torrance still grows from there toward grazing light. Measured on a sphere of 420 lines:
    its largest value is a pixel farther for a roughness of 0.1, up to nine for 0.3, and up to sixty for 0.6.
    So it is where S grows: with an F0 of 0.04 up to six pixels for N = 20, and one for N = 100.

    Raises UsageError on the background, where the normal does not face the eye, because no light has a
    highlight there, and for a light at P itself.
    """
    seen = _on_surface(seen, "a highlight")
    if scene.words == NORMALS:
        seen = seen_from_afar(scene, seen)
    row = scene.light_in_world(light)
    point, reflected = np.array(seen.point), np.array(seen.reflected_view)
    # N.R = N.V is cos(I) of the light in its new place.
    if reflected @ np.array(seen.normal) <= 0:
        raise UsageError(
            f"a highlight must be placed where the normal faces the eye, not where {seen.surface!r} turns"
            " away; choose another pixel"
        )
    position = point + math.dist(row.position, seen.point) * reflected
    if np.array_equal(position, point):
        raise UsageError(
            f"light {light!r} must be away from the point of its highlight, not at {shown(row.position)};"
            " move it first"
        )
    if row.aim is not None:
        return scene.with_light_in_world(light, position=position.tolist(), aim=seen.point)
    if row.direction is not None:
        return scene.with_light_in_world(light, position=position.tolist(), direction=(-reflected).tolist())
    return scene.with_light_in_world(light, position=position.tolist())


def cone_placed(scene: Scene, seen: Seen | None, light: str, add: bool = False) -> Scene:
    """The scene with a light whose cone ends at a point: its angle is that of the point from the direction.

    The angle is at least LEAST_CONE and at most 180 degrees. A soft edge keeps its inner angle, or that of
    the cone if that is smaller. A light without a cone gets one with `add`.
    Raises UsageError on the background, for a light at the point itself, for a point source, for a light at
    infinity, where cones have no effect, and for a light without a cone unless one is to be added.
    """
    seen = _on_surface(seen, "a cone")
    row = scene.light_in_world(light)
    axis = row.axis
    if axis is None:
        raise UsageError(
            f"a cone must have a direction or an aim, not be of the point source {light!r}; add an aim"
        )
    if row.at_infinity:
        raise UsageError(
            f"a cone must end around a light that is somewhere, not around {light!r} at infinity; switch"
            " at_infinity off"
        )
    if row.cone_angle is None and not add:
        raise UsageError(f"light {light!r} must have a cone to be changed, not none; add one")
    toward = np.array(seen.point) - np.array(row.position)
    if not toward.any():
        raise UsageError(
            f"a cone must end away from its light, not at {light!r} itself; choose another pixel"
        )
    # The arc tangent is exact at all angles, which the arc cosine is not.
    toward /= np.abs(toward).max()
    angle = math.degrees(math.atan2(float(np.linalg.norm(np.cross(axis, toward))), float(toward @ axis)))
    angle = min(max(angle, LEAST_CONE), 180.0)
    if row.inner_angle is None:
        return scene.with_light(light, cone_angle=angle)
    return scene.with_light(light, cone_angle=angle, inner_angle=min(row.inner_angle, angle))


def flap_placed(
    scene: Scene, seen: Seen | None, light: str, axis: Axis, end: FlapEnd, add: bool = False
) -> Scene:
    """The scene with a light one of whose flaps ends at a point: at its coordinate.

    The minimum goes no further than the maximum, nor the maximum than the minimum. The flap's switch stays.
    A light without this flap gets one, on, with `add`. Raises UsageError on the background, for an unknown
    axis or end, and for a light without this flap unless one is to be added.
    """
    seen = _on_surface(seen, "a flap")
    for what, name, known in (("axis", axis, get_args(Axis)), ("end", end, get_args(FlapEnd))):
        if name not in known:
            raise UsageError(
                f"the {what} of a flap must be {either(known)}, not {shown(name)}; choose another"
            )
    row = scene.light(light)
    flap = flaps_of(row)[axis]
    if flap is None and not add:
        raise UsageError(f"light {light!r} must have a flap in {axis} to be changed, not none; add one")
    flap = flap or Flap()
    coordinate = seen.point["xyz".index(axis)]
    if end == "minimum":
        flap = flap.replace(minimum=min(coordinate, flap.maximum))
    else:
        flap = flap.replace(maximum=max(coordinate, flap.minimum))
    return scene.with_light(light, flaps=row.flaps.replace(**{axis: flap}))


def half_space_placed(scene: Scene, seen: Seen | None, light: str, name: str) -> Scene:
    """The scene with a light one of whose half-spaces ends at a point: its plane moves along its direction.

    Its own point moves by as little as leads the plane there; so does that of one that the light carries.
    Raises UsageError on the background, and for a light without this half-space.
    """
    seen = _on_surface(seen, "a half-space")
    row = scene.light_in_world(light)
    half_space = next((each for each in row.half_spaces if each.name == name), None)
    if half_space is None:
        known = nearest(name, [each.name for each in row.half_spaces])
        raise UsageError(f"there is no half-space {shown(name)} of light {light!r}{known or '; add one'}")
    point = seen.point
    if half_space.carried:
        point = light_frame(row).point_from_world(point)
    direction = np.array(unit_vector(half_space.direction))
    start = np.array(half_space.point)
    moved = start + (direction @ (np.array(point) - start)) * direction
    return scene.with_light(light, half_spaces={name: {"point": moved.tolist()}})


def _on_surface(seen: Seen | None, what: str) -> Seen:
    if seen is None:
        raise UsageError(f"{what} must be dragged to a surface, not to the background; choose another pixel")
    return seen
