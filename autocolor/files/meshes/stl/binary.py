"""The triangles of a binary STL file: 80 bytes of any text, their count, and 50 bytes for each."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Singles
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError

BEFORE_TRIANGLES: Final = 84
TRIANGLE: Final = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

MOST_PROBLEMS: Final = 20


def has_binary_size(data: bytes) -> bool:
    """Whether a file has just as many bytes as its count of triangles says, if it is binary."""
    return len(data) >= BEFORE_TRIANGLES and len(data) == BEFORE_TRIANGLES + TRIANGLE.itemsize * _count(data)


def read_binary(data: bytes, place: str) -> tuple[Singles, tuple[str, ...]]:
    """The corners of the triangles, (corners, 3), and messages about what was skipped.

    `place` is the file's name in messages. Normals and attributes are ignored. Raises InputError if the file
    is cut short, or about triangles with coordinates that are no finite numbers of at most 1e30 in size.
    """
    if len(data) < BEFORE_TRIANGLES:
        raise InputError(
            f"{place}: a binary STL file must have at least {BEFORE_TRIANGLES} bytes, not {len(data)}; it is"
            " cut short, export it again"
        )
    count = _count(data)
    size = BEFORE_TRIANGLES + TRIANGLE.itemsize * count
    if size > len(data):
        raise InputError(
            f"{place}: a binary STL file of {count:,} triangles must have {size:,} bytes, not {len(data):,};"
            " it is cut short or of another format, export it again"
        )
    corners = np.array(np.frombuffer(data, TRIANGLE, count, BEFORE_TRIANGLES)["corners"])
    # A comparison with NaN is false.
    if count and not (corners.min() >= -LARGEST_COORDINATE and corners.max() <= LARGEST_COORDINATE):
        is_wrong = ~(np.abs(corners) <= LARGEST_COORDINATE)
        rows = np.flatnonzero(is_wrong.any(axis=(1, 2)))[:MOST_PROBLEMS]
        rule = "a coordinate must be a finite number of at most 1e30 in size"
        raise InputError(
            [
                f"{place}, facet {row + 1}: {rule}, not {corners[row][is_wrong[row]][0]:g}; correct it"
                for row in rows.tolist()
            ]
        )
    left = len(data) - size
    return corners.reshape(-1, 3), (f"skipped bytes after the last triangle: {left:,}",) if left else ()


def _count(data: bytes) -> int:
    return int.from_bytes(data[BEFORE_TRIANGLES - 4 : BEFORE_TRIANGLES], "little")
