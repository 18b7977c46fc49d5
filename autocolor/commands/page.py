"""`autocolor page`: write a page that shows a picture and recolors it in any browser."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import click

from autocolor.commands.options import flag, force_option, option
from autocolor.commands.outputs import progress, tell_written
from autocolor.commands.scenes import SceneSource, scene_in, scene_options
from autocolor.commands.sweep import started, table_option, vary_option
from autocolor.errors import InputError, UsageError

EXAMPLES: Final = """\b
Examples:
  autocolor page coupe.npz
  autocolor page coupe.npz --lights -o lit.html
  autocolor page scenes/coupe --vary surfaces.body.object_color=@paints.gpl -o paints.html
  autocolor page coupe.npz --table looks.csv --lights -o looks.html
"""


@click.command(epilog=EXAMPLES)
@scene_options("settings", "stage", "size", "smooth")
@flag("--lights", "Let the page change the lights: their strengths, and which are on.")
@vary_option
@table_option
@option("-o --output", "HTML", "Page to write. Default: SCENE.html.")
@force_option
def page(
    source: SceneSource,
    lights: bool,
    varies: tuple[str, ...],
    table: str | None,
    output: str | None,
    force: bool,
) -> int:
    """Write a page of SCENE that anyone can recolor: one HTML file, for any browser, without a network.

    SCENE may be a picture file, which needs no rendering. The page holds the words of the picture and the
    paints, but no mesh; with --lights, also the light of each lamp at each pixel. Variants are shown as a
    strip. They may only change paints, and `on` and `intensity` of lights if the page has --lights.
    """
    from autocolor.batches.table import products
    from autocolor.files.paths import file_stem
    from autocolor.files.writing import check_suffix, refuse_output
    from autocolor.web.exported import LARGEST_CANVAS, check_canvas, check_variants
    from autocolor.web.page import save_page

    if output is None:
        output = f"{file_stem(Path(source.path).stem)}.html"
    check_suffix(output, ".html", "a page")
    refuse_output(output, overwrite=force)
    start, tables, code = started(source, varies, table)
    scene = scene_in(start)
    if table is not None:
        try:
            check_variants(scene, tables[0], lights)
        except UsageError as error:
            raise InputError(f"{table}: {error}") from None
    variants = products(tables) if tables else ()
    if isinstance(start, tuple) and source.given_sizes:
        raise UsageError("--size and --smooth are for a scene, not for a picture file; leave them out")
    with progress(2) as bar:
        if isinstance(start, tuple):
            picture = start.picture
        else:
            width, height = source.size
            if source.smooth is None and width * height * source.samples**2 > LARGEST_CANVAS:
                source = source._replace(smooth=1)
            check_canvas(width * source.samples, height * source.samples)
            picture = source.rendered(scene)
        bar.update(1)
        save_page(output, scene, picture, lights=lights, variants=variants, overwrite=force)
        bar.update(1)
    tell_written(output)
    return code
