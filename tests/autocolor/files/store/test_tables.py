from __future__ import annotations

import sqlite3
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

from autocolor import InputError, MissingInputError, Phong, UsageError, WriteError, open_tables
from autocolor.files.opening import read_scene
from autocolor.files.store.tables import Tables, tables_of
from tests.autocolor.files.store.stores import contents, is_equal, run, small_scene, small_store
from tests.tables import refused


@pytest.fixture
def tables(tmp_path: Path) -> Iterator[Tables]:
    """The tables of the small store."""
    with open_tables(small_store(tmp_path)) as opened:
        yield opened


def test_rows_are_selected_joined_and_given_by_name(tables: Tables) -> None:
    query = (
        "SELECT parts.name, count(*) AS polygons FROM polygons JOIN parts ON part = parts.name"
        " WHERE surface = :surface GROUP BY part"
    )
    assert tables.select(query, {"surface": "glass"}) == [{"name": "roof", "polygons": 1}]
    assert tables.columns("nodes") == ["node", "x", "y", "z"]
    assert {"scene", "nodes", "polygons", "parts", "view"} <= set(tables.names)
    assert is_equal(tables.scene(), small_scene())
    assert tables.answer('SELECT 1 AS a, 2 AS "a 2", 3 AS a')[0] == ("a", "a 2", "a 3")


