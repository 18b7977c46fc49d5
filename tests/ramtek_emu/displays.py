"""Displays with words sent to them; their replies, memories and windows."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from ramtek_emu import Ramtek9300, instructions


@contextmanager
def smallest_slices() -> Iterator[None]:
    """Long instructions are executed in the smallest slices, such as single lines or circles."""
    with pytest.MonkeyPatch.context() as patch:
        for limit in (
            "drawing.vectors.MOST_POINTS",
            "drawing.areas.PIXELS_AT_ONCE",
            "drawing.areas.RUNS_AT_ONCE",
            "video.scan_out.PAINTED_AT_ONCE",
        ):
            patch.setattr(f"ramtek_emu.{limit}", 1)
        yield


def colored(display: Ramtek9300) -> Ramtek9300:
    """The display with a dark picture."""
    entries = display.configuration.largest_word + 1
    display.send(instructions.load_entries(0, np.full((entries, 3), 40)))
    display.send(instructions.park_table())
    return display


def shown() -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """The pixels of the window, (height, width, 3)."""
    import pygame

    return np.asarray(pygame.surfarray.array3d(pygame.display.get_surface())).transpose(1, 0, 2)
