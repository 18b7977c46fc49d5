"""`autocolor convert`: write a mesh or a scene in another format."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import click

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
    if is_given and not context.resilient_parsing:
        click.echo("\n".join(format_lines()))
        context.exit()


@click.command(epilog=EXAMPLES)
@scene_options()
@click.argument("out", type=click.Path())
@click.option(
    "--to",
    metavar="FORMAT",
    help="Format of OUT, instead of the format of its ending; --formats lists the names.",
)
@click.option("--force", is_flag=True, help="Overwrite existing files.")
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


def format_lines() -> list[str]:
    """A line for each format: its name, the endings of its files, and whether it is read and written."""
    from autocolor.files.opening import FORMATS

    rows = []
    for each in sorted(FORMATS, key=lambda each: each.name.casefold()):
        folder = [f"a folder of {', '.join(each.in_folder)}"] if each.in_folder else []
        endings = " ".join([*each.suffixes, *folder])
        rows.append((each.name, endings, "read, written" if each.write else "read"))
    name_width, ending_width = (max(len(row[column]) for row in rows) for column in (0, 1))
    return [f"{name:{name_width}}  {endings:{ending_width}}  {uses}" for name, endings, uses in rows]
