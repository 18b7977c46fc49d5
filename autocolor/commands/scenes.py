"""What the commands share about scenes: reading one, with a word on what was repaired."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

if TYPE_CHECKING:
    from autocolor.files.scenes.scene_report import SceneReport

Command = TypeVar("Command", bound=Callable[..., Any])

REPAIRED: Final = 1
"""The exit code for a thing done with something skipped or repaired, under --strict."""


def scene_options(command: Command) -> Command:
    """The argument and the options of a command that reads a scene."""
    for decorate in (
        click.option(
            "--strict", is_flag=True, help="End with exit code 1 if anything was repaired or skipped."
        ),
        click.option(
            "--up",
            type=click.Choice(["x", "y", "z"]),
            default="z",
            show_default=True,
            help="The up axis of a bare mesh file; a scene file says its own.",
        ),
        click.argument("scene", type=click.Path()),
    ):
        command = decorate(command)
    return command


def read(path: str, up: str) -> SceneReport:
    """The scene of a path, with a line on stderr for each thing that was repaired."""
    from autocolor.files.scene_sources import read_scene_with_report

    report = read_scene_with_report(path, up=up)
    for repair in report.repairs:
        click.echo(f"autocolor: {repair}", err=True)
    return report


def ended(report: SceneReport, strict: bool) -> int:
    """The exit code of a command that did what it was asked."""
    return REPAIRED if strict and report.repairs else 0
