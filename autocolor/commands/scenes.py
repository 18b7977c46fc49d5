"""What the commands share about scenes: reading one with a word on what was repaired, and `--set`."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from autocolor.files.scene_report import SceneReport
    from autocolor.scene import Scene

Command = TypeVar("Command", bound=Callable[..., Any])

REPAIRED = 1
"""The exit code for a thing done with something skipped or repaired, under --strict."""

LONGEST_VALUE = 10_000


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
        click.argument("scene"),
    ):
        command = decorate(command)
    return command


def read(path: str, up: str) -> SceneReport:
    """The scene of a path, with a line on stderr for each thing that was repaired."""
    from autocolor.files import read_scene_with_report

    report = read_scene_with_report(path, up=up)
    for repair in report.repairs:
        click.echo(f"autocolor: {repair}", err=True)
    return report


def ended(report: SceneReport, strict: bool) -> int:
    """The exit code of a command that did what it was asked."""
    return REPAIRED if strict and report.repairs else 0


def with_settings(scene: Scene, settings: tuple[str, ...]) -> Scene:
    """The scene with each KEY=VALUE set: `lights.key.intensity=2`, `view.angle=10`, `ambient=0.2`.

    A key is the path that it has in a scene file; a value is written as there, quotes may be left out.
    """
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals:
            raise click.UsageError(f"--set must be KEY=VALUE, not {setting!r}, as in lights.key.intensity=2")
        scene = _with_setting(scene, key.strip(), value_of(text.strip()))
    return scene


def value_of(text: str) -> Any:
    """A value as a scene file has it; what is none is a text.

    >>> value_of("2.5"), value_of("[1, 2]"), value_of("true"), value_of("#b01020")
    (2.5, [1, 2], True, '#b01020')
    """
    import tomllib

    # A color begins as a comment does, and a line break would begin another key.
    if text.startswith("#") or "\n" in text or not text or len(text) > LONGEST_VALUE or text.count("[") > 8:
        return text
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _with_setting(scene: Scene, key: str, value: Any) -> Scene:
    from autocolor.errors import UsageError

    table, _, rest = key.partition(".")
    if table == "view" and rest:
        return scene.with_view(**{rest: value})
    edit = {"lights": scene.with_light, "surfaces": scene.with_surface, "parts": scene.with_part}.get(table)
    if edit is None or not rest:
        if table in ("view", "lights", "surfaces", "parts", "mesh", "name"):
            raise UsageError(f"--set {key}: it must name a field, as in lights.key.intensity=2, not a table")
        return scene.replace(**{key: value})
    # A name may itself hold points: take the longest that the table has.
    names = [row.name for row in getattr(scene, table)]
    name = max((name for name in names if rest.startswith(f"{name}.")), key=len, default="")
    if not name:
        name = rest.partition(".")[0]
    field = rest[len(name) + 1 :]
    if not field:
        raise UsageError(f"--set {key}: it must name a field, as in {table}.{name}.FIELD=VALUE, not a row")
    if table == "lights" and field.startswith("flaps."):
        field, value = "flaps", _with_flap(scene, name, field.split("."), value)
    return edit(name, **{field: value})


def _with_flap(scene: Scene, name: str, path: list[str], value: Any) -> Any:
    """The flaps of a light with one field of one of them set, or one set whole."""
    if len(path) != 3:
        return {path[1]: value}
    flap = getattr(scene.light(name).flaps, path[1], None)
    return {path[1]: {**({} if flap is None else dataclasses.asdict(flap)), path[2]: value}}
