"""What the checks at the doors share: how a value is shown in a sentence, and the nearest right name."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from typing import Final

Vector = tuple[float, float, float]
Color = tuple[int, int, int]

LARGEST_COORDINATE: Final = 1e30
"""Assumed: far beyond any object, and its square is still far from the end of the float64 range."""


def shown(value: object, most: int = 60) -> str:
    """The value for the end of a sentence: true and false as in a file, and cut where it is long.

    >>> shown(True), shown("body"), shown((1, 2)), shown("x" * 100, most=3)
    ('true', "'body'", '(1, 2)', "'xxx'...")
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return repr(value) if len(value) <= most else f"{value[:most]!r}..."
    text = repr(value)
    return text if len(text) <= most else f"{text[:most]}..."


def listed(names: Iterable[str]) -> str:
    """Names as a list in a sentence.

    >>> listed(["x", "y", "z"])
    'x, y and z'
    """
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def nearest(name: str, names: Iterable[str]) -> str:
    """A clause that names the nearest right name, or all of them when few, or nothing."""
    names = list(names)
    close = [known for known in names if known.startswith(name)] or difflib.get_close_matches(
        name, names, n=1
    )
    if close:
        return f"; did you mean {close[0]!r}?"
    if 0 < len(names) <= 12:
        return f"; known are {', '.join(map(repr, names))}"
    return ""


def finite(
    problems: list[str], what: str, value: object, *, at_least: float = -math.inf, at_most: float = math.inf
) -> float:
    """The value as a float, when it is a finite number within the bounds."""
    try:
        number = float(value) if not isinstance(value, (bool, str, bytes)) else math.nan  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not (math.isfinite(number) and at_least <= number <= at_most):
        rule = "must be a finite number"
        if at_least > -math.inf and at_most < math.inf:
            rule = f"must be a number from {at_least:g} to {at_most:g}"
        elif at_least > -math.inf:
            rule = f"must be a finite number of at least {at_least:g}"
        problems.append(f"{what} {rule}, not {value!r}")
        return max(0.0, at_least)
    return number
