"""Displays with words sent to them; their replies, memories and windows."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from ramtek_emu import FAMILY, Configuration, Ramtek9300, instructions
from tests.ramtek_emu.strategies import sent_words


def sent(*texts: str, configuration: Configuration = FAMILY) -> Ramtek9300:
    """A display that was sent these words, in hexadecimal; FAMILY takes every instruction."""
    display = Ramtek9300(configuration)
    for text in texts:
        display.send(np.array([int(word, 16) for word in text.split()], np.uint16))
    return display


@contextmanager
def smallest_slices() -> Iterator[None]:
    """Long instructions are executed in the smallest slices: by single lines, circles and runs."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ramtek_emu.drawing.vectors.MOST_POINTS", 1)
        patch.setattr("ramtek_emu.drawing.areas.MOST_RUNS", 1)
        patch.setattr("ramtek_emu.processor.image_executors.MOST_COPIED", 1)
        yield


def box(display: Ramtek9300) -> tuple[int, int, int, int]:
    """Left, top, right and bottom of the words that are not 0."""
    lines, elements = np.nonzero(display.words)
    return (int(elements.min()), int(lines.min()), int(elements.max()), int(lines.max()))


def read(display: Ramtek9300, *words: int) -> list[int]:
    """The replies of the display to these words."""
    display.send(sent_words(words))
    answer: list[int] = display.receive(display.processor.waiting).tolist()
    return answer


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
