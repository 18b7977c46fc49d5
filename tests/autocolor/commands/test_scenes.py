from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.commands.scenes import SceneSource, created_again, ended, read, reframed
from autocolor.commands.settings import with_settings
from autocolor.files.opening import read_scene_with_report
from autocolor.files.scene_report import SceneReport
from autocolor.scene.defaults import default_lights, framed
from tests.autocolor.commands.conftest import Refused
from tests.small import wall_scene


@pytest.mark.parametrize("command", ["render", "show --recover --to tcp://127.0.0.1:1"])
@pytest.mark.parametrize("option", ["--up", "--scale"])
def test_an_up_axis_and_a_scale_come_with_a_scene(command: str, option: str, refused: Refused) -> None:
    value = "y" if option == "--up" else "0.001"
    assert refused(f"{command} {option} {value}", 2) == (
        f"{option} must come with a mesh file as SCENE; name a file, or leave {option} out"
    )


def test_each_repair_is_a_line_on_stderr(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert read(SceneSource("two.obj")).repairs == ()
    assert tuple(capsys.readouterr()) == ("", "")
    (folder / "two.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\nl 1 2\n")
    report = read(SceneSource("two.obj"))
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines() == [f"autocolor: {repair}" for repair in report.repairs]
    assert len(report.repairs) == 2


@pytest.mark.parametrize(
    ("repairs", "strict", "code"),
    [((), False, 0), ((), True, 0), (("a repair",), False, 0), (("a repair",), True, 1)],
)
def test_only_strict_makes_a_repair_an_exit_code(repairs: tuple[str, ...], strict: bool, code: int) -> None:
    assert ended(SceneReport(wall_scene(), repairs), SceneSource("wall", strict=strict)) == code
    assert ended(SceneReport(wall_scene(), repairs), None) == 0


# Views and lights that are created.


def edited(report: SceneReport, *settings: str) -> SceneReport:
    return SceneReport(created_again(report, with_settings(report.scene, settings)))


def test_a_created_view_frames_what_is_left_when_a_part_becomes_stage(folder: Path) -> None:
    report = read_scene_with_report("two.obj")
    scene = edited(report, "parts.side.stage=true").scene
    alone = framed(report.scene.view, scene.object_coordinates)
    assert scene.view == alone != report.scene.view
    assert scene.lights == default_lights(scene.object_coordinates, alone) != report.scene.lights
    # Lights that are set stay.
    scene = edited(report, "parts.side.stage=true", "lights.key.intensity=2").scene
    assert scene.lights == report.scene.with_light("key", intensity=2).lights


def test_a_created_view_with_another_field_of_view_still_frames_the_object(folder: Path) -> None:
    report = read_scene_with_report("two.obj")
    scene = edited(report, "view.field_of_view=10").scene
    assert scene.view == framed(scene.view, scene.object_coordinates)
    assert scene.view.eye != report.scene.view.eye
    assert scene.lights == report.scene.lights


def test_a_created_view_frames_the_object_in_a_picture_of_any_shape(folder: Path) -> None:
    report = read_scene_with_report("two.obj")
    assert reframed(report, 640 / 480) is report
    narrow = reframed(report, 0.5)
    coordinates = report.scene.object_coordinates
    assert narrow.scene.view == framed(report.scene.view, coordinates, 0.5) != report.scene.view
    again = created_again(narrow, with_settings(narrow.scene, ("view.field_of_view=10",)), 0.5)
    assert again.view == framed(again.view, coordinates, 0.5)


@pytest.mark.parametrize(
    "settings",
    [
        (),
        ("ambient=0.5", "lights.key.intensity=2"),
        ("view.eye=[1, -5, 2]", "view.field_of_view=10"),
        ("view.target=none", "view.direction=[0, 1, 0]", "view.field_of_view=10"),
        ("view.target=[0, 0, 0]", "view.field_of_view=10"),
    ],
)
def test_what_was_set_is_kept_as_it_is(folder: Path, settings: tuple[str, ...]) -> None:
    report = read_scene_with_report("two.obj")
    scene = with_settings(report.scene, settings)
    assert created_again(report, scene) is scene


def test_a_view_and_lights_that_the_scene_gives_stay_where_they_are(folder: Path) -> None:
    path = folder / "scene" / "scene.toml"
    path.write_text(path.read_text() + "[view]\neye = [1, -4, 2]\ntarget = [0, 0, 0]\n")
    report = read_scene_with_report("scene")
    scene = with_settings(report.scene, ("parts.side.stage=true", "view.field_of_view=10"))
    assert created_again(report, scene) is scene
    assert reframed(report, 0.5) is report
