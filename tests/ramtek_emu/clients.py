"""Host programs of the time, written anew: they use only a host port and the words of the display.

`Library` has the calls of a C library of 1978. A call writes one instruction; parameters stay set.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ramtek_emu import HostPort
from tests.ramtek_emu.strategies import sent_words

Words = NDArray[np.uint16]
VISIBLE, BLINK, TRACK, ENTER = 1 << 10, 1 << 11, 1 << 12, 1 << 13
Box = tuple[int, int, int, int]
Place = tuple[int, int]


class Library:
    """Calls; a call sends one instruction."""

    def __init__(self, port: HostPort) -> None:
        self.port = port

    def send(self, *words: int) -> None:
        self.port.send(sent_words(words))

    def reset(self) -> None:
        self.send(0x0910)
        self.send(0x0500)

    def color(self, word: int) -> None:
        self.send(0x0802, 0x0002, word)

    def window(self, box: Box) -> None:
        self.send(0x0802, 0x0040, *box)

    def scan(self, order: int) -> None:
        self.send(0x0802, 0x0080, order)

    def start(self, element: int, line: int) -> None:
        self.send(0x0802, 0x8000, element, line)

    def erase(self, word: int) -> None:
        self.send(0x0902, 0x0004, word)

    def write_image(self, box: Box, words: Iterable[int]) -> None:
        row = list(map(int, words))
        self.send(0x0A03, 0x0040, *box, 2 * len(row), *row)

    def read_image(self, box: Box) -> Words:
        """Set the window, then read it without a start point."""
        count = (box[2] - box[0] + 1) * (box[3] - box[1] + 1)
        self.window(box)
        self.send(0x0B01, 2 * count)
        return self.port.receive(count)

    def text(self, box: Box, text: str, swapped: bool = False) -> None:
        self.send(0x0C13 if swapped else 0x0C03, 0x0040, *box, len(text), *pairs(text.encode()))

    def vectors(self, *vertices: Place) -> None:
        self.send(0x0E01, 4 * len(vertices), *(number for vertex in vertices for number in vertex))

    def conic(self, coefficients: Sequence[int], stop: Place) -> None:
        self.send(
            0x0F03, 0x1000, *(word for coefficient in coefficients for word in (0, coefficient)), 4, *stop
        )

    def write_cursor(self, number: int, place: Place, state: int) -> None:
        self.send(0x1600 | number, place[0], place[1] | state)

    def read_cursor(self, number: int) -> tuple[int, int, int]:
        """The element, the line and the state of a cursor."""
        self.send(0x1700 | number)
        element, word = self.port.receive(2).tolist()
        return element & 0x3FF, word & 0x3FF, word & ~0x3FF


def pairs(data: bytes, low_first: bool = False) -> list[int]:
    """Bytes as words, high byte first unless reverse packed."""
    padded = data + bytes(len(data) % 2)
    words: list[int] = np.frombuffer(padded, "<u2" if low_first else ">u2").tolist()
    return words


def fill_polygon(library: Library, corners: Sequence[Place], outline: int, inside: int) -> None:
    """Outline a convex polygon, read its lines back and fill them between the outlines."""
    library.color(outline)
    library.start(*corners[0])
    library.vectors(*corners[1:], corners[0])
    left, right = min(corner[0] for corner in corners), max(corner[0] for corner in corners)
    top, bottom = min(corner[1] for corner in corners), max(corner[1] for corner in corners)
    for line in range(top, bottom + 1):
        found = np.flatnonzero(library.read_image((left, line, right, line)) == outline)
        first, last = left + int(found[0]), left + int(found[-1])
        row = library.read_image((first, line, last, line))
        row[row != outline] = inside
        library.write_image((first, line, last, line), row)


def mirror_image(library: Library, box: Box, corner: Place) -> None:
    """Read a picture column by column and write it elsewhere, right to left."""
    width, height = box[2] - box[0] + 1, box[3] - box[1] + 1
    library.scan(4)
    columns = library.read_image(box)
    library.scan(6)
    library.write_image((corner[0], corner[1], corner[0] + width - 1, corner[1] + height - 1), columns)
    library.scan(0)


def draft(library: Library, color: int, hand: Callable[[], object]) -> list[list[Place]]:
    """Follow cursor 0 with lines while TRACK is on, until ENTER; `hand` moves and presses for the user."""
    library.color(color)
    library.write_cursor(0, (320, 240), VISIBLE)
    strokes: list[list[Place]] = []
    pen_is_down = False
    while True:
        hand()
        element, line, state = library.read_cursor(0)
        if state & ENTER:
            library.write_cursor(0, (element, line), 0)
            return strokes
        if state & TRACK:
            if not pen_is_down:
                library.start(element, line)
                strokes.append([])
            library.vectors((element, line))
            strokes[-1].append((element, line))
        pen_is_down = bool(state & TRACK)


def chase(library: Library, places: Iterable[Place], size: int) -> None:
    """Move a square about, partly off the screen."""
    last: Box | None = None
    for element, line in places:
        if last is not None:
            library.window(last)
            library.erase(0)
        last = (element, line, element + size - 1, line + size - 1)
        library.window(last)
        library.erase(7)
