"""The budget of memory: one estimate before a file is read or a picture is rendered, which may be refused.

The estimates are bytes for each byte of a file, row or pixel. Users allow more with `--limit` of the commands
and `limit=` of the functions, a factor for the budget. If memory ends all the same, functions raise
MemoryError, and commands exit with 71.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from numbers import Real
from typing import Final

from autocolor.checks import shown
from autocolor.errors import InputError, UsageError

MEMORY: Final = 4_000_000_000
"""Limit: bytes to read a file or to render a picture; ten million quads as binary PLY take 2.6 billion."""

_LIMIT: Final[ContextVar[float]] = ContextVar("limit", default=1.0)
"""The factor for the budget. A new thread begins with 1."""


@contextmanager
def allowing(limit: float | None) -> Iterator[None]:
    """Multiply the usual budget by `limit`; None leaves the budget as it is. Raises UsageError."""
    token = _LIMIT.set(validated_limit(limit))
    try:
        yield
    finally:
        _LIMIT.reset(token)


def validated_limit(limit: float | None) -> float:
    """The factor as a number, the current factor for None. Raises UsageError."""
    if limit is None:
        return _LIMIT.get()
    if isinstance(limit, bool) or not isinstance(limit, Real) or not 0 < limit <= sys.float_info.max:
        raise UsageError(
            f"limit must be a finite number above 0, a factor for the memory that is allowed, not"
            f" {shown(limit)}; give one such as 2"
        )
    return float(limit)


def allowed_memory() -> int:
    """The budget in bytes."""
    return round(min(MEMORY * _LIMIT.get(), sys.maxsize))


def require_memory(needed: float, subject: str, remedy: str) -> None:
    """Raise InputError if more bytes are needed than the budget allows.

    `subject` begins the message, with the place; `remedy` says what to do instead of allowing more.
    """
    allowed = allowed_memory()
    if needed <= allowed:
        return
    limit = math.ceil(10 * needed / MEMORY) / 10
    raise InputError(
        f"{subject} must take at most {math.floor(allowed / 1e5) / 10:,.1f} MB of memory, not"
        f" {math.ceil(needed / 1e5) / 10:,.1f} MB; {remedy}, or allow it with --limit {limit:.16g}"
        f" (limit={limit:.16g} in Python)"
    )
