from __future__ import annotations

import sqlite3
import tracemalloc
from collections.abc import Iterator
from pathlib import Path

import pytest

import autocolor
from autocolor import InputError, MissingInputError, UsageError, WriteError, open_tables
from autocolor.files.opening import read_scene
from autocolor.files.scene_writing import write_scene
from autocolor.files.store.store_file import store_of
from autocolor.files.store.tables import LONGEST_COMPUTED, answer_of, changes_of
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


NOT_ONE = "a statement must be one that SQLite can run, and this one is not"
NO_CHANGE = "a statement must be a SELECT or, with --write, an INSERT, UPDATE or DELETE of rows, not another"

WRONG_UPDATES: dict[str, tuple[str, str | int, dict[str, object]]] = {
    "there is no table 'light'; did you mean 'lights'?": ("light", "key", {"on": 1}),
    "there is no row of lights with name 'kye'; did you mean 'key'?": ("lights", "kye", {"on": 1}),
    "there is no column of lights 'intensty'; did you mean 'intensity'?": ("lights", "key", {"intensty": 1}),
    "an update must change a column, not none; give one as in intensity=2.0": ("lights", "key", {}),
    "intensity must be a finite number of at least 0, and a": ("lights", "key", {"intensity": -1}),
    f"{NOT_ONE} (cannot store TEXT value in REAL column": ("nodes", 1, {"x": "left"}),
}


@pytest.mark.parametrize("problem", WRONG_UPDATES)
def test_an_update_that_is_wrong_says_what_to_do(tmp_path: Path, problem: str) -> None:
    path = small_store(tmp_path)
    before = path.read_bytes()
    table, key, values = WRONG_UPDATES[problem]
    with open_tables(path) as tables, pytest.raises(UsageError) as refused:
        tables.update(table, key, **values)
    assert str(refused.value).startswith(problem)
    assert path.read_bytes() == before


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
        roof = "WITH roof AS (SELECT 'roof') DELETE FROM polygons WHERE part = (SELECT * FROM roof)"
        assert [tables.change(roof) for _ in range(2)] == [1, 0]
    mesh = read_scene(path).mesh
    assert [(each.name, len(each.values)) for each in mesh.scalars] == [("stress", 5), ("area", 1)]


