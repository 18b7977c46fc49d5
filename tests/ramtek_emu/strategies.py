"""Strategies of the tests alone; those of `ramtek_emu.testing` are for everybody."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import Configuration
from ramtek_emu.instruction_set.instruction import OperandValue, encode, normal
from ramtek_emu.memory.scan_orders import Window

SMALL = Configuration(name="SMALL", elements=13, lines=9, planes=10)

scan_codes = st.integers(0, 7)
masks = st.integers(0, 1023) | st.just(0xFFFF)


@st.composite
def windows(draw: st.DrawFn) -> Window:
    """A window that may lie partly or wholly outside the small memory; never empty."""
    left, top = draw(st.integers(-6, 15)), draw(st.integers(-6, 11))
    return Window(left, top, left + draw(st.integers(0, 16)), top + draw(st.integers(0, 12)))


def cuts(stream: list[int], places: list[int]) -> list[NDArray[np.uint16]]:
    """The pieces of a stream that is cut at these places."""
    edges = sorted({0, len(stream), *(place % (len(stream) + 1) for place in places)})
    return [np.array(stream[a:b], np.uint16) for a, b in itertools.pairwise(edges)]


def sent_words(numbers: Iterable[int]) -> NDArray[np.uint16]:
    """Numbers as 16-bit words; negative numbers in two's complement."""
    return np.array([number & 0xFFFF for number in numbers], np.uint16)


SLICED = ("WVL", "WVU", "CIRC", "FILL", "COPY", "WT", "WC", "WPB", "ERS", "BERS")
"""Instructions that can be executed in slices."""
DRAWING = (*SLICED, "WI", "WR", "RI", "WPT", "WRP", "SET")


@st.composite
def drawing_instructions(
    draw: st.DrawFn, names: Sequence[str] = DRAWING, farthest: int = 0x7FFF
) -> NDArray[np.uint16]:
    """An instruction near the small memory or far away, with any flags, operands and data."""
    coordinate = st.integers(-6, 18) | st.sampled_from([-farthest - 1, farthest])
    small = st.integers(0, 3)
    operands: dict[str, st.SearchStrategy[OperandValue | None]] = {
        "mask": masks,
        "foreground": st.integers(0, 3) | st.integers(0, 0xFFFF),
        "background": st.integers(0, 1023),
        "index_1": st.tuples(coordinate, coordinate),
        "index_2": st.tuples(coordinate, coordinate),
        "window": windows() | st.tuples(*[coordinate] * 4),
        "scan_order": st.integers(0, 8),
        "dimensions": st.tuples(st.integers(0, 9), st.integers(0, 17)),
        "spacing": st.tuples(small, small),
        "base_line": coordinate,
        "scale": st.sampled_from([0, 0, 1, 0x0100, 0x0201]),
        "start": st.tuples(coordinate, coordinate),
        "read_mask": masks,
        "write_window": windows(),
        "texture": st.tuples(st.sampled_from([0xFFFF, 0xAAAA, 0xF731]), small),
        "image_mode": small,
    }
    given_operands = draw(st.fixed_dictionaries({}, optional=operands))
    name = draw(st.sampled_from(names))
    if name == "SET":
        numbers = draw(st.lists(st.integers(-20, 20), min_size=5, max_size=5))
        given_operands["conic"] = [*numbers, draw(st.integers(0, 60))]
    flags = draw(st.sampled_from([0, 0x40, 0x80, 0xC0])) | draw(st.sampled_from([0, 8, 0x10, 0x20]))
    has_points = name in ("WVL", "WVU", "CIRC", "WC", "WPT", "COPY")
    number = coordinate if has_points else coordinate | st.integers(0, 0xFFFF)
    data = sent_words(draw(st.lists(number, max_size=24 if has_points else 40)))
    length = max(0, 2 * len(data) - draw(st.integers(0, 1)))
    if name == "RI":
        length, data = draw(st.integers(0, 300)), data[:0]
    return encode(normal(name, given_operands, data, length, flags))
