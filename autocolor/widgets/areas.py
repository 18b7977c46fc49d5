"""Areas of the screen: rectangles of pixels.

Positions are an element and a line. Whole numbers are the centers of pixels, line 0 on top.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from autocolor.widgets.colors import HEIGHT, WIDTH


class Area(NamedTuple):
    """A rectangle of pixels, its edges included."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def width(self) -> int:
        """The number of elements."""
        return self.right - self.left + 1

    @property
    def height(self) -> int:
        """The number of lines."""
        return self.bottom - self.top + 1

    @property
    def is_empty(self) -> bool:
        """Whether it has no pixels."""
        return self.right < self.left or self.bottom < self.top

    def has(self, element: float, line: float) -> bool:
        """Whether a position is inside."""
        return self.left <= element <= self.right and self.top <= line <= self.bottom

    @property
    def middle(self) -> tuple[float, float]:
        """The element and the line of the middle, which may lie between pixels."""
        return (self.left + self.right) / 2, (self.top + self.bottom) / 2

    def overlaps(self, other: Area) -> bool:
        """Whether the two have a pixel in common."""
        return (
            self.left <= other.right
            and other.left <= self.right
            and self.top <= other.bottom
            and other.top <= self.bottom
        )

    def covers(self, other: Area) -> bool:
        """Whether all pixels of another area are inside."""
        return (
            self.left <= other.left
            and other.right <= self.right
            and self.top <= other.top
            and other.bottom <= self.bottom
        )

    def within(self, other: Area) -> Area:
        """The pixels that both have."""
        return Area(
            max(self.left, other.left),
            max(self.top, other.top),
            min(self.right, other.right),
            min(self.bottom, other.bottom),
        )

    def inset(self, margin: int) -> Area:
        """The area without a margin on all sides."""
        return Area(self.left + margin, self.top + margin, self.right - margin, self.bottom - margin)


SCREEN: Final = Area(0, 0, WIDTH - 1, HEIGHT - 1)
