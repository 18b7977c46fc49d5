"""A value that is computed again only when its sources are other objects."""

from __future__ import annotations

from collections.abc import Callable
from operator import is_
from typing import Generic, TypeVar

Value = TypeVar("Value")


class Cached(Generic[Value]):
    """The last computed value, for as long as its sources are the same objects.

    Sources are compared by identity: an edited scene shares all unchanged objects with the scene before.
    """

    def __init__(self) -> None:
        self._sources: tuple[object, ...] = (self,)
        self._value: Value

    def of(self, compute: Callable[[], Value], *sources: object) -> Value:
        """The value of some sources, computed if one of them is another object than before."""
        if len(self._sources) != len(sources) or not all(map(is_, self._sources, sources)):
            self._value = compute()
            self._sources = sources
        return self._value
