"""View: which pixel of the memory is shown where on the screen.

Hardware: JPL (the origin is the pixel at the screen's top-left corner; zoom repeats pixels 1 to 16 times);
PRG orig.c (the origin wraps around the memory); NCAR (the video origin may be at the bottom, lines count
up).
Assumed: with the video origin at the bottom the origin is the pixel at the bottom-left corner; memory,
windows and scan orders stay as they are.
"""

from __future__ import annotations

from ramtek_emu.configuration import Configuration
from ramtek_emu.memory.parameters import Parameters


def pixel_at(
    parameters: Parameters, configuration: Configuration, element: int, line: int
) -> tuple[int, int]:
    """The pixel of the memory that is shown at an element and a line of the screen."""
    if parameters.origin_at_bottom:
        line = configuration.shown_lines - 1 - line
    across, down = parameters.zoom
    return (
        (parameters.origin.element + element // across) % configuration.elements,
        (parameters.origin.line + line // down) % configuration.lines,
    )


def screen_at(
    parameters: Parameters, configuration: Configuration, element: int, line: int
) -> tuple[int, int]:
    """The first element and line of the screen, from the video origin on, where a pixel is shown.

    It lies beyond the screen when the pixel is not shown.
    """
    across, down = parameters.zoom
    element = (element - parameters.origin.element) % configuration.elements * across
    line = (line - parameters.origin.line) % configuration.lines * down
    return element, configuration.shown_lines - 1 - line if parameters.origin_at_bottom else line
