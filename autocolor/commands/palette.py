"""`autocolor palette`: write the entries of a surface's range to a palette file."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import click

from autocolor.commands.completion import complete_surfaces
from autocolor.commands.options import force_option, option
from autocolor.commands.outputs import tell_written
from autocolor.commands.scenes import SceneSource, scene_in, scene_options, start_of

EXAMPLES: Final = """\b
Examples:
  autocolor palette coupe.npz body -o body.gpl
  autocolor palette scenes/coupe tires -o tires.csv
  autocolor palette scenes/bracket bracket --set scalar.name=stress -o stress.csv
  autocolor recolor coupe.npz body --palette body.gpl
"""


@click.command(epilog=EXAMPLES)
@scene_options("settings")
@click.argument("surface", shell_complete=complete_surfaces)
@option(
    "-o --output",
    "FILE",
    "File to write: a GIMP palette (.gpl) or a table (.csv). Default: SCENE-SURFACE.gpl.",
)
@force_option
def palette(source: SceneSource, surface: str, output: str | None, force: bool) -> int:
    """Write the lookup table entries of SURFACE to a palette file, from its lowest level up.

    SCENE may be a picture file, which needs no rendering. Any other scene is rendered in the size of the
    display. With `recolor --palette` the colors become a ramp of the surface.
    """
    from autocolor.files.palette_file import check_palette_path, write_palette
    from autocolor.files.paths import file_stem
    from autocolor.files.writing import refuse_output
    from autocolor.images import display_image

    if output is None:
        output = f"{file_stem(Path(source.path).stem)}-{file_stem(surface)}.gpl"
    check_palette_path(Path(output))
    refuse_output(output, overwrite=force)
    source = source._replace(smooth=1)
    start, code = start_of(source)
    scene = scene_in(start)
    # A wrong name is refused before the picture is rendered.
    scene.surfaces[surface]
    picture = start.picture if isinstance(start, tuple) else source.rendered(scene)
    write_palette(output, display_image(scene, picture).entries_of(surface), overwrite=force)
    tell_written(output)
    return code
