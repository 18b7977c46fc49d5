"""Scenes of commands: options for reading, messages about repairs, created views and lights, exit codes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import click
from click.core import ParameterSource

from autocolor.commands.completion import complete_scenes, complete_settings
from autocolor.commands.options import limit_option, print_log, verbose_option
from autocolor.errors import UsageError
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from autocolor.files.scene_report import SceneReport
    from autocolor.scene.creation import SurfaceSource
    from autocolor.scene.scene import Scene

REPAIRED: Final = 1
"""The exit code with --strict of a command that succeeds, if input was skipped or repaired."""


class SceneSource(NamedTuple):
    """The path of a scene, and how to read it: the values of `scene_options`."""

    path: str
    up: str = "z"
    surfaces: SurfaceSource = "materials"
    strict: bool = False
    scale: float = 1.0


def scene_options(command: Callable[..., Any], required: bool = True) -> Callable[..., Any]:
    """A decorator that adds the argument and options of commands that read a scene.

    The command gets them as its argument `source`, a SceneSource. It is None if the command line has no
    scene, which is an error if `required`.
    """

    @wraps(command)
    def with_source(
        *arguments: Any,
        scene: str | None,
        up: str,
        scale: float,
        surfaces: SurfaceSource,
        strict: bool,
        **options: Any,
    ) -> Any:
        for option, is_given in (("--up", up != "z"), ("--scale", scale != 1)):
            if scene is None and is_given:
                raise UsageError(
                    f"{option} must come with a mesh file as SCENE; name a file, or leave {option} out"
                )
        source = None if scene is None else SceneSource(scene, up, surfaces, strict, scale)
        return command(*arguments, source=source, **options)

    decorated: Callable[..., Any] = with_source
    for decorate in (
        verbose_option,
        limit_option,
        click.option("--strict", is_flag=True, help="Exit with code 1 if input was repaired or skipped."),
        click.option(
            "--up",
            type=click.Choice(["x", "y", "z"]),
            default="z",
            show_default=True,
            help="Up axis of a mesh file; a scene file has its own.",
        ),
        click.option(
            "--scale",
            type=float,
            default=1.0,
            metavar="FACTOR",
            help="Factor for the coordinates of a mesh file, such as 0.001 for millimeters.",
        ),
        click.option(
            "--surfaces",
            type=click.Choice(["materials", "parts"]),
            default="materials",
            show_default=True,
            help="Create a missing surface for each material of the mesh, or for each part.",
        ),
        click.argument("scene", type=click.Path(), required=required, shell_complete=complete_scenes),
    ):
        decorated = decorate(decorated)
    return decorated


set_option = click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    shell_complete=complete_settings,
    help="Set a field of the scene, such as lights.key.intensity=2, with the names of scene.toml; the value"
    " none unsets a field; repeatable.",
)


def read(source: SceneSource | None) -> SceneReport:
    """Read a scene, by default the built-in demo; print a line on stderr for each repair and each warning."""
    if context := click.get_current_context(silent=True):
        print_log(context)
    if source is None:
        from autocolor.commands.demo import demo_report

        return demo_report()
    from autocolor.files.opening import read_scene_with_report

    report = read_scene_with_report(source.path, up=source.up, scale=source.scale, surfaces=source.surfaces)
    tell(*(f"autocolor: {repair}" for repair in report.repairs))
    return report


def tell_up(report: SceneReport, source: SceneSource | None) -> None:
    """Print a line on stderr if the mesh seems to lie on its side, unless the user gave `--up`."""
    from autocolor.files.opening import hinted_up

    context = click.get_current_context(silent=True)
    is_given = context is not None and context.get_parameter_source("up") is ParameterSource.COMMANDLINE
    if source is None:
        return
    if up := "" if is_given else hinted_up(source.path, report.scene.mesh):
        tell(f"autocolor: {source.path} seems to lie on its side; try --up {up}, or give --up z")


def ended(report: SceneReport, source: SceneSource | None) -> int:
    """The exit code of a command that succeeded."""
    return REPAIRED if source is not None and source.strict and report.repairs else 0


def reframed(report: SceneReport, aspect: float) -> SceneReport:
    """The report; a created view frames the object for a picture of an aspect, its width over its height."""
    from autocolor.scene.defaults import framed
    from autocolor.scene.view import ASPECT

    scene = report.scene
    if not report.is_view_created or aspect == ASPECT:
        return report
    view = framed(scene.view, scene.object_coordinates, aspect)
    return dataclasses.replace(report, scene=scene.replace(view=view))


def read_edited(
    source: SceneSource | None,
    settings: tuple[str, ...],
    size: tuple[int, int],
    prepared: Callable[[Scene], Scene] = lambda scene: scene,
) -> tuple[Scene, SceneReport]:
    """The scene of a source with `--set`, for pictures of a size, and the report of what was read.

    The scene is `prepared` before it is edited.
    """
    from autocolor.commands.settings import with_settings

    elements, lines = size
    report = reframed(read(source), elements / lines)
    tell_up(report, source)
    edited = with_settings(prepared(report.scene), settings)
    return created_again(report, edited, elements / lines), report


def created_again(report: SceneReport, edited: Scene, aspect: float | None = None) -> Scene:
    """The edited scene of a report; if the edits affect its created view or lights, they are created again.

    An edit of the view or of `stage` of a part makes a created view frame the object again, unless it sets
    the eye, the direction or the target. An edit of `stage` makes created lights be created again. `aspect`
    is the aspect of the picture, by default the display's.
    """
    from autocolor.scene.defaults import default_lights, framed
    from autocolor.scene.view import ASPECT

    original = report.scene
    is_same_object = [part.stage for part in original.parts] == [part.stage for part in edited.parts]
    before, view = original.view, edited.view
    is_placed = (before.eye, before.direction, before.target) != (view.eye, view.direction, view.target)
    if report.is_view_created and not is_placed and not (is_same_object and before == view):
        edited = edited.replace(view=framed(view, edited.object_coordinates, aspect or ASPECT))
    if report.are_lights_created and not is_same_object and edited.lights == original.lights:
        edited = edited.replace(lights=default_lights(edited.object_coordinates, edited.view))
    return edited
