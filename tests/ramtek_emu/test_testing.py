from __future__ import annotations

from collections.abc import Callable
from functools import partial
from operator import eq
from typing import Any

import numpy as np
import pytest
from hypothesis import Phase, find, given, settings
from hypothesis import strategies as st

from ramtek_emu.arrays import Colors, Raster
from ramtek_emu.instruction_set.table import FORMATS, SUBSTANTIATED
from ramtek_emu.testing import entries, rasters, streams, words


def begins(opcode: int, stream: list[int]) -> bool:
    """Whether a stream begins with an instruction."""
    return bool(stream) and stream[0] >> 8 == opcode


REACHED: dict[str, tuple[st.SearchStrategy[Any], Callable[[Any], bool]]] = {
    "the largest word of 10 planes": (words(), partial(eq, 1023)),
    "the largest word of 16 planes": (words(16), partial(eq, 0xFFFF)),
    "no words": (streams(), partial(eq, [])),
    "all words that may be": (streams(9), lambda stream: len(stream) == 9),
    "an entry of 0 and 255": (entries(2), lambda table: table.min() == 0 and table.max() == 255),
    **{f"the word {word}": (streams(1), partial(eq, [word])) for word in (0, 12, 0xFFFF)},
    **{
        f"the instruction {format.name}": (streams(1), partial(begins, format.opcode))
        for format in (SUBSTANTIATED[-1], FORMATS[-1])
    },
    "an instruction with all flags": (streams(1), partial(eq, [SUBSTANTIATED[0].opcode << 8 | 0xFF])),
}
"""Values at the edges, by what they are: a strategy, and what is looked for."""


@pytest.mark.parametrize("value", REACHED)
def test_the_strategies_reach_the_values_at_their_edges(value: str) -> None:
    strategy, is_it = REACHED[value]
    unhurried = settings(max_examples=20_000, phases=[Phase.generate], database=None, derandomize=True)
    assert is_it(find(strategy, is_it, settings=unhurried))


@given(rasters(3, 4), entries(5), rasters(), entries(), streams(7))
def test_rasters_and_entries_have_the_shapes_and_types_of_the_memories(
    raster: Raster[np.uint16], table: Colors, usual: Raster[np.uint16], whole: Colors, stream: list[int]
) -> None:
    assert (raster.shape, raster.dtype.str, usual.shape) == ((3, 4), "<u2", (9, 13))
    assert (table.shape, table.dtype.str, whole.shape) == ((5, 3), "|u1", (1024, 3))
    assert raster.max() <= 1023
    assert len(stream) <= 7
