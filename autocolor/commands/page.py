"""`autocolor page`: write a page that shows a picture and recolors it in any browser."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import click
from click.core import ParameterSource

from autocolor.commands.options import size_option, smooth_option
from autocolor.commands.outputs import progress, tell_written
from autocolor.commands.scenes import SceneSource, scene_options, set_option
from autocolor.commands.sweep import refuse_keys, scene_in, start_of, table_option, tell_paints, vary_option
from autocolor.errors import InputError, UsageError

EXAMPLES: Final = """\b
Examples:
  autocolor page coupe.npz
  autocolor page coupe.npz --lights -o lit.html
  autocolor page scenes/coupe --vary surfaces.body.object_color=@paints.gpl -o paints.html
  autocolor page coupe.npz --table looks.csv --lights -o looks.html
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option(
    "--lights", is_flag=True, help="Let the page change the lights: their strengths, and which are on."
)
@vary_option
@table_option
@set_option
@click.option("-o", "--output", type=click.Path(), metavar="HTML", help="Page to write. Default: SCENE.html.")
@size_option
@smooth_option
@click.option("--force", is_flag=True, help="Overwrite an existing file.")
@click.pass_context
def page(
    context: click.Context,
    source: SceneSource,
    lights: bool,
    varies: tuple[str, ...],
    table: str | None,
    settings: tuple[str, ...],
    output: str | None,
    size: tuple[int, int],
    smooth: int | None,
    force: bool,
) -> None:
    """Write a page of SCENE that anyone can recolor: one HTML file, for any browser, without a network.

    SCENE may be a picture file, which needs no rendering. The page holds the words of the picture and the
    paints, but no mesh; with --lights, also the light of each lamp at each pixel. Variants are shown as a
    strip. They may only change paints, and `on` and `intensity` of lights if the page has --lights.
    """
    from autocolor.batches.table import products, read_variants, varied
    from autocolor.files.paths import file_stem
    from autocolor.files.writing import check_suffix, refuse_output
    from autocolor.images import default_smooth
    from autocolor.rendering import render
    from autocolor.web.exported import LARGEST_CANVAS, check_canvas, check_variants
    from autocolor.web.page import save_page

    if output is None:
        output = f"{file_stem(Path(source.path).stem)}.html"
    check_suffix(output, ".html", "a page")
    refuse_output(output, overwrite=force)
    tables = [] if table is None else [read_variants(table)]
    tables += [varied(text) for text in varies]
    start, code = start_of(source, settings, size)
    refuse_keys(start, tables, table)
    tell_paints(start, tables)
    scene, (width, height) = scene_in(start), size
    if table is not None:
        try:
            check_variants(scene, tables[0], lights)
        except UsageError as error:
            raise InputError(f"{table}: {error}") from None
    variants = products(tables) if tables else ()
    if isinstance(start, tuple):
        is_sized = context.get_parameter_source("size") is ParameterSource.COMMANDLINE
        if is_sized or smooth is not None:
            raise UsageError("--size and --smooth are for a scene, not for a picture file; leave them out")
        picture = start.picture
    with progress(2) as step:
        if not isinstance(start, tuple):
            samples = smooth or default_smooth(size)
            if smooth is None and width * height * samples**2 > LARGEST_CANVAS:
                samples = 1
            check_canvas(width * samples, height * samples)
            picture = render(scene, size, smooth=samples)
        step()
        save_page(output, scene, picture, lights=lights, variants=variants, overwrite=force)
        step()
    tell_written(output)
    context.exit(code)
