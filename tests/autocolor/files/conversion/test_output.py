from __future__ import annotations

from autocolor.files.conversion.output import WHOLE_SCENE
from autocolor.files.conversion.outputs import SCENE, outputs
from autocolor.files.meshes.formats import HELD, mesh_formats


def test_a_scene_file_holds_everything_and_a_mesh_no_lights() -> None:
    assert SCENE.holds == WHOLE_SCENE
    meshes = {each.name for each in mesh_formats()}
    of_meshes = [each for each in outputs() if each.name in meshes]
    assert of_meshes
    for each in of_meshes:
        assert each.holds <= {*HELD, "surfaces"}
