from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given

from autocolor import (
    Flap,
    Flaps,
    InputError,
    Light,
    MissingInputError,
    OutputError,
    Rig,
    Scene,
    UsageError,
    read_rig,
    scene_of,
    write_rig,
)
from autocolor.files.rig_file import is_rig
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT
from autocolor.scene.lights import HalfSpace, Links
from tests.autocolor.linked_scenes import linked_scenes
from tests.small import cube

DOORS = (HalfSpace("left", (0, 0, 0), (1, 0, 0), 1 / 3), HalfSpace("my door", (0, 0, 0), (0, 1, 0), on=False))
BOUNDS = "minimum = [0, 0, 0]\nmaximum = [1, 1, 1]\n"


def given_text(folder: Path, text: str) -> Path:
    path = folder / "rig.toml"
    path.write_text(text, "utf-8")
    return path


@given(scene=linked_scenes())
def test_a_rig_read_back_puts_the_same_lights_on_the_same_scene(
    tmp_path_factory: pytest.TempPathFactory, scene: Scene
) -> None:
    path = tmp_path_factory.mktemp("rigs") / "rig.toml"
    write_rig(path, scene)
    assert read_rig(path) == scene.rig
    assert scene.replace(lights=()).with_rig(read_rig(path)).lights == scene.lights


def test_every_control_of_a_light_is_kept(tmp_path: Path) -> None:
    lights = (
        Light('a "name"\n', (0.1, 1e-300, -1e36), 1e30, False, flaps=Flaps(x=Flap(), y=Flap(0.5, on=False))),
        Light("spot", (0, 0, 2), aim=(1 / 3, 0, 0), concentration=2.5, cone_angle=0.1),
        Light("sun", (0, 0, 9), direction=(0, 0, -1e-9), half_spaces=DOORS, follows="spot"),
    )
    rig = Rig((-1, -1, 0), (1, 1, 1 / 7), lights)
    write_rig(tmp_path / "rig.toml", rig)
    assert read_rig(tmp_path / "rig.toml") == rig


def test_a_rig_may_have_no_lights(tmp_path: Path) -> None:
    dark = scene_of(cube(), lights=())
    write_rig(tmp_path / "dark.toml", dark)
    assert scene_of(cube()).with_rig(read_rig(tmp_path / "dark.toml")).lights == ()


def test_the_file_reads_like_a_scene_file(tmp_path: Path) -> None:
    write_rig(tmp_path / "rig.toml", scene_of(cube(), lights=[Light("key", (1, -2, 3), 0.5)]))
    assert (tmp_path / "rig.toml").read_text("utf-8") == (
        "minimum = [0.0, 0.0, 0.0]\nmaximum = [1.0, 1.0, 1.0]\n\n"
        '[[lights]]\nname = "key"\nposition = [1.0, -2.0, 3.0]\nintensity = 0.5\n'
    )


def test_a_file_that_is_there_is_kept_unless_told_otherwise(tmp_path: Path) -> None:
    path = given_text(tmp_path, "mine")
    with pytest.raises(OutputError, match="exist"):
        write_rig(path, scene_of(cube()))
    assert path.read_text("utf-8") == "mine"
    write_rig(path, scene_of(cube()), overwrite=True)
    assert read_rig(path) == scene_of(cube()).rig


