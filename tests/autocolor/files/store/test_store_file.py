from __future__ import annotations

import os
import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from autocolor import InputError, OutputError, Scene, WriteError
from autocolor.files.store.store_file import read_store, store_bytes, write_store
from autocolor.scene.creation import scene_of
from tests.autocolor.files.store.stores import is_equal, loosen, run, small_scene, small_store
from tests.autocolor.linked_scenes import linked_scenes

ONE_FILE = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


@ONE_FILE
@given(scene=linked_scenes())
def test_a_store_gives_the_scene_back_that_was_written(tmp_path: Path, scene: Scene) -> None:
    path = tmp_path / "any.sqlite"
    path.write_bytes(store_bytes(scene))
    report = read_store(path)
    assert is_equal(report.scene, scene)
    assert report.repairs == report.created == ()


def test_a_store_of_nodes_and_polygons_alone_is_completed_as_any_mesh_is(tmp_path: Path) -> None:
    path = tmp_path / "bare.db"
    run(
        path,
        "CREATE TABLE nodes (node INTEGER, x, y, z)",
        "CREATE TABLE polygons (polygon INTEGER, part TEXT, node1, node2, node3, node4)",
        "INSERT INTO nodes VALUES (70, 0, 1, 1), (10, 0, 0, 0), (20, 1, 0, 0), (40, 1.5, 1, 0)",
        "INSERT INTO polygons VALUES (5, 'roof', 10, 20, 70, NULL), (3, 'hood', 10, 20, 40, 70)",
    )
    report = read_store(path)
    mesh = report.scene.mesh
    assert mesh.part_names == ("hood", "roof")
    assert mesh.node_numbers.tolist() == [[0, 1, 2, 3], [0, 1, 3, 3]]
    assert mesh.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [1.5, 1, 0], [0, 1, 1]]
    bare = scene_of(mesh, name="bare")
    assert report.scene.equals(bare)
    assert len(report.created) == 3


REFUSALS = """\
UPDATE polygons SET node3 = 40 WHERE polygon = 2
DELETE FROM nodes WHERE node = 4
  polygons, row 1: node 4 is not in the node table; correct it

UPDATE polygons SET part = 'hod' WHERE polygon = 1
  polygons, row 1: part must be in the part table, not 'hod'; did you mean 'hood'?

LOOSE nodes
UPDATE nodes SET x = NULL, y = 'a' WHERE node = 2
  nodes, row 2: x must be a number of at most 1e+30 in size, not missing; correct it

UPDATE nodes SET z = 9e999 WHERE node = 2
  nodes, row 2: z must be a number of at most 1e+30 in size, not inf; correct it

LOOSE nodes
UPDATE nodes SET node = 3 WHERE node = 2
  nodes: rows must have different numbers, and 3 is repeated; number them anew

LOOSE polygons
UPDATE polygons SET node2 = 1.5 WHERE polygon = 1
  polygons, row 1: node2 must be a whole number, not 1.5; correct it

UPDATE lights SET intensity = -1, "on" = 2, aim_x = NULL WHERE name = 'key'
UPDATE surfaces SET model = 'gloss' WHERE name = 'glass'
  surfaces, row 2: model must be 'phong', 'blinn' or 'cook-torrance', not 'gloss'
  lights, row 1: intensity must be a finite number of at least 0, not -1.0
  lights, row 1: on must be true or false, not 2
  lights, row 1: aim must be three finite numbers of at most 1e36, not [None, 0.0, 0.0]

CREATE TABLE two AS SELECT * FROM view
DROP TABLE view
ALTER TABLE two RENAME TO view
INSERT INTO view SELECT * FROM view
  the rows of view must be at most 1, not more; leave rows out

INSERT INTO node_scalars VALUES ('stress', 9, 1.0)
  node_scalars, scalar 'stress': node 9 is not in the node table; remove it

INSERT INTO node_scalars VALUES ('heat', 1, 1.0)
  node_scalars: scalar 'heat' is not in the mesh_scalars table; remove its values

ALTER TABLE polygons RENAME COLUMN node3 TO node_3
  polygons must have the columns polygon, node1, node2, node3 and node4; add node3; did you mean 'node_3'?

DROP TABLE mesh
CREATE TABLE mesh (number, crease_angle AS (hex(zeroblob(1000000))))
  mesh must be a table of plain columns, and no view, virtual table or computed column; make it one, or \
rename it

UPDATE scene SET name = hex(zeroblob(2000000))
  a value must have at most 131,072 bytes, not more; shorten it
"""
"""Changes of the small store, and below each the problems that are then found in it, all in one report."""


@pytest.mark.parametrize("case", REFUSALS.strip().split("\n\n"))
def test_a_refusal_names_the_table_the_row_and_what_to_do(tmp_path: Path, case: str) -> None:
    path = small_store(tmp_path)
    lines = case.split("\n")
    for line in lines:
        if line.startswith("LOOSE "):
            loosen(path, line.removeprefix("LOOSE "))
        elif not line.startswith(" "):
            run(path, line)
    with pytest.raises(InputError) as refused:
        read_store(path)
    sentences = [line.strip() for line in lines if line.startswith(" ")]
    assert list(refused.value.problems) == [f"small.sqlite: {sentence}" for sentence in sentences]


