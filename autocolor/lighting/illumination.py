"""The visible points under all lights: the planes of each light are computed or reused, mixed and added up.

Paper: "The Lighting Model": light(j) of all lights and the ambient term are summed at each point.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Set
from typing import NamedTuple

import numpy as np

from autocolor.arrays import Singles
from autocolor.lighting.picture import Picture
from autocolor.lighting.shading import (
    ControlledLight,
    LightPlanes,
    SurfaceWeights,
    controlled_light,
    light_mix,
    mix,
    shade,
)
from autocolor.scene.columns import Tier, cost
from autocolor.scene.lights import Light
from autocolor.scene.reflection_models import ReflectionModel
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import VisiblePoints


class Previous(NamedTuple):
    """A scene and its picture of the same visible points, whose planes can be reused."""

    scene: Scene
    picture: Picture


def illuminate(scene: Scene, points: VisiblePoints, previous: Previous | None = None) -> Picture:
    """The picture of the visible points in the light of a scene.

    Raises InputError for intensities that float32 can't hold.
    """
    models = {
        surface.surface_number: scene.surfaces[surface.surface_number - 1].reflectance.model
        for surface in points.slices
    }
    lights = {light.name: light for light in scene.lights_in_world}
    weights = light_mix(models, scene.surfaces, scene.lights, scene.ambient, scene.parts)
    changed = _changed_surfaces(models, previous)
    reusable = _reusable_planes(lights, previous)
    updates = {
        name: _plane_update(lights[name], reusable.get(name), changed, surface_weights, points)
        for name, surface_weights in weights.lights.items()
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
                shade(update.planes.values, update.light, points, chunk, models)
            mixed = scratch if update.planes.mixed is None else update.planes.mixed[chunk.pixels]
            if update.to_mix:
                mix(update.planes, chunk, out=mixed)
            sums += mixed

    # A light that does not shine keeps its planes for as long as they are right.
    kept = {} if changed else reusable
    kept |= {name: update.planes for name, update in updates.items()}
    planes = {light.name: kept[light.name] for light in scene.lights if light.name in kept}
    for each in planes.values():
        _freeze(each.values, each.mixed)
    _freeze(relative)
    names = tuple(surface.name for surface in scene.surfaces)
    return Picture(
        points.lines,
        points.elements,
        names,
        points.pixels,
        points.slices,
        relative,
        weights.scale,
        planes,
        visible_parts=points.parts,
    )


def _changed_surfaces(models: Mapping[int, ReflectionModel], previous: Previous | None) -> Set[int]:
    """The visible surface numbers whose reflection model is not that of the previous picture."""
    if previous is None:
        return set()
    old = previous.scene.surfaces
    return {number for number, model in models.items() if old[number - 1].reflectance.model != model}


def _reusable_planes(lights: Mapping[str, Light], previous: Previous | None) -> dict[str, LightPlanes]:
    """The planes of the previous picture that still belong to a light, on surfaces that have not changed."""
    if previous is None:
        return {}
    planes = previous.picture.light_planes
    before = {light.name: light for light in previous.scene.lights_in_world}
    return {
        name: planes[name]
        for name, light in lights.items()
        if name in planes and _has_same_planes(before[name], light)
    }


class _PlaneUpdate(NamedTuple):
    """The planes of a light that shines, and what is to be computed of them.

    Where `light` is given, its values are computed on the surfaces `changed_surfaces`. The weighted sum of
    both planes is computed everywhere if it is `to_mix`.
    """

    planes: LightPlanes
    light: ControlledLight | None
    changed_surfaces: Set[int]
    to_mix: bool


def _plane_update(
    light: Light,
    old: LightPlanes | None,
    changed: Set[int],
    weights: SurfaceWeights,
    points: VisiblePoints,
) -> _PlaneUpdate:
    """What is to be computed for a light that shines, given its reusable planes and the changed surfaces."""
    if old is None:
        values = np.empty((2, len(points.pixels)), np.float32)
        planes = LightPlanes(values, weights)
        return _PlaneUpdate(planes, controlled_light(light, points), weights.keys(), to_mix=True)
    if not changed:
        if old.weights != weights:
            return _PlaneUpdate(LightPlanes(old.values, weights), None, changed, to_mix=True)
        if old.mixed is not None:
            return _PlaneUpdate(old, None, changed, to_mix=False)
        # This light stays while another is edited: keep its mix for the edits to come.
        kept = dataclasses.replace(old, mixed=np.empty(len(points.pixels), np.float32))
        return _PlaneUpdate(kept, None, changed, to_mix=True)
    planes = LightPlanes(old.values.copy(), weights)
    return _PlaneUpdate(planes, controlled_light(light, points), changed, to_mix=True)


def _has_same_planes(old: Light, new: Light) -> bool:
    """Whether two lights differ in nothing but what weighs their planes."""
    costs = None if old is new else cost(old, new)
    return costs is None or costs < Tier.LIGHT


def _freeze(*arrays: Singles | None) -> None:
    """Make arrays read-only."""
    for array in arrays:
        if array is not None:
            array.flags.writeable = False
