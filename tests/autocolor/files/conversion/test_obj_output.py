from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import Scene, read_scene, scene_of
from autocolor.errors import OutputError
from autocolor.files.conversion.obj_output import beyond_materials, material_names, write_obj
from autocolor.scene.surfaces import Surface
from tests.autocolor.meshes import cube, wall_scene


def colored() -> Scene:
    """A cube whose one surface has a color and a highlight of its own."""
    scene = scene_of(cube(), surfaces=[Surface("body")], parts={"cube": {"surface": "body"}})
    return scene.with_surface("body", object_color=(10, 20, 30), specular=0.25, exponent=7.5)


def test_surfaces_become_materials_that_read_back(tmp_path: Path) -> None:
    path = tmp_path / "box.obj"
    assert write_obj(path, colored(), False) == [path, tmp_path / "box.mtl"]
    again = read_scene(path, strict=True)
    assert again.mesh.part_names == ("cube",)
    (body,) = again.surfaces
    assert (body.name, body.paint.object_color) == ("body", (10, 20, 30))
    assert (body.reflectance.specular, body.reflectance.exponent) == (0.25, 7.5)


def test_a_mesh_whose_surface_was_created_has_no_library(tmp_path: Path) -> None:
    path = tmp_path / "box.obj"
    assert write_obj(path, scene_of(cube()), False) == [path]
    assert b"usemtl" not in path.read_bytes()


@pytest.mark.parametrize("existing", ["wall.obj", "wall.mtl"])
def test_neither_file_is_overwritten_unless_that_is_allowed(tmp_path: Path, existing: str) -> None:
    (tmp_path / existing).write_text("mine")
    with pytest.raises(OutputError, match="must be a new file"):
        write_obj(tmp_path / "wall.obj", colored(), False)
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [(existing, "mine")]
    write_obj(tmp_path / "wall.obj", colored(), True)
    assert len(list(tmp_path.iterdir())) == 2


def test_names_of_materials_are_readable_and_differ() -> None:
    assert material_names(["body", "a\nb", "a?b", ""]) == {
        "body": "body",
        "a\nb": "a?b",
        "a?b": "a?b 2",
        "": "surface",
    }


def test_what_a_library_does_not_hold_is_found_by_reading_it() -> None:
    scene = read_back = wall_scene()
    assert beyond_materials(read_back.surfaces) == [each.name for each in scene.surfaces]
