"""`autocolor validate`: list every problem of a scene and every fault of its mesh."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.outputs import refuse_outputs, tell_written, write_png
from autocolor.commands.scenes import REPAIRED, SceneSource, ended, read, scene_options
from autocolor.errors import InputError, UsageError

if TYPE_CHECKING:
    from autocolor.scene.scene import Scene

EXAMPLES: Final = """\b
Examples:
  autocolor validate scenes/coupe
  autocolor validate car.obj --strict --json
  autocolor validate car.obj --show                  color the faults in a window
  autocolor validate car.obj --show -o faults.png    or in a PNG file
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option("--json", "as_json", is_flag=True, help="Print JSON, with all rows.")
@click.option("--show", "shows", is_flag=True, help="Show the faults of the mesh in color, in a window.")
@click.option("-o", "--output", type=click.Path(), metavar="PNG", help="With --show, write a PNG instead.")
@click.option("--force", is_flag=True, help="Overwrite an existing PNG.")
@click.pass_context
def validate(
    context: click.Context,
    source: SceneSource,
    as_json: bool,
    shows: bool,
    output: str | None,
    force: bool,
) -> None:
    """List every problem of SCENE, every repair, and every fault of its mesh, with its rows from 1 on.

    The exit code is 65 if there is a problem. A fault keeps nothing from being rendered: it makes the exit
    code 1 with --strict, as a repair does.
    """
    if output is not None and not shows:
        raise UsageError("-o is for --show; add that")
    refuse_outputs(output, None, force)
    try:
        report = read(source)
    except InputError as error:
        if as_json:
            click.echo(json.dumps({"problems": error.problems, "repairs": [], "faults": []}, indent=2))
        raise
    from autocolor.commands.faults.fault_report import fault_lines, fault_values
    from autocolor.scene.geometry.faults.mesh_faults import mesh_faults

    faults = mesh_faults(report.scene.mesh)
    if as_json:
        told = {"problems": [], "repairs": report.repairs, "faults": fault_values(faults)}
        click.echo(json.dumps(told, indent=2))
    else:
        kinds = f"{len(faults)} kind{'s' if len(faults) > 1 else ''} of faults in its mesh"
        found = f"it can be rendered, with {kinds}" if faults else "no problem"
        click.echo("\n".join([f"{source.path}: {found}", *fault_lines(faults)]))
    if shows:
        from autocolor.commands.faults.fault_picture import fault_scene

        show_scene(fault_scene(report.scene, faults), output, force)
    context.exit(REPAIRED if source.strict and faults else ended(report, source))


def show_scene(scene: Scene, output: str | None, force: bool) -> None:
    """Show a scene in a window, or write what the display shows to a PNG file. Nothing is saved to it."""
    if output is None:
        from autocolor.commands.view import show
        from autocolor.journal.history import History

        show(History(scene))
        return
    from autocolor.studio import Studio
    from ramtek_emu import Ramtek9300

    display = Ramtek9300()
    Studio(scene, display)
    write_png(output, display, force)
    tell_written(output)
