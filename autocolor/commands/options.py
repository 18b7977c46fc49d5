"""Options that several commands share, such as `--normals`, `--paper`, `--hold-exposure` and `--size`.

An invalid value of an option is a UsageError, not an InputError.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.errors import InputError, UsageError
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from logging import LogRecord

    from autocolor.lighting.picture import Picture
    from autocolor.scene.scene import Scene
    from autocolor.screens.viewer import Viewer


@contextmanager
def as_usage(place: str = "") -> Iterator[None]:
    """Raise a UsageError instead of an InputError; the lines of its message begin with `place`."""
    try:
        yield
    except InputError as error:
        raise UsageError(f"{place}{problem}" for problem in error.problems) from None


normals_option = click.option(
    "--normals",
    is_flag=True,
    help="Let words stand for normals: changing a light is then fast. Lights and eye count as far away.",
)


def with_normals(scene: Scene, normals: bool) -> Scene:
    """The scene, in which words stand for normals if `normals`.

    Raises UsageError if a scalar colors its surfaces.
    """
    if not normals:
        return scene
    with as_usage("--normals: "):
        return scene.replace(words="normals")


paper_option = click.option(
    "--paper",
    is_flag=True,
    help="Show the scene as in 1983: normals linear in the picture, Phong's model, levels from minimum to"
    " maximum, no smooth edges.",
)


hold_option = click.option(
    "--hold-exposure",
    is_flag=True,
    help="Hold the exposure that SCENE has without other options, so that less light is darker.",
)


def with_held_exposure(scene: Scene, picture: Picture) -> Scene:
    """The scene with the exposure that its picture has."""
    from autocolor.images import display_image
    from autocolor.mapping.intensity import held_exposure, stage_surfaces

    mapped = display_image(scene, picture).mapped
    return scene.replace(exposure=held_exposure(mapped, scene.scaling, scene.exposure, stage_surfaces(scene)))


paints_option = click.option(
    "--paints",
    type=click.Path(),
    metavar="FILE",
    help="Offer the named paints of a .gpl or .csv file beside the swatches of color mixing.",
)


def bringing_paints(path: str | None) -> Callable[[Viewer], object]:
    """A function that brings the paints of a palette file to a viewer; it does nothing without a path.

    The file is read at once. Raises InputError.
    """
    if path is None:
        return lambda _: None
    from autocolor.files.palette_file import read_palette

    paints, name = read_palette(path), Path(path).name
    return lambda viewer: viewer.bring_paints(paints, name)


def _size(_context: click.Context, _parameter: click.Parameter, text: str) -> tuple[int, int]:
    from autocolor.images import size_of

    try:
        return size_of(text)
    except UsageError as error:
        raise click.BadParameter(str(error)) from None


size_option = click.option(
    "--size",
    metavar="WIDTHxHEIGHT",
    default="640x480",
    show_default=True,
    callback=_size,
    help="Width and height of the picture, up to 4096x4096, as on the largest display.",
)


smooth_option = click.option(
    "--smooth",
    type=click.IntRange(1, 4),
    metavar="1-4",
    help="Smooth edges: each pixel is the mean light of 1, 4, 9 or 16. 1 is the picture of a display."
    " Default: 2, and 1 for more than 10 million pixels.",
)


def _allow(context: click.Context, _: click.Parameter, limit: float | None) -> None:
    """Allow the command this multiple of the memory budget."""
    if limit is not None and not context.resilient_parsing:
        from autocolor.budget import allowing

        context.find_root().with_resource(allowing(limit))


limit_option = click.option(
    "--limit",
    type=float,
    metavar="FACTOR",
    expose_value=False,
    callback=_allow,
    help="Factor for the memory that files and pictures may take, such as 2 for twice as much.",
)
"""`--limit` of the commands that read files."""

VERBOSITY: Final = "autocolor.verbosity"
"""The key of a click context for the number of `-v`."""

PRINTER: Final = "autocolor.printer"
"""The key of a click context whose log is printed."""


def print_log(context: click.Context) -> None:
    """Print log records on stderr until the command ends: warnings, and what `-v` asks for."""
    import logging

    logger = logging.getLogger("autocolor")
    verbosity = context.meta.get(VERBOSITY, 0)
    logger.setLevel((logging.WARNING, logging.INFO, logging.DEBUG)[min(verbosity, 2)])
    if PRINTER in context.meta:
        return
    context.meta[PRINTER] = True

    class Printer(logging.Handler):
        """Prints records on stderr, like all messages of a command."""

        def emit(self, record: LogRecord) -> None:
            tell(f"autocolor: {self.format(record)}")

    printer = Printer()
    logger.addHandler(printer)

    def stop() -> None:
        logger.removeHandler(printer)
        logger.setLevel(logging.NOTSET)

    context.find_root().call_on_close(stop)


def _listen(context: click.Context, _: click.Parameter, count: int) -> None:
    """Print log records until the command ends, if `-v` was given before the command or after it."""
    if count and not context.resilient_parsing:
        context.meta[VERBOSITY] = context.meta.get(VERBOSITY, 0) + count
        print_log(context)


verbose_option = click.option(
    "-v",
    "--verbose",
    count=True,
    expose_value=False,
    is_eager=True,
    callback=_listen,
    help="Print the steps of the command with their times; -vv prints more.",
)
"""`-v` of the group and of its commands."""
