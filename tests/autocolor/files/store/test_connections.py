from __future__ import annotations

import os
import shutil
import sqlite3
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import pytest

from autocolor import InputError, MissingInputError, UnavailableError, WriteError, open_tables
from autocolor.budget import allowing
from autocolor.files.store import connections
from autocolor.files.store.connections import (
    UNSAFE_FUNCTIONS,
    Clock,
    authorizer,
    connected,
    connected_to_change,
    in_memory,
    refusals,
)
from tests.autocolor.files.store.stores import contents, hostile_journal, run, small_store

Open = Callable[[Path], Any]


def test_a_connection_to_read_cannot_write(tmp_path: Path) -> None:
    connection = connected(small_store(tmp_path))
    with pytest.raises(sqlite3.OperationalError, match="readonly"):
        connection.execute("DELETE FROM lights")
    connection.close()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="names of files are text elsewhere")
def test_a_store_of_any_name_is_opened(tmp_path: Path) -> None:
    path = small_store(tmp_path).rename(tmp_path / "a?b#c%20\u202e\x1b\n\udcff.sqlite")
    with closing(connected(path)) as connection:
        assert connection.execute("SELECT count(*) FROM lights").fetchone()[0] > 0


def test_sizes_are_limited_and_the_schema_is_not_trusted() -> None:
    connection = in_memory()
    limits = {
        "LENGTH": 1 << 20, "SQL_LENGTH": 1 << 20, "COLUMN": 2000, "EXPR_DEPTH": 200, "COMPOUND_SELECT": 50,
        "VDBE_OP": 250_000, "FUNCTION_ARG": 100, "ATTACHED": 0, "LIKE_PATTERN_LENGTH": 1000,
        "VARIABLE_NUMBER": 1000, "TRIGGER_DEPTH": 1, "WORKER_THREADS": 0,
    }  # fmt: skip
    for name, most in limits.items():
        assert connection.getlimit(getattr(sqlite3, f"SQLITE_LIMIT_{name}")) == most, name
    pragmas = {"trusted_schema": 0, "cell_size_check": 1, "foreign_keys": 0}
    for pragma, value in pragmas.items():
        assert connection.execute(f"PRAGMA {pragma}").fetchone() == (value,), pragma
    for size in ((1 << 20) - 1, 1 << 20):
        assert connection.execute("SELECT length(?)", (bytes(size),)).fetchone() == (size,)
    with pytest.raises(sqlite3.DataError, match="too big"):
        connection.execute("SELECT length(?)", (bytes((1 << 20) + 1),)).fetchall()
    connection.close()


def test_a_statement_that_takes_too_long_is_ended() -> None:
    connection = in_memory()
    clock = Clock(connection, seconds=0.05)
    endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT max(i) FROM n"
    with (
        pytest.raises(InputError, match=r"x: a store must be read within 0\.05 seconds, not longer"),
        refusals("x", clock),
    ):
        connection.execute(endless).fetchall()
    connection.close()


def test_a_pipe_a_folder_and_a_missing_file_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.db")
    for name in ("pipe.db", "."):
        with pytest.raises(InputError, match="must be a regular file"):
            connected(tmp_path / name)
    with pytest.raises(MissingInputError):
        connected(tmp_path / "none.db")
    with pytest.raises(InputError):
        connected(Path("nul\0.db"))


def test_a_file_that_is_too_large_is_not_opened(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    with pytest.raises(InputError, match=r"small.sqlite: to read [0-9,]+ bytes must take "), allowing(1e-9):
        connected(path)


def test_a_store_in_a_folder_that_cannot_be_written_is_read(tmp_path: Path) -> None:
    path = small_store(tmp_path, "odd name?#%.sqlite")
    path.chmod(0o444)
    tmp_path.chmod(0o555)
    try:
        connection = connected(path)
        assert connection.execute("SELECT count(*) FROM nodes").fetchone() == (5,)
        connection.close()
    finally:
        tmp_path.chmod(0o755)


def test_an_old_sqlite_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    for version in ((3, 37, 0), (3, 37, 1), (4, 0, 0)):
        monkeypatch.setattr(sqlite3, "sqlite_version_info", version)
        in_memory().close()
    for version in ((3, 36, 0), (3, 36, 9)):
        monkeypatch.setattr(sqlite3, "sqlite_version_info", version)
        with pytest.raises(UnavailableError, match=r"a store must have SQLite 3\.37 or later"):
            in_memory()


@pytest.mark.parametrize("opened", [connected, connected_to_change])
@pytest.mark.parametrize("ending", ["-journal", "-wal", "-shm"])
@pytest.mark.parametrize("kind", ["a pipe", "a folder", "a link"])
def test_a_file_beside_a_store_must_be_regular(tmp_path: Path, opened: Open, ending: str, kind: str) -> None:
    path = small_store(tmp_path)
    beside = Path(f"{path}{ending}")
    if kind == "a pipe":
        os.mkfifo(beside)
    elif kind == "a folder":
        beside.mkdir()
    else:
        beside.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match=f"{ending}: it must be a regular file, not {kind}"):
        opened(path)


