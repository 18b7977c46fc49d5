from __future__ import annotations

import os
import sqlite3
from pathlib import Path

import pytest

from autocolor import InputError, MissingInputError, UnavailableError
from autocolor.files.store import connections
from autocolor.files.store.connections import Clock, connected, in_memory, refusals
from tests.autocolor.files.store.stores import small_store


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


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes")
@pytest.mark.parametrize("ending", ["-journal", "-wal", "-shm"])
def test_a_pipe_beside_a_store_is_not_waited_for(tmp_path: Path, ending: str) -> None:
    path = small_store(tmp_path)
    os.mkfifo(f"{path}{ending}")
    for may_change in (False, True):
        with pytest.raises(InputError, match=f"{ending}: it must be a regular file, not a pipe; name a file"):
            connected(path, may_change=may_change)
