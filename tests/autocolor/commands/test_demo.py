from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import MissingInputError
from autocolor.commands import demo


def test_a_demo_that_is_not_there_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(demo, "PLACES", (tmp_path,))
    with pytest.raises(MissingInputError, match="install autocolor again"):
        autocolor.demo()


def test_the_demo_is_the_coupe_and_is_saved_elsewhere_with_its_mesh(tmp_path: Path) -> None:
    scene = autocolor.demo()
    assert scene.name == "coupe"
    assert [light.name for light in scene.lights] == ["key", "side", "back", "rim"]
    autocolor.write_scene(tmp_path / "coupe", scene)
    again = autocolor.read_scene(tmp_path / "coupe")
    assert again.replace(mesh=scene.mesh).equals(scene)
    assert sorted(path.name for path in (tmp_path / "coupe").iterdir()) == ["mesh.obj", "scene.toml"]
