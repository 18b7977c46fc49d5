"""Where a light shows in the picture, and how a drag there changes it: highlights, cones, flaps, half-spaces.

Paper: "Light Controls". The paper moves lights in three views; here they follow a point of the picture. The
functions that place a highlight or a rim take a scene and return a scene, for `Studio.edit`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final, Literal, NamedTuple, get_args

import numpy as np

from autocolor.arrays import (
    Booleans,
    Bytes,
    Indices,
    Singles,
    chunks,
    columns,
    dot,
    underflowing,
    unit_vector,
)
from autocolor.checks import either, nearest, shown
from autocolor.errors import UsageError
from autocolor.lighting.controls import Axis, FlapEnd, flap_sides, flaps_of, half_space_sides, is_inside
from autocolor.lighting.light import CameraLight, exact_rays_to, is_within
from autocolor.lighting.picture import Picture
from autocolor.lighting.precision import uncertain_share
from autocolor.lighting.rays import (
    camera_light,
    direction_between,
    direction_to_eye,
    direction_to_light,
    fast_rays,
    middle_of,
)
from autocolor.lighting.shading import SPECULAR
from autocolor.scene.following import light_frame
from autocolor.scene.lights import Flap, Light
from autocolor.scene.scene import NORMALS, Scene
from autocolor.visibility.projection import focal_length
from autocolor.visibility.visible_points import (
    NORMAL,
    PIXELS_AT_ONCE,
    POINT,
    REFLECTED_VIEW,
    Seen,
    Sight,
    SurfaceSlice,
    VisiblePoints,
)

ROUNDING: Final = np.float32(1e-5)
"""Assumed: above the rounding of a cosine in float32, which many pixels around a highlight may share."""

LEAST_CONE: Final = 0.03
"""Assumed: in degrees; a narrower cone lights hardly a point."""

LARGEST_GAP: Final = 4.0
"""Assumed: in pixels at their distance; a neighbor farther before or behind the tangent plane belongs to
another surface, or is behind the silhouette."""

CELL: Final = 16
"""Assumed: pixels across the squares in which the light of a highlight is added up."""

CONE: Final = "cone"


class Plane(NamedTuple):
    """The rim of a half-space: where its plane ends the light, by the name of the half-space."""

    half_space: str


Rim = Literal["cone"] | tuple[Axis, FlapEnd] | Plane
"""The rim of a cone, of an end of the flap along an axis, or of a half-space."""

RIMS_AT_ONCE: Final = 7
"""A light without half-spaces has at most seven rims."""

VISIBLE: Final = np.uint8(1 << RIMS_AT_ONCE)
"""The flag of a visible pixel; the flags below it belong to the rims."""


@underflowing
def highlight_of(sight: Sight, light: str, surface: str | None = None) -> tuple[int, int] | None:
    """The line and the element where the highlight of a light is: the pixel with the largest cos(E).

    This is the inverse of `highlight_placed`. If a surface is named, only its pixels count. The result is
    None if no visible point has both cos(E) and cos(I) above 0. The light may be off, and its controls do not
    matter. If words stand for normals, light and eye are taken as far away. Measured on the coupe: 1.4 ms.
    Raises UsageError for an unknown light or surface.
    """
    scene, points = sight.scene, sight.points
    row = scene.light_in_world(light)
    number = None if surface is None else scene.surfaces.index(scene.surface(surface)) + 1
    slices = [each for each in points.slices if number is None or each.surface_number == number]
    if scene.words == NORMALS:
        place = _brightest_from_afar(scene, row, points, slices)
    else:
        place = _brightest(points, camera_light(row, points, with_controls=False), slices)
    if place is None:
        return None
    line, element = sight.pixels_of(points.pixels[[place]])[0].tolist()
    return line, element


def _brightest(points: VisiblePoints, light: CameraLight, slices: Sequence[SurfaceSlice]) -> int | None:
    """The place of the point with the largest cos(E) on some surfaces."""
    nearly = [_nearly_brightest(points, light, each) for each in slices]
    places = np.concatenate([np.empty(0, np.intp), *nearly])
    if not len(places):
        return None
    # Compare these points in float64: cos(E) is largest where the unit vector to the light is closest to R.
    to_light = light.position[:, None] - points.rows[POINT].take(places, axis=1)
    to_light /= np.maximum(np.linalg.norm(to_light, axis=0), np.finfo(np.float64).tiny)
    to_light -= points.rows[REFLECTED_VIEW].take(places, axis=1)
    return int(places[np.argmin(np.square(to_light).sum(axis=0))])


def _nearly_brightest(points: VisiblePoints, light: CameraLight, surface: SurfaceSlice) -> Indices:
    """The places of the points of a surface with the largest cos(E), up to the rounding of float32."""
    cosines = np.empty(surface.stop - surface.start, np.float32)
    for chunk in chunks(surface.stop, PIXELS_AT_ONCE, surface.start):
        rays, _ = fast_rays(light, points.rows[:, chunk], points.radius)
        rays.eye[rays.incidence <= 0] = -1
        cosines[chunk.start - surface.start : chunk.stop - surface.start] = rays.eye
    largest = cosines.max()
    if largest <= 0:
        return np.empty(0, np.intp)
    return np.flatnonzero(cosines >= largest - ROUNDING) + surface.start


def _brightest_from_afar(
    scene: Scene, light: Light, points: VisiblePoints, slices: Sequence[SurfaceSlice]
) -> int | None:
    """The place of the point with the largest cos(E) on some surfaces, for a light and an eye far away."""
    most, place = 0.0, None
    for each in slices:
        cosines = cosines_from_afar(scene, light, points, each.pixels)
        largest = int(cosines.argmax())
        if cosines[largest] > most:
            most, place = float(cosines[largest]), each.start + largest
    return place


@underflowing
def cosines_from_afar(scene: Scene, light: Light, points: VisiblePoints, pixels: slice) -> Singles:
    """cos(E) at some visible points, (points,) float32; -1 where the light is behind the surface."""
    to_eye = direction_to_eye(scene)
    to_light = scene.view.axes @ np.array(direction_to_light(light, middle_of(scene)))
    # L . R, for the reflected view R = 2 (N.V) N - V.
    along_eye, along_light = np.stack([to_eye, to_light]).astype(np.float32) @ points.rows[NORMAL, pixels]
    cosines: Singles = 2 * along_eye * along_light - np.float32(to_eye @ to_light)
    cosines[along_light <= 0] = -1
    return cosines


# What is seen of a highlight: its share of the picture, with all controls of the light.


def seen_highlight(picture: Picture, light: str, surface: str | None = None) -> tuple[int, int] | None:
    """The line and the element where the highlight of a light is seen, on one surface or on all.

    Assumed: this is the brightest pixel of the light's specular plane in the square of CELL pixels that has
    the largest sum. A bright edge of a few pixels has the largest cos(E), but a broad reflection is what the
    eye sees. None for a light without planes, or without specular reflection there. Measured on the coupe:
    0.6 ms.
    """
    planes = picture.light_planes.get(light)
    if planes is None:
        return None
    number = None if surface is None else picture.surfaces.index(surface) + 1
    best, largest = None, 0.0
    across = -(-picture.elements // CELL)
    for each in picture.slices:
        if number is not None and each.surface_number != number:
            continue
        weight = planes.weights.get(each.surface_number, (0.0, 0.0))[SPECULAR]
        values, pixels = planes.values[SPECULAR, each.pixels], picture.pixels[each.pixels]
        lines, elements = np.divmod(pixels, picture.elements)
        cells = lines // CELL * across + elements // CELL
        sums = weight * np.bincount(cells, weights=values)
        cell = int(sums.argmax())
        if sums[cell] > largest:
            inside = np.flatnonzero(cells == cell)
            best, largest = int(pixels[inside[values[inside].argmax()]]), float(sums[cell])
    return None if best is None else divmod(best, picture.elements)


def specular_shares(picture: Picture, line: int, element: int) -> Mapping[str, float]:
    """The specular part of each light with planes at a pixel, in proportion; empty on the background."""
    flat = line * picture.elements + element
    for each in picture.slices:
        places = np.flatnonzero(picture.pixels[each.pixels] == flat)
        if len(places):
            place, number = each.start + int(places[0]), each.surface_number
            return {
                name: float(planes.weights.get(number, (0.0, 0.0))[SPECULAR] * planes.values[SPECULAR, place])
                for name, planes in picture.light_planes.items()
            }
    return {}


def highlight_placed(scene: Scene, seen: Seen | None, light: str) -> Scene:
    """The scene with a light moved so that the middle of its highlight, cos(E) = 1, is at a point P.

    The light keeps its distance from P, and moves to P plus the distance times R, where the view is reflected
    to. Its aim, if any, becomes P; its direction, if any, leads to P. Assumed: of all places that give this
    highlight, the place at the same distance changes the light at P least. A light at infinity moves and
    turns in the same way, so that it has this highlight whether it is at infinity or not. A light that
    follows something still follows it. If words stand for normals, light and eye are taken as far away: then
    P is the middle of the object, with the normal that is seen.

    The half vector is then the normal, so that the specular factors of Phong and of Blinn are largest at P.
    The factor of Cook and Torrance still grows from there toward grazing light. Measured on a sphere of 420
    lines: its largest value is a pixel farther for a roughness of 0.1, up to nine for 0.3, and up to sixty
    for 0.6. If S grows with the angle of incidence, the largest value moves, too: with an F0 of 0.04 up to
    six pixels for N = 20, and one for N = 100.

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


