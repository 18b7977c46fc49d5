"""Rims: the pixels where the cone, the flaps and the half-spaces of a light end, which a pointer can grab."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Bytes, Indices, chunks, dot
from autocolor.lighting.light_controls.cone import Cone
from autocolor.lighting.light_controls.flap_sides import Axis, FlapEnd, flap_sides
from autocolor.lighting.light_controls.half_spaces import half_space_sides
from autocolor.lighting.light_controls.sides import is_inside
from autocolor.lighting.rays import camera_light, rays_to
from autocolor.scene.lights.light import Light
from autocolor.visibility.projection import focal_length
from autocolor.visibility.sight import Sight
from autocolor.visibility.visible_points import NORMAL, POINT, VisiblePoints

CONE: Final = "cone"


class Plane(NamedTuple):
    """What ends at the rim of a half-space: its plane, by the name of the half-space."""

    half_space: str


Rim = Literal["cone"] | tuple[Axis, FlapEnd] | Plane
"""What ends at a rim: the cone, an end of the flap along an axis, or a half-space."""

AT_ONCE: Final = 7
"""The rims that are found together: the most that a light without half-spaces has."""

VISIBLE: Final = np.uint8(1 << AT_ONCE)
"""The flag of a visible pixel; those below it are of the rims."""

LARGEST_GAP: Final = 4.0
"""Assumed: in pixels at their distance; a neighbor that lies further before or behind the tangent plane is
another surface, or one behind the silhouette."""


def rims(sight: Sight, light: str) -> Mapping[Rim, Indices]:
    """The pixels at which the cone, the flaps and the half-spaces of a light end, (n, 2): line and element.

    There is one array for the cone, if there is any, one for each finite end of the flaps that are on, and
    one for each half-space that is on; it is empty where that end is not to be seen. Its pixels are inside,
    and one of the four neighbors of each is outside on the same surface: so no silhouette is a rim. Each rim
    is that of one control by itself, also where another leaves nothing of the light. At a soft edge, it is
    where nothing is left.

    Measured on the coupe: a cone takes 2 ms, and all seven rims 4; beside another busy process up to 10.
    Raises UsageError for an unknown light.
    """
    inside = list(_inside(sight.points, sight.scene.light_in_world(light)).items())
    found: dict[Rim, Indices] = {}
    for some in chunks(len(inside), AT_ONCE):
        found |= _ends(sight, dict(inside[some]))
    return found


def _ends(sight: Sight, inside: Mapping[Rim, Booleans]) -> dict[Rim, Indices]:
    """The pixels at which some rims are, at most `AT_ONCE`; `inside` has their sides of the points."""
    points = sight.points
    # Set one flag for each rim, and spread the flags and the places over the raster.
    flags = np.full(len(points.pixels), VISIBLE)
    for bit, each in enumerate(inside.values()):
        flags |= each.view(np.uint8) << np.uint8(bit)
    raster = np.zeros(points.lines * points.elements, np.uint8)
    raster[points.pixels] = flags
    places = np.empty(len(raster), np.intp)
    places[points.pixels] = np.arange(len(points.pixels))

    # Find the neighbors that differ, and keep those on one surface.
    pairs = [_differing(raster, points.elements, step) for step in (1, points.elements)]
    before, after = np.concatenate(pairs, axis=1)
    kept = _are_on_one_surface(points, places[before], places[after])
    before, after = before[kept], after[kept]

    # Of each pair, take the pixel that is inside.
    found: dict[Rim, Indices] = {}
    for bit, rim in enumerate(inside):
        flag = np.uint8(1 << bit)
        is_before, is_after = raster[before] & flag, raster[after] & flag
        pixels = np.concatenate([before[is_before > is_after], after[is_after > is_before]])
        found[rim] = sight.pixels_of(np.unique(pixels))
    return found


def _inside(points: VisiblePoints, light: Light) -> dict[Rim, Booleans]:
    """Whether each point is inside the cone, each end of the flaps and each half-space, as in shading."""
    inside: dict[Rim, Booleans] = {}
    cone = Cone.of(light, points)
    if cone is not None:
        camera = camera_light(light, points, directed=True)
        inside[CONE] = np.empty(len(points.pixels), np.bool_)
        for chunk in points.chunks:
            cosines = rays_to(camera, points.rows[:, chunk.pixels]).cos_light
            assert cosines is not None
            np.greater_equal(cosines, np.float32(cone.least_cosine), out=inside[CONE][chunk.pixels])
    for rim, side in flap_sides(light, points).items():
        inside[rim] = is_inside(side, points.rows)
    for name, side in half_space_sides(light, points).items():
        inside[Plane(name)] = is_inside(side, points.rows)
    return inside


def _differing(raster: Bytes, elements: int, step: int) -> Indices:
    """The visible pixels that differ from a visible neighbor `step` further in the raster, and it, (2, n)."""
    one, other = raster[:-step], raster[step:]
    # Measured: the places of true booleans are found in an eighth of the time of those of other bytes.
    found = np.flatnonzero((one != other) & ((one & other) >= VISIBLE))
    if step == 1:
        # The last pixel of a line is no neighbor of the first of the next.
        found = found[(found + 1) % elements > 0]
    return np.stack([found, found + step])


def _are_on_one_surface(points: VisiblePoints, one: Indices, other: Indices) -> Booleans:
    """Whether each of two neighboring points is close to the tangent plane of the other."""
    at_one, at_other = (points.rows[POINT].take(places, axis=1) for places in (one, other))
    between = at_other - at_one
    depth = at_one[2] + np.float32(points.middle[2])
    most = depth * np.float32(LARGEST_GAP / focal_length(points.lines, points.view.field_of_view))
    close = np.ones(len(one), np.bool_)
    for places in (one, other):
        close &= np.abs(dot(points.rows[NORMAL].take(places, axis=1), between)) <= most
    return close
