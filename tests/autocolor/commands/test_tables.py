from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

import pytest

import autocolor
from tests.autocolor.commands.conftest import Refused, Run

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng lid\nf 1 2 3 4\n"
MESH = "box/square.obj"


@pytest.fixture(autouse=True)
def box(folder: Path) -> Path:
    """A folder of the current folder with a mesh, square.obj."""
    (folder / "box").mkdir()
    Path(MESH).write_text(SQUARE)
    return folder / "box"


@pytest.mark.parametrize("surfaces", ["materials", "parts"])
@pytest.mark.parametrize("materials", ["", "usemtl red\n"])
def test_created_tables_fed_back_give_the_same_picture(
    box: Path, run: Run, surfaces: Literal["materials", "parts"], materials: str
) -> None:
    Path(MESH).write_text(SQUARE.replace("f 1", f"{materials}f 1"))
    (box / "square.mtl").write_text("newmtl red\nKd 1 0.5 0\nKs 0.25\nNs 9\n")
    bare = autocolor.read_scene(MESH, surfaces=surfaces)
    text = run("tables", MESH, "--surfaces", surfaces).out
    ran = run("tables", MESH, "--surfaces", surfaces, "--write")
    told = "wrote box/scene.toml; to render it, name it or its folder, not the mesh"
    assert (ran.code, ran.out, ran.err.splitlines()[-1]) == (0, "", told)
    assert text == (box / "scene.toml").read_text()
    again = autocolor.read_scene(box)
    assert (again.parts, again.surfaces, again.lights) == (bare.parts, bare.surfaces, bare.lights)
    assert again.view == bare.view
    first, second = autocolor.render(bare, (32, 24)), autocolor.render(again, (32, 24))
    assert (first.intensity == second.intensity).all()
    assert (first.surface_number == second.surface_number).all()


def test_a_scene_file_is_not_overwritten_without_force(box: Path, run: Run, refused: Refused) -> None:
    (box / "scene.toml").write_text("ambient = 0.5\n")
    refused(f"tables {MESH} --write", 73)
    assert run("tables", MESH, "--write", "--force").code == 0
    assert 'surface = "surface"' in (box / "scene.toml").read_text()


def test_the_tables_of_a_picture_file_are_written_with_its_mesh_beside(
    folder: Path, run: Run, refused: Refused
) -> None:
    scene = autocolor.read_scene(MESH).with_light(
        "key",
        half_spaces={"left": {"point": (0, 0, 0), "direction": (1, 0, 0)}},
        except_parts=["lid"],
        follows="eye",
    )
    (folder / "pictures").mkdir()
    autocolor.write_picture("pictures/square.npz", scene, autocolor.render(scene, (32, 24)))
    light = json.loads(run("tables", "pictures/square.npz", "--json").out)["lights"][0]
    assert (light["follows"], light["except_parts"]) == ("eye", ["lid"])
    assert light["half_spaces"]["left"]["direction"] == [1.0, 0.0, 0.0]
    ran = run("tables", "pictures/square.npz", "--write")
    assert ran.code == 0
    assert "wrote pictures/mesh.obj\nwrote pictures/scene.toml; to render it" in ran.err
    again = autocolor.read_scene("pictures")
    assert again.replace(mesh=scene.mesh, name=scene.name).equals(scene)
    assert (again.mesh.coordinates == scene.mesh.coordinates).all()
    refused("tables pictures/square.npz --write", 73)