def test_sqlite_itself_deletes_the_file_that_a_hostile_journal_names(tmp_path: Path) -> None:
    path, named = small_store(tmp_path), tmp_path / "named.txt"
    named.write_text("precious")
    hostile_journal(path, named)
    run(path, "SELECT * FROM lights")
    if named.exists():
        pytest.skip(f"SQLite {sqlite3.sqlite_version} trusts no journal with the name of another file")
    named.write_text("precious")
    hostile_journal(path, named, has_header=False)
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN")
        other.execute("DELETE FROM lights")
        assert named.exists()
        other.execute("ROLLBACK")
    assert not named.exists()


@pytest.mark.parametrize("opened", [connected, connected_to_change])
@pytest.mark.parametrize("mode", ["DELETE", "WAL"])
@pytest.mark.parametrize("place", ["beside the store", "beside the file of a link", "beside a link"])
def test_a_hostile_journal_is_never_rolled_back(tmp_path: Path, opened: Open, mode: str, place: str) -> None:
    path, named = small_store(tmp_path), tmp_path / "named.txt"
    run(path, f"PRAGMA journal_mode = {mode}")
    named.write_text("precious")
    journal = hostile_journal(path, named)
    if place != "beside the store":
        link = tmp_path / "link.sqlite"
        link.symlink_to(path.name)
        if place == "beside a link":
            journal = journal.rename(f"{link}-journal")
        path = link
    before = contents(tmp_path)
    with pytest.raises(
        (InputError, WriteError), match=r"the -journal beside the store is from a change that"
    ):
        opened(path)
    assert contents(tmp_path) == before


def test_a_journal_without_a_header_is_refused_only_for_a_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "SECONDS_OF_WAITING", 0.05)
    path, named = small_store(tmp_path), tmp_path / "named.txt"
    named.write_text("precious")
    hostile_journal(path, named, has_header=False)
    before = contents(tmp_path)
    connected(path).close()
    with pytest.raises(InputError, match="the -journal beside the store is from a change that has not ended"):
        connected_to_change(path)
    assert contents(tmp_path) == before


@pytest.mark.parametrize(
    "content",
    [b"", bytes(600), bytes(512) + b"old pages", (bytes(12) + b"unsynced header").ljust(512, b"\0")],
)
def test_a_journal_that_a_program_keeps_for_its_next_change_is_no_hindrance(
    tmp_path: Path, content: bytes
) -> None:
    path = small_store(tmp_path)
    Path(f"{path}-journal").write_bytes(content)
    for opened in (connected, connected_to_change):
        opened(path).close()


def test_a_journal_that_appears_before_the_change_begins_is_not_rolled_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "SECONDS_OF_WAITING", 0.05)
    path, named = small_store(tmp_path), tmp_path / "named.txt"
    named.write_text("precious")
    has_journal = connections._has_journal

    def checked(place: Path) -> bool:
        answer = has_journal(place)
        hostile_journal(path, named)
        return answer

    monkeypatch.setattr(connections, "_has_journal", checked)
    with pytest.raises((InputError, WriteError)):
        connected_to_change(path)
    assert named.exists()


