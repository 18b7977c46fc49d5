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
  autocolor page scenes/coupe --views 12 --lights -o turning.html
  autocolor page scenes/coupe --vary surfaces.body.object_color=@paints.gpl -o paints.html
  autocolor page coupe.npz --table looks.csv --lights -o looks.html
"""


@click.command(epilog=EXAMPLES)
@scene_options("settings", "stage", "size", "smooth")
@option(
    "--views",
    "N|cameras",
    "Let the page turn: N views from all around the object, 2 to 64; or cameras, the scene's view and its"
    " named views.",
    str,
)
@flag("--lights", "Let the page change the lights: their strengths, and which are on.")
@vary_option
@table_option
@option(
    "--link",
    "URL",
    "Address that the page will have, so that other sites show its picture; a PNG is written beside it.",
    str,
)
@option("-o --output", "HTML", "Page to write. Default: SCENE.html.")
@force_option
def page(
    source: SceneSource,
    views: str | None,
    lights: bool,
    varies: tuple[str, ...],
    table: str | None,
    link: str | None,
    output: str | None,
    force: bool,
) -> int:
    """Write a page of SCENE that anyone can recolor: one HTML file, for any browser, without a network.

    SCENE may be a picture file, which needs no rendering. The page holds the words of the picture and the
    paints, but no mesh; with --lights, also the light of each lamp at each pixel. With --views, visitors drag
    the picture to turn it. All views have the levels and the exposure of the first, and lights can be changed
    in the first only. Variants are shown as a strip. They may only change paints, and `on` and `intensity` of
    lights if the page has --lights.
    """
    from autocolor.batches.table import products
    from autocolor.files.paths import file_stem
    from autocolor.files.writing import check_suffix, refuse_output
    from autocolor.web.exported import check_variants
    from autocolor.web.page import check_link, save_page
    from autocolor.web.views import views_of

    if output is None:
        output = f"{file_stem(Path(source.path).stem)}.html"
    check_suffix(output, ".html", "a page")
    link = link or ""
    check_link(link)
    written = [output, *[str(Path(output).with_suffix(".png"))] * bool(link)]
    for path in written:
        refuse_output(path, overwrite=force)
    start, tables, code = started(source, varies, table)
    scene = scene_in(start)
    if table is not None:
        try:
            check_variants(scene, tables[0], lights)
        except UsageError as error:
            raise InputError(f"{table}: {error}") from None
    if isinstance(start, tuple) and (views or source.given_sizes):
        raise UsageError(
            "--views, --size and --smooth are for a scene, not for a picture file; give the scene"
        )
    # Python does not convert thousands of digits.
    number = int(views) if views is not None and views.isdecimal() and len(views) < 10 else views
    picture = start.picture if isinstance(start, tuple) else None
    # `save_page` places the eyes of an orbit, which takes a while for a large mesh.
    count = number if isinstance(number, int) else len(views_of(scene, number, 1))
    with progress(1 + count * (picture is None)) as bar:
        save_page(
            output,
            scene,
            picture,
            **source.given_sizes,
            views=number,
            lights=lights,
            variants=products(tables) if tables else (),
            link=link,
            overwrite=force,
            progress=lambda _: bar.update(1),
        )
        bar.update(1)
    tell_written(*written)
    return code
