"""Meshes of any size are rendered without an error where numpy is told to raise floating-point errors."""

from __future__ import annotations

import numpy as np
import pytest

from autocolor import Mesh, Scene, View, render, scene_of
from autocolor.images import display_image
from autocolor.mapping.legend import legend
from autocolor.scene.mesh_faults import mesh_faults
from autocolor.scene.scalar import COMPUTED
from tests.small import cube, sphere

DEGENERATE = Mesh(
    np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]]),
    np.array([[0, 1, 2, 2], [0, 1, 1, 1], [3, 3, 3, 3], [0, 1, 3, 3]]),
)


def variants(scene: Scene) -> list[Scene]:
    """The scene in other light, mapped otherwise, and colored by every computed scalar."""
    light = scene.lights[0].name
    lights = [
        {"intensity": 1e-320},
        {"intensity": 1e37},
        {"concentration": 1e30},
        {"cone_angle": 30.0, "inner_angle": 10.0},
        {"falloff": "quadratic", "reach": 1e-30},
        {"position": scene.view.eye},
        {"flaps": {"z": {"minimum": -1e30, "maximum": 0.1, "edge_width": 1e-300}}},
    ]
    (surface,) = (each.name for each in scene.surfaces)
    return [
        scene,
        *(scene.with_light(light, **changes) for changes in lights),  # type: ignore[arg-type]
        *(scene.with_surface(surface, model=model) for model in ("blinn", "cook-torrance")),
        *(scene.replace(mapping=mapping) for mapping in ("gamma", "logarithm", "equalize")),
        *(scene.with_scalar(name=name) for name in COMPUTED),
        scene.with_scalar(name="z", limits=(0, 5e-324)),
        scene.replace(words="normals"),
        scene.replace(lights=()),
        scene.replace(view=View(scene.mesh.bounds[0].tolist(), direction=(1, 0.5, 0.2))),
    ]


@pytest.mark.parametrize(
    ("mesh", "scale"),
    [
        *((sphere(8, 6), [size] * 3) for size in (1e-320, 1e-157, 1e-30, 1e29)),
        (sphere(8, 6), [1e-320, 1, 1]),
        (cube(), [1, 1, 1e29]),
        (DEGENERATE, [1e-157] * 3),
    ],
    ids=repr,
)
def test_nothing_raises_a_floating_point_error(mesh: Mesh, scale: list[float]) -> None:
    with np.errstate(under="ignore"):
        coordinates = mesh.coordinates * scale
    with np.errstate(all="raise"):
        scene = scene_of(Mesh(coordinates, mesh.node_numbers))
        mesh_faults(scene.mesh)
        for variant in variants(scene):
            picture = render(variant, (32, 24))
            assert np.isfinite(picture.relative).all()
            legend(display_image(variant, picture))