def test_a_store_with_a_trigger_is_read_and_not_changed(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    # It would change nothing itself, but keep the row from being changed.
    run(path, "CREATE TRIGGER evil BEFORE UPDATE ON lights BEGIN SELECT RAISE(IGNORE); END")
    before = path.read_bytes()
    with open_tables(path) as tables:
        assert is_equal(tables.scene(), small_scene())
        with pytest.raises(WriteError) as refused:
            tables.update("lights", "key", intensity=2.0)
    assert str(refused.value) == (
        "small.sqlite: a store that is changed must have no triggers, and this one has trigger 'evil'; drop"
        " it, or write the scene to another file"
    )
    assert path.read_bytes() == before


def test_views_and_indexes_of_others_are_no_hindrance_to_a_change(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "CREATE VIEW bright AS SELECT * FROM lights", "CREATE INDEX by_x ON nodes (abs(x))")
    with open_tables(path) as tables:
        tables.update("lights", "key", intensity=2.0)
        assert tables.select("SELECT max(intensity) AS most FROM bright") == [{"most": 2.0}]


def test_a_change_is_made_to_the_store_as_it_is_now(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    with open_tables(path) as tables:
        run(path, "UPDATE lights SET intensity = 5")
        assert tables.select("SELECT max(intensity) AS most FROM lights") == [{"most": 1.0}]
        tables.change("UPDATE lights SET intensity = intensity + 1 WHERE name = 'rim'")
        assert [row["intensity"] for row in tables.table("lights")] == [5.0, 6.0]
    path.unlink()
    with pytest.raises(MissingInputError):
        open_tables(path)


def test_a_row_that_a_table_of_others_refers_to_is_not_removed(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "CREATE TABLE notes (light REFERENCES lights (name))", "INSERT INTO notes VALUES ('rim')")
    before = tables_of(path)
    with (
        open_tables(path) as tables,
        pytest.raises(
            WriteError, match=r"small\.sqlite: tables of other programs must not refer to rows that a change"
        ),
    ):
        tables.change("DELETE FROM lights WHERE name = 'rim'")
    assert tables_of(path) == before


def test_a_scene_of_files_is_read_into_memory_and_written_by_its_user(tmp_path: Path) -> None:
    folder = tmp_path / "small"
    write_scene(folder, small_scene().replace(mesh=small_scene().mesh.with_scalars()))
    with open_tables(folder) as tables:
        tables.update("lights", "rim", intensity=0.5)
        assert read_scene(folder).light("rim").intensity == 1.0
        autocolor.write_scene(folder, tables.scene(), overwrite=True)
    assert read_scene(folder).light("rim").intensity == 0.5


ENDLESS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT "


@pytest.fixture
def connection() -> Iterator[sqlite3.Connection]:
    made = store_of(small_scene())
    yield made
    made.close()


@pytest.mark.parametrize(
    ("statement", "problem"),
    [
        ("SELECT * FROM light", f"{NOT_ONE} (no such table: light); correct it"),
        ("SELECT on FROM lights", f'{NOT_ONE} (near "on": syntax error); correct it'),
        ("SELECT * FROM", f"{NOT_ONE} (incomplete input); correct it"),
        ("SELECT 1; SELECT 2", f"{NOT_ONE} (You can only execute one statement at a time.); correct it"),
        ("  ; ", "a statement must not be empty; write one, as in SELECT"),
        ("DELETE FROM lights", "a statement must only read the tables, and this one changes lights; allow"),
        ("CREATE TABLE x (y)", NO_CHANGE),
        ("ATTACH 'x' AS y", NO_CHANGE),
        ("PRAGMA journal_mode = OFF", NO_CHANGE),
        ("SELECT load_extension('x')", f"{NOT_ONE} (not authorized to use function: load_extension)"),
        ("SELECT hex(hex(printf('%100000d', 1)))", f"{NOT_ONE} (string or blob too big)"),
        ("SELECT length(randomblob(1000000000))", f"{NOT_ONE} (string or blob too big); correct it"),
        ("SELECT length(zeroblob(1000000000))", f"{NOT_ONE} (string or blob too big); correct it"),
    ],
)
def test_a_wrong_statement_is_told_in_a_sentence_with_what_to_do(
    connection: sqlite3.Connection, statement: str, problem: str
) -> None:
    with pytest.raises(UsageError) as refused:
        list(answer_of(connection, statement).rows)
    assert str(refused.value).startswith(problem)


@pytest.mark.parametrize("select", ["max(i) FROM n", "i FROM n WHERE i < 0"])
def test_a_statement_that_runs_on_is_ended(connection: sqlite3.Connection, select: str) -> None:
    with pytest.raises(UsageError, match=r"a statement must end within 0\.05 seconds, not run on; narrow it"):
        list(answer_of(connection, ENDLESS + select, seconds=0.05).rows)


def test_rows_come_as_they_are_asked_for(connection: sqlite3.Connection) -> None:
    columns, rows = answer_of(connection, ENDLESS + "i, i FROM n")
    assert columns == ("i", "i 2")
    assert [next(rows) for _ in range(3)] == [(1, 1), (2, 2), (3, 3)]


def test_the_columns_of_an_answer_have_different_names(connection: sqlite3.Connection) -> None:
    assert answer_of(connection, 'SELECT 1 AS a, 2 AS "a 2", 3 AS a').columns == ("a", "a 2", "a 3")


def test_what_a_statement_would_change_is_known_before_it_is_run(connection: sqlite3.Connection) -> None:
    found = changes_of(connection, "UPDATE lights SET intensity = ?", [2.0])
    assert found == {"lights": {sqlite3.SQLITE_UPDATE}}
    assert connection.execute("SELECT DISTINCT intensity FROM lights").fetchall() == [(1.0,)]
    assert changes_of(connection, "SELECT * FROM lights") == {}


def test_long_rows_are_fetched_a_few_at_a_time(connection: sqlite3.Connection) -> None:
    rows = answer_of(connection, ENDLESS + "printf('%.100000c', 'a') FROM n").rows
    tracemalloc.start()
    next(rows)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10_000_000


def test_values_that_a_statement_computes_are_short_enough_to_be_searched_at_once(
    connection: sqlite3.Connection,
) -> None:
    def length_of(letters: int) -> object:
        try:
            return next(answer_of(connection, f"SELECT length(printf('%.{letters}c', 'a'))").rows)[0]
        except UsageError as error:
            return str(error)

    assert length_of(LONGEST_COMPUTED - 1000) == LONGEST_COMPUTED - 1000
    # A longer value of printf is NULL, or an error in later versions of SQLite.
    longer = length_of(LONGEST_COMPUTED + 1)
    assert longer is None or "string or blob too big" in str(longer)
