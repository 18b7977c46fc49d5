"""Windows, points and the eight scan orders: the place of each word of an image.

A window is inclusive at both ends and may lie partly or wholly outside the memory. Words follow each other in
the inner direction; at the edge of the window they continue one step further in the outer direction. A run is
a line or a column of the window, from edge to edge. Steps are counted from the corner where the scan starts:
inner steps in words, outer steps in runs.

Hardware: PRG, LONG, ASF (the eight codes); LIN, JPL (the run wraps at the window's edge to the next line).
Assumed: at the end of the window, words continue at the corner where the scan starts, as counters do. Words
that start before the window continue into it, since counters compare with the far edges only (JPL reads pairs
of pixels from even elements on, also where its window begins at an odd one). A start beyond the far edge of a
run is at the next run, and one beyond the last run is at the first.
Assumed: a window is empty if its right is less than its left, or its bottom less than its top.

Images of bytes are sent in pairs, two pixels in a word of the host.
Hardware: JPL (with a window of odd width "an additional pixel will be written per line", which offsets what
follows, so its driver refuses such areas and ends odd lines with a pair of their own).
Assumed: the display looks for the edge of the window after each pair. So a run holds whole pairs, the second
pixel of its last pair may lie one step past the edge, and the next run begins with the next word. Reading
follows the same order, so it returns the pixels that were written. A pair begins wherever the operating
point is.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from ramtek_emu.arrays import Raster, Scalar


class Point(NamedTuple):
    """An element (x) and a line (y)."""

    element: int
    line: int


class Window(NamedTuple):
    """A rectangle of pixels: left, top, right and bottom, all inclusive."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def width(self) -> int:
        """The number of elements in a line."""
        return max(0, self.right - self.left + 1)

    @property
    def height(self) -> int:
        """The number of lines."""
        return max(0, self.bottom - self.top + 1)

    @property
    def is_empty(self) -> bool:
        """Whether the window holds no word."""
        return self.right < self.left or self.bottom < self.top

    def holds(self, point: Point) -> bool:
        """Whether the point lies inside."""
        return self.left <= point.element <= self.right and self.top <= point.line <= self.bottom

    def intersection(self, other: Window) -> Window:
        """The part that both windows cover; it may be empty."""
        return Window(
            max(self.left, other.left),
            max(self.top, other.top),
            min(self.right, other.right),
            min(self.bottom, other.bottom),
        )


class ScanOrder(NamedTuple):
    """The directions of one of the eight codes."""

    vertical: bool
    leftward: bool
    upward: bool

    def oriented(self, raster: Raster[Scalar]) -> Raster[Scalar]:
        """A view of [line, element] data as [outer, inner]."""
        if self.leftward:
            raster = raster[:, ::-1]
        if self.upward:
            raster = raster[::-1]
        return raster.T if self.vertical else raster

    def inner_and_outer(self, window: Window) -> tuple[int, int]:
        """The number of words in a run, and the number of runs in the window."""
        if self.vertical:
            return window.height, window.width
        return window.width, window.height

    def corner(self, window: Window) -> Point:
        """Where the scan of the window starts."""
        return Point(
            window.right if self.leftward else window.left, window.bottom if self.upward else window.top
        )

    def steps(self, window: Window, point: Point) -> tuple[int, int]:
        """The inner and outer steps from the corner to a point; negative if the point lies before it."""
        across = window.right - point.element if self.leftward else point.element - window.left
        down = window.bottom - point.line if self.upward else point.line - window.top
        return (down, across) if self.vertical else (across, down)

    def stepped(self, corner: Point, inner: int, outer: int) -> Point:
        """The point at these steps from the corner: the inverse of `steps`."""
        across, down = (outer, inner) if self.vertical else (inner, outer)
        return Point(
            corner.element + (-across if self.leftward else across),
            corner.line + (-down if self.upward else down),
        )

    def entry(self, window: Window, start: Point) -> tuple[int, int]:
        """The inner and outer steps of the first word of a scan that begins at `start`."""
        inner, outer = self.steps(window, start)
        along, runs = self.inner_and_outer(window)
        if inner >= along:
            inner, outer = 0, outer + 1
        return inner, 0 if outer >= runs else outer

    def words_around(self, window: Window, start: Point, pairs: bool) -> tuple[int, int]:
        """How many words the scan takes from `start` to the corner, and around the window from there."""
        inner, outer = self.entry(window, start)
        along, runs = self.inner_and_outer(window)
        run = whole(along, pairs)
        return whole(along - inner, pairs) + (runs - outer - 1) * run, run * runs

    def block_window(self, start: Point, outer: int, inner: int) -> Window:
        """The window of an [outer, inner] block with its first word at `start`."""
        width, height = (outer, inner) if self.vertical else (inner, outer)
        left = start.element - width + 1 if self.leftward else start.element
        top = start.line - height + 1 if self.upward else start.line
        return Window(left, top, left + width - 1, top + height - 1)


SCAN_ORDERS: Final = (
    ScanOrder(False, False, False),  # 0: left to right, top to bottom
    ScanOrder(False, True, False),  # 1: right to left, top to bottom
    ScanOrder(False, False, True),  # 2: left to right, bottom to top
    ScanOrder(False, True, True),  # 3: right to left, bottom to top
    ScanOrder(True, False, False),  # 4: top to bottom, left to right
    ScanOrder(True, False, True),  # 5: bottom to top, left to right
    ScanOrder(True, True, False),  # 6: top to bottom, right to left
    ScanOrder(True, True, True),  # 7: bottom to top, right to left
)


def whole(words: int, pairs: bool) -> int:
    """The number of words, or with `pairs` of pixels in whole pairs, that so many words of a run take."""
    return words + words % 2 if pairs else words


def blocks(
    window: Window, order: ScanOrder, start: Point, count: int, pairs: bool = False
) -> tuple[list[tuple[Window, tuple[int, int], slice]], Point]:
    """The rectangles that `count` words from `start` on fill, and the point after the last word.

    A rectangle is its window, its (outer, inner) shape, and the slice of its words. There are at most
    three for each time around the window. With `pairs`, the words are pixels in pairs.
    """
    along, runs = order.inner_and_outer(window)
    corner = order.corner(window)
    inner, outer = order.entry(window, start)
    parts = []
    done = 0
    while done < count:
        point = order.stepped(corner, inner, outer)
        left, room = count - done, whole(along - inner, pairs)
        whole_runs = left // room if inner == 0 else 0
        shape = (min(whole_runs, runs - outer), room) if whole_runs else (1, min(left, room))
        size = shape[0] * shape[1]
        parts.append((order.block_window(point, *shape), shape, slice(done, done + size)))
        done += size
        inner += shape[1]
        if shape[1] == room:
            inner, outer = 0, outer + shape[0]
            outer = 0 if outer == runs else outer
    return parts, order.stepped(corner, inner, outer) if count else start
