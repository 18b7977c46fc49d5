"""`autocolor convert`: write a mesh or a scene in another format."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import click

from autocolor.commands.options import force_option, option
from autocolor.commands.outputs import tell_written
from autocolor.commands.scenes import REPAIRED, SceneSource, ended, read, scene_options
from autocolor.errors import UsageError
from ramtek_emu.command_line import tell

EXAMPLES: Final = """\b
Examples:
  autocolor convert car.ply car.obj                 with the materials in car.mtl
  autocolor convert bracket.vtk bracket.ply         with its scalars
  autocolor convert car.stl car --up y --scale 0.001
                                                    a scene, in the folder car
  autocolor convert scenes/coupe coupe.csv          tables, in the folder coupe.csv
  autocolor convert car.obj tables --to npy         tables that are mapped into memory, not read
  autocolor convert --formats                       list the formats
"""


def _show_formats(context: click.Context, _: click.Parameter, is_given: bool) -> None:
    """List the formats: the names, whether each is read and written, and the endings of its files."""
    if not is_given or context.resilient_parsing:
        return
    from autocolor.files.opening import FORMATS

    rows = []
    for each in sorted(FORMATS, key=lambda each: each.name.casefold()):
        folder = [f"a folder of {', '.join(each.in_folder)}"] if each.in_folder else []
        rows.append(
            (each.name, " ".join(["read, written:" if each.write else "read:", *each.suffixes, *folder]))
        )
    formatter = click.HelpFormatter(width=110)
    formatter.write_dl(rows)
    click.echo(formatter.getvalue(), nl=False)
    context.exit()


@click.command(epilog=EXAMPLES)
@scene_options()
@click.argument("out", type=click.Path())
@option(
    "--to", "FORMAT", "Format of OUT, instead of the format of its ending; --formats lists the names.", str
)
@force_option
@click.option(
    "--formats",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_show_formats,
    help="List the formats that are read and written, and exit.",
)
def convert(source: SceneSource, out: str, to: str | None, force: bool) -> int:
    """Write SCENE, a mesh or a whole scene, to OUT; the ending of OUT determines the format.

    Without an ending, OUT becomes a scene folder. Anything that OUT's format cannot hold is left out and
    listed; with --strict the exit code is then 1.
    """
    if out in ("", "-"):
        raise UsageError(f"OUT must be a file or a folder, not {out!r}; give it a name")
    from autocolor.files.opening import left_out, output_named, output_of, source_format
    from autocolor.files.writing import refuse_output

    path = Path(out)
    output = output_of(path) if to is None else output_named(to)
    if not output.in_folder:
        # Fail before reading if OUT cannot be written.
        refuse_output(path, overwrite=force)
    report = read(source)
    is_bare = bool(source_format(Path(source.path))[1].keys)
    assert output.write is not None
    written = output.write(path, report.scene, force)
    lost = left_out(report.scene, output, is_bare=is_bare)
    for phrase in lost:
        tell(f"autocolor: {path.name}: left out, as {output.name} cannot hold it: {phrase}")
    tell_written(*map(str, written))
    return REPAIRED if source.strict and lost else ended(report, source)
