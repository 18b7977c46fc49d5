"""Tests that are tables: inputs that are refused with their sentences, and cases left for a longer run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar

import pytest

from autocolor.errors import AutocolorError
from ramtek_emu.errors import RamtekError

OURS = (AutocolorError, RamtekError)

Value = TypeVar("Value")


def refused(
    act: Callable[[Any], object],
    cases: Iterable[tuple[Any, str]],
    error: type[Exception] | tuple[type[Exception], ...] = OURS,
) -> Callable[[Any, str], None]:
    """A test that `act` refuses each input with its sentence.

    The result is named at the module's top: `test_what_is_refused = refused(parse, [("1_0", "a number must be
    ..."), ...])`. For calls of several functions the inputs are calls, and `act` is `call`.
    """
    rows = list(cases)

    def test(given: Any, sentence: str) -> None:
        with pytest.raises(error) as caught:
            act(given)
        assert str(caught.value) == sentence

    names = [sentence[:60] for _, sentence in rows]
    table: Callable[[Any, str], None] = pytest.mark.parametrize(("given", "sentence"), rows, ids=names)(test)
    return table


def call(function: Callable[[], object]) -> object:
    """What the function returns."""
    return function()


def first(count: int, values: Iterable[Value]) -> Sequence[Any]:
    """Values of one argument for `parametrize`: the first are always tried, the others in a thorough run."""
    return [
        value if number < count else pytest.param(value, marks=pytest.mark.thorough)
        for number, value in enumerate(values)
    ]
