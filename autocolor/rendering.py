"""From a scene to its picture, keeping what the next scene can use again.

| changed | computed again |
|---|---|
| mesh, view, the surface of a part | everything |
| a light's place, aim, concentration, flaps, cone | that light's two planes, the sum |
| a surface's exponent | every light on that surface, the sum |
| a light's intensity or switch, ambient, D, S | the sum |
| anything else | nothing |
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Set
from dataclasses import dataclass
from numbers import Integral
from typing import NamedTuple

import numpy as np

from autocolor.checks import nearest
from autocolor.errors import UsageError
from autocolor.lights import Light
from autocolor.picture import LightPlanes, Picture, SurfaceWeights, add_up, weigh, weights_of
from autocolor.scene import Scene
from autocolor.seen import Seen
from autocolor.shading import placed, shade
from autocolor.visible_surfaces import visible_surfaces
from autocolor.watkins import watkins

# glibc gives large arrays back to the system and fetches them again, page by page, for every frame; once it
# has seen one of this size go, it keeps them. Measured: 4 to 15 ms a frame.
_ = np.empty(30 << 20, np.uint8)
del _

LARGEST_RASTER = 16384
"""Assumed: a picture of this size on both sides takes tens of gigabytes."""

ALGORITHMS: dict[str, Callable[..., Seen]] = {"batch": visible_surfaces, "watkins": watkins}


@dataclass(frozen=True, eq=False)
class Rendering:
    """A scene, what is seen of it, and its picture."""

    scene: Scene
    seen: Seen
    picture: Picture


def render(scene: Scene, lines: int = 480, elements: int = 640, algorithm: str = "batch") -> Picture:
    """The picture of a scene, (lines, elements).

    `algorithm` is "batch", all lines at once, or "watkins", the literal one, which gives the same picture
    some hundred times slower. Raises InputError for intensities that float32 can't hold, UsageError for a
    raster or an algorithm that there is not.
    """
    for what, size in (("lines", lines), ("elements", elements)):
        if isinstance(size, bool) or not isinstance(size, Integral) or not 1 <= size <= LARGEST_RASTER:
            raise UsageError(
                f"{what} must be a whole number from 1 to {LARGEST_RASTER}, not {size!r}; choose another size"
            )
    if algorithm not in ALGORITHMS:
        raise UsageError(f"there is no algorithm {algorithm!r}{nearest(str(algorithm), ALGORITHMS)}")
    return rendering(scene, lines, elements, algorithm=algorithm).picture


def rendering(
    scene: Scene,
    lines: int = 480,
    elements: int = 640,
    before: Rendering | None = None,
    algorithm: str = "batch",
) -> Rendering:
    """The picture of a scene with what it was made from; `before` lends what did not change."""
    if before is not None and (before.picture.lines, before.picture.elements) != (lines, elements):
        before = None
    if before is not None and _sees_the_same(before.scene, scene):
        if _composes_the_same(before.scene, scene):
            return Rendering(scene, before.seen, before.picture)
        seen = before.seen
    else:
        before = None
        one_sided = frozenset(row + 1 for row, surface in enumerate(scene.surfaces) if not surface.two_sided)
        seen = ALGORITHMS[algorithm](
            scene.mesh, scene.view, scene.surface_number_of_part, lines, elements, one_sided
        )
    return Rendering(scene, seen, _picture(scene, seen, before))


def _picture(scene: Scene, seen: Seen, before: Rendering | None) -> Picture:
    """The picture of what is seen; `before` lends the planes of lights that did not change."""
    exponents = {
        surface.surface_number: scene.surfaces[surface.surface_number - 1].reflectance.exponent
        for surface in seen.slices
    }
    weights = weights_of(exponents, scene.surfaces, scene.lights, scene.ambient)
    begun = {}
    for light in scene.lights:
        made = _begun(light, seen, exponents, weights.lights.get(light.name), before)
        if made is not None:
            begun[light.name] = made

    ready = {name: placed(each.light, seen) for name, each in begun.items() if each.to_shade}
    # Do all there is to a share before the next, whose rows and planes are then fetched from memory once.
    relative = np.empty(len(seen.pixels), np.float32)
    shining = [begun[name].planes for name in weights.lights]
    for share in seen.shares:
        numbers = {surface.surface_number for surface in share.slices}
        for name, each in begun.items():
            if not numbers.isdisjoint(each.to_shade):
                shade(each.planes.values, ready[name], seen, share, exponents)
            if each.to_weigh:
                weigh(each.planes, share)
        add_up(relative, shining, weights.ambient, share)

    relative.flags.writeable = False
    for each in begun.values():
        each.planes.values.flags.writeable = each.planes.weighed.flags.writeable = False
    return Picture(
        seen.lines,
        seen.elements,
        tuple(surface.name for surface in scene.surfaces),
        seen.pixels,
        seen.slices,
        relative,
        weights.scale,
        {name: each.planes for name, each in begun.items()},
    )


class _Begun(NamedTuple):
    """The planes of a light, and what of them is still to be computed.

    `to_shade` are the numbers of the surfaces where its values are; `to_weigh` is whether what is weighed is.
    """

    light: Light
    planes: LightPlanes
    to_shade: Set[int]
    to_weigh: bool


def _begun(
    light: Light,
    seen: Seen,
    exponents: Mapping[int, float],
    weights: SurfaceWeights | None,
    before: Rendering | None,
) -> _Begun | None:
    """The planes of a light with what can be lent of them; None where a light that rests has none.

    `weights` are those of a light that shines. One that rests keeps what it has until that would change.
    """
    lent, to_shade = None, set(exponents)
    if (
        before is not None
        and light.name in before.picture.light_planes
        and _only_weighs_another(before.scene.light(light.name), light)
    ):
        lent = before.picture.light_planes[light.name]
        old = before.scene.surfaces
        to_shade = {
            number
            for number, exponent in exponents.items()
            if old[number - 1].reflectance.exponent != exponent
        }
    if lent is not None and not to_shade and weights in (None, lent.weights):
        return _Begun(light, lent, to_shade, to_weigh=False)
    if weights is None:
        return None
    count = len(seen.pixels)
    if lent is None:
        values = np.empty((2, count), np.float32)
    else:
        values = lent.values.copy() if to_shade else lent.values
    return _Begun(light, LightPlanes(values, np.empty(count, np.float32), weights), to_shade, to_weigh=True)


SHAPING = tuple(field.name for field in dataclasses.fields(Light) if field.name not in ("intensity", "on"))
"""The fields of a light that its planes depend on; the others only weigh them."""


def _only_weighs_another(old: Light, new: Light) -> bool:
    """Whether two lights have the same planes."""
    return old is new or all(getattr(old, name) == getattr(new, name) for name in SHAPING)


def _sees_the_same(old: Scene, new: Scene) -> bool:
    return (
        old.mesh is new.mesh
        and old.view == new.view
        and old.surface_number_of_part == new.surface_number_of_part
        and (
            old.surfaces is new.surfaces
            or [surface.two_sided for surface in old.surfaces]
            == [surface.two_sided for surface in new.surfaces]
        )
    )


def _composes_the_same(old: Scene, new: Scene) -> bool:
    return (
        old.ambient == new.ambient
        and old.lights == new.lights
        and (
            old.surfaces is new.surfaces
            or [(surface.name, surface.reflectance) for surface in old.surfaces]
            == [(surface.name, surface.reflectance) for surface in new.surfaces]
        )
    )
