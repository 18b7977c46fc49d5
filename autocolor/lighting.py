"""The lights on what is seen: what each gives is computed or lent, weighed and added up to the picture.

Paper: "The Lighting Model": light(j) of all lights and the ambient term are summed at each point.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Set
from typing import NamedTuple

import numpy as np

from autocolor.light_planes import LightPlanes, weigh
from autocolor.lights import Light
from autocolor.picture import Picture
from autocolor.rays import placed
from autocolor.scene import Scene
from autocolor.seen import Seen
from autocolor.shading import shade
from autocolor.weights import SurfaceWeights, weights_of

SHAPING = tuple(field.name for field in dataclasses.fields(Light) if field.name not in ("intensity", "on"))
"""The fields of a light that its planes depend on; the others only weigh them."""


def lit(scene: Scene, seen: Seen, before: tuple[Scene, Picture] | None = None) -> Picture:
    """The picture of what is seen in the light of a scene.

    `before` is a scene with its picture of the very same that is seen; it lends the planes of the lights that
    did not change. Raises InputError for intensities that float32 can't hold.
    """
    exponents = {
        surface.surface_number: scene.surfaces[surface.surface_number - 1].reflectance.exponent
        for surface in seen.slices
    }
    weights = weights_of(exponents, scene.surfaces, scene.lights, scene.ambient)
    lights = {}
    for light in scene.lights:
        begun = _begun(light, exponents, weights.lights.get(light.name), before, len(seen.pixels))
        if begun is not None:
            lights[light.name] = begun
    ready = {name: placed(each.light, seen) for name, each in lights.items() if each.to_shade}

    # Do all there is to a share before the next, whose rows and planes are then fetched from memory once.
    relative = np.empty(len(seen.pixels), np.float32)
    for share in seen.shares:
        sums = relative[share.pixels]
        sums[:] = weights.ambient
        passing = np.empty_like(sums)
        numbers = {surface.surface_number for surface in share.slices}
        for name, (_, planes, to_shade, to_weigh) in lights.items():
            if not numbers.isdisjoint(to_shade):
                shade(planes.values, ready[name], seen, share, exponents)
            weighed = passing if planes.weighed is None else planes.weighed[share.pixels]
            if to_weigh:
                weigh(planes, share, weighed)
            if name in weights.lights:
                sums += weighed

    kept = {name: each.planes for name, each in lights.items()}
    relative.flags.writeable = False
    for planes in kept.values():
        planes.values.flags.writeable = False
        if planes.weighed is not None:
            planes.weighed.flags.writeable = False
    names = tuple(surface.name for surface in scene.surfaces)
    return Picture(seen.lines, seen.elements, names, seen.pixels, seen.slices, relative, weights.scale, kept)


class _Begun(NamedTuple):
    """A light with its planes, and what of them is still to be computed.

    `to_shade` are the numbers of the surfaces where the values are; `to_weigh` is whether their sum is.
    """

    light: Light
    planes: LightPlanes
    to_shade: Set[int]
    to_weigh: bool


def _begun(
    light: Light,
    exponents: Mapping[int, float],
    weights: SurfaceWeights | None,
    before: tuple[Scene, Picture] | None,
    count: int,
) -> _Begun | None:
    """The planes of a light with what can be lent of them; None where a light that rests has none.

    `weights` are those of a light that shines. One that rests keeps what it has until that would change.
    """
    lent, to_shade = _lent(light, exponents, before)
    if weights is None:
        return None if lent is None or to_shade else _Begun(light, lent, to_shade, to_weigh=False)
    if lent is None:
        return _Begun(light, LightPlanes(np.empty((2, count), np.float32), weights), to_shade, to_weigh=True)
    if to_shade:
        return _Begun(light, LightPlanes(lent.values.copy(), weights), to_shade, to_weigh=True)
    if lent.weights != weights:
        return _Begun(light, LightPlanes(lent.values, weights), to_shade, to_weigh=True)
    if lent.weighed is None:
        # It stays while something else is edited, and will while that goes on.
        lent = dataclasses.replace(lent, weighed=np.empty(count, np.float32))
        return _Begun(light, lent, to_shade, to_weigh=True)
    return _Begun(light, lent, to_shade, to_weigh=False)


def _lent(
    light: Light, exponents: Mapping[int, float], before: tuple[Scene, Picture] | None
) -> tuple[LightPlanes | None, Set[int]]:
    """The planes of the same light before, and the numbers of the surfaces on which they are not right."""
    if before is None:
        return None, exponents.keys()
    scene, picture = before
    lent = picture.light_planes.get(light.name)
    if lent is None or not _only_weighs_another(scene.light(light.name), light):
        return None, exponents.keys()
    return lent, {
        number
        for number, exponent in exponents.items()
        if scene.surfaces[number - 1].reflectance.exponent != exponent
    }


def _only_weighs_another(old: Light, new: Light) -> bool:
    """Whether two lights have the same planes."""
    return old is new or all(getattr(old, name) == getattr(new, name) for name in SHAPING)
