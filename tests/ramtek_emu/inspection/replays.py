"""Replays of small displays that keep states often, and the slow way to the same results."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from numpy.typing import NDArray

from ramtek_emu import Configuration, Ramtek9300
from ramtek_emu.inspection import replay as module
from ramtek_emu.inspection.replay import Replay, reply_of
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.snapshot import snapshot_bytes
from tests.ramtek_emu.strategies import SMALL


@contextmanager
def states_every(seconds: float, most_bytes: int = 1 << 30) -> Iterator[None]:
    """Keep states so many seconds apart, while they take fewer bytes than this."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "STATE_SECONDS", seconds)
        patch.setattr(module, "STATE_BYTES", 0)
        patch.setattr(module, "LEAST_STATE_BYTES", most_bytes)
        yield


def replay_of(words: Iterable[int], configuration: Configuration = SMALL) -> Replay:
    """A replay of words that keeps no states yet."""
    stream = Stream(configuration, np.array(list(words), np.uint16))
    return Replay(stream)


def prepare(replay: Replay) -> None:
    """Run over the whole stream."""
    while replay.prepare_for(0.1):
        pass


def moments(replay: Replay) -> list[tuple[bytes, NDArray[np.uint16]]]:
    """All of a fresh display after each number of instructions, and the reply of the last."""
    display = Ramtek9300(replay.stream.configuration)
    found = [(snapshot_bytes(display), np.zeros(0, np.uint16))]
    for number in range(1, len(replay.stream) + 1):
        display.send(replay.stream.words_between(number - 1, number))
        reply = reply_of(display)
        found.append((snapshot_bytes(display), reply))
    return found
