"""Options that several commands share: `--normals`, `--size` and `-v`; and mistakes in options.

An invalid value of an option is wrong usage, not invalid input.
"""

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
    """Raise an InputError about values from the command line as a UsageError.

    Each problem is on a line of its own, after the `place`.
    """
    try:
        yield
    except InputError as error:
        raise UsageError("\n".join(f"{place}{problem}" for problem in error.problems)) from None


normals_option = click.option(
    "--normals",
    is_flag=True,
    help="Let words stand for normals: lights then change entries only. Lights and eye count as far away.",
)


def with_normals(scene: Scene, normals: bool) -> Scene:
    """The scene; with `normals`, its words stand for normals.

    Raises UsageError if a scalar colors its surfaces.
    """
    if not normals:
        return scene
    with as_usage("--normals: "):
        return scene.replace(words="normals")


LARGEST: Final = 4096
"""The most elements and lines of a display: the largest picture is as large as the largest memory."""


def size_of(text: str) -> tuple[int, int]:
    """The elements and lines of a size. Raises click.BadParameter.

    >>> size_of("1280x960")
    (1280, 960)
    """
    match = re.fullmatch(r"([0-9]{1,5})[xX]([0-9]{1,5})", text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
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

VERBOSITY: Final = "autocolor.verbosity"
"""The key of the number of `-v` in the contexts of a command."""


def _listen(context: click.Context, _: click.Parameter, count: int) -> None:
    """Print log records until the command has ended; nothing changes without the option."""
    if not count or context.resilient_parsing:
        return
    import logging

    logger = logging.getLogger("autocolor")
    # The option may stand before the command and after it.
    is_first = VERBOSITY not in context.meta
    context.meta[VERBOSITY] = context.meta.get(VERBOSITY, 0) + count
    logger.setLevel(logging.INFO if context.meta[VERBOSITY] == 1 else logging.DEBUG)
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
    help="Print each step of reading, creating and computing, and its time; -vv prints more.",
)
"""`-v` of the group and of each command."""
