"""The sheet: shows pages on a display, and sends only what differs from the page before.

A page is a value: what is below everything, the items over it from the lowest to the highest, and the lookup
table. So a screen only tells what it looks like now. What an item covered is drawn again when it goes: the
base by ERS, or by WI from the host's copy of a picture, and the items that it overlapped. Each change is one
transfer to the display.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.mapping.level_ranges import BACKGROUND
from autocolor.sending import configuration_of, encoder_of_entries
from autocolor.widgets.areas import Area
from autocolor.widgets.items import Item
from ramtek_emu import HostPort, instructions


class Page(NamedTuple):
    """What a display shows: a base, which is one word or the words of a picture, items, and entries.

    `base` has (lines, elements); two pages have the same one only if it is the same array. `entries` are
    (1024, 3).
    """

    base: Words | int
    items: Sequence[Item]
    entries: Bytes


class Sheet:
    """Shows pages on a display, which nothing else may draw on meanwhile.

    The base fills all that the display shows, which may be more than the screens are laid out for.
    """

    def __init__(self, display: HostPort) -> None:
        self._display = display
        self._encode_entries = encoder_of_entries(display)
        sizes = configuration_of(display)
        self._whole = Area(0, 0, sizes.shown_elements - 1, sizes.shown_lines - 1)
        self._page: Page | None = None

    def forget(self) -> None:
        """Take nothing for granted: the next page is drawn whole."""
        self._page = None

    def show(self, page: Page) -> None:
        """Show a page. Raises ReplyError or PortError if the display cannot be reached."""
        parts = list(self._changes(page))
        if parts:
            self._page = None
            self._display.send(np.concatenate(parts))
        self._page = page

    def _changes(self, page: Page) -> Iterator[Words]:
        """The instructions that turn what is shown into a page."""
        before = self._page
        if before is None:
            yield instructions.reset()
            yield self._encode_entries(0, page.entries)
        elif page.entries is not before.entries:
            differing = np.flatnonzero((page.entries != before.entries).any(axis=1))
            if len(differing):
                first, last = int(differing[0]), int(differing[-1])
                yield self._encode_entries(first, page.entries[first : last + 1])
        if before is None or not _is_same(page.base, before.base):
            yield from _restored(page.base, uncovered(self._whole, page.items))
            redrawn = list(page.items)
        else:
            restored, redrawn = changed_items(before.items, page.items)
            for area in restored:
                yield from _restored(page.base, area.within(self._whole))
        for item in redrawn:
            yield np.frombuffer(item.stream, np.uint16)


def changed_items(before: Sequence[Item], now: Sequence[Item]) -> tuple[list[Area], list[Item]]:
    """The areas whose base must be drawn again, and the items to draw again after that, lowest first."""
    if list(before) == list(now):
        return [], []
    old, new = set(before), set(now)
    if [item for item in before if item in new] != [item for item in now if item in old]:
        # What was above something may be below it now.
        old = set()
    fresh = [item for item in now if item not in old]
    gone = [item.area for item in before if item not in new and not item.area.is_empty]
    solid = [item.area for item in fresh if item.is_solid]
    restored = [area for area in gone if not any(each.covers(area) for each in solid)]
    # An item is drawn again if it is new, or if something below it was drawn.
    dirty, redrawn = list(restored), []
    for item in now:
        if item not in old or any(item.area.overlaps(area) for area in dirty):
            redrawn.append(item)
            # Few areas are enough: this is done at each movement, for hundreds of items.
            if not any(area.covers(item.area) for area in dirty):
                dirty.append(item.area)
    return restored, redrawn


def _is_same(base: Words | int, other: Words | int) -> bool:
    if isinstance(base, int) or isinstance(other, int):
        return type(base) is type(other) and base == other
    return base is other


def _restored(base: Words | int, area: Area) -> Iterator[Words]:
    """The instruction that draws an area of the base."""
    if area.is_empty:
        return
    if isinstance(base, int):
        yield instructions.erase(area, base)
        return
    lines, elements = base.shape
    whole = Area(0, 0, elements - 1, lines - 1)
    if not whole.covers(area):
        # Beside a picture that is smaller than the screen is background.
        yield instructions.erase(area, BACKGROUND)
        area = area.within(whole)
    if not area.is_empty:
        part = base[area.top : area.bottom + 1, area.left : area.right + 1]
        yield instructions.write_image(part, area.left, area.top)


def uncovered(area: Area, items: Sequence[Item]) -> Area:
    """An area without what solid items cover along its whole right or lower edge."""
    for _ in range(2):
        for item in items:
            edge = item.area
            if not item.is_solid or edge.right < area.right or edge.bottom < area.bottom:
                continue
            if edge.top <= area.top:
                area = area._replace(right=min(area.right, edge.left - 1))
            elif edge.left <= area.left:
                area = area._replace(bottom=min(area.bottom, edge.top - 1))
    return area
