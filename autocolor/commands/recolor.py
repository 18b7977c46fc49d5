"""`autocolor recolor`: change the colors of a saved picture; nothing is rendered."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from autocolor.commands.completion import complete_colors, complete_surfaces
from autocolor.commands.options import force_option, limit_option, option, verbose_option
from autocolor.commands.outputs import refuse_outputs, tell_written
from autocolor.commands.scenes import set_option
from autocolor.errors import InputError, UsageError

if TYPE_CHECKING:
    from autocolor.checks import Color

EXAMPLES: Final = """\b
Examples:
  autocolor render scenes/coupe --save coupe.npz
  autocolor recolor coupe.npz body --object "#1f3f8f" -o blue.png
  autocolor recolor coupe.npz body --object navy --source "#ffe9c0" --blend 0 -o metallic.png
  autocolor recolor coupe.npz body --ramp "#200,#f60,#fff" -o glowing.png
  autocolor recolor coupe.npz body --palette body.gpl
  autocolor recolor bracket.npz --set scalar.scale=turbo --set scalar.limits=[0,200] -o stress.png
"""


@click.command(epilog=EXAMPLES)
@click.argument("picture", type=click.Path())
@click.argument("surface", required=False, shell_complete=complete_surfaces)
@option(
    "--object --object-color object_color",
    "COLOR",
    'Object color: "#rrggbb", or a name.',
    str,
    shell_complete=complete_colors,
)
@option(
    "--source --light-color light_color",
    "COLOR",
    'Light source color: "#rrggbb", or a name.',
    str,
    shell_complete=complete_colors,
)
@option(
    "--blend", "FRACTION", "Level above which the light color blends in, 0 to 1; 1 for no blending.", float
)
@option(
    "--percentage light_percentage",
    "PERCENT",
    "Share of the light color at the highest level, 0 to 100.",
    float,
)
@option(
    "--ramp",
    "COLORS",
    "Colors at equal distances from the lowest level to the highest, such as #200,#f60,#fff; instead of"
    " the two colors and their blend.",
    str,
)
@option(
    "--palette",
    "FILE",
    "Take the colors of a .gpl or .csv file as the ramp, such as a file of `autocolor palette`.",
)
@set_option
@option("-o --output", "PNG", "PNG file to write. Default, without --save: PICTURE-SURFACE.png.")
@option("--save", "PICTURE.npz", "Save the picture with the new colors.")
@force_option
@limit_option
@verbose_option
def recolor(
    picture: str,
    surface: str | None,
    palette: str | None,
    settings: tuple[str, ...],
    output: str | None,
    save: str | None,
    force: bool,
    **colors: Any,
) -> None:
    """Change the colors of SURFACE in PICTURE, a picture file, without rendering it again.

    Edges are as smooth as `--smooth` of `render` made them.

    --set changes any field that needs no rendering: paints, the mapping, and the color scale, limits and
    bands of a scalar.
    """
    from autocolor.commands.settings import recolored
    from autocolor.files.opening import is_picture
    from autocolor.files.paths import file_stem
    from autocolor.files.picture_file import read_picture, write_picture
    from autocolor.images import save_image
    from autocolor.logs import logger_of, timed

    given = {name: value for name, value in colors.items() if value is not None}
    if surface is None and (given or palette is not None or not settings):
        raise UsageError(
            "recolor must have a SURFACE, or --set KEY=VALUE without colors; write it as in recolor PICTURE"
            " body --object navy"
        )
    if not is_picture(Path(picture)):
        raise InputError(
            f"recolor must have a picture file, not {picture}; make one with `autocolor render SCENE --save"
            " FILE.npz`"
        )
    if output is None and save is None:
        output = f"{Path(picture).stem}-{file_stem(surface or 'recolored')}.png"
    refuse_outputs({"-o": output, "--save": save}, force)
    if palette is not None:
        if given:
            raise UsageError("--palette gives all colors of a surface; leave the other options of colors out")
        given["ramp"] = ramp_of_file(palette)
    logger = logger_of(__name__)
    with timed(logger, f"read {picture}"):
        saved = read_picture(picture)
    logger.info("%r", saved.picture)
    scene = recolored(saved.scene, surface, given, settings)
    if save is not None:
        write_picture(save, scene, saved.picture, overwrite=force)
    if output is not None:
        with timed(logger, "image written"):
            save_image(output, scene, saved.picture, overwrite=force)
    tell_written(output, save)


def ramp_of_file(path: str) -> tuple[Color, ...]:
    """The colors of a palette file. Raises InputError if their number cannot make a ramp."""
    from autocolor.files.palette_file import read_palette
    from autocolor.scene.surfaces import MOST_RAMP_COLORS

    colors = read_palette(path).colors
    if not 2 <= len(colors) <= MOST_RAMP_COLORS:
        advice = "choose some of them" if len(colors) > 1 else "use --object for a single color"
        rule = f"a ramp must have 2 to {MOST_RAMP_COLORS:,} colors"
        raise InputError(f"{Path(path).name}: {rule}, not {len(colors):,}; {advice}")
    return colors
