from __future__ import annotations

import sqlite3

import pytest

from autocolor.files.store.permissions import authorizer, restoring

REFUSED = (
    "ATTACH 'other.db' AS other",
    "DETACH main",
    "SELECT load_extension('x')",
    "SELECT writefile('x', 'y')",
    "SELECT fts3_tokenizer('x')",
    "SELECT zeroblob(1000000000)",
    "SELECT randomblob(9)",
    "PRAGMA journal_mode = WAL",
    "PRAGMA writable_schema = ON",
    "PRAGMA user_version = 9",
    "PRAGMA trusted_schema = ON",
    "VACUUM INTO 'x'",
    "CREATE TABLE other (x)",
    "CREATE TEMP TABLE other (x)",
    "CREATE VIRTUAL TABLE other USING fts5(x)",
    "DROP TABLE nodes",
    "ALTER TABLE nodes ADD COLUMN w",
    "ANALYZE",
    "DELETE FROM sqlite_master",
)
CHANGES = ("DELETE FROM nodes", "UPDATE nodes SET x = 1", "INSERT INTO nodes VALUES (2)")


def connection(may_change: bool) -> sqlite3.Connection:
    made = sqlite3.connect(":memory:", isolation_level=None)
    made.execute("CREATE TABLE nodes (x)")
    made.execute("INSERT INTO nodes VALUES (1)")
    made.set_authorizer(authorizer(may_change))
    return made


@pytest.mark.parametrize("statement", [*REFUSED, *CHANGES])
def test_a_statement_that_reads_may_do_nothing_else(statement: str) -> None:
    with pytest.raises(sqlite3.DatabaseError):
        connection(may_change=False).execute(statement)


@pytest.mark.parametrize("statement", REFUSED)
def test_a_statement_that_changes_rows_may_change_nothing_else(statement: str) -> None:
    with pytest.raises(sqlite3.DatabaseError):
        connection(may_change=True).execute(statement)


@pytest.mark.parametrize("statement", CHANGES)
def test_rows_are_changed_where_that_is_asked_for(statement: str) -> None:
    assert connection(may_change=True).execute(statement).rowcount == 1


@pytest.mark.parametrize("statement", [each for each in (*REFUSED, *CHANGES) if "DROP" not in each])
def test_the_text_of_a_trigger_or_an_index_may_make_that_alone(statement: str) -> None:
    made = connection(may_change=True)
    made.set_authorizer(restoring)
    with pytest.raises(sqlite3.DatabaseError):
        made.execute(statement)
    made.execute("CREATE TRIGGER kept AFTER DELETE ON nodes BEGIN DELETE FROM nodes; END")
    made.execute("CREATE INDEX kept_too ON nodes (abs(x))")
    with pytest.raises(sqlite3.DatabaseError):
        made.execute("CREATE INDEX other ON nodes (hex(zeroblob(x)))")


def test_a_statement_may_compute() -> None:
    query = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 4) SELECT sum(i) FROM n"
    assert connection(may_change=False).execute(query).fetchall() == [(10,)]
    assert connection(may_change=False).execute("PRAGMA table_info(nodes)").fetchall()
