"""Checks that stand at the doors: each adds its sentence to a list, so that a report names every problem.

A check returns the value as the rest of the program holds it (floats, tuples), or a harmless one after a
problem was noted.
"""

from __future__ import annotations

import dataclasses
import difflib
import math
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any, Final, TypeVar

import numpy as np

from autocolor.errors import InputError

Vector = tuple[float, float, float]
Color = tuple[int, int, int]
Row = TypeVar("Row")

LARGEST_COORDINATE: Final = 1e30
"""Assumed: far beyond any object, and its square is still far from the end of the float64 range."""

LARGEST_PLACE: Final = 1e36
"""Assumed: an eye and lights have room around the largest object."""


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


def known_fields(
    cls: type, changes: Mapping[str, Any], place: str, suggested: Iterable[str] = ()
) -> dict[str, Any]:
    """The changes as a dictionary, when each names a field of the dataclass; else InputError.

    `suggested` are the names to choose the nearest right one from, where they are more than the fields.
    """
    fields = field_names(cls)
    unknown = [name for name in changes if name not in fields]
    if unknown:
        names = list(suggested) or fields
        raise InputError([f"{place}: there is no {name!r}{nearest(name, names)}" for name in unknown])
    return dict(changes)


@lru_cache
def field_names(cls: type) -> tuple[str, ...]:
    """The names of a dataclass's fields."""
    return tuple(field.name for field in dataclasses.fields(cls))


def with_checked(row: Row, values: Mapping[str, object]) -> Row:
    """A copy of a frozen row with some fields changed to values that were checked; nothing is checked again.

    What the row computed of itself and keeps goes along: no such thing may depend on these fields.
    """
    copy = object.__new__(type(row))
    fields = vars(copy)
    fields.update(vars(row))
    fields.update(values)
    return copy


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


def vector(problems: list[str], what: str, value: object, *, not_zero: bool = False) -> Vector:
    """The value as three floats, when it is three finite numbers (and not all zero, where that is asked)."""
    try:
        given = list(value)  # type: ignore[call-overload]
        words = any(isinstance(component, (str, bytes, bool)) for component in given)
        components = [] if words else [float(component) for component in given]
    except (TypeError, ValueError, OverflowError):
        components = []
    if len(components) != 3 or not all(abs(component) <= LARGEST_PLACE for component in components):
        problems.append(f"{what} must be three finite numbers of at most 1e36, not {value!r}")
        return (0.0, 0.0, 1.0)
    if not_zero and not any(components):
        problems.append(f"{what} must not be zero, not {value!r}; give it a length")
        return (0.0, 0.0, 1.0)
    return (components[0], components[1], components[2])


def switch(problems: list[str], what: str, value: object) -> bool:
    """The value as a bool, when it is true or false."""
    if not isinstance(value, (bool, np.bool_)):
        problems.append(f"{what} must be true or false, not {value!r}")
    return bool(value)


def text(problems: list[str], what: str, value: object) -> None:
    """Note a problem unless the value is a text of at least one letter."""
    if not isinstance(value, str) or not value:
        problems.append(f"{what} must be a text of at least one letter, not {value!r}")


def kind(problems: list[str], what: str, value: object, cls: type) -> None:
    """Note a problem unless the value is of a class."""
    if not isinstance(value, cls):
        problems.append(f"{what} must be a {cls.__name__}, not {value!r}")


def color(problems: list[str], what: str, value: object) -> Color:
    """The value as red, green and blue from 0 to 255, when it is "#rrggbb" or three whole numbers."""
    try:
        if isinstance(value, str) and len(value) == 7 and value[0] == "#":
            # Six hexadecimal digits with nothing between them make three bytes.
            red, green, blue = bytes.fromhex(value[1:])
            return (red, green, blue)
        given = list(value)  # type: ignore[call-overload]
        parts = [int(part) for part in given if not isinstance(part, (str, bytes, bool))]
        if parts == given and len(parts) == 3 and min(parts) >= 0 and max(parts) <= 255:
            return (parts[0], parts[1], parts[2])
    except (TypeError, ValueError, OverflowError):
        pass
    problems.append(f'{what} must be "#rrggbb" or three whole numbers from 0 to 255, not {value!r}')
    return (0, 0, 0)
