from __future__ import annotations

import sys
from pathlib import Path

import pytest

from autocolor import InputError, read_scene
from autocolor.files import scenes
from autocolor.files.registry import Registry, recognized
from autocolor.files.scenes import formats
from autocolor.files.scenes.formats import SceneFormat, scene_format_named, scene_formats, scene_suffixes

ANOTHER = """
from autocolor.files.scene_sources import read_scene_with_report
from autocolor.files.scenes.formats import SceneFormat, register

def read(path, *, outside=False, surfaces="materials"):
    mesh = path.parent / path.read_text().split()[1]
    return read_scene_with_report(mesh, outside=outside, surfaces=surfaces)

def begins(head):
    return head.startswith(b"another")

register(SceneFormat("another", read, (".another",), in_folder="scene.another", begins=begins))
"""


def name_of(path: Path) -> str | None:
    found = scene_format_named(path)
    return found.name if found else None


def name_within(path: Path, data: bytes) -> str | None:
    path.write_bytes(data)
    found = recognized(path, scene_formats())
    return found.name if found else None


def test_every_format_has_a_name_and_a_way_to_be_chosen() -> None:
    assert [each.name for each in scene_formats()] == ["picture file", "scene file", "store"]
    assert [each.in_folder for each in scene_formats()] == [None, "scene.toml", None]
    assert scene_suffixes() == (".npz", ".toml", ".sqlite", ".db")


@pytest.mark.parametrize(
    ("name", "known"),
    [
        ("scene.toml", "scene file"),
        ("night.TOML", "scene file"),
        ("car.npz", "picture file"),
        ("car.toml.npz", "picture file"),
        ("car.obj", None),
        ("toml", None),
        (".toml", None),
        ("car.toml.bak", None),
    ],
)
def test_a_file_is_known_by_the_end_of_its_name_in_capitals_too(name: str, known: str | None) -> None:
    assert name_of(Path("folder.toml") / name) == known


def test_a_file_of_another_name_is_known_by_how_it_begins(tmp_path: Path) -> None:
    assert name_within(tmp_path / "saved", b"PK\x03\x04 and more") == "picture file"
    assert name_within(tmp_path / "notes", b'[[mesh]]\nfile = "car.obj"\n') is None
    assert name_within(tmp_path / "short", b"PK") is None
    assert name_within(tmp_path / "empty", b"") is None


def test_a_module_that_is_put_beside_the_others_is_a_format(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "another_scene.py").write_text(ANOTHER)
    (tmp_path / "car.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    for name in ("car.another", "car", "scene.another"):
        (tmp_path / name).write_text("another car.obj")
    with pytest.raises(InputError, match=r"end in \..*, \.obj, .*, not in '\.another'"):
        read_scene(tmp_path / "car.another")
    monkeypatch.setattr(scenes, "__path__", [*scenes.__path__, str(tmp_path)])
    before, registry = scene_formats(), Registry[SceneFormat](scenes.__name__)
    monkeypatch.setattr(formats, "REGISTRY", registry)
    for each in before:
        formats.register(each)
    try:
        assert scene_suffixes() == (".another", ".npz", ".toml", ".sqlite", ".db")
        for path in (tmp_path / "car.another", tmp_path / "car", tmp_path):
            assert len(read_scene(path).mesh.node_numbers) == 1
    finally:
        sys.modules.pop("autocolor.files.scenes.another_scene", None)
