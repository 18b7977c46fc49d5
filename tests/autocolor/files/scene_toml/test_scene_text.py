from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given

from autocolor import Light, Scene
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_toml.scene_file import read_scene_file
from autocolor.files.scene_toml.scene_text import edited_to
from autocolor.scene.columns import with_values
from tests.autocolor.linked_scenes import linked_scenes
from tests.autocolor.strategies import of_mesh

MESH = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\no part 0\nf 1 2 3 4\no part 1\nf 1 2 3\n"


MIXED = """\
# Mine.
view.eye = [1,2,3]
view.target = [0,0,0]
views = [ {name="hood", eye=[1,2,3], target=[0,0,0]} ]
parts = { "part 0" = {surface="body"}, "part 1".surface = "glass" }
scalar = { name = "z", limits = [0, 1] }
exposure.body = [0.0, 1.0]
exposure.object = [0.0, 1.0]
[surfaces]
[surfaces.glass]
[surfaces.body]
diffuse = 0.5
model = "blinn"
[[lights]]
name = "rim"  # behind
position = [1,2,3]
[lights.flaps.x]
minimum = 0.5
[[mesh]]
file = "car.obj"
[[lights]]
name = "fill"
position = [1,2,3]
flaps.z.on = false
half_spaces.left.point = [0,0,0]
half_spaces.left.direction = [1,0,0]
half_spaces."barn door" = { point = [1,0,0], direction = [1,0,0], edge_width = 0.1 }
only_parts = ["part 0"]
"""

COMMENTED = """\
# Mine.
ambient = 0.1 # dark
view = { eye = [0.5, -4, 0.5], target = [0.5, 0, 0.5] }
mesh = [ { file = "car.obj" } ]
surfaces = { body = { object_color = [176, 16, 32] } }
lights = [
  # the window, measured in May
  { name = "key", position = [1, -3, 2], intensity = 1 },  # 100 W
  { name = "rim", position = [
    -1, # west
    3, 2
  ], intensity = 1 }, # the lamp
]
"""

PLACE = Path("car", "scene.toml")
SHORT = '# Mine.\n[[mesh]]\nfile = "car.obj"\n'


@pytest.fixture(scope="module")
def meshes(tmp_path_factory: pytest.TempPathFactory) -> list[MeshReport]:
    path = tmp_path_factory.mktemp("mesh") / "car.obj"
    path.write_text(MESH)
    return [read_mesh({"file": path})]


def read(text: bytes, meshes: list[MeshReport]) -> Scene:
    return read_scene_file(PLACE, data=text, meshes=meshes).scene


def edited(text: str, scene: Scene, meshes: list[MeshReport]) -> str:
    data = edited_to(text.encode(), scene, PLACE, meshes)
    assert data is not None
    return data.decode()


@pytest.mark.parametrize("text", [MIXED, COMMENTED, SHORT])
@given(drawn=linked_scenes())
def test_a_file_in_any_style_is_changed_to_any_scene(
    text: str, drawn: Scene, meshes: list[MeshReport]
) -> None:
    assert edited(text, read(text.encode(), meshes), meshes) == text
    scene = of_mesh(drawn, meshes[0].mesh)
    after = edited(text, scene, meshes)
    assert with_values(read(after.encode(), meshes), {"mesh": scene.mesh, "name": scene.name}).equals(scene)
    assert after.count("# Mine.") == 1
    # Once there, it stays.
    assert edited(after, scene, meshes) == after


def test_a_renamed_light_keeps_its_place_and_its_comment(meshes: list[MeshReport]) -> None:
    scene = read(MIXED.encode(), meshes).with_light("rim", name="moon")
    assert edited(MIXED, scene, meshes) == MIXED.replace('"rim"', '"moon"')


def test_comments_within_arrays_stay_when_a_light_is_changed_added_or_removed(
    meshes: list[MeshReport],
) -> None:
    scene = read(COMMENTED.encode(), meshes)
    assert edited(COMMENTED, scene.with_light("key", intensity=2.5), meshes) == COMMENTED.replace(
        "1 },  #", "2.5 },  #"
    )
    assert edited(COMMENTED, scene.with_light("rim", position=(-1, 7, 2)), meshes) == COMMENTED.replace(
        "    3, 2", "    7.0, 2"
    )
    key, rim = scene.lights
    moon = Light("moon", (1.0, 2.0, 3.0))
    assert edited(COMMENTED, scene.replace(lights=(key, rim, moon)), meshes) == COMMENTED.replace(
        "# the lamp\n", '# the lamp\n  { name = "moon", position = [1.0, 2.0, 3.0] },\n'
    )
    without = edited(COMMENTED, scene.replace(lights=(rim,)), meshes)
    assert without == COMMENTED.replace(
        '  { name = "key", position = [1, -3, 2], intensity = 1 },  # 100 W\n', ""
    )
