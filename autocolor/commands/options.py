"""Options that several commands share: `--normals`, `--size` and `-v`.

An invalid value of an option is a UsageError, not an InputError.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import click

from autocolor.errors import InputError, UsageError
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from logging import LogRecord

    from autocolor.scene.scene import Scene


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


LARGEST: Final = 4096
"""The most elements and lines of a picture: the size of the largest display memory."""


def size_of(text: str) -> tuple[int, int]:
    """The elements and the lines in the text of a size. Raises click.BadParameter.

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
    help="Width and height of the picture, up to 4096x4096.",
)

VERBOSITY: Final = "autocolor.verbosity"
"""The key of a click context for the number of `-v`."""


def _listen(context: click.Context, _: click.Parameter, count: int) -> None:
    """Print log records until the command ends, if `-v` was given."""
    if not count or context.resilient_parsing:
        return
    import logging

    logger = logging.getLogger("autocolor")
    # `-v` is allowed before the command and after it.
    is_first = VERBOSITY not in context.meta
    context.meta[VERBOSITY] = context.meta.get(VERBOSITY, 0) + count
    logger.setLevel(logging.INFO if context.meta[VERBOSITY] == 1 else logging.DEBUG)
    if not is_first:
        return

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
