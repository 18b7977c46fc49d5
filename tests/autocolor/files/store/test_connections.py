from __future__ import annotations

import os
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from autocolor import InputError, MissingInputError, UnavailableError, WriteError, open_tables
from autocolor.files.store import connections
from autocolor.files.store.connections import (
    Clock,
    FileChanges,
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


def test_sizes_are_limited_and_the_schema_is_not_trusted() -> None:
    connection = in_memory()
    assert connection.getlimit(sqlite3.SQLITE_LIMIT_LENGTH) == 1 << 20
    assert connection.getlimit(sqlite3.SQLITE_LIMIT_ATTACHED) == 0
    assert connection.execute("PRAGMA trusted_schema").fetchone() == (0,)
    assert connection.execute("PRAGMA cell_size_check").fetchone() == (1,)
    with pytest.raises(sqlite3.DataError, match="too big"):
        connection.execute("SELECT hex(zeroblob(1000000))").fetchall()
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


def test_a_file_that_is_too_large_is_not_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "LARGEST_STORE", 100)
    with pytest.raises(InputError, match="a store must have at most 100 bytes, not more; split it"):
        connected(small_store(tmp_path))


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
    monkeypatch.setattr(sqlite3, "sqlite_version_info", (3, 31, 1))
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
    assert not named.exists()
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


BRIGHTER = "UPDATE lights SET intensity = intensity + 1"


def test_a_store_that_is_changed_in_place_is_noticed(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    changes = FileChanges(path, is_store=True)
    assert not changes.have_come()
    run(path, BRIGHTER)
    assert changes.have_come()
    changes.seen()
    assert not changes.have_come()
    run(path, "SELECT * FROM lights")
    assert not changes.have_come()


def test_a_change_that_is_only_beside_the_store_is_noticed(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "PRAGMA journal_mode = WAL")
    changes = FileChanges(path, is_store=True)
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("SELECT * FROM lights").fetchall()
        changes.seen()
        before = os.stat(path)
        other.execute(BRIGHTER)
        assert os.stat(path).st_mtime_ns == before.st_mtime_ns
        assert changes.have_come()


def test_a_store_that_is_replaced_is_noticed_and_changes_of_the_new_one(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    changes = FileChanges(path, is_store=True)
    other = small_store(tmp_path, "other.sqlite")
    os.utime(other, ns=(os.stat(path).st_atime_ns, os.stat(path).st_mtime_ns))
    os.replace(other, path)
    assert changes.have_come()
    changes.seen()
    run(path, BRIGHTER)
    assert changes.have_come()


def test_a_file_that_is_being_written_or_is_gone_was_not_changed_yet(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    changes = FileChanges(path, is_store=True)
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        other.execute(BRIGHTER)
        assert not changes.have_come()
        other.execute("COMMIT")
        assert changes.have_come()
    path.unlink()
    assert not changes.have_come()


def test_a_text_file_is_noticed_by_its_place_and_time(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text("a")
    changes = FileChanges(path, is_store=False)
    assert not changes.have_come()
    path.write_text("ab")
    assert changes.have_come()


def test_to_look_leaves_nothing_beside_the_store(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    changes = FileChanges(path, is_store=True)
    changes.have_come()
    run(path, "PRAGMA journal_mode = WAL")
    assert changes.have_come()
    assert os.listdir(tmp_path) == ["small.sqlite"]


def test_a_store_with_a_journal_left_beside_it_is_being_written(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    changes = FileChanges(path, is_store=True)
    run(path, BRIGHTER)
    journal = hostile_journal(path, tmp_path / "other.txt")
    assert not changes.have_come()
    journal.unlink()
    assert changes.have_come()


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


def guarded(may_change: bool) -> sqlite3.Connection:
    connection = sqlite3.connect(":memory:", isolation_level=None)
    connection.execute("CREATE TABLE nodes (x)")
    connection.execute("INSERT INTO nodes VALUES (1)")
    connection.set_authorizer(authorizer(may_change))
    return connection


@pytest.mark.parametrize("statement", [*REFUSED, *CHANGES])
def test_a_statement_that_reads_may_do_nothing_else(statement: str) -> None:
    with pytest.raises(sqlite3.DatabaseError):
        guarded(may_change=False).execute(statement)


@pytest.mark.parametrize("statement", REFUSED)
def test_a_statement_that_changes_rows_may_change_nothing_else(statement: str) -> None:
    with pytest.raises(sqlite3.DatabaseError):
        guarded(may_change=True).execute(statement)


@pytest.mark.parametrize("statement", CHANGES)
def test_rows_are_changed_where_that_is_asked_for(statement: str) -> None:
    assert guarded(may_change=True).execute(statement).rowcount == 1


def test_a_trigger_changes_nothing_whatever_the_schema_calls_it() -> None:
    connection = guarded(may_change=True)
    connection.set_authorizer(None)
    connection.execute("CREATE TRIGGER evil AFTER DELETE ON nodes BEGIN INSERT INTO nodes VALUES (7); END")
    connection.set_authorizer(authorizer(may_change=True))
    with pytest.raises(sqlite3.DatabaseError, match="not authorized"):
        connection.execute("DELETE FROM nodes")


def test_a_statement_may_compute() -> None:
    query = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 4) SELECT sum(i) FROM n"
    assert guarded(may_change=False).execute(query).fetchall() == [(10,)]
    assert guarded(may_change=False).execute("PRAGMA table_info(nodes)").fetchall()
