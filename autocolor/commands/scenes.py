"""Reading a scene for a command: the common options, messages about repairs, and the exit code."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from autocolor.commands.completion import complete_scenes
from autocolor.commands.verbosity import verbose_option

if TYPE_CHECKING:
    from autocolor.files.scenes.scene_report import SceneReport
    from autocolor.scene.creation import SurfaceSource

Command = TypeVar("Command", bound=Callable[..., Any])

REPAIRED: Final = 1
"""The exit code of a command that succeeds with --strict although something was skipped or repaired."""


def scene_options(command: Command) -> Command:
    """A decorator that adds the argument and options of commands that read a scene."""
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
            "--surfaces",
            type=click.Choice(["materials", "parts"]),
            default="materials",
            show_default=True,
            help="Where surfaces come from that are not given: materials of the mesh, or one for each part.",
        ),
        click.argument("scene", type=click.Path(), shell_complete=complete_scenes),
    ):
        command = decorate(command)
    return command


def read(path: str, up: str, surfaces: SurfaceSource) -> SceneReport:
    """Read a scene, and print a line on stderr for each repair."""
    from autocolor.files.scene_sources import read_scene_with_report

    report = read_scene_with_report(path, up=up, surfaces=surfaces)
    for repair in report.repairs:
        click.echo(f"autocolor: {repair}", err=True)
    return report


def ended(report: SceneReport, strict: bool) -> int:
    """The exit code of a command that succeeded."""
    return REPAIRED if strict and report.repairs else 0
