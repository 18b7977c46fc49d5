from __future__ import annotations

import numpy as np

from autocolor import image, render, scene_of
from autocolor.commands.faults.fault_picture import COLORS, fault_scene
from autocolor.mapping.display_image import display_image
from autocolor.mapping.legend import legend
from autocolor.scene.geometry.faults.mesh_faults import KINDS, mesh_faults
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from tests.autocolor.meshes import cube


def test_there_is_a_color_for_each_kind() -> None:
    assert len(COLORS) == len(set(COLORS)) == len(KINDS)


def test_the_faults_color_the_scene_whatever_surfaces_it_has() -> None:
    mesh = cube()
    turned = mesh.node_numbers.copy()
    turned[0] = turned[0, ::-1]
    mesh = type(mesh)(mesh.coordinates, turned).with_scalars(
        MeshScalar("stress", np.zeros(8)), MeshScalar("fault", np.zeros(8))
    )
    scene = fault_scene(scene_of(mesh, surfaces="parts"), mesh_faults(mesh))
    assert [scalar.name for scalar in scene.mesh.scalars] == ["stress", "fault"]
    assert [scalar.of for scalar in scene.mesh.scalars] == ["node", "polygon"]
    colors = {tuple(color) for color in image(scene, render(scene, 60, 80)).reshape(-1, 3).tolist()}
    red, green, blue = COLORS[list(KINDS).index("turned")]
    # A shade of the kind's color: its components keep their order.
    assert any(g > b > r for r, g, b in colors), (red, green, blue)


def test_the_legend_has_the_numbers_of_the_kinds_and_0_for_none() -> None:
    scene = fault_scene(scene_of(cube()), ())
    found = legend(display_image(scene, render(scene)))
    assert found is not None
    assert [each.text for each in found.labels] == ["fault", *map(str, range(len(KINDS) + 1))]