def test_a_mesh_file_is_opened_by_its_up_axis_and_scale(tmp_path: Path) -> None:
    (tmp_path / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 3 0\nf 1 2 3\n")
    with open_tables(tmp_path / "one.obj", up="y", scale=0.5) as tables:
        assert tables.select("SELECT max(z) AS top FROM nodes") == [{"top": 1.5}]


def test_a_row_is_changed_by_its_key_and_saved_at_once(tmp_path: Path, tables: Tables) -> None:
    tables.update("lights", "key", intensity=2.5, on=False)
    tables.update("nodes", 5, z=3.0)
    assert tables.scene().lights["key"].intensity == 2.5
    scene = read_scene(tmp_path / "small.sqlite")
    assert (scene.lights["key"].intensity, scene.lights["key"].on) == (2.5, False)
    assert scene.mesh.coordinates[4, 2] == 3.0


SMALL = "small.sqlite: "
NOT_ONE = (
    "a statement must be one SELECT or, with --write, one INSERT, UPDATE or DELETE that SQLite can run, and"
    " this one is not"
)

WRONG_CHANGES: dict[str, Callable[[Tables], object]] = {
    "there is no table 'light'; did you mean 'lights'?": lambda tables: tables.update("light", "key", on=1),
    "there is no row of lights with name 'kye'; did you mean 'key'?": (
        lambda tables: tables.update("lights", "kye", on=1)
    ),
    f"{SMALL}lights, row 1: intensity must be a finite number of at least 0, not -1.0": (
        lambda tables: tables.update("lights", "key", intensity=-1)
    ),
    f"{NOT_ONE} (not authorized); correct it": (lambda tables: tables.change("DROP TABLE lights")),
}


@pytest.mark.parametrize("problem", WRONG_CHANGES)
def test_a_change_that_is_wrong_is_refused_as_a_whole(tmp_path: Path, tables: Tables, problem: str) -> None:
    before = contents(tmp_path)
    with pytest.raises((InputError, UsageError)) as caught:
        WRONG_CHANGES[problem](tables)
    assert str(caught.value) == problem
    assert is_equal(tables.scene(), small_scene())
    assert contents(tmp_path) == before


def test_what_is_renamed_is_renamed_where_it_is_referred_to(tables: Tables) -> None:
    tables.update("surfaces", "body", name="paint")
    tables.update("parts", "hood", name="bonnet")
    tables.update("mesh_scalars", "stress", name="strain")
    scene = tables.scene()
    assert scene.parts["bonnet"].surface == "paint"
    assert scene.mesh.part_names == ("bonnet", "roof")
    assert scene.mesh.scalars[0].values.tolist()[:2] == [1, 2]


def test_values_of_scalars_go_with_their_nodes_and_polygons(tables: Tables) -> None:
    roof = "WITH roof AS (SELECT 'roof') DELETE FROM polygons WHERE part = (SELECT * FROM roof)"
    assert [tables.change(roof) for _ in range(2)] == [1, 0]
    assert tables.change("DELETE FROM nodes WHERE node = 5 RETURNING node") == 1
    assert [(each.name, len(each.values)) for each in tables.scene().mesh.scalars] == [
        ("stress", 4),
        ("area", 1),
    ]


@pytest.mark.parametrize(
    ("statement", "sentence"),
    [
        (
            # It would change nothing itself, but keep the row from being removed.
            "CREATE TRIGGER evil BEFORE DELETE ON lights BEGIN SELECT RAISE(IGNORE); END",
            "a store that is changed must have no triggers, not 'evil'; drop it, or"
            " write the scene to another file",
        ),
        (
            "CREATE TABLE notes (light REFERENCES lights (name)); INSERT INTO notes VALUES ('rim')",
            "tables of other programs must not refer to rows that a change removes or renames (FOREIGN KEY"
            " constraint failed); change their rows first",
        ),
    ],
)
def test_what_others_added_can_keep_a_store_from_being_changed(
    tmp_path: Path, tables: Tables, statement: str, sentence: str
) -> None:
    with closing(sqlite3.connect(tmp_path / "small.sqlite")) as connection:
        connection.executescript(statement)
    before = contents(tmp_path)
    with pytest.raises(WriteError) as caught:
        tables.change("DELETE FROM lights WHERE name = 'rim'")
    assert str(caught.value) == f"{SMALL}{sentence}"
    assert is_equal(tables.scene(), small_scene())
    assert contents(tmp_path) == before


def test_a_change_is_made_to_the_store_as_it_is_now(tmp_path: Path, tables: Tables) -> None:
    path = tmp_path / "small.sqlite"
    run(path, "UPDATE lights SET intensity = 5")
    assert tables.select("SELECT max(intensity) AS most FROM lights") == [{"most": 1.0}]
    tables.change("UPDATE lights SET intensity = intensity + 1 WHERE name = 'rim'")
    assert [row["intensity"] for row in tables.select("SELECT intensity FROM lights")] == [5.0, 6.0]
    path.unlink()
    with pytest.raises(MissingInputError):
        open_tables(path)


def test_own_normals_of_a_mesh_stay_until_its_polygons_are_changed(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Tables have no normals."""
    path = tmp_path / "one.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 3 0\nvn 0 0 1\nvn 0 0.6 0.8\nf 1//1 2//2 3//1\n")
    own = read_scene(path).mesh.own_normals
    assert own is not None
    with open_tables(path) as tables:
        tables.change("UPDATE surfaces SET exponent = 7")
        tables.change("UPDATE mesh SET crease_angle = 20")
        scene = tables.scene()
        kept = scene.mesh.own_normals
        assert kept is not None
        assert (kept.vectors[kept.numbers] == own.vectors[own.numbers]).all()
        assert scene.mesh.crease_angle == 20
        assert scene.surfaces[0].reflectance.model == Phong(7)
        assert "normals" not in caplog.text
        tables.change("UPDATE nodes SET z = 1 WHERE x = 1")
        assert tables.scene().mesh.own_normals is None
        assert "one: the normals of the changed mesh will be computed" in caplog.text


ENDLESS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT "


def select(statement: str) -> None:
    with tables_of(small_scene()) as tables:
        tables.seconds = 0.5
        tables.select(statement)


TOO_BIG = f"{NOT_ONE} (string or blob too big); correct it"
LATE = (
    "a statement must end within 0.5 seconds, not run on; narrow it with WHERE or LIMIT, or allow more with"
    " --seconds"
)

test_a_wrong_statement_is_told_in_a_sentence_with_what_to_do = refused(
    select,
    [
        ("SELECT * FROM light", f"{NOT_ONE} (no such table: light); correct it"),
        ("SELECT 1; SELECT 2", f"{NOT_ONE} (You can only execute one statement at a time.); correct it"),
        (
            "DELETE FROM lights",
            "a statement must only read the tables, and this one changes lights; allow changes with --write"
            " (tables.change in Python), or write a SELECT",
        ),
        ("SELECT length(zeroblob(1000000000))", TOO_BIG),
        (f"{ENDLESS} i FROM n WHERE i < 0", LATE),
    ],
    UsageError,
)


def test_rows_come_a_few_at_a_time_as_they_are_asked_for(tables: Tables) -> None:
    columns, rows = tables.answer(f"{ENDLESS} i, printf('%.100000c', 'a') AS text FROM n")
    assert columns == ("i", "text")
    tracemalloc.start()
    assert [next(rows)[0] for _ in range(60)] == list(range(1, 61))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 20_000_000
