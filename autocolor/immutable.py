"""Immutable values: a copy of one is itself, its arrays stay read-only, and it is shown in a line."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from autocolor.arrays import AnyArray

Self = TypeVar("Self", bound="Immutable")
SomeArray = TypeVar("SomeArray", bound=AnyArray)


def read_only(array: SomeArray) -> SomeArray:
    """The array itself, which can no longer be written to.

    >>> read_only(np.zeros(2)).flags.writeable
    False
    """
    array.flags.writeable = False
    return array


class Immutable:
    """A base class of frozen dataclasses, some of whose fields may be arrays.

    Pickles of arrays do not tell that they are read-only: here they are made so again. In a `repr`, an array
    is its shape and its type; a dataclass leaves that to this class with `repr=False`.
    """

    def __copy__(self: Self) -> Self:
        return self

    def __deepcopy__(self: Self, memo: Mapping[int, object]) -> Self:
        return self

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        # What was cached is kept: it was computed from the fields alone.
        vars(self).update(state)
        for value in state.values():
            for each in value if isinstance(value, tuple) else (value,):
                if isinstance(each, np.ndarray):
                    read_only(each)

    def __repr__(self) -> str:
        values = vars(self)
        fields = [each.name for each in dataclasses.fields(self) if each.repr]  # type: ignore[arg-type]
        return f"{type(self).__name__}({', '.join(f'{name}={_shown(values[name])}' for name in fields)})"


def _shown(value: object) -> str:
    return f"{value.shape} {value.dtype}" if isinstance(value, np.ndarray) else repr(value)
