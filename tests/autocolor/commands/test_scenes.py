from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.commands.scenes import SceneSource, edited, read
from autocolor.commands.settings import with_settings
from autocolor.files.opening import read_scene_with_report
from autocolor.scene.defaults import default_lights, framed
from autocolor.scene.scene import Scene


def test_each_repair_is_a_line_on_stderr(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert read(SceneSource("two.obj")).repairs == ()
    assert tuple(capsys.readouterr()) == ("", "")
    (folder / "two.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\nl 1 2\n")
    report = read(SceneSource("two.obj"))
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines() == [f"autocolor: {repair}" for repair in report.repairs]
    assert len(report.repairs) == 2


# Views and lights that are created.


def edited_mesh(*settings: str, scene: str = "two.obj", size: tuple[int, int] = (640, 480)) -> Scene:
    """The scene of a mesh with settings, for a picture of a size."""
    return edited(read_scene_with_report(scene), SceneSource(scene, settings=settings, size=size))


def test_a_created_view_frames_what_is_left_when_a_part_becomes_stage(folder: Path) -> None:
    first = read_scene_with_report("two.obj").scene
    scene = edited_mesh("parts.side.stage=true")
    alone = framed(first.view, scene.object_coordinates)
    assert scene.view == alone != first.view
    assert scene.lights == default_lights(scene.object_coordinates, alone) != first.lights
    # Lights that are set stay.
    scene = edited_mesh("parts.side.stage=true", "lights.key.intensity=2")
    assert scene.lights == first.with_light("key", intensity=2).lights


@pytest.mark.parametrize("size", [(640, 480), (30, 60)])
def test_a_created_view_frames_the_object_whatever_the_shape_of_the_picture_and_its_field(
    folder: Path, size: tuple[int, int]
) -> None:
    first, aspect = read_scene_with_report("two.obj").scene, size[0] / size[1]
    assert edited_mesh(size=size).view == framed(first.view, first.object_coordinates, aspect)
    scene = edited_mesh("view.field_of_view=10", size=size)
    assert scene.view == framed(scene.view, scene.object_coordinates, aspect)
    assert scene.view.eye != first.view.eye
    assert scene.lights == first.lights


@pytest.mark.parametrize(
    "settings",
    [
        ("ambient=0.5", "lights.key.intensity=2"),
        ("view.eye=[1, -5, 2]", "view.field_of_view=10"),
        ("view.target=none", "view.direction=[0, 1, 0]", "view.field_of_view=10"),
        ("view.target=[0, 0, 0]", "view.field_of_view=10"),
    ],
)
def test_what_was_set_is_kept_as_it_is(folder: Path, settings: tuple[str, ...]) -> None:
    report = read_scene_with_report("two.obj")
    scene = edited(report, SceneSource("two.obj", settings=settings))
    assert scene.equals(with_settings(report.scene, settings))


def test_a_view_and_lights_that_the_scene_gives_stay_where_they_are(folder: Path) -> None:
    path = folder / "scene" / "scene.toml"
    path.write_text(path.read_text() + "[view]\neye = [1, -4, 2]\ntarget = [0, 0, 0]\n")
    first = read_scene_with_report("scene").scene
    scene = edited_mesh("parts.side.stage=true", "view.field_of_view=10", scene="scene", size=(30, 60))
    assert (scene.view, scene.lights) == (first.view.replace(field_of_view=10), first.lights)
