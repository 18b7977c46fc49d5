"""`autocolor render`: render a scene to a PNG or picture file, without a window."""

from __future__ import annotations

from typing import Final

import click

from autocolor.commands.completion import complete_lights
from autocolor.commands.options import force_option, option
from autocolor.commands.outputs import progress, refuse_outputs, tell_written
from autocolor.commands.scenes import SceneSource, ended, read_edited, scene_options

EXAMPLES: Final = """\b
Examples:
  autocolor render
  autocolor render scenes/coupe -o coupe.png --save coupe.npz
  autocolor render car.obj --up y --stage bowl
  autocolor render scenes/coupe --light key -o key.png
  autocolor render scenes/coupe --light key --hold-exposure -o key-alone.png
  autocolor render scenes/coupe --view hood -o hood.png
  autocolor render scenes/coupe --set lights.key.concentration=40 --set ambient=0.2
  autocolor render scenes/coupe --set surfaces.body.object_color=navy --size 1280x960 --smooth 4
  autocolor render scenes/coupe --layers coupe.exr --words coupe-words.png
"""


@click.command(epilog=EXAMPLES)
@scene_options(
    "settings", "stage", "view", "normals", "paper", "size", "smooth", "hold_exposure", required=False
)
@option(
    "-o --output", "PNG", "PNG file to write. Default, without any other output: SCENE.png, or coupe.png."
)
@option("--save", "PICTURE.npz", "Save the picture with its scene, to recolor it later.")
@option(
    "--layers", "FILE.exr", "Write what compositors use: each light, depth, normals, positions, identities."
)
@option("--words", "FILE.png", "Write the words as 16-bit grays, with the lookup table.")
@option("--indexed", "FILE.png", "Write the words in use, at most 256, as indices of a palette.")
@option(
    "--light lights",
    "NAME",
    "Switch off all lights but this one; repeatable.",
    str,
    multiple=True,
    shell_complete=complete_lights,
)
@force_option
def render(
    source: SceneSource,
    output: str | None,
    save: str | None,
    layers: str | None,
    words: str | None,
    indexed: str | None,
    lights: tuple[str, ...],
    force: bool,
) -> int:
    """Render SCENE: a folder, a scene.toml, a mesh file or a picture file. Without SCENE, render the demo.

    --layers, --words and --indexed never average pixels. With any of these options, --smooth is 1 by default.
    With --smooth N, their files have N times the lines and elements of the PNG.
    """
    from autocolor.files.paths import file_stem
    from autocolor.files.picture_file import write_picture
    from autocolor.images import save_image, save_words
    from autocolor.layers import open_exr, save_layers

    unsmoothed = {"--layers": layers, "--words": words, "--indexed": indexed}
    if source.smooth is None and (source.paper or any(unsmoothed.values())):
        source = source._replace(smooth=1)
    edited, report = read_edited(source)
    if lights:
        edited = edited.only_lights(*lights)
    if output is None and save is None and not any(unsmoothed.values()):
        output = f"{file_stem(edited.name)}.png"
    outputs = {"-o": output, "--save": save, **unsmoothed}
    refuse_outputs(outputs, force)
    if layers is not None:
        open_exr()

    with progress(3) as bar:
        picture = source.rendered(edited)
        bar.update(1)
        # This may be refused, so it comes first.
        if indexed is not None:
            save_words(indexed, edited, picture, indexed=True, overwrite=force)
        if save is not None:
            write_picture(save, edited, picture, overwrite=force)
        if output is not None:
            save_image(output, edited, picture, overwrite=force)
        bar.update(1)
        if words is not None:
            save_words(words, edited, picture, overwrite=force)
        if layers is not None:
            save_layers(layers, edited, picture, overwrite=force)
        bar.update(1)
    tell_written(*outputs.values())
    return ended(report, source)
