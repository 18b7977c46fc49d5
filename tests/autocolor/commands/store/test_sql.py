from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from autocolor import read_scene, write_scene
from autocolor.commands.store.sql import sql
from autocolor.errors import AutocolorError
from autocolor.scene.lights.half_spaces import HalfSpace
from autocolor.scene.lights.links import Links
from tests.autocolor.files.store.stores import small_scene, small_store, tables_of

LIGHTS = "SELECT name, intensity FROM lights"


def asked(*arguments: object, stdin: str = "") -> Result:
    return CliRunner().invoke(sql, [str(each) for each in arguments], input=stdin)


def refused(*arguments: object, stdin: str = "") -> AutocolorError:
    error = asked(*arguments, stdin=stdin).exception
    assert isinstance(error, AutocolorError)
    return error


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a scene file that has a comment."""
    path = tmp_path / "small"
    write_scene(path, small_scene().replace(mesh=small_scene().mesh.with_scalars()))
    file = path / "scene.toml"
    file.write_text(f"# mine\n{file.read_text()}")
    return path


def test_rows_are_a_table_csv_or_json(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    assert asked(path, LIGHTS).stdout.splitlines() == [
        "name  intensity",
        "----  ---------",
        "key         1.0",
        "rim         1.0",
    ]
    assert asked(path, LIGHTS, "--csv").stdout == "name,intensity\nkey,1.0\nrim,1.0\n"
    rows = [{"name": "key", "intensity": 1.0}, {"name": "rim", "intensity": 1.0}]
    assert json.loads(asked(path, LIGHTS, "--json").stdout) == rows
    assert json.loads(asked(path, LIGHTS, "--format", "json").stdout) == rows
    assert "leave one of the options" in str(refused(path, LIGHTS, "--json", "--csv"))


def test_a_folder_and_a_picture_file_are_asked_as_a_store_is(folder: Path, tmp_path: Path) -> None:
    from autocolor import render, write_picture

    picture = tmp_path / "small.npz"
    scene = read_scene(folder)
    write_picture(picture, render(scene, 12, 16), scene)
    for source in (folder, folder / "scene.toml", picture, small_store(tmp_path)):
        assert asked(source, "SELECT count(*) AS n FROM nodes", "--csv").stdout == "n\n5\n"


def test_a_change_needs_write(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    before = path.read_bytes()
    error = refused(path, "UPDATE lights SET intensity = 2")
    assert error.exit_code == 2
    assert "this one changes lights; allow changes with --write" in str(error)
    assert path.read_bytes() == before


def test_a_change_is_saved_to_the_store(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    result = asked(path, "UPDATE lights SET intensity = 2 WHERE name = 'key'", "--write")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "changed 1 row\n")
    assert read_scene(path).light("key").intensity == 2
    assert asked(path, LIGHTS, "--write").stdout.endswith("rim         1.0\n")


def test_a_change_is_saved_to_the_scene_file_and_its_comments_stay(folder: Path) -> None:
    result = asked(folder, "DELETE FROM lights WHERE name = 'rim'", "--write")
    assert result.exit_code == 0, result.output
    assert [light.name for light in read_scene(folder).lights] == ["key"]
    assert (folder / "scene.toml").read_text().startswith("# mine\n")


def test_a_change_that_would_be_wrong_is_refused_as_a_whole(tmp_path: Path, folder: Path) -> None:
    path = small_store(tmp_path)
    before = tables_of(path)
    error = refused(path, "UPDATE polygons SET node1 = 9", "--write")
    assert error.exit_code == 2
    assert str(error).splitlines() == [
        "nothing was changed",
        "small.sqlite: polygons, row 1: node 9 is not in the node table (1 to 5); correct it",
        "small.sqlite: polygons, row 2: node 9 is not in the node table (1 to 5); correct it",
    ]
    assert tables_of(path) == before
    text = (folder / "scene.toml").read_bytes()
    refused(folder, "UPDATE polygons SET node1 = 9", "--write")
    assert (folder / "scene.toml").read_bytes() == text


HALF_SPACE = '{"left": {"point": [0, 0, 0], "direction": [0, 0, 1], "edge_width": %s}}'


def test_half_spaces_and_links_are_changed_as_json(tmp_path: Path, folder: Path) -> None:
    for path in (small_store(tmp_path), folder):
        values = f"half_spaces = '{HALF_SPACE % 0.5}', only_parts = '[\"hood\"]', follows = 'eye'"
        result = asked(path, f"UPDATE lights SET {values} WHERE name = 'rim'", "--write")
        assert result.exit_code == 0, result.output
        light = read_scene(path).light("rim")
        assert light.half_spaces == (HalfSpace("left", (0, 0, 0), (0, 0, 1), 0.5),)
        assert (light.links, light.follows) == (Links(only_parts=("hood",)), "eye")
        query = (
            "SELECT json_extract(half_spaces, '$.left.edge_width') AS width FROM lights WHERE name = 'rim'"
        )
        assert json.loads(asked(path, query, "--json").stdout) == [{"width": 0.5}]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (
            f"half_spaces = '{HALF_SPACE % -1}'",
            "lights, row 1: half_spaces.left.edge_width must be a finite number of at least 0, not -1",
        ),
        (
            "follows = 'key'",
            "light 'key': follows must not lead back to it, as 'key' to 'key' does; change one of them",
        ),
        (
            "except_parts = '[\"hod\"]'",
            "light 'key': except_parts 'hod' is not in the part table; did you mean 'hood'?",
        ),
    ],
)
def test_half_spaces_and_names_that_are_wrong_are_told_and_not_saved(
    tmp_path: Path, change: str, told: str
) -> None:
    path = small_store(tmp_path)
    before = tables_of(path)
    error = refused(path, f"UPDATE lights SET {change} WHERE name = 'key'", "--write")
    assert str(error).splitlines() == ["nothing was changed", f"small.sqlite: {told}"]
    assert tables_of(path) == before
    empty = refused(path, "UPDATE lights SET follows = ''", "--write")
    assert "follows must be 'eye' or the name of one of the lights, and a changed row does not" in str(empty)


@pytest.mark.parametrize(
    ("name", "advice"), [("a.npz", "take its scene out"), ("a.obj", "make a scene of it")]
)
def test_a_picture_or_a_mesh_is_not_written_to(tmp_path: Path, name: str, advice: str) -> None:
    error = refused(tmp_path / name, "DELETE FROM lights", "--write")
    assert error.exit_code == 2
    assert f"--write must save to a store or to a scene's folder, not to {tmp_path / name}; {advice}" in str(
        error
    )


def test_statements_come_from_stdin_one_after_the_other(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    text = "UPDATE lights\nSET intensity = 3; SELECT max(intensity) AS m FROM lights;\nSELECT ';' AS s"
    result = asked(path, "--write", "--csv", stdin=text)
    assert result.stdout == "m\n3.0\ns\n;\n"
    assert "'lihgts'" in str(refused(path, stdin="SELECT 1;\nSELECT * FROM lihgts;\n"))


def test_repairs_of_a_mesh_are_told_and_strict(tmp_path: Path) -> None:
    path = tmp_path / "torn.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\nf 1 1 2\n")
    result = asked(path, "SELECT count(*) AS n FROM polygons", "--csv", "--strict")
    assert (result.exit_code, result.stdout) == (1, "n\n1\n")
    assert result.stderr