@pytest.mark.parametrize(
    ("text", "sentences"),
    [
        (
            "",
            [
                "rig.toml, minimum must be three finite numbers of at most 1e36, not missing; add it",
                "rig.toml, maximum must be three finite numbers of at most 1e36, not missing; add it",
            ],
        ),
        (
            BOUNDS + '[[lights]]\nname = "k"\nposition = [1, 2]\nconcentraton = 3\n',
            [
                "rig.toml, line 5, lights[1] 'k': position must be three finite numbers of at most 1e36, not"
                " [1, 2]",
                "rig.toml, line 6, lights[1] 'k': there is no field 'concentraton'; did you mean"
                " 'concentration'?",
            ],
        ),
        (
            BOUNDS + '[[mesh]]\nfile = "a.obj"\n',
            ["rig.toml, line 3, there is no field 'mesh'; choose 'minimum', 'maximum' or 'lights'"],
        ),
        (
            "minimum = [0, 0, 5]\nmaximum = [1, 1, 1]\n",
            ["rig.toml, the minimum of z must be at most the maximum, not 5 to 1; exchange them"],
        ),
        (BOUNDS + "lights = 3", ["rig.toml, line 3, lights must be a list of Light rows, not 3"]),
        (
            "minimum = [nan, 0, 0]\nmaximum = [inf, 1, 1]\n",
            [
                "rig.toml, line 1, minimum must be three finite numbers of at most 1e36, not [nan, 0, 0]",
                "rig.toml, line 2, maximum must be three finite numbers of at most 1e36, not [inf, 1, 1]",
            ],
        ),
        ("\0", ["rig.toml: a rig file must be text, not hold a NUL byte (line 1); save it as UTF-8 text"]),
    ],
)
def test_a_strangers_file_is_refused_with_every_problem_and_its_line(
    tmp_path: Path, text: str, sentences: list[str]
) -> None:
    with pytest.raises(InputError) as refusal:
        read_rig(given_text(tmp_path, text))
    assert list(refusal.value.problems) == sentences


@pytest.mark.parametrize("text", ["a" * (LARGEST_TEXT + 1), "a = " + "[" * 5000, ".".join("a" * 9) + " = 1"])
def test_a_file_that_would_be_slow_to_read_is_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError, match=r"^rig\.toml"):
        read_rig(given_text(tmp_path, text))


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(MissingInputError, match="there is no such file or folder"):
        read_rig(tmp_path / "rig.toml")
    with pytest.raises(InputError, match="must be a regular file, not a folder"):
        read_rig(tmp_path)


@pytest.mark.parametrize(
    ("name", "rig", "kind", "sentence"),
    [
        ("rig.txt", scene_of(cube()), UsageError, "a rig must be written to a file that ends in .toml"),
        ("rig.toml", 3, UsageError, "a rig must be of a Scene, not 3; give the scene with the lights"),
        (
            "rig.toml",
            Rig((0, 0, 0), (1, 1, 1), (Light("\ud800", (0, 0, 1)),)),
            InputError,
            "a name in a file must be text in UTF-8; rename it",
        ),
        (
            "rig.toml",
            Rig((0, 0, 0), (1, 1, 1), (Light("key", (0, 0, 1), links=Links(only_parts=("\ud800",))),)),
            InputError,
            "light 'key': a name in a file must be text in UTF-8; rename it",
        ),
        (
            "rig.toml",
            Rig((0, 0, 0), (1, 1, 1), (Light("a" * (LARGEST_TEXT + 1), (0, 0, 1)),)),
            OutputError,
            r"a rig file must have at most 1,048,576 bytes, not 1,048,\d+; remove lights",
        ),
    ],
)
def test_what_cannot_be_written_is_refused_and_leaves_no_file(
    tmp_path: Path, name: str, rig: Any, kind: type[Exception], sentence: str
) -> None:
    with pytest.raises(kind, match=sentence):
        write_rig(tmp_path / name, rig)
    assert list(tmp_path.iterdir()) == []


def test_a_file_with_the_size_of_an_object_and_no_mesh_is_a_rig(tmp_path: Path) -> None:
    write_rig(tmp_path / "rig.toml", scene_of(cube()))
    assert is_rig(tmp_path / "rig.toml")
    for text in ("", "ambient = 0.5", 'minimum = [0, 0, 0]\n[[mesh]]\nfile = "car.obj"', "minimum = ["):
        assert not is_rig(given_text(tmp_path, text)), text
    assert not is_rig(tmp_path / "gone.toml")
    assert not is_rig(tmp_path)
