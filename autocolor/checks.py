"""Helpers for input checks: how messages show values and lists, and which name was probably meant."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from typing import Final

Vector = tuple[float, float, float]
Color = tuple[int, int, int]

LARGEST_COORDINATE: Final = 1e30
"""Assumed: far larger than any object; its square is still well within the float64 range."""


def shown(value: object, most: int = 60) -> str:
    """The value as text for a message, at most about `most` characters; booleans are written as in TOML.

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
    """The names as a list in English.

    >>> listed(["x", "y", "z"])
    'x, y and z'
    """
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def nearest(name: str, names: Iterable[str]) -> str:
    """A clause for a message: the closest of `names`, else all of them if they are few, else nothing."""
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
    """The value as a float.

    Where it is not a finite number within the bounds, a message that calls it `what` is appended
    to `problems`, and a placeholder is returned.
    """
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
