from __future__ import annotations

import os
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from autocolor import InputError, OutputError, UnavailableError, WriteError
from autocolor.budget import allowing
from autocolor.files.store import connections
from autocolor.files.store.connections import (
    UNSAFE_FUNCTIONS,
    authorizer,
    in_memory,
    replacing,
    store_content,
)
from autocolor.files.store.store_file import store_bytes, write_store
from tests.autocolor.files.store.stores import contents, hostile_journal, run, small_scene, small_store

BRIGHTER = "UPDATE lights SET intensity = intensity + 1 WHERE name = 'key'"
BRIGHTNESS = "SELECT intensity FROM lights WHERE name = 'key'"


def brightness(path: Path) -> float:
    """The intensity of the key light, as SQLite reads it from the file."""
    return float(run(path, BRIGHTNESS)[0][0])


def read(path: Path) -> None:
    store_content(path)


def change(path: Path) -> None:
    """Save the small scene with another brightness over a store."""
    write_store(path, small_scene().with_light("key", intensity=9.0), overwrite=True)


def test_sizes_are_limited_and_the_schema_is_not_trusted() -> None:
    with closing(in_memory()) as connection:
        for pragma, value in {"trusted_schema": 0, "cell_size_check": 1, "foreign_keys": 0}.items():
            assert connection.execute(f"PRAGMA {pragma}").fetchone() == (value,), pragma
        assert connection.execute("SELECT length(?)", (bytes(1 << 17),)).fetchone() == (1 << 17,)
        for wrong in ("SELECT length(zeroblob(131073))", f"SELECT 'a' LIKE '{1001 * '%'}'"):
            with pytest.raises(sqlite3.Error, match=r"too (big|complex)"):
                connection.execute(wrong).fetchall()


def test_a_file_may_have_any_name_and_a_copy_is_not_the_file(tmp_path: Path) -> None:
    name = "a?b#c%20\u202e\x1b\n\udcff.sqlite" if sys.platform.startswith("linux") else "a b#c%20.sqlite"
    path = small_store(tmp_path).rename(tmp_path / name)
    with closing(in_memory(store_content(path))) as connection:
        connection.execute("DELETE FROM lights")
    assert run(path, "SELECT count(*) FROM lights") == [(2,)]


def test_what_is_no_file_or_too_large_is_not_opened(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    for name in ("pipe.db", "small.sqlite-wal"):
        os.mkfifo(tmp_path / name)
    for name in ("pipe.db", ".", "small.sqlite"):
        with pytest.raises(InputError, match="must be a regular file"):
            store_content(tmp_path / name)
    with pytest.raises(InputError, match="-wal: it must be a regular file, not a pipe"):
        change(path)
    with pytest.raises(InputError, match=r"small.sqlite: to read [0-9,]+ bytes must take "), allowing(1e-9):
        store_content(path)


def test_an_old_sqlite_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sqlite3, "sqlite_version_info", (3, 37, 0))
    in_memory().close()
    monkeypatch.setattr(sqlite3, "sqlite_version_info", (3, 36, 9))
    with pytest.raises(UnavailableError, match=r"a store must have SQLite 3\.37 or later"):
        in_memory()


# Journals and logs beside a store.


@pytest.mark.parametrize("act", [read, change])
@pytest.mark.parametrize("has_header", [False, True])
def test_a_hostile_journal_is_never_rolled_back(
    tmp_path: Path, act: Callable[[Path], None], has_header: bool
) -> None:
    path, link, named = small_store(tmp_path), tmp_path / "link.sqlite", tmp_path / "named.txt"
    link.symlink_to(path.name)
    named.write_text("precious")
    hostile_journal(path, named, has_header=has_header)
    before = contents(tmp_path)
    for place in (path, link):
        with pytest.raises(InputError, match="its -journal names another file, which SQLite deletes"):
            act(place)
    assert contents(tmp_path) == before


def killed_change(path: Path, mode: str) -> None:
    """Have a program of SQLite killed while it changes a store, and has written a part of it."""
    code = (
        "import os, sqlite3, sys; c = sqlite3.connect(sys.argv[1], isolation_level=None);"
        "c.execute('PRAGMA cache_size = 1'); c.execute('PRAGMA cache_spill = 1');"
        f"c.execute('PRAGMA journal_mode = {mode}'); c.execute('BEGIN'); c.execute('DELETE FROM lights');"
        "[c.execute('INSERT INTO nodes VALUES (?, 1, 1, 1)', (n,)) for n in range(100, 20000)]; os._exit(0)"
    )
    subprocess.run([sys.executable, "-c", code, str(path)], check=True, timeout=60)


@pytest.mark.parametrize("mode", ["DELETE", "PERSIST", "TRUNCATE", "WAL"])
@pytest.mark.parametrize("act", [read, change])
def test_a_change_of_a_program_that_was_killed_is_taken_back(
    tmp_path: Path, mode: str, act: Callable[[Path], None]
) -> None:
    path = small_store(tmp_path)
    killed_change(path, mode)
    assert len(os.listdir(tmp_path)) > 1
    act(path)
    assert brightness(path) == (1.0 if act == read else 9.0)
    assert run(path, "SELECT count(*) FROM nodes") == [(5,)]
    assert run(path, "PRAGMA integrity_check") == [("ok",)]