def seen_from_afar(scene: Scene, seen: Seen) -> Seen:
    """The visible point at a pixel, moved to the middle of the object; the normal stays."""
    middle = middle_of(scene)
    to_eye = np.array(direction_between(middle, scene.view.eye))
    normal = np.array(seen.normal)
    x, y, z = (2 * (normal @ to_eye) * normal - to_eye).tolist()
    return seen._replace(point=middle, reflected_view=(x, y, z))


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
    where another control leaves nothing of the light. The rim of a soft edge is its dark end.

    Measured on the coupe: a cone takes 2 ms, and all seven rims 4; beside another busy process up to 10.
    Raises UsageError for an unknown light.
    """
    inside = list(_inside(sight.points, sight.scene.light_in_world(light)).items())
    pixels: dict[Rim, Indices] = {}
    for some in chunks(len(inside), RIMS_AT_ONCE):
        pixels |= _pixels_of_rims(sight, dict(inside[some]))
    return pixels


def _pixels_of_rims(sight: Sight, inside: Mapping[Rim, Booleans]) -> dict[Rim, Indices]:
    """The pixels of at most RIMS_AT_ONCE rims; `inside` has a flag for each point that is inside a rim."""
    points = sight.points
    # Set one flag for each rim, and spread the flags and the places over the raster.
    flags = np.full(len(points.pixels), VISIBLE)
    for bit, each in enumerate(inside.values()):
        flags |= each.view(np.uint8) << np.uint8(bit)
    raster = np.zeros(points.lines * points.elements, np.uint8)
    raster[points.pixels] = flags
    places = np.empty(len(raster), np.intp)
    places[points.pixels] = np.arange(len(points.pixels))

    # Find the pairs of neighbors that differ, and keep the pairs on one surface.
    pairs = [_differing(raster, points.elements, step) for step in (1, points.elements)]
    before, after = np.concatenate(pairs, axis=1)
    is_near = _are_on_one_surface(points, places[before], places[after])
    before, after = before[is_near], after[is_near]

    # Take the pixel of each pair that is inside.
    pixels_of: dict[Rim, Indices] = {}
    for bit, rim in enumerate(inside):
        flag = np.uint8(1 << bit)
        is_before, is_after = raster[before] & flag, raster[after] & flag
        pixels = np.concatenate([before[is_before > is_after], after[is_after > is_before]])
        pixels_of[rim] = sight.pixels_of(np.unique(pixels))
    return pixels_of


def _inside(points: VisiblePoints, light: Light) -> dict[Rim, Booleans]:
    """Whether each point is inside the cone, each end of the flaps and each half-space, as in shading."""
    inside: dict[Rim, Booleans] = {}
    if light.cone_angle is not None:
        camera = camera_light(light, points)
        inside[CONE] = np.empty(len(points.pixels), np.bool_)
        for chunk in points.chunks:
            rays, rounding = fast_rays(camera, points.rows[:, chunk.pixels], points.radius)
            within = inside[CONE][chunk.pixels]
            within[:] = is_within(rays, light.cone_angle)
            again = uncertain_share(camera, rays, rounding)
            if again is not None:
                exact = exact_rays_to(camera, columns(rays.rows, np.flatnonzero(again)))
                within[again] = is_within(exact, light.cone_angle)
    for rim, side in flap_sides(light, points).items():
        inside[rim] = is_inside(side, points.rows[POINT])
    for name, side in half_space_sides(light, points).items():
        inside[Plane(name)] = is_inside(side, points.rows[POINT])
    return inside


def _differing(raster: Bytes, elements: int, step: int) -> Indices:
    """The pairs of visible neighbors, `step` apart in the raster, whose flags differ, (2, n)."""
    one, other = raster[:-step], raster[step:]
    # Measured: numpy finds the places of true booleans in an eighth of the time that other bytes take.
    pixels = np.flatnonzero((one != other) & ((one & other) >= VISIBLE))
    if step == 1:
        # The last pixel of a line is no neighbor of the first of the next.
        pixels = pixels[(pixels + 1) % elements > 0]
    return np.stack([pixels, pixels + step])


def _are_on_one_surface(points: VisiblePoints, one: Indices, other: Indices) -> Booleans:
    """Whether each of two neighboring points is close to the tangent plane of the other."""
    at_one, at_other = (points.rows[POINT].take(places, axis=1) for places in (one, other))
    between = at_other - at_one
    depth = at_one[2] + np.float32(points.origin[2])
    focal = focal_length(points.lines, points.elements, points.view.field_of_view)
    most = depth * np.float32(LARGEST_GAP / focal)
    close = np.ones(len(one), np.bool_)
    for places in (one, other):
        close &= np.abs(dot(points.rows[NORMAL].take(places, axis=1), between)) <= most
    return close


def cone_placed(scene: Scene, seen: Seen | None, light: str, add: bool = False) -> Scene:
    """The scene with a light whose cone ends at a point: its angle is the angle L of the point.

    The angle is at least LEAST_CONE and at most 180 degrees. The inner angle stays, but it is at most the
    cone angle. With `add`, a light without a cone gets a cone. Raises UsageError on the background, for a
    light at the point itself, for a point source, for a light at infinity, where cones have no effect, and,
    without `add`, for a light without a cone.
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
    """The scene with a light whose flap along an axis ends at the coordinate of a point.

    The minimum goes no further than the maximum, nor the maximum than the minimum. The flap's switch stays.
    With `add`, a light without this flap gets it, switched on. Raises UsageError on the background, for an
    unknown axis or end, and, without `add`, for a light without this flap.
    """
    seen = _on_surface(seen, "a flap")
    for what, name, names in (("axis", axis, get_args(Axis)), ("end", end, get_args(FlapEnd))):
        if name not in names:
            raise UsageError(
                f"the {what} of a flap must be {either(names)}, not {shown(name)}; choose another"
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
    """The scene with a light whose half-space ends at a visible point: its plane moves along its direction.

    The half-space's own point moves by the least distance. Raises UsageError on the background, and for a
    light without this half-space.
    """
    seen = _on_surface(seen, "a half-space")
    row = scene.light_in_world(light)
    half_space = next((each for each in row.half_spaces if each.name == name), None)
    if half_space is None:
        close = nearest(name, [each.name for each in row.half_spaces])
        raise UsageError(f"there is no half-space {shown(name)} of light {light!r}{close or '; add one'}")
    point = seen.point
    if half_space.carried:
        point = light_frame(row).point_from_world(point)
    along = np.array(unit_vector(half_space.direction))
    start = np.array(half_space.point)
    moved = start + (along @ (np.array(point) - start)) * along
    return scene.with_light(light, half_spaces={name: {"point": moved.tolist()}})
