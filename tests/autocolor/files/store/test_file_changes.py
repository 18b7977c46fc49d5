from __future__ import annotations

import os
import sqlite3
from contextlib import closing
from pathlib import Path

from autocolor.files.store.file_changes import FileChanges
from tests.autocolor.files.store.stores import hostile_journal, run, small_store

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
