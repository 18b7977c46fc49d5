from __future__ import annotations

import dataclasses

import numpy as np

from autocolor import scene_of
from autocolor.files.conversion.left_out import left_out
from autocolor.files.conversion.output import Output
from autocolor.files.conversion.outputs import SCENE, output_named
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from tests.autocolor.meshes import cube

NOTHING = Output("NOTHING", (), lambda path, scene, overwrite: [], frozenset())
MESH = cube().with_scalars(
    MeshScalar("stress", np.zeros(8)),
    MeshScalar("u", np.zeros(8)),
    MeshScalar("fault", np.zeros(6), "polygon"),
)


def test_a_scene_file_leaves_nothing_out() -> None:
    assert left_out(scene_of(MESH), SCENE, is_bare=False) == []


def test_scalars_are_named_where_a_format_has_none() -> None:
    assert left_out(scene_of(MESH), output_named("obj"), is_bare=True) == [
        "2 node scalars ('stress', 'u')",
        "1 polygon scalar ('fault')",
    ]


def test_of_a_bare_mesh_only_what_is_of_the_mesh_is_told() -> None:
    two = dataclasses.replace(MESH, part_names=("cube", "lid"), crease_angle=60)
    assert left_out(scene_of(two), NOTHING, is_bare=True) == [
        "2 parts ('cube', 'lid')",
        "2 node scalars ('stress', 'u')",
        "1 polygon scalar ('fault')",
        "the crease angle of 60 degrees",
    ]


def test_of_a_scene_its_surfaces_lights_view_and_settings_are_told() -> None:
    scene = scene_of(cube(), surfaces="parts").replace(background=(1, 2, 3))
    told = left_out(scene, NOTHING, is_bare=False)
    assert told[:3] == [
        "1 surface ('cube')",
        "4 lights ('key', 'fill', 'top', 'rim')",
        "the view",
    ]
    assert "'background'" in told[3]


def test_what_materials_do_not_hold_of_surfaces_is_told() -> None:
    scene = scene_of(cube(), surfaces="parts").with_surface("cube", diffuse=0.25)
    assert left_out(scene, output_named("OBJ"), is_bare=False)[0] == (
        "what a material does not have of 1 of 1 surfaces ('cube')"
    )


def test_many_names_are_cut() -> None:
    mesh = dataclasses.replace(cube(), part_names=("cube", *map(str, range(9))))
    assert left_out(scene_of(mesh), NOTHING, is_bare=True) == [
        "10 parts ('cube', '0', '1', '2', '3' and 5 more)"
    ]
