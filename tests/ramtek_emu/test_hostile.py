"""Streams of real programs with faults, such as bad lines and bad programs cause."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest
from numpy.typing import NDArray

from ramtek_emu import FAMILY, NCAR_9460, PRINCETON_9300, Configuration, Ramtek9300, instructions
from ramtek_emu.monitor.pattern import pattern
from ramtek_emu.testing import check_words_within_planes
from tests.ramtek_emu.recorded_streams import RECORDED
from tests.ramtek_emu.strategies import sent_words


@lru_cache
def sessions() -> tuple[NDArray[np.uint16], ...]:
    """The streams of some programs."""
    modern = sent_words(
        [
            *[0x2701, 0x080E, 0x0041, 0x0006, 0xFF, 0, 512, 639, 1023, 0, 512, 639, 1023, 0, 512, 0x4EFF],
            *[0x0E0F, 0x8002, 0x0008, 7, 10, 532, 0xFF00, 0x1000, 8, 100, 532, 100, 602],
            *[0x6D0B, 2, 9, 6, 300, 800, 50, 0x3A0D, 1, 0xFF, 2, 0, 0x2600, 0x0101],
            *[0x1300, 0x6901, 4, 9, 9, 0x1400, 0x3501, 8, 1, 2, 30, 40, 0x3801, 4, 7, 8],
            *[0x3901, 6, 9, 9, 3, 0x2B00, 0x2402, 0xFFFF, 0x2500, 0x2C00, 3, 4],
        ]
    )
    return np.concatenate(RECORDED), modern, pattern()[:6000]


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
    "configuration", [FAMILY, PRINCETON_9300, NCAR_9460], ids=lambda configuration: configuration.name
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
