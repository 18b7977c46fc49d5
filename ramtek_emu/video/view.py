"""View: converts places of the screen to pixels of the memory, and back.

Three parameters decide: the display origin, the zoom, and whether the video origin is at the bottom of the
screen. All arithmetic with these parameters is in this module.

Hardware: JPL (the origin is the pixel at the screen's top-left corner; zoom repeats pixels 1 to 16 times);
PRG orig.c (the origin wraps around the memory); NCAR (the video origin may be at the bottom, lines count
up).
Assumed: with the video origin at the bottom, the origin is the pixel at the bottom-left corner. Memory,
windows and scan orders do not change.
"""

from __future__ import annotations

from typing import Final, TypeVar

import numpy as np

from ramtek_emu.arrays import Indices, Words
from ramtek_emu.configuration import Configuration
from ramtek_emu.memory.parameters import Parameters

View = tuple[tuple[int, int], tuple[int, int], bool]
"""Origin, zoom, and whether the video origin is at the bottom."""
PLAIN_VIEW: Final[View] = (0, 0), (1, 1), False
"""The view that shows the lines of the memory as they are."""

Place = TypeVar("Place", int, Indices)


def view_of(parameters: Parameters) -> View:
    """The view that the parameters ask for."""
    return parameters.origin, parameters.zoom, parameters.origin_at_bottom


def pixel_at(
    parameters: Parameters, configuration: Configuration, element: Place, line: Place
) -> tuple[Place, Place]:
    """The element and the line of the memory at an element and a line of the screen, or at arrays of them."""
    if parameters.origin_at_bottom:
        line = configuration.shown_lines - 1 - line
    across, down = parameters.zoom
    return (
        shown_at(element, parameters.origin.element, across, configuration.elements),
        shown_at(line, parameters.origin.line, down, configuration.lines),
    )


def screen_at(
    parameters: Parameters, configuration: Configuration, element: int, line: int
) -> tuple[int, int]:
    """The first element and line of the screen, from the video origin on, that show a pixel of the memory.

    If no place of the screen shows the pixel, the result is beyond the screen.
    """
    across, down = parameters.zoom
    element = (element - parameters.origin.element) % configuration.elements * across
    line = (line - parameters.origin.line) % configuration.lines * down
    return element, configuration.shown_lines - 1 - line if parameters.origin_at_bottom else line


def shown_at(place: Place, origin: int, zoom: int, size: int) -> Place:
    """Along one axis, the place in a memory of `size` places that a place of the screen shows.

    >>> [shown_at(place, 638, 2, 640) for place in range(6)]
    [638, 638, 639, 639, 0, 0]
    """
    return (origin + place // zoom) % size


def copy_shown(target: Indices, first: int, memory: Words, parameters: Parameters, shown_lines: int) -> None:
    """Fill the target, lines of the screen from `first` on, with the words of the memory that they show.

    The words are those of `pixel_at`. Measured: taking them by its indices takes four times as long.
    """
    if parameters.origin_at_bottom:
        target, first = target[::-1], shown_lines - first - len(target)
    origin, (across, down) = parameters.origin, parameters.zoom
    if (across, down) == (1, 1):
        for rows, memory_rows in parts(origin.line + first, memory.shape[0], target.shape[0]):
            for columns, memory_columns in parts(origin.element, memory.shape[1], target.shape[1]):
                target[rows, columns] = memory[memory_rows, memory_columns]
        return
    # Zoom each line of the memory once, then repeat it.
    begin, end = first // down, (first + len(target) - 1) // down + 1
    taken = memory.take(shown_at(np.arange(begin, end), origin.line, 1, memory.shape[0]), axis=0)
    elements = shown_at(np.arange(target.shape[1]), origin.element, across, memory.shape[1])
    zoomed = taken.take(elements, axis=1, mode="clip")
    target[...] = zoomed.repeat(down, axis=0)[first % down :][: len(target)]


def parts(first: int, size: int, count: int) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Cut `count` places of the screen where the memory wraps; each part is beside its places in the memory.

    >>> parts(638, 640, 6)
    ((slice(0, 2, None), slice(638, 640, None)), (slice(2, 6, None), slice(0, 4, None)))
    """
    first %= size
    before = min(size - first, count)
    return (
        (slice(0, before), slice(first, first + before)),
        (slice(before, count), slice(0, count - before)),
    )
