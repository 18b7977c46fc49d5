"""Random items and pages, and displays that show them."""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Sequence

import numpy as np
from hypothesis import strategies as st

from autocolor.mapping.ranges import SCREENS
from autocolor.widgets.items import Area, Item, filled, image, lines, outline, text
from ramtek_emu import Configuration, Ramtek9300
from ramtek_emu.testing import words

TINY = Configuration(name="tiny", elements=48, lines=40, planes=10)
"""A display on which random items often meet."""

places = st.integers(-12, 60)


@st.composite
def areas(draw: st.DrawFn) -> Area:
    """Areas on a tiny display, across its edges, beyond them, or empty."""
    left, top = draw(places), draw(places)
    return Area(left, top, left + draw(st.integers(-3, 30)), top + draw(st.integers(-3, 30)))


@st.composite
def items(draw: st.DrawFn) -> Item:
    """Items of every kind."""
    area, word = draw(areas()), draw(words())
    kind = draw(st.sampled_from(["filled", "outline", "text", "lines", "image"]))
    if kind == "filled":
        return filled(area, word)
    if kind == "outline":
        return outline(area, word)
    if kind == "text":
        line = draw(st.text("aM.", max_size=4))
        return text(line, area.left, area.top, word, draw(words()), draw(st.integers(1, 2)))
    if kind == "lines":
        far = st.one_of(places, places, st.sampled_from([-1e30, -70000.0, 70000.0, 1e30, float("nan")]))
        polyline = st.lists(st.tuples(far, far), max_size=4)
        return lines(draw(st.lists(polyline, max_size=3)), word, area)
    across, down = draw(st.integers(1, 9)), draw(st.integers(1, 9))
    return image(np.arange(across * down, dtype=np.uint16).reshape(down, across), area.left, area.top)


def draw_items(display: Ramtek9300, drawn: Sequence[Item]) -> None:
    """Send the instructions of some items, in their order."""
    for item in drawn:
        display.send(np.frombuffer(item.stream, np.uint16))


IMAGE = image(np.zeros((1, 1), np.uint16), 0, 0).stream[:2]
"""The word that an image begins with."""


def checksum(drawn: Iterable[Item], *, skips_images: bool = False) -> int:
    """A number for the areas and the instructions of items.

    Rounding may change the words of a picture: with `skips_images` only the area of an image counts.
    """
    total = 0
    for item in drawn:
        total = zlib.crc32(np.array(item.area, np.int64).tobytes(), total)
        if not (skips_images and item.stream.startswith(IMAGE)):
            total = zlib.crc32(item.stream, total)
    return total


def drawing_on(display: Ramtek9300) -> int:
    """A number for what stands over the picture: words of the picture itself depend on rounding."""
    words = display.words
    return zlib.crc32(np.where(words >= SCREENS.first, words, 0).astype(np.uint16).tobytes())
