"""Immutable values: copies are the value itself, arrays stay read-only, and a `repr` takes one line."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.checks import Suggesting

Self = TypeVar("Self", bound="Immutable")
SomeArray = TypeVar("SomeArray", bound=AnyArray)


def read_only(array: SomeArray) -> SomeArray:
    """The array itself, made read-only.

    >>> read_only(np.zeros(2)).flags.writeable
    False
    """
    array.flags.writeable = False
    return array


class Immutable(Suggesting):
    """A base class of frozen dataclasses, some of whose fields may be arrays.

    Unpickled arrays are writable, so `__setstate__` makes them read-only again. With `repr=False` in the
    dataclass, a `repr` shows only the shape and the type of an array.
    """

    def __copy__(self: Self) -> Self:
        return self

    def __deepcopy__(self: Self, memo: Mapping[int, object]) -> Self:
        return self

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        # Keep cached properties: they depend only on the fields.
        vars(self).update(state)
        for value in state.values():
            for item in value if isinstance(value, tuple) else (value,):
                if isinstance(item, np.ndarray):
                    read_only(item)

    def __repr__(self) -> str:
        values = vars(self)
        fields = [field.name for field in dataclasses.fields(self) if field.repr]  # type: ignore[arg-type]
        return f"{type(self).__name__}({', '.join(f'{name}={_shown(values[name])}' for name in fields)})"


def _shown(value: object) -> str:
    return f"{value.shape} {value.dtype}" if isinstance(value, np.ndarray) else repr(value)
