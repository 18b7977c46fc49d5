"""Where a light shows in the picture, and how a drag there changes it: highlights, cones, flaps, half-spaces.

Paper: "Light Controls". The paper moves lights in three views; here they follow a point of the picture. The
functions that place a highlight or a rim take a scene and return a scene, for `Studio.edit`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Final, Literal

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, chunks, columns, dot, underflowing, unit_vector
from autocolor.errors import UsageError
from autocolor.lighting.controls import Axis, FlapEnd, Plane, flaps_of, is_inside, sides_of
from autocolor.lighting.light import CameraLight, exact_rays_to, is_within, rays_to
from autocolor.lighting.picture import Picture
from autocolor.lighting.rays import camera_light, direction_to_eye, direction_to_light, fast_rays, middle_of
from autocolor.lighting.shading import SPECULAR
from autocolor.scene.changes import LightChanges
from autocolor.scene.following import light_frame
from autocolor.scene.lights import Light
from autocolor.scene.row_kinds import place_named
from autocolor.scene.scene import NORMALS, Scene
from autocolor.visibility.projection import focal_length
from autocolor.visibility.visible_points import NORMAL, PIXELS_AT_ONCE, POINT, Seen, Sight, VisiblePoints

ROUNDING: Final = 1e-5
"""Assumed: above the rounding of a cosine in float32, which many pixels around a highlight may share."""

LEAST_CONE: Final = 0.03
"""Assumed: in degrees; a narrower cone lights hardly a point."""

LARGEST_GAP: Final = 4.0
"""Assumed: in pixels at their distance; a neighbor farther before or behind the tangent plane belongs to
another surface, or is behind the silhouette."""

CELL: Final = 16
"""Assumed: pixels across the squares in which the light of a highlight is added up."""

CONE: Final = "cone"

Rim = Literal["cone"] | tuple[Axis, FlapEnd] | Plane
"""The rim of a cone, of an end of the flap along an axis, or of a half-space."""


@underflowing
def highlight_of(sight: Sight, light: str, surface: str | None = None) -> tuple[int, int] | None:
    """The line and the element where the highlight of a light is: the pixel with the largest cos(E).

    This is the inverse of `highlight_placed`. If a surface is named, only its pixels count. The result is
    None if no visible point has both cos(E) and cos(I) above 0. The light may be off, and its controls do not
    matter. If words stand for normals, light and eye are taken as far away. Raises UsageError for an unknown
    light or surface.
    """
    scene, points = sight.scene, sight.points
    row = scene.lights_in_world[light]
    camera = camera_light(row, points)
    # Without a name, a highlight is on the object, not on the stage that is made around it.
    names = {row.name for row in scene.surfaces} - {scene.stage_surface}
    if surface is not None:
        names = {scene.surfaces[place_named(scene.surfaces, surface)].name}
    most, found = 0.0, None
    for each in (each for each in points.slices if scene.surfaces[each.surface_number - 1].name in names):
        for chunk in chunks(each.stop, PIXELS_AT_ONCE, each.start):
            if scene.words == NORMALS:
                cosines = _cosines_from_afar(scene, row, points, chunk)
            else:
                cosines = _cosines(camera, points, chunk)
            place = int(cosines.argmax())
            if cosines[place] > most:
                most, found = float(cosines[place]), chunk.start + place
    if found is None:
        return None
    line, element = sight.pixels_of(points.pixels[[found]])[0].tolist()
    return line, element


def _cosines(light: CameraLight, points: VisiblePoints, pixels: slice) -> Floats:
    """cos(E) at some visible points, (points,), near its maximum exact; -1 where cos(I) is not above 0."""
    rays, _ = fast_rays(light, points.rows[:, pixels], points.radius)
    cosines: Floats = np.where(rays.cos_incidence > 0, rays.cos_eye, np.float64(-1))
    near = np.flatnonzero(cosines >= max(cosines.max() - ROUNDING, 0))
    cosines[near] = exact_rays_to(light, columns(rays.rows, near)).cos_eye
    return cosines


def _cosines_from_afar(scene: Scene, light: Light, points: VisiblePoints, pixels: slice) -> Floats:
    """The same for a light and an eye far away."""
    to_eye = direction_to_eye(scene)
    to_light = scene.view.axes @ np.array(direction_to_light(light, middle_of(scene)))
    # L . R, for the reflected view R = 2 (N.V) N - V.
    along_eye, along_light = np.stack([to_eye, to_light]) @ points.rows[NORMAL, pixels]
    cosines: Floats = 2 * along_eye * along_light - to_eye @ to_light
    cosines[along_light <= 0] = -1
    return cosines


# What is seen of a highlight: its share of the picture, with all controls of the light.


def seen_highlight(picture: Picture, light: str, surface: str | None = None) -> tuple[int, int] | None:
    """The line and the element where the highlight of a light is seen, on one surface or on all.

    Assumed: this is the brightest pixel of the light's specular plane in the square of CELL pixels that has
    the largest sum. A bright edge of a few pixels has the largest cos(E), but a broad reflection is what the
    eye sees. None for a light without planes, or without specular reflection there.
    """
    planes = picture.light_planes.get(light)
    if planes is None:
        return None
    number = None if surface is None else picture.surfaces.index(surface) + 1
    best, largest = None, 0.0
    across = -(-picture.elements // CELL)
    for each in (each for each in picture.slices if number in (None, each.surface_number)):
        values, pixels = planes.values[SPECULAR, each.pixels], picture.pixels[each.pixels]
        lines, elements = np.divmod(pixels, picture.elements)
        cells = lines // CELL * across + elements // CELL
        sums = planes.weights[each.surface_number][SPECULAR] * np.bincount(cells, weights=values)
        cell = int(sums.argmax())
        if sums[cell] > largest:
            inside = np.flatnonzero(cells == cell)
            best, largest = int(pixels[inside[values[inside].argmax()]]), float(sums[cell])
    return None if best is None else divmod(best, picture.elements)


def specular_shares(picture: Picture, line: int, element: int) -> Mapping[str, float]:
    """The specular part of each light with planes at a pixel, in proportion; empty on the background."""
    places = np.flatnonzero(picture.pixels == line * picture.elements + element)
    return {
        name: float(planes.weights[each.surface_number][SPECULAR] * planes.values[SPECULAR, place])
        for place in places.tolist()
        for each in picture.slices
        if each.start <= place < each.stop
        for name, planes in picture.light_planes.items()
    }


def highlight_placed(scene: Scene, seen: Seen | None, light: str) -> Scene:
    """The scene with a light moved so that the middle of its highlight, cos(E) = 1, is at a point P.

    The light keeps its distance from P, and moves to P plus the distance times R, where the view is reflected
    to. Its aim, if any, becomes P; its direction, if any, leads to P. Assumed: of all places that give this
    highlight, the place at the same distance changes the light at P least. A light at infinity moves and
    turns in the same way, so that it has this highlight whether it is at infinity or not. A light that
    follows something still follows it. If words stand for normals, light and eye are taken as far away: then
    P is the middle of the object, with the normal that is seen.

    The half vector is then the normal, so that the specular factors of Phong and of Blinn are largest at P.
    The factor of Cook and Torrance still grows from there toward grazing light: measured on a sphere of 420
    lines, by up to nine pixels for a roughness of 0.3. So does an S that grows with the angle of incidence.

    Raises UsageError on the background, and where the normal does not face the eye, because no light has a
    highlight there.
    """
    seen = _on_surface(seen, "a highlight")
    row = scene.lights_in_world[light]
    point, normal, reflected = (np.array(each) for each in (seen.point, seen.normal, seen.reflected_view))
    if scene.words == NORMALS:
        point = np.array(middle_of(scene))
        to_eye = direction_to_eye(scene) @ scene.view.axes
        reflected = 2 * (normal @ to_eye) * normal - to_eye
    # N.R = N.V is cos(I) of the light in its new place.
    if reflected @ normal <= 0:
        raise UsageError(
            f"a highlight must be placed where the normal faces the eye, not where {seen.surface!r} turns"
            " away; choose another pixel"
        )
    changes: LightChanges = {"position": (point + math.dist(row.position, point) * reflected).tolist()}
    if row.aim is not None:
        changes["aim"] = point.tolist()
    elif row.direction is not None:
        changes["direction"] = (-reflected).tolist()
    return scene.with_light_in_world(light, **changes)


def _on_surface(seen: Seen | None, what: str) -> Seen:
    if seen is None:
        raise UsageError(f"{what} must be dragged to a surface, not to the background; choose another pixel")
    return seen


@underflowing
def rims(sight: Sight, light: str) -> Mapping[Rim, Indices]:
    """The pixels at which the cone, the flaps and the half-spaces of a light end, (n, 2): line and element.

    There are arrays for the cone, for the finite ends of the flaps that are on, and for the half-spaces that
    are on. An array is empty if the rim is not visible. A pixel of a rim is inside, and one of its four
    neighbors is outside on the same surface: so no silhouette is a rim. Every control has its own rim, even
    where another control leaves nothing of the light. The rim of a soft edge is its dark end. Raises
    UsageError for an unknown light.
    """
    points = sight.points
    places = np.empty(points.lines * points.elements, np.intp)
    places[points.pixels] = np.arange(len(points.pixels))
    return {
        rim: sight.pixels_of(_rim(points, inside, places))
        for rim, inside in _inside(points, sight.scene.lights_in_world[light])
    }


def _rim(points: VisiblePoints, inside: Booleans, places: Indices) -> Indices:
    """The pixels of a rim, given whether each point is inside, and the place of the point at each pixel."""
    # Find the pairs of neighbors that differ: 2 is inside, 1 is outside, and 0 the background.
    raster = np.zeros(len(places), np.uint8)
    raster[points.pixels] = inside + np.uint8(1)
    pairs = []
    for step in (1, points.elements):
        # Measured: numpy finds the places of true booleans in an eighth of the time that other bytes take.
        before = np.flatnonzero(raster[:-step] + raster[step:] == 3)
        if step == 1:
            # The last pixel of a line is no neighbor of the first of the next.
            before = before[(before + 1) % points.elements > 0]
        pairs.append([before, before + step])
    before, after = np.concatenate(pairs, axis=1)

    # Of each pair on one surface, take the pixel that is inside.
    is_near = _are_on_one_surface(points, places[before], places[after])
    return np.unique(np.where(raster[before] == 2, before, after)[is_near])


def _inside(points: VisiblePoints, light: Light) -> Iterator[tuple[Rim, Booleans]]:
    """Whether each point is inside the cone, each end of the flaps and each half-space, as in shading."""
    if light.cone_angle is not None:
        camera, inside = camera_light(light, points), np.empty(len(points.pixels), np.bool_)
        for chunk in points.chunks:
            rays = rays_to(camera, points.rows[:, chunk.pixels])
            inside[chunk.pixels] = is_within(rays, light.cone_angle)
        yield CONE, inside
    for rim, side in sides_of(light, points).items():
        yield rim, is_inside(side, points.rows[POINT])


def _are_on_one_surface(points: VisiblePoints, one: Indices, other: Indices) -> Booleans:
    """Whether each of two neighboring points is close to the tangent plane of the other."""
    at_one, at_other = (points.rows[POINT].take(places, axis=1) for places in (one, other))
    between = at_other - at_one
    depth = at_one[2] + np.float32(points.origin[2])
    focal = focal_length(points.lines, points.elements, points.view.field_of_view)
    most = depth * np.float32(LARGEST_GAP / focal)
    normals = (points.rows[NORMAL].take(places, axis=1) for places in (one, other))
    close: Booleans = np.logical_and.reduce([np.abs(dot(each, between)) <= most for each in normals])
    return close


def cone_placed(scene: Scene, seen: Seen | None, light: str) -> Scene:
    """The scene in which the cone of a light ends at a visible point: the cone angle is L of the point.

    The light must have a cone. The angle is at least LEAST_CONE and at most 180 degrees. The inner angle
    stays, but it is at most the cone angle. Raises UsageError on the background.
    """
    seen = _on_surface(seen, "a cone")
    row = scene.lights_in_world[light]
    assert row.axis is not None
    toward = np.subtract(seen.point, row.position)
    # The arc tangent is exact at all angles, which the arc cosine is not.
    tangent = math.hypot(*np.cross(row.axis, toward)), float(np.dot(row.axis, toward))
    angle = max(math.degrees(math.atan2(*tangent)), LEAST_CONE)
    inner = None if row.inner_angle is None else min(row.inner_angle, angle)
    return scene.with_light(light, cone_angle=angle, inner_angle=inner)


def flap_placed(scene: Scene, seen: Seen | None, light: str, axis: Axis, end: FlapEnd) -> Scene:
    """The scene with a light whose flap along an axis, which it has, ends at the coordinate of a point.

    The minimum goes no further than the maximum, nor the maximum than the minimum. The flap's switch stays.
    Raises UsageError on the background.
    """
    seen = _on_surface(seen, "a flap")
    row = scene.lights[light]
    flap = flaps_of(row)[axis]
    assert flap is not None
    coordinate = seen.point["xyz".index(axis)]
    if end == "minimum":
        flap = flap.replace(minimum=min(coordinate, flap.maximum))
    else:
        flap = flap.replace(maximum=max(coordinate, flap.minimum))
    return scene.with_light(light, flaps=row.flaps.replace(**{axis: flap}))


def half_space_placed(scene: Scene, seen: Seen | None, light: str, name: str) -> Scene:
    """The scene with a light whose half-space ends at a visible point: its plane moves along its direction.

    The light must have this half-space, whose own point moves by the least distance. Raises UsageError on the
    background.
    """
    seen = _on_surface(seen, "a half-space")
    row = scene.lights_in_world[light]
    half_space = next(each for each in row.half_spaces if each.name == name)
    point = seen.point
    if half_space.carried:
        point = light_frame(row).point_from_world(point)
    along = np.array(unit_vector(half_space.direction))
    start = np.array(half_space.point)
    moved = start + (along @ (np.array(point) - start)) * along
    return scene.with_light(light, half_spaces={name: {"point": moved.tolist()}})
