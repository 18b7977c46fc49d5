"""`--size ELEMENTSxLINES`: the size of a picture."""

from __future__ import annotations

import re
from typing import Final

import click

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
