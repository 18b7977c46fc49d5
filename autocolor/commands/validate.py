"""`autocolor validate`: list every problem of a scene."""

from __future__ import annotations

import json
from typing import Final

import click

from autocolor.commands.scenes import SceneSource, ended, read, scene_options
from autocolor.errors import InputError

EXAMPLES: Final = """\b
Examples:
  autocolor validate scenes/coupe
  autocolor validate car.obj --strict --json
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_context
def validate(context: click.Context, source: SceneSource, as_json: bool) -> None:
    """List every problem of SCENE and every repair. The exit code is 65 if there is a problem."""
    try:
        report = read(source)
    except InputError as error:
        if as_json:
            click.echo(json.dumps({"problems": error.problems, "repairs": []}, indent=2))
        raise
    if as_json:
        click.echo(json.dumps({"problems": [], "repairs": report.repairs}, indent=2))
    else:
        click.echo(f"{source.path}: no problem")
    context.exit(ended(report, source))
