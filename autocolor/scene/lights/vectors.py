"""Unit vectors of directions of any length, and points between others."""

from __future__ import annotations

import math

from autocolor.checks import Vector


def unit_vector(direction: Vector) -> Vector:
    """The direction with the length 1; it must not be zero.

    >>> unit_vector((0.0, 3e36, 4e36))
    (0.0, 0.6, 0.8)
    """
    # Scale by the largest component first, as squares of very large or small ones over- or underflow.
    largest = max(abs(component) for component in direction)
    scaled = tuple(component / largest for component in direction)
    length = math.hypot(*scaled)
    return (scaled[0] / length, scaled[1] / length, scaled[2] / length)


def middle_between(one: Vector, other: Vector) -> Vector:
    """The point halfway between two points, however large their coordinates are."""
    x, y, z = (a / 2 + b / 2 for a, b in zip(one, other, strict=True))
    return x, y, z
