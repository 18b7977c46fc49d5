from __future__ import annotations

import os
from pathlib import Path

import pytest

from autocolor import InputError
from autocolor.files.scene_files import MOST_LISTED, Openable, kind_of, openables_of, stays_within


def test_what_can_be_opened_is_listed_in_natural_order_with_folders_last(tmp_path: Path) -> None:
    files = "car10.obj car2.obj Car3.OBJ notes.txt .hidden.obj lights.toml a.npz a.db b.GPL c.act d.csv"
    for name in files.split():
        (tmp_path / name).write_text("")
    for name in ("b", "a scene", "a mesh", ".git"):
        (tmp_path / name).mkdir()
    (tmp_path / "a scene" / "scene.toml").write_text("")
    for name in ("nodes.csv", "polygons.csv"):
        (tmp_path / "a mesh" / name).write_text("")
    assert [(path.name, kind) for path, kind in openables_of(tmp_path)] == [
        ("a mesh", "mesh"),
        ("a scene", "scene"),
        ("a.db", "store"),
        ("a.npz", "picture"),
        ("b.GPL", "paints"),
        ("c.act", "paints"),
        ("car2.obj", "mesh"),
        ("Car3.OBJ", "mesh"),
        ("car10.obj", "mesh"),
        ("lights.toml", "scene"),
        ("b", "folder"),
    ]


def test_no_more_than_some_names_are_looked_at(tmp_path: Path) -> None:
    for number in range(MOST_LISTED + 5):
        (tmp_path / f"{number}.obj").touch()
    assert len(openables_of(tmp_path)) == MOST_LISTED


@pytest.mark.parametrize("missing", ["gone", "file.obj"])
def test_a_folder_that_cannot_be_read_is_refused(tmp_path: Path, missing: str) -> None:
    (tmp_path / "file.obj").write_text("")
    with pytest.raises(
        InputError, match=rf"^{missing}: a folder must be readable, and is not \(.+\); choose"
    ):
        openables_of(tmp_path / missing)


def test_what_is_no_regular_file_cannot_be_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.obj")
    (tmp_path / "broken.obj").symlink_to(tmp_path / "gone.obj")
    assert kind_of(tmp_path / "pipe.obj") == kind_of(tmp_path / "broken.obj") == ""
    assert kind_of(tmp_path / ("long" * 100 + ".obj")) == kind_of(tmp_path / "gone.obj") == ""
    assert openables_of(tmp_path) == []


def test_links_are_followed_before_a_path_is_within_a_folder(tmp_path: Path) -> None:
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    (inside / "a").mkdir(parents=True)
    outside.mkdir()
    (outside / "car.obj").touch()
    (inside / "link.obj").symlink_to(outside / "car.obj")
    (inside / "up").symlink_to(tmp_path)
    (inside / "to a").symlink_to(inside / "a")
    assert stays_within(inside, inside)
    assert stays_within(inside / "to a", inside)
    assert stays_within(inside / "a" / ".." / "a", inside)
    for path in ("link.obj", "up", "..", "a/../..", "up/outside/car.obj", "up/inside/../outside"):
        assert not stays_within(inside / path, inside), path


def test_a_folder_whose_scene_file_is_a_link_out_is_not_within(tmp_path: Path) -> None:
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    for name in ("scene", "mesh"):
        (inside / name).mkdir(parents=True)
    outside.mkdir()
    for name in ("scene.toml", "nodes.csv", "polygons.csv"):
        (outside / name).touch()
    (inside / "scene" / "scene.toml").symlink_to(outside / "scene.toml")
    (inside / "mesh" / "nodes.csv").symlink_to(outside / "nodes.csv")
    (inside / "mesh" / "polygons.csv").symlink_to(outside / "polygons.csv")
    assert openables_of(inside) == [
        Openable(inside / "mesh", "mesh"),
        Openable(inside / "scene", "scene"),
    ]
    assert not stays_within(inside / "scene", inside)
    assert not stays_within(inside / "mesh", inside)