def test_a_store_in_wal_mode_is_read_without_a_trace(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "PRAGMA journal_mode = WAL")
    before = contents(tmp_path)
    with closing(connected(path)) as connection:
        assert connection.execute("SELECT count(*) FROM lights").fetchone() == (2,)
        assert contents(tmp_path) == before
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("DELETE FROM lights WHERE name = 'rim'")
        with closing(connected(path)) as connection:
            assert connection.execute("SELECT count(*) FROM lights").fetchone() == (1,)
        copy = tmp_path / "copy.sqlite"
        for ending in ("", "-wal"):
            shutil.copy(f"{path}{ending}", f"{copy}{ending}")
    assert contents(tmp_path).keys() == {"small.sqlite", "copy.sqlite", "copy.sqlite-wal"}
    before = contents(tmp_path)
    for opened in (connected, connected_to_change):
        with pytest.raises(
            InputError, match=r"changes are in copy\.sqlite-wal, which cannot be read without"
        ):
            opened(copy)
    assert contents(tmp_path) == before


def test_a_store_in_wal_mode_is_changed_and_nothing_stays_beside_it(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "PRAGMA journal_mode = WAL")
    with open_tables(path) as tables:
        tables.update("lights", "key", intensity=3)
        assert tables.select("SELECT max(intensity) AS most FROM lights") == [{"most": 3}]
    assert os.listdir(tmp_path) == [path.name]


def test_only_the_two_bytes_of_the_version_tell_the_wal_mode(tmp_path: Path) -> None:
    path = tmp_path / "store.sqlite"
    for place, mode in [(17, "ro"), (18, "ro&immutable=1"), (19, "ro&immutable=1"), (20, "ro")]:
        head = bytearray(b"SQLite format 3\0" + bytes([16, 0, 1, 1, 0, 64, 32, 32]))
        head[place] = 2
        path.write_bytes(head)
        assert connections._reading_mode(path) == mode, place


