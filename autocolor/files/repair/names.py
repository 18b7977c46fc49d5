"""Names of parts, materials and scalars as files have them, made printable, not too long, and different."""

from __future__ import annotations

import codecs
from collections.abc import Sequence
from typing import Final

from autocolor.checks import printable

LONGEST_NAME: Final = 200
"""Assumed: letters of a name; the rest of a longer one is left out."""


def name_of(data: bytes) -> str:
    """The name in bytes, as `printable_name`; bytes that are not UTF-8 are Latin-1."""
    data = data.strip()
    start = data[: 4 * LONGEST_NAME]
    try:
        # What is cut may end within a letter.
        text = codecs.getincrementaldecoder("utf-8")().decode(start, final=start == data)
    except UnicodeDecodeError:
        text = start.decode("latin-1")
    return printable_name(text)


def printable_name(text: str) -> str:
    """The name without spaces around it, as printable text of at most LONGEST_NAME letters."""
    return printable(text.strip()[:LONGEST_NAME])


def different(names: Sequence[str], addition: str = "") -> tuple[str, ...]:
    """The names, each that was there before with an addition or a number.

    >>> different(["hood", "hood", "hood"])
    ('hood', 'hood 2', 'hood 3')
    """
    found: dict[str, None] = {}
    counts: dict[str, int] = {}
    for name in names:
        unique = name if name not in found else f"{name}{addition}"
        number = counts.get(name, 1)
        while unique in found:
            number += 1
            unique = f"{name}{addition} {number}"
        counts[name] = number
        found[unique] = None
    return tuple(found)
