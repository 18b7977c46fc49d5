"""The light equation at a point: the contribution of each light. `lighting.light` has the equation."""

from __future__ import annotations

import math
from dataclasses import dataclass

from autocolor.explanation.point import PointExplained
from autocolor.lighting.light import exact_rays_to, light_at, shares_of, specular_factor
from autocolor.lighting.rays import camera_light
from autocolor.scene.lights import Light
from autocolor.visibility.visible_points import VisiblePoints


@dataclass(frozen=True)
class LightExplained:
    """The contribution of one light, which is `diffuse` + `specular`.

    `cos_incidence`, `cos_eye` and `cos_light` are the cosines of I, E and L; the last is None for a light
    without a direction. `controls` has the name of each control of the light, and the share that it leaves,
    0 to 1. `specular_factor` is cos^N(E), or what takes its place under another reflection model.
    """

    light: int
    name: str
    intensity: float
    cos_incidence: float
    cos_eye: float
    cos_light: float | None
    controls: tuple[tuple[str, float], ...]
    specular_factor: float
    diffuse: float
    specular: float

    @property
    def share(self) -> float:
        """The share of the light that all controls leave, 0 to 1."""
        return math.prod(share for _, share in self.controls)

    @property
    def contribution(self) -> float:
        """The intensity that the light adds."""
        return self.diffuse + self.specular


def light_explained(
    light: Light, number: int, points: VisiblePoints, place: int, at: PointExplained
) -> LightExplained:
    """The contribution of a light of the world, the row `number` of the light table, at a visible point.

    `place` is that of the point among all visible points.
    """
    ready = camera_light(light, points)
    if light.axis is not None:
        ready = ready._replace(axis=points.camera_direction(light.axis))
    rays = exact_rays_to(ready, points.rows[:, place : place + 1])
    controls = {} if light.on else {"switch": 0.0}
    for name, share in shares_of(ready, rays):
        controls[name] = controls.get(name, 1.0) * float(share[0])
    reaches = light.intensity if light.on else 0.0
    links = light.links
    if links.only_surfaces is not None or links.except_surfaces is not None:
        controls["surfaces"] = float(links.shines_on_surface(at.surface_name))
        reaches *= controls["surfaces"]
    if links.depend_on_parts:
        controls["parts"] = float(bool(links.lit_parts([at.part_name])))
        reaches *= controls["parts"]
    factor = specular_factor(at.reflectance.model, rays)
    # Adding 0 makes 0 of -0.
    diffuse, specular = reaches * light_at(ready, rays, factor)[:, 0] + 0.0
    return LightExplained(
        light=number,
        name=light.name,
        intensity=light.intensity,
        cos_incidence=float(rays.cos_incidence[0]),
        cos_eye=float(rays.cos_eye[0]),
        cos_light=None if rays.cos_light is None else float(rays.cos_light[0]),
        controls=tuple(controls.items()),
        specular_factor=float(factor[0]) if rays.cos_incidence[0] > 0 else 0.0,
        diffuse=float(diffuse) * at.reflectance.diffuse,
        specular=float(specular) * at.reflectance.specular,
    )
