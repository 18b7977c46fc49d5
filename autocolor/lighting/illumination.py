"""The visible points under all lights: the planes of each light are computed or reused, mixed and added up.

Paper: "The Lighting Model": light(j) of all lights and the ambient term are summed at each point.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Set
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Singles
from autocolor.lighting.light_mix import SurfaceWeights, light_mix
from autocolor.lighting.light_planes import LightPlanes, mix
from autocolor.lighting.picture import Picture
from autocolor.lighting.rays import CameraLight, camera_light
from autocolor.lighting.shading import shade
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import VisiblePoints

PLANE_FIELDS: Final = tuple(
    field.name for field in dataclasses.fields(Light) if field.name not in ("intensity", "on")
)
"""The fields of a light that its planes depend on; the others change only its weights."""


class Previous(NamedTuple):
    """A scene and its picture of the same visible points, whose planes can be reused."""

    scene: Scene
    picture: Picture


def illuminate(scene: Scene, points: VisiblePoints, previous: Previous | None = None) -> Picture:
    """The picture of the visible points in the light of a scene.

    Raises InputError for intensities that float32 can't hold.
    """
    exponents = {
        surface.surface_number: scene.surfaces[surface.surface_number - 1].reflectance.exponent
        for surface in points.slices
    }
    weights = light_mix(exponents.keys(), scene.surfaces, scene.lights, scene.ambient)
    reusable = {light.name: _reusable_planes(light, exponents, previous) for light in scene.lights}
    updates = {
        light.name: _plane_update(light, reusable[light.name], weights.lights[light.name], points)
        for light in scene.lights
        if light.name in weights.lights
    }

    # Finish a chunk before the next, so that its rows and planes are fetched from memory only once.
    relative = np.empty(len(points.pixels), np.float32)
    for chunk in points.chunks:
        sums = relative[chunk.pixels]
        sums[:] = weights.ambient
        scratch = np.empty_like(sums)
        numbers = {surface.surface_number for surface in chunk.slices}
        for update in updates.values():
            if update.light is not None and not numbers.isdisjoint(update.changed_surfaces):
                shade(update.planes.values, update.light, points, chunk, exponents)
            mixed = scratch if update.planes.mixed is None else update.planes.mixed[chunk.pixels]
            if update.to_mix:
                mix(update.planes, chunk, out=mixed)
            sums += mixed

    # A light that does not shine keeps its planes for as long as they are right.
    kept = {name: old.planes for name, old in reusable.items() if old.planes and not old.changed_surfaces}
    kept |= {name: update.planes for name, update in updates.items()}
    planes = {light.name: kept[light.name] for light in scene.lights if light.name in kept}
    for each in planes.values():
        _freeze(each.values, each.mixed)
    _freeze(relative)
    names = tuple(surface.name for surface in scene.surfaces)
    return Picture(
        points.lines, points.elements, names, points.pixels, points.slices, relative, weights.scale, planes
    )


class _ReusablePlanes(NamedTuple):
    """The planes of a light in the previous picture, if any, and the surfaces on which they are outdated."""

    planes: LightPlanes | None
    changed_surfaces: Set[int]


def _reusable_planes(
    light: Light, exponents: Mapping[int, float], previous: Previous | None
) -> _ReusablePlanes:
    """What can be reused of a light's planes; `exponents` has N for each visible surface number."""
    planes = None if previous is None else previous.picture.light_planes.get(light.name)
    if previous is None or planes is None or not _has_same_planes(previous.scene.light(light.name), light):
        return _ReusablePlanes(None, exponents.keys())
    old = previous.scene.surfaces
    changed = {number for number in exponents if old[number - 1].reflectance.exponent != exponents[number]}
    return _ReusablePlanes(planes, changed)


class _PlaneUpdate(NamedTuple):
    """The planes of a light that shines, and what is to be computed of them.

    Where `light` is given, its values are computed on the surfaces `changed_surfaces`. The weighted sum of
    both planes is computed everywhere if it is `to_mix`.
    """

    planes: LightPlanes
    light: CameraLight | None
    changed_surfaces: Set[int]
    to_mix: bool


def _plane_update(
    light: Light, reusable: _ReusablePlanes, weights: SurfaceWeights, points: VisiblePoints
) -> _PlaneUpdate:
    """What is to be computed for a light that shines."""
    old, changed = reusable
    if old is not None and not changed:
        if old.weights != weights:
            return _PlaneUpdate(LightPlanes(old.values, weights), None, changed, to_mix=True)
        if old.mixed is not None:
            return _PlaneUpdate(old, None, changed, to_mix=False)
        # This light stays while another is edited: keep its mix for the edits to come.
        kept = dataclasses.replace(old, mixed=np.empty(len(points.pixels), np.float32))
        return _PlaneUpdate(kept, None, changed, to_mix=True)
    values = np.empty((2, len(points.pixels)), np.float32) if old is None else old.values.copy()
    return _PlaneUpdate(LightPlanes(values, weights), camera_light(light, points), changed, to_mix=True)


def _has_same_planes(old: Light, new: Light) -> bool:
    """Whether two lights have the same planes."""
    return old is new or all(getattr(old, name) == getattr(new, name) for name in PLANE_FIELDS)


def _freeze(*arrays: Singles | None) -> None:
    """Make arrays read-only."""
    for array in arrays:
        if array is not None:
            array.flags.writeable = False
