from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import InputError
from autocolor.files.store import found_tables as module
from autocolor.files.store.store_file import read_store
from tests.autocolor.files.store.stores import run, small_store


def test_a_store_of_a_later_version_is_refused(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "PRAGMA user_version = 2")
    with pytest.raises(
        InputError, match="the version of a store must be at most 1, not 2; read it with a newer"
    ):
        read_store(path)


def test_a_column_that_is_missing_is_named_with_the_nearest_one(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "ALTER TABLE polygons RENAME COLUMN node3 TO node_3")
    with pytest.raises(
        InputError, match=r"polygons must have the columns .* node3 is missing; add it; did you"
    ):
        read_store(path)


def test_a_table_of_too_many_rows_is_refused_before_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "MOST_ROWS", 1)
    with pytest.raises(InputError, match="parts must have at most 1 rows, not more; leave rows out"):
        read_store(small_store(tmp_path))


def test_bytes_are_refused_in_a_table_without_types(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "DROP TABLE view", "CREATE TABLE view (eye_x)", "INSERT INTO view VALUES (x'00')")
    with pytest.raises(
        InputError, match="view, row 1: eye_x must be a number or text, not bytes; correct it"
    ):
        read_store(path)
