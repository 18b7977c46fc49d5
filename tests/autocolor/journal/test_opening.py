"""Scenes that are opened, and opened again as they were then."""

from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import InputError, read_scene
from autocolor.journal.opening import checksum_of, opened
from autocolor.journal.places import Source, stamp_of
from autocolor.scene.columns.rows import plain
from tests.autocolor.sessions import car


@pytest.fixture
def source(tmp_path: Path) -> Source:
    autocolor.write_scene(tmp_path / "car", car())
    return Source(str(tmp_path / "car"))


def test_a_scene_is_opened_with_the_stamp_of_its_file(source: Source) -> None:
    scene, place = opened(source)
    assert checksum_of(scene) == checksum_of(read_scene(source.path))
    assert place.source == source
    assert place.stamp == stamp_of(Path(source.path) / "scene.toml")


def test_a_scene_that_was_saved_over_is_opened_as_it_was_and_not_saved_there_again(source: Source) -> None:
    then = opened(source).scene
    autocolor.write_scene(source.path, then.replace(ambient=0.75), overwrite=True)
    again = opened(source, plain(then), checksum_of(then))
    assert checksum_of(again.scene) == checksum_of(then)
    assert again.place.stamp is None
    assert opened(source, plain(again.scene.replace(ambient=0.75))).place.stamp is not None


def test_a_scene_of_another_checksum_is_refused(source: Source) -> None:
    with pytest.raises(InputError) as refusal:
        opened(source, checksum="9f")
    assert str(refusal.value) == (
        f"{source.path} must hold the mesh that it held when it was opened, and it was changed since; bring"
        " the old file back"
    )