def test_a_journal_that_appears_beside_open_tables_is_told(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    with open_tables(path) as tables:
        hostile_journal(path, tmp_path / "named.txt").with_name("named.txt").write_text("precious")
        before = contents(tmp_path)
        for action in (lambda: tables.select("SELECT * FROM lights"), tables.scene):
            with pytest.raises(
                InputError, match="the -journal beside the store is from a change that has not"
            ):
                action()
    assert contents(tmp_path) == before


REFUSED = (
    "ATTACH 'other.db' AS other",
    "DETACH main",
    "SELECT load_extension('x')",
    "SELECT writefile('x', 'y')",
    "SELECT readfile('x')",
    "SELECT fts3_tokenizer('simple')",
    "SELECT FTS3_Tokenizer('simple', x'00')",
    "SELECT * FROM nodes WHERE nodes MATCH 'a'",
    "SELECT rtreenode(2, zeroblob(100))",
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


@contextmanager
def guarded(may_change: bool) -> Iterator[sqlite3.Connection]:
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as connection:
        connection.execute("CREATE TABLE nodes (x)")
        connection.execute("INSERT INTO nodes VALUES (1)")
        connection.set_authorizer(authorizer(may_change))
        yield connection


@pytest.mark.parametrize("statement", [*REFUSED, *CHANGES])
def test_a_statement_that_reads_may_do_nothing_else(statement: str) -> None:
    with guarded(may_change=False) as connection, pytest.raises(sqlite3.DatabaseError):
        connection.execute(statement)


@pytest.mark.parametrize("statement", REFUSED)
def test_a_statement_that_changes_rows_may_change_nothing_else(statement: str) -> None:
    with guarded(may_change=True) as connection, pytest.raises(sqlite3.DatabaseError):
        connection.execute(statement)


@pytest.mark.parametrize("statement", CHANGES)
def test_rows_are_changed_where_that_is_asked_for(statement: str) -> None:
    with guarded(may_change=True) as connection:
        assert connection.execute(statement).rowcount == 1


ACTIONS = {
    name: number
    for name in dir(sqlite3)
    if name in (
        "SQLITE_ALTER_TABLE", "SQLITE_ANALYZE", "SQLITE_ATTACH", "SQLITE_CREATE_INDEX", "SQLITE_CREATE_TABLE",
        "SQLITE_CREATE_TEMP_INDEX", "SQLITE_CREATE_TEMP_TABLE", "SQLITE_CREATE_TEMP_TRIGGER",
        "SQLITE_CREATE_TEMP_VIEW", "SQLITE_CREATE_TRIGGER", "SQLITE_CREATE_VIEW", "SQLITE_CREATE_VTABLE",
        "SQLITE_DELETE", "SQLITE_DETACH", "SQLITE_DROP_INDEX", "SQLITE_DROP_TABLE", "SQLITE_DROP_TEMP_INDEX",
        "SQLITE_DROP_TEMP_TABLE", "SQLITE_DROP_TEMP_TRIGGER", "SQLITE_DROP_TEMP_VIEW", "SQLITE_DROP_TRIGGER",
        "SQLITE_DROP_VIEW", "SQLITE_DROP_VTABLE", "SQLITE_INSERT", "SQLITE_READ", "SQLITE_RECURSIVE",
        "SQLITE_REINDEX", "SQLITE_SAVEPOINT", "SQLITE_SELECT", "SQLITE_TRANSACTION", "SQLITE_UPDATE",
    )
    for number in [getattr(sqlite3, name)]
}  # fmt: skip
"""All actions that SQLite asks about, but for pragmas and functions, which go by their names."""

READ = {"SQLITE_READ", "SQLITE_RECURSIVE", "SQLITE_SAVEPOINT", "SQLITE_SELECT", "SQLITE_TRANSACTION"}
CHANGED = {"SQLITE_DELETE", "SQLITE_INSERT", "SQLITE_UPDATE"}


@pytest.mark.parametrize("may_change", [False, True])
def test_every_action_but_reads_and_changes_of_rows_is_denied(may_change: bool) -> None:
    ask = authorizer(may_change)
    answers = {name: ask(action, "lights", "name", "main", None) for name, action in ACTIONS.items()}
    assert {name for name, answer in answers.items() if answer == sqlite3.SQLITE_OK} == (
        READ | CHANGED if may_change else READ
    )
    assert set(answers.values()) == {sqlite3.SQLITE_OK, sqlite3.SQLITE_DENY}
    # Reads inside of a view or trigger are allowed, and changes are not; nor are those of SQLite's tables.
    for name in READ | CHANGED:
        inner = ask(ACTIONS[name], "lights", "name", "main", "view")
        assert inner == (sqlite3.SQLITE_OK if name in READ else sqlite3.SQLITE_DENY)
        of_sqlite = [ask(ACTIONS[name], table, None, "main", None) for table in ("SQLite_x", "sqlite_master")]
        assert set(of_sqlite) == {sqlite3.SQLITE_OK if name in READ else sqlite3.SQLITE_DENY}
    for unknown in (0, 100, -1):
        assert ask(unknown, None, None, None, None) == sqlite3.SQLITE_DENY


def test_pragmas_are_allowed_that_read_and_functions_that_compute() -> None:
    def is_allowed(action: int, first: str | None, second: str | None) -> bool:
        answers = {authorizer(may)(action, first, second, None, None) for may in (False, True)}
        assert len(answers) == 1
        return answers == {sqlite3.SQLITE_OK}

    for pragma in ("application_id", "schema_version", "User_Version"):
        assert is_allowed(sqlite3.SQLITE_PRAGMA, pragma, None)
        assert not is_allowed(sqlite3.SQLITE_PRAGMA, pragma, "1")
    for pragma in ("table_info", "INDEX_LIST", "integrity_check"):
        assert is_allowed(sqlite3.SQLITE_PRAGMA, pragma, "lights")
    for unknown in ("trusted_schema", "journal_mode", "", None):
        assert not is_allowed(sqlite3.SQLITE_PRAGMA, unknown, None)
    for computing in ("max", "HEX", None):
        assert is_allowed(sqlite3.SQLITE_FUNCTION, None, computing)
    for function in UNSAFE_FUNCTIONS:
        assert not is_allowed(sqlite3.SQLITE_FUNCTION, None, function.upper())


def test_a_trigger_changes_nothing_whatever_the_schema_calls_it() -> None:
    with guarded(may_change=True) as connection:
        connection.set_authorizer(None)
        connection.execute(
            "CREATE TRIGGER evil AFTER DELETE ON nodes BEGIN INSERT INTO nodes VALUES (7); END"
        )
        connection.set_authorizer(authorizer(may_change=True))
        with pytest.raises(sqlite3.DatabaseError, match="not authorized"):
            connection.execute("DELETE FROM nodes")


def test_a_statement_may_compute() -> None:
    query = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 4) SELECT sum(i) FROM n"
    with guarded(may_change=False) as connection:
        assert connection.execute(query).fetchall() == [(10,)]
        assert connection.execute("PRAGMA table_info(nodes)").fetchall()
