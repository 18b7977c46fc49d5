"""What scenes were opened from, and which files may be saved to again."""

from __future__ import annotations

import hashlib
from pathlib import Path

import autocolor
from autocolor.journal.places import PACKAGE, Source, file_of, place_of, stamp_of
from tests.autocolor.sessions import car


def test_the_file_of_a_scene_folder_is_its_scene_file(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    path = tmp_path / "car" / "scene.toml"
    assert file_of(Source(str(tmp_path / "car"))) == path
    assert file_of(Source(str(path))) == path
    assert file_of(Source(str(tmp_path / "car.npz"))) == tmp_path / "car.npz"
    assert file_of(Source(str(tmp_path / "car.obj"))) is None


def test_a_stamp_is_that_of_the_bytes_of_a_file(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    assert stamp_of(path) is None
    path.write_bytes(b"ambient = 0.1\n")
    assert stamp_of(path) == hashlib.sha256(b"ambient = 0.1\n").hexdigest()
    assert place_of(Source(str(path))).stamp == stamp_of(path)
    assert stamp_of(tmp_path) is None


def test_meshes_and_files_of_the_package_have_no_stamp(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text("v 0 0 0\n")
    assert place_of(Source(str(tmp_path / "car.obj"))).stamp is None
    inside = PACKAGE / "demo_scene" / "scene.toml"
    assert place_of(Source(str(inside))).stamp is None
    assert Path(autocolor.__file__).parent == PACKAGE


def test_two_openings_of_one_file_are_two_places(tmp_path: Path) -> None:
    source = Source(str(tmp_path / "car.obj"))
    assert place_of(source) != place_of(source)
    assert len({place_of(source), place_of(source)}) == 2


def test_the_stamp_of_a_store_is_also_that_of_what_was_written_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "car.sqlite"
    assert file_of(Source(str(path))) == path
    path.write_bytes(b"store")
    before = stamp_of(path)
    Path(f"{path}-wal").write_bytes(b"more")
    assert stamp_of(path) != before
    Path(f"{path}-wal").unlink()
    assert stamp_of(path) == before
