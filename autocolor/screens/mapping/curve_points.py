"""The points of a mapping curve, as they are moved, added and removed: the curve stays a rising one.

Its first point is at the fraction 0 of the intensities, its last one at 1; both stay there.
"""

from __future__ import annotations

from typing import Final

from autocolor.scene.curves import CurvePoints

STRAIGHT: Final[CurvePoints] = ((0.0, 0.0), (0.25, 0.25), (0.5, 0.5), (0.75, 0.75), (1.0, 1.0))

LEAST_APART: Final = 0.01
"""Assumed: the smallest distance of two points along the intensities."""

DIGITS: Final = 4
"""Decimals of a point; pointing is not as fine."""


def moved(points: CurvePoints, number: int, x: float, y: float) -> CurvePoints:
    """The points with one moved to fractions of intensity and level, or as near as the others let it."""
    last = len(points) - 1
    low = points[number - 1][1] if number else 0.0
    high = points[number + 1][1] if number < last else 1.0
    if 0 < number < last:
        least, most = points[number - 1][0] + LEAST_APART, points[number + 1][0] - LEAST_APART
        x = min(max(x, least), most) if least <= most else points[number][0]
    else:
        x = points[number][0]
    point = round(x, DIGITS), round(min(max(y, low), high), DIGITS)
    return (*points[:number], point, *points[number + 1 :])


def added(points: CurvePoints, x: float, y: float) -> tuple[CurvePoints, int]:
    """The points with one more at fractions of intensity and level, and its number.

    Its level is between those of its neighbors. One that is closer than LEAST_APART to another is not added:
    that one's number is returned.
    """
    nearest = min(range(len(points)), key=lambda number: abs(points[number][0] - x))
    if abs(points[nearest][0] - x) < LEAST_APART:
        return points, nearest
    number = sum(other < x for other, _ in points)
    between = points[:number], points[number:]
    y = min(max(y, between[0][-1][1]), between[1][0][1])
    return (*between[0], (round(x, DIGITS), round(y, DIGITS)), *between[1]), number


def removed(points: CurvePoints, number: int) -> CurvePoints:
    """The points without one of them; the ends stay."""
    return (*points[:number], *points[number + 1 :]) if 0 < number < len(points) - 1 else points