ADDITIONS = (
    "CREATE TABLE notes (text, part REFERENCES parts)",
    "INSERT INTO notes VALUES ('mine', 'x')",
    "CREATE VIEW far AS SELECT * FROM nodes WHERE x > 0.9",
    "CREATE UNIQUE INDEX by_part ON polygons (part, abs(node1)) WHERE node1 > 0",
    "CREATE INDEX by_text ON notes (text)",
    "CREATE TRIGGER evil AFTER DELETE ON lights BEGIN DELETE FROM notes; DELETE FROM parts; END",
    "CREATE TRIGGER noted AFTER INSERT ON parts BEGIN DELETE FROM notes; END",
    "CREATE TRIGGER seen INSTEAD OF DELETE ON far BEGIN DELETE FROM notes; END",
)


def test_additions_of_others_stay_and_none_is_run_when_a_store_is_saved_over(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, *ADDITIONS)
    schema = "SELECT type, name, tbl_name, sql FROM sqlite_master ORDER BY name"
    before = run(path, schema)
    assert is_equal(read_store(path).scene, small_scene())
    scene = small_scene().without_light("rim").replace(ambient=0.25)
    write_store(path, scene, overwrite=True)
    assert is_equal(read_store(path).scene, scene)
    assert run(path, "SELECT * FROM notes") == [("mine", "x")]
    assert run(path, schema) == before
    assert run(path, "PRAGMA integrity_check") == [("ok",)]


def test_an_addition_that_does_not_fit_keeps_the_store_as_it_is(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "DELETE FROM nodes WHERE node > 1", "CREATE UNIQUE INDEX one ON nodes (z > 9)")
    before = path.read_bytes()
    with pytest.raises(WriteError) as refused:
        write_store(path, small_scene(), overwrite=True)
    assert str(refused.value) == (
        "small.sqlite: what other programs added must fit the tables of the scene, and does not"
        " (UNIQUE constraint failed: index 'one'); drop it, or write to another file"
    )
    assert path.read_bytes() == before


def test_rows_are_read_from_tables_and_not_from_indexes_that_are_out_of_date(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    ours = "FROM sqlite_master WHERE type = 'index' AND tbl_name = 'polygons'"
    run(path, f"CREATE TABLE saved AS SELECT * {ours}", "PRAGMA writable_schema = ON", f"DELETE {ours}")
    run(path, "DELETE FROM polygons WHERE polygon = 2", "DELETE FROM polygon_scalars WHERE polygon = 2")
    run(path, "PRAGMA writable_schema = ON", "INSERT INTO sqlite_master SELECT * FROM saved")
    assert run(path, "SELECT count(*) FROM polygons INDEXED BY polygons_part") == [(2,)]
    assert read_store(path).scene.mesh.node_numbers.tolist() == [[0, 1, 2, 3]]


def test_what_is_no_store_and_what_may_not_be_overwritten_stays(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    with pytest.raises(OutputError):
        write_store(path, small_scene())
    assert path.read_bytes() == store_bytes(small_scene())
    path.write_bytes(b"text")
    with pytest.raises(InputError, match="a store must be an SQLite file, and this one does not begin as"):
        write_store(path, small_scene(), overwrite=True)
    assert path.read_bytes() == b"text"


def test_a_file_without_nodes_or_of_later_tables_is_refused(tmp_path: Path) -> None:
    empty = tmp_path / "empty.sqlite"
    run(empty, "CREATE TABLE node (x)")
    with pytest.raises(InputError, match="must have the tables nodes and polygons; add nodes and polygons"):
        read_store(empty)
    run(empty, "PRAGMA user_version = 2")
    with pytest.raises(InputError, match="version of a store must be at most 1, not 2; use a newer"):
        read_store(empty)


def test_a_store_that_is_damaged_anywhere_gives_a_scene_or_a_refusal(tmp_path: Path) -> None:
    data = store_bytes(small_scene())
    chance = random.Random(12)
    path = tmp_path / "damaged.sqlite"
    read = refused = 0
    for number in range(200):
        changed = bytearray(data[: chance.randrange(1000, len(data)) if number % 4 == 0 else None])
        for _ in range(chance.choice((1, 1, 3, 30))):
            # Every fifth time in the header and the schema.
            changed[chance.randrange(16, 200 if number % 5 == 0 else len(changed))] = chance.randrange(256)
        path.write_bytes(changed)
        try:
            read += bool(np.isfinite(read_store(path).scene.mesh.coordinates).all())
        except InputError as error:
            refused += all(problem.startswith("damaged.sqlite") for problem in error.problems)
    assert read + refused == 200
    assert read > 20 < refused


def test_a_name_that_utf_8_cannot_hold_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a text in a store must be UTF-8 of at most 131,072 bytes, and one"):
        write_store(tmp_path / "odd.sqlite", small_scene().replace(name="\ud800"))
    assert os.listdir(tmp_path) == []
