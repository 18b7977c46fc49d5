"""The sheet: shows pages on a display, and sends only what differs from the page before.

A page is a value: a base, the items over it from the lowest to the highest, and the lookup table. So a screen
only says how it looks now. When an item goes, the sheet draws the pixels below it again: the base by ERS, or
by WI from the host's copy of a picture, and the items that overlapped it. Each change is one transfer to the
display.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Bytes, Numbers, Words
from autocolor.immutable import read_only
from autocolor.mapping.ranges import BACKGROUND
from autocolor.sending import configuration_of, encoder_of_entries
from autocolor.widgets.items import Area, Item, filled
from ramtek_emu import HostPort, instructions


class Page(NamedTuple):
    """The contents of a display: a base, which is one word or the words of a picture, items, and entries.

    Words of a base are (lines, elements); two pages share a base only if it is the same array. `entries` is
    (1024, 3).
    """

    base: Words | int
    items: Sequence[Item]
    entries: Bytes


class Sent(NamedTuple):
    """The words that a sheet sent to show a page."""

    words: Words
    """The instructions in the order in which they were sent, (n,) uint16, read-only."""
    entry_words: int
    """The number of the first words: they load entries. Those of a first page also reset the display."""
    base_words: int
    """The number of the next words, which write a base that is a picture. All further words are for items."""


class Sheet:
    """Shows pages on a display, on which nothing else may draw meanwhile.

    The base fills the whole display, which may be larger than the screens.
    """

    def __init__(self, display: HostPort) -> None:
        self._display = display
        self._encode_entries = encoder_of_entries(display)
        sizes = configuration_of(display)
        self._whole = Area(0, 0, sizes.shown_elements - 1, sizes.shown_lines - 1)
        self._page: Page | None = None

    def show(self, page: Page) -> Sent:
        """Show a page; returns its words. Raises ReplyError or PortError if the display cannot be reached."""
        entries, base, others = self._changes(page)
        stream = read_only(np.concatenate([np.zeros(0, np.uint16), *entries, *base, *others]))
        if len(stream):
            self._page = None
            self._display.send(stream)
        self._page = page
        return Sent(stream, sum(map(len, entries)), sum(map(len, base)))

    def words(self) -> Words:
        """The words that are shown, (lines, elements), read back from the display."""
        left, top, right, bottom = self._whole
        parts = []
        for read, count in instructions.read_image(left, top, right + 1, bottom + 1):
            self._display.send(read)
            parts.append(self._display.receive(count))
        return np.concatenate(parts).reshape(bottom + 1, right + 1)

    def _changes(self, page: Page) -> tuple[list[Words], list[Words], list[Words]]:
        """The instructions that change the display from the page before to this page.

        Instructions for entries are first, then for a base that is a picture, then for everything else.
        """
        before = self._page
        entries: list[Words] = []
        if before is None:
            entries = [instructions.reset(), self._encode_entries(0, page.entries)]
        elif page.entries is not before.entries:
            differing = np.flatnonzero((page.entries != before.entries).any(axis=1))
            if len(differing):
                first, last = int(differing[0]), int(differing[-1])
                entries = [self._encode_entries(first, page.entries[first : last + 1])]
        base, items = (None, ()) if before is None else (before.base, before.items)
        drawn = differing_area(base, page.base, uncovered(self._whole, page.items))
        restored, redrawn = changed_items(items, page.items, [] if drawn.is_empty else [drawn])
        others = [words for area in restored for words in _restored(page.base, area.within(self._whole))]
        others += [np.frombuffer(item.stream, np.uint16) for item in redrawn]
        picture = _restored(page.base, drawn)
        return (entries, [], picture + others) if isinstance(page.base, int) else (entries, picture, others)


def changed_items(
    before: Sequence[Item], now: Sequence[Item], drawn: Sequence[Area] = ()
) -> tuple[list[Area], list[Item]]:
    """The areas whose base must be drawn again, and then the items to draw again, lowest first.

    When an item over an item of one word goes, only its area of the lower item is drawn again. `drawn` are
    areas whose base is drawn again anyhow.
    """
    if not drawn and list(before) == list(now):
        return [], []
    old, new = set(before), set(now)
    if [item for item in before if item in new] != [item for item in now if item in old]:
        # The order changed: an item that was above another may be below it now. Draw all items again.
        old = set()
    stays = [item in old for item in now]
    # Hundreds of items are compared at each movement: all at once, by the columns of their areas.
    areas = _columns([item.area for item in now])
    grounds = np.array(
        [stay and item.word is not None for item, stay in zip(now, stays, strict=True)], np.bool_
    )
    covers = [item.area for item, stay in zip(now, stays, strict=True) if item.is_solid and not stay]
    covering = _columns([*drawn, *covers])
    restored: list[Area] = []
    patches: dict[int, list[Item]] = {}
    for item in before:
        area = item.area
        if item in new or area.is_empty or _covering(covering, area).any():
            continue
        ground = np.flatnonzero(_covering(areas, area) & grounds)
        if len(ground):
            topmost = int(ground[-1])
            patches.setdefault(topmost, []).append(filled(area, now[topmost].word or 0))
        else:
            restored.append(area)
    # Draw an item again if it is new, or if something below it was drawn.
    is_dirty = np.zeros(len(now), np.bool_)
    for area in (*drawn, *restored):
        is_dirty |= _overlapping(areas, area)
    redrawn: list[Item] = []
    for number, item in enumerate(now):
        if is_dirty[number] or not stays[number]:
            redrawn.append(item)
            is_dirty |= _overlapping(areas, item.area)
        for patch in patches.get(number, ()):
            redrawn.append(patch)
            is_dirty |= _overlapping(areas, patch.area)
    return restored, redrawn


def _columns(areas: Sequence[Area]) -> Numbers:
    """The left, top, right and bottom of areas, (4, n)."""
    # Of a list of tuples, `np.array` takes three times as long.
    return np.fromiter(chain.from_iterable(areas), np.int64, 4 * len(areas)).reshape(-1, 4).T.copy()


def _covering(columns: Numbers, area: Area) -> Booleans:
    """Whether each of some areas covers an area, (n,)."""
    left, top, right, bottom = columns
    covers: Booleans = (left <= area[0]) & (top <= area[1]) & (right >= area[2]) & (bottom >= area[3])
    return covers


def _overlapping(columns: Numbers, area: Area) -> Booleans:
    """Whether each of some areas has a pixel in common with an area, (n,)."""
    left, top, right, bottom = columns
    overlaps: Booleans = (left <= area[2]) & (top <= area[3]) & (right >= area[0]) & (bottom >= area[1])
    return overlaps


def differing_area(before: Words | int | None, now: Words | int, area: Area) -> Area:
    """The smallest part of an area in which two bases differ; an empty area if they are the same."""
    nowhere = area._replace(bottom=area.top - 1)
    if before is now:
        return nowhere
    if isinstance(before, np.ndarray) and isinstance(now, np.ndarray) and before.shape == now.shape:
        places = slice(area.top, area.bottom + 1), slice(area.left, area.right + 1)
        differs = before[places] != now[places]
        lines, elements = (np.flatnonzero(differs.any(axis=axis)).tolist() for axis in (1, 0))
        if not lines:
            return nowhere
        left, top = area.left + elements[0], area.top + lines[0]
        return Area(left, top, area.left + elements[-1], area.top + lines[-1])
    return nowhere if isinstance(before, int) and isinstance(now, int) and before == now else area


def _restored(base: Words | int, area: Area) -> list[Words]:
    """The instructions that draw an area of the base."""
    if area.is_empty:
        return []
    if isinstance(base, int):
        return [instructions.erase(area, base)]
    lines, elements = base.shape
    left, top, right, bottom = inside = area.within(Area(0, 0, elements - 1, lines - 1))
    # Beside a picture that is smaller than the screen is background.
    parts = [] if inside == area else [instructions.erase(area, BACKGROUND)]
    if not inside.is_empty:
        parts.append(instructions.write_image(base[top : bottom + 1, left : right + 1], left, top))
    return parts


def uncovered(area: Area, items: Sequence[Item]) -> Area:
    """An area without the strips along its whole upper, right or lower edge that solid items cover."""
    for _ in range(2):
        for item in items:
            edge = item.area
            if not item.is_solid or edge.right < area.right:
                continue
            if edge.left <= area.left and edge.top <= area.top:
                area = area._replace(top=max(area.top, edge.bottom + 1))
            elif edge.bottom >= area.bottom and edge.top <= area.top:
                area = area._replace(right=min(area.right, edge.left - 1))
            elif edge.bottom >= area.bottom and edge.left <= area.left:
                area = area._replace(bottom=min(area.bottom, edge.top - 1))
    return area
