"""The sheet: shows pages on a display, and sends only what differs from the page before.

A page is a value: what is below everything, the items over it from the lowest to the highest, and the lookup
table. So a screen only tells what it looks like now. What an item covered is drawn again when it goes: the
base by ERS, or by WI from the host's copy of a picture, and the items that it overlapped. Each change is one
transfer to the display.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from typing import NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.mapping.ranges import BACKGROUND
from autocolor.sending import configuration_of, encoder_of_entries
from autocolor.widgets.items import Area, Item, filled
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
        whole = uncovered(self._whole, page.items)
        if before is None:
            yield from _restored(page.base, whole)
            redrawn = list(page.items)
        else:
            drawn = [area for area in [differing_lines(before.base, page.base, whole)] if not area.is_empty]
            restored, redrawn = changed_items(before.items, page.items, drawn)
            for area in (*drawn, *restored):
                yield from _restored(page.base, area.within(self._whole))
        for item in redrawn:
            yield np.frombuffer(item.stream, np.uint16)


def changed_items(
    before: Sequence[Item], now: Sequence[Item], drawn: Sequence[Area] = ()
) -> tuple[list[Area], list[Item]]:
    """The areas whose base must be drawn again, and the items to draw again after that, lowest first.

    Where something goes that stood on an item of one word, that much of the item is drawn, and not all of it.
    `drawn` are areas whose base is drawn again anyhow.
    """
    if not drawn and list(before) == list(now):
        return [], []
    old, new = set(before), set(now)
    if [item for item in before if item in new] != [item for item in now if item in old]:
        # What was above something may be below it now.
        old = set()
    fresh = [item for item in now if item not in old]
    gone = [item.area for item in before if item not in new and not item.area.is_empty]
    covers = [*drawn, *(item.area for item in fresh if item.is_solid)]
    restored: list[Area] = []
    patches: dict[int, list[Item]] = {}
    for area in gone:
        if any(each.covers(area) for each in covers):
            continue
        ground = ground_of(area, now, old)
        if ground is None:
            restored.append(area)
        else:
            patches.setdefault(ground, []).append(filled(area, now[ground].word or 0))
    # An item is drawn again if it is new, or if something below it was drawn.
    dirty, redrawn = [*drawn, *restored], []
    for number, item in enumerate(now):
        if item not in old or any(item.area.overlaps(area) for area in dirty):
            redrawn.append(item)
            # Few areas are enough: this is done at each movement, for hundreds of items.
            if not any(area.covers(item.area) for area in dirty):
                dirty.append(item.area)
        for patch in patches.get(number, ()):
            redrawn.append(patch)
            dirty.append(patch.area)
    return restored, redrawn


def ground_of(area: Area, items: Sequence[Item], kept: AbstractSet[Item]) -> int | None:
    """The number of the topmost item of one word, among those that are kept, that covers an area."""
    for number in range(len(items) - 1, -1, -1):
        item = items[number]
        if item.word is not None and item.area.covers(area) and item in kept:
            return number
    return None


def differing_lines(before: Words | int, now: Words | int, area: Area) -> Area:
    """The lines of an area in which two bases differ; an empty area if they are the same."""
    nowhere = area._replace(bottom=area.top - 1)
    if isinstance(before, int) or isinstance(now, int):
        is_same = isinstance(before, int) and isinstance(now, int) and before == now
        return nowhere if is_same else area
    if before is now:
        return nowhere
    if before.shape != now.shape:
        return area
    places = slice(area.top, area.bottom + 1), slice(area.left, area.right + 1)
    lines = np.flatnonzero((before[places] != now[places]).any(axis=1))
    if not len(lines):
        return nowhere
    return area._replace(top=area.top + int(lines[0]), bottom=area.top + int(lines[-1]))


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
