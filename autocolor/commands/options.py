"""Mistakes of the command line: an invalid value there is wrong usage, and no bad input."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import click

from autocolor.errors import InputError, UsageError

if TYPE_CHECKING:
    from logging import LogRecord

    from autocolor.scene.scene import Scene


@contextmanager
def as_usage(place: str = "") -> Iterator[None]:
    """Raise what is wrong with values from the command line as a UsageError.

    Each problem is on a line of its own, after the `place`.
    """
    try:
        yield
    except InputError as error:
        raise UsageError("\n".join(f"{place}{problem}" for problem in error.problems)) from None


# -------------------- normals
# `--normals`: words that stand for normals, so that lights move by loads of the table alone.

normals_option = click.option(
    "--normals",
    is_flag=True,
    help="Let words stand for normals: lights change entries alone; they and the eye are taken as far away.",
)


def with_normals(scene: Scene, normals: bool) -> Scene:
    """The scene, whose words stand for normals if that is asked for.

    Raises UsageError where a scalar colors its surfaces.
    """
    if not normals:
        return scene
    with as_usage("--normals: "):
        return scene.replace(words="normals")


# -------------------- raster_size
# `--size ELEMENTSxLINES`: the size of a picture.

LARGEST: Final = 4096
"""The most elements and lines of a display: the largest picture is as large as the largest memory."""

WRITTEN: Final = re.compile(r"([0-9]{1,5})[xX]([0-9]{1,5})")


def size_of(text: str) -> tuple[int, int]:
    """The elements and lines of a size. Raises click.BadParameter.

    >>> size_of("1280x960")
    (1280, 960)
    """
    found = WRITTEN.fullmatch(text)
    size = (int(found[1]), int(found[2])) if found else (0, 0)
    if not all(1 <= count <= LARGEST for count in size):
        raise click.BadParameter(
            f"a size must be ELEMENTSxLINES, each from 1 to {LARGEST}, not {text[:60]!r}; write it as in"
            " 1280x960"
        )
    return size


size_option = click.option(
    "--size",
    metavar="ELEMENTSxLINES",
    default="640x480",
    show_default=True,
    callback=lambda _context, _parameter, text: size_of(text),
    help="Size of the picture, up to 4096x4096.",
)


# -------------------- verbosity
# `-v`: what the library logs, on stderr.

COUNT: Final = "autocolor.verbosity"
"""Where the contexts of a command keep how often the option was given."""


def _listen(context: click.Context, _: click.Parameter, count: int) -> None:
    """Print what is logged until the command has ended; nothing changes without the option."""
    if not count or context.resilient_parsing:
        return
    import logging

    logger = logging.getLogger("autocolor")
    # The option may stand before the command and after it.
    is_first = COUNT not in context.meta
    context.meta[COUNT] = context.meta.get(COUNT, 0) + count
    logger.setLevel(logging.INFO if context.meta[COUNT] == 1 else logging.DEBUG)
    if not is_first:
        return

    class Printer(logging.Handler):
        """Prints each record on stderr, as all messages of a command."""

        def emit(self, record: LogRecord) -> None:
            click.echo(f"autocolor: {self.format(record)}", err=True)

    printer = Printer()
    logger.addHandler(printer)

    def stop() -> None:
        logger.removeHandler(printer)
        logger.setLevel(logging.NOTSET)

    context.find_root().call_on_close(stop)


verbose_option = click.option(
    "-v",
    "--verbose",
    count=True,
    expose_value=False,
    is_eager=True,
    callback=_listen,
    help="Say what is read, created and computed, and how long it takes; -vv for more.",
)
"""`-v` of the group and of each command."""
