from __future__ import annotations

from pathlib import Path

from autocolor.files.scenes.formats import scene_format_named, scene_formats
from autocolor.files.scenes.toml_scene import SCENE_FILE


def test_a_scene_file_is_a_scene_format() -> None:
    assert SCENE_FILE in scene_formats()
    assert scene_format_named(Path("car.TOML")) is SCENE_FILE
