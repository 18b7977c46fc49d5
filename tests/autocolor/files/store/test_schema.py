from __future__ import annotations

import sqlite3

from autocolor.files.store.schema import DEFINITIONS, MESH_TABLES, ROW_TABLES
from autocolor.scene.columns.column import fields_of
from autocolor.scene.columns.row_kinds import Nested, Rows
from autocolor.scene.scene import Scene


def test_every_table_of_a_scene_has_a_table_and_all_are_strict() -> None:
    kinds = {name: field.column.kind for name, field in fields_of(Scene).items()}
    tables = {name for name, kind in kinds.items() if isinstance(kind, (Rows, Nested))}
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
