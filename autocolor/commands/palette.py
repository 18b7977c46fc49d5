"""`autocolor palette`: write the entries of a surface's range to a palette file."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import click

from autocolor.commands.completion import complete_surfaces
from autocolor.commands.outputs import tell_written
from autocolor.commands.scenes import SceneSource, scene_options, set_option
from autocolor.commands.sweep import scene_in, start_of

EXAMPLES: Final = """\b
Examples:
  autocolor palette coupe.npz body -o body.gpl
  autocolor palette scenes/coupe tires -o tires.csv
  autocolor palette scenes/bracket bracket --set scalar.name=stress -o stress.csv
  autocolor recolor coupe.npz body --palette body.gpl
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.argument("surface", shell_complete=complete_surfaces)
@set_option
@click.option(
    "-o",
    "--output",
    type=click.Path(),
    metavar="FILE",
    help="File to write: a GIMP palette (.gpl) or a table (.csv). Default: SCENE-SURFACE.gpl.",
)
@click.option("--force", is_flag=True, help="Overwrite an existing file.")
@click.pass_context
def palette(
    context: click.Context,
    source: SceneSource,
    surface: str,
    settings: tuple[str, ...],
    output: str | None,
    force: bool,
) -> None:
    """Write the lookup table entries of SURFACE to a palette file, from its lowest level up.

    SCENE may be a picture file, which needs no rendering. Any other scene is rendered in the size of the
    display. With `recolor --palette` the colors become a ramp of the surface.
    """
    from autocolor.files.palette_file import check_palette_path, write_palette
    from autocolor.files.paths import file_stem
    from autocolor.files.writing import refuse_output
    from autocolor.images import display_image
    from autocolor.rendering import render

    if output is None:
        output = f"{file_stem(Path(source.path).stem)}-{file_stem(surface)}.gpl"
    check_palette_path(Path(output))
    refuse_output(output, overwrite=force)
    start, code = start_of(source, settings, (640, 480))
    scene = scene_in(start)
    # A wrong name is refused before the picture is rendered.
    scene.surface(surface)
    picture = start.picture if isinstance(start, tuple) else render(scene)
    write_palette(output, display_image(scene, picture).entries_of(surface), overwrite=force)
    tell_written(output)
    context.exit(code)
