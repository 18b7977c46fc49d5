"""Scene files as a scene format: a `scene.toml` and the mesh files beside it."""

from __future__ import annotations

from typing import Final

from autocolor.files.scene_toml.scene_file import read_scene_file
from autocolor.files.scenes.formats import SceneFormat, register

SCENE_FILE: Final = register(SceneFormat("scene file", read_scene_file, (".toml",), in_folder="scene.toml"))
