from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import InputError, UsageError, open_tables
from autocolor.files.scene_sources import read_scene
from autocolor.files.scene_writing import write_scene
from tests.autocolor.files.store.stores import is_equal, run, small_scene, small_store, tables_of


def test_rows_are_selected_joined_and_given_by_name(tmp_path: Path) -> None:
    with open_tables(small_store(tmp_path)) as tables:
        query = (
            "SELECT parts.name, count(*) AS polygons FROM polygons JOIN parts ON part = parts.name"
            " WHERE surface = :surface GROUP BY part"
        )
        assert tables.select(query, {"surface": "glass"}) == [{"name": "roof", "polygons": 1}]
        assert [row["name"] for row in tables.table("lights")] == ["key", "rim"]
        assert tables.columns("nodes") == ["node", "x", "y", "z"]
        assert {"scene", "nodes", "polygons", "parts", "view"} <= set(tables.names)
        assert is_equal(tables.scene(), small_scene())
        twice = tables.select("SELECT 1 AS a, 2 AS a")
        assert twice == [{"a": 1, "a 2": 2}]


def test_a_mesh_file_is_opened_by_its_up_axis_and_scale_which_a_store_gives_itself(tmp_path: Path) -> None:
    (tmp_path / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 3 0\nf 1 2 3\n")
    with open_tables(tmp_path / "one.obj", up="y", scale=0.5) as tables:
        assert tables.select("SELECT max(z) AS top FROM nodes") == [{"top": 1.5}]
    with pytest.raises(UsageError, match="scale is for mesh files"):
        open_tables(small_store(tmp_path), scale=2.0)


def test_a_row_is_changed_by_its_key_and_saved_at_once(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    with open_tables(path) as tables:
        tables.update("lights", "key", intensity=2.5, on=False)
        tables.update("nodes", 5, z=3.0)
        assert tables.scene().light("key").intensity == 2.5
    scene = read_scene(path)
    assert (scene.light("key").intensity, scene.light("key").on) == (2.5, False)
    assert scene.mesh.coordinates[4, 2] == 3.0


@pytest.mark.parametrize(
    ("table", "key", "values", "problem"),
    [
        ("light", "key", {"on": 1}, "there is no table 'light'; did you mean 'lights'?"),
        ("lights", "kye", {"on": 1}, "there is no row of lights with name 'kye'; did you mean 'key'?"),
        (
            "lights",
            "key",
            {"intensty": 1},
            "there is no column of lights 'intensty'; did you mean 'intensity'?",
        ),
        ("lights", "key", {}, "an update must change a column, not none"),
        (
            "lights",
            "key",
            {"intensity": -1},
            "intensity must be a finite number of at least 0, and a changed row",
        ),
        ("nodes", 1, {"x": "left"}, "nodes.x must be REAL, not TEXT; convert it"),
    ],
)
def test_an_update_that_is_wrong_says_what_to_do(
    tmp_path: Path, table: str, key: str, values: dict[str, object], problem: str
) -> None:
    path = small_store(tmp_path)
    before = tables_of(path)
    with open_tables(path) as tables, pytest.raises(UsageError, match=problem):
        tables.update(table, key, **values)
    assert tables_of(path) == before


def test_a_change_that_makes_the_scene_wrong_is_refused_as_a_whole(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    before = tables_of(path)
    with open_tables(path) as tables:
        with pytest.raises(InputError, match="polygons, row 2: node 5 is not in the node table"):
            tables.change("DELETE FROM nodes WHERE node > 4")
        with pytest.raises(InputError, match="lights, row 2: concentration must come with a direction"):
            tables.change("UPDATE lights SET concentration = 3")
        with pytest.raises(
            InputError, match="parts, row 1: surface 'glas' is not in the surface table; did you"
        ):
            tables.change("UPDATE parts SET surface = 'glas'")
    assert tables_of(path) == before


def test_a_surface_that_is_renamed_is_renamed_where_it_is_referred_to(tmp_path: Path) -> None:
    with open_tables(small_store(tmp_path)) as tables:
        tables.update("surfaces", "body", name="paint")
        tables.update("parts", "hood", name="bonnet")
        scene = tables.scene()
    assert scene.part("bonnet").surface == "paint"
    assert scene.mesh.part_names == ("bonnet", "roof")


def test_values_of_scalars_go_with_their_polygons(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    with open_tables(path) as tables:
        assert tables.change("DELETE FROM polygons WHERE part = 'roof'") == 1
    mesh = read_scene(path).mesh
    assert [(each.name, len(each.values)) for each in mesh.scalars] == [("stress", 5), ("area", 1)]


def test_triggers_of_others_are_not_run_by_a_change_and_kept(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "CREATE TRIGGER evil AFTER UPDATE ON lights BEGIN DELETE FROM surfaces; END")
    with open_tables(path) as tables:
        tables.update("lights", "key", intensity=2.0)
    assert run(path, "SELECT count(*) FROM surfaces") == [(2,)]
    assert run(path, "SELECT name FROM sqlite_master WHERE type = 'trigger'") == [("evil",)]


def test_a_scene_of_files_is_read_into_memory_and_written_by_its_user(tmp_path: Path) -> None:
    folder = tmp_path / "small"
    write_scene(folder, small_scene().replace(mesh=small_scene().mesh.with_scalars()))
    with open_tables(folder) as tables:
        tables.update("lights", "rim", intensity=0.5)
        assert read_scene(folder).light("rim").intensity == 1.0
        autocolor.write_scene(folder, tables.scene(), overwrite=True)
    assert read_scene(folder).light("rim").intensity == 0.5