def test_what_a_log_holds_is_read_and_is_not_played_into_the_next_store(tmp_path: Path) -> None:
    path, copy = small_store(tmp_path), tmp_path / "copy.sqlite"
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("PRAGMA journal_mode = WAL")
        other.execute(BRIGHTER)
        for ending in ("", "-wal"):
            shutil.copy(f"{path}{ending}", f"{copy}{ending}")
    before = copy.read_bytes()
    with closing(in_memory(store_content(copy))) as connection:
        assert connection.execute(BRIGHTNESS).fetchone() == (2.0,)
    assert copy.read_bytes() == before
    change(copy)
    assert brightness(copy) == 9.0
    assert run(copy, "PRAGMA journal_mode") == [("delete",)]
    assert "copy.sqlite-wal" not in os.listdir(tmp_path)


def test_a_journal_that_a_program_keeps_for_its_next_change_is_no_hindrance(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    for content in (b"", bytes(512) + b"old pages", bytes(12) + b"unsynced header".ljust(500, b"\0")):
        Path(f"{path}-journal").write_bytes(content)
        read(path)
        change(path)
        assert brightness(path) == 9.0


def test_no_store_is_made_beside_a_file_that_would_be_played_into_it(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    killed_change(path, "WAL")
    path.unlink()
    before = contents(tmp_path)
    with pytest.raises(WriteError, match="-wal beside it, because SQLite would"):
        change(path)
    assert contents(tmp_path) == before


# Other programs.


def test_a_program_that_has_the_store_is_waited_for_and_then_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "SECONDS_OF_WAITING", 0.05)
    path = small_store(tmp_path)
    sentence = "another program is writing to the store, or has it open in WAL mode; close it"
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        for act, error in ((read, InputError), (change, WriteError)):
            with pytest.raises(error, match=sentence):
                act(path)
        other.execute(BRIGHTER)
        other.execute("COMMIT")
        other.execute("PRAGMA journal_mode = WAL")
        other.execute(BRIGHTER)
        with pytest.raises(WriteError, match=sentence):
            change(path)
        other.execute(BRIGHTER)
    assert brightness(path) == 4.0


def test_nobody_else_changes_a_store_while_it_is_changed_and_one_that_is_replaced_stays(
    tmp_path: Path,
) -> None:
    path, other = small_store(tmp_path), small_store(tmp_path, "other.sqlite")
    run(other, BRIGHTER)
    with replacing(path, lambda: None) as (_, save):
        with pytest.raises(sqlite3.OperationalError, match="database is locked"):
            run(path, "PRAGMA busy_timeout = 0", BRIGHTER)
        os.replace(other, path)
        with pytest.raises(WriteError, match="another program replaced it; nothing was saved, so try again"):
            save(store_bytes(small_scene()))
    assert brightness(path) == 2.0


def test_programs_that_change_a_store_at_the_same_time_lose_nothing(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    code = (
        "import sys; from autocolor import open_tables\n"
        f"for _ in range(5):\n  with open_tables(sys.argv[1]) as tables: tables.change({BRIGHTER!r})"
    )
    programs = [subprocess.Popen([sys.executable, "-c", code, str(path)]) for _ in range(3)]
    assert [program.wait(timeout=120) for program in programs] == [0, 0, 0]
    assert brightness(path) == 16.0
    assert os.listdir(tmp_path) == [path.name]


def test_a_store_that_is_write_protected_is_read_and_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = small_store(tmp_path)
    before = contents(tmp_path)
    # Root may write everywhere.
    monkeypatch.setattr(os, "access", lambda *_: False)
    read(path)
    with pytest.raises(OutputError, match=r"small.sqlite: a store must not be write-protected to be changed"):
        change(path)
    assert contents(tmp_path) == before


# Permissions of statements.

REFUSED = """\
ATTACH 'other.db' AS other
SELECT FTS3_Tokenizer('simple', x'00')
PRAGMA journal_mode = WAL
DROP VIEW far
DELETE FROM sqlite_master
DELETE FROM far"""
"""The last one would change rows by a trigger."""

CHANGES = ("DELETE FROM nodes", "UPDATE nodes SET x = 1", "INSERT INTO nodes VALUES (2)")
READS = (
    "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 4) SELECT sum(i) FROM n",
    "SELECT HEX(max(x)) FROM far",
    "SELECT * FROM sqlite_master",
    "PRAGMA INDEX_LIST(nodes)",
)
GUARDED = """\
CREATE TABLE nodes (x UNIQUE);
INSERT INTO nodes VALUES (1);
CREATE VIEW far AS SELECT * FROM nodes;
CREATE TRIGGER evil INSTEAD OF DELETE ON far BEGIN INSERT INTO nodes VALUES (7); END"""


@pytest.mark.parametrize("may_change", [False, True])
def test_a_statement_reads_or_also_changes_rows_and_may_do_nothing_else(may_change: bool) -> None:
    def is_allowed(statement: str) -> bool:
        with closing(sqlite3.connect(":memory:", isolation_level=None)) as connection:
            connection.executescript(GUARDED)
            connection.set_authorizer(authorizer(may_change, set()))
            try:
                connection.execute(statement).fetchall()
            except sqlite3.DatabaseError:
                return False
            return True

    allowed = [each for each in (*REFUSED.splitlines(), *CHANGES, *READS) if is_allowed(each)]
    assert allowed == [*(CHANGES if may_change else ()), *READS]
    ask = authorizer(may_change, set())
    assert {ask(unknown, None, None, None, None) for unknown in (0, 100, -1)} == {sqlite3.SQLITE_DENY}
    for function in UNSAFE_FUNCTIONS:
        assert ask(sqlite3.SQLITE_FUNCTION, None, function.upper(), None, None) == sqlite3.SQLITE_DENY
