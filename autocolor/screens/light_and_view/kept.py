"""Values that are kept while what they are made of is the same, so that a movement makes only what moved."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

Value = TypeVar("Value")


class Kept(Generic[Value]):
    """The last value that was made, for as long as its sources are the same objects.

    Scenes share with the one before all that an edit did not change, so that it need not be compared.
    """

    def __init__(self) -> None:
        self._sources: tuple[object, ...] | None = None
        self._value: Value

    def of(self, make: Callable[[], Value], *sources: object) -> Value:
        """The value of some sources, made by a function if one of them is another object than before."""
        known = self._sources
        if known is None or len(known) != len(sources) or any(map(_differ, known, sources)):
            self._value = make()
            self._sources = sources
        return self._value


def _differ(one: object, other: object) -> bool:
    return one is not other
