"""Streams of real programs with faults, such as bad lines and bad programs cause."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest
from numpy.typing import NDArray

from ramtek_emu import GMR_9300, NCAR_9460, PRINCETON_9300, Configuration, Ramtek9300, instructions
from ramtek_emu.monitor.pattern import pattern
from ramtek_emu.testing import check_words_within_planes
from tests.ramtek_emu.clients import Library, chase, fill_polygon, mirror_image
from tests.ramtek_emu.strategies import sent_words


class Listener(Ramtek9300):
    """A display that records the words that it was sent."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        super().__init__(configuration)
        self.heard: list[NDArray[np.uint16]] = []

    def send(self, words: NDArray[np.uint16]) -> None:
        self.heard.append(words)
        super().send(words)


@lru_cache
def sessions() -> tuple[NDArray[np.uint16], ...]:
    """The streams of some programs."""
    drawing = Listener()
    library = Library(drawing)
    library.reset()
    fill_polygon(library, [(100, 40), (130, 50), (120, 70)], 9, 4)
    mirror_image(library, (90, 30, 120, 60), (300, 300))
    chase(library, [(600, 470), (-10, -10), (3, -2)], 16)
    library.text((10, 10, 90, 30), "What is this?", swapped=True)
    library.start(300, 200)
    library.conic((1, 1, 0, 80, 0, 0), (260, 240))
    library.write_cursor(0, (5, 6), 0x400)
    library.read_cursor(0)
    modern = sent_words(
        [
            *[0x2701, 0x080E, 0x0041, 0x0006, 0xFF, 0, 512, 639, 1023, 0, 512, 639, 1023, 0, 512, 0x4EFF],
            *[0x0E0F, 0x8002, 0x0008, 7, 10, 532, 0xFF00, 0x1000, 8, 100, 532, 100, 602],
            *[0x6D0B, 2, 9, 6, 300, 800, 50, 0x3A0D, 1, 0xFF, 2, 0, 0x2600, 0x0101],
            *[0x1300, 0x6901, 4, 9, 9, 0x1400, 0x3501, 8, 1, 2, 30, 40, 0x3801, 4, 7, 8],
            *[0x3901, 6, 9, 9, 3, 0x2B00, 0x2402, 0xFFFF, 0x2500, 0x2C00, 3, 4],
        ]
    )
    return np.concatenate(drawing.heard), modern, pattern()[:6000]


def with_faults(stream: NDArray[np.uint16], random: np.random.Generator) -> NDArray[np.uint16]:
    """The stream with a few words changed, lost, doubled or inserted."""
    faulty = stream.copy()
    for _ in range(int(random.integers(1, 6))):
        place = int(random.integers(0, len(faulty)))
        kind = random.integers(0, 5)
        if kind == 0:
            faulty[place] ^= np.uint16(1 << random.integers(0, 16))
        elif kind == 1:
            faulty = np.delete(faulty, place)
        elif kind == 2:
            faulty = np.insert(faulty, place, random.integers(0, 0x10000, 3).astype(np.uint16))
        elif kind == 3:
            faulty = np.concatenate((faulty[:place], faulty[max(0, place - 20) :]))
        else:
            faulty[place : place + 4] = faulty[place : place + 4].byteswap()
    return faulty


@pytest.mark.parametrize(
    "configuration", [GMR_9300, PRINCETON_9300, NCAR_9460], ids=lambda configuration: configuration.name
)
@pytest.mark.parametrize("session", range(3))
@pytest.mark.parametrize("count", [12, pytest.param(100, marks=pytest.mark.thorough)])
def test_streams_with_faults_are_drawn_somehow_and_do_no_harm(
    configuration: Configuration, session: int, count: int
) -> None:
    random = np.random.default_rng(session)
    display = Ramtek9300(configuration)
    for _ in range(count):
        display.send(with_faults(sessions()[session], random))
        check_words_within_planes(display.words, configuration.planes)
        assert display.decoder.pending_words < 0x8100
    display.field()
    display.reset()
    display.send(instructions.write_image(np.full((480, 640), 200)))
    assert (display.words[:480, :640] == 200).all()
    assert display.status == type(display.status).READY
