"""Strategies of the tests alone; those of `ramtek_emu.testing` are for everybody."""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import Configuration
from ramtek_emu.memory.scan_orders import Point, Window

quick = settings(deadline=None, max_examples=60)
thorough = settings(deadline=None, max_examples=150)

SMALL = Configuration(name="SMALL", elements=13, lines=9, planes=10)

scan_codes = st.integers(0, 7)
masks = st.integers(0, 1023) | st.just(0xFFFF)
points = st.builds(Point, st.integers(-6, 18), st.integers(-6, 14))


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
