from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import InputError
from autocolor.files.store.store_file import read_store
from tests.autocolor.files.store.stores import run, small_scene, small_store


def test_a_row_that_is_added_needs_no_more_than_a_scene_file_does(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(
        path,
        "INSERT INTO lights (name, position_x, position_y, position_z) VALUES ('fill', 1, 2, 3)",
        "INSERT INTO surfaces (name, model, roughness) VALUES ('metal', 'cook-torrance', 0.2)",
        "UPDATE lights SET flaps_z_maximum = 0.5 WHERE name = 'rim'",
    )
    scene = read_store(path).scene
    expected = small_scene().with_new_light("fill", position=(1, 2, 3))
    assert scene.lights == expected.with_light("rim", flaps={"z": {"maximum": 0.5}}).lights
    assert scene.surface("metal").reflectance.model.roughness == 0.2  # type: ignore[attr-defined]


def test_the_growth_of_s_is_set_by_sql_as_in_a_scene_file(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(
        path,
        "UPDATE surfaces SET refractive_index = 1.5 WHERE name = 'body'",
        "UPDATE surfaces SET fresnel_curve = '[[0, 0.04], [90, 1]]' WHERE name = 'glass'",
    )
    scene = read_store(path).scene
    expected = small_scene().with_surface("body", refractive_index=1.5)
    assert scene.surfaces == expected.with_surface("glass", fresnel_curve=[(0, 0.04), (90, 1)]).surfaces
    run(path, "UPDATE surfaces SET model = 'cook-torrance', exponent = NULL WHERE name = 'body'")
    with pytest.raises(InputError) as refused:
        read_store(path)
    assert refused.value.problems == (
        "small.sqlite: surfaces, row 1: refractive_index must go with model = 'phong' or 'blinn', not with"
        " 'cook-torrance'; leave it out, or change the other",
    )


def test_tables_that_are_missing_are_created_and_told(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "DROP TABLE surfaces", "DROP TABLE lights", "DROP TABLE view")
    report = read_store(path)
    assert [part.surface for part in report.scene.parts] == ["body", "glass"]
    assert [surface.name for surface in report.scene.surfaces] == ["body", "glass"]
    assert report.is_view_created
    assert report.are_lights_created
    run(path, "DROP TABLE parts")
    own = read_store(path, surfaces="parts").scene
    assert [(part.name, part.surface) for part in own.parts] == [("hood", "hood"), ("roof", "roof")]


def test_an_empty_table_of_lights_means_no_lights(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "DELETE FROM lights")
    assert read_store(path).scene.lights == ()


def test_every_problem_of_the_rows_is_told(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(
        path,
        "UPDATE surfaces SET exponent = 5, model = 'cook-torrance' WHERE name = 'glass'",
        "UPDATE lights SET concentration = 3 WHERE name = 'rim'",
        "UPDATE scene SET exposure = '{\"body\": [2, 1]}'",
    )
    with pytest.raises(InputError) as refused:
        read_store(path)
    first, second = refused.value.problems
    assert first.startswith("small.sqlite: surfaces, row 2: exponent must go with model = 'phong'")
    assert second.startswith("small.sqlite: lights, row 2: concentration must come with a direction")


def test_more_than_one_row_of_a_table_of_one_is_refused(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(
        path,
        "CREATE TABLE views AS SELECT * FROM view",
        "DROP TABLE view",
        "ALTER TABLE views RENAME TO view",
    )
    run(path, "INSERT INTO view SELECT * FROM view")
    with pytest.raises(InputError, match="view must have one row, not 2; leave one"):
        read_store(path)


NEW_COLUMNS = (
    "inner_angle", "half_spaces", "falloff", "reach", "at_infinity", "follows", "only_surfaces",
    "except_surfaces", "only_parts", "except_parts", "flaps_x_edge_width", "flaps_y_edge_width",
    "flaps_z_edge_width",
)  # fmt: skip


def test_a_store_that_lacks_columns_gives_their_defaults(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "UPDATE lights SET flaps_z_maximum = 0.5 WHERE name = 'rim'")
    others = [name for _, name, *_ in run(path, "PRAGMA table_info(lights)") if name not in NEW_COLUMNS]
    kept = ", ".join(f'"{name}"' for name in others)
    run(
        path,
        f"CREATE TABLE before AS SELECT {kept} FROM lights",
        "DROP TABLE lights",
        "ALTER TABLE before RENAME TO lights",
    )
    expected = small_scene().with_light("rim", flaps={"z": {"maximum": 0.5}})
    assert read_store(path).scene.lights == expected.lights


def test_rows_by_name_and_names_are_read_from_what_any_tool_writes(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(
        path,
        "UPDATE lights SET half_spaces = json_object('left', json_object("
        "'point', json_array(0, 0, 1), 'direction', json_array(1, 0, 0))) WHERE name = 'rim'",
        "UPDATE lights SET only_parts = '[\"hood\"]', follows = 'key' WHERE name = 'rim'",
    )
    assert read_store(path).scene.light("rim") == small_scene().light("rim").replace(
        half_spaces={"left": {"point": (0, 0, 1), "direction": (1, 0, 0)}},
        only_parts=["hood"],
        follows="key",
    )


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (
            """half_spaces = '{"left": {"point": [0,0,0], "direction": [0,0,1], "edge_width": -1}}'""",
            "lights, row 1: half_spaces.left.edge_width must be a finite number of at least 0, not -1",
        ),
        (
            """half_spaces = '{"left": '""",
            "lights, row 1: half_spaces must be a table of half-spaces by name, not '{\"left\": '",
        ),
        ("half_spaces = 3", "lights, row 1: half_spaces must be a table of half-spaces by name, not 3"),
        ("only_parts = 'hood'", "lights, row 1: only_parts must be a list of names, not 'hood'"),
        (
            """only_parts = '["hod"]'""",
            "light 'key': only_parts 'hod' is not in the part table; did you mean 'hood'?",
        ),
        (
            "follows = 'rm'",
            "light 'key': follows 'rm' is not in the light table; did you mean 'rim'?",
        ),
        (
            "follows = 'rim'",
            "light 'key': follows must be a light with an aim, not 'rim' without one; give it an aim",
        ),
    ],
)
def test_what_is_wrong_with_them_is_told_with_its_place(tmp_path: Path, change: str, told: str) -> None:
    path = small_store(tmp_path)
    run(path, f"UPDATE lights SET {change} WHERE name = 'key'")
    with pytest.raises(InputError) as refused:
        read_store(path)
    assert list(refused.value.problems) == [f"small.sqlite: {told}"]
