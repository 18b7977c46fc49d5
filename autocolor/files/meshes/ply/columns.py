"""What a PLY file holds of its elements: columns of numbers and of lists of numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from autocolor.arrays import AnyArray, Indices


class Lists(NamedTuple):
    """Lists, one a row: all their values, one list after the other, and how many each has."""

    values: AnyArray
    counts: Indices


Column = AnyArray | Lists


@dataclass(frozen=True)
class Rows:
    """The columns of an element by the names of its properties; `place_of` tells where a row is."""

    count: int
    columns: dict[str, Column]
    place_of: Callable[[int], str]


class PlyTables(NamedTuple):
    """The elements of a file by name, and what of it comes after them, as the end of a message."""

    elements: dict[str, Rows]
    skipped: tuple[str, ...] = ()
