"""Placement: where a window shows the field, and which pixel of the field is under the mouse."""

from __future__ import annotations

from typing import NamedTuple


class Placement(NamedTuple):
    """The rectangle of the window that shows the field: left, top, width and height in pixels."""

    left: int
    top: int
    width: int
    height: int


def placement(field: tuple[int, int], window: tuple[int, int], fit: bool = False) -> Placement:
    """Where a (width, height) window shows a (width, height) field, enlarged by a whole number unless `fit`.

    A window that is smaller than the field shows its middle.

    >>> placement((640, 480), (1400, 1000))
    Placement(left=60, top=20, width=1280, height=960)
    """
    ratio = min(window[0] / field[0], window[1] / field[1])
    if fit:
        width, height = (max(1, int(size * ratio + 0.5)) for size in field)
    else:
        multiple = max(1, int(ratio))
        width, height = field[0] * multiple, field[1] * multiple
    return Placement((window[0] - width) // 2, (window[1] - height) // 2, width, height)


def pixel_under(
    place: tuple[int, int], field: tuple[int, int], window: tuple[int, int], fit: bool = False
) -> tuple[int, int]:
    """The element and line of the field at a place of the window; outside the field, the nearest at its edge.

    >>> pixel_under((0, 999), (640, 480), (1400, 1000))
    (0, 479)
    """
    left, top, width, height = placement(field, window, fit)
    element = (place[0] - left) * field[0] // width
    line = (place[1] - top) * field[1] // height
    return min(max(element, 0), field[0] - 1), min(max(line, 0), field[1] - 1)
