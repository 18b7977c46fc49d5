from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from autocolor import InputError
from autocolor.files.store import schema as module
from autocolor.files.store.schema import DEFINITIONS, MESH_TABLES, ROW_TABLES
from autocolor.files.store.store_file import read_store
from autocolor.scene.columns import fields_of
from autocolor.scene.row_kinds import Nested, RowList
from autocolor.scene.scene import Scene
from tests.autocolor.files.store.stores import run, small_store


def test_every_table_of_a_scene_has_a_table_and_all_are_strict() -> None:
    kinds = {name: field.column.kind for name, field in fields_of(Scene).items()}
    tables = {name for name, kind in kinds.items() if isinstance(kind, (RowList, Nested))}
    assert ROW_TABLES.keys() == {"scene", *tables}
    assert DEFINITIONS.keys() == {*ROW_TABLES, *MESH_TABLES}
    connection = sqlite3.connect(":memory:")
    for definition in DEFINITIONS.values():
        connection.execute(definition)
    strict = {row[1] for row in connection.execute("PRAGMA table_list") if row[5]}
    assert strict == DEFINITIONS.keys()


def test_every_reference_is_to_a_column_that_is_unique() -> None:
    connection = sqlite3.connect(":memory:")
    connection.execute("PRAGMA foreign_keys = ON")
    for definition in DEFINITIONS.values():
        connection.execute(definition)
    for table in DEFINITIONS:
        # SQLite raises an error here for a key that fits no table.
        assert connection.execute(f'PRAGMA foreign_key_check("{table}")').fetchall() == []


def test_a_store_of_a_later_version_is_refused(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "PRAGMA user_version = 2")
    with pytest.raises(
        InputError, match="the version of a store must be at most 1, not 2; read it with a newer"
    ):
        read_store(path)


def test_a_column_that_is_missing_is_named_with_the_nearest_one(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "ALTER TABLE polygons RENAME COLUMN node3 TO node_3")
    with pytest.raises(
        InputError, match=r"polygons must have the columns .* node3 is missing; add it; did you"
    ):
        read_store(path)


def test_a_table_of_too_many_rows_is_refused_before_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "MOST_ROWS", 1)
    with pytest.raises(InputError, match="parts must have at most 1 rows, not more; leave rows out"):
        read_store(small_store(tmp_path))


def test_bytes_are_refused_in_a_table_without_types(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "DROP TABLE view", "CREATE TABLE view (eye_x)", "INSERT INTO view VALUES (x'00')")
    with pytest.raises(
        InputError, match="view, row 1: eye_x must be a number or text, not bytes; correct it"
    ):
        read_store(path)
