from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given

from autocolor import Light, OutputError, Rig, Scene, read_rig, scene_of, write_rig
from autocolor.errors import UsageError
from autocolor.files.opening import kind_of
from tests.autocolor.linked_scenes import linked_scenes
from tests.small import cube
from tests.tables import refused

BOUNDS = "minimum = [0, 0, 0]\nmaximum = [1, 1, 1]\n"


def read_text(text: str) -> Rig:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "rig.toml")
        path.write_text(text, "utf-8")
        return read_rig(path)


@given(scene=linked_scenes())
def test_a_rig_read_back_puts_the_same_lights_on_the_same_scene(
    tmp_path_factory: pytest.TempPathFactory, scene: Scene
) -> None:
    path = tmp_path_factory.mktemp("rigs") / "rig.toml"
    write_rig(path, scene)
    assert read_rig(path) == scene.rig
    assert scene.replace(lights=()).with_rig(read_rig(path)).lights == scene.lights
    assert kind_of(path) == "rig"


def test_the_file_reads_like_a_scene_file(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    write_rig(path, scene_of(cube(), lights=[Light("key", (1, -2, 3), 0.5)]))
    written = (
        "minimum = [0.0, 0.0, 0.0]\nmaximum = [1.0, 1.0, 1.0]\n\n"
        '[[lights]]\nname = "key"\nposition = [1.0, -2.0, 3.0]\nintensity = 0.5\n'
    )
    assert path.read_text("utf-8") == written
    assert read_rig(path).lights == (Light("key", (1, -2, 3), 0.5),)
    with pytest.raises(OutputError, match="exist"):
        write_rig(path, scene_of(cube()))
    assert path.read_text("utf-8") == written


VECTOR = "must be three finite numbers of at most 1e36, not"

test_a_strangers_file_is_refused_with_every_problem_and_its_line = refused(
    read_text,
    [
        ("", f"rig.toml, minimum {VECTOR} missing; add it\nrig.toml, maximum {VECTOR} missing; add it"),
        (
            BOUNDS + '[[lights]]\nname = "k"\nposition = [1, 2]\nconcentraton = 3\n',
            f"rig.toml, line 5, lights[1] 'k': position {VECTOR} [1, 2]\n"
            "rig.toml, line 6, lights[1] 'k': there is no field 'concentraton'; did you mean"
            " 'concentration'?",
        ),
        (
            "minimum = [0, 0, 5]\nmaximum = [1, 1, 1]\n",
            "rig.toml, the minimum of z must be at most the maximum, not 5 to 1; exchange them",
        ),
    ],
)


def test_what_cannot_be_written_is_refused_and_leaves_no_file(tmp_path: Path) -> None:
    wrong: Any = 3
    for name, rig, sentence in (
        ("rig.txt", Rig((0, 0, 0), (1, 1, 1)), "a rig must be written to a file that ends in .toml"),
        ("rig.toml", wrong, "a scene must be a Scene, not 3"),
    ):
        with pytest.raises(UsageError, match=sentence):
            write_rig(tmp_path / name, rig)
    assert list(tmp_path.iterdir()) == []
