"""Mistakes of the command line: an invalid value there is wrong usage, and no bad input."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from autocolor.errors import InputError, UsageError


@contextmanager
def as_usage(place: str = "") -> Iterator[None]:
    """Raise what is wrong with values from the command line as a UsageError.

    Each problem is on a line of its own, after the `place`.
    """
    try:
        yield
    except InputError as error:
        raise UsageError("\n".join(f"{place}{problem}" for problem in error.problems)) from None
