"""Reading a scene for a command: the common options, messages about repairs, and the exit code."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import click

from autocolor.commands.completion import complete_scenes
from autocolor.commands.options import verbose_option

if TYPE_CHECKING:
    from autocolor.files.scene_report import SceneReport
    from autocolor.scene.creation import SurfaceSource

REPAIRED: Final = 1
"""The exit code of a command that succeeds with --strict although something was skipped or repaired."""


class SceneSource(NamedTuple):
    """What a command reads a scene from, and how: what `scene_options` asks for."""

    path: str
    up: str = "z"
    surfaces: SurfaceSource = "materials"
    strict: bool = False
    scale: float = 1.0


def scene_options(command: Callable[..., Any], required: bool = True) -> Callable[..., Any]:
    """A decorator that adds the argument and options of commands that read a scene.

    The command gets them as one value, `source`, a SceneSource; None if none is named and none `required`.
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
        source = None if scene is None else SceneSource(scene, up, surfaces, strict, scale)
        return command(*arguments, source=source, **options)

    decorated: Callable[..., Any] = with_source
    for decorate in (
        verbose_option,
        click.option("--strict", is_flag=True, help="Exit with code 1 if anything was repaired or skipped."),
        click.option(
            "--up",
            type=click.Choice(["x", "y", "z"]),
            default="z",
            show_default=True,
            help="Up axis of a mesh file; scene files give their own.",
        ),
        click.option(
            "--scale",
            type=float,
            default=1.0,
            metavar="FACTOR",
            help="Factor for the coordinates of a mesh file, as 0.001 for one in millimeters.",
        ),
        click.option(
            "--surfaces",
            type=click.Choice(["materials", "parts"]),
            default="materials",
            show_default=True,
            help="Where surfaces that are not given come from: materials of the mesh, or one for each part.",
        ),
        click.argument("scene", type=click.Path(), required=required, shell_complete=complete_scenes),
    ):
        decorated = decorate(decorated)
    return decorated


def read(source: SceneSource) -> SceneReport:
    """Read a scene, and print a line on stderr for each repair."""
    from autocolor.files.scene_sources import read_scene_with_report

    report = read_scene_with_report(source.path, up=source.up, scale=source.scale, surfaces=source.surfaces)
    for repair in report.repairs:
        click.echo(f"autocolor: {repair}", err=True)
    return report


def ended(report: SceneReport, source: SceneSource) -> int:
    """The exit code of a command that succeeded."""
    return REPAIRED if source.strict and report.repairs else 0
