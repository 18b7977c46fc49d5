"""`autocolor render`: render a scene to a PNG or picture file, without a window."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.completion import complete_lights, complete_views
from autocolor.commands.options import (
    hold_option,
    normals_option,
    paper_option,
    size_option,
    smooth_option,
    with_held_exposure,
    with_normals,
)
from autocolor.commands.outputs import progress, refuse_outputs, tell_written, write_image
from autocolor.commands.scenes import SceneSource, ended, read_edited, scene_options, set_option

if TYPE_CHECKING:
    from autocolor.lighting.picture import Picture
    from autocolor.scene.scene import Scene

EXAMPLES: Final = """\b
Examples:
  autocolor render
  autocolor render scenes/coupe -o coupe.png --save coupe.npz
  autocolor render car.obj --up y
  autocolor render scenes/coupe --light key -o key.png
  autocolor render scenes/coupe --light key --hold-exposure -o key-alone.png
  autocolor render scenes/coupe --view hood -o hood.png
  autocolor render scenes/coupe --set lights.key.concentration=40 --set ambient=0.2
  autocolor render scenes/coupe --set surfaces.body.object_color=navy --size 1280x960 --smooth 4
  autocolor render scenes/coupe --layers coupe.exr --words coupe-words.png
"""


@click.command(epilog=EXAMPLES)
@partial(scene_options, required=False)
@click.option(
    "-o",
    "--output",
    type=click.Path(),
    metavar="PNG",
    help="PNG file to write. Default, without any other output: SCENE.png, or coupe.png.",
)
@click.option(
    "--save",
    type=click.Path(),
    metavar="PICTURE.npz",
    help="Save the picture with its scene, to recolor it later.",
)
@click.option(
    "--layers",
    type=click.Path(),
    metavar="FILE.exr",
    help="Write what compositors use: each light, depth, normals, positions, identities.",
)
@click.option(
    "--words",
    type=click.Path(),
    metavar="FILE.png",
    help="Write the words as 16-bit grays, with the lookup table.",
)
@click.option(
    "--indexed",
    type=click.Path(),
    metavar="FILE.png",
    help="Write the words in use, at most 256, as indices of a palette.",
)
@click.option(
    "--light",
    "lights",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_lights,
    help="Switch off all lights but this one; repeatable.",
)
@click.option(
    "--view",
    "view_name",
    metavar="NAME",
    shell_complete=complete_views,
    help="Render a named view of the scene.",
)
@set_option
@normals_option
@paper_option
@size_option
@smooth_option
@hold_option
@click.option("--force", is_flag=True, help="Overwrite existing files.")
@click.pass_context
def render(
    context: click.Context,
    source: SceneSource | None,
    output: str | None,
    save: str | None,
    layers: str | None,
    words: str | None,
    indexed: str | None,
    lights: tuple[str, ...],
    view_name: str | None,
    settings: tuple[str, ...],
    normals: bool,
    paper: bool,
    size: tuple[int, int],
    smooth: int | None,
    hold_exposure: bool,
    force: bool,
) -> None:
    """Render SCENE: a folder, a scene.toml, a mesh file or a picture file. Without SCENE, render the demo.

    --layers, --words and --indexed never average pixels. With any of these options, --smooth is 1 by default.
    With --smooth N, their files have N times the lines and elements of the PNG.
    """
    others = {"--layers": layers, "--words": words, "--indexed": indexed}
    is_image_alone = not any(others.values())
    if smooth is None and (paper or not is_image_alone):
        smooth = 1

    def rendered(scene: Scene) -> Picture:
        from autocolor.images import default_smooth
        from autocolor.rendering import render

        return render(scene, size, smooth=smooth or default_smooth(size))

    def prepared(scene: Scene) -> Scene:
        scene = with_normals(scene.as_in_1983() if paper else scene, normals)
        if view_name is not None:
            scene = scene.with_taken_view(view_name)
        return with_held_exposure(scene, rendered(scene)) if hold_exposure else scene

    edited, report = read_edited(source, settings, size, prepared)
    if lights:
        edited = edited.only_lights(*lights)
    if output is None and save is None and is_image_alone:
        from autocolor.files.paths import file_stem

        output = f"{file_stem(edited.name)}.png"
    refuse_outputs(output, save, force, others)
    if layers is not None:
        from autocolor.layers import open_exr

        open_exr()

    with progress(5) as step:
        from autocolor.files.picture_file import write_picture
        from autocolor.images import save_words
        from autocolor.layers import save_layers

        _ = edited.mesh.normals
        step()
        picture = rendered(edited)
        step()
        # This may be refused, so it comes first.
        if indexed is not None:
            save_words(indexed, edited, picture, indexed=True, overwrite=force)
        if save is not None:
            write_picture(save, edited, picture, overwrite=force)
        step()
        if output is not None:
            write_image(output, edited, picture, force)
        step()
        if words is not None:
            save_words(words, edited, picture, overwrite=force)
        if layers is not None:
            save_layers(layers, edited, picture, overwrite=force)
        step()
    tell_written(output, save, *others.values())
    context.exit(ended(report, source))
