"""A display behind a TCP port or a Unix socket of this machine."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import numpy as np

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.host.server import Server, TcpServer, UnixServer

READ_EVERYTHING = np.concatenate([stream for stream, _ in instructions.read_image(0, 0, 640, 480)])


Some = TypeVar("Some", bound=Server)


@contextmanager
def serving(idle_seconds: float = 20.0) -> Iterator[TcpServer]:
    """A server on TCP in a thread of its own; tests inspect its display while the server is idle."""
    with in_a_thread(TcpServer(Ramtek9300(), idle_seconds=idle_seconds)) as server:
        yield server


@contextmanager
def serving_at(path: Path) -> Iterator[UnixServer]:
    """A server at a Unix socket in a thread of its own."""
    with in_a_thread(UnixServer(Ramtek9300(), path, idle_seconds=20.0)) as server:
        yield server


@contextmanager
def in_a_thread(server: Some) -> Iterator[Some]:
    """A server that a thread steps until it is closed."""
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


def until(condition: object, seconds: float = 60.0) -> None:
    """Wait until a condition holds."""
    assert callable(condition)
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen in time"
        time.sleep(0.002)
