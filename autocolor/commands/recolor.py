"""`autocolor recolor`: change the colors of a saved picture; nothing is rendered."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any, Final

import click

from autocolor.commands.outputs import refuse_outputs, tell_written, write_png

EXAMPLES: Final = """\b
Examples:
  autocolor render scenes/coupe --save coupe.npz
  autocolor recolor coupe.npz body --object "#1f3f8f" -o blue.png
  autocolor recolor coupe.npz body --source "#ffe9c0" --blend 0 -o metallic.png
"""


@click.command(epilog=EXAMPLES)
@click.argument("picture", type=click.Path())
@click.argument("surface")
@click.option("--object", "object_color", metavar="COLOR", help='Object color, "#rrggbb".')
@click.option("--source", "light_color", metavar="COLOR", help='Light source color, "#rrggbb".')
@click.option(
    "--blend",
    type=float,
    metavar="FRACTION",
    help="Level above which the light color begins, 0 to 1; 1 for never.",
)
@click.option(
    "--percentage",
    type=float,
    metavar="PERCENT",
    help="Share of the light color at the highest level, 0 to 100.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(),
    metavar="PNG",
    help="PNG file to write; without -o and --save, PICTURE-SURFACE.png.",
)
@click.option(
    "--save", type=click.Path(), metavar="PICTURE.npz", help="Save the picture with the new colors."
)
@click.option("--force", is_flag=True, help="Overwrite existing files.")
def recolor(
    picture: str,
    surface: str,
    object_color: str | None,
    light_color: str | None,
    blend: float | None,
    percentage: float | None,
    output: str | None,
    save: str | None,
    force: bool,
) -> None:
    """Change the colors of SURFACE in PICTURE, a picture file, without rendering it again."""
    if output is None and save is None:
        from autocolor.files.file_stem import file_stem

        output = f"{Path(picture).stem}-{file_stem(surface)}.png"
    refuse_outputs(output, save, force)

    from autocolor.files.picture_file import read_picture, write_picture
    from autocolor.sending import send_picture
    from ramtek_emu import GMR_9300, Ramtek9300

    saved = read_picture(picture)
    changes: dict[str, Any] = {
        "object_color": object_color,
        "light_color": light_color,
        "blend": blend,
        "light_percentage": percentage,
    }
    scene = saved.scene.with_surface(
        surface, **{name: value for name, value in changes.items() if value is not None}
    )
    if save is not None:
        write_picture(save, saved.picture, scene, overwrite=force)
    if output is not None:
        lines, elements = saved.picture.lines, saved.picture.elements
        display = Ramtek9300(dataclasses.replace(GMR_9300, lines=lines, elements=elements))
        send_picture(scene, saved.picture, display)
        write_png(output, display, force)
    tell_written(output, save)
