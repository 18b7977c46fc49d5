"""A display behind a TCP port of this machine."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.host.server import Server

READ_EVERYTHING = np.concatenate([stream for stream, _ in instructions.read_image(0, 0, 640, 480)])


@contextmanager
def serving(idle_seconds: float = 20.0, partial_seconds: float = 20.0) -> Iterator[Server]:
    """A server in a thread of its own; its display is looked at when it has nothing to do."""
    server = Server(Ramtek9300(), idle_seconds=idle_seconds, partial_seconds=partial_seconds)
    ended = threading.Event()

    def serve() -> None:
        while not ended.is_set():
            server.step(0.01)

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        yield server
    finally:
        ended.set()
        thread.join()
        server.close()


def until(condition: object, seconds: float = 5.0) -> None:
    """Wait until a condition holds."""
    assert callable(condition)
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen in time"
        time.sleep(0.002)
