from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from autocolor import UsageError
from autocolor.files.scene_files import kind_of
from autocolor.files.scene_sources import read_scene
from autocolor.files.scene_writing import write_scene
from tests.autocolor.files.store.stores import is_equal, small_scene, small_store


@pytest.mark.parametrize("name", ["scene.sqlite", "scene.db", "SCENE.DB"])
def test_a_scene_is_written_to_a_store_and_read_from_it_by_its_name(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    write_scene(path, small_scene())
    assert is_equal(read_scene(path), small_scene())
    assert kind_of(path) == "store"


def test_a_store_of_another_name_is_known_by_its_first_bytes(tmp_path: Path) -> None:
    path = tmp_path / "tables.bin"
    shutil.copy(small_store(tmp_path), path)
    assert is_equal(read_scene(path), small_scene())


def test_a_store_gives_its_own_up_axis(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="up is for mesh files"):
        read_scene(small_store(tmp_path), up="y")
