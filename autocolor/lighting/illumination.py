"""The lights on what is seen: what each gives is computed or lent, weighed and added up to the picture.

Paper: "The Lighting Model": light(j) of all lights and the ambient term are summed at each point.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Set
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Singles
from autocolor.lighting.light_mix import SurfaceWeights, weights_of
from autocolor.lighting.light_planes import LightPlanes, weigh
from autocolor.lighting.picture import Picture
from autocolor.lighting.rays import Placed, placed
from autocolor.lighting.shading import shade
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import Seen

SHAPING: Final = tuple(
    field.name for field in dataclasses.fields(Light) if field.name not in ("intensity", "on")
)
"""The fields of a light that its planes depend on; the others only weigh them."""


class Lender(NamedTuple):
    """A scene with its picture of the very same that is seen; it lends the planes of lights that stay."""

    scene: Scene
    picture: Picture


def lit(scene: Scene, seen: Seen, lender: Lender | None = None) -> Picture:
    """The picture of what is seen in the light of a scene.

    Raises InputError for intensities that float32 can't hold.
    """
    exponents = {
        surface.surface_number: scene.surfaces[surface.surface_number - 1].reflectance.exponent
        for surface in seen.slices
    }
    weights = weights_of(exponents.keys(), scene.surfaces, scene.lights, scene.ambient)
    loans = {light.name: _loan(light, exponents, lender) for light in scene.lights}
    works = {
        light.name: _work(light, loans[light.name], weights.lights[light.name], seen)
        for light in scene.lights
        if light.name in weights.lights
    }

    # Do all there is to a share before the next, whose rows and planes are then fetched from memory once.
    relative = np.empty(len(seen.pixels), np.float32)
    for share in seen.shares:
        sums = relative[share.pixels]
        sums[:] = weights.ambient
        passing = np.empty_like(sums)
        numbers = {surface.surface_number for surface in share.slices}
        for work in works.values():
            if work.light is not None and not numbers.isdisjoint(work.changed_surfaces):
                shade(work.planes.values, work.light, seen, share, exponents)
            weighed = passing if work.planes.weighed is None else work.planes.weighed[share.pixels]
            if work.to_weigh:
                weigh(work.planes, share, weighed)
            sums += weighed

    # A light that rests keeps what it has until that would change.
    made = {name: loan.planes for name, loan in loans.items() if loan.planes and not loan.changed_surfaces}
    made |= {name: work.planes for name, work in works.items()}
    planes = {light.name: made[light.name] for light in scene.lights if light.name in made}
    for each in planes.values():
        _freeze(each.values, each.weighed)
    _freeze(relative)
    names = tuple(surface.name for surface in scene.surfaces)
    return Picture(
        seen.lines, seen.elements, names, seen.pixels, seen.slices, relative, weights.scale, planes
    )


class _Loan(NamedTuple):
    """The planes that a light had before, if any, and the numbers of the surfaces where they are wrong."""

    planes: LightPlanes | None
    changed_surfaces: Set[int]


def _loan(light: Light, exponents: Mapping[int, float], lender: Lender | None) -> _Loan:
    """What can be lent of a light's planes; `exponents` has N for each surface number that is seen."""
    lent = None if lender is None else lender.picture.light_planes.get(light.name)
    if lender is None or lent is None or not _only_weighs_another(lender.scene.light(light.name), light):
        return _Loan(None, exponents.keys())
    old = lender.scene.surfaces
    changed = {number for number in exponents if old[number - 1].reflectance.exponent != exponents[number]}
    return _Loan(lent, changed)


class _Work(NamedTuple):
    """The planes of a light that shines, and what of them is still to be computed.

    The values are on the surfaces with the numbers `changed_surfaces`, in the light `light`; the sum of both
    planes is everywhere, if it is `to_weigh`.
    """

    planes: LightPlanes
    light: Placed | None
    changed_surfaces: Set[int]
    to_weigh: bool


def _work(light: Light, loan: _Loan, weights: SurfaceWeights, seen: Seen) -> _Work:
    """What there is to do for a light that shines."""
    lent, changed = loan
    if lent is not None and not changed:
        if lent.weights != weights:
            return _Work(LightPlanes(lent.values, weights), None, changed, to_weigh=True)
        if lent.weighed is not None:
            return _Work(lent, None, changed, to_weigh=False)
        # It stays while something else is edited, and will while that goes on.
        kept = dataclasses.replace(lent, weighed=np.empty(len(seen.pixels), np.float32))
        return _Work(kept, None, changed, to_weigh=True)
    values = np.empty((2, len(seen.pixels)), np.float32) if lent is None else lent.values.copy()
    return _Work(LightPlanes(values, weights), placed(light, seen), changed, to_weigh=True)


def _only_weighs_another(old: Light, new: Light) -> bool:
    """Whether two lights have the same planes."""
    return old is new or all(getattr(old, name) == getattr(new, name) for name in SHAPING)


def _freeze(*arrays: Singles | None) -> None:
    for array in arrays:
        if array is not None:
            array.flags.writeable = False
