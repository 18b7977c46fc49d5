from __future__ import annotations

import sqlite3
import tracemalloc
from collections.abc import Iterator

import pytest

from autocolor import UsageError, WriteError
from autocolor.files.store.connections import LONGEST_COMPUTED
from autocolor.files.store.statements import answer_of, authorizer, change, changes_of, restoring
from autocolor.files.store.store_file import store_of
from tests.autocolor.files.store.stores import small_scene

ENDLESS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT "


@pytest.fixture
def connection() -> Iterator[sqlite3.Connection]:
    made = store_of(small_scene())
    yield made
    made.close()


@pytest.mark.parametrize(
    ("statement", "problem"),
    [
        ("SELECT * FROM light", "there is no table 'light'; did you mean 'lights'?"),
        ("SELECT intensty FROM lights", "there is no column 'intensty'; did you mean 'intensity'?"),
        ("SELECT lights.nam FROM lights", "there is no column 'lights.nam'; did you mean 'name'?"),
        ("SELECT load_extension('x')", "a statement may not call the function 'load_extension'; "),
        ("SELECT roud(1.5)", "a statement may not call the function 'roud'; did you mean 'round'?"),
        (
            "SELECT on FROM lights",
            "cannot be understood near 'on'; as a column, write \"on\" with its quotes",
        ),
        ("SELEC * FROM lights", "a statement cannot be understood near 'SELEC'; correct it"),
        ("SELECT * FROM", "a statement must be complete, and this one ends too early; complete it"),
        ("SELECT 1; SELECT 2", "there must be one statement at a time, not several"),
        ("  ; ", "a statement must not be empty; write one, as in SELECT"),
        ("DELETE FROM lights", "must only read the tables, and this one changes lights; allow changes with"),
        ("CREATE TABLE x (y)", "must be a SELECT or, with --write, an INSERT, UPDATE or DELETE of rows, not"),
        ("ATTACH 'x' AS y", "must be a SELECT or, with --write, an INSERT, UPDATE or DELETE of rows, not"),
        ("PRAGMA journal_mode = OFF", "must be a SELECT or, with --write"),
        (
            "SELECT hex(hex(hex(hex(replace(printf('%100000d', 1), ' ', 'abcdef')))))",
            "a value must have at most",
        ),
    ],
)
def test_a_wrong_statement_is_told_in_a_sentence_with_what_to_do(
    connection: sqlite3.Connection, statement: str, problem: str
) -> None:
    with pytest.raises(UsageError) as refused:
        list(answer_of(connection, statement).rows)
    assert problem in str(refused.value)


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
    rows = answer_of(connection, ENDLESS + "printf('%.1000000c', 'a') FROM n").rows
    tracemalloc.start()
    next(rows)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10_000_000


def test_a_full_disk_is_no_fault_of_the_statement(connection: sqlite3.Connection) -> None:
    connection.execute("PRAGMA max_page_count = 1")
    grow = "UPDATE lights SET name = name || printf('%.100000c', 'a')"
    with pytest.raises(WriteError, match=r"the disk must hold the store, and is full or fails .*; make room"):
        change(connection, grow)


def test_values_that_a_statement_computes_are_short_enough_to_be_searched_at_once(
    connection: sqlite3.Connection,
) -> None:
    def length_of(letters: int) -> object:
        return next(answer_of(connection, f"SELECT length(printf('%.{letters}c', 'a'))").rows)[0]

    assert length_of(LONGEST_COMPUTED - 1000) == LONGEST_COMPUTED - 1000
    # A longer one is NULL, as printf has it.
    assert length_of(LONGEST_COMPUTED + 1) is None


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


def connection_2(may_change: bool) -> sqlite3.Connection:
    made = sqlite3.connect(":memory:", isolation_level=None)
    made.execute("CREATE TABLE nodes (x)")
    made.execute("INSERT INTO nodes VALUES (1)")
    made.set_authorizer(authorizer(may_change))
    return made


@pytest.mark.parametrize("statement", [*REFUSED, *CHANGES])
def test_a_statement_that_reads_may_do_nothing_else(statement: str) -> None:
    with pytest.raises(sqlite3.DatabaseError):
        connection_2(may_change=False).execute(statement)


@pytest.mark.parametrize("statement", REFUSED)
def test_a_statement_that_changes_rows_may_change_nothing_else(statement: str) -> None:
    with pytest.raises(sqlite3.DatabaseError):
        connection_2(may_change=True).execute(statement)


@pytest.mark.parametrize("statement", CHANGES)
def test_rows_are_changed_where_that_is_asked_for(statement: str) -> None:
    assert connection_2(may_change=True).execute(statement).rowcount == 1


@pytest.mark.parametrize("statement", [each for each in (*REFUSED, *CHANGES) if "DROP" not in each])
def test_the_text_of_a_trigger_or_an_index_may_make_that_alone(statement: str) -> None:
    made = connection_2(may_change=True)
    made.set_authorizer(restoring)
    with pytest.raises(sqlite3.DatabaseError):
        made.execute(statement)
    made.execute("CREATE TRIGGER kept AFTER DELETE ON nodes BEGIN DELETE FROM nodes; END")
    made.execute("CREATE INDEX kept_too ON nodes (abs(x))")
    with pytest.raises(sqlite3.DatabaseError):
        made.execute("CREATE INDEX other ON nodes (hex(zeroblob(x)))")


def test_a_statement_may_compute() -> None:
    query = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 4) SELECT sum(i) FROM n"
    assert connection_2(may_change=False).execute(query).fetchall() == [(10,)]
    assert connection_2(may_change=False).execute("PRAGMA table_info(nodes)").fetchall()
