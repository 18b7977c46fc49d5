from __future__ import annotations

from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from autocolor.commands.scenes import SceneSource, created_again, ended, read, reframed, scene_options
from autocolor.commands.settings import with_settings
from autocolor.errors import InputError, MissingInputError
from autocolor.files.scene_report import SceneReport
from autocolor.files.scene_sources import read_scene_with_report
from autocolor.scene.defaults import default_lights, framed
from tests.autocolor.commands.conftest import Run
from tests.small import wall_scene


@click.command
@scene_options
def echo(source: SceneSource) -> None:
    """Say what the options of a command are."""
    click.echo(" ".join(map(str, source)))


def said(*arguments: str) -> str:
    return CliRunner().invoke(echo, arguments).output


def test_a_command_takes_a_scene_an_up_axis_a_scale_where_surfaces_come_from_and_whether_to_be_strict() -> (
    None
):
    assert said("car.obj") == "car.obj z materials False 1.0\n"
    assert said("--up", "y", "car.obj", "--strict") == "car.obj y materials True 1.0\n"
    assert said("--surfaces", "parts", "car.obj") == "car.obj z parts False 1.0\n"
    assert said("--scale", "0.001", "car.obj") == "car.obj z materials False 0.001\n"


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("a.obj", "b.obj"),
        ("a.obj", "--up", "Z"),
        ("a.obj", "--up"),
        ("a.obj", "--scale", "x"),
        ("a.obj", "--surfaces", "Parts"),
    ],
)
def test_other_arguments_are_wrong_usage(arguments: tuple[str, ...]) -> None:
    assert CliRunner().invoke(echo, arguments).exit_code == 2


@pytest.mark.parametrize("command", ["render", "show --recover --to tcp://127.0.0.1:1"])
@pytest.mark.parametrize(("option", "value"), [("--up", "y"), ("--scale", "0.001")])
def test_an_up_axis_and_a_scale_come_with_a_scene(command: str, option: str, value: str, run: Run) -> None:
    refused = run(*command.split(), option, value)
    assert refused.code == 2
    assert refused.err == (
        f"autocolor: {option} must come with a mesh file as SCENE; name a file, or leave {option} out\n"
    )


def test_a_scene_is_read_without_a_word_where_nothing_is_repaired(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert read(SceneSource("scene")).scene.name == "scene"
    assert tuple(capsys.readouterr()) == ("", "")


def test_each_repair_is_a_line_on_stderr(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "two.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\nl 1 2\n")
    report = read(SceneSource("two.obj"))
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines() == [f"autocolor: {repair}" for repair in report.repairs]
    assert len(report.repairs) == 2


def test_the_up_axis_is_that_of_the_mesh_file(folder: Path) -> None:
    above = read(SceneSource("two.obj", "y")).scene.mesh.coordinates
    assert above[2].tolist() == [1, -1, 0]


def test_the_scale_is_a_factor_for_the_coordinates_of_the_mesh_file(folder: Path) -> None:
    larger = read(SceneSource("two.obj", scale=25.4)).scene.mesh.coordinates
    assert larger[2].tolist() == (read(SceneSource("two.obj")).scene.mesh.coordinates[2] * 25.4).tolist()


def test_what_cannot_be_read_is_refused_and_not_told(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "bad.obj").write_text("v 0\n")
    with pytest.raises(InputError):
        read(SceneSource("bad.obj"))
    with pytest.raises(MissingInputError):
        read(SceneSource("none.obj"))
    assert tuple(capsys.readouterr()) == ("", "")


@pytest.mark.parametrize(
    ("repairs", "strict", "code"),
    [((), False, 0), ((), True, 0), (("a repair",), False, 0), (("a repair",), True, 1)],
)
def test_only_strict_makes_a_repair_an_exit_code(repairs: tuple[str, ...], strict: bool, code: int) -> None:
    assert ended(SceneReport(wall_scene(), repairs), SceneSource("wall", strict=strict)) == code


@pytest.mark.parametrize("command", ["render", "view", "info", "validate", "show", "tables"])
def test_every_command_that_reads_a_scene_takes_the_same_options(run: Run, command: str) -> None:
    shown = run(command, "--help").out
    for option in ("SCENE", "--up [x|y|z]", "--scale FACTOR", "--surfaces [materials|parts]", "--strict"):
        assert option in shown


def test_a_created_view_frames_what_is_left_when_a_part_becomes_stage(folder: Path) -> None:
    report = read_scene_with_report("two.obj")
    edited = created_again(report, with_settings(report.scene, ("parts.side.stage=true",)))
    alone = framed(report.scene.view, edited.object_coordinates)
    assert edited.view == alone != report.scene.view
    assert edited.lights == default_lights(edited.object_coordinates, alone) != report.scene.lights


def test_a_created_view_with_another_field_of_view_still_frames_the_object(folder: Path) -> None:
    report = read_scene_with_report("two.obj")
    edited = created_again(report, with_settings(report.scene, ("view.field_of_view=10",)))
    assert edited.view == framed(edited.view, edited.object_coordinates)
    assert edited.lights == report.scene.lights


def test_a_created_view_frames_the_object_in_a_picture_of_any_shape(folder: Path) -> None:
    report = read_scene_with_report("two.obj")
    assert reframed(report, 640 / 480) is report
    narrow = reframed(report, 0.5)
    coordinates = report.scene.object_coordinates
    assert narrow.scene.view == framed(report.scene.view, coordinates, 0.5) != report.scene.view
    edited = created_again(narrow, with_settings(narrow.scene, ("view.field_of_view=10",)), 0.5)
    assert edited.view == framed(edited.view, coordinates, 0.5)
    given = read_scene_with_report("scene")
    assert given.is_view_created or reframed(given, 0.5) is given


@pytest.mark.parametrize(
    ("source", "settings"),
    [
        ("two.obj", ("view.eye=[1, -5, 2]", "view.target=[0, 0, 0]", "view.field_of_view=10")),
        ("two.obj", ("ambient=0.5", "lights.key.intensity=2")),
        ("two.obj", ()),
    ],
)
def test_what_was_set_is_kept_as_it_is(folder: Path, source: str, settings: tuple[str, ...]) -> None:
    report = read_scene_with_report(source)
    edited = with_settings(report.scene, settings)
    assert created_again(report, edited) is edited


def test_a_view_and_lights_that_the_scene_gives_stay_where_they_are(folder: Path) -> None:
    path = folder / "scene" / "scene.toml"
    path.write_text(path.read_text() + "[view]\neye = [1, -4, 2]\ntarget = [0, 0, 0]\n")
    report = read_scene_with_report("scene")
    settings = ("parts.side.stage=true", "view.field_of_view=10")
    edited = with_settings(report.scene, settings)
    assert created_again(report, edited) is edited
