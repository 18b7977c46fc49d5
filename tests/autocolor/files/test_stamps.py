"""Stamps and looks: every change of a file by another program is noticed."""

from __future__ import annotations

import hashlib
import os
import sqlite3
from contextlib import closing
from pathlib import Path

from autocolor.files.stamps import look_at, stamp_of
from tests.autocolor.files.store.stores import hostile_journal, run, small_store
from tests.small import scene_folder

BRIGHTER = "UPDATE lights SET intensity = intensity + 1"


def changed(path: Path, seen: tuple[int, ...] | None) -> tuple[int, ...] | None:
    """The numbers of a file, which are others than were seen."""
    now = look_at(path)
    assert now not in (None, seen)
    return now


def test_a_store_that_is_changed_in_place_or_replaced_is_noticed(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    seen = look_at(path)
    run(path, "SELECT * FROM lights")
    assert look_at(path) == seen
    run(path, BRIGHTER)
    seen = changed(path, seen)
    other = small_store(tmp_path, "other.sqlite")
    os.utime(other, ns=(os.stat(path).st_atime_ns, os.stat(path).st_mtime_ns))
    os.replace(other, path)
    changed(path, seen)


def test_a_change_that_is_only_beside_the_store_is_noticed(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "PRAGMA journal_mode = WAL")
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("SELECT * FROM lights").fetchall()
        seen = look_at(path)
        before = os.stat(path)
        other.execute(BRIGHTER)
        assert os.stat(path).st_mtime_ns == before.st_mtime_ns
        changed(path, seen)
    # To look leaves nothing beside the store.
    assert os.listdir(tmp_path) == ["small.sqlite"]


def test_a_file_that_is_being_written_or_is_gone_was_not_changed_yet(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    seen = look_at(path)
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        other.execute(BRIGHTER)
        assert look_at(path) == seen
        other.execute("COMMIT")
    seen = changed(path, seen)
    journal = hostile_journal(path, tmp_path / "other.txt")
    assert look_at(path) is None
    journal.unlink()
    path.unlink()
    assert look_at(path) is None


def test_a_text_file_has_the_stamp_of_its_bytes_and_a_folder_or_a_pipe_has_none(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    os.mkfifo(tmp_path / "pipe.toml")
    for missing in (path, tmp_path, tmp_path / "pipe.toml"):
        assert stamp_of(missing) is None
    for text in ("ambient = 0.1", "mesh = 5", 'mesh = ["a", {file = 5}, {file = "/etc/passwd"}]', "[[mesh"):
        seen = look_at(path)
        path.write_text(text)
        assert stamp_of(path) == hashlib.sha256(text.encode()).hexdigest()
        changed(path, seen)


def test_a_stamp_of_a_store_includes_its_log_also_through_a_link(tmp_path: Path) -> None:
    path, link = tmp_path / "car.sqlite", tmp_path / "link.sqlite"
    path.write_bytes(b"store")
    link.symlink_to(path)
    before = stamp_of(path)
    (tmp_path / "car.sqlite-wal").write_bytes(b"")
    assert stamp_of(path) == before
    (tmp_path / "car.sqlite-wal").write_bytes(b"more")
    assert stamp_of(path) == stamp_of(link) == hashlib.sha256(b"storemore").hexdigest()
    (tmp_path / "car.sqlite-wal").unlink()
    assert stamp_of(path) == stamp_of(link) == before


def test_a_stamp_of_a_scene_file_includes_the_meshes_that_it_names(tmp_path: Path) -> None:
    folder = scene_folder(tmp_path / "scene")
    path, mesh = folder / "scene.toml", folder / "two.obj"
    before = stamp_of(path)
    (folder / "other.obj").write_text("v 0 0 0\n")
    assert before == stamp_of(path)
    os.utime(mesh, ns=(0, 0))
    earlier = stamp_of(path)
    mesh.write_text(mesh.read_text() + "\n")
    os.utime(mesh, ns=(0, 0))
    assert len({before, earlier, stamp_of(path)}) == 3
