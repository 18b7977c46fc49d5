"""The visible points under all lights: the planes of each light are computed or reused, mixed and added up.

Paper: "The Lighting Model": light(j) of all lights and the ambient term are summed at each point. The paper
sets no limit to the lights. A picture keeps the planes of the lights as far as they fit in a share of the
budget. The planes of further lights are computed in turns, in the same array, and again for each edit.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Singles, underflowing
from autocolor.budget import allowed_memory
from autocolor.immutable import read_only
from autocolor.lighting.picture import Picture
from autocolor.lighting.rays import camera_light
from autocolor.lighting.shading import LightPlanes, SurfaceWeights, light_mix, mix, shade
from autocolor.scene.columns import Tier, cost
from autocolor.scene.lights import Light
from autocolor.scene.reflection_models import ReflectionModel
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import VisiblePoints

SHARE: Final = 0.25
"""Limit: the share of the memory budget for light planes: on a whole picture of 640 x 480, of 271 lights."""

BYTES_OF_LIGHT: Final = 12
"""Bytes at each visible point: both planes of a light and, while other lights are edited, their mix."""


class Previous(NamedTuple):
    """A scene and its picture of the same visible points, whose planes can be reused."""

    scene: Scene
    picture: Picture


@underflowing
def illuminate(scene: Scene, points: VisiblePoints, previous: Previous | None = None) -> Picture:
    """The picture of the visible points in the light of a scene.

    Raises InputError for intensities that float32 can't hold.
    """
    models = {
        surface.surface_number: scene.surfaces[surface.surface_number - 1].reflectance.model
        for surface in points.slices
    }
    lights = {light.name: light for light in scene.lights_in_world}
    weights = light_mix(models, scene.surfaces, scene.lights, scene.ambient, scene.staged.parts)
    changed = _changed_surfaces(models, previous)
    reusable = _reusable_planes(lights, previous)
    most = int(SHARE * allowed_memory()) // (BYTES_OF_LIGHT * max(1, len(points.pixels)))
    new = [name for name in weights.lights if name not in reusable]
    in_turns = set(new[max(0, most - len(reusable)) :])
    shared = np.empty((2, len(points.pixels)), np.float32) if in_turns else None
    updates = {
        name: _plane_update(
            reusable.get(name), changed, of_light, len(points.pixels), shared if name in in_turns else None
        )
        for name, of_light in weights.lights.items()
    }
    cameras = {name: camera_light(lights[name], points) for name in updates if updates[name][1]}

    # Finish a chunk before the next, so that its rows and planes are fetched from memory only once.
    relative = np.empty(len(points.pixels), np.float32)
    for chunk in points.chunks:
        sums = relative[chunk.pixels]
        sums[:] = weights.ambient
        scratch = np.empty_like(sums)
        numbers = {surface.surface_number for surface in chunk.slices}
        for name, (planes, surfaces, to_mix) in updates.items():
            if not numbers.isdisjoint(surfaces):
                shade(planes.values, cameras[name], points, chunk, models)
            mixed = scratch if planes.mixed is None else planes.mixed[chunk.pixels]
            if to_mix:
                mix(planes, chunk, out=mixed)
            sums += mixed

    # A light that does not shine keeps its planes as long as no model changes.
    valid = {} if changed else reusable
    valid |= {name: planes for name, (planes, _, _) in updates.items() if name not in in_turns}
    light_planes = {light.name: valid[light.name] for light in scene.lights if light.name in valid}
    for each in light_planes.values():
        read_only(each.values)
        if each.mixed is not None:
            read_only(each.mixed)
    read_only(relative)
    return Picture(
        points.lines,
        points.elements,
        tuple(surface.name for surface in scene.surfaces),
        points.pixels,
        points.slices,
        relative,
        weights.scale,
        light_planes,
        visible_parts=points.parts,
        apart=scene.stage_surface,
    )


def _changed_surfaces(models: Mapping[int, ReflectionModel], previous: Previous | None) -> Set[int]:
    """The visible surface numbers whose reflection model differs from the previous picture's."""
    if previous is None:
        return set()
    old = previous.scene.surfaces
    return {number for number, model in models.items() if old[number - 1].reflectance.model != model}


def _reusable_planes(lights: Mapping[str, Light], previous: Previous | None) -> dict[str, LightPlanes]:
    """The planes of the previous picture that are still valid, by light, on surfaces that did not change."""
    if previous is None:
        return {}
    planes = previous.picture.light_planes
    before = {light.name: light for light in previous.scene.lights_in_world}
    return {
        name: planes[name]
        for name, light in lights.items()
        if name in planes and (cost(before[name], light) or Tier.NOTHING) < Tier.LIGHT
    }


def _plane_update(
    old: LightPlanes | None, changed: Set[int], weights: SurfaceWeights, count: int, shared: Singles | None
) -> tuple[LightPlanes, Set[int], bool]:
    """The planes of a light that shines on `count` points, given its reusable planes and changed surfaces.

    Also the surfaces on which to compute them, and whether to mix them. New planes are in the array `shared`,
    (2, count), if it is given, else in an array of their own.
    """
    if old is None:
        values = np.empty((2, count), np.float32) if shared is None else shared
        return LightPlanes(values, weights), weights.keys(), True
    if changed:
        return LightPlanes(old.values.copy(), weights), changed, True
    if old.weights != weights:
        return LightPlanes(old.values, weights), changed, True
    if old.mixed is None:
        # This light stays while another light is edited: keep its mix for further edits.
        return LightPlanes(old.values, weights, np.empty(count, np.float32)), changed, True
    return old, changed, False
