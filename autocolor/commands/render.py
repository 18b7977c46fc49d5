"""`autocolor render`: render a scene to a PNG or picture file, without a window."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.completion import complete_lights, complete_views
from autocolor.commands.options import normals_option, size_option, smooth_of, smooth_option, with_normals
from autocolor.commands.outputs import refuse_outputs, tell_written, write_image
from autocolor.commands.scenes import (
    SceneSource,
    created_again,
    ended,
    read,
    reframed,
    scene_options,
    set_option,
    tell_unset,
    tell_up,
)

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
"""


@click.command(epilog=EXAMPLES)
@partial(scene_options, required=False)
@click.option(
    "-o",
    "--output",
    type=click.Path(),
    metavar="PNG",
    help="PNG file to write. Default, without --save: SCENE.png, or coupe.png.",
)
@click.option(
    "--save",
    type=click.Path(),
    metavar="PICTURE.npz",
    help="Save the picture with its scene, to recolor it later.",
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
@size_option
@smooth_option
@click.option(
    "--hold-exposure",
    is_flag=True,
    help="Use the exposure that the scene has without --light and --set, so that less light is darker.",
)
@click.option("--force", is_flag=True, help="Overwrite existing files.")
@click.pass_context
def render(
    context: click.Context,
    source: SceneSource | None,
    output: str | None,
    save: str | None,
    lights: tuple[str, ...],
    view_name: str | None,
    settings: tuple[str, ...],
    normals: bool,
    size: tuple[int, int],
    smooth: str | None,
    hold_exposure: bool,
    force: bool,
) -> None:
    """Render SCENE: a folder, a scene.toml, a mesh file or a picture file. Without SCENE, render the demo."""
    from autocolor.commands.settings import with_settings

    def rendered(scene: Scene) -> Picture:
        from autocolor.rendering import render

        return render(scene, lines, elements, smooth=smooth_of(smooth, size))

    elements, lines = size
    report = reframed(read(source), elements / lines)
    if source is not None:
        tell_up(report, source)
    original = with_normals(report.scene, normals)
    if view_name is not None:
        original = original.with_taken_view(view_name)
    if hold_exposure:
        from autocolor.images import display_image
        from autocolor.mapping.intensity import held_exposure

        mapped = display_image(original, rendered(original)).mapped
        original = original.replace(exposure=held_exposure(mapped, original.scaling, original.exposure))
    edited = created_again(report, with_settings(original, settings), elements / lines)
    tell_unset(original, edited)
    if lights:
        edited = edited.only_lights(*lights)
    if output is None and save is None:
        from autocolor.files.paths import file_stem

        output = f"{file_stem(edited.name)}.png"
    refuse_outputs(output, save, force)

    with progress(4) as step:
        from autocolor.files.picture_file import write_picture

        _ = edited.mesh.normals
        step()
        picture = rendered(edited)
        step()
        if save is not None:
            write_picture(save, edited, picture, overwrite=force)
        step()
        if output is not None:
            write_image(output, edited, picture, force)
        step()
    tell_written(output, save)
    context.exit(ended(report, source))


@contextmanager
def progress(steps: int) -> Iterator[Callable[[], None]]:
    """A progress bar on stderr, if stderr is a terminal. Call the yielded function after each step."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield lambda: None
        return
    with click.progressbar(length=steps, file=sys.stderr, show_eta=False) as bar:
        yield lambda: bar.update(1)
