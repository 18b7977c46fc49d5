from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

import pytest
from click.testing import CliRunner

import autocolor
from autocolor.commands.tables import tables

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng lid\nf 1 2 3 4\n"


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    path = tmp_path / "box" / "square.obj"
    path.parent.mkdir()
    path.write_text(SQUARE)
    return path


@pytest.mark.parametrize("surfaces", ["materials", "parts"])
@pytest.mark.parametrize("materials", ["", "usemtl red\n"])
def test_created_tables_fed_back_give_the_same_picture(
    mesh: Path, surfaces: Literal["materials", "parts"], materials: str
) -> None:
    mesh.write_text(SQUARE.replace("f 1", f"{materials}f 1"))
    mesh.with_suffix(".mtl").write_text("newmtl red\nKd 1 0.5 0\nKs 0.25\nNs 9\n")
    bare = autocolor.read_scene(mesh, surfaces=surfaces)
    result = CliRunner().invoke(tables, [str(mesh), "--surfaces", surfaces, "--write"])
    assert result.exit_code == 0, result.output
    again = autocolor.read_scene(mesh.parent)
    assert (again.parts, again.surfaces, again.lights) == (bare.parts, bare.surfaces, bare.lights)
    assert again.view == bare.view
    first, second = autocolor.render(bare, 48, 64), autocolor.render(again, 48, 64)
    assert (first.intensity == second.intensity).all()
    assert (first.surface_number == second.surface_number).all()


def test_tables_on_stdout_are_the_scene_file_that_write_writes(mesh: Path) -> None:
    shown = CliRunner().invoke(tables, [str(mesh)])
    CliRunner().invoke(tables, [str(mesh), "--write"])
    assert shown.stdout == (mesh.parent / "scene.toml").read_text()


def test_a_scene_file_is_not_overwritten_without_force(mesh: Path) -> None:
    scene = mesh.parent / "scene.toml"
    scene.write_text("ambient = 0.5\n")
    refused = CliRunner().invoke(tables, [str(mesh), "--write"])
    assert isinstance(refused.exception, autocolor.OutputError)
    assert scene.read_text() == "ambient = 0.5\n"
    assert CliRunner().invoke(tables, [str(mesh), "--write", "--force"]).exit_code == 0
    assert 'surface = "surface"' in scene.read_text()


def test_tables_as_json_hold_every_table(mesh: Path) -> None:
    values = json.loads(CliRunner().invoke(tables, [str(mesh), "--json"]).stdout)
    assert values["parts"] == [{"name": "lid", "surface": "surface", "stage": False}]
    assert len(values["lights"]) == 4
    assert {"surfaces", "view", "ambient", "mesh"} <= set(values)


def test_the_tables_of_a_picture_file_are_written_with_its_mesh_beside(mesh: Path, tmp_path: Path) -> None:
    scene = autocolor.read_scene(mesh).with_light("key", intensity=2.5)
    path = tmp_path / "pictures" / "square.npz"
    path.parent.mkdir()
    autocolor.write_picture(path, scene, autocolor.render(scene, 24, 32))
    result = CliRunner().invoke(tables, [str(path), "--write"])
    assert result.exit_code == 0, result.output
    assert (
        f"wrote {path.parent / 'mesh.obj'}\nwrote {path.parent / 'scene.toml'}; to render it" in result.stderr
    )
    again = autocolor.read_scene(path.parent)
    assert again.replace(mesh=scene.mesh, name=scene.name).equals(scene)
    assert (again.mesh.coordinates == scene.mesh.coordinates).all()
    refused = CliRunner().invoke(tables, [str(path), "--write"])
    assert isinstance(refused.exception, autocolor.OutputError)
    assert len(list(path.parent.iterdir())) == 3


def test_tables_written_over_a_scene_file_keep_its_comments(mesh: Path) -> None:
    text = '# By hand.\nambient = 0.50 # dim\n\n[[mesh]]\nfile = "square.obj"\n'
    (mesh.parent / "scene.toml").write_text(text)
    scene = autocolor.read_scene(mesh.parent)
    result = CliRunner().invoke(tables, [str(mesh.parent), "--write", "--force"])
    assert result.exit_code == 0, result.output
    after = (mesh.parent / "scene.toml").read_text()
    assert after.startswith("# By hand.\nambient = 0.50 # dim\n")
    assert after.count("[[lights]]") == 4
    assert "two_sided = true" in after
    assert "crease_angle = 40.0" in after
    assert autocolor.read_scene(mesh.parent).replace(mesh=scene.mesh).equals(scene)


def test_half_spaces_and_links_are_told_as_text_and_as_json_and_fed_back(mesh: Path) -> None:
    scene = autocolor.read_scene(mesh).with_light(
        "key",
        half_spaces={"left": {"point": (0, 0, 0), "direction": (1, 0, 0)}},
        except_parts=["lid"],
        follows="eye",
    )
    path = mesh.parent / "square.npz"
    autocolor.write_picture(path, scene, autocolor.render(scene, 24, 32))
    text = CliRunner().invoke(tables, [str(path)]).stdout
    assert (
        "half_spaces.left = { point = [0.0, 0.0, 0.0], direction = [1.0, 0.0, 0.0], edge_width = 0.0," in text
    )
    assert 'follows = "eye"\nexcept_parts = ["lid"]\n' in text
    light = json.loads(CliRunner().invoke(tables, [str(path), "--json"]).stdout)["lights"][0]
    assert (light["follows"], light["except_parts"]) == ("eye", ["lid"])
    assert light["half_spaces"]["left"]["direction"] == [1.0, 0.0, 0.0]
    assert CliRunner().invoke(tables, [str(path), "--write"]).exit_code == 0
    assert autocolor.read_scene(mesh.parent).lights == scene.lights
