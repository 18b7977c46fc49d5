from __future__ import annotations

import sqlite3

from autocolor.files.store.foreign_keys import MOST_PROBLEMS, broken_references
from autocolor.files.store.schema import DEFINITIONS
from autocolor.files.store.store_file import store_of
from tests.autocolor.files.store.stores import small_scene


def broken(*statements: str) -> list[str]:
    connection = store_of(small_scene())
    for statement in statements:
        connection.execute(statement)
    found = broken_references(connection, DEFINITIONS, DEFINITIONS)
    connection.close()
    return found


def test_a_whole_store_has_no_broken_references() -> None:
    assert broken() == []


def test_each_row_is_told_with_its_table_its_number_and_the_nearest_name() -> None:
    assert broken(
        "UPDATE parts SET surface = 'glas' WHERE number = 2", "UPDATE node_scalars SET scalar = 'x'"
    ) == [
        "parts, row 2: surface 'glas' is not in the surface table; did you mean 'glass'?",
        "node_scalars: a scalar is not in the mesh_scalars table; remove such rows",
    ]


def test_so_many_are_told_and_no_more() -> None:
    numbers = "WITH n(i) AS (SELECT 10 UNION ALL SELECT i + 1 FROM n WHERE i < 500)"
    insert = f"INSERT INTO parts (name, surface) {numbers} SELECT 'part ' || i, 'none' FROM n"
    assert len(broken(insert)) == MOST_PROBLEMS


def test_tables_of_others_and_keys_that_fit_no_table_are_left_alone() -> None:
    assert broken("CREATE TABLE notes (node REFERENCES nodes)", "INSERT INTO notes VALUES (77)") == []
    connection = sqlite3.connect(":memory:")
    connection.execute("CREATE TABLE nodes (node, x)")
    connection.execute("CREATE TABLE node_scalars (scalar, node REFERENCES nodes (node))")
    connection.execute("INSERT INTO node_scalars VALUES (1, 2)")
    assert broken_references(connection, {"nodes": 1, "node_scalars": 1}, DEFINITIONS) == []
